## Before there is a draft
enrol-show-part = Mostrar la pieza que se va a registrar
enrol-capture-replacement = Capturar la pieza que sustituye a { $part }
enrol-how = Colgarla delante de la cámara y pulsar Capturar, abrir una captura, una nube de puntos o una malla, o soltar aquí el archivo
enrol-take-shown = Tomar { $scene }, que muestra Inspección
enrol-use-shown = Usar la escena inspeccionada
enrol-see-inspected = Guardada: verla en Inspección
enrol-open-scan-hint = Varias tomas desde varios lados, cada una con la pose de su cámara (Ctrl Mayús O)
enrol-step-capture = 1  Capturar la pieza o abrir su archivo
enrol-step-correct = 2  Comprobar qué se conserva y corregirlo
enrol-step-title = 3  Poner un título
enrol-step-save = 4  Guardar: las inspecciones la reconocen

## The card of the draft
enrol-new-part = Pieza nueva
enrol-replaces = Sustituye a { $part }
enrol-previous-draft = Borrador anterior: se está preparando uno nuevo
enrol-as-new = Registrarla como pieza nueva
enrol-unready-problem = Todavía no se puede guardar: véase arriba
enrol-unready-title = Poner primero un título
enrol-unready-name = Corregir primero el nombre
enrol-unready-library = Esta biblioteca no se puede modificar: véase arriba
enrol-unready-unknown = Aún no se sabe qué se guardará
enrol-points-kept = { $points } puntos
enrol-outline = Contorno { $length }
enrol-openings = Aberturas { $count }
enrol-seen-one-side = Vista desde un lado
enrol-seen-all-around = Vista desde todos los lados
enrol-seen-several-sides = Vista desde varios lados
enrol-painted-from-front = Se pinta por delante
enrol-painted-from-back = Se pinta por detrás
enrol-painted-from-left = Se pinta por la izquierda
enrol-painted-from-right = Se pinta por la derecha
enrol-painted-from-top = Se pinta por arriba
enrol-painted-from-bottom = Se pinta por abajo
enrol-examining = Examinando la pieza…
enrol-stored-unknown = No se sabe qué se guardará
enrol-look-again = Volver a examinar
enrol-title = Título
enrol-title-hint = Nombre habitual de la pieza
enrol-title-full = Un título tiene como máximo { $limit } caracteres; poner el resto en las notas
enrol-name-hint = se propone a partir del título
enrol-notes = Notas
enrol-reference-of = Otra referencia de
enrol-reference-of-chosen = Otra referencia de: { $part }
enrol-reference-of-none = Ninguna otra pieza
enrol-reference-choice = Referencia de: { $part }
enrol-reference-of-hint = Otra vista u otro modelo de una pieza registrada: los resultados nombran esa pieza
enrol-namesake = { $part } ya tiene este nombre
enrol-namesake-advice = Al guardar se sustituye; la versión anterior se puede recuperar
enrol-most-similar = La más parecida: { $part } ({ $percent } % igual)
enrol-most-similar-mirrored = La más parecida: { $part } (su imagen reflejada, { $percent } % igual)
enrol-distinguishable = Las dos se pueden distinguir
enrol-indistinguishable = Las dos no se pueden distinguir
enrol-indistinguishable-advice = Las inspecciones de una u otra quedarán casi empatadas: guardar otra referencia de esa pieza, sustituirla o capturar un lado en el que se diferencien
enrol-replace = Sustituir { $part }
enrol-add-reference = Otra referencia de { $part }
enrol-discard = Descartar
enrol-saving = Guardando…
enrol-save-and-replace = Guardar y sustituir

## The meshes of a file
enrol-meshes = Mallas de { $file }
enrol-meshes-hint = Elegir las piezas que se registran: pasan a ser borradores una tras otra
enrol-meshes-find = Buscar una malla
enrol-meshes-find-hint = Palabras de su nombre
enrol-meshes-order = Ordenar por { $order }
enrol-meshes-size = Tamaño
enrol-meshes-unit = Longitudes en { $unit }
enrol-meshes-counted = { $shown } de { $count } mallas
enrol-meshes-none = Ninguna malla tiene estas palabras en su nombre
enrol-meshes-figures = { $size } · triángulos: { $triangles }
enrol-meshes-enrol =
    { $count ->
        [0] Registrar mallas
        [one] Registrar { $count } malla
       *[other] Registrar { $count } mallas
    }
enrol-meshes-whole = Todo como una pieza
enrol-meshes-whole-hint = Todo el archivo muestra una sola pieza
enrol-mesh-number = Malla { $number } de { $count }
enrol-mesh-skip = Omitir
enrol-mesh-leave-out = Omitir las demás

## The card of an enrolled part
enrol-rename = Cambiar nombre
enrol-spray-path = Trayectoria de pintura…
enrol-remove-path = Eliminar la trayectoria de pintura
enrol-anew = Registrar de nuevo
enrol-origin = Registrada el { $time } a partir de { $source } ({ $method })
enrol-origin-points = { $points } puntos
enrol-origin-simulated = simulada, no procede de una cámara
enrol-origin-seen = vista por una cámara
enrol-origin-path = trayectoria de pintura de { $count } puntos
enrol-origin-number = número para robots: { $number }

## The strip of enrolled parts
enrol-enrolled-parts = Piezas registradas
enrol-library-loading = Cargando la biblioteca…
enrol-num-parts =
    { $count ->
        [0] Todavía no hay piezas registradas: la primera que se guarde aparecerá aquí
        [one] { $count } pieza registrada
       *[other] { $count } piezas registradas
    }
