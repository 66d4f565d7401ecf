# Warum ein Roboter, den die Kamera führt, gehalten oder angehalten wird

servo-not-accepted = der Roboter wurde angehalten, weil kein Teil akzeptiert wird: { $why }
servo-another-part = der Roboter wurde angehalten, weil dort { $other } statt { $part } hängt
    .advice = Das richtige Teil aufhängen oder das hängende wählen und neu starten
servo-ambiguous = der Roboter wurde angehalten, weil die Pose von { $part } nicht sicher ist: Eine andere passt fast ebenso gut, oder die Größe stimmt nicht
    .advice = Die Vorderseite des Teils zur Kamera drehen, das ganze Teil im Bild, und neu starten
servo-no-bounds = der Roboter wurde angehalten, weil die Prüfung keine Unsicherheit der Pose von { $part } angibt
    .advice = Ein Rezept wählen, das die Pose global schätzt, und neu starten
servo-moved = der Roboter wurde angehalten, weil sich das Teil von einem Bild zum nächsten um { MM($shift_m, 0) } mm und { DEGREES($turn_rad, 1) }° bewegt zu haben scheint
    .advice = Das Teil ruhig hängen lassen und neu starten; hing es ruhig, die Kalibrierung prüfen und ob Kamera und Roboter dieselbe Zeit haben
servo-lost = der Roboter wurde angehalten, weil seit { FIXED($age_s, 1) } s kein Bild akzeptiert wurde
    .advice = Kamera und Kabel prüfen und ob das ganze Teil im Bild bleibt, dann neu starten
servo-stale = der Roboter wurde angehalten, weil ein Bild erst { FIXED($age_s, 1) } s nach der Aufnahme ankam
    .advice = Schließen, was diesen Rechner sonst beschäftigt, oder das zulässige Alter eines Bildes erhöhen, dann neu starten
servo-frame-times = der Roboter wurde angehalten, weil die Zeiten der Bilder um { FIXED($off_s, 2) } s falsch sind: später als jetzt oder nicht der Reihe nach
    .advice = Die Uhren von Kamera, Roboter und diesem Rechner nach demselben Zeitserver stellen, dann neu starten
servo-arm-times = der Roboter wurde angehalten, weil zwei Meldungen seiner Pose { FIXED($gap_s, 3) } s auseinanderliegen
    .advice = Die Verbindung zur Robotersteuerung prüfen, dann neu starten
servo-arm-astray = der Roboter wurde angehalten, weil er { MM($shift_m, 0) } mm und { DEGREES($turn_rad, 1) }° neben dem vorgegebenen Weg steht
    .advice = Am Handbediengerät nach einer Meldung sehen und prüfen, ob Basis und Werkzeug die der Kalibrierung sind, dann neu starten
servo-too-far = der Roboter wurde angehalten, weil das Ziel { MM($shift_m, 0) } mm und { DEGREES($turn_rad, 0) }° entfernt ist
    .advice = Den Roboter näher an das Ziel fahren, sodass die Kamera das ganze Teil sieht, und neu starten
servo-outside-volume = der Roboter wurde angehalten, weil er den Arbeitsraum um { MM($beyond_m, 0) } mm verlassen würde
    .advice = Das Teil anders aufhängen oder den Arbeitsraum vergrößern, wenn Platz ist
servo-too-near = der Roboter wurde angehalten, weil { $body ->
        [gun] seine Pistole
        [wrist] sein Handgelenk
        [forearm] sein Unterarm
        [upper_arm] sein Oberarm
       *[tool] sein Werkzeug
    } { near-obstacle } zu nahe käme
    .advice = Das Teil anders aufhängen, von einer anderen Seite starten oder die Hindernisse und ihren Mindestabstand prüfen
servo-out-of-reach = der Roboter wurde angehalten, weil der Arm den Weg zum Ziel nicht erreicht
    .advice = Das Teil näher zur Mitte der Reichweite hängen oder mit einer anderen Stellung des Arms starten
servo-joint-limit = der Roboter wurde angehalten, weil Achse { $joint } über ihre Grenze fahren würde
    .advice = Mit einer anderen Stellung des Arms starten oder das Teil anders aufhängen
servo-singular = der Roboter wurde angehalten, weil der Arm einer Singularität nahe käme
    .advice = Mit einer anderen Stellung des Arms starten oder das Teil anders aufhängen
servo-uncertain = das Ziel ist erreicht, aber nicht so genau wie verlangt: { MM($shift_m, 1) } mm und { DEGREES($turn_rad, 2) }° mit der Unsicherheit, erlaubt sind { MM($most_m, 1) } mm und { DEGREES($most_rad, 2) }°
    .advice = Die Kamera das ganze Teil aus größerer Nähe sehen lassen, für die Düse als Ziel neu kalibrieren oder die Toleranz erhöhen
servo-not-settling = { $num_rounds ->
        [one] der Roboter wurde angehalten, weil nach { $num_rounds } Korrektur { MM($shift_m, 1) } mm und { DEGREES($turn_rad, 2) }° bleiben
       *[other] der Roboter wurde angehalten, weil nach { $num_rounds } Korrekturen { MM($shift_m, 1) } mm und { DEGREES($turn_rad, 2) }° bleiben
    }
    .advice = Das Teil ruhig hängen lassen oder das Totband erhöhen; bewegt sich nichts, die Kalibrierung prüfen
servo-time-over = der Roboter wurde angehalten, weil das Ziel nicht innerhalb von { FIXED($limit_s, 0) } s erreicht wurde
    .advice = Näher am Ziel starten oder die längste Zeit erhöhen
servo-robot-stopped = der Roboter wurde angehalten, weil sein Programm nicht mehr läuft oder keine Posen mehr annimmt
    .advice = Das Programm des Roboters neu starten und dann erneut servoen
servo-by-person = der Roboter wurde auf Wunsch angehalten
    .advice = Neu starten, wenn die Zelle frei ist

# Before it moves
servo-waits-for-robot = Wartet auf den Roboter: { $robot }
servo-not-simulated = die simulierte Zelle hat kein Teil { $part }
