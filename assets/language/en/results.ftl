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

## Why a part is not accepted

results-low-score = the best match, { $part }, scores { $score }, below the threshold of { $threshold }
results-piece = only a piece of { $part } is in sight ({ $hidden } % of it hidden, { $outside } % beyond the picture); it scores { $score }, below the threshold of { $threshold }
results-hardly-seen = what may be { $part } is hardly in sight: seen nearly edge-on, or cut off on most sides
results-another-model = it is like { $part }, but not the same: its surface is off by { $relief }, its outline by { $outline }, and { $missing } % of it is missing; another model, the pose is approximate
results-another-make = it resembles { $part }, but is of another make, with other dimensions or another shape
results-ambiguous-pose = the piece of { $part } in sight fits almost equally well at another place of it (lead over that place { $margin }, needed { $threshold })
results-unconstrained = the pose of { $part } is unconstrained by what is in sight: { $freedom }
results-uncertain = the pose of { $part } is uncertain by { $shift }, and { $limit } is allowed
results-unknown-nearest = unknown: no enrolled part is like it; the nearest, { $nearest }, scores { $score }
results-unknown-alone = unknown: no enrolled part is like it
results-mirrored = it looks like the mirror image of { $part } (which scores { $score }): the part from the other side of the car
results-mirrored-image = it fits { $part } only as its mirror image (which scores { $score }), and { $part } has no other side: left and right are probably swapped in the image
results-small-margin = { $part } and { $other } fit almost equally well (margin { $margin }, needed { $threshold })
results-unconfirmed = { $part } is the nearest outline; the paper's matcher alone cannot tell it from an unknown part
results-out-of-range = what may be { $part } is { $depth } m from the camera: depth cameras read from 0.1 to 20 m
results-behind-camera = { $share } % of the points lie behind the camera, so it is not known where { $part } is
results-surplus-bytes = { $num } bytes follow the last point of the file: it is damaged, and with it what may be { $part }
results-no-pose = no pose was found: { $why }
results-not-steady = { $part } is not hanging still yet
results-few-frames = { $part } hangs still, but only { $num } of { $needed } frames were inspected since
results-undecided = { $agreeing } of { $num } frames accept { $part }, but { $needed } are needed
results-poses-apart = the poses of { $part } agree in { $agreeing } of { $num } frames, but { $needed } are needed

## The same where refusals are counted

results-kind-low-score = Score below the threshold
results-kind-piece = Only a piece of the part in sight
results-kind-hardly-seen = Part hardly in sight
results-kind-another-model = Another model
results-kind-another-make = Another make
results-kind-ambiguous-pose = Fits another place of the part almost equally well
results-kind-unconstrained = Pose unconstrained
results-kind-uncertain = Pose too uncertain
results-kind-unknown = Unknown: no enrolled part is like it
results-kind-mirrored = Mirror image of an enrolled part
results-kind-mirrored-image = Left and right probably swapped in the image
results-kind-small-margin = Two parts fit almost equally well
results-kind-unconfirmed = By the paper's matcher alone, without a pose
results-kind-out-of-range = Outside the camera's range
results-kind-behind-camera = Points behind the camera
results-kind-surplus-bytes = Damaged file
results-kind-no-pose = No pose found
results-kind-not-steady = Not hanging still yet
results-kind-few-frames = Too few frames since it hung still
results-kind-undecided = Too few frames accept the part
results-kind-poses-apart = Poses of the frames do not agree

## What to do about it

results-low-score-advice = Check that this part is enrolled and that nothing covers it, then capture again
results-small-margin-advice = Turn the part to face the camera and capture again; if both names stand for the same part, remove one of them from the library
results-hidden-piece-advice = Take away what stands in front of the part and capture again
results-outside-piece-advice = Hang the part further inside the picture and capture again
results-piece-advice = Take away what stands in front of the part, or hang it further inside the picture, and capture again
results-hardly-seen-advice = Turn the part to face the camera, all of it inside the picture, and capture again
results-see-an-edge-advice = Move the camera so that it sees a corner or another edge of the part, and capture again
results-another-model-advice = If this one is to be painted too, enrol it as one more reference of { $part }
results-unknown-advice = Enrol the part if it is to be painted; if it is enrolled, turn its face to the camera and capture again
results-mirrored-advice = Enrol the part of this side under a name of its own, and do not paint it with the other side's path
results-mirrored-image-advice = Do not move the robot by this image: compare an image with the part, and if left and right are swapped, add "mirrored": true to the JSON with the camera's intrinsics
results-unconfirmed-advice = Have the pose estimated too: set “Pose by” to Global in the recipe
results-out-of-range-advice = Check the unit of the file or of the camera's JSON: lengths are metres; then capture again
results-behind-camera-advice = Export the capture in the camera's own frame: x right, y down, z forward
results-surplus-bytes-advice = Copy or export the file again from the program that made it
results-not-steady-advice = Let the part hang still for a second
results-few-frames-advice = Wait a moment
results-undecided-advice = Wait a moment; if it persists, turn the part's face to the camera and take away what stands in front of it
results-poses-apart-advice = Hang the part so that nothing can swing, and wait a moment; if it persists, turn its face to the camera

