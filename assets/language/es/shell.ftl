# The bars, the source, settings, files and shortcuts

## Bars

shell-capture = Capturar
shell-live = En vivo
shell-open = Abrir…
shell-robot = Robot…
shell-help = Ayuda
shell-cancel = Cancelar
shell-close = Cerrar
shell-redo = Rehacer
shell-more = Más de { $group } ({ $count })
shell-export-csv = Exportar CSV…
shell-export = Exportar…
shell-save-as = Guardar como…
shell-save = Guardar
shell-wrote = Se ha escrito { $path }
shell-writing = Escribiendo { $file }
shell-csv-files = Valores separados por comas
shell-stop-live-says = Dejar de seguir la fuente (L)
shell-live-says = Seguir la fuente e inspeccionar tantas imágenes como sea posible (L)
shell-robot-says = Calibración, comprobación de la celda y respuestas a robots (B)
shell-calibrated-by = Calibrado con { $name }
shell-no-flange-pose = No se conoce la pose de la brida al capturar
shell-calibration-edited = Los números de la calibración se cambiaron y no se confirmaron
shell-not-calibrated = Dónde está la cámara en la celda del robot: sin calibrar
shell-dark = Oscuro
shell-light = Claro
shell-to-dark = Cambiar a oscuro (T)
shell-to-light = Cambiar a claro (T)
shell-to-units = Cambiar a { $units } (U)
shell-language-says = Idioma de la ventana
shell-language-of = Idioma: { $language }
shell-num-parts = { $num ->
        [one] { $num } pieza
       *[other] { $num } piezas
    }
shell-library-named = { $num ->
        [one] { $num } pieza · { $name }
       *[other] { $num } piezas · { $name }
    }
shell-no-library = Sin biblioteca
shell-library-in-use = Biblioteca en uso
shell-library-version = Versión { $version } de { $store }
shell-library-version-changed = Versión { $version } de { $store }, modificada aquí desde entonces
shell-use-another-library = Usar otra biblioteca…
shell-use-usual-library = Usar la biblioteca habitual
shell-progress = { $work } · { $done } de { $total }

## Workspaces and views

shell-inspect = Inspección
shell-enrol = Registro
shell-compare = Comparar
shell-align = Alinear
shell-paint = Pintar
shell-servo = Servo
shell-history = Historial
shell-operator = Operador
shell-engineer = Técnico
shell-operators-view = Vista del operador
shell-engineers-view = Vista del técnico
shell-to-engineer = Cambiar a la vista del técnico (Ctrl K)
shell-set-pin = Definir un PIN…
shell-set-pin-says = Con un PIN la ventana se abre en la vista del operador
shell-change-pin = Cambiar el PIN…
shell-remove-pin = Quitar el PIN
shell-remove-pin-asked = ¿Quitar el PIN? Entonces cualquiera puede pasar a la vista del técnico
shell-lock-after = Bloquear tras
shell-minutes = { $num ->
        [one] { $num } minuto
       *[other] { $num } minutos
    }
shell-enter-pin = Introducir el PIN para cambiar receta, umbrales, biblioteca, celda y fuente
shell-unlock = Desbloquear
shell-may-change = En esta vista se pueden cambiar receta, umbrales, biblioteca, celda y fuente
shell-switch = Cambiar
shell-new-pin = Nuevo PIN
shell-new-pin-says = De cuatro a ocho cifras que protegen la vista del técnico
shell-next = Siguiente
shell-same-digits = Introducir de nuevo las mismas cifras
shell-set-the-pin = Definir el PIN
shell-pin-forgotten = ¿Olvidado? Avisar al técnico
shell-num-digits = { $num ->
        [one] { $num } cifra
       *[other] { $num } cifras
    }
shell-erase = Borrar
shell-digit = Cifra { $digit }
shell-locked = Bloqueada: la ventana no se ha usado durante un rato
shell-pin-removed = PIN quitado
shell-wrong-pin = PIN incorrecto
shell-four-digits = Al menos cuatro cifras
shell-pins-differ = No coinciden: introducir un PIN nuevo
shell-pin-set = PIN definido: la ventana se abrirá en la vista del operador

