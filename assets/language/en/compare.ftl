## The case in front
compare-case = Case
compare-case-hint = Which scene is looked at
compare-no-case = none
compare-in-front = { $scene } (in front)
compare-kept-cases = Kept cases
compare-no-cases-listed = None yet
compare-asked = which part is it actually?
compare-taken-for = taken for
compare-nearest-to = nearest to
compare-nothing = nothing
compare-accepted-asked = accepted · which part is it actually?
compare-not-accepted-asked = not accepted · which part is it actually?
compare-accepted-right = accepted, and it is
compare-not-accepted-right = not accepted, and it is
compare-accepted-wrong = accepted, but it is
compare-not-accepted-wrong = not accepted, but it is
compare-choose-truth = Choose…
compare-truth-hint = What actually hung in front of the camera
compare-against = against
compare-against-none = no part
compare-against-hint = The enrolled part that the case is compared with
compare-against-follows = What it is, else the best
compare-against-choice = Against: { $part }
compare-keep-case = Keep case
compare-keep-case-hint = Keep this scene with its actual part
compare-keep-case-first = First choose what it is
compare-kept-case = Kept case
compare-remove-case = Remove case
compare-run-all = Run all cases
compare-run-all-hint = Inspect every kept case with the recipe on the right
compare-undo-keep = Undo keep
compare-undo-removal = Put case back
compare-undo-truth = Undo actual part
compare-undo-recipe = Put recipe back
compare-undo-use = Undo use
compare-undo-open = Undo open

## The pictures
compare-nothing-to-compare = Nothing to compare yet
compare-nothing-to-compare-advice = Capture a scene (Space), open one, or open a kept case
compare-no-outline = There is no outline to compare: { $reason }
compare-no-outline-reason = no outline
compare-contours = Contours at the best lag
compare-signatures-default = query and part, part shifted by the lag
compare-signatures-paper = as the paper writes them: no lag, Θ folded
compare-correlations = Auto- and cross-correlation
compare-correlations-default = default: finds the lag · ‖A − C‖₁ { $share } of ‖A‖₁ · axis not from 0
compare-correlations-paper = paper: ‖A − C‖₁ { $value } px² + rad² · { $share } of ‖A‖₁
compare-no-lag = no lag found
compare-overlay = lag { $lag } of { $rays } · turned { $angle } · { $distance } apart
compare-legend-query = — query
compare-rays = Rays, m²
compare-lag-zero-rays = lag 0, in rays
compare-lag-zero-pixels = lag 0, in pixels
compare-lag-read = lag { $lag }: A { $auto }, C { $cross }
compare-auto = A: itself
compare-cross = C: query

## The distances
compare-distances = Distance per part
compare-distances-none = Needs an outline
compare-distance-default = default: outlines apart
compare-distance-paper = paper: ‖A − C‖₁, px² + rad²
compare-distance-in-use = { $name } (in use)
compare-distance-paper-hint = The paper's own figure (eq. 11): the differences of the lengths' correlations, in squared pixels, and of the angles', in squared radians, added up
compare-compare-with = Compare with { $part }: { $figures }
compare-distance-hint = Outlines apart { $outline } (default) · ‖A − C‖₁ { $paper } px² + rad² (paper) · score in the end { $score }

## The kept cases
compare-all-cases = All kept cases
compare-looking = Looking for kept cases
compare-no-cases-in = No kept cases in { $folder }
compare-no-cases = No kept cases yet
compare-no-cases-advice = Capture a scene, choose what it is and press Keep case; kept cases show what another recipe gains and what it breaks
compare-folder = Folder…
compare-folder-of-cases = Folder of cases…
compare-back = Back to matrix
compare-earlier = Earlier run…
compare-earlier-label = Compare with an earlier run…
compare-earlier-hint = Compare with an earlier run that partsight evaluate --json wrote
compare-ran-at = ran at { $time }
compare-false-accepts =
    { $count ->
        [0] no false accepts
        [one] 1 false accept
       *[other] { $count } false accepts
    }