## Why there is no part

results-too-few-readings = the scene has { $found } readings, at least { $needed } are needed
results-too-few-readings-advice = Check that the camera is connected, uncovered and 0.6 to 3 m from the part, then capture again
results-too-wide = the scene spans { $extent } m and holds nothing the size of a part
results-too-wide-advice = Press Read as millimetres if it is offered below, or export it in metres; for a depth image, correct metres_per_unit in the JSON beside it
results-only-background = nothing the size of a part stands in front of the background ({ $planes ->
        [one] 1 plane removed
       *[other] { $planes } planes removed
    }, largest rest { $found } m², needed { $needed } m²)
results-only-background-advice = Hang the part in front of the camera, at least 10 cm away from the wall, and capture again
results-known-cell-advice = Hang the part in front of the camera, at least 10 cm away from the wall, and capture again; if it hung there when the empty cell was captured, capture that again without it
results-empty-library = no part is enrolled in the library
results-empty-library-advice = Enrol a part first, in the Enrol workspace
results-no-plane = the part's { $num } points lie on a line or a spot ({ $width } m wide)
results-no-plane-advice = Turn the part to face the camera and capture again
results-too-large = the part spans { $found } m, an image covers { $limit } m
results-too-large-advice = Check that the file is in metres, or clear everything but the part from the scene; for a depth image, correct metres_per_unit in the JSON beside it
results-no-shape = the binary image holds no shape with an area ({ $num } pixels set)
results-no-shape-advice = Raise the gap that is closed, or move the part nearer to the camera, and capture again
results-no-outline = the outline of { $num } points has no length
results-no-outline-advice = Move the part nearer to the camera and capture again

## Poses

