## Robot programs
program-files = Programas de robot
program-no-nozzle = Sin el lugar de la boquilla en la brida no se puede comprobar el alcance
program-no-nozzle-advice = Escríbalo en Pintar, debajo del brazo, o no elija brazo
program-not-written = No se escribió ningún programa: { $why }
program-written = Escrito { $path }: { $count } puntos en { $format }
program-written-parts = Escritos { $path } y { $parts } programas que llama: { $count } puntos en { $format }; el controlador los necesita todos