## What a scene truly shows

shell-actual-part = Pieza real: { $part }
shell-truth-not-set = Sin indicar
shell-truth-not-enrolled = No registrada
shell-truth-nothing = Nada (celda vacía)

## The status bar

shell-days = { $num ->
        [one] 1 día
       *[other] { $num } días
    }
shell-status-from-pairs = calibración mano-ojo
shell-status-made-ago = { $kind }, hace { $age }
shell-status-edited = modificada
shell-status-no-flange-pose = sin pose de la brida
shell-status-not-calibrated = sin calibrar
shell-status-robots-off = robots apagados
shell-status-robots-off-says = No se responde a ningún robot: las respuestas están apagadas
shell-status-not-answered = sin respuesta
shell-status-no-frames = sin imágenes
shell-status-robots-start = iniciando
shell-status-listens = a la escucha
shell-status-last-answer = Última respuesta: { $answer }
shell-status-live-off = En vivo apagado
shell-status-live-off-says = En vivo está apagado: no se vigila si la pieza está inmóvil
shell-status-motion-unknown = No llegan imágenes: no se sabe si la pieza está inmóvil
shell-status-no-frame = Todavía no se ha capturado ninguna imagen
shell-status-frame-age = Antigüedad de la imagen en pantalla: { $age }
shell-status-speed = Este ordenador inspecciona { $inspected } de { $frames } imágenes
shell-status-speed-unknown = La velocidad de este ordenador se mide mientras En vivo está activo
shell-status-drift = deriva

## The source

shell-simulated-cell = Celda simulada
shell-source-button = Fuente · { $source }
shell-source-says = De dónde toman escenas Capturar y En vivo
shell-simulated = Simulada · { $what }
shell-scan-of = Escaneo { $name }
shell-cell-set-up = Celda simulada, configurada
shell-recording-of = Grabación { $name }
shell-folder-of = Carpeta { $name }
shell-set-up-cell = Configurar la celda…
shell-cameras-and-folders = Cámaras y carpetas
shell-play-recording = Reproducir una grabación…
shell-play-recording-says = Una carpeta de imágenes de profundidad o nubes: En vivo la reproduce y la detiene, Capturar toma la imagen siguiente
shell-watch-folder = Vigilar una carpeta…
shell-watch-folder-says = Se inspecciona cada captura que otro programa guarda allí
shell-open-file = Abrir un archivo…
shell-open-file-says = Una sola captura
shell-open-scan = Abrir un escaneo…
shell-open-scan-says = Una carpeta con varias tomas de una pieza, cada una con la pose de su cámara (Ctrl Mayús O)
shell-average-depth = En vivo promedia la profundidad de
shell-one-frame = 1 imagen
shell-recent-files = Archivos recientes
shell-empty-cell = Celda vacía
shell-capture-empty-cell = Capturar celda vacía
shell-capture-empty-cell-says = La escena mostrada pasa a ser la celda vacía: desde ahora nada de ella se toma por una pieza
shell-discard-empty-cell = Descartar celda vacía
shell-no-empty-cell = No se ha capturado ninguna celda vacía
shell-empty-cell-discarded = Celda vacía descartada
shell-cell-not-empty = La celda no está vacía: hay una pieza colgada
shell-cell-not-empty-advice = Retirar la pieza, capturar y después pulsar Capturar celda vacía
shell-empty-cell-doubt = Celda vacía capturada, pero contiene algo del tamaño de una pieza
shell-empty-cell-doubt-advice = Si es una pieza: Fuente, Descartar celda vacía; después retirar la pieza y capturar primero
shell-empty-cell-captured = Celda vacía capturada: desde la próxima captura nada de ella se toma por una pieza

## What is at work

