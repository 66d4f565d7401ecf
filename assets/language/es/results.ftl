# What the library says of a result

## Verdicts

results-accepted = Aceptada
results-not-accepted = No aceptada
results-unknown = Desconocida
results-no-part = Sin pieza
results-recipe-as-in-the-paper = Como en el artículo
results-recipe-modified = { $name } (modificada)
results-title-not-recognised = No reconocida · la más parecida: { $part }
results-title-refused = { $part } · no aceptada
results-title-unknown = Desconocida · la más parecida: { $part }
results-title-mirrored = Imagen reflejada de { $part }
results-keep-all = Todas
results-keep-not-accepted = Las no aceptadas
results-keep-none = Ninguna

## Why a part is not accepted

results-low-score = la mejor coincidencia, { $part }, obtiene { $score }, por debajo del umbral de { $threshold }
results-piece = solo se ve una parte de { $part } ({ $hidden } % oculto, { $outside } % fuera de la imagen); obtiene { $score }, por debajo del umbral de { $threshold }
results-hardly-seen = lo que puede ser { $part } apenas se ve: casi de canto, o cortado por la mayoría de los lados
results-another-model = se parece a { $part }, pero no es igual: la superficie se desvía { $relief }, el contorno { $outline }, y falta el { $missing } %; otro modelo, la pose es aproximada
results-another-make = es del tipo de { $part }, pero no la registrada: otra marca, con otras dimensiones u otra forma
results-ambiguous-pose = lo que se ve de { $part } encaja casi igual de bien en otro lugar de la pieza (margen sobre ese lugar { $margin }, necesario { $threshold })
results-unconstrained = lo que se ve no determina la pose de { $part }: { $freedom }
results-uncertain = la pose de { $part } tiene una incertidumbre de { $shift }; se admiten { $limit }
results-unknown-nearest = desconocida: ninguna pieza registrada se le parece; la más parecida, { $nearest }, obtiene { $score }
results-unknown-alone = desconocida: ninguna pieza registrada se le parece
results-mirrored = parece la imagen reflejada de { $part } (que obtiene { $score }): la pieza del otro lado del coche
results-mirrored-image = solo encaja con { $part } como imagen reflejada (que obtiene { $score }), y { $part } no tiene otro lado: es probable que la imagen tenga cambiadas izquierda y derecha
results-small-margin = { $part } y { $other } encajan casi igual de bien (margen { $margin }, necesario { $threshold })
results-unconfirmed = { $part } tiene el contorno más parecido; el comparador del artículo por sí solo no la distingue de una pieza desconocida
results-out-of-range = lo que puede ser { $part } está a { $depth } m de la cámara: las cámaras de profundidad miden de 0.1 a 20 m
results-behind-camera = el { $share } % de los puntos está detrás de la cámara, por lo que no se sabe dónde está { $part }
results-surplus-bytes = tras el último punto del archivo siguen { $num } bytes: está dañado, y con él lo que puede ser { $part }
results-no-pose = no se encontró la pose: { $why }
results-not-steady = { $part } todavía no cuelga inmóvil
results-few-frames = { $part } cuelga inmóvil, y desde entonces se han inspeccionado { $num } de { $needed } imágenes
results-undecided = { $agreeing } de { $num } imágenes aceptan { $part }; se necesitan { $needed }
results-poses-apart = las poses de { $part } coinciden en { $agreeing } de { $num } imágenes; se necesitan { $needed }

## The same where refusals are counted

results-kind-low-score = Puntuación por debajo del umbral
results-kind-piece = Solo se ve una parte de la pieza
results-kind-hardly-seen = La pieza apenas se ve
results-kind-another-model = Otro modelo
results-kind-another-make = Otra marca
results-kind-ambiguous-pose = Encaja casi igual de bien en otro lugar de la pieza
results-kind-unconstrained = Pose no determinada
results-kind-uncertain = Pose con demasiada incertidumbre
results-kind-unknown = Desconocida: ninguna pieza registrada se le parece
results-kind-mirrored = Imagen reflejada de una pieza registrada
results-kind-mirrored-image = Izquierda y derecha probablemente cambiadas en la imagen
results-kind-small-margin = Dos piezas encajan casi igual de bien
results-kind-unconfirmed = Solo con el comparador del artículo, sin pose
results-kind-out-of-range = Fuera del alcance de la cámara
results-kind-behind-camera = Puntos detrás de la cámara
results-kind-surplus-bytes = Archivo dañado
results-kind-no-pose = No se encontró la pose
results-kind-not-steady = Aún no colgaba inmóvil
results-kind-few-frames = Muy pocas imágenes desde que colgaba inmóvil
results-kind-undecided = Muy pocas imágenes aceptan la pieza
results-kind-poses-apart = Las poses de las imágenes no coinciden

