# Why a part is not accepted, or nothing is recognised. Of each kind: the reason; `advice`, what to do, and `command-advice`
# where commands advise something else; `kind`, its name where refusals are counted; `short`, the reason for an operator;
# what an operator can do, as `step` and `otherwise`, between which the window says how to inspect again, or as `next`,
# or else `advice`; `compared`, the reason beside the figures of Compare.

## A part is not accepted

refusal-low-score = the best match, { $part }, scores { FIXED($score, 2) }, below the threshold of { FIXED($threshold, 2) }
    .advice = Check that this part is enrolled and that nothing covers it, then capture again
    .kind = Score below the threshold
    .short = It does not match { $nearest } well enough
    .step = { step-uncover }
    .otherwise = { step-if-it-persists }
    .compared = score { FIXED($score, 2) } is below { FIXED($threshold, 2) }
refusal-piece = only a piece of { $part } is in sight ({ PERCENT($hidden, 0) } % of it hidden, { PERCENT($outside, 0) } % beyond the picture); it scores { FIXED($score, 2) }, below the threshold of { FIXED($threshold, 2) }
    .advice = { PERCENT($hidden, 0) ->
        [0] { PERCENT($outside, 0) ->
            [0] { piece-hidden-or-outside }
           *[other] { piece-outside }
        }
       *[other] { PERCENT($outside, 0) ->
            [0] { piece-hidden }
           *[other] { piece-hidden-or-outside }
        }
    }
    .kind = Only a piece of the part in sight
    .short = Only a piece of { $nearest } is in sight
    .compared = score { FIXED($score, 2) } is below { FIXED($threshold, 2) }: only a piece is in sight
refusal-hardly-seen = what may be { $part } is hardly in sight: seen nearly edge-on, or cut off on most sides
    .advice = Turn the part to face the camera, all of it inside the picture, and capture again
    .kind = Part hardly in sight
    .short = { short-hardly-seen }
    .step = { step-all-in-picture }
    .compared = score { FIXED($score, 2) }: hardly in sight
refusal-another-model = it is like { $part }, but not the same: { LIST(model-surface, model-outline, model-missing, between: ", ", last: ", and ", end: "; ") }another model, the pose is approximate
    .advice = If this one is to be painted too, enrol it as one more reference of { $part }
    .kind = Another model
    .short = It resembles { $nearest }, but its shape differs
    .next = { step-enrol-if-painted-next }
    .compared = { LIST(model-surface, model-outline, model-missing, between: ", ", last: ", ", end: ": ") }another model
refusal-another-make = it resembles { $part }, but is of another make, with other dimensions or another shape
    .advice = { refusal-another-model.advice }
    .kind = Another make
    .short = It resembles { $nearest }, but its dimensions differ
    .next = { step-enrol-if-painted-next }
    .compared = of the same type with a probability of { FIXED($likeness, 2) }: another make
refusal-ambiguous-pose = the piece of { $part } in sight fits almost equally well at another place of it (lead over that place { FIXED($margin, 2) }, needed { FIXED($threshold, 2) })
    .advice = { see-an-edge }
    .kind = Fits another place of the part almost equally well
    .short = { short-uncertain-pose }
    .step = { step-see-an-edge }
    .otherwise = { step-if-it-persists }
    .compared = its lead over another pose is { FIXED($margin, 2) }, below { FIXED($threshold, 2) }
refusal-unconstrained = the pose of { $part } is unconstrained by what is in sight: { free-motion }
    .advice = { see-an-edge }
    .kind = Pose unconstrained
    .short = { short-uncertain-pose }
    .step = { step-see-an-edge }
    .otherwise = { step-if-it-persists }
    .compared = the pose is unconstrained: { free-motion }
refusal-uncertain = the pose of { $part } is uncertain by { MM($shift_m, 1) } mm, and { MM($limit_m, 1) } mm is allowed
    .advice = { $frames_disagree ->
        [true] { scan-poses }
       *[other] { see-an-edge }
    }
    .kind = Pose too uncertain
    .short = { short-uncertain-pose }
    .step = { $frames_disagree ->
        [true] { step-scan-again }
       *[other] { step-see-an-edge }
    }
    .otherwise = { step-if-it-persists }
    .compared = the pose is uncertain by { MM($shift_m, 1) } mm, and { MM($limit_m, 1) } mm is allowed
refusal-unknown = unknown: no enrolled part is like it{ $like ->
        [true] ; the nearest, { $nearest }, scores { FIXED($score, 2) }
       *[other] { "" }
    }
    .advice = Enrol the part if it is to be painted; if it is enrolled, turn its face to the camera and capture again
    .kind = Unknown: no enrolled part is like it
    .short = No enrolled part resembles it
    .step = { step-turn }
    .otherwise = { step-enrol-if-painted-next }
    .compared = score { FIXED($score, 2) }: unknown
