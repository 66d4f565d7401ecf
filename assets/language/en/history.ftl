## The list
history-empty-advice = Press Capture: every inspection is listed here and kept when the window closes
history-in-memory = Kept in memory only: { $reason }
history-none-listed = No matching inspections: change the filter
history-column-score = Score
history-column-ms = ms
history-column-time = Time
history-part-again = { $part } · again { $count }×
history-row =
    { $count ->
        [0] Inspection { $number }: { $part }, { $verdict }
        [one] Inspection { $number }: { $part }, { $verdict }, inspected again once
       *[other] Inspection { $number }: { $part }, { $verdict }, inspected again { $count } times
    }

## The bar above the list
history-show-all = Show all
history-counted = { $count ->
        [one] { $matching } of { $count } entry
       *[other] { $matching } of { $count } entries
    }
history-export-csv-hint = Write the listed inspections to a table
history-export-cases = Export cases…
history-export-cases-hint = Save the listed inspections that have a frame and an actual part as cases, for Compare and partsight evaluate
history-statistics = Statistics
history-statistics-hint = OK and NOK by shift, by part and by reason, of what is listed; simulated frames only where nothing else is listed
history-frames-button = Frames…
history-frames-button-hint = Which frames are kept, and how long
history-find = Find
history-find-hint = Part, serial, scene
history-filter-days = Days
history-filter-all-verdicts = All
history-filter-all-parts = All
history-days-all = All days
history-days-week = 7 days
history-days-month = 30 days
history-days-typed = From … to
history-from = from
history-to = to
history-first-day = First day
history-last-day = Last day
history-day-format = Write a day as year-month-day: 2026-11-20

## The inspection on the right
history-choose = Choose an inspection to see more of it
history-inspection = Inspection { $number }
history-no-picture = Its scene has no rows and columns, so there is no picture of it
history-picture = Segmentation of inspection { $number }
history-of-part = Inspections of this part
history-counts = counts
history-of-this-part = Of this part: inspection { $number }, { $verdict }
history-found-same = Inspection { $number } found the same
history-found-other = Inspection { $number } found something else
history-figure-source = source
history-figure-time = time
history-figure-serial = serial
history-figure-score = score
history-figure-margin = margin
history-figure-library = library
history-figure-program = program
history-figure-frame = frame
history-figure-verdict = verdict
history-figure-nearest = nearest
history-frame-not-kept = not kept
history-frame-lost = not kept: { $why }
history-frame-kept = kept, { $megabytes } MB
history-rz = rz, of Rz·Ry·Rx
history-stage-segment = segment
history-stage-project = project
history-stage-contour = contour
history-stage-signature = signature
history-stage-rank = rank
history-stage-pose = pose
history-stage-total = total
history-times = Times
history-open = Open
history-open-hint = Open with every stage, using its own recipe
history-again = Inspect again
history-again-hint = Use the current recipe and library; changes are shown here
history-frame-gone = The frame of { $scene } is not kept
history-frame-gone-advice = Keep more frames from now on: Frames… above the list
history-actual-part = Actual part
history-labelled = Stored in the history. Actual part: { $part }
history-label-undone = Undone: the actual part is as before
history-remark = Remark
history-your-remark = Your remark

## What differs
history-differences = Inspected again
history-same-today = Same result today
history-other-today = Different result today
history-then = then
history-today = today
history-pose-differs = The pose differs by { $shift } and { $rotation }

## Keys
history-key-newer = The newer inspection
history-key-older = The older inspection
history-key-open = Open it with all its stages
history-key-again = Inspect it again with the current recipe and library

## Frames to keep
history-keep-title = Frames to keep
history-keep-why = With its frame an inspection can be opened again with every stage. The inspections themselves are kept for good. "Not accepted" also keeps the frames of the newest { $num } accepted parts, so that a wrong one can be labelled later.
history-keep-which = From which inspections
history-keep-days = At most, days
history-keep-gigabytes = At most, gigabytes
history-keep-used =
    Now: { $count ->
        [one] 1 frame
       *[other] { $count } frames
    }, { $size }. The oldest go first
history-keep-marked = Those with a remark or an actual part stay: { $size }

