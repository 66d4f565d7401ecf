# Why a part is not accepted, or nothing is recognised. Of each kind: the reason; `advice`, what to do, and `command-advice`
# where commands advise something else; `kind`, its name where refusals are counted; `short`, the reason for an operator;
# what an operator can do, as `step` and `otherwise`, between which the window says how to inspect again, or as `next`,
# or else `advice`; `compared`, the reason beside the figures of Compare.

## A part is not accepted

refusal-low-score = la mejor coincidencia, { $part }, obtiene { FIXED($score, 2) }, por debajo del umbral de { FIXED($threshold, 2) }
    .advice = Comprobar que esta pieza está registrada y que nada la tapa, y volver a capturar
    .kind = Puntuación por debajo del umbral
    .short = No coincide lo suficiente con: { $nearest }
    .step = { step-uncover }
    .otherwise = { step-if-it-persists }
    .compared = la puntuación { FIXED($score, 2) } está por debajo de { FIXED($threshold, 2) }
refusal-piece = solo se ve una parte de { $part } ({ PERCENT($hidden, 0) } % oculto, { PERCENT($outside, 0) } % fuera de la imagen); obtiene { FIXED($score, 2) }, por debajo del umbral de { FIXED($threshold, 2) }
    .advice = { PERCENT($hidden, 0) ->
        [0] { PERCENT($outside, 0) ->
            [0] { piece-hidden-or-outside }
           *[other] { piece-outside }
        }
       *[other] { PERCENT($outside, 0) ->
            [0] { piece-hidden }
           *[other] { piece-hidden-or-outside }
        }
    }
    .kind = Solo se ve una parte de la pieza
    .short = Solo se ve una parte de: { $nearest }
    .compared = la puntuación { FIXED($score, 2) } está por debajo de { FIXED($threshold, 2) }: solo se ve una parte
refusal-hardly-seen = lo que puede ser { $part } apenas se ve: casi de canto, o cortado por la mayoría de los lados
    .advice = Girar la pieza con la cara hacia la cámara, toda dentro de la imagen, y volver a capturar
    .kind = La pieza apenas se ve
    .short = { short-hardly-seen }
    .step = { step-all-in-picture }
    .compared = puntuación { FIXED($score, 2) }: apenas se ve
refusal-another-model = se parece a { $part }, pero no es igual: { LIST(model-surface, model-outline, model-missing, between: ", ", last: ", y ", end: "; ") }otro modelo, la pose es aproximada
    .advice = Si también hay que pintar esta, registrarla como otra referencia de { $part }
    .kind = Otro modelo
    .short = Se parece a { $nearest }, pero su forma es distinta
    .next = { step-enrol-if-painted-next }
    .compared = { LIST(model-surface, model-outline, model-missing, between: ", ", last: ", ", end: ": ") }otro modelo
refusal-another-make = es del tipo de { $part }, pero no la registrada: otra marca, con otras dimensiones u otra forma
    .advice = { refusal-another-model.advice }
    .kind = Otra marca
    .short = Se parece a { $nearest }, pero sus dimensiones son distintas
    .next = { step-enrol-if-painted-next }
    .compared = del mismo tipo con una probabilidad de { FIXED($likeness, 2) }: otra marca
refusal-ambiguous-pose = lo que se ve de { $part } encaja casi igual de bien en otro lugar de la pieza (margen sobre ese lugar { FIXED($margin, 2) }, necesario { FIXED($threshold, 2) })
    .advice = { see-an-edge }
    .kind = Encaja casi igual de bien en otro lugar de la pieza
    .short = { short-uncertain-pose }
    .step = { step-see-an-edge }
    .otherwise = { step-if-it-persists }
    .compared = su margen sobre otra pose es { FIXED($margin, 2) }, por debajo de { FIXED($threshold, 2) }
refusal-unconstrained = lo que se ve no determina la pose de { $part }: { free-motion }
    .advice = { see-an-edge }
    .kind = Pose no determinada
    .short = { short-uncertain-pose }
    .step = { step-see-an-edge }
    .otherwise = { step-if-it-persists }
    .compared = la pose no está determinada: { free-motion }
