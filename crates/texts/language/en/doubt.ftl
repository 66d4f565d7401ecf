# Why a robot must not act on a result

# In History: the reasons are those below, in the past
doubt-past = Not for robots: { $why }

doubt-reported-wrong = the part was reported as wrong
    .advice = Check which part hangs there, and capture it again
    .past = the part was reported as wrong
doubt-source-lost = the source was lost, so what hangs there now is not known
    .advice = Connect the source again, and capture the part again
    .past = the source was lost
doubt-moving = the part is moving
    .advice = Wait until the part hangs still
    .past = the part was moving
doubt-superseded = another part may hang there by now
    .advice = Capture the part again
    .past = another part may have hung there
doubt-other-order = its order expects other parts than those that it was inspected for
    .advice = Capture the part again
    .past = its order expected other parts
doubt-not-accepted = the part was not accepted
    .advice = Capture the part again
    .past = the part was not accepted
doubt-no-pose = the part has no pose
    .advice = Choose a recipe that estimates the pose, and inspect the part again
    .past = the part had no pose
doubt-not-calibrated = the cell is not calibrated
    .advice = Calibrate where the camera stands in the robot's cell, with Robot… at the top
    .command-advice = Calibrate where the camera stands in the robot's cell: partsight calibrate, or Robot… in the window
    .past = the cell was not calibrated
doubt-clock-ahead = the capture is dated { FIXED($seconds, 0) } s later than now, so its age is not known
    .advice = Set the clocks of this computer and of the one that wrote the capture from the same time server, and capture the part again
    .past = the capture was dated later than the clock of this computer
doubt-old = the capture is more than 10 minutes old, or of unknown age
    .advice = Capture the part again
    .past = the capture was more than 10 minutes old, or of unknown age
doubt-ambiguous-pose = another pose of the part fits nearly as well
    .advice = Turn the part's face to the camera, all of it inside the picture; if it looks the same either way round, enrol and inspect it with something in view that tells the two apart, such as a bracket or a cut-out
    .past = another pose of the part fitted nearly as well
doubt-surface = the part's surface is not good
    .advice = Look at the regions that the inspection rings, and rework the part or take it off
    .past = the part's surface was not good
# Otherwise the text is pose-off-scale
doubt-off-scale =
    .past = the part was larger or smaller than its reference
doubt-frames-disagree = the frames may not fit together: { PERCENT($disagreeing, 1) } % of what { $frame } and the others see together disagrees, at most { PERCENT($most, 0) } % is usual
    .advice = Check that each pose belongs to its frame and that nothing moved between the frames
    .past = the frames of the scan disagreed
doubt-poses-apart = the poses contradict one another: { $one } and { $other } fit together only if one is moved by { MM($apart_m, 1) } mm
    .advice = Check that each pose belongs to its frame, that the arm was at rest and that its calibration still holds; the part's place in the robot's base frame is only as certain as the poses agree
    .past = the poses of the scan contradicted one another
doubt-off-the-part = the spray path does not aim at the part ({ $num_too_near ->
        [0] only { $num_aiming } of { $num_spraying } points with the gun on
       *[other] at { $num_too_near } of { $num_spraying } points with the gun on, the nozzle is less than { MM($least_m, 0) } mm in front of it or behind its surface
    })
    .advice = Check that the path is that of this part, or plan and store a new one in Paint
    .command-advice = { $num_too_near ->
        [0] Check that the path is that of this part, in the part's frame, in the unit that its heading says, and points towards the part
       *[other] Check that the positions are those of the nozzle (nozzle_x_mm) and not of the surface (x_mm, normal_x, stand_off_mm), in the part's frame and in the unit that the heading says
    }
doubt-not-reached = { $arm } misses { $num_missed } of { $num_points } points{ $num_collisions ->
        [0] {""}
       *[other] , { $num_collisions } of them because it would collide
    }
    .advice = Move the part or the arm's base, or change the path
doubt-film-off-plan = the program would bring { PERCENT($written, 1) } % of the surface within { PERCENT($tolerance, 0) } % of the target with { UM($written_m, 1) } µm on average, where { PERCENT($planned, 1) } % and { UM($planned_m, 1) } µm were planned; with the gun open it would stop { $num_stops } times
    .advice = Plan the path without added strokes along flanks (Lean to flanks 0), or write it for a controller that switches the gun while the robot moves
    .command-advice = Plan the path without added strokes along flanks (flank_lean = 0), or write it for a controller that switches the gun while the robot moves
