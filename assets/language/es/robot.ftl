# The robot's cell
robot-title = Robot
robot-in-use = Calibración
robot-by-hand = A mano
robot-from-pairs = De pares de poses
robot-load-title = Cargar la calibración de la celda del robot
robot-calibrations = Calibraciones
robot-pairs-title = Pares de poses de robot y cámara
robot-tables = Tablas y JSON
robot-forgotten = La calibración ya no se usa; su archivo se conserva
robot-opening = Abriendo la calibración
robot-saving = Guardando la calibración
robot-calculating = Calculando dónde está la cámara
robot-no-folder = No hay carpeta para la calibración propia
robot-no-folder-advice = Escribirla con partsight calibrate --out FILE y cargar aquí ese archivo
robot-saved = Guardada; la calibración anterior se conserva en { $path }

## In use

robot-not-calibrated = La celda no está calibrada: las poses están en el sistema de la cámara y un robot no puede usarlas
robot-file = archivo
robot-edited = los números de la calibración se cambiaron y no se confirmaron: ningún robot recibe poses
robot-edited-advice = Compruebe los números en Robot…; confírmelos si son correctos, si no, calibre de nuevo
robot-confirm = Confirmar…
robot-confirm-says = ¿Está la cámara ahí? Los números contarán como introducidos a mano y los robots recibirán poses según ellos. El archivo anterior se conserva
robot-confirm-not = Ahora no
robot-confirm-right = Son correctos
robot-load = Cargar…
robot-forget = Olvidar
robot-cell = celda
robot-camera = cámara
robot-made = creada
robot-from = origen
robot-entered-by-hand = introducida a mano
robot-pairs-of = { $num ->
        [one] { $num } par de { $file }
       *[other] { $num } pares de { $file }
    }
robot-residuals = residuos
robot-residuals-are = { $mm } mm y { $degrees }° rms, peor { $worst } mm ({ $pair })
robot-uncertainty = incertidumbre (95 %)
robot-mm-and-degrees = { $mm } mm y { $degrees }°
robot-flange-at-every = robot_from_flange en cada captura
robot-flange-unknown = no se conoce la pose de la brida al capturar: no hay pose para el robot
robot-flange-unknown-advice = Escribir la pose de la brida como la muestra el controlador y guardarla
robot-flange-at = Brida al capturar

## By hand

robot-camera-in-cell = Cámara en la celda
robot-camera-on-flange = Cámara en la brida
robot-numbers-of = Números de
robot-numbers-are-of = Números de: { $convention }
robot-where-camera-stands = { $transform }: dónde está el sistema de la cámara
robot-name-of-cell = Nombre de la celda
robot-use-it = Usar
robot-use-anyway = Usar de todos modos

## From pairs

robot-choose-pairs = Elegir pares…
robot-choose-pairs-says = Tabla o JSON de poses de robot y cámara, de 8 a 15 pares
robot-pairs-format = Cada línea contiene la pose del robot, como el controlador muestra la brida, y después la de la cámara: dónde ve el objetivo. Líneas como "# robot: kuka" y "# camera: matrix" al principio indican las convenciones. Una pieza registrada puede ser el objetivo: partsight calibrate hand-eye --captures
robot-counts = cuenta
robot-off-mm = error mm
robot-off-degrees = error °
robot-worst = peor
robot-left-out = excluido
robot-rms = rms de los residuos
robot-not-determined = los pares no la determinan
robot-flange-turned = giro de la brida
robot-span = { $turn }° como máximo, { $other }° en otros ejes; objetivo movido { $travel } mm
robot-read-as = leído como
robot-conventions-are = robot { $robot }, cámara { $camera }
robot-eye-to-hand = eye-to-hand: la cámara está fija en la celda
robot-eye-in-hand = eye-in-hand: la cámara está en la brida

## Check of the cell

robot-check = Comprobación
robot-check-says = Una pieza colgada cada día en el mismo sitio muestra si la cámara y la celda siguen donde estaban. Sirve cualquier cosa rígida con bordes en todas las direcciones; dejar algo de pared o suelo en la imagen
robot-check-no-folder = No hay carpeta para el estado inicial y las comprobaciones
robot-check-no-folder-advice = Usar partsight cell con --folder DIR
robot-no-baseline = No hay estado inicial con el que comparar
robot-no-baseline-advice = Tomarlo mientras la celda está bien
robot-baseline = estado inicial
robot-taken-at =
    { $time }, { $count ->
        [one] 1 imagen
       *[other] { $count } imágenes
    }