enrol-damaged = Dañada
enrol-tile-reference = Ref. de { $part }
enrol-enrolled = Registrada: { $part }
enrol-renamed-at = Renombrada, { $time }
enrol-brought-back-at = Recuperada, { $time }
enrol-saved-at = Guardada, { $time }
enrol-path-changed-at = Trayectoria, { $time }

## What corrects the draft
enrol-in-front = Delante del fondo
enrol-everything = Todo
enrol-box = Recuadro
enrol-box-hint = Trazar un recuadro en la vista 3D o en la imagen (D)
enrol-lasso-hint = Trazar un lazo en la vista 3D o en la imagen (D, D)
enrol-keep = Dejar
enrol-drop = Quitar
enrol-add = Añadir
enrol-keep-hint = Lo que queda fuera se quita
enrol-drop-hint = Lo que queda dentro se quita
enrol-add-hint = Se toma todo lo que queda dentro, también el fondo
enrol-drag-box = Trazar un recuadro
enrol-drag-lasso = Trazar un lazo
enrol-picture-hint = { $drag } en esta imagen. { $does }. Con un clic se toma o se quita un segmento
enrol-view-hint = { $drag }. { $does }. Atraviesa toda la pieza. Esc para girar
enrol-picture = Imagen de lo que se conserva
enrol-mesh-is-whole = Una malla se registra entera: recortarla en el programa que la creó
enrol-undo-step = Deshacer el último paso
enrol-redo-step = Rehacer el último paso
enrol-reset-all = Restablecer todas las correcciones
enrol-both = Ambas
enrol-picture-pane = Imagen
enrol-view-pane = 3D
enrol-show-both = Mostrar ambas
enrol-show-picture = Mostrar imagen
enrol-show-view = Mostrar 3D
enrol-segment-partly = { $segment } · { $kept } de { $all }
enrol-kept = se conserva
enrol-partly-kept = se conserva en parte
enrol-dropped = se quita
enrol-take-it = Tomarlo
enrol-drop-it = Quitarlo
enrol-segment-stand = Soporte
enrol-segment-surface = Superficie { $number }
enrol-segment-background = Fondo { $number }
enrol-segment-piece = Fragmento { $number }
enrol-segment-specks = Puntos sueltos
enrol-segment-mesh = Malla
enrol-segment-cell = Celda alrededor
enrol-view = Vista 3D del borrador

## Keys
enrol-key-redo = Rehacer el último cambio deshecho
enrol-key-undo = Deshacer la última corrección; sin borrador, el último cambio de la biblioteca
enrol-key-save = Guardar la pieza
enrol-key-draw = Trazar un recuadro; otra vez: un lazo
enrol-key-rotate = Volver a girar la vista 3D al arrastrar

## Work and notices
enrol-path-file-title = Trayectoria de la boquilla sobre esta pieza
enrol-path-files = Tablas
enrol-examining-part = Examinando la pieza
enrol-taking-scan = Tomando el escaneo mostrado
enrol-taking-scene = Tomando la escena mostrada
enrol-live-stopped = En vivo ha terminado: el archivo siguiente es para Registro
enrol-live-stopped-advice = Después pulsar L para volver a «En vivo»
enrol-changing-library = Modificando la biblioteca
enrol-unsaved = La pieza de Registro no está guardada
enrol-unsaved-titled = { $part }, la pieza de Registro, no está guardada
enrol-bringing-back = Recuperando el borrador
enrol-writing-draft = Conservando el borrador
enrol-draft-back = El borrador sin guardar se ha recuperado
enrol-draft-differs = El borrador conserva ahora otros puntos: su escena o la receta ha cambiado
enrol-draft-differs-advice = Compruebe qué se conserva antes de guardar la pieza
enrol-draft-no-scene = La escena del borrador sin guardar ya no está disponible
enrol-draft-no-scene-advice = Capture la pieza otra vez: se conservan el título, el nombre y las notas introducidos
enrol-draft-not-used = El borrador no se usa: { $why }
enrol-draft-set-aside = Se ha movido a { $path }
enrol-draft-not-kept = El borrador no se conserva: { $why }
enrol-draft-too-large-advice = Guarde la pieza o deshaga algunas correcciones
enrol-nothing-to-save = Todavía no hay nada que guardar
enrol-nothing-to-save-advice = Guardar cuando aparezca la imagen de lo que se guardará
enrol-outline-nothing = El contorno no ha cambiado nada
enrol-outline-nothing-advice = Trazarlo alrededor de puntos que se puedan conservar o quitar, o deshacerlo
enrol-other-program = Otro programa ha guardado una pieza llamada { $name } desde que se abrió esta biblioteca
enrol-other-program-advice = Guardar de nuevo para sustituirla o dar otro nombre a esta
enrol-changed-since = { $part } queda como está: otra ventana u otro programa la ha cambiado desde entonces
enrol-changed-since-advice = Abrirla entre las piezas registradas para cambiarle el nombre o eliminarla
enrol-saved = { $part }: guardada
enrol-saved-over = { $part }: guardada; la versión anterior queda en la papelera de la biblioteca
enrol-saved-over-path = { $part }: guardada; la versión anterior queda en la papelera de la biblioteca junto con su trayectoria de pintura: guardar una para el nuevo sistema de coordenadas
enrol-title-changed = Título de { $part } cambiado
enrol-removed = { $part }: eliminada
enrol-brought-back = { $part }: recuperada
enrol-stored-path = Trayectoria de pintura de { $count } puntos guardada con { $part }
enrol-removed-path = Trayectoria de pintura de { $part } eliminada
enrol-undone = Deshecho: «{ $what }»
