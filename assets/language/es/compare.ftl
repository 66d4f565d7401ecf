## The case in front
compare-case = Caso
compare-case-hint = Qué escena se examina
compare-no-case = ninguno
compare-in-front = { $scene } (mostrada)
compare-kept-cases = Casos guardados
compare-no-cases-listed = Ninguno todavía
compare-asked = ¿qué pieza es?
compare-taken-for = reconocida como
compare-nearest-to = la más parecida
compare-nothing = nada
compare-accepted-asked = aceptada · ¿qué pieza es?
compare-not-accepted-asked = no aceptada · ¿qué pieza es?
compare-accepted-right = aceptada, y es
compare-not-accepted-right = no aceptada, y es
compare-accepted-wrong = aceptada, pero es
compare-not-accepted-wrong = no aceptada, pero es
compare-choose-truth = Elegir…
compare-truth-hint = Qué colgaba en realidad delante de la cámara
compare-against = comparada con
compare-against-none = ninguna pieza
compare-against-hint = La pieza registrada con la que se compara el caso
compare-against-follows = La real o, si no, la mejor
compare-against-choice = Comparada con: { $part }
compare-keep-case = Guardar caso
compare-keep-case-hint = Guardar esta escena con su pieza real
compare-keep-case-first = Elegir primero qué es
compare-kept-case = Caso guardado
compare-remove-case = Eliminar caso
compare-run-all = Inspeccionar todos
compare-run-all-hint = Inspeccionar todos los casos guardados con la receta de la derecha
compare-undo-keep = Deshacer guardado
compare-undo-removal = Recuperar caso
compare-undo-truth = Deshacer pieza real
compare-undo-recipe = Recuperar receta
compare-undo-use = Deshacer uso
compare-undo-open = Deshacer apertura

## The pictures
compare-nothing-to-compare = Todavía no hay nada que comparar
compare-nothing-to-compare-advice = Capturar una escena (Espacio), abrir una, o abrir un caso guardado
compare-no-outline = No hay ningún contorno que comparar: { $reason }
compare-no-outline-reason = sin contorno
compare-contours = Contornos, mejor desfase
compare-signatures-default = escena y pieza, la pieza desplazada según el desfase
compare-signatures-paper = como en el artículo: sin desfase, Θ plegado
compare-correlations = Autocorrelación y cruzada
compare-correlations-default = predeterminado: halla el desfase · ‖A − C‖₁ { $share } de ‖A‖₁ · eje no desde 0
compare-correlations-paper = artículo: ‖A − C‖₁ { $value } px² + rad² · { $share } de ‖A‖₁
compare-no-lag = sin desfase
compare-overlay = desfase { $lag } de { $rays } · girado { $angle } · separación { $distance }
compare-legend-query = — escena
compare-rays = Rayos, m²
compare-lag-zero-rays = desfase 0 (rayos)
compare-lag-zero-pixels = desfase 0 (píxeles)
compare-lag-read = desfase { $lag }: A { $auto }, C { $cross }
compare-auto = A: consigo
compare-cross = C: escena

## The distances
compare-distances = Distancia por pieza
compare-distances-none = Requiere un contorno
compare-distance-default = predeterminado: separación de contornos
compare-distance-paper = artículo: ‖A − C‖₁, px² + rad²
compare-distance-in-use = { $name } (en uso)
compare-distance-paper-hint = La medida del propio artículo (ec. 11): la suma de las diferencias de las correlaciones, de las longitudes en píxeles cuadrados y de los ángulos en radianes cuadrados
compare-compare-with = Comparar con { $part }: { $figures }
compare-distance-hint = Separación de contornos { $outline } (predeterminado) · ‖A − C‖₁ { $paper } px² + rad² (artículo) · puntuación final { $score }

## The kept cases
compare-all-cases = Casos guardados
compare-looking = Buscando casos guardados
compare-no-cases-in = No hay casos guardados en { $folder }
compare-no-cases = Todavía no hay casos guardados
compare-no-cases-advice = Capturar una escena, elegir qué es y pulsar Guardar caso; los casos guardados muestran qué mejora y qué estropea otra receta
compare-folder = Carpeta…
compare-folder-of-cases = Carpeta de casos…
compare-back = Volver a la matriz
compare-earlier = Anterior…
compare-earlier-label = Comparar con una ejecución anterior…
compare-earlier-hint = Comparar con lo que partsight evaluate --json escribió de una ejecución anterior
compare-ran-at = a las { $time }
compare-false-accepts =
    { $count ->
        [0] ninguna falsa aceptación
        [one] 1 falsa aceptación
       *[other] { $count } falsas aceptaciones
    }
compare-tally =
    { $right } de { $total } correctos · { $refused ->
        [0] ninguno
       *[other] { $refused }
    } con rechazo erróneo
compare-num-unreadable =
    { $count ->
        [one] { $count } ilegible
       *[other] { $count } ilegibles
    }
