# The shots of a scan
shots-shots = Tomas
shots-add = Añadir una toma…
shots-add-says = Una imagen de la misma pieza; su pose debe estar en el archivo de poses o en poses.json junto a ella
shots-redo-label = Rehacer el cambio de las tomas
shots-undo-label = Deshacer el cambio de las tomas
shots-all-used = { $num } tomas
shots-some-used = { $used } de { $num } tomas usadas
shots-agree = { $used } · concuerdan a { $rms } rms
shots-use = Usar { $name }
shots-drop-says = Quitar esta toma: las demás se unen sin ella
shots-take-back-says = Recuperar esta toma
shots-mark = Marcar lo que solo ve la toma { $shot }
shots-dropped = Quitada
shots-left-out = Excluida: { $why }
shots-left-out-says = { $why }. { $advice }
shots-shot-left-out = La toma { $shot } queda excluida: { $why }
shots-seen = { $share } % de la pieza
shots-seen-says = Ve { $num } puntos de la pieza
shots-alone = solo esta: { $share }
shots-no-part = sin pieza en ella
shots-no-part-says = Las demás tomas determinan qué de ella es la pieza
shots-moved = movida { $shift } · { $turn }
shots-rms = rms { $rms }
shots-to-be-dropped = Se quitará…

## The summary

shots-scan = Escaneo
shots-used = tomas usadas
shots-num-used = { $used } de { $num }
shots-refined-by = poses refinadas hasta en
shots-agree-to = concordancia, rms
shots-points = puntos de la pieza
shots-outline-open = contorno abierto
shots-not-seen = No visto por ninguna toma · { $share } de la superficie registrada
shots-unseen = Sin ver: la pieza puede continuar aquí · { $share } del contorno
shots-seen-by-one = Visto solo por la toma { $shot } · { $share } de la pieza

## Why a shot is left out

shots-wrong-pose = pose errónea
shots-wrong-pose-by = su pose es errónea: la imagen encaja a { $shift } y { $turn }
shots-contradicts = contradice a las demás imágenes
shots-contradicts-by = contradice a las demás imágenes: concuerda el { $share } % de lo que ven en común
shots-looked-past-by = contradice a las demás imágenes: una ve más allá del { $share } % de lo que ambas deberían ver
shots-overlaps-none = no solapa con otra
shots-overlaps-none-says = no solapa con ninguna otra toma, así que su pose no se puede comprobar
shots-part-moved = la pieza se movió
shots-part-moved-by = la pieza se movió: la celda concuerda con las demás imágenes, de la pieza el { $share } %
shots-excluded-advice = Comprobar que esta pose corresponde a esta imagen y volver a capturarla con el brazo en reposo
shots-overlaps-none-advice = Comprobar que esta pose corresponde a esta imagen, o añadir una toma que muestre superficie de esta y de otra
shots-part-moved-advice = Volver a capturar la imagen con la pieza inmóvil

## Files

shots-add-a-frame = Añadir una imagen al escaneo
shots-poses-file = Archivo de las poses de las tomas
shots-poses = Poses
shots-at-least = Un escaneo necesita al menos { $num } tomas
shots-take-another = Recuperar antes otra toma
shots-putting-together = Uniendo las tomas
shots-adding = Añadiendo { $name }
shots-is-left-out = { $name } queda excluida: { $why }
