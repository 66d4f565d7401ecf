## Before there is a draft
enrol-show-part = Show the part to enrol
enrol-capture-replacement = Capture the replacement for { $part }
enrol-how = Hang it in front of the camera and press Capture, open a capture, a cloud or a mesh, or drop its file here
enrol-take-shown = Take { $scene }, which Inspect shows
enrol-use-shown = Use the inspected scene
enrol-see-inspected = Saved: see it in Inspect
enrol-open-scan-hint = Several shots from several sides, each with the pose of its camera (Ctrl Shift O)
enrol-step-capture = 1  Capture the part, or open its file
enrol-step-correct = 2  See what is kept, and correct it
enrol-step-title = 3  Give it a title
enrol-step-save = 4  Save: inspections recognise it

## The card of the draft
enrol-new-part = New part
enrol-replaces = Replaces { $part }
enrol-previous-draft = Previous draft: a new one is being prepared
enrol-as-new = Enrol as a new part instead
enrol-unready-problem = Nothing can be saved yet: see above
enrol-unready-title = Give it a title first
enrol-unready-name = Fix the name first
enrol-unready-library = This library cannot be changed: see above
enrol-unready-unknown = What will be stored is not known yet
enrol-points-kept = { $points } points kept
enrol-outline = Outline { $length }
enrol-openings = Openings { $count }
enrol-seen-one-side = Seen from one side
enrol-seen-all-around = Seen from all around
enrol-seen-several-sides = Seen from several sides
enrol-painted-from-front = Painted from the front
enrol-painted-from-back = Painted from the back
enrol-painted-from-left = Painted from the left
enrol-painted-from-right = Painted from the right
enrol-painted-from-top = Painted from above
enrol-painted-from-bottom = Painted from below
enrol-examining = Examining the part…
enrol-stored-unknown = What will be stored is not known
enrol-look-again = Look again
enrol-title = Title
enrol-title-hint = Title, as people call it
enrol-title-full = A title has at most { $limit } characters; put the rest into the notes
enrol-name-hint = proposed from the title
enrol-notes = Notes
enrol-reference-of = One more reference of
enrol-reference-of-chosen = One more reference of: { $part }
enrol-reference-of-none = No other part
enrol-reference-choice = Reference of: { $part }
enrol-reference-of-hint = Another view or model of a part that is enrolled: verdicts name that part
enrol-namesake = { $part } has this name already
enrol-namesake-advice = Saving replaces it; the previous version can be restored
enrol-most-similar = Most similar: { $part } ({ $percent } % alike)
enrol-most-similar-mirrored = Most similar: { $part } (its mirror image { $percent } % alike)
enrol-distinguishable = The two can be told apart
enrol-indistinguishable = The two cannot be told apart
enrol-indistinguishable-advice = Inspections of either will be a near tie: store one more reference of that part, replace it, or capture a side on which they differ
enrol-replace = Replace { $part }
enrol-add-reference = One more reference of { $part }
enrol-discard = Discard
enrol-saving = Saving…
enrol-save-and-replace = Save and replace

## The meshes of a file
enrol-meshes = Meshes of { $file }
enrol-meshes-hint = Choose the parts to enrol: they become drafts one after the other
enrol-meshes-find = Find a mesh
enrol-meshes-find-hint = Words of its name
enrol-meshes-order = Sort by { $order }
enrol-meshes-size = Size
enrol-meshes-unit = Lengths in { $unit }
enrol-meshes-counted = { $shown } of { $count } meshes
enrol-meshes-none = No mesh has these words in its name
enrol-meshes-figures = { $size } · triangles: { $triangles }
enrol-meshes-enrol =
    { $count ->
        [0] Enrol meshes
        [one] Enrol { $count } mesh
       *[other] Enrol { $count } meshes
    }
enrol-meshes-whole = All as one part
enrol-meshes-whole-hint = The whole file shows one part
enrol-mesh-number = Mesh { $number } of { $count }
enrol-mesh-skip = Skip
enrol-mesh-leave-out = Leave out the rest

## The card of an enrolled part
enrol-rename = Rename
enrol-spray-path = Spray path…
enrol-remove-path = Remove the spray path
enrol-anew = Enrol anew
enrol-origin = Enrolled { $time } from { $source }, { $method }
enrol-origin-points = { $points } points
enrol-origin-simulated = simulated, not from a camera
enrol-origin-seen = seen by a camera
enrol-origin-path = spray path of { $count } points
enrol-origin-number = number for robots: { $number }

## The strip of enrolled parts
enrol-enrolled-parts = Enrolled parts
enrol-library-loading = The library is being loaded…
enrol-num-parts =
    { $count ->
        [0] No part is enrolled yet: the first one that is saved appears here
        [one] { $count } enrolled part
       *[other] { $count } enrolled parts
    }
