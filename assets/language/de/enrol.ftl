## Before there is a draft
enrol-show-part = Einzulernendes Teil zeigen
enrol-capture-replacement = Ersatz für { $part } aufnehmen
enrol-how = Vor die Kamera hängen und „Aufnehmen“ drücken, eine Aufnahme, eine Punktwolke oder ein Netz öffnen oder die Datei hier ablegen
enrol-take-shown = { $scene } aus „Prüfen“ übernehmen
enrol-use-shown = Geprüfte Szene verwenden
enrol-see-inspected = Gespeichert: in „Prüfen“ ansehen
enrol-open-scan-hint = Mehrere Aufnahmen von mehreren Seiten, jede mit ihrer Kamerapose (Strg Umschalt O)
enrol-step-capture = 1  Teil aufnehmen oder Datei öffnen
enrol-step-correct = 2  Kontrollieren, was behalten wird, und korrigieren
enrol-step-title = 3  Titel eingeben
enrol-step-save = 4  Speichern: Künftige Prüfungen erkennen das Teil

## The card of the draft
enrol-new-part = Neues Teil
enrol-replaces = Ersetzt { $part }
enrol-previous-draft = Voriger Entwurf: ein neuer wird vorbereitet
enrol-as-new = Stattdessen als neues Teil einlernen
enrol-unready-problem = Speichern noch nicht möglich: siehe oben
enrol-unready-title = Zuerst einen Titel eingeben
enrol-unready-name = Zuerst den Namen korrigieren
enrol-unready-library = Diese Bibliothek kann nicht geändert werden: siehe oben
enrol-unready-unknown = Noch nicht bekannt, was gespeichert wird
enrol-points-kept = { $points } Punkte
enrol-outline = Umriss { $length }
enrol-openings = Öffnungen { $count }
enrol-seen-one-side = Einseitig gesehen
enrol-seen-all-around = Allseitig gesehen
enrol-seen-several-sides = Mehrseitig gesehen
enrol-painted-from-front = Lackiert von vorn
enrol-painted-from-back = Lackiert von hinten
enrol-painted-from-left = Lackiert von links
enrol-painted-from-right = Lackiert von rechts
enrol-painted-from-top = Lackiert von oben
enrol-painted-from-bottom = Lackiert von unten
enrol-examining = Teil wird untersucht…
enrol-stored-unknown = Nicht bekannt, was gespeichert wird
enrol-look-again = Erneut untersuchen
enrol-title = Titel
enrol-title-hint = Gebräuchliche Bezeichnung
enrol-title-full = Ein Titel hat höchstens { $limit } Zeichen; der Rest gehört in die Notizen
enrol-name-hint = aus dem Titel vorgeschlagen
enrol-notes = Notizen
enrol-reference-of = Weitere Referenz von
enrol-reference-of-chosen = Weitere Referenz von: { $part }
enrol-reference-of-none = Kein anderes Teil
enrol-reference-choice = Referenz von: { $part }
enrol-reference-of-hint = Eine weitere Ansicht oder Variante eines eingelernten Teils: Als Ergebnis wird jenes Teil genannt
enrol-namesake = { $part } hat diesen Namen bereits
enrol-namesake-advice = Speichern ersetzt das Teil; die vorige Version lässt sich wiederherstellen
enrol-most-similar = Am ähnlichsten: { $part } (zu { $percent } % gleich)
enrol-most-similar-mirrored = Am ähnlichsten: { $part } (gespiegelt zu { $percent } % gleich)
enrol-distinguishable = Die beiden sind unterscheidbar
enrol-indistinguishable = Die beiden sind nicht unterscheidbar
enrol-indistinguishable-advice = Prüfungen beider Teile enden fast gleichauf: eine weitere Referenz jenes Teils speichern, es ersetzen oder eine Seite aufnehmen, auf der sie sich unterscheiden
enrol-replace = { $part } ersetzen
enrol-add-reference = Weitere Referenz von { $part }
enrol-discard = Verwerfen
enrol-saving = Wird gespeichert…
enrol-save-and-replace = Speichern und ersetzen

