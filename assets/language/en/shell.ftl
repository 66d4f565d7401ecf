# The bars, the source, settings, files and shortcuts

## Bars

shell-capture = Capture
shell-live = Live
shell-open = Open…
shell-robot = Robot…
shell-help = Help
shell-cancel = Cancel
shell-close = Close
shell-redo = Redo
shell-more = More of { $group } ({ $count })
shell-export-csv = Export CSV…
shell-export = Export…
shell-save-as = Save as…
shell-save = Save
shell-wrote = Wrote { $path }
shell-writing = Writing { $file }
shell-csv-files = Comma-separated values
shell-stop-live-says = Stop following the source (L)
shell-live-says = Follow the source and inspect as many frames as possible (L)
shell-robot-says = Calibration, check of the cell and answers to robots (B)
shell-calibrated-by = Calibrated by { $name }
shell-no-flange-pose = The flange pose at a capture is not known
shell-calibration-edited = The numbers of the calibration were changed and not confirmed
shell-not-calibrated = Where the camera sits in the robot's cell: not calibrated
shell-dark = Dark
shell-light = Light
shell-to-dark = Switch to dark (T)
shell-to-light = Switch to light (T)
shell-to-units = Switch to { $units } (U)
shell-language-says = Language of the window
shell-language-of = Language: { $language }
shell-num-parts = { $num ->
        [one] { $num } part
       *[other] { $num } parts
    }
shell-library-named = { $num ->
        [one] { $num } part · { $name }
       *[other] { $num } parts · { $name }
    }
shell-no-library = No library
shell-library-in-use = Library in use
shell-library-version = Version { $version } of { $store }
shell-library-version-changed = Version { $version } of { $store }, changed here since
shell-use-another-library = Use another library…
shell-use-usual-library = Use the usual library
shell-progress = { $work } · { $done } of { $total }

## Workspaces and views

shell-inspect = Inspect
shell-enrol = Enrol
shell-compare = Compare
shell-align = Align
shell-paint = Paint
shell-servo = Servo
shell-history = History
shell-operator = Operator
shell-engineer = Engineer
shell-operators-view = Operator's view
shell-engineers-view = Engineer's view
shell-to-engineer = Switch to the engineer's view (Ctrl K)
shell-set-pin = Set a PIN…
shell-set-pin-says = With a PIN the window starts in the operator's view
shell-change-pin = Change the PIN…
shell-remove-pin = Remove the PIN
shell-remove-pin-asked = Remove the PIN? Then anyone can switch to the engineer's view
shell-lock-after = Lock after
shell-minutes = { $num ->
        [one] { $num } minute
       *[other] { $num } minutes
    }
shell-enter-pin = Enter the PIN to change recipe, thresholds, library, cell and source
shell-unlock = Unlock
shell-may-change = In this view recipe, thresholds, library, cell and source can be changed
shell-switch = Switch
shell-new-pin = New PIN
shell-new-pin-says = Four to eight digits that protect the engineer's view
shell-next = Next
shell-same-digits = Enter the same digits again
shell-set-the-pin = Set the PIN
shell-pin-forgotten = Forgotten? Ask the engineer
shell-num-digits = { $num ->
        [one] { $num } digit
       *[other] { $num } digits
    }
shell-erase = Erase
shell-digit = Digit { $digit }
shell-locked = Locked: the window was not used for a while
shell-pin-removed = PIN removed
shell-wrong-pin = Wrong PIN
shell-four-digits = At least four digits
shell-pins-differ = The two differ: enter a new PIN
shell-pin-set = PIN set: the window now starts in the operator's view

## What a scene truly shows

shell-actual-part = Actual part: { $part }
shell-truth-not-set = Not set
shell-truth-not-enrolled = Not enrolled
shell-truth-nothing = Nothing (empty cell)

## The status bar

shell-days = { $num ->
        [one] 1 day
       *[other] { $num } days
    }
shell-status-from-pairs = hand-eye calibration
shell-status-made-ago = { $kind }, { $age } ago
shell-status-edited = edited
shell-status-no-flange-pose = no flange pose
shell-status-not-calibrated = not calibrated
shell-status-robots-off = robots off
shell-status-robots-off-says = No robot is answered: answering is off
shell-status-not-answered = not answered
shell-status-no-frames = no frames
shell-status-robots-start = starting
shell-status-listens = listens
shell-status-last-answer = Last answer: { $answer }
shell-status-live-off = Live off
shell-status-live-off-says = Live is off: nobody watches whether the part hangs still
shell-status-motion-unknown = No frames arrive: whether the part hangs still is not known
shell-status-no-frame = No frame has been captured yet
shell-status-frame-age = Age of the frame on the screen: { $age }
shell-status-speed = This computer inspects { $inspected } of { $frames } frames
shell-status-speed-unknown = The speed of this computer is measured while Live is on
shell-status-drift = drift