refusal-uncertain = la pose de { $part } tiene una incertidumbre de { MM($shift_m, 1) } mm; se admiten { MM($limit_m, 1) } mm
    .advice = { $frames_disagree ->
        [true] { scan-poses }
       *[other] { see-an-edge }
    }
    .kind = Pose con demasiada incertidumbre
    .short = { short-uncertain-pose }
    .step = { $frames_disagree ->
        [true] { step-scan-again }
       *[other] { step-see-an-edge }
    }
    .otherwise = { step-if-it-persists }
    .compared = la pose tiene una incertidumbre de { MM($shift_m, 1) } mm; se admiten { MM($limit_m, 1) } mm
refusal-unknown = desconocida: ninguna pieza registrada se le parece{ $like ->
        [true] ; la más parecida, { $nearest }, obtiene { FIXED($score, 2) }
       *[other] { "" }
    }
    .advice = Registrar la pieza si hay que pintarla; si ya está registrada, orientar la cara hacia la cámara y volver a capturar
    .kind = Desconocida: ninguna pieza registrada se le parece
    .short = Ninguna pieza registrada se le parece
    .step = { step-turn }
    .otherwise = { step-enrol-if-painted-next }
    .compared = puntuación { FIXED($score, 2) }: desconocida
refusal-mirrored = parece la imagen reflejada de { $part } (que obtiene { FIXED($score, 2) }): la pieza del otro lado del coche
    .advice = Registrar la pieza de este lado con un nombre propio, y no pintarla con la trayectoria del otro lado
    .kind = Imagen reflejada de una pieza registrada
    .short = Parece la imagen reflejada de { $nearest }
    .next = No pintarla como { $nearest }: pedir al técnico que registre la pieza de este lado
    .compared = parece la imagen reflejada de { $part }
refusal-mirrored-image = solo encaja con { $part } como imagen reflejada (que obtiene { FIXED($score, 2) }), y { $part } no tiene otro lado: es probable que la imagen tenga cambiadas izquierda y derecha
    .advice = No mover el robot según esta imagen: comparar una imagen con la pieza y, si izquierda y derecha están cambiadas, añadir "mirrored": true al JSON con los parámetros intrínsecos de la cámara
    .kind = Izquierda y derecha probablemente cambiadas en la imagen
    .short = La imagen de la cámara está reflejada
    .next = No arrancar el robot: pedir al técnico que ajuste la cámara
    .compared = solo encaja con { $part } como imagen reflejada: es probable que la imagen esté reflejada
refusal-off-scale = lo que la cámara ve de { $part } es un { PERCENT($by, 0) } % más { $is_larger ->
        [true] grande
       *[false] pequeño
    } que la referencia: los números de la cámara son erróneos, o es de otra marca
    .advice = Comprobar primero la unidad de las profundidades de la cámara y sus distancias focales (fx, fy); registrarla como otra referencia de { $part } solo si de verdad tiene otro tamaño
    .kind = Otro tamaño que la referencia: números de la cámara erróneos u otra marca
    .short = La cámara muestra { $nearest } con otro tamaño
    .next = No arrancar el robot: pedir al técnico que compruebe la cámara
    .compared = otro tamaño que la referencia
refusal-other-half = parece la imagen reflejada de lo registrado de { $part } (que obtiene { FIXED($score, 2) }): de { $part } solo está registrado un trozo, y esta puede ser la otra mitad
    .advice = Registrar { $part } entera, o esta mitad como una referencia más de ella
    .kind = Quizá la mitad no registrada de una pieza
    .short = Puede ser la otra mitad de { $nearest }
    .next = Pedir al técnico que registre { $nearest } entera
    .compared = parece la imagen reflejada del trozo registrado de { $part }
refusal-small-margin = { $part } y { $other } encajan casi igual de bien (margen { FIXED($margin, 2) }, necesario { FIXED($threshold, 2) })
    .advice = Girar la pieza con la cara hacia la cámara y volver a capturar; si ambos nombres son la misma pieza, eliminar uno de la biblioteca
    .kind = Dos piezas encajan casi igual de bien
    .short = Dos piezas registradas coinciden casi por igual
    .step = { step-turn }
    .otherwise = { step-if-two-alike }
    .compared = su margen sobre { $other } es { FIXED($margin, 2) }, por debajo de { FIXED($threshold, 2) }
refusal-wrong-part = pieza equivocada: hay { $part } en lugar de { $expected }
    .advice = Colgar { $expected } en su lugar, o corregir lo que se espera
    .kind = Otra pieza que la esperada
    .short = Hay { $nearest } en lugar de { $expected }
    .compared = se espera { $expected }
