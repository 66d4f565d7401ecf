# robot