robot-allowed = permitido
robot-allowed-are = { $shift } y { $turn }
robot-no-wall = Ni la pared ni el suelo están en la imagen del estado inicial: una comprobación no puede distinguir si se movió la cámara o la pieza
robot-no-wall-advice = Dejar algo de ellos en la imagen y tomar un nuevo estado inicial
robot-frames-from = imágenes de
robot-new-baseline-allows = Un nuevo estado inicial permite
robot-allowed-shift = Desplazamiento permitido, mm
robot-allowed-turn = Rotación permitida, grados
robot-take-baseline = Tomar el estado inicial
robot-take-new-baseline = Tomar un nuevo estado inicial…
robot-check-now = Comprobar ahora
robot-replace-says = ¿Reemplazar el estado inicial? Desde entonces se compara con el nuevo, y el anterior no se conserva
robot-keep-baseline = Conservarlo
robot-replace-baseline = Reemplazarlo
robot-reading-checks = Leyendo el estado inicial y las comprobaciones
robot-taking-baseline = Tomando el estado inicial
robot-checking = Comprobando la celda
robot-writing-checks = Escribiendo las comprobaciones
robot-check-of-scan = Un escaneo se ve desde varios lugares y no es una comprobación de la celda
robot-check-of-scan-advice = Elegir una cámara como fuente o abrir una sola captura
robot-last-check = Última comprobación
robot-checked = comprobado
robot-of-allowed = { $value }, permitido { $limit }
robot-part-shifted = la pieza se movió
robot-along-axes = en x, y, z de la cámara
robot-part-turned = la pieza giró
robot-wall-shifted = pared y suelo se movieron
robot-wall-not-found = no se encontraron de nuevo
robot-readings = lecturas
robot-readings-are = { $rms } rms respecto al estado inicial, { $ratio } veces su ruido
robot-checks-shown = { $count ->
        [one] Últimas { $shown } de { $count } comprobación
       *[other] Últimas { $shown } de { $count } comprobaciones
    }
robot-shift-over-time = Desplazamiento desde el estado inicial en x, y, z de la cámara
robot-check-time = hora
robot-check-shift = desplazamiento
robot-check-turn = rotación
robot-check-finding = resultado
robot-export-checks-title = Exportar las comprobaciones de la celda
robot-checks-written =
    { $count ->
        [one] Una comprobación escrita
       *[other] { $count } comprobaciones escritas
    } en { $path }
robot-moved = Última comprobación de la celda, { $time }: { $finding }
robot-moved-advice = Pedir a un técnico que lo revise antes de pintar: Robot…, Comprobación

## Answering robots

robot-answer = Peticiones
robot-answer-says = Robots y PLC piden por TCP una inspección y reciben resultado y pose, como de partsight serve. Cada trigger se responde con una imagen que la fuente de la ventana da después. SERVO usa el objetivo y los límites de la página Servo
robot-protocol = Protocolo
robot-port = Puerto, o dirección IP y puerto
robot-pose-of-part = Dónde está la pieza
robot-pose-offset = Distancia a su posición estándar
robot-poses-as = poses como
robot-answered-in = Responder en: { $convention }
robot-change-poses = Se está respondiendo a robots: los números de su próxima pose significarían otra cosa
robot-change-poses-advice = Primero parar los robots y adaptar sus programas. Todas las conexiones terminan y cambia el número boot
robot-change-poses-do = Cambiar
robot-change-poses-not = Dejar como está
robot-no-address = "{ $text }" no es un puerto ni una dirección IP con puerto
robot-no-address-advice = Indicar un puerto de 1 a 65535, o con él la dirección de la tarjeta de red de este equipo, como 192.168.1.10:30100
robot-other-convention = Elegir otra convención
robot-turn-on = Activar
robot-turn-off = Desactivar
robot-calibrate-first = Calibrarla primero: sin ello no hay pose
robot-answers-at = Responde a robots · { $at }
robot-answers-without-frames = Responde a robots, sin imágenes
robot-answers-without-frames-advice = Pulsar En vivo: hasta entonces cada trigger recibe un error
robot-answers-soon = Empezando a responder a robots
robot-not-answered = No se responde a los robots
robot-port-in-use = No se puede escuchar en { $at }: otro programa usa este puerto
robot-port-in-use-advice = Cerrar el otro programa, o elegir otro puerto. Se vuelve a intentar cada 3 s
robot-cannot-listen-advice = Elegir otro puerto desde 1024, o la dirección de una tarjeta de red de este equipo
robot-listens-at = escucha en
robot-clients = conexiones
robot-last-client = última conexión
robot-client-connected = { $peer } se conectó
robot-client-left = { $peer } se desconectó
robot-client-turned-away = { $peer } fue rechazado: ya están conectados todos los clientes permitidos
robot-client-turned-away-advice = Cerrar una conexión que no se use
robot-last-trigger = último trigger
robot-no-trigger = ninguno aún
robot-answer-number = n.º { $number }
robot-answer-age = imagen de hace { $age } ms
robot-answer-motion-unchecked = no se ha comprobado si la pieza se mueve
robot-part-numbers = Números de las piezas

## Poses and conventions
robot-motion-unknown = No se sabe si la pieza colgaba quieta

## Lo que no se comprobó