compare-tally =
    { $right } of { $total } right · { $refused ->
        [0] none
       *[other] { $refused }
    } wrongly refused
compare-num-unreadable = { $count } cannot be read
compare-run-running = running, { $done } of { $total } done
compare-run-stopped = stopped, { $done } of { $total } done
compare-other-recipe = with another recipe
compare-run-covers = outdated: { $done } of { $total } kept cases
compare-cases-removed = outdated: a case was removed
compare-running = Running
compare-run-hint = Run all cases (Ctrl R) shows what each is taken for now
compare-it-is = it is: { $part }
compare-cell-taken-for = { $truth } taken for { $part }: { $count }
compare-cell-not-accepted = { $truth }, not accepted: { $count }
compare-open-case = Open { $name }
compare-open-case-hint = Bring this case to the front
compare-remove-named = Remove { $name }
compare-cell-refused = wrongly refused
compare-matrix-hint = Rows: what it is · columns: what it was accepted as · a cell opens its cases

## Changes since an earlier run
compare-num-worse =
    { $count ->
        [0] none worse
       *[other] { $count } worse
    }
compare-num-better = { $count } better
compare-num-rescored = { $count } with another score
compare-num-common = { $count ->
        [one] { $count } case of both
       *[other] { $count } cases of both
    }
compare-num-new = { $count } new
compare-num-gone = { $count } gone or damaged
compare-against-file = against { $file }
compare-no-changes = Every case of both runs came out as before
compare-worse = worse
compare-better = better
compare-change-same = { $change }: { $before } → { $now }
compare-change = { $change }: { $is }, was { $was } · { $before } → { $now }

## The recipe
compare-recipe-named = Recipe { $recipe }
compare-built-in-hint = Every parameter at its default
compare-is-default = default
compare-duplicate = Duplicate
compare-rename = Rename…
compare-delete = Delete
compare-set-default = Set as default
compare-built-in-stays = A built-in recipe cannot be changed
compare-nothing-to-save = Nothing has changed since it was saved
compare-not-kept = It is not among the saved recipes
compare-default-already = It is the default already
compare-import = Import…
compare-take-rename = Rename
compare-name-hint = name
compare-name = Name of the recipe
compare-save-name = Save under this name
compare-rename-name = Rename under this name
compare-cancel-name = Cancel the name
compare-replace-title = Replace recipe { $name }?
compare-replace-why = Another program changed it while it was on trial here; that version would be lost
compare-replace = Replace it
compare-expects = Expects { $parts }
compare-num-changed = { $count } changed from default
compare-list-changes = List them
compare-reset-all = Reset all
compare-reset-all-hint = Every parameter back to its default
compare-parameter-change = { $parameter }: { $value }, default { $default }
compare-scaling = Scaling: one core against several
compare-more-changed = More of { $group } ({ $count }, { $changed } changed)
compare-case-is-pending = With this recipe this case is…
compare-case-is = With this recipe this case is
compare-verdict-nearest = Not accepted · nearest { $part } { $score }
compare-verdict-nothing = Not accepted · no part found
compare-right-accepted = Right and accepted
compare-rightly-refused = Rightly refused
compare-truth-not-set = The actual part is not set
compare-use = Use this recipe
compare-use-hint = Scenes are inspected with it from now on
compare-in-use-hint = Scenes are inspected with this recipe already

## Why a case is refused
compare-refused = Refused: { $reason }
compare-refused-apart = Refused: { $reason }; the outlines lie { $distance } apart

