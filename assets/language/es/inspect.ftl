# The Inspect workspace

## The verdict

inspect-unknown-part = Pieza desconocida
inspect-not-recognised = No reconocida
inspect-no-verdict = Sin resultado
inspect-live-stopped = En vivo se detuvo antes de que un resultado contara
inspect-stopped-moving = algo se movía cuando se detuvo En vivo
inspect-press-capture = Pulsar Capturar
inspect-something-moves = algo se mueve delante de la cámara
inspect-looking = Buscando
inspect-not-long-enough = aún no se ha visto el tiempo suficiente
inspect-it-is-steady = está inmóvil
inspect-not-accepted-yet = Aún no aceptada
inspect-nearest = La más parecida: { $part }
inspect-recognised = Reconocida
inspect-hold-simulated = Simulada: no se leyó ninguna cámara
inspect-hold-replayed = Reproducida de una grabación: la pieza no cuelga ahí
inspect-hold-choose-camera = Elegir una cámara como fuente
inspect-hold-choose-camera-operator = Pedir al técnico que elija una cámara
inspect-hold-not-calibrated = Sin calibrar: el robot no recibe la pose
inspect-hold-not-calibrated-operator = No arrancar el robot: llamar al técnico para que calibre la celda
inspect-hold-clock-operator = No arrancar el robot: llamar al técnico para que ponga los relojes en hora
inspect-hold-old = Capturada hace más de 10 minutos: ahora puede colgar de otro modo
inspect-hold-old-file = De un archivo de más de 10 minutos: ahora puede colgar de otro modo
inspect-hold-open-newer = Abrir una captura más reciente o elegir una cámara como fuente

## The card

inspect-previous-result = Resultado anterior: hay una inspección en curso
inspect-outdated = Resultado anterior: desde entonces no ha llegado nada de la fuente
inspect-from-history = Del historial, no es la pieza actual
inspect-other-empty-cell = La celda vacía es de otra cámara y no se usa; captúrela de nuevo con esta
inspect-touches-edge = La pieza llega al borde de la imagen: puede faltar una parte
inspect-approximate = La pose es aproximada: puede ser otro modelo de la pieza
inspect-parts-accepted = { $num } de { $all } aceptadas
inspect-export = Exportar…
inspect-export-says = Un informe: JSON, una página PDF, una fila en una tabla de poses y las imágenes de todas las etapas (Ctrl E)
inspect-wrong-part = ¿Otra pieza?
inspect-wrong-part-says = Ver en Comparar por qué se reconoció como esta pieza
inspect-why = ¿Por qué?
inspect-why-says = Ver en Comparar por qué no se acepta
inspect-enrol-this = Registrar esta pieza
inspect-add-reference = Añadir una referencia
inspect-calibrate = Calibrar la celda
inspect-copy-pose = Copiar pose
inspect-copy-pose-says = En la convención elegida, indicada en la primera línea (Ctrl Mayús C)
inspect-score-itself = Puntuación de la pieza misma, no de su imagen reflejada
inspect-as-part = Como { $part } (no aceptada)
inspect-next = Siguiente: { $part } { $score }
inspect-threshold = umbral { $score }
inspect-margin = Margen sobre la siguiente pieza { $margin }
inspect-margin-says = Diferencia de las dos probabilidades si solo puede colgar ahí una de las dos piezas; no es la diferencia de las puntuaciones
inspect-offset = Desplazamiento respecto a la posición estándar
inspect-measured-from = Medido desde { $part }, otra referencia de esta pieza
inspect-offset-note = Centro de la pieza, ejes de la cámara · R = Rz·Ry·Rx
inspect-fit = Ajuste
inspect-rms = rms
inspect-overlap = solape
inspect-unconstrained = No determinada: { $freedom }
inspect-pose-uncertainty = incertidumbre de pose (95 %)
inspect-runner-up = segunda mejor pose
inspect-times-worse = { $ratio }× peor
inspect-as-good = igual de buena
inspect-iterations = { $num ->
        [one] { $num } iteración
       *[other] { $num } iteraciones
    }
