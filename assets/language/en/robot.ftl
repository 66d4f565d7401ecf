# The robot's cell
robot-title = Robot
robot-in-use = Calibration
robot-by-hand = By hand
robot-from-pairs = From pairs of poses
robot-load-title = Load the calibration of the robot's cell
robot-calibrations = Calibrations
robot-pairs-title = Pairs of robot and camera poses
robot-tables = Tables and JSON
robot-forgotten = The calibration is no longer used; its file is kept
robot-opening = Opening the calibration
robot-saving = Saving the calibration
robot-calculating = Calculating where the camera sits
robot-no-folder = There is no folder for your own calibration
robot-no-folder-advice = Write it with partsight calibrate --out FILE, and load that file here
robot-saved = Saved; the previous calibration is kept in { $path }

## In use

robot-not-calibrated = The cell is not calibrated: poses are in the camera's frame, and a robot cannot use them
robot-file = file
robot-edited = the numbers of the calibration were changed and not confirmed: no robot gets poses
robot-edited-advice = Check the numbers in Robot…; confirm them if they are right, else calibrate again
robot-confirm = Confirm…
robot-confirm-says = Is this where the camera stands? The numbers will count as entered by hand, and robots get poses by them. The former file is kept
robot-confirm-not = Not now
robot-confirm-right = They are right
robot-load = Load…
robot-forget = Forget
robot-cell = cell
robot-camera = camera
robot-made = made
robot-from = from
robot-entered-by-hand = entered by hand
robot-pairs-of = { $num ->
        [one] { $num } pair of { $file }
       *[other] { $num } pairs of { $file }
    }
robot-residuals = residuals
robot-residuals-are = { $mm } mm and { $degrees }° rms, worst { $worst } mm ({ $pair })
robot-uncertainty = uncertainty (95 %)
robot-mm-and-degrees = { $mm } mm and { $degrees }°
robot-flange-at-every = robot_from_flange at every capture
robot-flange-unknown = the flange pose at a capture is not known: there is no pose for the robot
robot-flange-unknown-advice = Type the flange's pose as the controller shows it, and store it
robot-flange-at = Flange at a capture

## By hand

robot-camera-in-cell = Camera in the cell
robot-camera-on-flange = Camera on the flange
robot-numbers-of = Numbers of
robot-numbers-are-of = Numbers of: { $convention }
robot-where-camera-stands = { $transform }: where the camera's frame stands
robot-name-of-cell = Name of the cell
robot-use-it = Use it
robot-use-anyway = Use it anyway

## From pairs

robot-choose-pairs = Choose pairs…
robot-choose-pairs-says = A table or JSON of robot and camera poses, 8 to 15 pairs
robot-pairs-format = A line holds the robot's pose, as the controller shows the flange, then the camera's: where it sees the target. Lines such as "# robot: kuka" and "# camera: matrix" at the top name the conventions. An enrolled part can be the target: partsight calibrate hand-eye --captures
robot-counts = counts
robot-off-mm = off mm
robot-off-degrees = off °
robot-worst = worst
robot-left-out = left out
robot-rms = rms of the residuals
robot-not-determined = not determined by the pairs
robot-flange-turned = the flange turned
robot-span = { $turn }° at most, { $other }° about other axes; target moved { $travel } mm
robot-read-as = read as
robot-conventions-are = robot { $robot }, camera { $camera }
robot-eye-to-hand = eye to hand: the camera stands in the cell
robot-eye-in-hand = eye in hand: the camera is on the robot's flange

## Check of the cell

robot-check = Check of the cell
robot-check-says = One part, hung in the same place every day, shows whether camera and cell still stand where they stood. Any rigid thing with edges in all directions serves; leave some of wall or floor in the picture
robot-check-no-folder = There is no folder for the baseline and the checks
robot-check-no-folder-advice = Use partsight cell with --folder DIR
robot-no-baseline = There is no baseline to compare with
robot-no-baseline-advice = Take one while the cell is right
robot-baseline = baseline
robot-taken-at =
    { $time }, { $count ->
        [one] 1 frame
       *[other] { $count } frames
    }