## The plots
compare-calibration = Calibration
compare-calibration-caption = right over score · error { $error }
compare-calibration-caption-none = right over score
compare-calibration-hint = The best guesses of all cases, by score: on the line a score of 0.9 is right nine times in ten. The numbers count guesses
compare-calibration-bin = { $from } to { $to }, { $right } of { $count } right
compare-calibration-words = Calibration: expected error { $error }; { $bins }
compare-threshold = Threshold
compare-threshold-caption = share over least score
compare-threshold-words = Threshold: at { $threshold } the score alone accepts { $wrong } of { $cases } cases wrongly and refuses { $refused } of { $enrolled } parts
compare-threshold-hint = For each minimum score, by the score alone: the share of all cases that it would accept wrongly, and of enrolled parts that it would refuse. The vertical line is the recipe's
compare-plot-false-accepts = false accepts
compare-plot-refused = parts refused
compare-scaling-says = Ranks one query over 8 to 2048 simulated references by 1, 2, 4 and 8 workers; takes a few seconds
compare-measure = Measure
compare-measure-label = Measure scaling
compare-scaling-cores = { $cores ->
        [one] { $cores } core
       *[other] { $cores } cores
    }
compare-scaling-cores-shared = { $cores ->
        [one] { $cores } core; { $workers } workers and more share it
       *[other] { $cores } cores; { $workers } workers and more share them
    }
compare-scaling-from = { $count ->
        [one] { $cores }: several pay off from { $count } reference on
       *[other] { $cores }: several pay off from { $count } references on
    }
compare-scaling-never = { $cores }: several never pay off
compare-scaling-plot = Time of a ranking over the number of references; { $words }
compare-one-worker = 1 worker

## Keys
compare-key-keep = Keep the case in front
compare-key-run = Run all kept cases
compare-key-undo = Undo keeping or removing a case, setting its actual part, or removing, using or opening a recipe

## Work and notices
compare-cases-title = Folder of kept cases
compare-earlier-title = File that partsight evaluate --json wrote
compare-evaluation-files = Evaluations
compare-recipe-files = Recipes
compare-import-title = Recipe to import
compare-export-title = Export the recipe
compare-comparing = Comparing
compare-listing-cases = Listing the kept cases
compare-keeping-case = Keeping the case
compare-removing-case = Removing a case
compare-restoring-case = Putting the case back
compare-saving-truth = Saving the actual part
compare-running-cases = Running the kept cases
compare-measuring = Measuring the ranking
compare-comparing-earlier = Comparing with an earlier run
compare-changing-recipes = Changing recipes
compare-inspecting = Inspecting with another recipe
compare-nothing-to-keep = There is no case to keep yet
compare-nothing-to-keep-advice = Capture or open a scene, and wait until it is inspected
compare-kept-already = This case is kept already
compare-kept-already-advice = Capture or open another scene
compare-no-truth = A case needs its actual part
compare-no-cases-to-run = There are no kept cases to run
compare-no-cases-to-run-advice = Keep a case first, or choose a folder of cases
compare-no-run = There is no run to compare with an earlier one
compare-no-run-advice = Run all cases first
compare-kept-as = Kept as { $name }
compare-removed-case = Removed { $name }; its History entry is unchanged
compare-restored-case = { $name } is back
compare-truth-saved = Saved the actual part of { $name }; its History entry is unchanged
compare-case-gone = There is no kept case named { $name } any more
compare-case-gone-advice = Run all cases again
compare-front-gone = The kept case { $name } is gone or damaged
compare-front-gone-advice = The scene inspected last is in front instead; copy the case back to its folder to compare it again
compare-recipe-changed-elsewhere = Recipe { $name } was changed by another program
compare-recipe-changed-elsewhere-advice = Open it in Compare to use it; until then its previous parameters are used
compare-tried-changed-elsewhere-advice = Open it again to try that version; Save asks before it replaces it
compare-recipe-gone = Recipe { $name } is no longer among the saved recipes
compare-recipe-gone-advice = Another program renamed or deleted it: save its parameters under a name in Compare, or open another recipe
compare-saved-recipe = Saved recipe { $name }
compare-restored-recipe = Recipe { $name } is back
compare-renamed-recipe = Recipe { $before } is named { $now } now
compare-removed-recipe = Removed recipe { $name }
compare-default-recipe = Commands without --recipe now use "{ $name }"
compare-imported-recipe = Imported recipe { $name }
compare-recipe-used = Scenes are inspected with recipe { $recipe } now: { $count } changed from default
