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

## Files

shots-add-a-frame = Añadir una imagen al escaneo
shots-poses-file = Archivo de las poses de las tomas
shots-poses = Poses
shots-at-least = Un escaneo necesita al menos { $num } tomas
shots-take-another = Recuperar antes otra toma
shots-putting-together = Uniendo las tomas
shots-adding = Añadiendo { $name }
