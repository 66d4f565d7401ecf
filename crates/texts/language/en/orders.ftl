# Why a table of orders cannot be read

orders-file = { $what }
    .advice = { $is_damaged ->
        [true] { $to_do }; a spreadsheet saves a table as CSV UTF-8
       *[false] { $to_do }
    }
orders-column = { $path }, line 1: { $found } columns are named { $column }
    .advice = Name the columns order, serial and parts in the first line; serial may be left out
orders-none = { $path }: the table has no orders
    .advice = Add a row for each order below the first line
orders-cell = { $path }, line { $line }, column { $column }: { $why }

## What is wrong with a cell

orders-empty = the cell is empty
    .advice = Fill the cell, or delete the row
orders-not-one-line = the cell has line breaks, or more than { $limit } characters
    .advice = Shorten it; look for a missing quotation mark before it
orders-again = the order and serial number are those of line { $first }
    .advice = Put all parts that hang together into one row
