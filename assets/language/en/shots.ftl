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

## Files

shots-add-a-frame = Add a frame to the scan
shots-poses-file = File of the poses of the shots
shots-poses = Poses
shots-at-least = A scan needs at least { $num } shots
shots-take-another = Take another shot back first
shots-putting-together = Putting the shots together
shots-adding = Adding { $name }
