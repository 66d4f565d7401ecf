# Outcomes of inspections, estimations and cases, and names of frames

verdict-accepted = Accepted
verdict-not-accepted = Not accepted
verdict-unknown = Unknown
verdict-no-part = No part
another-make = { $part }, another make
another-model = { $part }, another model
mirror-image = mirror image of { $part }
other-half = mirror image of the enrolled piece of { $part }
simulated-frame = simulated frame { $number }
no-more-frames = { $source } has no more frames
keep-all = All
keep-not-accepted = Not accepted
keep-none = None
frame-loss-disk-full = the disk was full
frame-loss-not-writable = could not be written
frame-loss-slow-disk = the disk was too slow
stopped-converged = converged
stopped-below-target = below the threshold
stopped-iteration-limit = iteration limit
stopped-no-progress = no progress
outcome-right = right
outcome-refused = refused
outcome-wrong-accepted = false accept
no-calibration = Calibration: nothing was taken for a part