## What to do about it

results-low-score-advice = Comprobar que esta pieza está registrada y que nada la tapa, y volver a capturar
results-small-margin-advice = Girar la pieza con la cara hacia la cámara y volver a capturar; si ambos nombres son la misma pieza, eliminar uno de la biblioteca
results-hidden-piece-advice = Retirar lo que hay delante de la pieza y volver a capturar
results-outside-piece-advice = Colgar la pieza más adentro de la imagen y volver a capturar
results-piece-advice = Retirar lo que hay delante de la pieza, o colgarla más adentro de la imagen, y volver a capturar
results-hardly-seen-advice = Girar la pieza con la cara hacia la cámara, toda dentro de la imagen, y volver a capturar
results-see-an-edge-advice = Mover la cámara para que vea una esquina u otro borde de la pieza, y volver a capturar
results-another-model-advice = Si también hay que pintar esta, registrarla como otra referencia de { $part }
results-unknown-advice = Registrar la pieza si hay que pintarla; si ya está registrada, orientar la cara hacia la cámara y volver a capturar
results-mirrored-advice = Registrar la pieza de este lado con un nombre propio, y no pintarla con la trayectoria del otro lado
results-mirrored-image-advice = No mover el robot según esta imagen: comparar una imagen con la pieza y, si izquierda y derecha están cambiadas, añadir "mirrored": true al JSON con los parámetros intrínsecos de la cámara
results-unconfirmed-advice = Estimar también la pose: en la receta, poner «Pose mediante» en Global
results-out-of-range-advice = Comprobar la unidad del archivo o del JSON de la cámara: las longitudes van en metros; después volver a capturar
results-behind-camera-advice = Exportar la captura en el sistema de la propia cámara: x derecha, y abajo, z adelante
results-surplus-bytes-advice = Copiar o exportar de nuevo el archivo desde el programa que lo creó
results-not-steady-advice = Dejar la pieza inmóvil un segundo
results-few-frames-advice = Esperar un momento
results-undecided-advice = Esperar un momento; si persiste, orientar la cara de la pieza hacia la cámara y retirar lo que haya delante
results-poses-apart-advice = Colgar la pieza de modo que nada oscile y esperar un momento; si persiste, orientar su cara hacia la cámara

## Why there is no part

results-too-few-readings = la escena tiene { $found } lecturas; se necesitan al menos { $needed }
results-too-few-readings-advice = Comprobar que la cámara está conectada, descubierta y a entre 0.6 y 3 m de la pieza, y volver a capturar
results-too-wide = la escena abarca { $extent } m y no contiene nada del tamaño de una pieza
results-too-wide-advice = Pulsar «Leer como milímetros» si se ofrece abajo, o exportarla en metros; en una imagen de profundidad, corregir metres_per_unit en el JSON que la acompaña
results-only-background = no hay nada del tamaño de una pieza delante del fondo ({ $planes ->
        [one] 1 plano eliminado
       *[other] { $planes } planos eliminados
    }, resto mayor { $found } m², necesario { $needed } m²)