## The meshes of a file
enrol-meshes = Netze in { $file }
enrol-meshes-hint = Teile zum Einlernen wählen: Sie werden nacheinander zu Entwürfen
enrol-meshes-find = Netz suchen
enrol-meshes-find-hint = Wörter im Namen
enrol-meshes-order = Sortieren nach { $order }
enrol-meshes-size = Größe
enrol-meshes-unit = Längen in { $unit }
enrol-meshes-counted = { $shown } von { $count } Netzen
enrol-meshes-none = Kein Netz hat diese Wörter im Namen
enrol-meshes-figures = { $size } · Dreiecke: { $triangles }
enrol-meshes-enrol =
    { $count ->
        [0] Netze einlernen
        [one] { $count } Netz einlernen
       *[other] { $count } Netze einlernen
    }
enrol-meshes-whole = Alles als ein Teil
enrol-meshes-whole-hint = Die ganze Datei zeigt ein Teil
enrol-mesh-number = Netz { $number } von { $count }
enrol-mesh-skip = Auslassen
enrol-mesh-leave-out = Übrige auslassen

## The card of an enrolled part
enrol-rename = Umbenennen
enrol-spray-path = Lackierbahn…
enrol-remove-path = Lackierbahn entfernen
enrol-anew = Neu einlernen
enrol-origin = Eingelernt { $time } aus { $source } ({ $method })
enrol-origin-points = { $points } Punkte
enrol-origin-simulated = simuliert, nicht von einer Kamera
enrol-origin-seen = von einer Kamera aufgenommen
enrol-origin-path = Lackierbahn mit { $count } Punkten
enrol-origin-number = Nummer für Roboter: { $number }

## The strip of enrolled parts
enrol-enrolled-parts = Eingelernte Teile
enrol-library-loading = Die Bibliothek wird geladen…
enrol-num-parts =
    { $count ->
        [0] Noch kein Teil eingelernt: das erste gespeicherte erscheint hier
        [one] { $count } eingelerntes Teil
       *[other] { $count } eingelernte Teile
    }
enrol-damaged = Beschädigt
enrol-tile-reference = Ref. von { $part }
enrol-enrolled = Eingelernt: { $part }
enrol-renamed-at = Umbenannt, { $time }
enrol-brought-back-at = Wieder da, { $time }
enrol-saved-at = Gespeichert, { $time }
enrol-path-changed-at = Neue Bahn, { $time }

## What corrects the draft
enrol-in-front = Vor dem Hintergrund
enrol-everything = Alles
enrol-box = Box
enrol-box-hint = Box in der 3D-Ansicht oder im Bild aufziehen (D)
enrol-lasso-hint = Lasso in der 3D-Ansicht oder im Bild ziehen (D, D)
enrol-keep = Behalten
enrol-drop = Entfernen
enrol-add = Ergänzen
enrol-keep-hint = Was außerhalb liegt, wird entfernt
enrol-drop-hint = Was innerhalb liegt, wird entfernt
enrol-add-hint = Alles innerhalb wird übernommen, auch der Hintergrund
enrol-drag-box = Box aufziehen
enrol-drag-lasso = Lasso ziehen
enrol-picture-hint = { $drag }, hier im Bild. { $does }. Ein Klick nimmt ein Segment hinzu oder entfernt es
enrol-view-hint = { $drag }. { $does }. Das gilt durch das ganze Teil hindurch. Esc: wieder drehen
enrol-picture = Bild der behaltenen Punkte
enrol-mesh-is-whole = Ein Netz wird ganz eingelernt: im Programm zuschneiden, das es erstellt hat
enrol-undo-step = Letzten Schritt rückgängig machen
enrol-redo-step = Letzten Schritt wiederholen
enrol-reset-all = Alle Korrekturen zurücksetzen
enrol-both = Beide
enrol-picture-pane = Bild
enrol-view-pane = 3D
enrol-show-both = Beide zeigen
enrol-show-picture = Bild zeigen
enrol-show-view = 3D zeigen
enrol-segment-partly = { $segment } · { $kept } von { $all } behalten
enrol-kept = behalten
enrol-partly-kept = teilweise behalten
enrol-dropped = entfernt
enrol-take-it = Übernehmen
enrol-drop-it = Entfernen
enrol-segment-stand = Gestell
enrol-segment-surface = Fläche { $number }
enrol-segment-background = Hintergrund { $number }
enrol-segment-piece = Stück { $number }
enrol-segment-specks = Einzelne Punkte
enrol-segment-mesh = Netz
enrol-segment-cell = Umgebende Zelle
enrol-view = 3D-Ansicht des Entwurfs

