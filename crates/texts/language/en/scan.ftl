# Why a frame of a scan is left out. Of each reason: `advice`, what to do, and `short`, the reason in a list

excluded-wrong-pose = its pose is wrong: the frame fits { MM($shift_m, 1) } mm and { DEGREES($turn_rad, 2) }° away
    .advice = Check that this pose belongs to this frame, and capture the frame again with the arm at rest
    .short = its pose is wrong
excluded-contradicts = it contradicts the other frames: { PERCENT($share, 0) } % of what they see together agrees
    .advice = { excluded-wrong-pose.advice }
    .short = it contradicts the other frames
excluded-looked-past = it contradicts the other frames: one looks past { PERCENT($share, 1) } % of what both should see
    .advice = { excluded-wrong-pose.advice }
    .short = { excluded-contradicts.short }
excluded-overlaps-none = it overlaps no other frame, so its pose cannot be checked
    .advice = Check that this pose belongs to this frame, or add a frame that shows surface of this one and of another
    .short = overlaps no other
excluded-part-moved = the part moved: the cell agrees with the other frames, { PERCENT($share, 0) } % of the part does
    .advice = Capture the frame again while the part stands still
    .short = the part moved

# Frames of a scan
left-out = { $name } is left out: { $why }
no-part-in-frame = no part found in it
