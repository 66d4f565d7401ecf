# What the library says of a result

## Verdicts

results-recipe-as-in-the-paper = As in the paper
results-recipe-modified = { $name } (modified)
results-title-not-recognised = Not recognised · nearest { $part }
results-title-refused = { $part } · not accepted
results-title-unknown = Unknown · nearest { $part }

## Poses


## The simulated cell

results-object-hood = hood
results-object-wheel = wheel
results-object-box = box
results-object-chair = chair
results-object-board = board
results-object-ladder = ladder
results-object-stool = stool
results-object-bucket = bucket

## The recipe