results-only-background-advice = Colgar la pieza delante de la cámara, a 10 cm o más de la pared, y volver a capturar
results-known-cell-advice = Colgar la pieza delante de la cámara, a 10 cm o más de la pared, y volver a capturar; si ya colgaba ahí al capturar la celda vacía, capturar esta de nuevo sin la pieza
results-empty-library = no hay ninguna pieza registrada en la biblioteca
results-empty-library-advice = Registrar primero una pieza, en Registro
results-no-plane = los { $num } puntos de la pieza están en una línea o un punto ({ $width } m de ancho)
results-no-plane-advice = Girar la pieza con la cara hacia la cámara y volver a capturar
results-too-large = la pieza abarca { $found } m; una imagen cubre { $limit } m
results-too-large-advice = Comprobar que el archivo está en metros, o quitar de la escena todo salvo la pieza; en una imagen de profundidad, corregir metres_per_unit en el JSON que la acompaña
results-no-shape = la imagen binaria no contiene ninguna forma con área ({ $num } píxeles activos)
results-no-shape-advice = Aumentar el hueco que se cierra, o acercar la pieza a la cámara, y volver a capturar
results-no-outline = el contorno de { $num } puntos no tiene longitud
results-no-outline-advice = Acercar la pieza a la cámara y volver a capturar

## Poses

results-slide-long = puede deslizarse a lo largo de su lado largo
results-slide-short = puede deslizarse a lo largo de su lado corto
results-slide-normal = puede moverse perpendicularmente a su superficie
results-turn-long = puede girar en torno a su lado largo
results-turn-short = puede girar en torno a su lado corto
results-turn-normal = puede girar en torno al eje perpendicular a su superficie
results-anyhow = puede deslizarse o girar
results-source = origen
results-target = destino
results-few-points = la nube de { $which } tiene { $found } puntos; se necesitan al menos { $needed }
results-few-points-advice = Capturar la pieza desde más cerca, o registrarla de nuevo
results-degenerate = la nube de { $which } deja la pose libre: sus puntos están en una línea o un punto ({ $width } m de ancho)
results-degenerate-advice = Usar una nube que muestre una superficie, no una línea ni un único punto
results-one-sided-pairs = los puntos más próximos de los { $num } pares están en un punto o una línea, a { $rms }
results-no-overlap = las nubes solo tienen { $found } pares de puntos a menos de { $reach }; se necesitan al menos { $needed }
results-no-overlap-advice = Comprobar que ambas nubes muestran la misma pieza en metros
results-sizes-differ = una nube es { $ratio } veces mayor que la otra
results-sizes-differ-advice = Exportar ambas en metros: una parece estar en milímetros
results-too-far-out = la nube de { $which } está a { $distance } m del origen, demasiado lejos para resolver sus puntos
results-too-far-out-advice = Restar un mismo desplazamiento a ambas nubes antes de exportarlas
results-no-reference-cloud = la referencia es una forma plana sin nube
results-no-reference-cloud-advice = Registrar la pieza a partir de una captura, una nube o una malla
results-pose-cancelled = se canceló la estimación
results-pose-cancelled-advice = Iniciarla de nuevo
results-little-overlap = solo el { $overlap } % del origen está sobre el destino; se necesita al menos el { $needed } %
results-another-pose = otra pose encaja igual de bien (su coste es { $ratio } veces mayor)
results-larger = lo que ve la cámara es un { $percent } % más grande que la referencia
results-smaller = lo que ve la cámara es un { $percent } % más pequeño que la referencia
results-off-scale-advice = Comprobar la unidad de las profundidades de la cámara y sus distancias focales (fx, fy): la pose se desvía ese mismo porcentaje de la distancia
results-loose = la pose no está determinada: { $freedom }
results-unsettled = la pose seguía moviéndose tras { $num } iteraciones
results-little-overlap-advice = Comprobar que ambas nubes muestran lo mismo y comparten al menos la mitad
results-converged = convergió
results-below-target = bajo el objetivo
results-iteration-limit = límite de iteraciones
results-no-progress = sin avance

## The check of the cell

