# The Inspect workspace

## The verdict

inspect-unknown-part = Unbekanntes Teil
inspect-not-recognised = Nicht erkannt
inspect-no-verdict = Kein Ergebnis
inspect-live-stopped = Live wurde beendet, bevor ein Ergebnis galt
inspect-stopped-moving = beim Beenden von Live hat sich etwas bewegt
inspect-press-capture = „Aufnehmen“ drücken
inspect-something-moves = vor der Kamera bewegt sich etwas
inspect-looking = Suche läuft
inspect-not-long-enough = noch nicht lange genug gesehen
inspect-it-is-steady = das Teil hängt still
inspect-not-accepted-yet = Noch offen
inspect-nearest = Am nächsten: { $part }
inspect-recognised = Erkannt
inspect-hold-simulated = Simuliert: Keine Kamera wurde ausgelesen
inspect-hold-replayed = Aus einer Aufzeichnung abgespielt: Das Teil hängt nicht dort
inspect-hold-choose-camera = Eine Kamera als Quelle wählen
inspect-hold-choose-camera-operator = Den Einrichter eine Kamera wählen lassen
inspect-hold-not-calibrated = Nicht kalibriert: Der Roboter bekommt keine Pose
inspect-hold-not-calibrated-operator = Roboter nicht starten: Den Einrichter rufen, damit er die Zelle kalibriert
inspect-hold-clock-operator = Roboter nicht starten: Den Einrichter rufen, damit er die Uhren stellt
inspect-hold-old = Vor mehr als 10 Minuten aufgenommen: Es kann jetzt anders hängen
inspect-hold-old-file = Aus einer Datei, die älter als 10 Minuten ist: Es kann jetzt anders hängen
inspect-hold-open-newer = Eine neuere Aufnahme öffnen oder eine Kamera als Quelle wählen

## The card

inspect-previous-result = Vorheriges Ergebnis: Eine neue Prüfung läuft
inspect-outdated = Vorheriges Ergebnis: Von der Quelle kam seitdem nichts
inspect-from-history = Aus dem Verlauf, nicht das aktuelle Teil
inspect-other-empty-cell = Die leere Zelle stammt von einer anderen Kamera und wird nicht verwendet; nehmen Sie sie mit dieser neu auf
inspect-touches-edge = Das Teil reicht bis an den Bildrand: Etwas davon kann fehlen
inspect-approximate = Die Pose ist ungefähr: Dies kann ein anderes Modell des Teils sein
inspect-parts-accepted = { $num } von { $all } akzeptiert
inspect-export = Export…
inspect-export-says = Ein Bericht: JSON, eine PDF-Seite, eine Zeile in einer Posentabelle und die Bilder aller Stufen (Strg E)
inspect-wrong-part = Falsches Teil?
inspect-wrong-part-says = Im Vergleich ansehen, warum es als dieses Teil erkannt wurde
inspect-why = Warum?
inspect-why-says = Im Vergleich ansehen, warum es nicht akzeptiert ist
inspect-enrol-this = Dieses Teil einlernen
inspect-add-reference = Referenz hinzufügen
inspect-calibrate = Zelle kalibrieren
inspect-copy-pose = Kopieren
inspect-copy-pose-says = In der gewählten Konvention, in der ersten Zeile genannt (Strg Umschalt C)
inspect-score-itself = Score des Teils selbst, nicht des Spiegelbilds
inspect-as-part = Als { $part } (nicht akzeptiert)
inspect-next = Nächstes: { $part } { $score }
inspect-threshold = Schwelle { $score }
inspect-margin = Vorsprung vor dem nächsten Teil { $margin }
inspect-margin-says = Unterschied der beiden Wahrscheinlichkeiten, wenn nur eines der beiden Teile dort hängen kann; nicht der Unterschied der Scores
inspect-offset = Versatz zur Standardlage
inspect-measured-from = Gemessen von { $part }, einer anderen Referenz dieses Teils
inspect-offset-note = Teilemitte, Kameraachsen · R = Rz·Ry·Rx
inspect-fit = Passung
inspect-rms = rms
inspect-overlap = Überlappung
inspect-unconstrained = Nicht bestimmt: { $freedom }
inspect-pose-uncertainty = Pose-Unsicherheit (95 %)
inspect-runner-up = zweitbeste Pose
inspect-times-worse = { $ratio }× schlechter
inspect-as-good = gleich gut
inspect-iterations = { $num ->
        [one] { $num } Iteration
       *[other] { $num } Iterationen
    }
