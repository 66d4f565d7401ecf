# The Inspect workspace

## The verdict

inspect-unknown-part = Unknown part
inspect-not-recognised = Not recognised
inspect-no-verdict = No verdict
inspect-live-stopped = Live was stopped before a verdict counted
inspect-stopped-moving = something was moving when Live was stopped
inspect-press-capture = Press Capture
inspect-something-moves = something is moving in front of the camera
inspect-looking = Looking
inspect-not-long-enough = it has not been seen for long enough yet
inspect-it-is-steady = it is steady
inspect-not-accepted-yet = Not accepted yet
inspect-nearest = Nearest: { $part }
inspect-recognised = Recognised
inspect-hold-simulated = Simulated: no camera was read
inspect-hold-replayed = Replayed from a recording: the part does not hang there
inspect-hold-choose-camera = Choose a camera as the source
inspect-hold-choose-camera-operator = Ask the engineer to choose a camera
inspect-hold-not-calibrated = Not calibrated: the robot gets no pose
inspect-hold-not-calibrated-operator = Do not start the robot: call the engineer to calibrate the cell
inspect-hold-clock-operator = Do not start the robot: call the engineer to set the clocks
inspect-hold-old = Captured more than 10 minutes ago: it may hang elsewhere now
inspect-hold-old-file = From a file more than 10 minutes old: it may hang elsewhere now
inspect-hold-open-newer = Open a newer capture, or choose a camera as the source

## The card

inspect-previous-result = Previous result: a new inspection is running
inspect-outdated = Previous result: nothing has come from the source since
inspect-from-history = From the history, not the current part
inspect-other-empty-cell = The empty cell is from another camera and is not used; capture it again with this one
inspect-touches-edge = The part reaches the edge of the picture: some of it may be missing
inspect-approximate = The pose is approximate: this may be another model of the part
inspect-parts-accepted = { $num } of { $all } accepted
inspect-export = Export…
inspect-export-says = A report: JSON, a page of PDF, a row in a table of poses, and the pictures of all stages (Ctrl E)
inspect-wrong-part = Wrong part?
inspect-wrong-part-says = See in Compare why it was recognised as this part
inspect-why = Why?
inspect-why-says = See in Compare why it is not accepted
inspect-enrol-this = Enrol this part
inspect-add-reference = Add a reference
inspect-calibrate = Calibrate the cell
inspect-copy-pose = Copy pose
inspect-copy-pose-says = In the chosen convention, named on the first line (Ctrl Shift C)
inspect-score-itself = Score of the part itself, not of its mirror image
inspect-as-part = As { $part } (not accepted)
inspect-next = Next: { $part } { $score }
inspect-threshold = threshold { $score }
inspect-margin = Margin to the next part { $margin }
inspect-margin-says = Difference of the two probabilities if only one of the two parts can hang there; not the difference of the scores
inspect-offset = Offset from standard position
inspect-measured-from = Measured from { $part }, another reference of this part
inspect-offset-note = Part's centre, camera axes · R = Rz·Ry·Rx
inspect-fit = Fit
inspect-rms = rms
inspect-overlap = overlap
inspect-unconstrained = Unconstrained: { $freedom }
inspect-pose-uncertainty = pose uncertainty (95 %)
inspect-runner-up = runner-up pose
inspect-times-worse = { $ratio }× worse
inspect-as-good = as good
inspect-iterations = { $num ->
        [one] { $num } iteration
       *[other] { $num } iterations
    }
inspect-ambiguous = Another pose fits as well: check which way round the part hangs
inspect-surface = Surface
inspect-surface-is = Surface: { $verdict }
inspect-surface-advice = Look at the ringed regions before the part goes on
inspect-surface-region = deviating region
inspect-surface-frames = frames averaged
inspect-surface-seen = judged of what faces the camera
inspect-surface-noise = noise of the average
inspect-surface-smallest = dent { $width } wide, found from
inspect-inspection = Inspection
inspect-time = time
inspect-scene = scene
inspect-simulated = simulated
inspect-serial = serial
inspect-order = order
inspect-operator = operator
inspect-recipe = recipe

## Stand-off

inspect-stand-off = Stand-off of an assumed path
inspect-stand-off-stored = Stand-off of the stored path
inspect-mean = mean
inspect-worst-of = { $value }, worst { $worst }
inspect-in-band = inside the band
inspect-points-in-band = { $inside } of { $num } points
inspect-points-not-seen = Not checked at { $count } of { $all } points, where the camera does not see the part
inspect-path-not-seen = The camera sees the part at no point of the path
inspect-angle = angle
inspect-angle-counts = { $count ->
        [0] Inside the band also means an angle of at most { $limit }
        [one] Inside the band also means an angle of at most { $limit }; 1 point has a larger one
       *[other] Inside the band also means an angle of at most { $limit }; { $count } points have a larger one
    }
inspect-path-fits = The path fits without the pose
inspect-path-needs-pose = The robot program must apply the pose to the path
inspect-stand-off-of = Stand-off { $mean } of { $nearest } to { $farthest }

## The pose for the robot

inspect-robot-frame = The robot's base frame, by { $name }
inspect-camera-frame = The camera's frame: the cell is not calibrated
inspect-camera-frame-only = The camera's frame: a robot must not act on this result
inspect-convention-of = Convention: { $name }
inspect-convention-says = Convention of the pose as it is shown, copied and written; Robot… has that of the answers to robots
inspect-no-pose-to-copy = There is no pose to copy: the part was not accepted
inspect-no-pose-advice = Follow the advice on the card, then capture again
inspect-pose-copied = Copied { $name } in the convention { $convention }

