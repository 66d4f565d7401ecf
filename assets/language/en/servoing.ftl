## How a run is described
servoing-standard-position = Standard position
servoing-camera-pose = Recorded camera pose
servoing-path-start = Start of the spray path
servoing-looking = Looking for the part
servoing-moving = Moving
servoing-waiting = Waiting for Next
servoing-holding = Holding
servoing-checking = Checking at rest
servoing-arrived = The target is reached
servoing-arrived-approximately = The target is reached approximately: the part may be another model
servoing-stopped = Stopped
servoing-state-left = { $state }: { $left } left
servoing-tolerance = Tolerance
servoing-shift-left = Shift left, mm
servoing-turn-left = Turn left, °

## The page
servoing-start = Start
servoing-stop = Stop
servoing-stop-keys = The space bar and Esc stop it too
servoing-key-stop = Stop the robot
servoing-key-next = Allow the next step
servoing-running = Servoing
servoing-begins = Preparing the run
servoing-stopping = The robot brakes
servoing-waits-for-robot-advice = Start the program on the robot's controller
servoing-nothing-yet = No run yet
servoing-nothing-yet-advice = Choose part and robot on the right, then press Start
servoing-left = The robot was stopped because you left the page Servo
servoing-left-advice = Stay on the page while the robot moves
servoing-view = 3-D view of the run
servoing-target = Target
servoing-nozzle = Nozzle
servoing-flange = Flange
servoing-error = Error left
servoing-bounds = Bounds, 95 %
servoing-took = Took
servoing-looks = Frames accepted
servoing-looks-of = { $accepted } of { $count }
servoing-delay = Frame to verdict

## What is servoed
servoing-part-and-target = Part and target
servoing-remove-frame = Remove this frame from the target
servoing-add-frame = Add a frame…
servoing-frame-title = Frame of the part, taken where the camera should stand
servoing-simulated = Simulated
servoing-simulated-says = An arm with a camera on its flange, in the simulated cell. Its calibration is wrong by up to 20 mm and 2°
servoing-listen-at = Address and port of this computer
servoing-connect-to = Address of the robot
servoing-no-safety = Servoing is no safety function. It has not been tested on controllers: try it slowly, with a hand on the stop
servoing-limits = Limits
servoing-speed = Greatest speed
servoing-in-steps = In steps
servoing-in-steps-hint = The robot waits for Next before each step of up to 50 mm and 5°
servoing-volume-says = Box in the robot's base frame that flange, camera and nozzle never leave
servoing-clearance = Clearance
servoing-arm = Arm
servoing-no-nozzle = None
servoing-to-robot = Change them in Paint

## What is missing
servoing-no-part = No part is enrolled
servoing-no-part-advice = Enrol a part in the Enrol workspace, or choose another library
servoing-not-simulated-advice = Choose one of the parts that come with the program, or a real robot
servoing-no-address = The robot's address is missing or wrong
servoing-listen-advice = Enter the address of this computer and the port at which the controller's packets arrive, such as 192.168.1.10:6510
servoing-connect-advice = Enter the address of the robot, such as 192.168.1.20
servoing-no-camera = No camera is the source: its frames must show what hangs there now
servoing-no-camera-advice = Choose a camera as the source in the status bar, or a simulated robot
servoing-no-frames = The target has no frame
servoing-no-frames-advice = Add frames of the part, taken where the camera should stand
servoing-no-arm = KUKA's robots are sent joint angles, so the arm must be known
servoing-no-arm-advice = Choose the arm and enter the nozzle in Paint, under Robot
servoing-not-calibrated = Where the camera sits is not known
servoing-not-calibrated-advice = Calibrate it first: press B, then Calibration

## Runs in the history
servoing-runs = Servo runs
servoing-runs-hint = Runs of visual servoing in place of the inspections
servoing-runs-counted = { $count ->
        [one] { $matching } of { $count } run
       *[other] { $matching } of { $count } runs
    }
servoing-no-runs-listed = No run matches the filter
servoing-choose-run = Choose a run to see its curve
servoing-row = Run { $number }: { $part }, { $end }
servoing-run-number = Run { $number }
servoing-source = Source
servoing-time = Time
servoing-wrote = { $count ->
    [one] Wrote { $count } run to { $path }
   *[other] Wrote { $count } runs to { $path }
}
