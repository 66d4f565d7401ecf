## Part and coat
paint-no-part = La biblioteca no tiene ninguna pieza que pintar
paint-no-such-part = { $part } ya no está en la biblioteca
paint-part = Pieza que se pinta: { $part }
paint-part-hint = La pieza registrada que se pinta
paint-recognised-gone = La última pieza reconocida ya no está registrada: elegir la pieza que se pinta
paint-film-within = Película: { $share } % de la superficie dentro de { $target } ± { $tolerance } µm
paint-film-within-hint = Parte de la superficie pintable cuya película está dentro de la tolerancia; bien a partir del { $least } %
paint-side-none = Elegir el lado que se pinta
paint-side-hint = El lado que pinta la pistola, visto por una cámara delante de la pieza; se guarda con la pieza
paint-side-unclear-advice = Elegir arriba por qué lado se pinta
paint-scope-one-side = Del lado que vio la cámara al registrarla
paint-scope-all-around = De este lado; la pieza se conoce por todos los lados
paint-scope-several-sides = De lo orientado hacia un lado; se registró desde varios
paint-coat = Capa
paint-coat-changed = { $coat }, modificada
paint-coat-named = Capa: { $coat }
paint-coat-name = Nombre de la capa
paint-saved-coat = Capa { $coat } guardada
paint-no-coat-folder = No hay carpeta para las capas
paint-no-coat-folder-advice = Iniciar la ventana como usuario con carpeta personal

## What the film comes to
paint-thinnest-thickest = Mínimo · máximo
paint-mean = Media
paint-missed = Sin cubrir
paint-double = Doble
paint-paintable = Superficie pintable
paint-landed = Sólidos en la pieza
paint-time = Tiempo
paint-points = Puntos de la trayectoria
paint-histogram = Parte de la superficie por espesor
paint-histogram-hint = Parte de la superficie por espesor, en porcentaje del objetivo; en verde lo que está dentro de la tolerancia

## Tools
paint-regions = Zonas
paint-keep-out = Excluir
paint-box = Recuadro
paint-keep-out-box = Excluir: recuadro
paint-keep-out-lasso = Excluir: lazo
paint-brush = Pincel
paint-keep-out-brush = Excluir: pincel
paint-keep-out-hint = Arrastrar alrededor de lo que no lleva pintura. Esc para girar
paint-brush-hint = Arrastrar sobre lo que no lleva pintura. Esc para girar
paint-only = Pintar solo
paint-in-box = En un recuadro
paint-only-box = Pintar solo: en un recuadro
paint-in-lasso = En un lazo
paint-only-lasso = Pintar solo: en un lazo
paint-only-hint = Arrastrar alrededor de lo único que se pinta; varias zonas se suman. Esc para girar
paint-clear = Borrar
paint-clear-hint = Descartar todas las zonas y lo movido a mano
paint-by-hand = Corregir a mano
paint-move-stroke = Mover pasada
paint-move-stroke-hint = Arrastrar una pasada a donde debe ir. Esc para girar
paint-move-point = Mover punto
paint-move-point-hint = Arrastrar un punto de una pasada; sus vecinos lo siguen. Esc para girar
paint-turn-gun = Inclinar pistola
paint-turn-gun-hint = Arrastrar desde un punto de una pasada para inclinar la pistola hacia ahí. Esc para girar
paint-edits-dropped = Lo movido a mano era de la trayectoria anterior y se descartó
paint-edits-dropped-advice = Deshacer lo recupera; corregir la trayectoria a mano al final
paint-drawn-dropped = Lo dibujado sobre { $part } en Pintar se descartó
paint-drawn-dropped-undo = Deshacer lo recupera
paint-drawn-dropped-again = La pieza se eliminó o se registró de nuevo; volver a dibujar lo que haga falta
paint-film-colours = Colores de película
paint-film-colours-hint = Colorear la pieza según el espesor de la película

## View and timeline
paint-view = Vista 3D de la pieza y su trayectoria de pintura
paint-gun-off = pistola cerrada
paint-key-play = Recorrer la trayectoria con la pistola o pararla
paint-key-back = A la pasada anterior
paint-key-on = A la pasada siguiente
paint-place-on = { $time } de { $end } · pasada { $stroke } de { $all } · pistola abierta
paint-place-off = { $time } de { $end } · pasada { $stroke } de { $all } · pistola cerrada
paint-path-takes = { $length } m de trayectoria · { $paint } ml de pintura
paint-timeline = Lugar de la pistola en la trayectoria, segundos
paint-timeline-keys = Las flechas mueven la pistola, Espacio reproduce
paint-blocks-are-strokes = Bloques: pistola abierta
paint-drag-to-move = Arrastrar para mover la pistola