refusal-not-expected = demasiadas piezas: { $part } no se espera
    .advice = Retirar { $part }, o corregir lo que se espera
    .kind = Pieza no esperada
    .short = { $nearest } no se espera
    .compared = no se espera
refusal-expected-elsewhere = lugar equivocado: { $part } cuelga en { $place } y se espera en { $expected_at }
    .advice = Colgar { $part } en { $expected_at }, o corregir lo que se espera
    .kind = Pieza en otro lugar que el esperado
    .short = { $nearest } se espera en { $expected_at }, no en { $place }
    .compared = se espera en { $expected_at }
refusal-cut-by-volume = { $part } sale del volumen de trabajo, y dentro queda demasiado poco
    .advice = Ampliar el volumen de trabajo en el archivo del bastidor, o colgar { $part } dentro
    .kind = Cortada por el volumen de trabajo
    .short = { $nearest } sale del volumen de trabajo
    .compared = sale del volumen de trabajo
refusal-wrong-place = lugar equivocado: { $part } no puede colgar en { $place }
    .advice = Colgar { $part } en su propio lugar, o permitirla en { $place } en el archivo del bastidor
    .kind = Pieza en el lugar de otra
    .short = { $nearest } no puede colgar en { $place }
    .compared = no puede colgar en { $place }
refusal-beside-places = { $part } cuelga { MM($distance_m, 0) } mm al lado de { $place }, el lugar más cercano del bastidor
    .advice = Colgar { $part } en un lugar del bastidor, o mover el lugar en el archivo del bastidor
    .kind = Fuera de los lugares del bastidor
    .short = { $nearest } cuelga { MM($distance_m, 0) } mm al lado de { $place }
    .compared = cuelga { MM($distance_m, 0) } mm al lado de { $place }
refusal-turned = { $part } cuelga mal en { $place }: girada { DEGREES($turn_rad, 0) }°, se permiten { DEGREES($limit_rad, 0) }°
    .advice = Colgar { $part } bien orientada, o permitir esta orientación en el archivo del bastidor
    .kind = Girada en su lugar
    .short = { $nearest } cuelga girada { DEGREES($turn_rad, 0) }° en { $place }
    .compared = está girada { DEGREES($turn_rad, 0) }°, se permiten { DEGREES($limit_rad, 0) }°
refusal-unconfirmed = { $part } tiene el contorno más parecido; el comparador del artículo por sí solo no la distingue de una pieza desconocida
    .advice = Estimar también la pose: en la receta, poner «Pose mediante» en Global
    .kind = Solo con el comparador del artículo, sin pose
    .short = Solo se comparó su contorno
    .next = { step-unconfirmed-next }
    .compared = el comparador del artículo por sí solo no la distingue de una pieza desconocida
refusal-out-of-range = lo que puede ser { $part } está a { FIXED($depth_m, 2) } m de la cámara: las cámaras de profundidad miden de { $from } a { $to } m
    .advice = Comprobar la unidad del archivo o del JSON de la cámara: las longitudes van en metros; después volver a capturar
    .kind = Fuera del alcance de la cámara
    .short = Está demasiado cerca o demasiado lejos de la cámara
    .next = { step-check-camera-next }
refusal-behind-camera = el { PERCENT($share, 1) } % de los puntos está detrás de la cámara, por lo que no se sabe dónde está { $part }
    .advice = Exportar la captura en el sistema de la propia cámara: x derecha, y abajo, z adelante
    .kind = Puntos detrás de la cámara
    .short = { short-damaged-file }
    .next = { step-check-camera-next }
refusal-surplus-bytes = { $num ->
        [one] tras el último punto del archivo sigue { $num } byte: está dañado, y con él lo que puede ser { $part }
       *[other] tras el último punto del archivo siguen { $num } bytes: está dañado, y con él lo que puede ser { $part }
    }
    .advice = Copiar o exportar de nuevo el archivo desde el programa que lo creó
    .kind = Archivo dañado
    .short = { short-damaged-file }
    .next = { step-check-camera-next }
refusal-no-pose = no se encontró la pose: { $why }
    .kind = No se encontró la pose
    .short = Puede ser { $nearest }, pero no se encontró la pose
    .step = { step-turn }
    .otherwise = { step-if-it-persists }