compare-run-running = en curso, { $done } de { $total } hechos
compare-run-stopped = detenido, { $done } de { $total } hechos
compare-other-recipe = con otra receta
compare-run-covers = desactualizado: { $done } de { $total } casos guardados
compare-cases-removed = desactualizado: se eliminó un caso
compare-running = En curso
compare-run-hint = Inspeccionar todos (Ctrl R) muestra como qué se reconoce ahora cada uno
compare-it-is = es: { $part }
compare-cell-taken-for = { $truth } reconocida como { $part }: { $count }
compare-cell-not-accepted = { $truth }, no aceptada: { $count }
compare-open-case = Abrir { $name }
compare-open-case-hint = Mostrar este caso
compare-remove-named = Eliminar { $name }
compare-cell-refused = rechazo erróneo
compare-matrix-hint = Filas: qué es · columnas: como qué se aceptó · una celda abre sus casos

## Changes since an earlier run
compare-num-worse =
    { $count ->
        [0] ninguno peor
        [one] { $count } peor
       *[other] { $count } peores
    }
compare-num-better =
    { $count ->
        [one] { $count } mejor
       *[other] { $count } mejores
    }
compare-num-rescored = { $count } con otra puntuación
compare-num-common =
    { $count ->
        [one] { $count } caso en ambas
       *[other] { $count } casos en ambas
    }
compare-num-new =
    { $count ->
        [one] { $count } nuevo
       *[other] { $count } nuevos
    }
compare-num-gone =
    { $count ->
        [one] { $count } ausente o dañado
       *[other] { $count } ausentes o dañados
    }
compare-against-file = con respecto a { $file }
compare-no-changes = Todos los casos de ambas ejecuciones dieron lo mismo que antes
compare-worse = peor
compare-better = mejor
compare-change-same = { $change }: { $before } → { $now }
compare-change = { $change }: { $is }, antes { $was } · { $before } → { $now }

## The recipe
compare-recipe-named = Receta { $recipe }
compare-built-in-hint = Todos los parámetros con su valor predeterminado
compare-is-default = predeterminada
compare-duplicate = Duplicar
compare-rename = Cambiar nombre…
compare-delete = Eliminar
compare-set-default = Usar como predeterminada
compare-built-in-stays = Una receta incorporada no se puede cambiar
compare-nothing-to-save = No ha cambiado nada desde que se guardó
compare-not-kept = No está entre las recetas guardadas
compare-default-already = Ya es la predeterminada
compare-import = Importar…
compare-take-rename = Cambiar
compare-name-hint = nombre
compare-name = Nombre de la receta
compare-save-name = Guardar con este nombre
compare-rename-name = Cambiar a este nombre
compare-cancel-name = Cancelar la introducción del nombre
compare-replace-title = ¿Sustituir la receta { $name }?
compare-replace-why = Otro programa la modificó mientras se probaba aquí; esa versión se perdería
compare-replace = Sustituir
compare-expects = Espera { $parts }
compare-num-changed =
    { $count ->
        [one] { $count } modificado
       *[other] { $count } modificados
    }
compare-list-changes = Mostrarlos
compare-reset-all = Restablecer
compare-reset-all-hint = Devolver todos los parámetros a su valor predeterminado
compare-parameter-change = { $parameter }: { $value } (predeterminado: { $default })
compare-scaling = Escalado: uno o varios núcleos
compare-more-changed =
    Más de { $group } ({ $count }; { $changed ->
        [one] { $changed } modificado
       *[other] { $changed } modificados
    })
compare-case-is-pending = Resultado con esta receta…
compare-case-is = Resultado con esta receta
compare-verdict-nearest = No aceptada · la más parecida: { $part } { $score }
compare-verdict-nothing = No aceptada · ninguna pieza hallada
compare-right-accepted = Correcta y aceptada
compare-rightly-refused = Rechazo correcto
compare-truth-not-set = La pieza real no está indicada
compare-use = Usar esta receta
compare-use-hint = A partir de ahora las escenas se inspeccionan con ella
compare-in-use-hint = Las escenas ya se inspeccionan con esta receta

## Why a case is refused
compare-refused = Rechazada: { $reason }
compare-refused-apart = Rechazada: { $reason }; los contornos distan { $distance }