## The source

shell-simulated-cell = Simulated cell
shell-source-button = Source · { $source }
shell-source-says = Where Capture and Live take scenes from
shell-simulated = Simulated · { $what }
shell-scan-of = Scan { $name }
shell-cell-set-up = Simulated cell, set up
shell-recording-of = Recording { $name }
shell-folder-of = Folder { $name }
shell-set-up-cell = Set up the cell…
shell-cameras-and-folders = Cameras and folders
shell-play-recording = Play a recording…
shell-play-recording-says = A folder of depth images or clouds: Live plays and pauses it, Capture takes its next frame
shell-watch-folder = Watch a folder…
shell-watch-folder-says = Every capture that another program saves there is inspected
shell-open-file = Open a file…
shell-open-file-says = A single capture
shell-open-scan = Open a scan…
shell-open-scan-says = A folder with several shots of one part, each with the pose of its camera (Ctrl Shift O)
shell-average-depth = Live averages depth over
shell-one-frame = 1 frame
shell-recent-files = Recent files
shell-empty-cell = Empty cell
shell-capture-empty-cell = Capture empty cell
shell-capture-empty-cell-says = The scene in front becomes the empty cell: nothing in it is taken for a part from now on
shell-discard-empty-cell = Discard empty cell
shell-no-empty-cell = No empty cell has been captured
shell-empty-cell-discarded = Empty cell discarded
shell-cell-not-empty = The cell is not empty: a part hangs in it
shell-cell-not-empty-advice = Remove the part, capture, then press Capture empty cell
shell-empty-cell-doubt = Empty cell captured, but something as large as a part is in it
shell-empty-cell-doubt-advice = If that is a part: Source, Discard empty cell; then remove the part and capture first
shell-empty-cell-captured = Empty cell captured: from the next capture on, nothing in it is taken for a part

## What is at work

shell-capturing = Capturing
shell-opening = Opening { $name }
shell-waiting-for-file = Waiting for a new file
shell-same-capture = { $scene } was inspected again: it has not changed since
shell-inspecting-again = Inspecting again
shell-opening-library = Opening the library
shell-loading-library = Loading the library
shell-reloading-library = Reloading the library
shell-library-reloaded = { $num ->
        [one] Library reloaded, another program has changed it: { $num } part
       *[other] Library reloaded, another program has changed it: { $num } parts
    }
shell-path-off-part = { $part }: the stored spray path does not aim at the part; robots do not get it
shell-counting-parts = Counting parts
shell-writing-settings = Writing the settings

## Settings

shell-settings-not-used = The settings are not used: { $why }
shell-settings-set-aside = They were moved to { $path }; the window starts with default settings
shell-settings-values-not-used = { $keys } in { $path } { $num ->
    [one] cannot be used and has its default value
   *[other] cannot be used and have their default values
}; all other settings are kept
shell-settings-kept-beside = The file as it was is { $path }
shell-settings-move-away = Move the file away: it could not be set aside ({ $why })
shell-settings-not-kept = The settings are not remembered: { $why }
shell-settings-not-kept-advice = { $advice }; until then settings are not remembered
shell-report-settings = Report the settings that were changed

## Files

shell-all-files = All files
shell-scenes-clouds-meshes = Scenes, clouds and meshes
shell-captured-scenes = Captured scenes
shell-open-scene = Open a captured scene
shell-scan-folder = Folder of a scan: its frames and their poses
shell-another-library = Use another library
shell-a-recording = Play a recording
shell-record-to = Folder to record the source in
shell-watched-folder = Folder that captures are saved to
shell-open-part = Open a scene, a cloud or a mesh to enrol
shell-cannot-be-made = { $path } cannot be made: { $why }
shell-choose-another-folder = Choose another folder
shell-type-a-path = Type a path
shell-add-a-name = This is a folder: add the name of a file
shell-no-such-file = There is no such file
shell-no-such-folder = There is no such folder
shell-not-a-folder = This is a file, not a folder
shell-confirm-replace = A file of this name exists: confirm again to replace it
shell-no-parent-folder = The folder of this file does not exist
shell-no-file-dialog = The desktop offers no file dialog (package xdg-desktop-portal-gtk or zenity): type the path, or choose it below
shell-path = Path
shell-ok = OK