## Keys
enrol-key-redo = Letzte rückgängig gemachte Änderung wiederholen
enrol-key-undo = Letzte Korrektur rückgängig machen; ohne Entwurf die letzte Änderung der Bibliothek
enrol-key-save = Teil speichern
enrol-key-draw = Box aufziehen; noch einmal: Lasso
enrol-key-rotate = 3D-Ansicht wieder durch Ziehen drehen

## Work and notices
enrol-path-file-title = Bahn der Düse über diesem Teil
enrol-path-files = Tabellen
enrol-examining-part = Teil wird untersucht
enrol-taking-scan = Angezeigter Scan wird übernommen
enrol-taking-scene = Angezeigte Szene wird übernommen
enrol-live-stopped = Live ist beendet: die nächste Datei wird eingelernt
enrol-live-stopped-advice = Danach L drücken, um Live wieder einzuschalten
enrol-changing-library = Bibliothek wird geändert
enrol-unsaved = Das Teil in „Einlernen“ ist nicht gespeichert
enrol-unsaved-titled = { $part }, das Teil in „Einlernen“, ist nicht gespeichert
enrol-bringing-back = Entwurf wird zurückgeholt
enrol-writing-draft = Entwurf wird aufbewahrt
enrol-draft-back = Der nicht gespeicherte Entwurf ist wieder da
enrol-draft-differs = Der Entwurf behält jetzt andere Punkte: Seine Szene oder das Rezept hat sich geändert
enrol-draft-differs-advice = Vor dem Speichern prüfen, was behalten wird
enrol-draft-no-scene = Die Szene des nicht gespeicherten Entwurfs ist nicht mehr zu haben
enrol-draft-no-scene-advice = Das Teil noch einmal aufnehmen: eingegebener Titel, Name und Notizen sind erhalten
enrol-draft-not-used = Der Entwurf wird nicht verwendet: { $why }
enrol-draft-set-aside = Er wurde nach { $path } verschoben
enrol-draft-not-kept = Der Entwurf wird nicht aufbewahrt: { $why }
enrol-draft-too-large-advice = Das Teil speichern oder einige Korrekturen rückgängig machen
enrol-nothing-to-save = Es gibt noch nichts zu speichern
enrol-nothing-to-save-advice = Mit dem Speichern warten, bis das Vorschaubild erscheint
enrol-outline-nothing = Der Umriss hat nichts geändert
enrol-outline-nothing-advice = Ihn um Punkte ziehen, die sich behalten oder entfernen lassen, oder rückgängig machen
enrol-other-program = Ein anderes Programm hat ein Teil namens { $name } gespeichert, seit diese Bibliothek geöffnet wurde
enrol-other-program-advice = Erneut speichern, um es zu ersetzen, oder diesem einen anderen Namen geben
enrol-changed-since = { $part } bleibt, wie es ist: ein anderes Fenster oder Programm hat es seitdem geändert
enrol-changed-since-advice = Unter den eingelernten Teilen öffnen, um es umzubenennen oder zu entfernen
enrol-saved = { $part } gespeichert
enrol-saved-over = { $part } gespeichert; die vorige Version liegt im Papierkorb der Bibliothek
enrol-saved-over-path = { $part } gespeichert; die vorige Version liegt mit ihrer Lackierbahn im Papierkorb der Bibliothek: eine Bahn für das neue Koordinatensystem speichern
enrol-title-changed = Titel von { $part } geändert
enrol-removed = { $part } entfernt
enrol-brought-back = { $part } wiederhergestellt
enrol-stored-path = Lackierbahn mit { $count } Punkten zu { $part } gespeichert
enrol-removed-path = Lackierbahn von { $part } entfernt
enrol-undone = Rückgängig gemacht: „{ $what }“
