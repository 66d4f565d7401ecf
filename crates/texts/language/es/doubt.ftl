# Por qué un robot no debe actuar según un resultado

doubt-past = No apta para robots: { $why }

doubt-reported-wrong = la pieza fue notificada como errónea
    .advice = Compruebe qué pieza cuelga ahí y captúrela de nuevo
    .past = la pieza fue notificada como errónea
doubt-source-lost = la fuente se perdió, así que no se sabe qué cuelga ahí ahora
    .advice = Conecte la fuente de nuevo y capture la pieza otra vez
    .past = se perdió la fuente
doubt-moving = la pieza se mueve
    .advice = Espere a que la pieza cuelgue quieta
    .past = la pieza se movía
doubt-superseded = puede que ya cuelgue ahí otra pieza
    .advice = Capture de nuevo la pieza
    .past = quizá ya colgaba otra pieza ahí
doubt-other-order = su orden espera otras piezas que aquellas para las que se inspeccionó
    .advice = Capture de nuevo la pieza
    .past = su orden esperaba otras piezas
doubt-not-accepted = la pieza no fue aceptada
    .advice = Capture de nuevo la pieza
    .past = la pieza no fue aceptada
doubt-no-pose = la pieza no tiene pose
    .advice = Elija una receta que estime la pose e inspeccione la pieza de nuevo
    .past = la pieza no tenía pose
doubt-not-calibrated = la celda no está calibrada
    .advice = Calibre dónde está la cámara en la celda del robot, arriba en Robot…
    .past = la celda no estaba calibrada
doubt-clock-ahead = la captura tiene una fecha { FIXED($seconds, 0) } s posterior a la actual, así que no se conoce su antigüedad
    .advice = Ponga en hora este ordenador y el que escribió la captura con el mismo servidor de hora y capture la pieza de nuevo
    .past = la captura tenía una fecha posterior a la hora de este ordenador
doubt-old = la captura tiene más de 10 minutos, o no se conoce su antigüedad
    .advice = Capture de nuevo la pieza
    .past = la captura tenía más de 10 minutos, o no se conocía su antigüedad
doubt-ambiguous-pose = otra pose de la pieza encaja casi igual de bien
    .advice = Gire la cara de la pieza hacia la cámara, toda dentro de la imagen; si girada se ve igual, regístrela e inspecciónela con algo a la vista que la distinga, como un soporte o un recorte
    .past = otra pose de la pieza encajaba casi igual de bien
doubt-surface = la superficie de la pieza no está bien
    .advice = Mire las zonas que la inspección rodea, y repase o retire la pieza
    .past = la superficie de la pieza no estaba bien
doubt-off-scale =
    .past = la pieza era mayor o menor que su referencia
doubt-frames-disagree = puede que las tomas no encajen: el { PERCENT($disagreeing, 1) } % de lo que { $frame } y las demás ven en común se contradice; lo habitual es un { PERCENT($most, 0) } % como máximo
    .advice = Compruebe que cada pose corresponde a su toma y que nada se movió entre las tomas
    .past = las tomas del escaneo se contradecían
doubt-poses-apart = las poses se contradicen: { $one } y { $other } solo encajan si una se desplaza { MM($apart_m, 1) } mm
    .advice = Compruebe que cada pose corresponde a su toma, que el brazo estaba parado y que su calibración sigue siendo válida; el lugar de la pieza en el sistema de la base del robot solo es tan seguro como concuerdan las poses
    .past = las poses del escaneo se contradecían
doubt-off-the-part = la trayectoria no apunta a la pieza ({ $num_too_near ->
        [0] solo { $num_aiming } de { $num_spraying } puntos con la pistola abierta
       *[other] en { $num_too_near } de { $num_spraying } puntos con la pistola abierta, la boquilla está a menos de { MM($least_m, 0) } mm delante de ella o detrás de su superficie
    })
    .advice = Compruebe que la trayectoria es de esta pieza, o planifique y guarde otra en Pintar
doubt-not-reached = { $arm } no alcanza { $num_missed } de { $num_points } puntos{ $num_collisions ->
        [0] {""}
       *[other] , { $num_collisions } de ellos porque chocaría
    }
    .advice = Mueva la pieza o la base del brazo, o cambie la trayectoria
doubt-film-off-plan = el programa dejaría el { PERCENT($written, 1) } % de la superficie a menos del { PERCENT($tolerance, 0) } % del objetivo, con { UM($written_m, 1) } µm de media; estaban previstos { PERCENT($planned, 1) } % y { UM($planned_m, 1) } µm. Con la pistola abierta se detendría { $num_stops } veces
    .advice = Planifique la trayectoria sin pasadas por los flancos (Inclinación a flancos 0), o escríbala para un controlador que conmute la pistola en movimiento
