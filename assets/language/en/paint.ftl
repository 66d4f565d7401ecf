## Part and coat
paint-no-part = The library has no part to paint
paint-no-such-part = { $part } is no longer in the library
paint-part = Part to paint: { $part }
paint-part-hint = The enrolled part that is painted
paint-recognised-gone = The part recognised last is no longer enrolled: choose the part to paint
paint-film-within = Film: { $share } % of the surface within { $target } ± { $tolerance } µm
paint-film-within-hint = Share of the paintable surface whose film is within the tolerance; good from { $least } % on
paint-side-none = Choose the side to be painted
paint-side-hint = The side that the gun paints, as seen by a camera in front of the part; stored with the part
paint-side-unclear-advice = Choose above from which side it is painted
paint-scope-one-side = Of the side that the camera saw when it was enrolled
paint-scope-all-around = Of this side; the part is known all around
paint-scope-several-sides = Of what faces one side; it was enrolled from several
paint-coat = Coat
paint-coat-changed = { $coat }, changed
paint-coat-named = Coat: { $coat }
paint-coat-name = Name of the coat
paint-saved-coat = Saved the coat { $coat }
paint-no-coat-folder = There is no folder for coats
paint-no-coat-folder-advice = Start the window as a user with a home folder

## What the film comes to
paint-thinnest-thickest = Thinnest · thickest
paint-mean = Mean
paint-missed = Missed
paint-double = Double
paint-paintable = Paintable surface
paint-landed = Solids on the part
paint-time = Time
paint-points = Points of the path
paint-histogram = Share of the surface by thickness
paint-histogram-hint = Share of the surface by thickness, in per cent of the target; green is within the tolerance

## Tools
paint-regions = Regions
paint-keep-out = Keep out
paint-box = Box
paint-keep-out-box = Keep out: box
paint-keep-out-lasso = Keep out: lasso
paint-brush = Brush
paint-keep-out-brush = Keep out: brush
paint-keep-out-hint = Drag around what gets no paint. Esc to rotate
paint-brush-hint = Drag over what gets no paint. Esc to rotate
paint-only = Paint only
paint-in-box = In a box
paint-only-box = Paint only: in a box
paint-in-lasso = In a lasso
paint-only-lasso = Paint only: in a lasso
paint-only-hint = Drag around the only area to be painted; several areas add up. Esc to rotate
paint-clear = Clear
paint-clear-hint = Remove all regions and what was moved by hand
paint-by-hand = Correct by hand
paint-move-stroke = Move stroke
paint-move-stroke-hint = Drag a stroke to where it should run. Esc to rotate
paint-move-point = Move point
paint-move-point-hint = Drag a point of a stroke; its neighbours follow. Esc to rotate
paint-turn-gun = Turn gun
paint-turn-gun-hint = Drag from a point of a stroke to lean the gun that way. Esc to rotate
paint-edits-dropped = What was moved by hand belonged to the previous path and was dropped
paint-edits-dropped-advice = Undo brings it back; correct the path by hand last
paint-drawn-dropped = What was drawn on { $part } in Paint was dropped
paint-drawn-dropped-undo = Undo brings it back
paint-drawn-dropped-again = The part was removed or enrolled anew; draw again what is still needed
paint-film-colours = Film colours
paint-film-colours-hint = Colour the part by the thickness of its film

## View and timeline
paint-view = 3-D view of the part and its spray path
paint-gun-off = gun off
paint-key-play = Run the gun along the path, or stop it
paint-key-back = To the previous stroke
paint-key-on = To the next stroke
paint-place-on = { $time } of { $end } · stroke { $stroke } of { $all } · gun on
paint-place-off = { $time } of { $end } · stroke { $stroke } of { $all } · gun off
paint-path-takes = { $length } m of path · { $paint } ml of paint
paint-timeline = Place of the gun on the path, seconds
paint-timeline-keys = Arrow keys move the gun, Space plays
paint-blocks-are-strokes = Blocks: gun on
paint-drag-to-move = Drag to move the gun