## The path
paint-planning = Planificando la trayectoria
paint-not-planned = Sin planificar: elegir la pieza de nuevo
paint-previous-path = Datos de la trayectoria anterior
paint-proposing = Buscando separación y velocidad
paint-storing-side = Guardando el lado
paint-storing = Guardando la trayectoria
paint-propose = Proponer
paint-propose-hint = Buscar la separación y la velocidad con las que la película alcanza su objetivo
paint-export-hint = Escribir la trayectoria como tabla
paint-export-title = Exportar la trayectoria de pintura
paint-store = Guardar con la pieza
paint-store-hint = Guardar la trayectoria con la pieza; las inspecciones y los programas de robot la usan desde entonces
paint-is-stored = Esta trayectoria está guardada con la pieza
paint-planned-path = Planificada
paint-stored-path = Guardada, { $count } puntos
paint-unsaved = Las zonas dibujadas en Pintar no están guardadas como trayectoria

## The robot
paint-robot = Robot
paint-arm-group = Brazo y boquilla
paint-cell-group = Celda y controlador
paint-reach-group = Alcance
paint-arm = Brazo: { $arm }
paint-arm-hint = El brazo cuyo alcance se comprueba; sin brazo no se comprueba
paint-no-arm = Sin brazo
paint-from-file = De un archivo…
paint-arm-title = Abrir un brazo
paint-nozzle = Boquilla en la brida
paint-nozzle-hint = Dónde está la boquilla en la brida, z hacia donde apunta: una convención y seis números, o los 16 números de una matriz
paint-example = p. ej. { $example }
paint-no-nozzle-advice = Escríbalo en «Boquilla en la brida», o no elija brazo
paint-base = Base del brazo
paint-base-hint = Pose de la base del brazo en el sistema de la calibración, como la escribe KUKA: girada A alrededor de z, la vertical, luego B alrededor del nuevo eje y, y C alrededor del nuevo eje x. Todo 0: los dos sistemas coinciden
paint-base-number = Base del brazo: { $name }
paint-rail = Carril
paint-rail-hint = El carril sobre el que está el brazo: eje de la calibración, inicio y fin en mm y, si se mueve a lo largo de la trayectoria, velocidad máxima en mm/s y, si se conoce, aceleración en mm/s². Vacío: el del archivo del brazo
paint-no-obstacles = Solo la pieza
paint-obstacles = Obstáculos: { $file }
paint-obstacles-hint = Con qué no deben chocar la pistola y el brazo además de la pieza: cajas de la celda y su suelo, de un archivo TOML
paint-obstacles-title = Abrir las cajas de la celda
paint-more-robot = Herramienta, pistola y velocidad
paint-tool = Herramienta en el controlador
paint-tool-hint = Un número en KUKA, FANUC y Yaskawa, un nombre en ABB y Doosan
paint-tilted = { $num ->
        [one] Pistola inclinada hasta { $degrees }° en { $num } punto donde el brazo no seguiría la trayectoria.
       *[other] Pistola inclinada hasta { $degrees }° en { $num } puntos donde el brazo no seguiría la trayectoria.
    }
paint-changed-moves = Movimientos sin pintar: { $slower } más lentos de lo previsto, { $joints } por ejes.
paint-slower-spraying = { $num ->
        [one] Pistola más lenta en { $num } movimiento mientras pinta, para que el brazo pueda seguir la trayectoria; la película sigue dentro de su tolerancia.
       *[other] Pistola más lenta en { $num } movimientos mientras pinta, para que el brazo pueda seguir la trayectoria; la película sigue dentro de su tolerancia.
    }
paint-not-calibrated = Primero calibre la celda, arriba en Robot…
paint-checking-reach = Comprobando el alcance del brazo
paint-arm-not-checked = Brazo: sin comprobar
paint-arm-reaches-all = Brazo: alcanza el 100 % de la trayectoria, los { $all } puntos
paint-arm-reaches-some = Brazo: alcanza el { $share } % de la trayectoria, todos salvo { $missed } de { $all } puntos
paint-arm-reaches-hint = Parte de los puntos de la trayectoria que el brazo alcanza sin colisión; bien solo si los alcanza todos
paint-acceleration-advice = Planifique con menos caudal de pintura, reduzca la velocidad donde acelera demasiado despacio, o redondee las esquinas con un radio mayor
paint-joints-advice = Pruebe otro ángulo de la boquilla, más inclinación de la pistola, otro lugar de la base o menos velocidad
paint-collisions = Colisiones
paint-collisions-not-checked = no comprobadas
paint-no-collisions-reached = ninguna donde alcanza
paint-no-collisions-part = ninguna con pieza y brazo
paint-num-collisions =
    { $count ->
        [0] ninguna
        [one] { $count } punto
       *[other] { $count } puntos
    }
paint-show-unreached = Mostrar el siguiente
paint-rail-moves = A lo largo de la trayectoria su carril está entre { $from } y { $to } mm
paint-rail-at = A { $at } mm de su carril alcanzaría { $count }
paint-base-moved = Con la base desplazada { $by } mm alcanzaría { $count }
paint-apply-rail = Mover la base hasta ahí a lo largo del carril
paint-apply-base = Mover la base hasta ahí
paint-export-program = Programa…
paint-export-program-hint = Escribir la trayectoria como programa del controlador, con la pieza colgada como al registrarla
paint-program-title = Exportar un programa del robot
