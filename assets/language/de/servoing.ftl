## How a run is described
servoing-standard-position = Standardlage
servoing-camera-pose = Aufgenommene Kamerapose
servoing-path-start = Anfang der Lackierbahn
servoing-looking = Sucht das Teil
servoing-moving = Fährt
servoing-waiting = Wartet auf Weiter
servoing-holding = Hält
servoing-checking = Prüft im Stillstand
servoing-arrived = Das Ziel ist erreicht
servoing-arrived-approximately = Das Ziel ist ungefähr erreicht: Das Teil kann ein anderes Modell sein
servoing-stopped = Angehalten
servoing-state-left = { $state }: noch { $left }
servoing-tolerance = Toleranz
servoing-shift-left = Verschiebung, die bleibt, mm
servoing-turn-left = Drehung, die bleibt, °

## The page
servoing-start = Start
servoing-stop = Stopp
servoing-stop-keys = Auch Leertaste und Esc halten an
servoing-key-stop = Roboter anhalten
servoing-key-next = Nächsten Schritt erlauben
servoing-running = Roboter wird geführt
servoing-begins = Lauf wird vorbereitet
servoing-stopping = Der Roboter bremst
servoing-waits-for-robot-advice = Das Programm auf der Steuerung des Roboters starten
servoing-nothing-yet = Noch kein Lauf
servoing-nothing-yet-advice = Rechts Teil und Roboter wählen, dann Start drücken
servoing-left = Der Roboter wurde angehalten, weil die Seite Servo verlassen wurde
servoing-left-advice = Auf der Seite bleiben, solange der Roboter fährt
servoing-view = 3D-Ansicht des Laufs
servoing-target = Ziel
servoing-nozzle = Düse
servoing-flange = Flansch
servoing-error = Fehler, der bleibt
servoing-bounds = Unsicherheit, 95 %
servoing-took = Dauer
servoing-looks = Bilder akzeptiert
servoing-looks-of = { $accepted } von { $count }
servoing-delay = Bild bis Ergebnis

## What is servoed
servoing-part-and-target = Teil und Ziel
servoing-remove-frame = Dieses Bild aus dem Ziel entfernen
servoing-add-frame = Bild hinzufügen…
servoing-frame-title = Bild des Teils von dort, wo die Kamera stehen soll
servoing-simulated = Simuliert
servoing-simulated-says = Ein Arm mit Kamera am Flansch in der simulierten Zelle. Seine Kalibrierung ist um bis zu 20 mm und 2° falsch
servoing-listen-at = Adresse und Port dieses Rechners
servoing-connect-to = Adresse des Roboters
servoing-no-safety = Das ist keine Sicherheitsfunktion. Auf Steuerungen nicht erprobt: zuerst langsam versuchen, mit der Hand am Halt
servoing-limits = Grenzen
servoing-speed = Höchste Geschwindigkeit
servoing-in-steps = In Schritten
servoing-in-steps-hint = Vor jedem Schritt von bis zu 50 mm und 5° wartet der Roboter auf Weiter
servoing-volume-says = Quader im Basissystem des Roboters, den Flansch, Kamera und Düse nie verlassen
servoing-clearance = Abstand
servoing-arm = Arm
servoing-no-nozzle = Keine
servoing-to-robot = In Lackieren ändern

## What is missing
servoing-no-part = Kein Teil ist eingelernt
servoing-no-part-advice = Unter „Einlernen“ ein Teil einlernen oder eine andere Bibliothek wählen
servoing-not-simulated-advice = Eines der mitgelieferten Teile oder einen wirklichen Roboter wählen
servoing-no-address = Die Adresse des Roboters fehlt oder ist falsch
servoing-listen-advice = Adresse und Port dieses Rechners eingeben, an denen die Pakete der Steuerung ankommen, etwa 192.168.1.10:6510
servoing-connect-advice = Die Adresse des Roboters eingeben, etwa 192.168.1.20
servoing-no-camera = Die Quelle ist keine Kamera: Ihre Bilder müssen zeigen, was jetzt dort hängt
servoing-no-camera-advice = In der Statusleiste eine Kamera als Quelle wählen, oder einen simulierten Roboter
servoing-no-frames = Das Ziel hat noch kein Bild
servoing-no-frames-advice = Bilder des Teils von dort hinzufügen, wo die Kamera stehen soll
servoing-no-arm = Roboter von KUKA bekommen Gelenkwinkel, daher muss der Arm bekannt sein
servoing-no-arm-advice = In Lackieren unter Roboter den Arm wählen und die Düse eintragen
servoing-not-calibrated = Wo die Kamera sitzt, ist nicht bekannt
servoing-not-calibrated-advice = Zuerst kalibrieren: Taste B, dann Kalibrierung

## Runs in the history
servoing-runs = Servoläufe
servoing-runs-hint = Läufe, in denen die Kamera einen Roboter geführt hat, statt der Prüfungen
servoing-runs-counted = { $count ->
        [one] { $matching } von { $count } Lauf
       *[other] { $matching } von { $count } Läufen
    }
servoing-no-runs-listed = Kein Lauf passt zum Filter
servoing-choose-run = Einen Lauf wählen, um seine Kurve zu sehen
servoing-row = Lauf { $number }: { $part }, { $end }
servoing-run-number = Lauf { $number }
servoing-source = Quelle
servoing-time = Zeit
servoing-wrote = { $count ->
    [one] { $count } Lauf nach { $path } geschrieben
   *[other] { $count } Läufe nach { $path } geschrieben
}