inspect-ambiguous = Eine andere Pose passt ebenso gut: prüfen, wie herum das Teil hängt
inspect-surface = Oberfläche
inspect-surface-is = Oberfläche: { $verdict }
inspect-surface-advice = Die umrandeten Stellen ansehen, bevor das Teil weitergeht
inspect-surface-region = abweichende Stelle
inspect-surface-frames = gemittelte Bilder
inspect-surface-seen = beurteilt von der Kameraseite
inspect-surface-noise = Rauschen des Mittels
inspect-surface-smallest = Delle, { $width } breit, gefunden ab
inspect-inspection = Prüfung
inspect-time = Zeit
inspect-scene = Szene
inspect-simulated = simuliert
inspect-serial = Serien-Nr.
inspect-order = Auftrag
inspect-operator = Bediener
inspect-recipe = Rezept

## Stand-off

inspect-stand-off = Düsenabstand einer angenommenen Bahn
inspect-stand-off-stored = Düsenabstand der gespeicherten Bahn
inspect-mean = Mittel
inspect-worst-of = { $value }, max. { $worst }
inspect-in-band = im Band
inspect-points-in-band = { $inside } von { $num } Punkten
inspect-points-not-seen = An { $count } von { $all } Punkten nicht geprüft, wo die Kamera das Teil nicht sieht
inspect-path-not-seen = Die Kamera sieht das Teil an keinem Punkt der Bahn
inspect-angle = Winkel
inspect-angle-counts = { $count ->
        [0] Im Band heißt auch: Winkel höchstens { $limit }
        [one] Im Band heißt auch: Winkel höchstens { $limit }; an 1 Punkt ist er größer
       *[other] Im Band heißt auch: Winkel höchstens { $limit }; an { $count } Punkten ist er größer
    }
inspect-path-fits = Die Bahn passt auch ohne die Pose
inspect-path-needs-pose = Das Roboterprogramm muss die Pose auf die Bahn anwenden
inspect-stand-off-of = Düsenabstand { $mean } von { $nearest } bis { $farthest }

## The pose for the robot

inspect-robot-frame = Basiskoordinatensystem des Roboters, laut { $name }
inspect-camera-frame = Kamerakoordinatensystem: Die Zelle ist nicht kalibriert
inspect-camera-frame-only = Kamerakoordinatensystem: Ein Roboter darf mit diesem Ergebnis nicht arbeiten
inspect-convention-of = Konvention: { $name }
inspect-convention-says = Konvention der Pose, wie sie gezeigt, kopiert und geschrieben wird; die der Antworten an Roboter steht unter „Roboter…“
inspect-no-pose-to-copy = Keine Pose zum Kopieren: Das Teil wurde nicht akzeptiert
inspect-no-pose-advice = Dem Hinweis auf der Karte folgen, dann erneut aufnehmen
inspect-pose-copied = { $name } in der Konvention { $convention } kopiert

## The view

inspect-colour = Farbe · { $colouring }
inspect-show = Anzeigen
inspect-export-path = Lackierbahn exportieren…
inspect-export-path-says = Erfordert ein akzeptiertes Teil mit gespeicherter Lackierbahn und eine kalibrierte Zelle
inspect-measure = Messen
inspect-measure-says = Zwei Punkte anklicken (M)
inspect-picture = Bild…
inspect-picture-says = Bild der Ansicht speichern (P)
inspect-fit-view = Einpassen
inspect-fit-view-says = Teil einpassen (F)
inspect-front = Vorn
inspect-top = Oben
inspect-side = Seite
inspect-part-axes = Achsen des Teils
inspect-part-camera = Tiefenkamera
inspect-part-outline = Eingelernte Kontur
inspect-part-nozzle-middle = Düse über der Mitte
inspect-part-nozzle-worst = Düse an der schlechtesten Stelle
inspect-part-spray-path = Lackierbahn
inspect-part-shot-cameras = Kameras der Aufnahmen
inspect-part-unseen = Von keiner Aufnahme gesehen
inspect-needs-pose = Erfordert ein erkanntes Teil, dessen Pose gefunden wurde
inspect-needs-camera = Erfordert eine einzelne Aufnahme, deren Kamera bekannt ist
inspect-needs-no-path = Erfordert ein akzeptiertes Teil ohne gespeicherte Lackierbahn
inspect-needs-path = Erfordert ein akzeptiertes Teil mit gespeicherter Lackierbahn
inspect-needs-calibration = Erfordert eine kalibrierte Zelle
inspect-needs-scan = Erfordert einen Scan
inspect-caption-planes = { $points } Punkte · Teil { $part } · { $planes ->
        [one] 1 Hintergrundebene entfernt
       *[other] { $planes } Hintergrundebenen entfernt
    }
inspect-caption-shots = { $points } Punkte · Teil { $part } · { $shots } Aufnahmen zusammen
inspect-no-camera-read = { $scene } · ohne Kamera
inspect-view-of-scene = 3D-Ansicht der Szene
inspect-other-surface = Andere Fläche
inspect-taught-nozzle = Angenommene Düse
inspect-worst = Schlechteste
inspect-path-in-band = Lackierbahn · { $inside } von { $num } im Band