results-slide-long = it can slide along its long side
results-slide-short = it can slide along its short side
results-slide-normal = it can move square to its surface
results-turn-long = it can turn about its long side
results-turn-short = it can turn about its short side
results-turn-normal = it can turn about the axis square to its surface
results-anyhow = it can slide or turn
results-source = source
results-target = target
results-few-points = the { $which } cloud has { $found } points, at least { $needed } are needed
results-few-points-advice = Capture the part again from closer, or enrol it again
results-degenerate = the { $which } cloud does not determine the pose: its points lie on a line or a spot ({ $width } m wide)
results-degenerate-advice = Use a cloud that shows a surface, not a line or a single spot
results-one-sided-pairs = the closest points of all { $num } pairs lie on a spot or a line, { $rms } apart
results-no-overlap = the clouds have only { $found } pairs of points within { $reach }, at least { $needed } are needed
results-no-overlap-advice = Check that both clouds show the same part in metres
results-sizes-differ = one cloud is { $ratio } times as large as the other
results-sizes-differ-advice = Export both in metres: one of them looks like millimetres
results-too-far-out = the { $which } cloud lies { $distance } m from the origin, too far to resolve its points
results-too-far-out-advice = Subtract a common offset from both clouds before exporting them
results-no-reference-cloud = the reference is a flat shape without a cloud
results-no-reference-cloud-advice = Enrol the part from a capture, a cloud or a mesh
results-pose-cancelled = the estimation was cancelled
results-pose-cancelled-advice = Start it again
results-little-overlap = only { $overlap } % of the source lies on the target, at least { $needed } % are needed
results-another-pose = another pose fits as well (its cost is { $ratio } times as high)
results-larger = what the camera sees is { $percent } % larger than the reference
results-smaller = what the camera sees is { $percent } % smaller than the reference
results-off-scale-advice = Check the unit of the camera's depths and its focal lengths (fx, fy): the pose is off by as many percent of the distance
results-loose = the pose is unconstrained: { $freedom }
results-unsettled = the pose was still moving after { $num } iterations
results-little-overlap-advice = Check that both clouds show the same thing and share at least half of it
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
results-group-pose = Pose
results-group-icp-ga = ICP-GA
results-group-acceptance = Acceptance
results-group-stand-off = Stand-off
results-segment-plane-distance = Plane distance
results-segment-plane-distance-help = The paper's d_t: a point closer than this (plus the noise) to a background plane belongs to it. Raising it removes what is near the wall.
results-segment-noise-at-1m = Depth noise at 1 m
results-segment-noise-at-1m-help = Standard deviation of the depth at 1 m; it grows with the depth squared. Used until a plane shows the real one.
results-segment-noise-factor = Noise factor
results-segment-noise-factor-help = How many standard deviations of noise still belong to a plane. Raising it removes what is near the wall, lowering it leaves specks of the wall.
results-segment-good-sample-probability = Good-sample probability
results-segment-good-sample-probability-help = The paper's p in eq. 1: the probability that at least one random sample is good. Raising it costs time.
results-segment-max-planes = Planes at most
results-segment-max-planes-help = Maximum number of background planes to remove: wall, floor and one more. Raising it costs time, and may take away a flat part.
results-segment-link-distance = Link distance
results-segment-link-distance-help = Neighbouring points further apart than this (plus the noise) are not connected. Raising it joins what hangs close to the part, lowering it tears the part.
results-segment-min-part-area = Least part area
results-segment-min-part-area-help = Smaller surfaces are no part. Raising it refuses small parts, lowering it takes clutter for parts.
results-segment-seed = Seed of the planes
results-segment-seed-help = Seed of the random samples. Another seed costs nothing; a verdict that changes with it rests on weak evidence.
results-project-pixel = Pixel
results-project-pixel-help = Side of a pixel of the binary image. Below the spacing of the points gaps appear; raising it blurs the outline.
results-project-closed-gap = Gap closed up to
results-project-closed-gap-help = Gaps up to this width are closed. Raising it fills narrow real openings.
results-contour-min-opening-area = Least opening
results-contour-min-opening-area-help = Smaller openings are treated as sensor dropouts. Raising it loses real openings.
results-signature-num-rays = Rays
results-signature-num-rays-help = Rays around the outline. More cost ranking time and resolve smaller detail.
results-signature-smoothing = Smoothing
results-signature-smoothing-help = The outline is averaged over this length before the rays are drawn. Raising it forgives ragged edges and rounds corners.
results-rank-matcher = Matcher
results-rank-matcher-help = Default: circular correlation of the rays as complex numbers, then overlap of the images. Paper: Algorithm 2, literally; it has no threshold of its own.
results-rank-num-overlaid = Placements laid over
results-rank-num-overlaid-help = Placements of each enrolled part that are laid over the scene's image. Raising it costs time and helps near-symmetric parts.
results-rank-outline-tolerance = Outline tolerance
results-rank-outline-tolerance-help = Distance of the outlines at which the score has dropped to 1/e. Raising it forgives outlines that differ.
results-rank-num-compared = Compared in full
results-rank-num-compared-help = Maximum number of enrolled references that are compared in full, the most similar in size and rough shape first. Raising it costs time in libraries of thousands and finds parts of which little is seen.
results-rank-parallel-from = All cores from
results-rank-parallel-from-help = Enrolled references from which all cores rank; the ranking stays the same. Lowering it costs time if starting them takes longer than ranking.
results-pose = Pose by
results-pose-help = Global: the best few parts are put in their place and looked for there. ICP: the paper's, from one start. None: the verdict rests on the outline alone and is quicker.
results-confirm-num-references = Parts looked for
results-confirm-num-references-help = Number of best-ranked parts to confirm in the scene. Raising it costs about 1.5 ms each and helps parts half hidden.
results-confirm-tolerance = Surface tolerance
results-confirm-tolerance-help = Distance from an enrolled part at which a point without noise still lies on it. Raising it forgives dents, and parts that are alike.
results-confirm-seed = Seed of the thinning
results-confirm-seed-help = Seed for thinning the points. Another seed takes other points and costs nothing.
results-icp-max-iterations = ICP iterations at most
results-icp-max-iterations-help = Most iterations of ICP. Raising it costs time in proportion.
results-icp-target-e-m2 = ICP target E
results-icp-target-e-m2-help = Algorithm 3 stops below this E; the paper's 1e-6 m² is 1 mm². Raising it ends the search earlier and coarser.
results-icp-max-source-points = ICP points at most
results-icp-max-source-points-help = Points of the scene's part that ICP uses, thinned evenly. Raising it costs time in proportion.
results-icp-shift-tolerance = ICP least shift
results-icp-shift-tolerance-help = A step that shifts by less than this (and turns little) ends the search. Raising it ends the search earlier.
results-icp-turn-tolerance = ICP least turn
results-icp-turn-tolerance-help = A step that turns by less than this (and shifts little) ends the search. Raising it ends the search earlier.
results-icp-ga-target-e-m2 = ICP-GA target E
results-icp-ga-max-rounds = Rounds at most
results-icp-ga-patience = Patience
results-icp-ga-least-progress = Least progress
results-icp-ga-vicinity-range = Vicinity
results-icp-ga-turn-range = Turns elsewhere
results-icp-ga-shift-range = Shifts elsewhere
results-icp-ga-num-fine-points = Points near
results-icp-ga-num-coarse-points = Points elsewhere
results-icp-ga-seed = ICP-GA seed
results-icp-ga-icp-max-iterations = Round: ICP iterations
results-icp-ga-icp-target-e-m2 = Round: ICP target E
results-icp-ga-icp-max-source-points = Round: ICP points
results-icp-ga-icp-shift-tolerance = Round: ICP least shift
results-icp-ga-icp-turn-tolerance = Round: ICP least turn
results-icp-ga-vicinity-population = Near: population
results-icp-ga-vicinity-generations = Near: generations
results-icp-ga-vicinity-tournament = Near: tournament
results-icp-ga-vicinity-crossover-rate = Near: crossover
results-icp-ga-vicinity-mutation-rate = Near: mutation
results-icp-ga-vicinity-mutation-decades = Near: mutation decades
results-icp-ga-vicinity-half-turn-rate = Near: half turns
results-icp-ga-elsewhere-population = Elsewhere: population
results-icp-ga-elsewhere-generations = Elsewhere: generations
results-icp-ga-elsewhere-tournament = Elsewhere: tournament
results-icp-ga-elsewhere-crossover-rate = Elsewhere: crossover
results-icp-ga-elsewhere-mutation-rate = Elsewhere: mutation
results-icp-ga-elsewhere-mutation-decades = Elsewhere: mutation decades
results-icp-ga-elsewhere-half-turn-rate = Elsewhere: half turns
results-accept-min-score = Accept from
results-accept-min-score-help = Minimum score. Raising it turns wrong verdicts into rejections, and some right ones too.
results-accept-min-likeness = Another make from
results-accept-min-likeness-help = A part that is not an enrolled one is named as another make of it from this likeness on. Raising it calls more of them unknown.
results-accept-min-margin = Margin at least
results-accept-min-margin-help = Minimum lead over the next part and over another pose: the difference of their probabilities where only one can be right. Raising it rejects parts that are alike.
results-accept-unknown-below = Unknown below
results-accept-unknown-below-help = A best match below this score is reported as unknown. Raising it names fewer parts that are half hidden.
results-accept-max-relief = Same model: relief
results-accept-max-relief-help = How far the surface may bulge or sink from the reference's. Raising it accepts other models, at an approximate pose.
results-accept-max-missing = Same model: missing
results-accept-max-missing-help = Share of the reference that may be missing from the scene. Raising it accepts other models, at an approximate pose.
results-accept-max-outline-shift = Same model: outline
results-accept-max-outline-shift-help = How far stretches of the outline may lie off the reference's. Raising it accepts other models, at an approximate pose.
results-accept-max-uncertainty = Pose uncertainty at most
results-accept-max-uncertainty-help = Largest bound (95 %) of the pose's shift. Raising it accepts poses that are known less exactly.
results-stand-off-taught = Taught distance
results-stand-off-taught-help = Distance of the nozzle from the part when its path was taught (the paper's standard d).
results-stand-off-nearest = Band from
results-stand-off-nearest-help = Nearest distance that still coats well. Raising it calls more of the path too near.
results-stand-off-farthest = Band to
results-stand-off-farthest-help = Farthest distance that still coats well. Raising it forgives more of the path.
results-stand-off-num-rays = Rays of the path
results-stand-off-num-rays-help = Points of the assumed path that are evaluated. Raising it costs about 2 µs each and finds a smaller worst spot.
results-option-default = Default
results-option-paper = Paper
results-option-global = Global
results-option-none = None