shell-capturing = Capturando
shell-opening = Abriendo { $name }
shell-waiting-for-file = Esperando un archivo nuevo
shell-same-capture = { $scene } se ha inspeccionado de nuevo: no ha cambiado
shell-inspecting-again = Inspeccionando de nuevo
shell-opening-library = Abriendo la biblioteca
shell-loading-library = Cargando la biblioteca
shell-reloading-library = Recargando la biblioteca
shell-library-reloaded = { $num ->
        [one] Biblioteca recargada, otro programa la ha cambiado: { $num } pieza
       *[other] Biblioteca recargada, otro programa la ha cambiado: { $num } piezas
    }
shell-path-off-part = { $part }: la trayectoria guardada no apunta a la pieza; los robots no la reciben
shell-counting-parts = Contando piezas
shell-writing-settings = Guardando los ajustes

## Settings

shell-settings-not-used = Los ajustes no se usan: { $why }
shell-settings-set-aside = Se han movido a { $path }; la ventana se abre con los ajustes predeterminados
shell-settings-values-not-used = { $keys } en { $path } { $num ->
    [one] no se puede usar y tiene su valor predeterminado
   *[other] no se pueden usar y tienen sus valores predeterminados
}; los demás ajustes se conservan
shell-settings-kept-beside = El archivo tal como estaba es { $path }
shell-settings-move-away = Mover el archivo a otro lugar: no se pudo apartar ({ $why })
shell-settings-not-kept = Los ajustes no se recuerdan: { $why }
shell-settings-not-kept-advice = { $advice }; hasta entonces no se recuerdan los ajustes
shell-report-settings = Notificar qué ajustes se cambiaron

## Files

shell-all-files = Todos los archivos
shell-scenes-clouds-meshes = Escenas, nubes y mallas
shell-captured-scenes = Escenas capturadas
shell-open-scene = Abrir una escena capturada
shell-scan-folder = Carpeta de un escaneo: sus imágenes y poses
shell-another-library = Usar otra biblioteca
shell-a-recording = Reproducir una grabación
shell-record-to = Carpeta en la que grabar la fuente
shell-watched-folder = Carpeta en la que se guardan las capturas
shell-open-part = Abrir una escena, una nube o una malla para registrarla
shell-cannot-be-made = No se puede crear { $path }: { $why }
shell-choose-another-folder = Elegir otra carpeta
shell-type-a-path = Escribir una ruta
shell-add-a-name = Es una carpeta: añadir el nombre de un archivo
shell-no-such-file = No existe ese archivo
shell-no-such-folder = No existe esa carpeta
shell-not-a-folder = Es un archivo, no una carpeta
shell-confirm-replace = Ya existe un archivo con ese nombre: confirmar otra vez para reemplazarlo
shell-no-parent-folder = La carpeta de este archivo no existe
shell-no-file-dialog = El escritorio no ofrece diálogo de archivos (paquete xdg-desktop-portal-gtk o zenity): escribir la ruta o elegirla abajo
shell-path = Ruta
shell-ok = Aceptar

## Notices and closing

shell-dismiss = Descartar
shell-dismiss-all = Descartar todos
shell-more-like-it = { $num } más de este tipo
shell-read-in-millimetres = Leer como milímetros
shell-too-wide = Los puntos abarcan { $extent } m
shell-too-wide-advice = Comprobar la unidad del archivo
shell-undo = Deshacer
shell-close-without-saving = ¿Cerrar sin guardar?
shell-not-written = { $num ->
        [one] { $num } inspección está solo en memoria
       *[other] { $num } inspecciones están solo en memoria
    }: no se puede escribir el historial
shell-keep-open = Mantener la ventana abierta
shell-close-anyway = Cerrar sin guardar
shell-stop-answering = ¿Dejar de responder a los robots?
shell-robots-without-answer = Los robots que preguntan en { $at } no reciben respuesta mientras la ventana esté cerrada
shell-close-and-stop-answering = Cerrar y dejar de responder

## Shortcuts

