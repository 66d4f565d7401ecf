# What should hang before the camera

expect-title = Expected
expect-anything = Any part
expect-at-place = { $part } ({ $place })
expect-not-known = Not known
expect-says = Which parts should hang there: another one is refused, and it is shown what is missing
expect-one-more = One more
expect-one-less = One less
expect-elsewhere-heading = At any other place
expect-as-recipe = As in recipe { $recipe }
expect-orders = Orders…
expect-orders-says = A table (CSV) of orders with the parts that hang there for each
expect-by-orders = By table of orders
expect-close-orders = Close the table
expect-table = Table of orders
expect-table-used = What is expected follows from { $file }
expect-table-unusable = The table of orders cannot be used: { $error }
expect-reading = Reading the table of orders { $file }
expect-watching = Watching the table of orders

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
