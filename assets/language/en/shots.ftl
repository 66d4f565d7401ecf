# The shots of a scan
shots-shots = Shots
shots-add = Add a shot…
shots-add-says = A frame of the same part; its pose must be in the file of the poses or in poses.json beside it
shots-redo-label = Redo the change of the shots
shots-undo-label = Undo the change of the shots
shots-all-used = { $num } shots
shots-some-used = { $used } of { $num } shots used
shots-agree = { $used } · they agree to { $rms } rms
shots-use = Use { $name }
shots-drop-says = Drop this shot: the others are put together without it
shots-take-back-says = Take this shot back
shots-mark = Mark what shot { $shot } alone sees
shots-dropped = Dropped
shots-left-out = Left out: { $why }
shots-left-out-says = { $why }. { $advice }
shots-shot-left-out = Shot { $shot } is left out: { $why }
shots-seen = { $share } % of the part
shots-seen-says = It sees { $num } points of the part
shots-alone = alone sees { $share }
shots-no-part = no part found in it
shots-no-part-says = The other shots determine what in it is the part
shots-moved = moved { $shift } · { $turn }
shots-rms = rms { $rms }
shots-to-be-dropped = To be dropped…

## The summary

shots-scan = Scan
shots-used = shots used
shots-num-used = { $used } of { $num }
shots-refined-by = poses refined by up to
shots-agree-to = shots agree to, rms
shots-points = points of the part
shots-outline-open = outline open
shots-not-seen = Not seen by any shot · { $share } of the enrolled surface
shots-unseen = Unseen: the part may continue here · { $share } of the outline
shots-seen-by-one = Seen by shot { $shot } alone · { $share } of the part

## Why a shot is left out

shots-wrong-pose = its pose is wrong
shots-wrong-pose-by = its pose is wrong: the frame fits { $shift } and { $turn } away
shots-contradicts = it contradicts the other frames
shots-contradicts-by = it contradicts the other frames: { $share } % of what they see together agrees
shots-looked-past-by = it contradicts the other frames: one looks past { $share } % of what both should see
shots-overlaps-none = overlaps no other
shots-overlaps-none-says = it overlaps no other shot, so its pose cannot be checked
shots-part-moved = the part moved
shots-part-moved-by = the part moved: the cell agrees with the other frames, { $share } % of the part does
shots-excluded-advice = Check that this pose belongs to this frame, and capture the frame again with the arm at rest
shots-overlaps-none-advice = Check that this pose belongs to this frame, or add a shot that shows surface of this one and of another
shots-part-moved-advice = Capture the frame again while the part stands still

## Files

shots-add-a-frame = Add a frame to the scan
shots-poses-file = File of the poses of the shots
shots-poses = Poses
shots-at-least = A scan needs at least { $num } shots
shots-take-another = Take another shot back first
shots-putting-together = Putting the shots together
shots-adding = Adding { $name }
shots-is-left-out = { $name } is left out: { $why }