## The stages

inspect-contour = Kontur
inspect-signatures = Signaturen
inspect-ranking = Rangliste
inspect-alignment = Ausrichtung
inspect-enlarge-segmentation = Segmentierung vergrößern
inspect-enlarge-binary-image = Binärbild vergrößern
inspect-enlarge-contour = Kontur vergrößern
inspect-enlarge-signatures = Signaturen vergrößern
inspect-enlarge-ranking = Rangliste vergrößern
inspect-enlarge-alignment = Ausrichtung vergrößern
inspect-enlarged = { $stage }, vergrößert
inspect-enlarged-without = { $stage }, vergrößert: { $why }
inspect-says-segmentation = Hintergrundebenen in matten Farben, das Teil hell
inspect-says-binary-image = das Teil in der Ebene seiner zwei längsten Achsen
inspect-says-contour = Umriss, Öffnungen, Strahlen vom Schwerpunkt; gestrichelt: das eingelernte Teil
inspect-says-signatures = Länge L und Winkel Θ der Strahlen; gestrichelt: das eingelernte Teil
inspect-says-ranking = Score jedes eingelernten Teils gegenüber der Schwelle
inspect-says-alignment = mittlerer quadratischer Abstand E je Iteration, logarithmisch
inspect-stages = Stufen
inspect-not-reached = nicht erreicht
inspect-no-picture = kein Bild: Die Punktwolke hat keine Zeilen und Spalten
inspect-not-examined = nicht untersucht
inspect-e-stayed-zero = E blieb bei 0
inspect-ended-at = { $part } endete bei rms { $rms }
inspect-papers-threshold = Schwelle des Artikels, 1e−6 m²
inspect-not-asked-for = nicht ausgerichtet: keine Pose verlangt
inspect-flat-shape = nicht ausgerichtet: als flache Form eingelernt
inspect-no-pose-found = nicht ausgerichtet: keine Pose gefunden
inspect-score-too-low = nicht ausgerichtet: Score zu niedrig für einen Versuch
inspect-capture-cell = „Aufnehmen“ drücken für ein Bild der simulierten Zelle, oder eine aufgenommene Szene hierher ziehen
inspect-capture-or-drop = „Aufnehmen“ drücken oder eine aufgenommene Szene hierher ziehen

## Shortcuts and files

inspect-does-redo = Letzte rückgängig gemachte Änderung der Aufnahmen wiederholen
inspect-does-undo = Letzte Änderung der Aufnahmen eines Scans rückgängig machen
inspect-does-picture = Bild der 3D-Ansicht speichern
inspect-does-contour = Eingelernte Kontur ein- oder ausblenden
inspect-does-nozzle = Düse an der schlechtesten Stelle ein- oder ausblenden
inspect-does-copy = Pose in der gewählten Konvention kopieren
inspect-does-previous-part = Vorheriges Teil des Bildes wählen
inspect-does-next-part = Nächstes Teil des Bildes wählen
inspect-report-folder = Ordner für den Bericht dieser Prüfung
inspect-save-picture = Bild der Ansicht speichern
inspect-pictures = Bilder
inspect-export-path-title = Lackierbahn für den Roboter exportieren
inspect-saving-picture = Bild wird gespeichert
inspect-writing-report = Bericht wird geschrieben
inspect-writing-path = Lackierbahn wird geschrieben
inspect-picture-saved = Bild gespeichert: { $path }
inspect-no-spray-path = Für das Angezeigte gibt es keine Lackierbahn
inspect-no-spray-path-advice = Eine beim Teil speichern und ein Teil aufnehmen, das akzeptiert wird
inspect-path-written = { $path } geschrieben: { $inside } von { $num } geprüften Punkten im Band, als { $convention }
inspect-path-not-written = Keine Lackierbahn geschrieben: { $why }
inspect-report-written = { $files }, die Bilder der Stufen und eine Zeile von { $table } in { $folder } geschrieben
inspect-report-set-aside = { $files }, die Bilder der Stufen und eine Zeile von { $table } in { $folder } geschrieben; die letzte Zeile war unvollständig und liegt jetzt in { $aside }
inspect-watching-folder = Ordner wird überwacht

## The values under the pointer

inspect-at-reading = Spalte { $column }, Zeile { $row }: { $depth } von der Kamera
inspect-at-no-reading = Spalte { $column }, Zeile { $row }: kein Messwert
inspect-at-surface = x { $x }, y { $y }, Höhe { $height }
inspect-at-plane = x { $x }, y { $y }
inspect-at-ray = x { $x }, y { $y } · vom Schwerpunkt L { $length }, Θ { $angle }
inspect-at-iteration = Iteration { $iteration }: E { $e } m²
