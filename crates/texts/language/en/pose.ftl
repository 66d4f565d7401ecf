# Poses

## Why there is no pose

pose-too-few-points = { $found ->
        [one] the { cloud-role } cloud has { $found } point, at least { $needed } are needed
       *[other] the { cloud-role } cloud has { $found } points, at least { $needed } are needed
    }
    .advice = Capture the part again from closer, or enrol it again
pose-degenerate = the { cloud-role } cloud does not determine the pose: its points lie on a line or a spot ({ FIXED($width_m, 5) } m wide)
    .advice = Use a cloud that shows a surface, not a line or a single spot
pose-one-sided-pairs = the closest points of all { $num_pairs } pairs lie on a spot or a line, { MM($rms_m, 1) } mm apart
    .advice = { pose-no-overlap.advice }
pose-no-overlap = { $found ->
        [one] the clouds have only { $found } pair of points within { MM($reach_m, 1) } mm, at least { $needed } are needed
       *[other] the clouds have only { $found } pairs of points within { MM($reach_m, 1) } mm, at least { $needed } are needed
    }
    .advice = Check that both clouds show the same part in metres
pose-sizes-differ = one cloud is { FIXED($ratio, 0) } times as large as the other
    .advice = Export both in metres: one of them looks like millimetres
pose-too-far-out = the { cloud-role } cloud lies { FIXED($distance_m, 0) } m from the origin, too far to resolve its points
    .advice = Subtract a common offset from both clouds before exporting them
pose-no-reference-cloud = the reference is a flat shape without a cloud
    .advice = Enrol the part from a capture, a cloud or a mesh
pose-cancelled = the estimation was cancelled
    .advice = Start it again

## Why a pose should not be relied upon

pose-little-overlap = only { PERCENT($overlap, 0) } % of the source lies on the target, at least { PERCENT($needed, 0) } % are needed
    .advice = Check that both clouds show the same thing and share at least half of it
pose-ambiguous = another pose fits as well (its cost is { FIXED($ratio, 2) } times as high)
    .command-advice = Give a start near the right pose
pose-off-scale = what the camera sees is { PERCENT($by, 0) } % { $is_larger ->
        [true] larger
       *[false] smaller
    } than the reference
    .advice = Check the unit of the camera's depths and its focal lengths (fx, fy): the pose is off by as many percent of the distance
pose-loose = the pose is unconstrained: { free-motion }
    .command-advice = Use clouds that show more of the part: an edge, a bend, a corner
pose-unsettled = the pose was still moving after { $num_iterations } iterations
    .command-advice = Run it again with the pose found as its start

## Why there is no stand-off

stand-off-no-surface = the enrolled part has no surface with normals
stand-off-none-meets = none of { $num_taught } assumed nozzle positions points at the part

## Parts of these texts

free-motion = { $motion ->
        [slide] { $axis ->
            [long] it can slide along its long side
            [short] it can slide along its short side
           *[other] it can move square to its surface
        }
        [turn] { $axis ->
            [long] it can turn about its long side
            [short] it can turn about its short side
           *[other] it can turn about the axis square to its surface
        }
       *[other] it can slide or turn
    }
cloud-role = { $which ->
        [source] source
       *[other] target
    }

## Which clouds
pose-onto = { $source } onto { $target }
