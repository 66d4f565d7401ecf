# What should hang before the camera

expect-title = Expected
expect-anything = Any part
expect-at-place = { $part } ({ $place })
expect-not-known = Not known
expect-says = Which parts should hang there: another one is refused, and it is shown what is missing
expect-one-more = One more
expect-one-less = One less
expect-orders = Orders…
expect-orders-says = A table (CSV) of orders with the parts that hang there for each
expect-by-orders = By table of orders
expect-close-orders = Close the table
expect-table = Table of orders
expect-table-used = What is expected follows from { $file }
expect-table-unusable = The table of orders cannot be used: { $error }
expect-reading = Reading the table of orders { $file }
expect-watching = Watching the table of orders

## Why it is not known

expect-not-given = No order is entered
expect-unknown-order = Order { $order } is not in the table of orders
expect-unknown-serial = Serial number { $serial } is not in the table of orders
expect-serial-not-given = Order { $order } differs by serial number
expect-other-order = Serial number { $serial } is of order { $other }, not { $order }
expect-several-orders = Several orders have serial number { $serial }
expect-give-order = Enter or scan the order
expect-give-serial = Scan the serial number
expect-check-order = Check the order, or ask for the table to be completed
expect-check-serial = Check the serial number, or ask for the table to be completed
expect-check-both = Check the order and the serial number

## The verdict

expect-num-met = { $num } of { $all } as expected
expect-is-met-and-posed = As expected, and its pose is known
expect-missing = Missing: { $parts }
expect-wrong = Wrong part: { $part } instead of { $expected }
expect-elsewhere = Wrong place: { $part }, expected at { $place }
expect-surplus = Not expected: { $part }
expect-of-order = Order { $order }: { $says }
expect-hang-missing = Hang up the missing parts and capture again
expect-as-expected = as expected
expect-wrong-part = wrong part
expect-wrong-place = wrong place
expect-not-expected = not expected
expect-is-missing = missing
expect-nothing-hangs = Nothing hangs there
