## Part and coat
paint-no-part = Die Bibliothek enthält kein Teil zum Lackieren
paint-no-such-part = { $part } ist nicht mehr in der Bibliothek
paint-part = Zu lackierendes Teil: { $part }
paint-part-hint = Das eingelernte Teil, das lackiert wird
paint-recognised-gone = Das zuletzt erkannte Teil ist nicht mehr eingelernt: das zu lackierende Teil wählen
paint-film-within = Schicht: { $share } % der Fläche innerhalb { $target } ± { $tolerance } µm
paint-film-within-hint = Anteil der lackierbaren Fläche, deren Schicht in der Toleranz liegt; gut ab { $least } %
paint-side-none = Zu lackierende Seite wählen
paint-side-hint = Die Seite, die die Pistole lackiert, von einer Kamera vor dem Teil aus gesehen; wird mit dem Teil gespeichert
paint-side-unclear-advice = Oben wählen, von welcher Seite es lackiert wird
paint-scope-one-side = Auf der Seite, die die Kamera beim Einlernen sah
paint-scope-all-around = Auf dieser Seite; das Teil ist rundum bekannt
paint-scope-several-sides = Auf dem, was einer Seite zugewandt ist; es wurde von mehreren eingelernt
paint-coat = Beschichtung
paint-coat-changed = { $coat }, geändert
paint-coat-named = Beschichtung: { $coat }
paint-coat-name = Name der Beschichtung
paint-saved-coat = Beschichtung { $coat } gespeichert
paint-no-coat-folder = Es gibt keinen Ordner für Beschichtungen
paint-no-coat-folder-advice = Das Fenster als Benutzer mit einem Home-Ordner starten

## What the film comes to
paint-thinnest-thickest = Dünnste · dickste Stelle
paint-mean = Mittel
paint-missed = Nicht getroffen
paint-double = Doppelt
paint-paintable = Lackierbare Fläche
paint-landed = Festkörper auf dem Teil
paint-time = Dauer
paint-points = Punkte der Bahn
paint-histogram = Flächenanteil nach Schichtdicke
paint-histogram-hint = Flächenanteil nach Schichtdicke in Prozent des Sollwerts; grün liegt in der Toleranz

## Tools
paint-regions = Bereiche
paint-keep-out = Aussparen
paint-box = Box
paint-keep-out-box = Aussparen: Box
paint-keep-out-lasso = Aussparen: Lasso
paint-brush = Pinsel
paint-keep-out-brush = Aussparen: Pinsel
paint-keep-out-hint = Um das ziehen, was keinen Lack bekommt. Esc: wieder drehen
paint-brush-hint = Über das ziehen, was keinen Lack bekommt. Esc: wieder drehen
paint-only = Nur lackieren
paint-in-box = In einer Box
paint-only-box = Nur lackieren: in einer Box
paint-in-lasso = In einem Lasso
paint-only-lasso = Nur lackieren: in einem Lasso
paint-only-hint = Um das ziehen, was allein lackiert wird; mehrere Bereiche zählen zusammen. Esc: wieder drehen
paint-clear = Leeren
paint-clear-hint = Alle Bereiche und von Hand Verschobenes verwerfen
paint-by-hand = Von Hand korrigieren
paint-move-stroke = Bahn verschieben
paint-move-stroke-hint = Eine Bahn dorthin ziehen, wo sie verlaufen soll. Esc: wieder drehen
paint-move-point = Punkt verschieben
paint-move-point-hint = Einen Punkt einer Bahn ziehen; seine Nachbarn folgen. Esc: wieder drehen
paint-turn-gun = Pistole neigen
paint-turn-gun-hint = Von einem Punkt einer Bahn ziehen, um die Pistole dorthin zu neigen. Esc: wieder drehen
paint-edits-dropped = Von Hand Verschobenes gehörte zur vorigen Bahn und wurde verworfen
paint-edits-dropped-advice = Rückgängig holt es zurück; die Bahn zuletzt von Hand korrigieren
paint-drawn-dropped = In Lackieren auf { $part } Gezeichnetes wurde verworfen
paint-drawn-dropped-undo = Rückgängig holt es zurück
paint-drawn-dropped-again = Das Teil wurde entfernt oder neu eingelernt; neu zeichnen, was noch gebraucht wird
paint-film-colours = Schichtfarben
paint-film-colours-hint = Teil nach der Schichtdicke einfärben

## View and timeline
paint-view = 3D-Ansicht des Teils und seiner Lackierbahn
paint-gun-off = Pistole aus
paint-key-play = Pistole die Bahn entlangfahren lassen oder anhalten
paint-key-back = Zur vorigen Bahn
paint-key-on = Zur nächsten Bahn
paint-place-on = { $time } von { $end } · Bahn { $stroke } von { $all } · Pistole an
paint-place-off = { $time } von { $end } · Bahn { $stroke } von { $all } · Pistole aus
paint-path-takes = { $length } m Bahn · { $paint } ml Lack
paint-timeline = Stelle der Pistole auf der Bahn, Sekunden
paint-timeline-keys = Pfeiltasten bewegen die Pistole, Leertaste spielt ab
paint-blocks-are-strokes = Blöcke: Pistole an
paint-drag-to-move = Ziehen bewegt die Pistole

