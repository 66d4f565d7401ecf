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

## Why it is not known what an order expects; `command-advice` is for a programmer

order-too-long = the order or the serial number has more than { $limit } characters, or line breaks
    .advice = Check what was scanned
order-not-given = no order is given
    .advice = Enter or scan the order
    .command-advice = Give it with --order, with the trigger (TRIGGER ORDER=4711), or in the window's field for the order
order-unknown-order = order { $order } is not in the table of orders
    .advice = Check the order, or ask for the table to be completed
    .command-advice = Check the order, or add it to the table
order-unknown-serial = serial number { $serial } is not in the table of orders
    .advice = Check the serial number, or ask for the table to be completed
    .command-advice = Check the serial number, or add it to the table
order-serial-not-given = order { $order } differs by serial number, and none is given
    .advice = Scan the serial number
    .command-advice = Give it with --serial, with the trigger (TRIGGER SERIAL=TL-0042), or in the window's field for the serial number
order-other-order = serial number { $serial } is of order { $other }, not { $order }
    .advice = Check the order and the serial number
order-several = several orders have serial number { $serial }
    .advice = { order-not-given.advice }
    .command-advice = { order-not-given.command-advice }
