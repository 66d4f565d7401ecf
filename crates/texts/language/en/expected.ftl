# Why parts cannot be expected

expected-too-many = { $found } parts are expected, and a frame can show { $limit }
    .advice = Expect up to { $limit } parts
expected-not-enrolled = { $name } is expected, but not enrolled
    .advice = Enrol it, or correct its name
    .command-advice = Give names of parts of the library; partsight library list shows them
expected-no-such-place = a part is expected at place "{ $place }", which the rack does not have
    .advice = { $has_places ->
        [true] Give a place of the rack: { $known }
       *[false] Open a rack that has the place, or leave the place out
    }
    .command-advice = { $has_places ->
        [true] Give a place of the rack: { $known }
       *[false] Give the rack that has the place with --rack, or leave the place out
    }
expected-place-twice = two parts are expected at place "{ $place }", where one can hang
    .advice = Expect one part at each place

expected-recipe = recipe { $recipe }: { $why }
