# La comprobación de la celda: su resultado, y por qué no se pueden comparar imágenes

cell-in-place = la cámara y la pieza están en su sitio
    .advice = No hay que hacer nada
cell-part-moved = la pieza se movió; la cámara no
    .advice = Colgar la pieza como estaba, o revisar lo que la sujeta, y comprobar de nuevo; si ha de quedarse así, tomar un nuevo estado inicial
cell-camera-moved = la cámara se movió
    .advice = Fijar la cámara, calibrarla de nuevo y después tomar un nuevo estado inicial
cell-part-or-camera-moved = la pieza o la cámara se movió
    .advice = Colgar la pieza como estaba y comprobar de nuevo; si no basta, la cámara se movió: calibrarla y tomar un nuevo estado inicial
cell-noisier = la cámara y la pieza están en su sitio, pero las lecturas tienen más ruido
    .advice = Limpiar la ventana de la cámara, buscar luz parásita o niebla delante de ella y comprobar de nuevo
cell-no-frame = ninguna imagen
    .advice = Capturar la pieza que comprueba la celda e indicar el archivo
cell-moving = las imágenes no coinciden: en la imagen { $frame } la pieza está { MM($shift_m, 1) } mm y { DEGREES($turn_rad, 2) }° fuera de donde está en la primera
    .advice = Dejar la pieza quieta, no mover la cámara y capturar de nuevo
cell-other-part = solo el { PERCENT($overlap, 0) } % de lo que se ve en la imagen { $frame } está sobre la pieza del estado inicial
    .advice = Colgar la pieza del estado inicial en su sitio habitual, sin nada delante; si está colgada allí, la cámara o la pieza se movió varios centímetros
cell-pose = imagen { $frame }: { $why }

cell-calibration = { $name }
cell-unnamed-calibration = una calibración sin nombre ({ $identity })
cell-scan-poses = las poses del escaneo
