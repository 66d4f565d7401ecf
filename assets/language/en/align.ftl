## What is aligned
align-moved-copy = Moved copy
align-files = Two files
align-run = Run
align-run-hint = Align by every method (R)
align-view-menu-hint = Of all 3-D views
align-library-failed = The library could not be loaded
align-part-hint = The enrolled part that is the reference
align-start = Start
align-custom = Custom…
align-random = Random
align-random-hint = The next random start
align-random-prefix = No.
align-random-number = Random start number { $number }
align-numbers = rx { $rx }°, ry { $ry }°, rz { $rz }°, then x { $x } mm, y { $y } mm, z { $z } mm
align-custom-hint = rx ry rz x y z, for example 0 0 30deg 100mm 0 0
align-custom-label = Custom start, six numbers
align-use-start = Use this start
align-custom-units = Radians and metres, or with a unit: deg, mm, cm, m; R = Rz·Ry·Rx
align-scene-part = { $scene }: the part found, { $count } points, from where it lies
align-source = Source
align-target = Target
align-source-hint = The cloud or mesh that is moved
align-target-hint = The cloud or mesh that stays
align-custom-start = custom start
align-random-start = random start { $seed }
align-from = { $part } from { $start }
align-library-has-no-part = The library has no part: enrol one in the Enrol workspace
align-nothing-inspected = Nothing inspected yet: press Capture
align-no-part-in-scene = No part was found in the scene: capture another
align-choose-source = Choose the file that is moved: Source…
align-choose-target = Choose the file that stays: Target…

## The views
align-view-of = 3-D view, { $method }
align-previous-result = Previous result: a new alignment is running
align-at-work = At work…
align-not-run = Not run
align-figures = E { $e } m² · rms { $rms } on { $overlap } % · { $time } ms
align-no-pose-figures = No pose · { $time } ms
align-end = { $count ->
        [one] End, after { $count } iteration
       *[other] End, after { $count } iterations
    }
align-iteration-e = Iteration { $iteration } of { $last } · E { $e } m²
align-aligning-now = Aligning…
align-nothing-aligned = Nothing aligned yet
align-nothing-aligned-advice = Choose a part and a start above, then press Run
align-ended-below-threshold = { $count ->
        [one] Threshold reached: E < 1e-6 m², { $count } iteration
       *[other] Threshold reached: E < 1e-6 m², { $count } iterations
    }
align-ended-below-threshold-says = Algorithm 3 stops once E (eq. 12) is below 1e-6 m²
align-ended-elsewhere = { $count ->
        [one] Converged elsewhere after { $count } iteration
       *[other] Converged elsewhere after { $count } iterations
    }
align-ended-elsewhere-says = The last step was below the limit, but more than 5° from the true pose: a local minimum of E
align-ended-converged = { $count ->
        [one] Converged after { $count } iteration
       *[other] Converged after { $count } iterations
    }
align-ended-converged-says = The last step was below the limit: the pose no longer changes
align-ended-above-threshold = { $count ->
        [one] Threshold not reached: best of { $count } iteration
       *[other] Threshold not reached: best of { $count } iterations
    }
align-ended-above-threshold-says = Algorithm 3 stops once E is below 1e-6 m². E stayed above, and the last rounds found no better pose: this is the best one. The noise of a camera alone keeps E above the threshold, however good the pose is
align-ended-limit = Maximum number of iterations: { $count }
align-ended-limit-says = The pose still changed in the last step
align-nearer-or-same-part = Choose a start that is nearer, or check that both clouds show the same part in metres
align-which-way-round = Check which way round the part lies
align-look-for-edge = Look for an edge or a bend that only one place of the part has
align-other-method = Try another method, or a start that is nearer
align-nearer-start = Choose a start that is nearer

## The plot
align-genetic-search = genetic search
align-threshold = threshold 1e-6 (Algorithm 3)
align-iteration = iteration { $iteration } of { $last }
align-iteration-hint = iteration { $iteration } of { $last } · drag to scrub, P to play
align-scrubber = Iteration shown
align-scrubber-keys = E per iteration. Left and right go one iteration, Page Up and Page Down ten, Home and End to the ends, P plays
align-no-way = No method found a pose: there is nothing to show
align-way = Press Run to see how the mean squared distance E falls, iteration by iteration

## Table I
align-table = Table I
align-table-says = Every enrolled part from T1 to T5 (eq. 15), moved and brought back by every method: E in m², the best of a row marked
align-cancel-table = Cancel Table I
align-run-table = Run Table I
align-go-on = Go on
align-go-on-table = Go on with Table I
align-again = Run again
align-table-again = Run Table I again
align-rows-done-left = { $done } of { $total } done · about { $time } left
align-rows-done = { $done } of { $total } done
align-rows = { $total ->
        [one] { $total } row
       *[other] { $total } rows
    }
align-rows-stopped = Stopped at { $done } of { $total }
align-rows-all = All { $total } done
align-column-part = part, start
align-none = none
align-best = best
align-no-pose = no pose
align-true-error = True error at this start
align-uncertainty = Uncertainty of the alignment (95 %)
align-uncertainty-says = How far off these poses may be, by the points of the two clouds alone. Inspect also uses the outline in the picture, so the uncertainty of its pose is usually smaller
align-method = method
align-rotation = rotation
align-shift = shift
align-unconstrained = unconstrained
align-copy = Copy
align-copy-hint = Table I as text, cells separated by tabs

## Keys
align-key-run = Run every method
align-key-play = Play or pause the iterations
align-key-back = One iteration back
align-key-on = One iteration on
align-keys-play = P, or Space on the plot
align-keys-back = , or ← on the plot
align-keys-on = . or → on the plot

## Work and notices
align-open-title = Open a cloud or a mesh
align-export-title = Export Table I
align-aligning = Aligning
align-copied = Copied Table I
