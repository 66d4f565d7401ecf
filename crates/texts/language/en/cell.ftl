# The check of the cell: what it found, and why frames cannot be compared

cell-in-place = camera and part are in place
    .advice = Nothing needs to be done
cell-part-moved = the part moved; the camera did not
    .advice = Hang the part as it was, or check what holds it, and check again; if it is to stay, take a new baseline
cell-camera-moved = the camera moved
    .advice = Fix the camera, calibrate it again, then take a new baseline
cell-part-or-camera-moved = the part or the camera moved
    .advice = Hang the part as it was and check again; if that does not help, the camera moved: calibrate it and take a new baseline
cell-noisier = camera and part are in place, but the readings are noisier
    .advice = Clean the camera's window, look for stray light or mist in front of it, and check again
cell-no-frame = no frame
    .advice = Capture the part that checks the cell, and give the file
cell-moving = the frames do not agree: the part is { MM($shift_m, 1) } mm and { DEGREES($turn_rad, 2) }° elsewhere in frame { $frame } than in the first
    .advice = Let the part hang still, keep the camera where it is, and capture again
cell-other-part = only { PERCENT($overlap, 0) } % of what is seen in frame { $frame } lies on the part of the baseline
    .advice = Hang the part that the baseline was taken of, in its usual place, with nothing in front of it; if it does hang there, camera or part moved by several centimetres
cell-pose = frame { $frame }: { $why }

cell-calibration = { $name }
cell-unnamed-calibration = an unnamed calibration ({ $identity })
cell-scan-poses = the poses of the scan