## The view

inspect-colour = Colour · { $colouring }
inspect-show = Show
inspect-export-path = Export spray path…
inspect-export-path-says = Needs an accepted part with a stored spray path, and a calibrated cell
inspect-measure = Measure
inspect-measure-says = Click two points (M)
inspect-picture = Picture…
inspect-picture-says = Save a picture of the view (P)
inspect-fit-view = Fit
inspect-fit-view-says = Fit the part (F)
inspect-front = Front
inspect-top = Top
inspect-side = Side
inspect-part-axes = Axes of the part
inspect-part-camera = Depth camera
inspect-part-outline = Enrolled contour
inspect-part-nozzle-middle = Nozzle over the middle
inspect-part-nozzle-worst = Nozzle at the worst spot
inspect-part-spray-path = Spray path
inspect-part-shot-cameras = Cameras of the shots
inspect-part-unseen = Not seen by any shot
inspect-needs-pose = Needs a recognised part whose pose was found
inspect-needs-camera = Needs a single capture whose camera is known
inspect-needs-no-path = Needs an accepted part without a stored spray path
inspect-needs-path = Needs an accepted part with a stored spray path
inspect-needs-calibration = Needs a calibrated cell
inspect-needs-scan = Needs a scan
inspect-caption-planes = { $points } points · part { $part } · { $planes ->
        [one] 1 background plane removed
       *[other] { $planes } background planes removed
    }
inspect-caption-shots = { $points } points · part { $part } · { $shots } shots together
inspect-no-camera-read = { $scene } · no camera was read
inspect-view-of-scene = 3-D view of the scene
inspect-other-surface = Other surface
inspect-taught-nozzle = Assumed nozzle
inspect-worst = Worst
inspect-path-in-band = Spray path · { $inside } of { $num } in the band

## The stages

inspect-contour = Contour
inspect-signatures = Signatures
inspect-ranking = Ranking
inspect-alignment = Alignment
inspect-enlarge-segmentation = Enlarge segmentation
inspect-enlarge-binary-image = Enlarge binary image
inspect-enlarge-contour = Enlarge contour
inspect-enlarge-signatures = Enlarge signatures
inspect-enlarge-ranking = Enlarge ranking
inspect-enlarge-alignment = Enlarge alignment
inspect-enlarged = { $stage }, enlarged
inspect-enlarged-without = { $stage }, enlarged: { $why }
inspect-says-segmentation = background planes in dull colours, the part bright
inspect-says-binary-image = the part in the plane of its two longest axes
inspect-says-contour = outline, openings, rays from the centroid; dashed: the enrolled part
inspect-says-signatures = length L and angle Θ of the rays; dashed: the enrolled part
inspect-says-ranking = score of every enrolled part against the threshold
inspect-says-alignment = mean squared distance E per iteration, logarithmic
inspect-stages = Stages
inspect-not-reached = not reached
inspect-no-picture = no picture: the cloud has no rows and columns
inspect-not-examined = not examined
inspect-e-stayed-zero = E stayed at 0
inspect-ended-at = { $part } ended at rms { $rms }
inspect-papers-threshold = the paper's threshold, 1e−6 m²
inspect-not-asked-for = not aligned: no pose was asked for
inspect-flat-shape = not aligned: it is enrolled as a flat shape
inspect-no-pose-found = not aligned: no pose was found
inspect-score-too-low = not aligned: its score was too low to be tried
inspect-capture-cell = Press Capture for a frame of the simulated cell, or drop a captured scene here
inspect-capture-or-drop = Press Capture, or drop a captured scene here

## Shortcuts and files

inspect-does-redo = Redo the last undone change of the shots
inspect-does-undo = Undo the last change of the shots of a scan
inspect-does-picture = Save a picture of the 3-D view
inspect-does-contour = Show or hide the enrolled contour
inspect-does-nozzle = Show or hide the nozzle at the worst spot
inspect-does-copy = Copy the pose in the chosen convention
inspect-does-previous-part = Select the previous part of the frame
inspect-does-next-part = Select the next part of the frame
inspect-report-folder = Folder for the report of this inspection
inspect-save-picture = Save a picture of the view
inspect-pictures = Pictures
inspect-export-path-title = Export the spray path for the robot
inspect-saving-picture = Saving the picture
inspect-writing-report = Writing the report
inspect-writing-path = Writing the spray path
inspect-picture-saved = Saved the picture { $path }
inspect-no-spray-path = There is no spray path for the inspection in front
inspect-no-spray-path-advice = Store one with the part, and capture a part that is accepted
inspect-path-written = Wrote { $path }: { $inside } of { $num } checked points within the band, as { $convention }
inspect-path-not-written = No spray path was written: { $why }
inspect-report-written = Wrote { $files }, the pictures of its stages and a row of { $table } to { $folder }
inspect-report-set-aside = Wrote { $files }, the pictures of its stages and a row of { $table } to { $folder }; its last row was incomplete and was set aside in { $aside }
inspect-watching-folder = Watching a folder

## The values under the pointer

inspect-at-reading = Column { $column }, row { $row }: { $depth } from the camera
inspect-at-no-reading = Column { $column }, row { $row }: no reading
inspect-at-surface = x { $x }, y { $y }, height { $height }
inspect-at-plane = x { $x }, y { $y }
inspect-at-ray = x { $x }, y { $y } · from the centroid L { $length }, Θ { $angle }
inspect-at-iteration = Iteration { $iteration }: E { $e } m²