## Notices and closing

shell-dismiss = Dismiss
shell-dismiss-all = Dismiss all
shell-more-like-it = { $num } more like it
shell-read-in-millimetres = Read as millimetres
shell-too-wide = The points span { $extent } m
shell-too-wide-advice = Check the unit of the file
shell-undo = Undo
shell-close-without-saving = Close without saving?
shell-not-written = { $num ->
        [one] { $num } inspection is kept in memory only
       *[other] { $num } inspections are kept in memory only
    }: the history cannot be written
shell-keep-open = Keep the window open
shell-close-anyway = Close without saving
shell-stop-answering = Stop answering robots?
shell-robots-without-answer = Robots that ask at { $at } get no answer while the window is closed
shell-close-and-stop-answering = Close and stop answering

## Shortcuts

shell-shortcuts = Shortcuts
shell-key-ctrl = Ctrl
shell-key-shift = Shift
shell-key-space = Space
shell-key-enter = Enter
shell-key-up = Up
shell-key-down = Down
shell-does-capture = Capture, and inspect or enrol it
shell-does-live = Live: follow the source, or stop
shell-does-record = Record the source, or stop
shell-does-open-scan = Open a scan: several shots with their poses
shell-does-export = Export the inspection in front
shell-does-robot = The robot's cell: where the camera sits
shell-does-units = Millimetres and degrees, or metres and radians
shell-does-theme = Dark or light
shell-does-role = Operator's or engineer's view
shell-does-quit = Close the window
shell-does-help = Help: keys, guide, report a problem
shell-does-size = Everything larger, smaller, as usual
shell-does-escape = Close the enlarged stage; give up a box or lasso
shell-keys-tab = Tab, Enter
shell-does-tab = Go to the next control, press it
shell-keys-turn = Arrow keys, left drag
shell-does-turn = Turn the 3-D view
shell-keys-shift = Shift + those, right drag
shell-does-shift = Shift it
shell-keys-zoom = + −, wheel
shell-does-zoom = Zoom it
shell-keys-fit = F, Shift F
shell-does-fit = Fit the part, fit everything
shell-does-look = Look from the front, the top, the side
shell-does-measure = Measure between two clicked points
shell-keys-drawing = Left drag, Esc
shell-does-drawing = Draw the box or lasso, give it up
shell-keys-box = Arrow keys, Enter
shell-does-box = Move a box in the picture, apply it
shell-keys-resize = Shift + arrow keys
shell-does-resize = Make that box larger or smaller

## The simulated cell

shell-every-part = Every part in turn
shell-not-enrolled = Not enrolled: { $what }
shell-of-simulator = { $name }, simulated
shell-gone = { $path } no longer exists
shell-gone-advice = The simulated cell is used instead
shell-device-lost = The graphics device was lost, so the window was opened again
shell-device-lost-advice = Everything saved is there; an unsaved draft comes back if its scene can be restored. If it happens again, update the graphics driver
shell-second-window = Partsight is already open with this data folder: with Live on in both windows, every part counts twice
shell-second-window-advice = Close one of the two. This one started without Live and does not keep its settings
shell-no-thread = The system cannot start a thread for this: { $error }
shell-no-thread-advice = Close other programs and try again
shell-library-not-loaded = The library could not be loaded: { $error }
shell-library-not-loaded-advice = { $advice }, or choose another one at the top right; until then nothing is recognised
shell-library-still-in-use = The library in memory stays in use: { $error }
shell-library-inside = The library lies inside the program and cannot be changed ({ $reason })
shell-inside-program = The library lies inside the program and cannot be changed
shell-inside-program-advice = Choose a folder of your own at the top right
shell-choose-library = Choose { $path } at the top right
shell-choose-or-go-on = Choose another one at the top right, or go on: the first part that is saved is stored there
shell-holds-no-library = { $path } holds no library of parts
shell-sentence = { $text }.
shell-about-scene = { $scene }: { $what }

## Words of several areas

shell-view = View
shell-part = Part
shell-no-part = none
shell-remove = Remove
shell-name = Name
shell-notes-hint = Anything worth remembering
shell-reset = Reset
shell-wait = Wait a moment
shell-apply = Apply
shell-pose = Pose
shell-robot-base = Robot base
shell-store = Store
shell-library-loading = The library is being loaded
shell-choose-another-part = Choose another part
shell-nothing-inspected = Nothing inspected yet
