# What was not checked of a path

unchecked-arm = reach and collisions
    .advice = Write a program and name its arm, with the nozzle's pose on the flange, or watch the robot's first run at low speed
unchecked-moving-part = reach and collisions, because the line moves the part while the robot works
    .advice = Run the program without paint on a slow line first, and watch the robot
unchecked-surroundings = collisions with anything but part and arm, such as the part's stand
    .advice = Describe the boxes and the floor of the cell in a file, or watch the robot's first run at low speed
unchecked-film = the film that the program leaves, because the path names no coat
    .advice = Plan the path again, so that it names its coat
unchecked-accelerations =
    { $what ->
        [joints] accelerations of the joints
        [rail] acceleration of the rail
       *[both] accelerations of joints and rail
    }
    .advice = Add the limits to the arm's file
unchecked-not-seen = the stand-off at { $num } of { $num_points } points, where the camera saw no surface
    .advice = Capture the part so that the camera sees more of it, or scan it, if the path should aim at it there

not-checked = not checked: { $what }