refusal-not-steady = { $part } todavía no cuelga inmóvil
    .advice = Dejar la pieza inmóvil un segundo
    .kind = Aún no colgaba inmóvil
    .short = Todavía no cuelga inmóvil
refusal-passing = { $part } pasa por la línea, pero hasta ahora solo { $num_frames } de { $needed } imágenes la muestran entera
    .advice = Esperar un momento
    .kind = Muy pocas imágenes en la línea
    .short = Hasta ahora la muestran muy pocas imágenes
refusal-smeared = { $part } se movió { MM($smear_m, 1) } mm durante una exposición; se admiten { MM($limit_m, 1) } mm
    .advice = Reducir la velocidad de la línea o acortar la exposición de la cámara; si es más corta de lo que indica el archivo de la línea, corregir allí exposure_ms
    .kind = Línea demasiado rápida para la exposición
    .short = La línea es demasiado rápida para la exposición de la cámara
refusal-few-frames = { $part } cuelga inmóvil, y desde entonces se han inspeccionado { $num_frames } de { $needed } imágenes
    .advice = Esperar un momento
    .kind = Muy pocas imágenes desde que colgaba inmóvil
    .short = Hasta ahora se han inspeccionado pocas imágenes
refusal-too-slow = no evaluada: este ordenador es demasiado lento ({ $num_inspected } de { $num_frames } imágenes inspeccionadas)
    .advice = Elegir una imagen más pequeña u otra receta, buscar menos piezas (max_parts) o cerrar otros programas
    .kind = No evaluada: ordenador demasiado lento
    .short = Este ordenador es demasiado lento: { $num_inspected } de { $num_frames } imágenes inspeccionadas
refusal-undecided = { $num_agreeing } de { $num_frames } imágenes aceptan { $part }; se necesitan { $needed }
    .advice = Esperar un momento; si persiste, orientar la cara de la pieza hacia la cámara y retirar lo que haya delante
    .kind = Muy pocas imágenes aceptan la pieza
    .short = { short-undecided }
refusal-poses-apart = las poses de { $part } coinciden en { $num_agreeing } de { $num_frames } imágenes; se necesitan { $needed }
    .advice = Colgar la pieza de modo que nada oscile y esperar un momento; si persiste, orientar su cara hacia la cámara
    .kind = Las poses de las imágenes no coinciden
    .short = { short-undecided }

## There is no part

refusal-too-few-points = { $found ->
        [one] la escena tiene { $found } lectura; se necesitan al menos { $needed }
       *[other] la escena tiene { $found } lecturas; se necesitan al menos { $needed }
    }
    .advice = Comprobar que la cámara está conectada, descubierta y a entre 0.6 y 3 m de la pieza, y volver a capturar
    .short = La cámara apenas ve nada
    .step = { step-uncover-camera }
    .otherwise = { step-if-it-persists }
refusal-too-wide = la escena abarca { FIXED($extent_m, 0) } m y no contiene nada del tamaño de una pieza
    .advice = Pulsar «Leer como milímetros» si se ofrece abajo, o exportarla en metros; en una imagen de profundidad, corregir metres_per_unit en el JSON que la acompaña
    .short = La escena es mucho mayor que una celda
    .next = { step-ask }
refusal-only-background = no hay nada del tamaño de una pieza delante del fondo ({ $planes ->
        [one] 1 plano eliminado
       *[other] { $planes } planos eliminados
    }, resto mayor { FIXED($found_m2, 3) } m², necesario { FIXED($needed_m2, 3) } m²)
    .advice = { $knows_cell ->
        [true] Colgar la pieza delante de la cámara, a 10 cm o más de la pared, y volver a capturar; si ya colgaba ahí al capturar la celda vacía, capturar esta de nuevo sin la pieza
       *[other] Colgar la pieza delante de la cámara, a 10 cm o más de la pared, y volver a capturar
    }
    .short = No cuelga ninguna pieza delante de la cámara
    .step = { step-hang }
    .otherwise = { $knows_cell ->
        [true] { step-if-it-hangs-there }
       *[other] { "" }
    }
refusal-no-plane = los { $num_points } puntos de la pieza están en una línea o un punto ({ FIXED($width_m, 4) } m de ancho)
    .advice = Girar la pieza con la cara hacia la cámara y volver a capturar
    .short = { short-hardly-seen }
    .step = { step-turn }
    .otherwise = { step-if-it-persists }