shell-shortcuts = Atajos de teclado
shell-key-ctrl = Ctrl
shell-key-shift = Mayús
shell-key-space = Espacio
shell-key-enter = Intro
shell-key-up = Arriba
shell-key-down = Abajo
shell-does-capture = Capturar, e inspeccionar o registrar
shell-does-live = En vivo: seguir la fuente, o parar
shell-does-record = Grabar la fuente, o parar
shell-does-open-scan = Abrir un escaneo: varias tomas con sus poses
shell-does-export = Exportar la inspección mostrada
shell-does-robot = La celda del robot: dónde está la cámara
shell-does-units = Milímetros y grados, o metros y radianes
shell-does-theme = Oscuro o claro
shell-does-role = Vista del operador o del técnico
shell-does-quit = Cerrar la ventana
shell-does-help = Ayuda: teclas, guía, informar de un problema
shell-does-size = Todo más grande, más pequeño, normal
shell-does-escape = Cerrar la etapa ampliada; abandonar el recuadro o lazo
shell-keys-tab = Tab, Intro
shell-does-tab = Ir al control siguiente, pulsarlo
shell-keys-turn = Flechas, arrastrar izquierdo
shell-does-turn = Girar la vista 3D
shell-keys-shift = Mayús + esas, arrastrar derecho
shell-does-shift = Desplazarla
shell-keys-zoom = + −, rueda
shell-does-zoom = Ampliarla o reducirla
shell-keys-fit = F, Mayús F
shell-does-fit = Encuadrar la pieza, encuadrar todo
shell-does-look = Ver de frente, desde arriba, de lado
shell-does-measure = Medir entre dos puntos pulsados
shell-keys-drawing = Arrastrar izquierdo, Esc
shell-does-drawing = Trazar el recuadro o el lazo, cancelarlo
shell-keys-box = Flechas, Intro
shell-does-box = Mover un recuadro en la imagen, aplicarlo
shell-keys-resize = Mayús + flechas
shell-does-resize = Ampliar o reducir ese recuadro

## The simulated cell

shell-every-part = Todas las piezas por turno
shell-not-enrolled = Sin registrar: { $what }
shell-of-simulator = { $name }, simulada
shell-gone = { $path } ya no existe
shell-gone-advice = Se usa en su lugar la celda simulada
shell-device-lost = Se perdió el dispositivo gráfico; la ventana se abrió de nuevo
shell-device-lost-advice = Todo lo guardado está ahí; un borrador sin guardar se recupera si su escena sigue disponible. Si vuelve a ocurrir, actualice el controlador gráfico
shell-second-window = Partsight ya está abierto con esta carpeta de datos: con «En vivo» en ambas ventanas, cada pieza cuenta dos veces
shell-second-window-advice = Cierre una de las dos. Esta empezó sin «En vivo» y no guarda sus ajustes
shell-no-thread = El sistema no proporciona un hilo para esto: { $error }
shell-no-thread-advice = Cerrar otros programas e intentarlo de nuevo
shell-library-not-loaded = No se pudo cargar la biblioteca: { $error }
shell-library-not-loaded-advice = { $advice }, o elegir otra arriba a la derecha; hasta entonces no se reconoce nada
shell-library-still-in-use = Se sigue usando la biblioteca en memoria: { $error }
shell-library-inside = La biblioteca está dentro del programa y no se puede cambiar ({ $reason })
shell-inside-program = La biblioteca está dentro del programa y no se puede modificar
shell-inside-program-advice = Elegir una carpeta propia arriba a la derecha
shell-choose-library = Elegir { $path } arriba a la derecha
shell-choose-or-go-on = Elegir otra arriba a la derecha, o continuar: la primera pieza que se guarde quedará allí
shell-holds-no-library = { $path } no contiene ninguna biblioteca de piezas
shell-sentence = { $text }.
shell-about-scene = { $scene }: { $what }

## Words of several areas

shell-view = Vista
shell-part = Pieza
shell-no-part = ninguna
shell-remove = Eliminar
shell-name = Nombre
shell-notes-hint = Lo que convenga recordar
shell-reset = Restablecer
shell-wait = Esperar un momento
shell-apply = Aplicar
shell-pose = Pose
shell-robot-base = Base del robot
shell-store = Guardar
shell-library-loading = La biblioteca se está cargando
shell-choose-another-part = Elegir otra pieza
shell-nothing-inspected = Todavía no hay inspecciones
