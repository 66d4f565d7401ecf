# The robot's cell
robot-title = Roboter
robot-in-use = Kalibrierung
robot-by-hand = Von Hand
robot-from-pairs = Aus Posenpaaren
robot-load-title = Kalibrierung der Roboterzelle laden
robot-calibrations = Kalibrierungen
robot-pairs-title = Paare aus Roboter- und Kameraposen
robot-tables = Tabellen und JSON
robot-forgotten = Die Kalibrierung wird nicht mehr verwendet; ihre Datei bleibt erhalten
robot-opening = Kalibrierung wird geöffnet
robot-saving = Kalibrierung wird gespeichert
robot-calculating = Lage der Kamera wird berechnet
robot-no-folder = Es gibt keinen Ordner für die eigene Kalibrierung
robot-no-folder-advice = Mit partsight calibrate --out FILE schreiben und diese Datei hier laden
robot-saved = Gespeichert; die frühere Kalibrierung liegt in { $path }

## In use

robot-not-calibrated = Die Zelle ist nicht kalibriert: Posen sind im Kamerakoordinatensystem, ein Roboter kann sie nicht verwenden
robot-file = Datei
robot-edited = die Zahlen der Kalibrierung wurden geändert und nicht bestätigt: Kein Roboter erhält Posen
robot-edited-advice = Die Zahlen unter Roboter… prüfen; bestätigen, wenn sie stimmen, sonst neu kalibrieren
robot-confirm = Bestätigen…
robot-confirm-says = Steht die Kamera dort? Die Zahlen gelten dann als von Hand eingegeben, und Roboter erhalten Posen danach. Die frühere Datei bleibt erhalten
robot-confirm-not = Jetzt nicht
robot-confirm-right = Sie stimmen
robot-load = Laden…
robot-forget = Vergessen
robot-cell = Zelle
robot-camera = Kamera
robot-made = erstellt
robot-from = Quelle
robot-entered-by-hand = von Hand eingegeben
robot-pairs-of = { $num ->
        [one] { $num } Paar aus { $file }
       *[other] { $num } Paare aus { $file }
    }
robot-residuals = Restfehler
robot-residuals-are = { $mm } mm und { $degrees }° rms, max. { $worst } mm ({ $pair })
robot-uncertainty = Unsicherheit (95 %)
robot-mm-and-degrees = { $mm } mm und { $degrees }°
robot-flange-at-every = robot_from_flange bei jeder Aufnahme
robot-flange-unknown = Die Flanschpose bei der Aufnahme ist nicht bekannt: Es gibt keine Pose für den Roboter
robot-flange-unknown-advice = Die Flanschpose wie auf der Steuerung angezeigt eingeben und speichern
robot-flange-at = Flansch bei der Aufnahme

## By hand

robot-camera-in-cell = Kamera in der Zelle
robot-camera-on-flange = Kamera am Flansch
robot-numbers-of = Zahlen von
robot-numbers-are-of = Zahlen von: { $convention }
robot-where-camera-stands = { $transform }: Lage des Kamerakoordinatensystems
robot-name-of-cell = Name der Zelle
robot-use-it = Verwenden
robot-use-anyway = Trotzdem verwenden

## From pairs

robot-choose-pairs = Paare wählen…
robot-choose-pairs-says = Tabelle oder JSON mit Roboter- und Kameraposen, 8 bis 15 Paare
robot-pairs-format = Eine Zeile enthält die Pose des Roboters, wie die Steuerung den Flansch anzeigt, dann die der Kamera: wo sie das Ziel sieht. Zeilen wie "# robot: kuka" und "# camera: matrix" am Anfang nennen die Konventionen. Auch ein eingelerntes Teil kann das Ziel sein: partsight calibrate hand-eye --captures
robot-counts = zählt
robot-off-mm = Abw. mm
robot-off-degrees = Abw. °
robot-worst = schlechtestes
robot-left-out = ausgelassen
robot-rms = rms der Restfehler
robot-not-determined = durch die Paare nicht bestimmt
robot-flange-turned = Drehung des Flanschs
robot-span = höchstens { $turn }°, { $other }° um andere Achsen; Ziel bewegt um { $travel } mm
robot-read-as = gelesen als
robot-conventions-are = Roboter { $robot }, Kamera { $camera }
robot-eye-to-hand = Eye-to-hand: Die Kamera steht in der Zelle
robot-eye-in-hand = Eye-in-hand: Die Kamera sitzt am Flansch

## Check of the cell

robot-check = Zellenkontrolle
robot-check-says = Ein Teil, das jeden Tag am selben Platz hängt, zeigt, ob Kamera und Zelle noch stehen wie zuvor. Jedes starre Ding mit Kanten in allen Richtungen eignet sich; etwas von Wand oder Boden im Bild lassen
robot-check-no-folder = Es gibt keinen Ordner für Ausgangszustand und Kontrollen
robot-check-no-folder-advice = partsight cell mit --folder DIR verwenden
robot-no-baseline = Es gibt keinen Ausgangszustand zum Vergleich
robot-no-baseline-advice = Einen aufnehmen, solange die Zelle in Ordnung ist
robot-baseline = Ausgangszustand
robot-taken-at =
    { $time }, { $count ->
        [one] 1 Bild
       *[other] { $count } Bilder
    }