results-cell-in-place = la cámara y la pieza están en su sitio
results-cell-in-place-advice = No hay que hacer nada
results-cell-part-moved = la pieza se movió; la cámara no
results-cell-part-moved-advice = Colgar la pieza como estaba, o revisar lo que la sujeta, y comprobar de nuevo; si ha de quedarse así, tomar un nuevo estado inicial
results-cell-camera-moved = la cámara se movió
results-cell-camera-moved-advice = Fijar la cámara, calibrarla de nuevo y después tomar un nuevo estado inicial
results-cell-part-or-camera-moved = la pieza o la cámara se movió
results-cell-part-or-camera-moved-advice = Colgar la pieza como estaba y comprobar de nuevo; si no basta, la cámara se movió: calibrarla y tomar un nuevo estado inicial
results-cell-noisier = la cámara y la pieza están en su sitio, pero las lecturas tienen más ruido
results-cell-noisier-advice = Limpiar la ventana de la cámara, buscar luz parásita o niebla delante de ella y comprobar de nuevo
results-cell-no-frame = ninguna imagen
results-cell-no-frame-advice = Capturar la pieza que comprueba la celda e indicar el archivo
results-cell-moving = las imágenes no coinciden: en la imagen { $frame } la pieza está { $shift } y { $turn } fuera de donde está en la primera
results-cell-moving-advice = Dejar la pieza quieta, no mover la cámara y capturar de nuevo
results-cell-other-part = solo el { $overlap } % de lo que se ve en la imagen { $frame } está sobre la pieza del estado inicial
results-cell-other-part-advice = Colgar la pieza del estado inicial en su sitio habitual, sin nada delante; si está colgada allí, la cámara o la pieza se movió varios centímetros
results-cell-pose = imagen { $frame }: { $error }

## The simulated cell

results-object-hood = capó
results-object-wheel = rueda
results-object-box = caja
results-object-chair = silla
results-object-board = tablero
results-object-ladder = escalera
results-object-stool = taburete
results-object-bucket = cubo

## The recipe

