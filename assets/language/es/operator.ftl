# The operator's view
operator-ok = OK
operator-not-ok = NOK
operator-parts-ok = { $num } de { $all } OK
operator-parts-recognised = { $num } de { $all } reconocidas
operator-opening-camera = Abriendo la cámara…
operator-no-camera = Sin cámara
operator-no-camera-next = Comprobar el enchufe y la alimentación de la cámara. Si persiste, avisar a mantenimiento
operator-no-folder = Carpeta no accesible
operator-no-folder-next = Comprobar la unidad de red o la carpeta compartida. Si persiste, avisar a mantenimiento
operator-lost = Partsight sigue intentándolo
operator-inspecting = Inspeccionando…
operator-no-result = Sin resultado
operator-no-result-next = Avisar al técnico, o pulsar Capturar para volver a intentarlo
operator-unreadable = No se puede leer { $file }
operator-unreadable-next = Guardar de nuevo la captura en la carpeta; si persiste, avisar al técnico
operator-no-parts = Sin piezas registradas
operator-ask-to-enrol = Pedir al técnico que registre las piezas
operator-no-new-file = Aún no hay ningún archivo nuevo en la carpeta
operator-save-capture = Guardar una captura en la carpeta: se inspecciona automáticamente
operator-nothing-captured = Aún no se ha capturado nada
operator-ready = Listo
operator-nothing-inspected = Aún no se ha inspeccionado nada
operator-counts-no-longer = El último resultado ya no cuenta
operator-hang-and-capture = Colgar una pieza y pulsar Capturar
operator-follow-current = Pulsar En vivo o Capturar para la pieza actual
operator-file-next = De un archivo: comprobar que muestra esta pieza tal como cuelga y arrancar el robot
operator-check-part-next = Comprobar la pieza y arrancar el robot
operator-start-robot = Arrancar el robot
operator-recognised = Reconocida, con pose conocida
operator-reported-wrong = Notificada como errónea
operator-reported-wrong-next = No arrancar el robot: avisar al técnico
operator-next = Siguiente paso
operator-last-parts = Últimas piezas de este turno
operator-none-yet = Ninguna todavía
operator-counting = Contando…

## What an operator can do about it

operator-then-capture = Después, pulsar Capturar
operator-then-open = Después, abrir la nueva captura
operator-next-file = El próximo archivo se inspecciona automáticamente
operator-reaches-edge = Llega al borde de la imagen: colgarla de modo que quede entera en la imagen
operator-reaches-edge-ok = No está entera en la imagen
operator-approximate-ok = Quizá otro modelo

## The bars above and below

operator-locked-says = Bloqueada: pide el PIN (Ctrl K)
operator-history-says = Todas las piezas inspeccionadas
operator-shift-since = Turno desde las { $time }
operator-shift-says = Piezas que colgaron ante esta fuente desde el comienzo del turno, cada una contada una vez. Una celda vacía no es una pieza; los archivos abiertos y las capturas sueltas de la celda simulada no cuentan. OK: aceptada y no notificada como errónea. Las estadísticas del historial cuentan lo mismo
operator-num-parts = { $num ->
        [one] { $num } pieza
       *[other] { $num } piezas
    }
operator-num-ok = { $num } OK
operator-num-not-ok = { $num } NOK
operator-num-not-judged = { $num } sin evaluar
operator-stop-live-says = Detener la inspección automática de las piezas (L)
operator-live-says = Inspeccionar cada pieza automáticamente cuando cuelgue inmóvil (L)
operator-wrong-part = ¿Pieza errónea?
operator-wrong-part-says = Indicar qué pieza es en realidad
operator-wrong-part-not-now = Posible cuando la pieza en pantalla tenga un resultado
operator-back = Volver
operator-back-says = Volver a la pieza sin cambios (Esc)
operator-which-part = { $part }, { $time }: ¿qué pieza es en realidad?
operator-find-part = Buscar una pieza
operator-no-such-part = Ninguna pieza se llama así
operator-none-of-these = Ninguna de estas
operator-none-of-these-says = La pieza no está registrada
operator-recognised-as-this = Reconocida como esta
operator-labelled-as-this = Indicada hasta ahora
operator-source = Fuente: { $source }
operator-serial = N.º serie
operator-serial-hint-this = para esta pieza
operator-serial-hint-next = para la próxima pieza
operator-serial-for-next = Para la próxima pieza inspeccionada
operator-serial-entered = El número de serie { $serial } es para la próxima pieza
operator-serial-of-part = Número de serie { $serial } → { $part }, { $time }
operator-serial-move-next = Asignarlo a la próxima pieza
operator-serial-move-this = Asignarlo a esta pieza
operator-serial-known = { $serial } ya es el número de esta pieza
operator-serial-in-shift = { $serial } ya es el número de una pieza de este turno
operator-serial-in-shift-next = Comprobarlo: si no es correcto, escanear el número correcto
operator-serial-replaced = { $former } aún no estaba asignado a ninguna pieza y se ha sustituido por { $serial }
operator-serial-replaced-next = Si { $former } era correcto, escanearlo de nuevo
operator-robots-without-pose = Los robots no reciben la pose: pedir al técnico que calibre la celda
operator-robots-without-frames = Los robots no reciben imágenes: pulsar En vivo
operator-robots-without-source = Los robots no reciben imágenes: pedir al técnico que elija una cámara
operator-not-recorded = Sin guardar
operator-not-recorded-says = No se puede escribir el historial: avisar al técnico. Hasta entonces las inspecciones están solo en memoria
