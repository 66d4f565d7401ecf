## Robot programs
program-files = Programas de robot
program-no-nozzle = Sin el lugar de la boquilla en la brida no se puede comprobar el alcance
program-no-nozzle-advice = Escríbalo en Pintar, debajo del brazo, o no elija brazo
program-not-written = No se escribió ningún programa: { $why }
program-written = { $count ->
        [one] Escrito { $path }: { $count } punto en { $format }
       *[other] Escrito { $path }: { $count } puntos en { $format }
    }
program-written-parts = { $parts ->
        [one] Escritos { $path } y { $parts } programa que llama: { $count } puntos en { $format }; el controlador necesita ambos
       *[other] Escritos { $path } y { $parts } programas que llama: { $count } puntos en { $format }; el controlador los necesita todos
    }
program-gun-output = Salida que abre la pistola
program-gun-output-help = Número de la salida digital que abre la pistola
program-gun-radius = Radio de la pistola
program-gun-radius-help = Radio de la pistola alrededor de la línea de la brida a la boca de la boquilla; cuenta como máximo la mitad de la longitud de la pistola
program-clearance = Distancia de seguridad
program-clearance-help = Distancia mínima de la pistola y el brazo a la pieza, las cajas y el suelo
program-speed = Velocidad donde la trayectoria no la fija
program-speed-help = Velocidad de la boquilla donde la trayectoria no la fija
program-approach = Aproximación y retirada
program-approach-help = Distancia de los puntos de aproximación al primer y al último punto de la trayectoria
program-blend = Radio de redondeo
program-blend-help = Radio dentro del cual el robot puede recortar las esquinas
program-max-tilt = Inclinación de la pistola si hace falta, hasta
program-max-tilt-help = Inclinación máxima de la boquilla alrededor del punto al que apunta; solo donde el brazo no puede seguir la trayectoria de otro modo