enrol-damaged = Damaged
enrol-tile-reference = Ref. of { $part }
enrol-enrolled = Enrolled: { $part }
enrol-renamed-at = Renamed, { $time }
enrol-brought-back-at = Restored, { $time }
enrol-saved-at = Saved, { $time }
enrol-path-changed-at = New path, { $time }

## What corrects the draft
enrol-in-front = In front of background
enrol-everything = Everything
enrol-box = Box
enrol-box-hint = Drag a box in the 3-D view or the picture (D)
enrol-lasso-hint = Drag a lasso in the 3-D view or the picture (D, D)
enrol-keep = Keep
enrol-drop = Drop
enrol-add = Add
enrol-keep-hint = What lies outside is dropped
enrol-drop-hint = What lies inside is dropped
enrol-add-hint = Everything inside is taken, background too
enrol-drag-box = Draw a box
enrol-drag-lasso = Draw a lasso
enrol-picture-hint = { $drag } in this picture. { $does }. Click to take or drop a segment
enrol-view-hint = { $drag }. { $does }. It reaches through the whole part. Esc to rotate
enrol-picture = Picture of what is kept
enrol-mesh-is-whole = A mesh is enrolled whole: crop it in the program that made it
enrol-undo-step = Undo the last step
enrol-redo-step = Redo the last step
enrol-reset-all = Reset all corrections
enrol-both = Both
enrol-picture-pane = Picture
enrol-view-pane = 3-D
enrol-show-both = Show both
enrol-show-picture = Show picture
enrol-show-view = Show 3-d
enrol-segment-partly = { $segment } · { $kept } of { $all } kept
enrol-kept = kept
enrol-partly-kept = partly kept
enrol-dropped = dropped
enrol-take-it = Take it
enrol-drop-it = Drop it
enrol-segment-stand = Stand
enrol-segment-surface = Surface { $number }
enrol-segment-background = Background { $number }
enrol-segment-piece = Piece { $number }
enrol-segment-specks = Specks
enrol-segment-mesh = Mesh
enrol-segment-cell = Cell around it
enrol-view = 3-D view of the draft

## Keys
enrol-key-redo = Redo the last undone change
enrol-key-undo = Undo the last correction; without a draft, the last change of the library
enrol-key-save = Save the part
enrol-key-draw = Draw a box; again: a lasso
enrol-key-rotate = Turn the 3-D view by dragging again

## Work and notices
enrol-path-file-title = The nozzle's path over this part
enrol-path-files = Tables
enrol-examining-part = Examining the part
enrol-taking-scan = Taking the scan in front
enrol-taking-scene = Taking the scene in front
enrol-live-stopped = Live stopped: the next file is for Enrol
enrol-live-stopped-advice = Afterwards, press L to start Live again
enrol-changing-library = Changing the library
enrol-unsaved = The part in Enrol is not saved
enrol-unsaved-titled = { $part }, the part in Enrol, is not saved
enrol-bringing-back = Bringing back the draft
enrol-writing-draft = Keeping the draft
enrol-draft-back = The unsaved draft is back
enrol-draft-differs = The draft now keeps other points: its scene or the recipe has changed
enrol-draft-differs-advice = Check what is kept before you save the part
enrol-draft-no-scene = The scene of the unsaved draft cannot be restored
enrol-draft-no-scene-advice = Take the part again: the title, name and notes that you entered are kept
enrol-draft-not-used = The draft is not used: { $why }
enrol-draft-set-aside = It was moved to { $path }
enrol-draft-not-kept = The draft is not kept: { $why }
enrol-draft-too-large-advice = Save the part, or undo some corrections
enrol-nothing-to-save = There is nothing to save yet
enrol-nothing-to-save-advice = Save once the picture of what will be stored is there
enrol-outline-nothing = The outline changed nothing
enrol-outline-nothing-advice = Draw it around points that can be kept or dropped, or undo it
enrol-other-program = Another program has saved a part named { $name } since this library was opened
enrol-other-program-advice = Save again to replace it, or give this one another name
enrol-changed-since = { $part } was left as it is: another window or program has changed it since
enrol-changed-since-advice = Open it among the enrolled parts to rename or remove it
enrol-saved = Saved { $part }
enrol-saved-over = Saved { $part }; the previous version is kept in the library's trash
enrol-saved-over-path = Saved { $part }; the previous version is kept in the library's trash, and its spray path with it: store one for the new frame
enrol-title-changed = Changed the title of { $part }
enrol-removed = Removed { $part }
enrol-brought-back = Brought back { $part }
enrol-stored-path = Stored a spray path of { $count } points with { $part }
enrol-removed-path = Removed the spray path of { $part }
enrol-undone = Undone: “{ $what }”
