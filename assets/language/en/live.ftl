# The followed source
live-record = Record…
live-record-says = Save every frame of the source unchanged (Ctrl L)
live-stop-recording = Stop recording
live-stop-recording-so-far = Stop recording · { $num ->
        [one] { $num } frame, { $size }
       *[other] { $num } frames, { $size }
    }
live-recorded = { $num ->
        [one] Recorded { $num } frame, { $size }, to { $folder }
       *[other] Recorded { $num } frames, { $size }, to { $folder }
    }
live-playing = Playing
live-watching = Watching
live-lost = lost, reconnecting
live-opening = opening
live-file-is-part = each file is a part
live-looking = looking
live-moving = moving
live-steady-for = steady for { $seconds } s
live-file-by-file = Every new file is inspected on its own
live-no-verdict = No verdict until the part hangs still
live-frames-of = { $num } of { $needed ->
        [one] { $needed } frame
       *[other] { $needed } frames
    }
live-frames-agree = { $agreeing } of { $num ->
        [one] { $num } frame agrees
       *[other] { $num } frames agree
    }
live-averaged = { $evidence } · depth of { $num }
live-dropped = { $num } dropped
live-rates = { $captured } fps, { $inspected } inspected
live-scan-cannot = A scan cannot be followed: it does not change
live-file-cannot = A single file cannot be followed: it does not change
live-cannot-advice = Choose a camera, a recording or a folder in the source menu
live-closing = Closing the camera
live-inspects-each = Each capture in the folder is inspected as soon as it is saved
live-ended = Live stopped: one frame was captured
live-ended-past = Live stopped: a past inspection was opened or repeated
live-ended-advice = Press L to start Live again
live-source-back = The source is back

## Setting up the simulated cell

live-what-hangs = What hangs there
live-hangs = Hangs there: { $what }
live-side = Side
live-side-left = Left
live-side-right = Right
live-model = Car model
live-model-says = 0 is the enrolled one
live-hung = Hung
live-with-care = With care
live-anyhow = Anyhow
live-turned-away = Turned away
live-noise = Noise
live-no-noise = None
live-kinect-noise = A Kinect's
live-three-times = Three times
live-clutter = Clutter
live-no-clutter = None
live-on-floor = On the floor
live-plank = A plank in front
live-line-runs = The line runs, a part every { $seconds } s
live-racks-run = The line runs, three parts side by side every { $seconds } s
live-conveyor-runs = The line runs without a stop at { $speed } mm/s
live-nothing = Nothing