robot-allowed = erlaubt
robot-allowed-are = { $shift } und { $turn }
robot-no-wall = Weder Wand noch Boden sind im Bild des Ausgangszustands: Eine Kontrolle kann nicht unterscheiden, ob sich die Kamera oder das Teil bewegt hat
robot-no-wall-advice = Etwas davon im Bild lassen und einen neuen Ausgangszustand aufnehmen
robot-frames-from = Bilder von
robot-new-baseline-allows = Ein neuer Ausgangszustand erlaubt
robot-allowed-shift = Erlaubte Verschiebung, mm
robot-allowed-turn = Erlaubte Drehung, Grad
robot-take-baseline = Ausgangszustand aufnehmen
robot-take-new-baseline = Neuen Ausgangszustand aufnehmen…
robot-check-now = Jetzt kontrollieren
robot-replace-says = Den Ausgangszustand ersetzen? Kontrollen werden dann mit dem neuen verglichen, der alte bleibt nicht erhalten
robot-keep-baseline = Behalten
robot-replace-baseline = Ersetzen
robot-reading-checks = Ausgangszustand und Kontrollen werden gelesen
robot-taking-baseline = Ausgangszustand wird aufgenommen
robot-checking = Zelle wird kontrolliert
robot-writing-checks = Kontrollen werden geschrieben
robot-check-of-scan = Ein Scan ist von mehreren Orten gesehen und keine Kontrolle der Zelle
robot-check-of-scan-advice = Eine Kamera als Quelle wählen oder eine einzelne Aufnahme öffnen
robot-last-check = Letzte Kontrolle
robot-checked = kontrolliert
robot-of-allowed = { $value }, erlaubt { $limit }
robot-part-shifted = Teil verschoben um
robot-along-axes = entlang x, y und z der Kamera
robot-part-turned = Teil gedreht um
robot-wall-shifted = Wand und Boden verschoben um
robot-wall-not-found = nicht wiedergefunden
robot-readings = Messwerte
robot-readings-are = { $rms } rms zum Ausgangszustand, das { $ratio }-Fache seines Rauschens
robot-checks-shown = { $count ->
        [one] Letzte { $shown } von { $count } Kontrolle
       *[other] Letzte { $shown } von { $count } Kontrollen
    }
robot-shift-over-time = Verschiebung seit dem Ausgangszustand entlang x, y und z der Kamera
robot-check-time = Zeit
robot-check-shift = Verschiebung
robot-check-turn = Drehung
robot-check-finding = Befund
robot-export-checks-title = Kontrollen der Zelle exportieren
robot-checks-written =
    { $count ->
        [one] Eine Kontrolle
       *[other] { $count } Kontrollen
    } nach { $path } geschrieben
robot-moved = Letzte Kontrolle der Zelle, { $time }: { $finding }
robot-moved-advice = Vor dem Lackieren einen Einrichter nachsehen lassen: Roboter…, Zellenkontrolle

## Answering robots

robot-answer = Anfragen
robot-answer-says = Roboter und SPS fragen über TCP nach einer Prüfung und erhalten Ergebnis und Pose, wie von partsight serve. Jeder Trigger wird aus einem Bild beantwortet, das die Quelle des Fensters danach liefert. SERVO nutzt Ziel und Grenzen der Seite Servo
robot-protocol = Protokoll
robot-port = Port, oder IP-Adresse und Port
robot-pose-of-part = Lage des Teils
robot-pose-offset = Abstand von der Standardposition
robot-poses-as = Posen als
robot-answered-in = Antworten als: { $convention }
robot-change-poses = Roboter werden gerade beantwortet: Die Zahlen ihrer nächsten Pose würden etwas anderes bedeuten
robot-change-poses-advice = Zuerst die Roboter anhalten und ihre Programme anpassen. Alle Verbindungen enden, und die Nummer boot ändert sich
robot-change-poses-do = Ändern
robot-change-poses-not = So lassen
robot-no-address = „{ $text }“ ist kein Port und keine IP-Adresse mit Port
robot-no-address-advice = Einen Port von 1 bis 65535 angeben, oder dazu die Adresse der Netzwerkkarte dieses Rechners, etwa 192.168.1.10:30100
robot-other-convention = Eine andere Konvention wählen
robot-turn-on = Einschalten
robot-turn-off = Ausschalten
robot-calibrate-first = Zuerst kalibrieren: Sonst gibt es keine Pose
robot-answers-at = Antwortet Robotern · { $at }
robot-answers-without-frames = Antwortet Robotern, ohne Bilder
robot-answers-without-frames-advice = Live drücken: Bis dahin wird jeder Trigger mit einem Fehler beantwortet
robot-answers-soon = Antworten an Roboter wird gestartet
robot-not-answered = Roboter erhalten keine Antwort
robot-port-in-use = { $at } ist nicht verfügbar: Ein anderes Programm verwendet diesen Port
robot-port-in-use-advice = Das andere Programm beenden, oder einen anderen Port wählen. Es wird alle 3 s erneut versucht
robot-cannot-listen-advice = Einen anderen Port ab 1024 wählen, oder die Adresse einer Netzwerkkarte dieses Rechners
robot-listens-at = erreichbar unter
robot-clients = Verbindungen
robot-last-client = letzte Verbindung
robot-client-connected = { $peer } ist verbunden
robot-client-left = { $peer } ist getrennt
robot-client-turned-away = { $peer } wurde abgewiesen: Es sind so viele Clients verbunden wie erlaubt
robot-client-turned-away-advice = Eine ungenutzte Verbindung schließen
robot-last-trigger = letzter Trigger
robot-no-trigger = noch keiner
robot-answer-number = Nr. { $number }
robot-answer-age = Bild { $age } ms alt
robot-answer-motion-unchecked = nicht geprüft, ob sich das Teil bewegt
robot-part-numbers = Nummern der Teile

## Poses and conventions
robot-motion-unknown = Nicht bekannt, ob das Teil still hing

## Was nicht geprüft wurde