inspect-ambiguous = Otra pose encaja igual de bien: comprobar en qué sentido cuelga la pieza
inspect-surface = Superficie
inspect-surface-is = Superficie: { $verdict }
inspect-surface-advice = Mire las zonas rodeadas antes de que la pieza continúe
inspect-surface-region = zona que se desvía
inspect-surface-frames = fotogramas promediados
inspect-surface-seen = evaluado del lado de la cámara
inspect-surface-noise = ruido del promedio
inspect-surface-smallest = abolladura de { $width }, se detecta desde
inspect-inspection = Inspección
inspect-time = tiempo
inspect-scene = escena
inspect-simulated = simulada
inspect-serial = n.º de serie
inspect-order = orden
inspect-operator = operador
inspect-recipe = receta

## Stand-off

inspect-stand-off = Distancia de boquilla de una trayectoria supuesta
inspect-stand-off-stored = Distancia de boquilla de la trayectoria guardada
inspect-mean = media
inspect-worst-of = { $value }, peor { $worst }
inspect-in-band = dentro de la banda
inspect-points-in-band = { $inside } de { $num } puntos
inspect-points-not-seen = Sin comprobar en { $count } de { $all } puntos, donde la cámara no ve la pieza
inspect-path-not-seen = La cámara no ve la pieza en ningún punto de la trayectoria
inspect-angle = ángulo
inspect-angle-counts = { $count ->
        [0] Dentro de la banda exige también un ángulo de { $limit } como máximo
        [one] Dentro de la banda exige también un ángulo de { $limit } como máximo; en 1 punto es mayor
       *[other] Dentro de la banda exige también un ángulo de { $limit } como máximo; en { $count } puntos es mayor
    }
inspect-path-fits = La trayectoria sirve sin la pose
inspect-path-needs-pose = El programa del robot debe aplicar la pose a la trayectoria
inspect-stand-off-of = Distancia de boquilla { $mean }, de { $nearest } a { $farthest }

## The pose for the robot

inspect-robot-frame = Sistema de la base del robot, según { $name }
inspect-camera-frame = Sistema de la cámara: la celda no está calibrada
inspect-camera-frame-only = Sistema de la cámara: un robot no debe usar este resultado
inspect-convention-of = Convención: { $name }
inspect-convention-says = Convención de la pose tal como se muestra, copia y escribe; la de las respuestas a robots está en Robot…
inspect-no-pose-to-copy = No hay pose que copiar: la pieza no se aceptó
inspect-no-pose-advice = Seguir el consejo de la ficha y volver a capturar
inspect-pose-copied = { $name } copiado en la convención { $convention }

## The view

inspect-colour = Color · { $colouring }
inspect-show = Mostrar
inspect-export-path = Exportar trayectoria de pintura…
inspect-export-path-says = Requiere una pieza aceptada con trayectoria de pintura guardada y una celda calibrada
inspect-measure = Medir
inspect-measure-says = Hacer clic en dos puntos (M)
inspect-picture = Imagen…
inspect-picture-says = Guardar una imagen de la vista (P)
inspect-fit-view = Encuadrar
inspect-fit-view-says = Encuadrar la pieza (F)
inspect-front = Frente
inspect-top = Arriba
inspect-side = Lado
inspect-part-axes = Ejes de la pieza
inspect-part-camera = Cámara de profundidad
inspect-part-outline = Contorno registrado
inspect-part-nozzle-middle = Boquilla sobre el centro
inspect-part-nozzle-worst = Boquilla en el peor punto
inspect-part-spray-path = Trayectoria de pintura
inspect-part-shot-cameras = Cámaras de las tomas
inspect-part-unseen = No visto por ninguna toma
inspect-needs-pose = Requiere una pieza reconocida cuya pose se haya encontrado
inspect-needs-camera = Requiere una sola captura cuya cámara se conozca
inspect-needs-no-path = Requiere una pieza aceptada sin trayectoria de pintura guardada
inspect-needs-path = Requiere una pieza aceptada con trayectoria de pintura guardada
inspect-needs-calibration = Requiere una celda calibrada
inspect-needs-scan = Requiere un escaneo
inspect-caption-planes = { $points } puntos · pieza { $part } · { $planes ->
        [one] 1 plano de fondo eliminado
       *[other] { $planes } planos de fondo eliminados
    }
inspect-caption-shots = { $points } puntos · pieza { $part } · { $shots } tomas juntas
inspect-no-camera-read = { $scene } · sin cámara
inspect-view-of-scene = Vista 3D de la escena
inspect-other-surface = Otra superficie
inspect-taught-nozzle = Boquilla supuesta
inspect-worst = Peor
inspect-path-in-band = Trayectoria de pintura · { $inside } de { $num } en la banda

