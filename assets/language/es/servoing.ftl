## How a run is described
servoing-standard-position = Posición estándar
servoing-camera-pose = Pose de cámara grabada
servoing-path-start = Inicio de la trayectoria
servoing-looking = Buscando la pieza
servoing-moving = En movimiento
servoing-waiting = Espera a Siguiente
servoing-holding = En espera
servoing-checking = Comprobando en reposo
servoing-arrived = Se ha alcanzado el objetivo
servoing-arrived-approximately = Se ha alcanzado el objetivo aproximadamente: la pieza puede ser de otro modelo
servoing-stopped = Detenido
servoing-state-left = { $state }: faltan { $left }
servoing-tolerance = Tolerancia
servoing-shift-left = Desplazamiento restante, mm
servoing-turn-left = Rotación restante, °

## The page
servoing-start = Iniciar
servoing-stop = Detener
servoing-stop-keys = También lo detienen la barra espaciadora y Esc
servoing-key-stop = Detener el robot
servoing-key-next = Permitir el siguiente paso
servoing-running = Guiando el robot
servoing-begins = Preparando el recorrido
servoing-stopping = El robot está frenando
servoing-waits-for-robot-advice = Inicie el programa en el controlador del robot
servoing-nothing-yet = Aún no hay recorridos
servoing-nothing-yet-advice = Elija a la derecha la pieza y el robot, y pulse Iniciar
servoing-left = El robot se ha detenido porque ha salido de la página Servo
servoing-left-advice = Permanezca en la página mientras el robot se mueve
servoing-view = Vista 3D del recorrido
servoing-target = Objetivo
servoing-nozzle = Boquilla
servoing-flange = Brida
servoing-error = Error restante
servoing-bounds = Incertidumbre, 95 %
servoing-took = Duración
servoing-looks = Imágenes aceptadas
servoing-looks-of = { $accepted } de { $count }
servoing-delay = De imagen a resultado

## What is servoed
servoing-part-and-target = Pieza y objetivo
servoing-remove-frame = Quitar esta imagen del objetivo
servoing-add-frame = Añadir una imagen…
servoing-frame-title = Imagen de la pieza, tomada donde debe estar la cámara
servoing-simulated = Simulado
servoing-simulated-says = Un brazo con la cámara en la brida, en la celda simulada. Su calibración tiene un error de hasta 20 mm y 2°
servoing-listen-at = Dirección y puerto de este equipo
servoing-connect-to = Dirección del robot
servoing-no-safety = Guiar el robot no es una función de seguridad. No se ha probado en controladores: pruébelo despacio, con la mano en el paro
servoing-limits = Límites
servoing-speed = Velocidad máxima
servoing-in-steps = Por pasos
servoing-in-steps-hint = El robot espera a Siguiente antes de cada paso de hasta 50 mm y 5°
servoing-volume-says = Caja en el sistema de la base del robot que la brida, la cámara y la boquilla nunca abandonan
servoing-clearance = Distancia de seguridad
servoing-arm = Brazo
servoing-no-nozzle = Ninguna
servoing-to-robot = Cambiarlos en Pintar

## What is missing
servoing-no-part = No hay ninguna pieza registrada
servoing-no-part-advice = Registre una pieza en Registro, o elija otra biblioteca
servoing-not-simulated-advice = Elija una de las piezas incluidas en el programa, o un robot real
servoing-no-address = Falta la dirección del robot, o es incorrecta
servoing-listen-advice = Introduzca la dirección de este equipo y el puerto al que llegan los paquetes del controlador, por ejemplo 192.168.1.10:6510
servoing-connect-advice = Introduzca la dirección del robot, por ejemplo 192.168.1.20
servoing-no-camera = La fuente no es una cámara: sus imágenes deben mostrar lo que cuelga ahora
servoing-no-camera-advice = Elija en la barra de estado una cámara como fuente, o un robot simulado
servoing-no-frames = El objetivo no tiene ninguna imagen
servoing-no-frames-advice = Añada imágenes de la pieza tomadas donde debe estar la cámara
servoing-no-arm = Los robots de KUKA reciben ángulos de ejes, así que el brazo debe conocerse
servoing-no-arm-advice = En Pintar, bajo Robot, elija el brazo e introduzca la boquilla
servoing-not-calibrated = No se sabe dónde está la cámara
servoing-not-calibrated-advice = Calíbrela primero: pulse B y después Calibración

## Runs in the history
servoing-runs = Recorridos
servoing-runs-hint = Recorridos en los que la cámara guió un robot, en lugar de las inspecciones
servoing-runs-counted = { $count ->
        [one] { $matching } de { $count } recorrido
       *[other] { $matching } de { $count } recorridos
    }
servoing-no-runs-listed = Ningún recorrido coincide con el filtro
servoing-choose-run = Elija un recorrido para ver su curva
servoing-row = Recorrido { $number }: { $part }, { $end }
servoing-run-number = Recorrido { $number }
servoing-source = Fuente
servoing-time = Hora
servoing-wrote = { $count ->
    [one] Se ha escrito { $count } recorrido en { $path }
   *[other] Se han escrito { $count } recorridos en { $path }
}