results-group-segmentation = Segmentación
results-group-binary-image = Imagen binaria
results-group-contour = Contorno y rayos
results-group-match = Comparación
results-group-pose = Pose
results-group-icp-ga = ICP-GA
results-group-acceptance = Aceptación
results-group-stand-off = Distancia de boquilla
results-segment-plane-distance = Distancia al plano
results-segment-plane-distance-help = d_t del artículo: un punto más cerca que esto (más el ruido) de un plano de fondo pertenece a él. Aumentarla elimina lo que está cerca de la pared.
results-segment-noise-at-1m = Ruido de profundidad a 1 m
results-segment-noise-at-1m-help = Desviación típica de la profundidad a 1 m; crece con el cuadrado de la profundidad. Se usa hasta que un plano muestra la real.
results-segment-noise-factor = Factor de ruido
results-segment-noise-factor-help = Cuántas desviaciones típicas de ruido pertenecen aún a un plano. Aumentarlo elimina lo que está cerca de la pared; reducirlo deja restos de pared.
results-segment-good-sample-probability = Probabilidad de buena muestra
results-segment-good-sample-probability-help = p de la ec. 1 del artículo: la probabilidad de que al menos una muestra aleatoria sea buena. Aumentarla cuesta tiempo.
results-segment-max-planes = Planos como máximo
results-segment-max-planes-help = Número máximo de planos de fondo que se eliminan: pared, suelo y uno más. Aumentarlo cuesta tiempo y puede quitar una pieza plana.
results-segment-link-distance = Distancia de unión
results-segment-link-distance-help = Los puntos vecinos más separados que esto (más el ruido) no están unidos. Aumentarla une lo que cuelga cerca de la pieza; reducirla fragmenta la pieza.
results-segment-min-part-area = Área mínima de pieza
results-segment-min-part-area-help = Las superficies menores no son piezas. Aumentarla rechaza piezas pequeñas; reducirla toma objetos sueltos por piezas.
results-segment-seed = Semilla de los planos
results-segment-seed-help = Semilla de las muestras aleatorias. Otra semilla no cuesta nada; un resultado que cambia con ella se apoya en indicios débiles.
results-project-pixel = Píxel
results-project-pixel-help = Lado de un píxel de la imagen binaria. Por debajo de la separación de los puntos aparecen huecos; aumentarlo difumina el contorno.
results-project-closed-gap = Cerrar huecos hasta
results-project-closed-gap-help = Se cierran los huecos de hasta esta anchura. Aumentarlo rellena aberturas estrechas reales.
results-contour-min-opening-area = Abertura mínima
results-contour-min-opening-area-help = Las aberturas menores se tratan como fallos del sensor. Aumentarla pierde aberturas reales.
results-signature-num-rays = Rayos
results-signature-num-rays-help = Rayos alrededor del contorno. Más rayos cuestan tiempo en la clasificación y resuelven detalles menores.
results-signature-smoothing = Suavizado
results-signature-smoothing-help = El contorno se promedia en esta longitud antes de trazar los rayos. Aumentarlo perdona bordes irregulares y redondea esquinas.
results-rank-matcher = Comparador
results-rank-matcher-help = Predeterminado: correlación circular de los rayos como números complejos y después solape de las imágenes. Artículo: algoritmo 2 al pie de la letra; no tiene umbral propio.
results-rank-num-overlaid = Colocaciones superpuestas
results-rank-num-overlaid-help = Colocaciones de cada pieza registrada que se superponen a la imagen de la escena. Aumentarlas cuesta tiempo y ayuda con piezas casi simétricas.
results-rank-outline-tolerance = Tolerancia del contorno
results-rank-outline-tolerance-help = Distancia entre contornos a la que la puntuación ha caído a 1/e. Aumentarla perdona contornos distintos.
results-rank-num-compared = Comparadas por completo
results-rank-num-compared-help = Número máximo de referencias registradas que se comparan por completo, primero las más parecidas en tamaño y forma general. Aumentarlo cuesta tiempo en bibliotecas de miles y encuentra piezas de las que se ve poco.
results-rank-parallel-from = Todos los núcleos desde
results-rank-parallel-from-help = Referencias registradas a partir de las que clasifican todos los núcleos; la clasificación no cambia. Reducirlo cuesta tiempo cuando arrancarlos tarda más que clasificar.
results-pose = Pose mediante
results-pose-help = Global: las mejores piezas se colocan en su sitio y se buscan allí. ICP: el del artículo, desde un inicio. Ninguna: el resultado se apoya solo en el contorno y es más rápido.
results-confirm-num-references = Piezas buscadas
results-confirm-num-references-help = Número de piezas mejor clasificadas que se confirman en la escena. Cada una más cuesta unos 1.5 ms y ayuda con piezas medio ocultas.
results-confirm-tolerance = Tolerancia de superficie
results-confirm-tolerance-help = Distancia a una pieza registrada a la que un punto sin ruido aún está sobre ella. Aumentarla perdona abolladuras y piezas parecidas.
results-confirm-seed = Semilla del diezmado
results-confirm-seed-help = Semilla para reducir los puntos. Otra semilla toma otros puntos y no cuesta nada.
results-icp-max-iterations = Iteraciones ICP como máximo
results-icp-max-iterations-help = Máximo de iteraciones de ICP. Aumentarlo cuesta tiempo en proporción.
results-icp-target-e-m2 = ICP se conforma bajo
results-icp-target-e-m2-help = El algoritmo 3 se detiene por debajo de este E; el 1e-6 m² del artículo es 1 mm². Aumentarlo termina la búsqueda antes y con menos detalle.
results-icp-max-source-points = Puntos ICP como máximo
results-icp-max-source-points-help = Puntos de la pieza de la escena que usa ICP, reducidos de forma uniforme. Aumentarlo cuesta tiempo en proporción.
results-icp-shift-tolerance = ICP desplazamiento mínimo
results-icp-shift-tolerance-help = Un paso que desplaza menos que esto (y gira poco) termina la búsqueda. Aumentarlo la termina antes.
results-icp-turn-tolerance = ICP giro mínimo
results-icp-turn-tolerance-help = Un paso que gira menos que esto (y desplaza poco) termina la búsqueda. Aumentarlo la termina antes.
results-icp-ga-target-e-m2 = E objetivo de ICP-GA
results-icp-ga-max-rounds = Rondas como máximo
results-icp-ga-patience = Paciencia
results-icp-ga-least-progress = Avance mínimo
results-icp-ga-vicinity-range = Entorno
results-icp-ga-turn-range = Giros en otro lugar
results-icp-ga-shift-range = Desplazamientos en otro lugar
results-icp-ga-num-fine-points = Puntos cerca
results-icp-ga-num-coarse-points = Puntos en otro lugar
results-icp-ga-seed = Semilla de ICP-GA
results-icp-ga-icp-max-iterations = Ronda: iteraciones ICP
results-icp-ga-icp-target-e-m2 = Ronda: E objetivo de ICP
results-icp-ga-icp-max-source-points = Ronda: puntos ICP
results-icp-ga-icp-shift-tolerance = Ronda: ICP desplazamiento mínimo
results-icp-ga-icp-turn-tolerance = Ronda: ICP giro mínimo
results-icp-ga-vicinity-population = Cerca: población
results-icp-ga-vicinity-generations = Cerca: generaciones
results-icp-ga-vicinity-tournament = Cerca: torneo
results-icp-ga-vicinity-crossover-rate = Cerca: cruce
results-icp-ga-vicinity-mutation-rate = Cerca: mutación
results-icp-ga-vicinity-mutation-decades = Cerca: décadas de mutación
results-icp-ga-vicinity-half-turn-rate = Cerca: medias vueltas
results-icp-ga-elsewhere-population = En otro lugar: población
results-icp-ga-elsewhere-generations = En otro lugar: generaciones
results-icp-ga-elsewhere-tournament = En otro lugar: torneo
results-icp-ga-elsewhere-crossover-rate = En otro lugar: cruce
results-icp-ga-elsewhere-mutation-rate = En otro lugar: mutación
results-icp-ga-elsewhere-mutation-decades = En otro lugar: décadas de mutación
results-icp-ga-elsewhere-half-turn-rate = En otro lugar: medias vueltas
results-accept-min-score = Aceptar desde
results-accept-min-score-help = Puntuación mínima. Aumentarla convierte dictámenes erróneos en rechazos, y también algunos correctos.
results-accept-min-likeness = Otra marca desde
results-accept-min-likeness-help = A partir de este parecido, una pieza no registrada se nombra como de otra marca. Aumentarlo llama desconocidas a más piezas.
results-accept-min-margin = Margen mínimo
results-accept-min-margin-help = Ventaja mínima sobre la pieza siguiente y sobre otra pose: la diferencia de sus probabilidades cuando solo una puede ser correcta. Aumentarlo rechaza piezas parecidas.
results-accept-unknown-below = Desconocida por debajo de
results-accept-unknown-below-help = Una mejor coincidencia por debajo de esta puntuación se da por desconocida. Aumentarla nombra menos piezas medio ocultas.
results-accept-max-relief = Mismo modelo: relieve
results-accept-max-relief-help = Cuánto puede abombarse o hundirse la superficie respecto a la referencia. Aumentarlo acepta otros modelos, con pose aproximada.
results-accept-max-missing = Mismo modelo: ausencias
results-accept-max-missing-help = Proporción de la referencia que puede faltar en la escena. Aumentarla acepta otros modelos, con pose aproximada.
results-accept-max-outline-shift = Mismo modelo: contorno
results-accept-max-outline-shift-help = Cuánto pueden desviarse tramos del contorno respecto a la referencia. Aumentarlo acepta otros modelos, con pose aproximada.
results-accept-max-uncertainty = Incertidumbre de pose máxima
results-accept-max-uncertainty-help = Mayor cota (95 %) del desplazamiento de la pose. Aumentarla acepta poses conocidas con menos exactitud.
results-stand-off-taught = Distancia enseñada
results-stand-off-taught-help = Distancia de la boquilla a la pieza cuando se enseñó la trayectoria (la d estándar del artículo).
results-stand-off-nearest = Banda desde
results-stand-off-nearest-help = Menor distancia que aún pinta bien. Aumentarla considera demasiado cerca más parte de la trayectoria.
results-stand-off-farthest = Banda hasta
results-stand-off-farthest-help = Mayor distancia que aún pinta bien. Aumentarla perdona más parte de la trayectoria.
results-stand-off-num-rays = Rayos de la trayectoria
results-stand-off-num-rays-help = Puntos de la trayectoria supuesta que se evalúan. Cada uno más cuesta unos 2 µs; aumentarlos encuentra un punto peor más pequeño.
results-option-default = Predeterminado
results-option-paper = Artículo
results-option-global = Global
results-option-none = Ninguna