refusal-mirrored = it looks like the mirror image of { $part } (which scores { FIXED($score, 2) }): the part from the other side of the car
    .advice = Enrol the part of this side under a name of its own, and do not paint it with the other side's path
    .kind = Mirror image of an enrolled part
    .short = It looks like the mirror image of { $nearest }
    .next = Do not paint it as { $nearest }: ask the engineer to enrol the part of this side
    .compared = it looks like the mirror image of { $part }
refusal-mirrored-image = it fits { $part } only as its mirror image (which scores { FIXED($score, 2) }), and { $part } has no other side: left and right are probably swapped in the image
    .advice = Do not move the robot by this image: compare an image with the part, and if left and right are swapped, add "mirrored": true to the JSON with the camera's intrinsics
    .command-advice = Do not move the robot by this image: { put-right }
    .kind = Left and right probably swapped in the image
    .short = The camera's picture is mirrored
    .next = Do not start the robot: ask the engineer to set the camera right
    .compared = it fits { $part } only as its mirror image: the image is probably mirrored
refusal-off-scale = what the camera sees of { $part } is { PERCENT($by, 0) } % { $is_larger ->
        [true] larger
       *[false] smaller
    } than the reference: the camera's numbers are wrong, or it is another make
    .advice = Check the unit of the camera's depths and its focal lengths (fx, fy) first; enrol it as one more reference of { $part } only if it really has another size
    .kind = Another size than the reference: wrong numbers of the camera, or another make
    .short = The camera shows { $nearest } in another size
    .next = Do not start the robot: ask the engineer to check the camera
    .compared = another size than the reference
refusal-other-half = it looks like the mirror image of what was enrolled of { $part } (which scores { FIXED($score, 2) }): only a piece of { $part } was enrolled, and this may be its other half
    .advice = Enrol all of { $part }, or this half as one more reference of it
    .kind = Perhaps the half of a part that was not enrolled
    .short = It may be the other half of { $nearest }
    .next = Ask the engineer to enrol all of { $nearest }
    .compared = it looks like the mirror image of the enrolled piece of { $part }
refusal-small-margin = { $part } and { $other } fit almost equally well (margin { FIXED($margin, 2) }, needed { FIXED($threshold, 2) })
    .advice = Turn the part to face the camera and capture again; if both names stand for the same part, remove one of them from the library
    .kind = Two parts fit almost equally well
    .short = Two enrolled parts match almost equally well
    .step = { step-turn }
    .otherwise = { step-if-two-alike }
    .compared = its lead over { $other } is { FIXED($margin, 2) }, below { FIXED($threshold, 2) }
refusal-wrong-part = wrong part: { $part } hangs there instead of { $expected }
    .advice = Hang { $expected } there, or correct what is expected
    .kind = Another part than expected
    .short = { $nearest } hangs there instead of { $expected }
    .compared = { $expected } is expected
refusal-not-expected = too many parts: { $part } is not expected
    .advice = Take { $part } away, or correct what is expected
    .kind = Part not expected
    .short = { $nearest } is not expected
    .compared = it is not expected
refusal-expected-elsewhere = wrong place: { $part } hangs at { $place }, and is expected at { $expected_at }
    .advice = Hang { $part } at { $expected_at }, or correct what is expected
    .kind = Part at another place than expected
    .short = { $nearest } is expected at { $expected_at }, not at { $place }
    .compared = it is expected at { $expected_at }
refusal-cut-by-volume = { $part } goes on outside the work volume, and too little of it is inside
    .advice = Make the work volume larger in the rack file, or hang { $part } inside it
    .kind = Cut off by the work volume
    .short = { $nearest } reaches out of the work volume
    .compared = it goes on outside the work volume
refusal-wrong-place = wrong place: { $part } may not hang at { $place }
    .advice = Hang { $part } at its own place, or allow it at { $place } in the rack file
    .kind = Part at another part's place
    .short = { $nearest } may not hang at { $place }
    .compared = it may not hang at { $place }
refusal-beside-places = { $part } hangs { MM($distance_m, 0) } mm outside place { $place }, the nearest of the rack
    .advice = Hang { $part } at a place of the rack, or move the place in the rack file
    .kind = Beside the places of the rack
    .short = { $nearest } hangs { MM($distance_m, 0) } mm outside { $place }
    .compared = it hangs { MM($distance_m, 0) } mm outside { $place }
