# What the library says of a result

## Verdicts

results-accepted = Accepted
results-not-accepted = Not accepted
results-unknown = Unknown
results-no-part = No part
results-recipe-as-in-the-paper = As in the paper
results-recipe-modified = { $name } (modified)
results-title-not-recognised = Not recognised · nearest { $part }
results-title-refused = { $part } · not accepted
results-title-unknown = Unknown · nearest { $part }
results-title-mirrored = Mirror image of { $part }
results-keep-all = All
results-keep-not-accepted = Not accepted
results-keep-none = None

## Poses

results-converged = converged
results-below-target = below target
results-iteration-limit = iteration limit
results-no-progress = no progress

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

results-group-segmentation = Segmentation
results-group-binary-image = Binary image
results-group-contour = Contour and rays
results-group-match = Match
results-group-icp-ga = ICP-GA
results-group-acceptance = Acceptance
results-group-stand-off = Stand-off
results-option-default = Default
results-option-paper = Paper
results-option-global = Global
results-option-none = None
