# The operator's view
operator-ok = OK
operator-not-ok = NOK
operator-parts-ok = { $num } of { $all } OK
operator-parts-recognised = { $num } of { $all } recognised
operator-opening-camera = Opening the camera…
operator-no-camera = No camera
operator-no-camera-next = Check the plug and the power of the camera. If it persists, call maintenance
operator-no-folder = Folder not reachable
operator-no-folder-next = Check the network drive or the share. If it persists, call maintenance
operator-lost = Partsight keeps trying
operator-inspecting = Inspecting…
operator-no-result = No result
operator-no-result-next = Ask the engineer, or press Capture to try again
operator-unreadable = { $file } cannot be read
operator-unreadable-next = Save the capture to the folder again; if it persists, ask the engineer
operator-no-parts = No parts enrolled
operator-ask-to-enrol = Ask the engineer to enrol the parts
operator-no-new-file = No new file in the folder yet
operator-save-capture = Save a capture to the folder: it is inspected automatically
operator-nothing-captured = Nothing was captured yet
operator-ready = Ready
operator-nothing-inspected = Nothing was inspected yet
operator-counts-no-longer = The last verdict no longer counts
operator-hang-and-capture = Hang a part and press Capture
operator-follow-current = Press Live or Capture for the current part
operator-file-next = From a file: check that it shows this part as it hangs, then start the robot
operator-check-part-next = Check the part, then start the robot
operator-start-robot = Start the robot
operator-recognised = Recognised, and its pose is known
operator-reported-wrong = Reported as wrong
operator-reported-wrong-next = Do not start the robot: tell the engineer
operator-next = Next
operator-last-parts = Last parts of this shift
operator-none-yet = None yet
operator-counting = Counting…

## What an operator can do about it

operator-then-capture = Then press Capture
operator-then-open = Then open the new capture
operator-next-file = The next file is inspected automatically
operator-reaches-edge = It reaches the edge of the picture: hang it so that all of it is in the picture
operator-reaches-edge-ok = Not all of it is in the picture
operator-approximate-ok = Maybe another model

## The bars above and below

operator-locked-says = Locked: asks for the PIN (Ctrl K)
operator-history-says = All parts that were inspected
operator-shift-since = Shift since { $time }
operator-shift-says = Parts that hung in front of this source since the shift began, each counted once. An empty cell is no part; opened files and single captures of the simulated cell do not count. OK: accepted, and not reported as wrong. The statistics of the history count the same
operator-num-parts = { $num ->
        [one] { $num } part
       *[other] { $num } parts
    }
operator-num-ok = { $num } OK
operator-num-not-ok = { $num } NOK
operator-num-not-judged = { $num } not judged
operator-stop-live-says = Stop inspecting every part automatically (L)
operator-live-says = Inspect every part automatically once it hangs still (L)
operator-wrong-part = Wrong part?
operator-wrong-part-says = Say which part it really is
operator-wrong-part-not-now = Available once the part on the screen has a verdict
operator-back = Back
operator-back-says = Back to the part, without a change (Esc)
operator-which-part = { $part }, { $time }: which part is it really?
operator-find-part = Find a part
operator-no-such-part = No part has this name
operator-none-of-these = None of these
operator-none-of-these-says = The part is not enrolled
operator-recognised-as-this = Recognised as this
operator-labelled-as-this = Actual part so far
operator-source = Source: { $source }
operator-serial = Serial
operator-serial-hint-this = for this part
operator-serial-hint-next = for the next part
operator-serial-for-next = For the next part that is inspected
operator-serial-entered = Serial number { $serial } is for the next part
operator-serial-of-part = Serial number { $serial } → { $part }, { $time }
operator-serial-move-next = Give it to the next part
operator-serial-move-this = Give it to this part
operator-serial-known = { $serial } is already the number of this part
operator-serial-in-shift = { $serial } is already the number of a part of this shift
operator-serial-in-shift-next = Check it: scan the right number if this one is wrong
operator-serial-replaced = { $serial } replaces { $former }, which no part has yet
operator-serial-replaced-next = If { $former } was right, scan it again
operator-robots-without-pose = Robots get no pose: ask the engineer to calibrate the cell
operator-robots-without-frames = Robots get no frames: press Live
operator-robots-without-source = Robots get no frames: ask the engineer to choose a camera
operator-not-recorded = Not recorded
operator-not-recorded-says = The history cannot be written: ask the engineer. Until then inspections are kept in memory only