## The path
paint-planning = Bahn wird geplant
paint-not-planned = Nicht geplant: Teil noch einmal wählen
paint-previous-path = Werte der vorherigen Bahn
paint-proposing = Bahnabstand und Geschwindigkeit werden gesucht
paint-storing-side = Seite wird gespeichert
paint-storing = Bahn wird gespeichert
paint-propose = Vorschlagen
paint-propose-hint = Bahnabstand und Geschwindigkeit suchen, mit denen die Schicht ihren Sollwert erreicht
paint-export-hint = Bahn als Tabelle schreiben
paint-export-title = Lackierbahn exportieren
paint-store = Beim Teil speichern
paint-store-hint = Bahn beim Teil speichern; Prüfungen und Roboterprogramme verwenden sie von da an
paint-is-stored = Diese Bahn ist beim Teil gespeichert
paint-planned-path = Geplant
paint-stored-path = Gespeichert, { $count } Punkte
paint-unsaved = Die in Lackieren gezeichneten Bereiche sind nicht als Bahn gespeichert

## The robot
paint-robot = Roboter
paint-arm-group = Arm und Düse
paint-cell-group = Zelle und Steuerung
paint-reach-group = Reichweite
paint-arm = Arm: { $arm }
paint-arm-hint = Der Arm, dessen Reichweite geprüft wird; ohne Arm wird sie nicht geprüft
paint-no-arm = Kein Arm
paint-from-file = Aus einer Datei…
paint-arm-title = Einen Arm öffnen
paint-nozzle = Düse am Flansch
paint-nozzle-hint = Wo die Düsenöffnung am Flansch sitzt, z in Strahlrichtung: eine Konvention und sechs Zahlen oder die 16 Zahlen einer Matrix
paint-example = z. B. { $example }
paint-no-nozzle-advice = Unter „Düse am Flansch“ eintragen oder keinen Arm wählen
paint-base = Fuß des Arms
paint-base-hint = Lage des Fußes im Koordinatensystem der Kalibrierung, wie KUKA sie schreibt: um A um die senkrechte z-Achse gedreht, dann um B um die neue y-Achse und um C um die neue x-Achse. Alles 0: beide Koordinatensysteme sind dasselbe
paint-base-number = Fuß des Arms: { $name }
paint-rail = Schiene
paint-rail-hint = Die Schiene, auf der der Arm steht: Achse der Kalibrierung, Anfang und Ende in mm und, wenn sie entlang der Bahn fährt, Höchstgeschwindigkeit in mm/s und, falls bekannt, Beschleunigung in mm/s². Leer: die aus der Datei des Arms
paint-no-obstacles = Nur das Teil
paint-obstacles = Hindernisse: { $file }
paint-obstacles-hint = Woran Pistole und Arm außer dem Teil nicht stoßen dürfen: Quader der Zelle und ihr Boden, aus einer TOML-Datei
paint-obstacles-title = Quader der Zelle öffnen
paint-more-robot = Werkzeug, Pistole und Geschwindigkeit
paint-tool = Werkzeug auf der Steuerung
paint-tool-hint = Eine Nummer bei KUKA, FANUC und Yaskawa, ein Name bei ABB und Doosan
paint-tilted = { $num ->
        [one] Pistole an { $num } Punkt um bis zu { $degrees }° geneigt, wo der Arm der Bahn sonst nicht folgt.
       *[other] Pistole an { $num } Punkten um bis zu { $degrees }° geneigt, wo der Arm der Bahn sonst nicht folgt.
    }
paint-changed-moves = Bewegungen ohne Farbe: { $slower } langsamer als geplant, { $joints } als Achsbewegung.
paint-slower-spraying = { $num ->
        [one] Pistole beim Sprühen auf { $num } Bewegung verlangsamt, damit der Arm folgen kann; die Schicht bleibt in ihrer Toleranz.
       *[other] Pistole beim Sprühen auf { $num } Bewegungen verlangsamt, damit der Arm folgen kann; die Schicht bleibt in ihrer Toleranz.
    }
paint-not-calibrated = Zuerst die Zelle kalibrieren, oben unter Roboter…
paint-checking-reach = Reichweite des Arms wird geprüft
paint-arm-not-checked = Arm: nicht geprüft
paint-arm-reaches-all = Arm: 100 % der Bahn erreicht, alle { $all } Punkte
paint-arm-reaches-some = Arm: { $share } % der Bahn erreicht, alle bis auf { $missed } von { $all } Punkten
paint-arm-reaches-hint = Anteil der Bahnpunkte, die der Arm ohne Kollision erreicht; gut nur, wenn er alle erreicht
paint-acceleration-advice = Mit kleinerer Ausflussrate planen, langsamer fahren, wo zu langsam beschleunigt wird, oder Ecken mit größerem Radius fahren
paint-joints-advice = Einen anderen Winkel der Düse versuchen, mehr Neigung der Pistole, einen anderen Ort des Sockels oder weniger Geschwindigkeit
paint-collisions = Kollisionen
paint-collisions-not-checked = nicht geprüft
paint-no-collisions-reached = keine, wo er hinreicht
paint-no-collisions-part = keine mit Teil und Arm
paint-num-collisions =
    { $count ->
        [0] keine
        [one] { $count } Punkt
       *[other] { $count } Punkte
    }
paint-show-unreached = Nächsten zeigen
paint-rail-moves = Entlang der Bahn ist seine Schiene zwischen { $from } und { $to } mm
paint-rail-at = Bei { $at } mm seiner Schiene würde er { $count } erreichen
paint-base-moved = Mit dem Fuß um { $by } mm versetzt würde er { $count } erreichen
paint-apply-rail = Den Fuß entlang der Schiene dorthin versetzen
paint-apply-base = Den Fuß dorthin versetzen
paint-export-program = Programm…
paint-export-program-hint = Die Bahn als Programm für die Robotersteuerung schreiben, für das Teil, wie es beim Anlernen hing
paint-program-title = Roboterprogramm exportieren