## The stages

inspect-contour = Contorno
inspect-signatures = Signaturas
inspect-ranking = Clasificación
inspect-alignment = Alineación
inspect-enlarge-segmentation = Ampliar la segmentación
inspect-enlarge-binary-image = Ampliar la imagen binaria
inspect-enlarge-contour = Ampliar el contorno
inspect-enlarge-signatures = Ampliar las signaturas
inspect-enlarge-ranking = Ampliar la clasificación
inspect-enlarge-alignment = Ampliar la alineación
inspect-enlarged = { $stage }, ampliada
inspect-enlarged-without = { $stage }, ampliada: { $why }
inspect-says-segmentation = planos de fondo en colores apagados, la pieza en color vivo
inspect-says-binary-image = la pieza en el plano de sus dos ejes mayores
inspect-says-contour = contorno, aberturas, rayos desde el centroide; a trazos: la pieza registrada
inspect-says-signatures = longitud L y ángulo Θ de los rayos; a trazos: la pieza registrada
inspect-says-ranking = puntuación de cada pieza registrada frente al umbral
inspect-says-alignment = distancia cuadrática media E por iteración, logarítmica
inspect-stages = Etapas
inspect-not-reached = no alcanzada
inspect-no-picture = sin imagen: la nube no tiene filas ni columnas
inspect-not-examined = sin examinar
inspect-e-stayed-zero = E se mantuvo en 0
inspect-ended-at = { $part } terminó en rms { $rms }
inspect-papers-threshold = umbral del artículo, 1e−6 m²
inspect-not-asked-for = sin alinear: no se pidió pose
inspect-flat-shape = sin alinear: está registrada como forma plana
inspect-no-pose-found = sin alinear: no se encontró la pose
inspect-score-too-low = sin alinear: puntuación demasiado baja para intentarlo
inspect-capture-cell = Pulsar Capturar para una imagen de la celda simulada, o soltar aquí una escena capturada
inspect-capture-or-drop = Pulsar Capturar, o soltar aquí una escena capturada

## Shortcuts and files

inspect-does-redo = Rehacer el último cambio deshecho de las tomas
inspect-does-undo = Deshacer el último cambio de las tomas de un escaneo
inspect-does-picture = Guardar una imagen de la vista 3D
inspect-does-contour = Mostrar u ocultar el contorno registrado
inspect-does-nozzle = Mostrar u ocultar la boquilla en el peor punto
inspect-does-copy = Copiar la pose en la convención elegida
inspect-does-previous-part = Seleccionar la pieza anterior de la imagen
inspect-does-next-part = Seleccionar la pieza siguiente de la imagen
inspect-report-folder = Carpeta para el informe de esta inspección
inspect-save-picture = Guardar una imagen de la vista
inspect-pictures = Imágenes
inspect-export-path-title = Exportar la trayectoria de pintura para el robot
inspect-saving-picture = Guardando la imagen
inspect-writing-report = Escribiendo el informe
inspect-writing-path = Escribiendo la trayectoria de pintura
inspect-picture-saved = Imagen guardada: { $path }
inspect-no-spray-path = No hay trayectoria de pintura para lo que se muestra
inspect-no-spray-path-advice = Guardar una con la pieza y capturar una pieza que se acepte
inspect-path-written = { $path } escrito: { $inside } de { $num } puntos comprobados en la banda, como { $convention }
inspect-path-not-written = No se escribió ninguna trayectoria: { $why }
inspect-report-written = Escritos { $files }, las imágenes de sus etapas y una fila de { $table } en { $folder }
inspect-report-set-aside = Escritos { $files }, las imágenes de sus etapas y una fila de { $table } en { $folder }; su última fila estaba incompleta y se apartó en { $aside }
inspect-watching-folder = Vigilando una carpeta

## The values under the pointer

inspect-at-reading = Columna { $column }, fila { $row }: a { $depth } de la cámara
inspect-at-no-reading = Columna { $column }, fila { $row }: sin lectura
inspect-at-surface = x { $x }, y { $y }, altura { $height }
inspect-at-plane = x { $x }, y { $y }
inspect-at-ray = x { $x }, y { $y } · desde el centroide L { $length }, Θ { $angle }
inspect-at-iteration = Iteración { $iteration }: E { $e } m²