robot-allowed = allowed
robot-allowed-are = { $shift } and { $turn }
robot-no-wall = Neither wall nor floor is in the picture of the baseline: a check cannot tell whether the camera moved or the part
robot-no-wall-advice = Leave some of them in the picture, and take a new baseline
robot-frames-from = frames from
robot-new-baseline-allows = A new baseline allows
robot-allowed-shift = Allowed shift, mm
robot-allowed-turn = Allowed turn, degrees
robot-take-baseline = Take baseline
robot-take-new-baseline = Take a new baseline…
robot-check-now = Check now
robot-replace-says = Replace the baseline? Checks are compared with the new one from then on, and the old one is not kept
robot-keep-baseline = Keep it
robot-replace-baseline = Replace it
robot-reading-checks = Reading baseline and checks
robot-taking-baseline = Taking the baseline
robot-checking = Checking the cell
robot-writing-checks = Writing the checks
robot-check-of-scan = A scan is taken from several places, so it cannot check the cell
robot-check-of-scan-advice = Choose a camera as the source, or open a single capture
robot-last-check = Last check
robot-checked = checked
robot-of-allowed = { $value }, allowed { $limit }
robot-part-shifted = part moved by
robot-along-axes = along x, y and z of the camera
robot-part-turned = part turned by
robot-wall-shifted = wall and floor moved by
robot-wall-not-found = neither was found again
robot-readings = readings
robot-readings-are = { $rms } rms against the baseline, { $ratio } times its noise
robot-checks-shown = { $count ->
        [one] Last { $shown } of { $count } check
       *[other] Last { $shown } of { $count } checks
    }
robot-shift-over-time = Shift since the baseline, along x, y and z of the camera
robot-check-time = time
robot-check-shift = shift
robot-check-turn = turn
robot-check-finding = finding
robot-export-checks-title = Export the checks of the cell
robot-checks-written =
    { $count ->
        [one] One check
       *[other] { $count } checks
    } written to { $path }
robot-moved = Last check of the cell, { $time }: { $finding }
robot-moved-advice = Have an engineer look before parts are painted: Robot…, Check of the cell

## Answering robots

robot-answer = Answer robots
robot-answer-says = Robots and PLCs ask over TCP for an inspection and get verdict and pose, as from partsight serve. Each trigger is answered from a frame that the window's source delivers after it. SERVO uses target and limits of the page Servo
robot-protocol = Protocol
robot-port = Port, or IP address and port
robot-pose-of-part = Where the part is
robot-pose-offset = How far it is from its standard position
robot-poses-as = poses as
robot-answered-in = Answers in: { $convention }
robot-change-poses = Robots are being answered: the numbers of their next pose would mean something else
robot-change-poses-advice = Stop the robots and adapt their programs first. All connections end, and the boot number changes
robot-change-poses-do = Change them
robot-change-poses-not = Leave them as they are
robot-no-address = "{ $text }" is neither a port nor an IP address with a port
robot-no-address-advice = Give a port from 1 to 65535, or the address of this computer's network card with it, such as 192.168.1.10:30100
robot-other-convention = Choose another convention
robot-turn-on = Turn on
robot-turn-off = Turn off
robot-calibrate-first = Calibrate it first, or no pose can be given
robot-answers-at = Answers robots · { $at }
robot-answers-without-frames = Answers robots, without frames
robot-answers-without-frames-advice = Press Live: until then every trigger is answered with an error
robot-answers-soon = Starting to answer robots
robot-not-answered = Robots are not answered
robot-port-in-use = Cannot listen at { $at }: another program listens at this port
robot-port-in-use-advice = End the other program, or choose another port. Listening is tried again every 3 s
robot-cannot-listen-advice = Choose another port from 1024 up, or the address of a network card of this computer
robot-listens-at = listens at
robot-clients = connections
robot-last-client = last connection
robot-client-connected = { $peer } connected
robot-client-left = { $peer } left
robot-client-turned-away = { $peer } was refused: the maximum number of clients is connected
robot-client-turned-away-advice = Close a connection that is not used
robot-last-trigger = last trigger
robot-no-trigger = none yet
robot-answer-number = no. { $number }
robot-answer-age = frame { $age } ms old
robot-answer-motion-unchecked = not checked whether the part moves
robot-part-numbers = Numbers of the parts

## Poses and conventions
robot-motion-unknown = Not known whether the part hung still

## What was not checked
