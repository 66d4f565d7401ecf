# Surfaces

## Verdicts

surface-ok = OK
surface-not-judged = not judged
surface-rework = rework
surface-scrap = scrap

## What a region is

region-dent = dent
region-bump = bump
region-missing = missing surface

## Why a surface is not judged

surface-little-in-sight = only { PERCENT($seen, 0) } % of this side of the part is seen well enough, { PERCENT($needed, 0) } % are needed
    .advice = Turn the part towards the camera and bring all of it into the picture
surface-too-far = from { FIXED($distance_m, 1) } m only deviations above { MM($certain_m, 1) } mm are certain, { MM($needed_m, 1) } mm are to be found
    .advice = Move the camera to { FIXED($nearer_m, 1) } m from the part
surface-too-noisy = { $num_frames ->
        [1] in one frame
       *[other] in { $num_frames } averaged frames
    } only deviations above { MM($certain_m, 1) } mm are certain, { MM($needed_m, 1) } mm are to be found
    .advice = Average more frames of the standing part, enrol it from averaged frames or its CAD mesh, or allow a larger tolerance
deviation-no-picture = the readings are no picture of a known camera
    .advice = Check the surface in a depth image or an organised cloud
deviation-frames-differ = the frames to be averaged are of different sizes or cameras
    .advice = Average frames that one camera took of the part while both stood still
deviation-moved = between the frames to be averaged, the part moved by { MM($by_m, 1) } mm, at most { MM($limit_m, 1) } mm are allowed
    .advice = Average frames of a part that hangs still
deviation-no-surface = the reference has no surface with normals
    .advice = Enrol the part from a capture, a cloud or a mesh
deviation-little-seen = only { PERCENT($seen, 0) } % of the reference is seen well enough to be measured, { PERCENT($needed, 0) } % are needed
    .advice = Turn the part towards the camera and bring all of it into the picture
