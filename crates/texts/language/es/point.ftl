# Por qué el brazo no puede recorrer un punto de una trayectoria

point-out-of-reach = fuera de alcance
point-joint-limit = el eje { $joint } necesitaría { DEGREES($angle, 0) }°
    .reason = eje { $joint } más allá de su límite
point-near-singularity = cerca de una singularidad: { $singularity ->
        [wrist] muñeca recta
        [elbow] brazo estirado
       *[shoulder] muñeca sobre el eje 1
    }
point-too-fast = el eje { $joint } necesitaría { DEGREES($speed, 0) }°/s
    .reason = eje { $joint } demasiado rápido
point-rail-too-fast = el carril necesitaría { MM($speed, 0) } mm/s
    .reason = carril demasiado rápido
point-joint-acceleration = el eje { $joint } necesitaría { DEGREES($acceleration, 0) }°/s² y tiene { DEGREES($limit, 0) }
    .reason = eje { $joint } acelera demasiado despacio
point-rail-acceleration = el carril necesitaría { MM($acceleration, 0) } mm/s² y tiene { MM($limit, 0) }
    .reason = el carril acelera demasiado despacio
point-configuration-change = el brazo tendría que voltearse
point-collision = { near-body } se acerca demasiado { near-obstacle }

near-body = { $body ->
        [gun] la pistola
        [wrist] la muñeca
        [forearm] el antebrazo
       *[upper_arm] el brazo superior
    }
near-obstacle = { $obstacle ->
        [part] a la pieza
        [other_part] a otra pieza colgada
        [floor] al suelo
        [upper_arm] al brazo superior
        [forearm] al antebrazo
        [base_column] a la columna de la base
       *[box] a la caja { $name }
    }