refusal-turned = { $part } is turned by { DEGREES($turn_rad, 0) }° at { $place }; { DEGREES($limit_rad, 0) }° are allowed
    .advice = Hang { $part } the right way round, or allow this orientation in the rack file
    .kind = Turned at its place
    .short = { $nearest } is turned by { DEGREES($turn_rad, 0) }° at { $place }
    .compared = it is turned by { DEGREES($turn_rad, 0) }°; { DEGREES($limit_rad, 0) }° are allowed
refusal-unconfirmed = { $part } is the nearest outline; the paper's matcher alone cannot tell it from an unknown part
    .advice = Have the pose estimated too: set “Pose by” to Global in the recipe
    .command-advice = Have the pose estimated too, with --pose global
    .kind = By the paper's matcher alone, without a pose
    .short = Only its outline was compared
    .next = { step-unconfirmed-next }
    .compared = the paper's matcher alone cannot tell it from an unknown part
refusal-out-of-range = what may be { $part } is { FIXED($depth_m, 2) } m from the camera: depth cameras read from { $from } to { $to } m
    .advice = Check the unit of the file or of the camera's JSON: lengths are metres; then capture again
    .kind = Outside the camera's range
    .short = It is too near to the camera or too far away
    .next = { step-check-camera-next }
refusal-behind-camera = { PERCENT($share, 1) } % of the points lie behind the camera, so it is not known where { $part } is
    .advice = Export the capture in the camera's own frame: x right, y down, z forward
    .kind = Points behind the camera
    .short = { short-damaged-file }
    .next = { step-check-camera-next }
refusal-surplus-bytes = { $num ->
        [one] { $num } byte follows the last point of the file: it is damaged, and with it what may be { $part }
       *[other] { $num } bytes follow the last point of the file: it is damaged, and with it what may be { $part }
    }
    .advice = Copy or export the file again from the program that made it
    .kind = Damaged file
    .short = { short-damaged-file }
    .next = { step-check-camera-next }
refusal-no-pose = no pose was found: { $why }
    .kind = No pose found
    .short = It may be { $nearest }, but no pose was found
    .step = { step-turn }
    .otherwise = { step-if-it-persists }
refusal-not-steady = { $part } is not hanging still yet
    .advice = Let the part hang still for a second
    .kind = Not hanging still yet
    .short = It is not hanging still yet
refusal-passing = { $part } passes on the line, but only { $num_frames } of { $needed } frames have shown all of it so far
    .advice = Wait a moment
    .kind = Too few frames of it on the line
    .short = Too few frames have shown it so far
refusal-smeared = { $part } moved by { MM($smear_m, 1) } mm while the camera exposed a frame, and { MM($limit_m, 1) } mm is allowed
    .advice = Slow the line down or shorten the camera's exposure; if it is shorter than the line's file says, correct exposure_ms there
    .kind = Line too fast for the exposure
    .short = The line is too fast for the camera's exposure
refusal-few-frames = { $part } hangs still, but only { $num_frames } of { $needed } frames were inspected since
    .advice = Wait a moment
    .kind = Too few frames since it hung still
    .short = Too few frames were inspected so far
refusal-too-slow = not judged: this computer is too slow ({ $num_inspected } of { $num_frames } frames inspected)
    .advice = Choose a smaller picture or another recipe, look for fewer parts (max_parts), or close other programs
    .kind = Not judged: this computer is too slow
    .short = This computer is too slow: { $num_inspected } of { $num_frames } frames inspected
refusal-undecided = { $num_agreeing } of { $num_frames } frames accept { $part }, but { $needed } are needed
    .advice = Wait a moment; if it persists, turn the part's face to the camera and take away what stands in front of it
    .kind = Too few frames accept the part
    .short = { short-undecided }
refusal-poses-apart = the poses of { $part } agree in { $num_agreeing } of { $num_frames } frames, but { $needed } are needed
    .advice = Hang the part so that nothing can swing, and wait a moment; if it persists, turn its face to the camera
    .kind = Poses of the frames do not agree
    .short = { short-undecided }

## There is no part

refusal-too-few-points = { $found ->
        [one] the scene has { $found } reading, at least { $needed } are needed
       *[other] the scene has { $found } readings, at least { $needed } are needed
    }
    .advice = Check that the camera is connected, uncovered and 0.6 to 3 m from the part, then capture again
    .short = The camera sees hardly anything
    .step = { step-uncover-camera }
    .otherwise = { step-if-it-persists }
refusal-too-wide = the scene spans { FIXED($extent_m, 0) } m and holds nothing the size of a part
    .advice = Press Read as millimetres if it is offered below, or export it in metres; for a depth image, correct metres_per_unit in the JSON beside it
    .command-advice = Read it as millimetres (--units mm), or export it in metres; for a depth image, correct metres_per_unit in the JSON beside it
    .short = The scene is far larger than a cell
    .next = { step-ask }