## Statistics
history-none-counted = No matching parts: change the filter
history-by-part = By part
history-by-rack = By rack
history-by-reason = By reason
history-ok-share = OK, %
history-shift = Shift of { $start }: { $ok } OK, { $nok } NOK
history-by-shift = Parts by shift
history-not-ok-on-top = NOK, on top
history-total = { $count ->
        [one] { $count } part, { $share } OK
       *[other] { $count } parts, { $share } OK
    }
history-total-of-shifts = { $count ->
        [one] { $shifts } shifts: { $count } part, { $share } OK
       *[other] { $shifts } shifts: { $count } parts, { $share } OK
    }
history-others-left-out =
    { $count ->
        [one] 1 part of another source is not counted
       *[other] { $count } parts of other sources are not counted
    }
history-no-part-left-out =
    { $count ->
        [one] 1 entry without a part is not counted
       *[other] { $count } entries without a part are not counted
    }
history-not-judged-left-out =
    { $count ->
        [one] 1 part was not judged and is not counted: too few of its frames were inspected
       *[other] { $count } parts were not judged and are not counted: too few of their frames were inspected
    }
history-drift = Drift: { $part }
history-drift-needs = Drift is shown for a part that was accepted at least { $count } times
history-drift-shift-bound = Bound of the position error, 95 %
history-drift-fit = Fit to the reference, rms
history-drift-place-along = Place of the part along { $axis }
history-drift-mean = mean
history-drift-limit = limit
history-drift-band = { $name }: mean { $mean }, 3σ from { $from } to { $to }
history-drift-band-limit = { $name }: mean { $mean }, 3σ from { $from } to { $to }, limit { $limit }
history-drift-place = Place of the part, mean ± 3σ: x { $x }, y { $y }, z { $z }
history-drift-trend = { $name }: trend from { $from } to { $to } over the newest { $count } inspections
history-drift-warning =
    { $count ->
        [0] { $part } drifts: at this trend, single parts are refused from now on ({ $name }, limit { $limit })
        [one] { $part } drifts: at this trend, single parts are refused after 1 more inspection ({ $name }, limit { $limit })
       *[other] { $part } drifts: at this trend, single parts are refused after { $count } more inspections ({ $name }, limit { $limit })
    }
history-drift-warning-advice = Look for the cause before: clean the window of the camera, then check the cell (Robot…, Check of the cell), the hangers and the parts

## Work and notices
history-looking = Looking into the history
history-export-csv-title = Export the listed inspections
history-export-cases-title = Folder for the cases of the listed inspections
history-wrote =
    Wrote { $count ->
        [one] one inspection
       *[other] { $count } inspections
    } to { $path }
history-no-cases = No inspection became a case: { $what }
history-no-cases-advice = Set the actual part of some inspections, and keep their frames
history-wrote-cases = { $what } in { $path }
history-cases-kept = cases: { $new } new, { $updated } updated, { $unchanged } unchanged
history-cases-without-truth = { $count } without a true label
history-cases-without-frame = { $count } whose frame is not kept
history-cases-scans = { $count ->
        [one] { $count } that is a scan
       *[other] { $count } that are scans
    }
history-cases-unreadable = { $count } whose frame cannot be read
history-crowded = The history cannot keep up: the frames of some inspections were not saved
history-crowded-advice = Keep fewer frames (Frames… in History), or use a faster disk
history-set-aside = The history: { $what }
history-set-aside-advice = It was set aside as { $path }; a new one was started
history-failed-advice = { $advice }; until then inspections are kept in memory
history-works =
    The history is writable again: saved { $count ->
        [one] one inspection
       *[other] { $count } inspections
    } that waited
history-works-lost =
    The history is writable again: saved { $count ->
        [one] one inspection
       *[other] { $count } inspections
    } that waited, lost { $lost ->
        [one] one inspection
       *[other] { $lost } inspections
    }
history-swept =
    The retention rule removed { $count ->
        [one] 1 frame
       *[other] { $count } frames
    }, { $megabytes } MB, from the history
history-inspecting-again = Inspecting { $scene } again
history-other-version = The recipe of { $scene } was written by another version of Partsight
history-other-version-advice = Press Inspect again to use the current recipe
history-changed-frame = its file or frame
history-changed-recipe = the recipe
history-changed-library = the library
history-changed-program = the program
history-changed-both = { $first } and { $second }
history-other-result = { $scene } now gives a different result: { $changed } has changed since
history-other-result-advice = The history keeps the first result