## The path
paint-planning = Planning the path
paint-not-planned = Not planned: choose the part again
paint-previous-path = Figures of the previous path
paint-proposing = Finding spacing and speed
paint-storing-side = Storing the side
paint-storing = Storing the path
paint-propose = Propose
paint-propose-hint = Find the row spacing and the speed that bring the film to its target
paint-export-hint = Write the path as a table
paint-export-title = Export the spray path
paint-store = Store with the part
paint-store-hint = Store the path with the part; inspections and robot programs use it from then on
paint-is-stored = This path is stored with the part
paint-planned-path = Planned
paint-stored-path = Stored, { $count } points
paint-unsaved = The regions drawn in Paint are not stored as a path

## The robot
paint-robot = Robot
paint-arm-group = Arm and nozzle
paint-cell-group = Cell and controller
paint-reach-group = Reach
paint-arm = Arm: { $arm }
paint-arm-hint = The arm whose reach is checked; without one, reach is not checked
paint-no-arm = No arm
paint-from-file = From a file…
paint-arm-title = Open an arm
paint-nozzle = Nozzle on the flange
paint-nozzle-hint = Where the nozzle's mouth is on the flange, z the way it points: a convention and six numbers, or the 16 numbers of a matrix
paint-example = e.g. { $example }
paint-no-nozzle-advice = Enter it under Nozzle on the flange, or choose no arm
paint-base = Base of the arm
paint-base-hint = Pose of the arm's base in the frame of the calibration, as KUKA writes it: turned by A about z, the vertical, then by B about the new y and by C about the new x. All 0: the two frames are the same
paint-base-number = Base of the arm: { $name }
paint-rail = Rail
paint-rail-hint = The rail that the arm stands on: axis of the calibration, from and to in mm and, if it moves along the path, top speed in mm/s and, if known, acceleration in mm/s². Empty: that of the arm's file
paint-no-obstacles = Only the part
paint-obstacles = Obstacles: { $file }
paint-obstacles-hint = What gun and arm must not run into besides the part: boxes of the cell and its floor, from a TOML file
paint-obstacles-title = Open the boxes of the cell
paint-more-robot = Tool, gun and speed
paint-tool = Tool on the controller
paint-tool-hint = A number for KUKA, FANUC and Yaskawa, a name for ABB and Doosan
paint-tilted = { $num ->
        [one] Gun tilted by up to { $degrees }° at { $num } point, to get past what the arm cannot follow.
       *[other] Gun tilted by up to { $degrees }° at { $num } points, to get past what the arm cannot follow.
    }
paint-changed-moves = Moves with the gun off: { $slower } slower than planned, { $joints } by joints.
paint-slower-spraying = { $num ->
        [one] Gun slowed on { $num } move while it sprays, so that the arm can follow; the film stays within its tolerance.
       *[other] Gun slowed on { $num } moves while it sprays, so that the arm can follow; the film stays within its tolerance.
    }
paint-not-calibrated = Calibrate the cell first, with Robot… at the top
paint-checking-reach = Checking the arm's reach
paint-arm-not-checked = Arm: not checked
paint-arm-reaches-all = Arm: 100 % of the path reached, all { $all } points
paint-arm-reaches-some = Arm: { $share } % of the path reached, all but { $missed } of { $all } points
paint-arm-reaches-hint = Share of the path's points that the arm reaches without a collision; good only if it reaches all
paint-acceleration-advice = Plan with a lower paint flow, run slower where it accelerates too slowly, or round the corners in a larger radius
paint-joints-advice = Try another angle of the nozzle, more tilt of the gun, another place of the base, or a lower speed
paint-collisions = Collisions
paint-collisions-not-checked = not checked
paint-no-collisions-reached = none where it reaches
paint-no-collisions-part = none with part and arm
paint-num-collisions =
    { $count ->
        [0] none
        [one] { $count } point
       *[other] { $count } points
    }
paint-show-unreached = Show next
paint-rail-moves = Along the path its rail is between { $from } and { $to } mm
paint-rail-at = At { $at } mm on its rail it would reach { $count }
paint-base-moved = With its base moved by { $by } mm it would reach { $count }
paint-apply-rail = Move the base there along the rail
paint-apply-base = Move the base there
paint-export-program = Program…
paint-export-program-hint = Write the path as a program for the robot's controller, for the part hung as it was enrolled
paint-program-title = Export a robot program