## The plots
compare-calibration = Calibración
compare-calibration-caption = aciertos según puntuación · error { $error }
compare-calibration-caption-none = aciertos según puntuación
compare-calibration-hint = La mejor estimación de cada caso, por puntuación: sobre la línea, una puntuación de 0.9 acierta nueve de cada diez veces. Los números indican cuántas estimaciones son
compare-calibration-bin = { $from } a { $to }, { $right } de { $count } correctas
compare-calibration-words = Calibración: error esperado { $error }; { $bins }
compare-threshold = Umbral
compare-threshold-caption = proporción según puntuación mínima
compare-threshold-words = Umbral: con { $threshold }, la puntuación por sí sola acepta erróneamente { $wrong } de { $cases } casos y rechaza { $refused } de { $enrolled } piezas
compare-threshold-hint = Lo que cada puntuación mínima aceptaría erróneamente de todos los casos y lo que rechazaría de las piezas registradas, solo por la puntuación. La línea vertical es la de la receta
compare-plot-false-accepts = falsas aceptaciones
compare-plot-refused = piezas rechazadas
compare-scaling-says = Clasifica entre 8 y 2048 referencias simuladas para una escena con 1, 2, 4 y 8 hilos; tarda unos segundos
compare-measure = Medir
compare-measure-label = Medir el escalado
compare-scaling-cores = { $cores ->
        [one] { $cores } núcleo
       *[other] { $cores } núcleos
    }
compare-scaling-cores-shared = { $cores ->
        [one] { $cores } núcleo; a partir de { $workers } hilos se comparte
       *[other] { $cores } núcleos; a partir de { $workers } hilos se comparten
    }
compare-scaling-from = { $count ->
        [one] { $cores }: varios compensan a partir de { $count } referencia
       *[other] { $cores }: varios compensan a partir de { $count } referencias
    }
compare-scaling-never = { $cores }: varios nunca compensaron
compare-scaling-plot = Tiempo de la clasificación según el número de referencias; { $words }
compare-one-worker = 1 hilo

## Keys
compare-key-keep = Guardar el caso mostrado
compare-key-run = Inspeccionar todos los casos guardados
compare-key-undo = Deshacer guardar o eliminar un caso, indicar su pieza real, o eliminar, usar o abrir una receta

## Work and notices
compare-cases-title = Carpeta de casos guardados
compare-earlier-title = Lo que ha escrito partsight evaluate --json
compare-evaluation-files = Evaluaciones
compare-recipe-files = Recetas
compare-import-title = Receta que se va a importar
compare-export-title = Exportar la receta
compare-comparing = Comparando
compare-listing-cases = Leyendo los casos guardados
compare-keeping-case = Guardando el caso
compare-removing-case = Eliminando un caso
compare-restoring-case = Recuperando el caso
compare-saving-truth = Guardando la pieza real
compare-running-cases = Inspeccionando los casos guardados
compare-measuring = Midiendo la clasificación
compare-comparing-earlier = Comparando con una ejecución anterior
compare-changing-recipes = Modificando recetas
compare-inspecting = Inspeccionando con otra receta
compare-nothing-to-keep = Todavía no hay ningún caso que guardar
compare-nothing-to-keep-advice = Capturar o abrir una escena y esperar a que se inspeccione
compare-kept-already = Este caso ya está guardado
compare-kept-already-advice = Capturar o abrir otra escena
compare-no-truth = Un caso sin pieza real no sirve de nada
compare-no-cases-to-run = No hay casos guardados que inspeccionar
compare-no-cases-to-run-advice = Guardar antes un caso o elegir una carpeta de casos
compare-no-run = No hay ninguna ejecución que comparar con una anterior
compare-no-run-advice = Inspeccionar antes todos los casos
compare-kept-as = Guardado como { $name }
compare-removed-case = { $name }: eliminado; su entrada en Historial no cambia
compare-restored-case = { $name } está de vuelta
compare-truth-saved = Pieza real de { $name } guardada; su entrada en Historial no cambia
compare-case-gone = Ya no existe ningún caso guardado llamado { $name }
compare-case-gone-advice = Volver a inspeccionar todos los casos
compare-front-gone = El caso guardado { $name } falta o está dañado
compare-front-gone-advice = En su lugar se muestra la última escena inspeccionada; para volver a compararlo, copiar el caso de nuevo a su carpeta
compare-recipe-changed-elsewhere = Otro programa ha modificado la receta { $name }
compare-recipe-changed-elsewhere-advice = Abrirla en Comparar para usarla; hasta entonces se usan sus parámetros anteriores
compare-tried-changed-elsewhere-advice = Abrirla de nuevo para probar esa versión; antes de sustituirla por la propia se pregunta
compare-recipe-gone = La receta { $name } ya no está entre las recetas guardadas
compare-recipe-gone-advice = Otro programa le cambió el nombre o la eliminó: guardar sus parámetros con un nombre en Comparar o abrir otra receta
compare-saved-recipe = Receta { $name } guardada
compare-restored-recipe = Receta { $name } recuperada
compare-renamed-recipe = La receta { $before } se llama ahora { $now }
compare-removed-recipe = Receta { $name } eliminada
compare-default-recipe = Las órdenes sin --recipe usan ahora «{ $name }»
compare-imported-recipe = Receta { $name } importada
compare-recipe-used =
    Las escenas se inspeccionan ahora con la receta { $recipe }: { $count ->
        [one] { $count } parámetro modificado
       *[other] { $count } parámetros modificados
    }