refusal-only-background = nothing the size of a part stands in front of the background ({ $planes ->
        [one] 1 plane removed
       *[other] { $planes } planes removed
    }, largest rest { FIXED($found_m2, 3) } m², needed { FIXED($needed_m2, 3) } m²)
    .advice = { $knows_cell ->
        [true] Hang the part in front of the camera, at least 10 cm away from the wall, and capture again; if it hung there when the empty cell was captured, capture that again without it
       *[other] Hang the part in front of the camera, at least 10 cm away from the wall, and capture again
    }
    .short = No part hangs in front of the camera
    .step = { step-hang }
    .otherwise = { $knows_cell ->
        [true] { step-if-it-hangs-there }
       *[other] { "" }
    }
refusal-no-plane = the part's { $num_points } points lie on a line or a spot ({ FIXED($width_m, 4) } m wide)
    .advice = Turn the part to face the camera and capture again
    .short = { short-hardly-seen }
    .step = { step-turn }
    .otherwise = { step-if-it-persists }
refusal-too-large = the part spans { FIXED($found_m, 1) } m, an image covers { FIXED($limit_m, 1) } m
    .advice = Check that the file is in metres, or clear everything but the part from the scene; for a depth image, correct metres_per_unit in the JSON beside it
    .short = Something far larger than a part is in sight
    .step = { step-clear }
    .otherwise = { step-if-it-persists }
refusal-no-shape = the binary image holds no shape with an area ({ $num_set } pixels set)
    .advice = Raise the gap that is closed, or move the part nearer to the camera, and capture again
    .short = { short-hardly-seen }
    .step = { step-nearer }
    .otherwise = { step-if-it-persists }
refusal-no-outline = the outline of { $num_points } points has no length
    .advice = Move the part nearer to the camera and capture again
    .short = { short-hardly-seen }
    .step = { step-nearer }
    .otherwise = { step-if-it-persists }
refusal-empty-library = no part is enrolled in the library
    .advice = Enrol a part first, in the Enrol workspace
    .command-advice = Enrol a part first, in the Enrol workspace or with partsight enrol FILE --name NAME
    .short = { short-no-parts-why }
    .next = { step-ask }
refusal-fault = internal error of the program: { $message }
    .advice = Keep the file or frame and report it with this message; later inspections are not affected
    .short = { short-fault }
    .next = { step-ask }

## Parts of these texts

model-surface = { MM($relief_m, 1) ->
        [0.0] { "" }
       *[other] its surface is off by { MM($relief_m, 1) } mm
    }
model-outline = { MM($outline_m, 1) ->
        [0.0] { "" }
       *[other] { MM($relief_m, 1) ->
            [0.0] its outline is off by { MM($outline_m, 1) } mm
           *[other] its outline by { MM($outline_m, 1) } mm
        }
    }
model-missing = { PERCENT($missing, 1) ->
        [0.0] { "" }
       *[other] { PERCENT($missing, 1) } % of it is missing
    }
piece-hidden = Take away what stands in front of the part and capture again
piece-outside = Hang the part further inside the picture and capture again
piece-hidden-or-outside = Take away what stands in front of the part, or hang it further inside the picture, and capture again
see-an-edge = Turn the part or move the camera so that a corner or another edge of the part is in sight, and capture again
scan-poses = Check the robot's pose of each frame and the hand-eye calibration first, then scan again; if both are right, move the camera so that it sees a corner or another edge of the part
short-uncertain-pose = Recognised, but its pose is uncertain
short-damaged-file = The captured file is damaged
short-undecided = The frames do not agree
short-hardly-seen = Too little of the part is in sight
short-fault = The program failed at this frame
short-no-parts-why = No part is enrolled in the library
step-unconfirmed-next = Ask the engineer to have the pose estimated too
step-uncover = Take away what covers the part
step-all-in-picture = Turn its face to the camera, all of it inside the picture
step-see-an-edge = Turn the part so that a corner or another edge of it is in sight
step-turn = Turn its face to the camera
step-clear = Take away everything but the part
step-nearer = Hang the part nearer to the camera
step-scan-again = Scan the part again, with nothing moving
step-hang = Hang the part in front of the camera, at least 10 cm away from the wall
step-uncover-camera = Take away what covers the camera
step-if-it-persists = If it persists, ask the engineer
step-if-two-alike = If it persists, ask the engineer to remove one of the two from the library
step-enrol-if-painted-next = If it is to be painted, ask the engineer to enrol it
step-check-camera-next = Ask the engineer to check the camera and its files
step-ask = Ask the engineer
step-if-it-hangs-there = If it already hangs there, ask the engineer to capture the empty cell again
put-right = compare an image with the part, and if left and right are swapped, add "mirrored": true to the JSON with the camera's intrinsics (see partsight help inspect)
