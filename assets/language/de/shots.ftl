# The shots of a scan
shots-shots = Aufnahmen
shots-add = Aufnahme hinzufügen…
shots-add-says = Ein Bild desselben Teils; seine Pose muss in der Posendatei oder in poses.json daneben stehen
shots-redo-label = Änderung der Aufnahmen wiederholen
shots-undo-label = Änderung der Aufnahmen rückgängig machen
shots-all-used = { $num } Aufnahmen
shots-some-used = { $used } von { $num } Aufnahmen verwendet
shots-agree = { $used } · Übereinstimmung { $rms } rms
shots-use = { $name } verwenden
shots-drop-says = Diese Aufnahme weglassen: Die übrigen werden ohne sie zusammengesetzt
shots-take-back-says = Diese Aufnahme wieder aufnehmen
shots-mark = Markieren, was nur Aufnahme { $shot } sieht
shots-dropped = Weggelassen
shots-left-out = Ausgelassen: { $why }
shots-left-out-says = { $why }. { $advice }
shots-shot-left-out = Aufnahme { $shot } ist ausgelassen: { $why }
shots-seen = { $share } % des Teils
shots-seen-says = Sieht { $num } Punkte des Teils
shots-alone = allein { $share }
shots-no-part-says = Die übrigen Aufnahmen bestimmen, was davon das Teil ist
shots-moved = verschoben { $shift } · { $turn }
shots-rms = rms { $rms }
shots-to-be-dropped = Wird weggelassen…

## The summary

shots-scan = Scan
shots-used = Aufnahmen verwendet
shots-num-used = { $used } von { $num }
shots-refined-by = Posen verfeinert um bis zu
shots-agree-to = Übereinstimmung, rms
shots-points = Punkte des Teils
shots-outline-open = Umriss offen
shots-not-seen = Von keiner Aufnahme gesehen · { $share } der eingelernten Fläche
shots-unseen = Nicht gesehen: Das Teil kann hier weitergehen · { $share } des Umrisses
shots-seen-by-one = Nur von Aufnahme { $shot } gesehen · { $share } des Teils

## Files

shots-add-a-frame = Bild zum Scan hinzufügen
shots-poses-file = Datei mit den Posen der Aufnahmen
shots-poses = Posen
shots-at-least = Ein Scan braucht mindestens { $num } Aufnahmen
shots-take-another = Zuerst eine andere Aufnahme wieder aufnehmen
shots-putting-together = Aufnahmen werden zusammengesetzt
shots-adding = { $name } wird hinzugefügt
