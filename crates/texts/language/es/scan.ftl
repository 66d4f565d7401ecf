# Por qué se omite una imagen de un escaneo

excluded-wrong-pose = su pose es errónea: la imagen encaja a { MM($shift_m, 1) } mm y { DEGREES($turn_rad, 2) }°
    .advice = Comprobar que esta pose corresponde a esta imagen y volver a capturarla con el brazo en reposo
    .short = pose errónea
excluded-contradicts = contradice a las demás imágenes: concuerda el { PERCENT($share, 0) } % de lo que ven en común
    .advice = { excluded-wrong-pose.advice }
    .short = contradice a las demás imágenes
excluded-looked-past = contradice a las demás imágenes: una ve más allá del { PERCENT($share, 1) } % de lo que ambas deberían ver
    .advice = { excluded-wrong-pose.advice }
    .short = { excluded-contradicts.short }
excluded-overlaps-none = no solapa con ninguna otra toma, así que su pose no se puede comprobar
    .advice = Comprobar que esta pose corresponde a esta imagen, o añadir una toma que muestre superficie de esta y de otra
    .short = no solapa con otra
excluded-part-moved = la pieza se movió: la celda concuerda con las demás imágenes, de la pieza el { PERCENT($share, 0) } %
    .advice = Volver a capturar la imagen con la pieza inmóvil
    .short = la pieza se movió

# Frames of a scan
left-out = { $name } queda excluida: { $why }
no-part-in-frame = sin pieza en ella
