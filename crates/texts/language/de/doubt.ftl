# Warum ein Roboter auf ein Ergebnis hin nicht handeln darf

doubt-past = Nicht für Roboter: { $why }

doubt-reported-wrong = das Teil wurde als falsch gemeldet
    .advice = Prüfen, welches Teil dort hängt, und es neu aufnehmen
    .past = das Teil wurde als falsch gemeldet
doubt-source-lost = die Quelle ist ausgefallen, was jetzt dort hängt, ist also nicht bekannt
    .advice = Die Quelle wieder verbinden und das Teil neu aufnehmen
    .past = die Quelle war verloren
doubt-moving = das Teil bewegt sich
    .advice = Warten, bis das Teil still hängt
    .past = das Teil bewegte sich
doubt-superseded = inzwischen kann dort ein anderes Teil hängen
    .advice = Das Teil neu aufnehmen
    .past = dort hing vielleicht schon ein anderes Teil
doubt-other-order = sein Auftrag erwartet andere Teile als die, für die es geprüft wurde
    .advice = Das Teil neu aufnehmen
    .past = sein Auftrag erwartete andere Teile
doubt-not-accepted = das Teil wurde nicht akzeptiert
    .advice = Das Teil neu aufnehmen
    .past = das Teil wurde nicht akzeptiert
doubt-no-pose = das Teil hat keine Pose
    .advice = Ein Rezept wählen, das die Pose schätzt, und das Teil neu prüfen
    .past = das Teil hatte keine Pose
doubt-not-calibrated = die Zelle ist nicht kalibriert
    .advice = Die Lage der Kamera in der Roboterzelle kalibrieren, oben unter Roboter…
    .past = die Zelle war nicht kalibriert
doubt-clock-ahead = die Aufnahme ist um { FIXED($seconds, 0) } s später als jetzt datiert, ihr Alter ist also nicht bekannt
    .advice = Die Uhren dieses Rechners und des Rechners, der die Aufnahme geschrieben hat, nach demselben Zeitserver stellen und das Teil neu aufnehmen
    .past = die Aufnahme war später datiert als die Uhr dieses Rechners
doubt-old = die Aufnahme ist älter als 10 Minuten oder von unbekanntem Alter
    .advice = Das Teil neu aufnehmen
    .past = die Aufnahme war älter als 10 Minuten oder von unbekanntem Alter
doubt-ambiguous-pose = eine andere Pose des Teils passt fast ebenso gut
    .advice = Die Vorderseite des Teils zur Kamera drehen, das ganze Teil im Bild; sieht es gedreht gleich aus, es mit einem unterscheidenden Merkmal im Bild einlernen und prüfen, etwa einem Halter oder einem Ausschnitt
    .past = eine andere Pose des Teils passte fast ebenso gut
doubt-surface = die Oberfläche des Teils ist nicht in Ordnung
    .advice = Die Stellen ansehen, die die Prüfung umrandet, und das Teil nacharbeiten oder abhängen
    .past = die Oberfläche des Teils war nicht in Ordnung
doubt-off-scale =
    .past = das Teil war größer oder kleiner als seine Referenz
doubt-frames-disagree = die Aufnahmen passen vielleicht nicht zusammen: { PERCENT($disagreeing, 1) } % dessen, was { $frame } und die anderen gemeinsam sehen, widerspricht sich; üblich sind höchstens { PERCENT($most, 0) } %
    .advice = Prüfen, ob jede Pose zu ihrer Aufnahme gehört und ob sich zwischen den Aufnahmen nichts bewegt hat
    .past = die Aufnahmen des Scans widersprachen sich
doubt-poses-apart = die Posen widersprechen einander: { $one } und { $other } passen nur zusammen, wenn eine davon um { MM($apart_m, 1) } mm verschoben wird
    .advice = Prüfen, ob jede Pose zu ihrer Aufnahme gehört, ob der Arm stillstand und ob seine Kalibrierung noch gilt; der Ort des Teils im Basiskoordinatensystem des Roboters ist nur so sicher, wie die Posen übereinstimmen
    .past = die Posen des Scans widersprachen sich
doubt-off-the-part = die Lackierbahn zielt nicht auf das Teil ({ $num_too_near ->
        [0] nur bei { $num_aiming } von { $num_spraying } Punkten mit eingeschalteter Pistole
       *[other] bei { $num_too_near } von { $num_spraying } Punkten mit eingeschalteter Pistole ist die Düse weniger als { MM($least_m, 0) } mm davor oder hinter seiner Oberfläche
    })
    .advice = Prüfen, ob die Bahn zu diesem Teil gehört, oder in Lackieren eine neue planen und speichern
doubt-not-reached = { $arm } erreicht { $num_missed } von { $num_points } Punkten nicht{ $num_collisions ->
        [0] {""}
       *[other] , davon { $num_collisions }, weil er anstoßen würde
    }
    .advice = Das Teil oder den Fuß des Arms versetzen oder die Bahn ändern
doubt-film-off-plan = das Programm brächte { PERCENT($written, 1) } % der Fläche in { PERCENT($tolerance, 0) } % um den Sollwert, im Mittel { UM($written_m, 1) } µm; geplant sind { PERCENT($planned, 1) } % und { UM($planned_m, 1) } µm. Mit offener Pistole hielte es { $num_stops }-mal an
    .advice = Die Bahn ohne Züge entlang von Flanken planen (Neigung zu Flanken 0) oder das Programm für eine Steuerung schreiben, die die Pistole während der Bewegung schaltet
