# Warum der Arm einen Punkt einer Bahn nicht anfahren kann

point-out-of-reach = außer Reichweite
point-joint-limit = Achse { $joint } bräuchte { DEGREES($angle, 0) }°
    .reason = Achse { $joint } über ihrer Grenze
point-near-singularity = nahe einer Singularität: { $singularity ->
        [wrist] Handgelenk gestreckt
        [elbow] Arm gestreckt
       *[shoulder] Handgelenk über Achse 1
    }
point-too-fast = Achse { $joint } bräuchte { DEGREES($speed, 0) }°/s
    .reason = Achse { $joint } zu schnell
point-rail-too-fast = die Schiene bräuchte { MM($speed, 0) } mm/s
    .reason = Schiene zu schnell
point-joint-acceleration = Achse { $joint } bräuchte { DEGREES($acceleration, 0) }°/s² und hat { DEGREES($limit, 0) }
    .reason = Achse { $joint } beschleunigt zu langsam
point-rail-acceleration = die Schiene bräuchte { MM($acceleration, 0) } mm/s² und hat { MM($limit, 0) }
    .reason = Schiene beschleunigt zu langsam
point-configuration-change = der Arm müsste umschlagen
point-collision = { near-body } zu nah an { near-obstacle }

near-body = { $body ->
        [gun] Pistole
        [wrist] Handgelenk
        [forearm] Unterarm
       *[upper_arm] Oberarm
    }
near-obstacle = { $obstacle ->
        [part] dem Teil
        [other_part] einem anderen hängenden Teil
        [floor] dem Boden
        [upper_arm] dem Oberarm
        [forearm] dem Unterarm
        [base_column] dem Sockel
       *[box] dem Quader { $name }
    }
