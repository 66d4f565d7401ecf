# Por qué se retiene o se detiene un robot guiado por la cámara

servo-not-accepted = el robot se detuvo porque no se acepta ninguna pieza: { $why }
servo-another-part = el robot se detuvo porque allí cuelga { $other } en lugar de { $part }
    .advice = Cuelgue la pieza correcta o elija la que está colgada y empiece de nuevo
servo-ambiguous = el robot se detuvo porque la pose de { $part } no es segura: otra ajusta casi igual de bien o su tamaño no coincide
    .advice = Gire la cara de la pieza hacia la cámara, toda dentro de la imagen, y empiece de nuevo
servo-no-bounds = el robot se detuvo porque la inspección no da la incertidumbre de la pose de { $part }
    .advice = Elija una receta que estime la pose con el método global y empiece de nuevo
servo-moved = el robot se detuvo porque la pieza parece haberse movido { MM($shift_m, 0) } mm y { DEGREES($turn_rad, 1) }° de una imagen a la siguiente
    .advice = Deje la pieza quieta y empiece de nuevo; si estaba quieta, compruebe la calibración y que la cámara y el robot tengan la misma hora
servo-lost = el robot se detuvo porque no hay ninguna imagen aceptada desde hace { FIXED($age_s, 1) } s
    .advice = Compruebe la cámara y su cable y que toda la pieza siga en la imagen; después empiece de nuevo
servo-stale = el robot se detuvo porque una imagen llegó { FIXED($age_s, 1) } s después de su captura
    .advice = Cierre lo demás que usa este ordenador o aumente la edad máxima de una imagen; después empiece de nuevo
servo-frame-times = el robot se detuvo porque las horas de las imágenes difieren { FIXED($off_s, 2) } s: son posteriores a la actual o no están en orden
    .advice = Ajuste los relojes de la cámara, del robot y de este ordenador con el mismo servidor de hora; después empiece de nuevo
servo-arm-times = el robot se detuvo porque dos avisos de su pose distan { FIXED($gap_s, 3) } s
    .advice = Compruebe la conexión con el controlador del robot; después empiece de nuevo
servo-arm-astray = el robot se detuvo porque está a { MM($shift_m, 0) } mm y { DEGREES($turn_rad, 1) }° del camino por el que se le envió
    .advice = Mire si hay un mensaje en la consola del robot y si la base y la herramienta son las de la calibración; después empiece de nuevo
servo-too-far = el robot se detuvo porque el objetivo está a { MM($shift_m, 0) } mm y { DEGREES($turn_rad, 0) }°
    .advice = Acerque el robot al objetivo de modo que la cámara vea toda la pieza y empiece de nuevo
servo-outside-volume = el robot se detuvo porque saldría { MM($beyond_m, 0) } mm del volumen de trabajo
    .advice = Cuelgue la pieza en otro sitio o amplíe el volumen de trabajo si hay espacio
servo-too-near = el robot se detuvo porque { $body ->
        [gun] su pistola
        [wrist] su muñeca
        [forearm] su antebrazo
        [upper_arm] su brazo
       *[tool] su herramienta
    } se acercaría demasiado { near-obstacle }
    .advice = Cuelgue la pieza en otro sitio, empiece desde otro lado o compruebe los obstáculos y su distancia mínima
servo-out-of-reach = el robot se detuvo porque el brazo no alcanza el camino hasta el objetivo
    .advice = Cuelgue la pieza más cerca del centro del alcance o empiece con otra configuración del brazo
servo-joint-limit = el robot se detuvo porque el eje { $joint } sobrepasaría su límite
    .advice = Empiece con otra configuración del brazo o cuelgue la pieza en otro sitio
servo-singular = el robot se detuvo porque el brazo se acercaría a una singularidad
    .advice = Empiece con otra configuración del brazo o cuelgue la pieza en otro sitio
servo-uncertain = se alcanzó el objetivo, pero no con la exactitud exigida: { MM($shift_m, 1) } mm y { DEGREES($turn_rad, 2) }° con la incertidumbre; se permiten { MM($most_m, 1) } mm y { DEGREES($most_rad, 2) }°
    .advice = Haga que la cámara vea la pieza entera y de más cerca, calibre de nuevo si el objetivo es la boquilla o aumente la tolerancia
servo-not-settling = { $num_rounds ->
        [one] el robot se detuvo porque quedan { MM($shift_m, 1) } mm y { DEGREES($turn_rad, 2) }° después de { $num_rounds } corrección
       *[other] el robot se detuvo porque quedan { MM($shift_m, 1) } mm y { DEGREES($turn_rad, 2) }° después de { $num_rounds } correcciones
    }
    .advice = Deje la pieza quieta o aumente la banda muerta; si nada se mueve, compruebe la calibración
servo-time-over = el robot se detuvo porque no alcanzó el objetivo en { FIXED($limit_s, 0) } s
    .advice = Empiece más cerca del objetivo o aumente el tiempo máximo
servo-robot-stopped = el robot se detuvo porque su programa se ha parado o ya no acepta poses
    .advice = Inicie de nuevo el programa del robot y vuelva a servocontrolar
servo-by-person = el robot se detuvo a petición
    .advice = Empiece de nuevo cuando la celda esté libre

# Before it moves
servo-waits-for-robot = Esperando al robot: { $robot }
servo-not-simulated = la celda simulada no tiene { $part }
