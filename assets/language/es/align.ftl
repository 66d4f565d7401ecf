## What is aligned
align-moved-copy = Copia movida
align-files = Dos archivos
align-run = Ejecutar
align-run-hint = Alinear con todos los métodos (R)
align-view-menu-hint = De todas las vistas 3D
align-library-failed = No se pudo cargar la biblioteca
align-part-hint = La pieza registrada que sirve de referencia
align-start = Inicio
align-custom = Propio…
align-random = Aleatorio
align-random-hint = El siguiente inicio aleatorio
align-random-prefix = N.º
align-random-number = Inicio aleatorio número { $number }
align-numbers = rx { $rx }°, ry { $ry }°, rz { $rz }°, después x { $x } mm, y { $y } mm, z { $z } mm
align-custom-hint = rx ry rz x y z, por ejemplo 0 0 30deg 100mm 0 0
align-custom-label = Inicio propio, seis números
align-use-start = Usar este inicio
align-custom-units = Radianes y metros, o con unidad: deg, mm, cm, m; R = Rz·Ry·Rx
align-scene-part = { $scene }: la pieza hallada, { $count } puntos, desde donde está
align-source = Origen
align-target = Destino
align-source-hint = La nube o malla que se mueve
align-target-hint = La nube o malla que permanece fija
align-custom-start = inicio propio
align-random-start = inicio aleatorio { $seed }
align-from = { $part } desde { $start }
align-library-has-no-part = La biblioteca no tiene piezas: registrar una en Registro
align-nothing-inspected = Todavía no se ha inspeccionado nada: pulsar Capturar
align-no-part-in-scene = No se encontró ninguna pieza en la escena: capturar otra
align-choose-source = Elegir el archivo que se mueve: Origen…
align-choose-target = Elegir el archivo que permanece fijo: Destino…

## The views
align-view-of = Vista 3D, { $method }
align-previous-result = Resultado anterior: hay una nueva alineación en curso
align-at-work = En curso…
align-not-run = Sin ejecutar
align-figures = E { $e } m² · rms { $rms } en el { $overlap } % · { $time } ms
align-no-pose-figures = Sin pose · { $time } ms
align-end = { $count ->
        [one] Final, tras { $count } iteración
       *[other] Final, tras { $count } iteraciones
    }
align-iteration-e = Iteración { $iteration } de { $last } · E { $e } m²
align-aligning-now = Alineando…
align-nothing-aligned = Todavía no se ha alineado nada
align-nothing-aligned-advice = Elegir arriba una pieza y un inicio, y pulsar Ejecutar
align-ended-below-threshold = { $count ->
        [one] Umbral alcanzado: E < 1e-6 m², { $count } iteración
       *[other] Umbral alcanzado: E < 1e-6 m², { $count } iteraciones
    }
align-ended-below-threshold-says = El algoritmo 3 termina en cuanto E (ec. 12) es menor que 1e-6 m²
align-ended-elsewhere = { $count ->
        [one] Convergió en otro lugar tras { $count } iteración
       *[other] Convergió en otro lugar tras { $count } iteraciones
    }
align-ended-elsewhere-says = El último paso fue menor que el límite, pero a más de 5° de la pose verdadera: un mínimo local de E
align-ended-converged = { $count ->
        [one] Convergió tras { $count } iteración
       *[other] Convergió tras { $count } iteraciones
    }
align-ended-converged-says = El último paso fue menor que el límite: la pose ya no cambia
align-ended-above-threshold = { $count ->
        [one] Umbral no alcanzado: la mejor de { $count } iteración
       *[other] Umbral no alcanzado: la mejor de { $count } iteraciones
    }
align-ended-above-threshold-says = El algoritmo 3 termina en cuanto E es menor que 1e-6 m². E quedó por encima y las últimas rondas no hallaron una pose mejor: esta es la mejor. Ya el ruido de una cámara mantiene E por encima del umbral, por buena que sea la pose
align-ended-limit = Número máximo de iteraciones: { $count }
align-ended-limit-says = La pose aún cambió en el último paso
align-nearer-or-same-part = Elegir un inicio más cercano o comprobar que ambas nubes muestran la misma pieza en metros
align-which-way-round = Comprobar en qué sentido está la pieza
align-look-for-edge = Buscar un borde o un doblez que solo tenga un lugar de la pieza
align-other-method = Probar otro método o un inicio más cercano
align-nearer-start = Elegir un inicio más cercano

## The plot
align-genetic-search = búsqueda genética
align-threshold = umbral 1e-6 (algoritmo 3)
align-iteration = iteración { $iteration } de { $last }
align-iteration-hint = iteración { $iteration } de { $last } · arrastrar para recorrer, P para reproducir
align-scrubber = Iteración mostrada
align-scrubber-keys = E por iteración. Izquierda y derecha avanzan una iteración, Re Pág y Av Pág diez, Inicio y Fin a los extremos, P reproduce
align-no-way = Ningún método halló una pose: no hay recorrido que mostrar
align-way = Ejecutar muestra aquí cómo disminuye la distancia cuadrática media E, iteración a iteración

## Table I
align-table = Tabla I
align-table-says = Cada pieza registrada, movida de T1 a T5 (ec. 15) y devuelta con cada método: E en m², con el mejor de cada fila marcado
align-cancel-table = Cancelar la tabla I
align-run-table = Calcular tabla I
align-go-on = Continuar
align-go-on-table = Continuar la tabla I
align-again = Repetir
align-table-again = Volver a calcular la tabla I
align-rows-done-left = { $done } de { $total } · quedan unos { $time }
align-rows-done = { $done } de { $total } hechas
align-rows = { $total ->
        [one] { $total } fila
       *[other] { $total } filas
    }
align-rows-stopped = Detenida en { $done } de { $total }
align-rows-all = Las { $total } hechas
align-column-part = pieza, inicio
align-none = sin pose
align-best = el mejor
align-no-pose = sin pose
align-true-error = Error real con este inicio
align-uncertainty = Incertidumbre de la alineación (95 %)
align-uncertainty-says = Cuánto pueden desviarse estas poses, solo según los puntos de las dos nubes. Inspección usa también el contorno en la imagen, por lo que la incertidumbre de su pose suele ser menor
align-method = método
align-rotation = rotación
align-shift = desplazam.
align-unconstrained = no determinada
align-copy = Copiar
align-copy-hint = La tabla I como texto, con celdas separadas por tabuladores

## Keys
align-key-run = Ejecutar todos los métodos
align-key-play = Reproducir o pausar las iteraciones
align-key-back = Una iteración atrás
align-key-on = Una iteración adelante
align-keys-play = P, o Espacio en el gráfico
align-keys-back = , o ← en el gráfico
align-keys-on = . o → en el gráfico

## Work and notices
align-open-title = Abrir una nube o una malla
align-export-title = Exportar la tabla I
align-aligning = Alineando
align-copied = Tabla I copiada
