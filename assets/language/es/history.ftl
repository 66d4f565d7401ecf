## The list
history-empty-advice = Pulsar Capturar: cada inspección aparece aquí y se conserva al cerrar la ventana
history-in-memory = Solo en memoria: { $reason }
history-none-listed = Ninguna inspección coincide: cambiar el filtro
history-column-score = Punt.
history-column-ms = ms
history-column-time = Fecha
history-part-again = { $part } · repetida { $count }×
history-row =
    { $count ->
        [0] Inspección { $number }: { $part }, { $verdict }
        [one] Inspección { $number }: { $part }, { $verdict }, repetida una vez
       *[other] Inspección { $number }: { $part }, { $verdict }, repetida { $count } veces
    }

## The bar above the list
history-show-all = Mostrar todo
history-counted = { $count ->
        [one] { $matching } de { $count } entrada
       *[other] { $matching } de { $count } entradas
    }
history-export-csv-hint = Escribir en una tabla las inspecciones mostradas
history-export-cases = Exportar casos…
history-export-cases-hint = Guardar como casos, para Comparar y partsight evaluate, las inspecciones mostradas que tienen imagen y pieza real
history-statistics = Estadística
history-statistics-hint = OK y NOK por turno, por pieza y por motivo, de lo que se muestra; las imágenes simuladas solo si no se muestra nada más
history-frames-button = Imágenes…
history-frames-button-hint = Qué imágenes se conservan y cuánto tiempo
history-find = Buscar
history-find-hint = Pieza, serie, escena
history-filter-days = Días
history-filter-all-verdicts = Todos
history-filter-all-parts = Todas
history-days-all = Todos los días
history-days-week = 7 días
history-days-month = 30 días
history-days-typed = De … a
history-from = de
history-to = a
history-first-day = Primer día
history-last-day = Último día
history-day-format = Escribir el día como año-mes-día: 2026-11-20

## The inspection on the right
history-choose = Elegir una inspección para ver más detalles
history-inspection = Inspección { $number }
history-no-picture = La escena no tiene filas ni columnas, por lo que no hay imagen
history-picture = Segmentación de la inspección { $number }
history-of-part = Inspecciones de esta pieza
history-counts = cuenta
history-of-this-part = De esta pieza: inspección { $number }, { $verdict }
history-found-same = La inspección { $number } dio el mismo resultado
history-found-other = La inspección { $number } dio otro resultado
history-figure-source = fuente
history-figure-time = fecha
history-figure-serial = n.º de serie
history-figure-score = puntuación
history-figure-margin = margen
history-figure-library = biblioteca
history-figure-program = programa
history-figure-frame = imagen
history-figure-verdict = resultado
history-figure-nearest = parecida a
history-frame-not-kept = no conservada
history-frame-lost = falta: { $why }
history-frame-kept = conservada, { $megabytes } MB
history-rz = rz, de Rz·Ry·Rx
history-stage-segment = segmentación
history-stage-project = proyección
history-stage-contour = contorno
history-stage-signature = signatura
history-stage-rank = clasificación
history-stage-pose = pose
history-stage-total = total
history-times = Tiempos
history-open = Abrir
history-open-hint = Abrir con todas las etapas y con su propia receta
history-again = Repetir inspección
history-again-hint = Con la receta y la biblioteca actuales; los cambios se muestran aquí
history-frame-gone = La imagen de «{ $scene }» no se ha conservado
history-frame-gone-advice = Conservar más imágenes en adelante: Imágenes… encima de la lista
history-actual-part = Pieza real
history-labelled = Guardado en el historial. Pieza real: { $part }
history-label-undone = Deshecho: la pieza real es la de antes
history-remark = Observación
history-your-remark = Observación propia

## What differs
history-differences = Inspección repetida
history-same-today = Hoy da el mismo resultado
history-other-today = Hoy da otro resultado
history-then = entonces
history-today = hoy
history-pose-differs = La pose difiere en { $shift } y { $rotation }

## Keys
history-key-newer = La inspección más reciente
history-key-older = La inspección anterior
history-key-open = Abrirla con todas sus etapas
history-key-again = Volver a inspeccionarla con la receta y la biblioteca actuales

## Frames to keep
history-keep-title = Imágenes que se conservan
history-keep-why = Con su imagen, una inspección puede volver a abrirse con todas las etapas. Las inspecciones en sí se conservan siempre. «Las no aceptadas» conserva también las imágenes de las últimas { $num } piezas aceptadas, para poder etiquetar después una equivocada.
history-keep-which = De qué inspecciones
history-keep-days = Como máximo, días
history-keep-gigabytes = Como máximo, gigabytes
history-keep-used =
    Ahora: { $count ->
        [one] 1 imagen
       *[other] { $count } imágenes
    }, { $size }. Las más antiguas se borran primero
history-keep-marked = Las que tienen observación o pieza real se conservan: { $size }

