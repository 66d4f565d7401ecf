# The robot's cell
robot-title = Roboter
robot-in-use = In Gebrauch
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
robot-edited = Die Datei wurde bearbeitet: Ihre Zahlen gelten als von Hand eingegeben
robot-edited-advice = Neu kalibrieren, um Restfehler dazu zu erhalten
robot-load = Laden…
robot-forget = Vergessen
robot-cell = Zelle
robot-camera = Kamera
robot-made = erstellt
robot-from = Quelle
robot-entered-by-hand = von Hand eingegeben
robot-pairs-of = { $num } Paare aus { $file }
robot-residuals = Restfehler
robot-residuals-are = { $mm } mm und { $degrees }° rms, max. { $worst } mm ({ $pair })
robot-uncertainty = Unsicherheit (95 %)
robot-mm-and-degrees = { $mm } mm und { $degrees }°
robot-flange-at-every = robot_from_flange bei jeder Aufnahme
robot-flange-unknown = Die Flanschpose bei der Aufnahme ist nicht bekannt: Es gibt keine Pose für den Roboter
robot-flange-unknown-advice = Die Flanschpose wie auf der Steuerung angezeigt eingeben und speichern
robot-flange-at = Flansch bei der Aufnahme
robot-store = Speichern

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
