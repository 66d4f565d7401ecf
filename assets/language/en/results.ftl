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

## The check of the cell

results-cell-in-place = camera and part are in place
results-cell-in-place-advice = Nothing needs to be done
results-cell-part-moved = the part moved; the camera did not
results-cell-part-moved-advice = Hang the part as it was, or check what holds it, and check again; if it is to stay, take a new baseline
results-cell-camera-moved = the camera moved
results-cell-camera-moved-advice = Fix the camera, calibrate it again, then take a new baseline
results-cell-part-or-camera-moved = the part or the camera moved
results-cell-part-or-camera-moved-advice = Hang the part as it was and check again; if that does not help, the camera moved: calibrate it and take a new baseline
results-cell-noisier = camera and part are in place, but the readings are noisier
results-cell-noisier-advice = Clean the camera's window, look for stray light or mist in front of it, and check again
results-cell-no-frame = no frame
results-cell-no-frame-advice = Capture the part that checks the cell, and give the file
results-cell-moving = the frames do not agree: the part is { $shift } and { $turn } elsewhere in frame { $frame } than in the first
results-cell-moving-advice = Let the part hang still, keep the camera where it is, and capture again
results-cell-other-part = only { $overlap } % of what is seen in frame { $frame } lies on the part of the baseline
results-cell-other-part-advice = Hang the part that the baseline was taken of, in its usual place, with nothing in front of it; if it does hang there, camera or part moved by several centimetres
results-cell-pose = frame { $frame }: { $error }

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