## Statistics
history-none-counted = Ninguna pieza coincide: cambiar el filtro
history-by-part = Por pieza
history-by-rack = Por bastidor
history-by-reason = Por motivo
history-ok-share = OK, %
history-shift = Turno del { $start }: { $ok } OK, { $nok } NOK
history-by-shift = Piezas por turno
history-not-ok-on-top = NOK, encima
history-total = { $count ->
        [one] { $count } pieza, { $share } OK
       *[other] { $count } piezas, { $share } OK
    }
history-total-of-shifts = { $count ->
        [one] { $shifts } turnos: { $count } pieza, { $share } OK
       *[other] { $shifts } turnos: { $count } piezas, { $share } OK
    }
history-others-left-out =
    { $count ->
        [one] 1 pieza de otra fuente no cuenta
       *[other] { $count } piezas de otras fuentes no cuentan
    }
history-no-part-left-out =
    { $count ->
        [one] 1 entrada sin pieza no cuenta
       *[other] { $count } entradas sin pieza no cuentan
    }
history-not-judged-left-out =
    { $count ->
        [one] 1 pieza no se ha evaluado y no cuenta: se han inspeccionado muy pocas de sus imágenes
       *[other] { $count } piezas no se han evaluado y no cuentan: se han inspeccionado muy pocas de sus imágenes
    }
history-drift = Deriva: { $part }
history-drift-needs = La deriva se muestra de una pieza aceptada al menos { $count } veces
history-drift-shift-bound = Cota del error de posición, 95 %
history-drift-fit = Ajuste a la referencia, rms
history-drift-place-along = Posición de la pieza a lo largo de { $axis }
history-drift-mean = media
history-drift-limit = límite
history-drift-band = { $name }: media { $mean }, 3σ de { $from } a { $to }
history-drift-band-limit = { $name }: media { $mean }, 3σ de { $from } a { $to }, límite { $limit }
history-drift-place = Posición de la pieza, media ± 3σ: x { $x }, y { $y }, z { $z }
history-drift-trend = { $name }: tendencia de { $from } a { $to } en las { $count } inspecciones más recientes
history-drift-warning =
    { $count ->
        [0] { $part } deriva: con esta tendencia se rechazan piezas sueltas desde ahora ({ $name }, límite { $limit })
        [one] { $part } deriva: con esta tendencia se rechazarán piezas sueltas tras 1 inspección más ({ $name }, límite { $limit })
       *[other] { $part } deriva: con esta tendencia se rechazarán piezas sueltas tras { $count } inspecciones más ({ $name }, límite { $limit })
    }
history-drift-warning-advice = Buscar antes la causa: limpiar la ventana de la cámara y comprobar la celda (Robot…, Comprobación), los colgadores y las piezas

## Work and notices
history-looking = Consultando el historial
history-export-csv-title = Exportar las inspecciones mostradas
history-export-cases-title = Carpeta para los casos de las inspecciones mostradas
history-wrote =
    { $count ->
        [one] Una inspección escrita
       *[other] { $count } inspecciones escritas
    } en { $path }
history-no-cases = Ninguna inspección se ha convertido en caso: { $what }
history-no-cases-advice = Indicar la pieza real de algunas inspecciones y conservar sus imágenes
history-wrote-cases = { $path }: { $what }
history-cases-kept = casos: { $new } nuevos, { $updated } actualizados, { $unchanged } sin cambios
history-cases-without-truth = { $count } sin pieza real
history-cases-without-frame = { $count } sin imagen conservada
history-cases-scans = { $count ->
        [one] { $count } que es un escaneo
       *[other] { $count } que son escaneos
    }
history-cases-unreadable = { $count } cuya imagen no se puede leer
history-crowded = El historial no puede seguir el ritmo: no se guardaron las imágenes de algunas inspecciones
history-crowded-advice = Conservar menos imágenes (Imágenes… en Historial) o usar un disco más rápido
history-set-aside = Historial: { $what }
history-set-aside-advice = Se ha apartado como { $path } y se ha empezado uno nuevo
history-failed-advice = { $advice }; hasta entonces las inspecciones se guardan en memoria
history-works =
    El historial vuelve a admitir escritura: { $count ->
        [one] se ha guardado una inspección que esperaba
       *[other] se han guardado { $count } inspecciones que esperaban
    }
history-works-lost =
    El historial vuelve a admitir escritura: { $count ->
        [one] se ha guardado una inspección que esperaba
       *[other] se han guardado { $count } inspecciones que esperaban
    }; { $lost ->
        [one] se ha perdido una
       *[other] se han perdido { $lost }
    }
history-swept =
    La regla de conservación ha eliminado del historial { $count ->
        [one] 1 imagen
       *[other] { $count } imágenes
    }, { $megabytes } MB
history-inspecting-again = Inspeccionando de nuevo { $scene }
history-other-version = La receta de { $scene } la escribió otra versión de Partsight
history-other-version-advice = Pulsar Repetir inspección para usar la receta actual
history-changed-frame = el archivo o la imagen
history-changed-recipe = la receta
history-changed-library = la biblioteca
history-changed-program = el programa
history-changed-both = { $first } y { $second }
history-other-result = { $scene } da ahora otro resultado; ha cambiado desde entonces: { $changed }
history-other-result-advice = El historial conserva el primer resultado
