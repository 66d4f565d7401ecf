# Why the arm cannot run a point of a path; `reason`: without the figures, which differ from point to point

point-out-of-reach = out of reach
point-joint-limit = joint { $joint } would need { DEGREES($angle, 0) }°
    .reason = joint { $joint } beyond its limit
point-near-singularity = near a singularity: { $singularity ->
        [wrist] wrist straight
        [elbow] arm stretched
       *[shoulder] wrist above joint 1
    }
point-too-fast = joint { $joint } would need { DEGREES($speed, 0) }°/s
    .reason = joint { $joint } too fast
point-rail-too-fast = the rail would need { MM($speed, 0) } mm/s
    .reason = rail too fast
point-joint-acceleration = joint { $joint } would need { DEGREES($acceleration, 0) }°/s² and has { DEGREES($limit, 0) }
    .reason = joint { $joint } accelerates too slowly
point-rail-acceleration = the rail would need { MM($acceleration, 0) } mm/s² and has { MM($limit, 0) }
    .reason = rail accelerates too slowly
point-configuration-change = the arm would have to fold over
point-collision = { near-body } too near to { near-obstacle }

near-body = { $body ->
        [gun] gun
        [wrist] wrist
        [forearm] forearm
       *[upper_arm] upper arm
    }
near-obstacle = { $obstacle ->
        [part] the part
        [other_part] another part that hangs there
        [floor] the floor
        [upper_arm] the upper arm
        [forearm] the forearm
        [base_column] the base column
       *[box] the box { $name }
    }
