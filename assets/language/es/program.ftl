## Robot programs
program-files = Programas de robot
program-no-nozzle = Sin el lugar de la boquilla en la brida no se puede comprobar el alcance
program-no-nozzle-advice = Escríbalo en Pintar, debajo del brazo, o no elija brazo
program-stale = No se escribió nada: la captura tiene más de 10 minutos
program-stale-advice = Capture la pieza de nuevo
program-clock-ahead = No se escribió nada: la captura tiene una fecha { $seconds } s posterior a la actual, así que no se conoce su antigüedad
program-clock-ahead-advice = Ponga en hora este ordenador y el que escribió la captura con el mismo servidor de hora y capture la pieza de nuevo
program-ambiguous = No se escribió nada: otra pose de la pieza encaja igual de bien
program-ambiguous-advice = Capture de nuevo la pieza entera, para que solo encaje una pose
program-off-part = No se escribió ningún programa: la trayectoria no apunta a la pieza (solo { $aiming } de { $all } puntos con la pistola abierta)
program-off-part-advice = Compruebe que la trayectoria es de esta pieza, o planifique y guarde otra en Pintar
program-not-reached = No se escribió ningún programa: { $arm } no alcanza { $missed } de { $all } puntos
program-not-reached-advice = Mueva la pieza o la base del brazo, o cambie la trayectoria
program-film-off-plan = No se escribió ningún programa: dejaría el { $written } % de la superficie a menos del { $tolerance } % del objetivo, con { $written_um } µm de media; estaban previstos { $planned } % y { $planned_um } µm. Con la pistola abierta se detendría { $stops } veces
program-film-off-plan-advice = Planifique la trayectoria sin pasadas por los flancos (Inclinación a flancos 0), o escríbala para un controlador que conmute la pistola en movimiento
program-written = Escrito { $path }: { $count } puntos en { $format }
program-written-parts = Escritos { $path } y { $parts } programas que llama: { $count } puntos en { $format }; el controlador los necesita todos
