# Enrolling

## Names that are not valid

name-empty = the name is empty
    .advice = { name-advice }
name-too-long = the name has { $found } characters, at most { $limit } are allowed
    .advice = { name-advice }
name-bad-character = { $name } is not a valid name: it contains { $character }
    .advice = { name-advice }
name-bad-beginning = { $name } is not a valid name: it begins with { $character }
    .advice = { name-advice }
name-reserved = { $name } is not a valid name: Windows reserves it for a device
    .advice = { name-advice }
name-advice = Use up to { $most } lowercase letters, digits, _ and -, for example { $example }

## Warnings about a part

enrol-touches-edge = the part reaches the border of the view, so some of it may be missing
    .advice = Move the camera back or centre the part, then enrol it again
enrol-background = this may be background: { background-sign }
    .advice = Check the picture, and take the part instead if it is not
enrol-on-background = { $percent } % of what is kept lies on the wall, the floor or another plane that was removed
    .advice = Drop what is background: an inspection removes it and compares the rest
enrol-apart = { $percent } % of what is kept lies apart from the rest
    .advice = Drop what does not belong to the part
enrol-too-little = there is too little of the part to recognise it by: this same view would score { FIXED($score, 2) }, and { FIXED($needed, 2) } is needed
    .advice = Enrol more of the part: move the camera back, or enrol several frames as a scan
enrol-unconstrained = the shape does not fix the pose: { free-motion }
    .advice = Enrol more of the part, so that corners or openings constrain its pose
enrol-symmetric = the part looks the same turned by { $degrees }°, so its pose cannot be told from that one
    .advice = Enrol and inspect it with something in view that tells the two poses apart, such as a bracket or a cut-out: without that, no robot gets its pose
enrol-side-unclear = it is not clear which side of the part is the outside
    .advice = Choose the side to be painted in Paint, before a path is planned
    .command-advice = Give the side to be painted: --side { $one } or --side { $other }
enrol-goes-on-unseen = { $percent } % of the scanned surface's outline is where the view of every frame ends: the part may continue there
    .advice = Add frames that show the missing sides, then enrol it again
background-sign = { $sign ->
        [behind] it lies behind other surfaces along { PERCENT($share, 0) } % of its border
        [cut] the view cuts it off on { $sides } sides
       *[other] it is a flat surface of { FIXED($area, 2) } m²
    }

## Why a part cannot be enrolled

reference-no-outline = the cloud of { $num_points } points has no outline from any side
    .advice = Check that the cloud shows the surface of one part and is in metres
reference-too-large = the part spans { FIXED($found, 1) } m, expected at most { FIXED($limit, 0) } m
    .advice = Export it in metres (these look like millimetres), or cut the one part out of its scene
not-enrolled-background = the surface found may be background: { background-sign }
    .advice = Choose the surface that is the part
    .command-advice = Select the surface that is the part with --segment N, or choose it in the window's Enrol workspace
not-enrolled-no-such-surface = the scene has no surface { $wanted }; { $found } were found
    .advice = Choose one of those found
not-enrolled-too-few-points = { $found ->
        [one] the cloud has { $found } point, at least { $needed } are needed
       *[other] the cloud has { $found } points, at least { $needed } are needed
    }
    .advice = Capture the part from closer, or export the cloud with more points
not-enrolled-too-few-kept = { $found ->
        [one] { $found } point is kept, at least { $needed } are needed
       *[other] { $found } points are kept, at least { $needed } are needed
    }
    .advice = Take back what was dropped: Undo, Reset, or Add
not-enrolled-no-part-in-scan = no part was found in any of the { $num_frames } frames
    .advice = Keep the part with Add and a box or a lasso, or capture it at least 10 cm in front of the background
    .command-advice = Look at the fused cloud (partsight scan DIR --out scan.ply), and capture the part at least 10 cm in front of the background
not-enrolled-no-area = the mesh of { $num_triangles } triangles has no area
    .advice = Export the mesh again with its faces

## What a mesh was found to be

enrolled-closed-sheet = closed sheet, about { MM($thickness_m, 1) } mm thick
enrolled-open-surface = open surface without thickness ({ $percent } %): it is recognised from both sides
enrolled-turned = turned: { $percent } % of its triangles faced inwards
enrolled-hidden = { $percent } % of its surface is inside, where no camera sees it, and is left out

## What was enrolled

shared-title = { $other } has the title "{ $title }" too
    .advice = Choose another title: verdicts and lists tell parts apart by it
enrolled-from-segmented = the part found in a captured scene
enrolled-from-whole-cloud = a whole cloud
enrolled-from-mesh = a mesh
enrolled-from-scan = a scan
renamed = Renamed { $before } to { $now }
no-such-part = the library has no part { $name }
mesh-no-area = { $path }: the mesh has no area
    .advice = { not-enrolled-no-area.advice }
