# The followed source
live-record = Grabar…
live-record-says = Guardar cada imagen de la fuente sin cambios (Ctrl L)
live-stop-recording = Parar la grabación
live-stop-recording-so-far = Parar la grabación · { $num ->
        [one] { $num } imagen, { $size }
       *[other] { $num } imágenes, { $size }
    }
live-recorded = { $num ->
        [one] { $num } imagen, { $size }, grabada en { $folder }
       *[other] { $num } imágenes, { $size }, grabadas en { $folder }
    }
live-playing = Reproducción
live-watching = Vigilando
live-lost = reconectando
live-opening = abriendo
live-file-is-part = cada archivo es una pieza
live-looking = buscando
live-moving = en movimiento
live-steady-for = inmóvil desde hace { $seconds } s
live-file-by-file = Cada archivo nuevo se inspecciona por separado
live-no-verdict = Sin resultado hasta que la pieza cuelgue inmóvil
live-frames-of = { $num } de { $needed ->
        [one] { $needed } imagen
       *[other] { $needed } imágenes
    }
live-frames-agree = { $agreeing } de { $num ->
        [one] { $num } imagen concuerda
       *[other] { $num } imágenes concuerdan
    }
live-averaged = { $evidence } · profundidad de { $num }
live-dropped = { $num } descartadas
live-rates = { $captured } fps, { $inspected } inspeccionadas
live-scan-cannot = Un escaneo no se puede seguir: no cambia
live-file-cannot = Un archivo suelto no se puede seguir: no cambia
live-cannot-advice = Elegir una cámara, una grabación o una carpeta en el menú de fuentes
live-closing = Cerrando la cámara
live-inspects-each = Cada captura de la carpeta se inspecciona en cuanto se guarda
live-ended = En vivo ha terminado: se capturó una imagen
live-ended-past = En vivo ha terminado: se abrió o repitió una inspección anterior
live-ended-advice = Pulsar L para volver a «En vivo»
live-source-back = La fuente ha vuelto

## Setting up the simulated cell

live-what-hangs = Qué cuelga ahí
live-hangs = Cuelga ahí: { $what }
live-side = Lado
live-side-left = Izquierdo
live-side-right = Derecho
live-model = Modelo de coche
live-model-says = 0 es el registrado
live-hung = Colgada
live-with-care = Con cuidado
live-anyhow = De cualquier modo
live-turned-away = Girada
live-noise = Ruido
live-no-noise = Ninguno
live-kinect-noise = Como Kinect
live-three-times = Triple
live-clutter = Objetos sueltos
live-no-clutter = Ninguno
live-on-floor = En el suelo
live-plank = Una tabla delante
live-line-runs = La línea avanza, una pieza cada { $seconds } s
live-racks-run = La línea avanza, tres piezas lado a lado cada { $seconds } s
live-conveyor-runs = La línea avanza sin parar a { $speed } mm/s
live-nothing = Nada