refusal-too-large = la pieza abarca { FIXED($found_m, 1) } m; una imagen cubre { FIXED($limit_m, 1) } m
    .advice = Comprobar que el archivo está en metros, o quitar de la escena todo salvo la pieza; en una imagen de profundidad, corregir metres_per_unit en el JSON que la acompaña
    .short = Se ve algo mucho mayor que una pieza
    .step = { step-clear }
    .otherwise = { step-if-it-persists }
refusal-no-shape = la imagen binaria no contiene ninguna forma con área ({ $num_set } píxeles activos)
    .advice = Aumentar el hueco que se cierra, o acercar la pieza a la cámara, y volver a capturar
    .short = { short-hardly-seen }
    .step = { step-nearer }
    .otherwise = { step-if-it-persists }
refusal-no-outline = el contorno de { $num_points } puntos no tiene longitud
    .advice = Acercar la pieza a la cámara y volver a capturar
    .short = { short-hardly-seen }
    .step = { step-nearer }
    .otherwise = { step-if-it-persists }
refusal-empty-library = no hay ninguna pieza registrada en la biblioteca
    .advice = Registrar primero una pieza, en Registro
    .short = { short-no-parts-why }
    .next = { step-ask }
refusal-fault = error interno del programa: { $message }
    .advice = Conservar el archivo o la imagen y notificarlo con este mensaje; las inspecciones posteriores no se ven afectadas
    .short = { short-fault }
    .next = { step-ask }

## Parts of these texts

model-surface = { MM($relief_m, 1) ->
        [0.0] { "" }
       *[other] la superficie se desvía { MM($relief_m, 1) } mm
    }
model-outline = { MM($outline_m, 1) ->
        [0.0] { "" }
       *[other] { MM($relief_m, 1) ->
            [0.0] el contorno se desvía { MM($outline_m, 1) } mm
           *[other] el contorno { MM($outline_m, 1) } mm
        }
    }
model-missing = { PERCENT($missing, 1) ->
        [0.0] { "" }
       *[other] falta el { PERCENT($missing, 1) } %
    }
piece-hidden = Retirar lo que hay delante de la pieza y volver a capturar
piece-outside = Colgar la pieza más adentro de la imagen y volver a capturar
piece-hidden-or-outside = Retirar lo que hay delante de la pieza, o colgarla más adentro de la imagen, y volver a capturar
see-an-edge = Girar la pieza o mover la cámara hasta que se vea una esquina u otro borde de la pieza, y volver a capturar
scan-poses = Comprobar primero la pose del robot de cada toma y la calibración mano-ojo, y escanear de nuevo; si ambas son correctas, mover la cámara para que vea una esquina u otro borde de la pieza
short-uncertain-pose = Reconocida, pero su pose es incierta
short-damaged-file = El archivo capturado está dañado
short-undecided = Las imágenes no concuerdan
short-hardly-seen = Se ve demasiado poco de la pieza
short-fault = El programa ha fallado con esta imagen
short-no-parts-why = No hay ninguna pieza registrada en la biblioteca
step-unconfirmed-next = Pedir al técnico que active también la estimación de la pose
step-uncover = Retirar lo que tapa la pieza
step-all-in-picture = Orientar la cara hacia la cámara, toda dentro de la imagen
step-see-an-edge = Girar la pieza hasta que se vea una esquina u otro borde
step-turn = Orientar la cara hacia la cámara
step-clear = Retirar todo menos la pieza
step-nearer = Colgar la pieza más cerca de la cámara
step-scan-again = Escanear de nuevo la pieza sin que nada se mueva
step-hang = Colgar la pieza delante de la cámara, a 10 cm o más de la pared
step-uncover-camera = Retirar lo que tapa la cámara
step-if-it-persists = Si persiste, avisar al técnico
step-if-two-alike = Si persiste, pedir al técnico que elimine una de las dos de la biblioteca
step-enrol-if-painted-next = Si hay que pintarla, pedir al técnico que la registre
step-check-camera-next = Pedir al técnico que compruebe la cámara y sus archivos
step-ask = Avisar al técnico
step-if-it-hangs-there = Si ya cuelga ahí, pedir al técnico que capture de nuevo la celda vacía
