# Why a robot that is moved by the camera is held or stopped

servo-not-accepted = the robot was stopped because no part is accepted: { $why }
servo-another-part = the robot was stopped because { $other } hangs there instead of { $part }
    .advice = Hang the right part, or choose the one that hangs there, and start again
servo-ambiguous = the robot was stopped because the pose of { $part } is not certain: another one fits nearly as well, or its size does not match
    .advice = Turn the part's face to the camera, all of it inside the picture, and start again
servo-no-bounds = the robot was stopped because the inspection gives no bounds for the pose of { $part }
    .advice = Choose a recipe that estimates the pose with the global method, and start again
servo-moved = the robot was stopped because the part appears to have moved by { MM($shift_m, 0) } mm and { DEGREES($turn_rad, 1) }° from one frame to the next
    .advice = Let the part hang still and start again; if it did hang still, check the calibration, and that camera and robot have the same time
servo-lost = the robot was stopped because there has been no accepted frame for { FIXED($age_s, 1) } s
    .advice = Check the camera and its cable, and that the whole part stays in the picture, then start again
servo-stale = the robot was stopped because a frame arrived { FIXED($age_s, 1) } s after it was taken
    .advice = Close what else uses this computer, or raise the greatest age of a frame, then start again
servo-frame-times = the robot was stopped because the times of the frames are wrong by { FIXED($off_s, 2) } s: later than now, or not in order
    .advice = Set the clocks of camera, robot and this computer from the same time server, then start again
servo-arm-times = the robot was stopped because two reports of its pose are { FIXED($gap_s, 3) } s apart
    .advice = Check the connection to the robot's controller, then start again
servo-arm-astray = the robot was stopped because it is { MM($shift_m, 0) } mm and { DEGREES($turn_rad, 1) }° off the way on which it was sent
    .advice = Check for a message on the teach pendant, and that base and tool are those of the calibration, then start again
servo-too-far = the robot was stopped because the target is { MM($shift_m, 0) } mm and { DEGREES($turn_rad, 0) }° away
    .advice = Move the robot nearer to the target, so that the camera sees the whole part, and start again
servo-outside-volume = the robot was stopped because it would leave the work volume by { MM($beyond_m, 0) } mm
    .advice = Hang the part elsewhere, or enlarge the work volume if there is room
servo-too-near = the robot was stopped because its { $body ->
        [gun] gun
        [wrist] wrist
        [forearm] forearm
        [upper_arm] upper arm
       *[tool] tool
    } would come too near to { near-obstacle }
    .advice = Hang the part elsewhere, start from another side, or check the obstacles and their least distance
servo-out-of-reach = the robot was stopped because the arm does not reach the way to the target
    .advice = Hang the part nearer to the middle of the arm's reach, or start with another configuration
servo-joint-limit = the robot was stopped because joint { $joint } would go beyond its limit
    .advice = Start with another configuration of the arm, or hang the part elsewhere
servo-singular = the robot was stopped because the arm would come near to a singularity
    .advice = Start with another configuration of the arm, or hang the part elsewhere
servo-uncertain = the target is reached, but not as exactly as required: { MM($shift_m, 1) } mm and { DEGREES($turn_rad, 2) }° with the bounds, allowed { MM($most_m, 1) } mm and { DEGREES($most_rad, 2) }°
    .advice = Let the camera see the part whole and from nearer, calibrate again where the nozzle is the target, or raise the tolerance
servo-not-settling = { $num_rounds ->
        [one] the robot was stopped because { MM($shift_m, 1) } mm and { DEGREES($turn_rad, 2) }° are left after { $num_rounds } correction
       *[other] the robot was stopped because { MM($shift_m, 1) } mm and { DEGREES($turn_rad, 2) }° are left after { $num_rounds } corrections
    }
    .advice = Let the part hang still, or raise the deadband; if nothing moves, check the calibration
servo-time-over = the robot was stopped because the target was not reached within { FIXED($limit_s, 0) } s
    .advice = Start nearer to the target, or raise the longest time
servo-robot-stopped = the robot was stopped because its program has stopped, or no longer takes poses
    .advice = Start the robot's program again, then servo again
servo-by-person = the robot was stopped on request
    .advice = Start again when the cell is clear

# Before it moves
servo-waits-for-robot = Waiting for the robot: { $robot }
servo-not-simulated = the simulated cell has no { $part }
