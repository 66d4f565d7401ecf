# What the library says of a result

## Verdicts

results-accepted = Akzeptiert
results-not-accepted = Nicht akzeptiert
results-unknown = Unbekannt
results-no-part = Kein Teil
results-recipe-as-in-the-paper = Wie im Artikel
results-recipe-modified = { $name } (geändert)
results-title-not-recognised = Nicht erkannt · am nächsten { $part }
results-title-refused = { $part } · nicht akzeptiert
results-title-unknown = Unbekannt · am nächsten { $part }
results-title-mirrored = Spiegelbild von { $part }
results-keep-all = Alle
results-keep-not-accepted = Nicht akzeptierte
results-keep-none = Keine

## Why a part is not accepted

results-low-score = der beste Treffer, { $part }, hat den Score { $score } und liegt unter der Schwelle { $threshold }
results-piece = von { $part } ist nur ein Stück sichtbar ({ $hidden } % verdeckt, { $outside } % außerhalb des Bildes); Score { $score }, Schwelle { $threshold }
results-hardly-seen = was { $part } sein könnte, ist kaum sichtbar: fast von der Kante gesehen oder an den meisten Seiten abgeschnitten
results-another-model = ähnlich wie { $part }, aber nicht gleich: Die Oberfläche weicht um { $relief } ab, der Umriss um { $outline }, und { $missing } % fehlen; anderes Modell, die Pose ist nur ungefähr
results-another-make = vom Typ { $part }, aber nicht das eingelernte Teil: anderes Fabrikat mit anderen Maßen oder anderer Form
results-ambiguous-pose = was von { $part } sichtbar ist, passt an einer anderen Stelle fast gleich gut (Vorsprung vor dieser Stelle { $margin }, erforderlich { $threshold })
results-unconstrained = die Pose von { $part } ist durch das Sichtbare nicht bestimmt: { $freedom }
results-uncertain = die Pose von { $part } ist um { $shift } unsicher, zulässig sind { $limit }
results-unknown-nearest = unbekannt: Kein eingelerntes Teil ist ähnlich; das nächste, { $nearest }, hat den Score { $score }
results-unknown-alone = unbekannt: Kein eingelerntes Teil ist ähnlich
results-mirrored = sieht aus wie das Spiegelbild von { $part } (Score { $score }): das Teil der anderen Fahrzeugseite
results-mirrored-image = passt zu { $part } nur als Spiegelbild (Score { $score }), und { $part } gibt es nur einmal: Vermutlich sind links und rechts im Bild vertauscht
results-small-margin = { $part } und { $other } passen fast gleich gut (Vorsprung { $margin }, erforderlich { $threshold })
results-unconfirmed = { $part } hat den ähnlichsten Umriss; das Verfahren des Artikels allein kann es nicht von einem unbekannten Teil unterscheiden
results-out-of-range = was { $part } sein könnte, ist { $depth } m von der Kamera entfernt: Tiefenkameras messen von 0.1 bis 20 m
results-behind-camera = { $share } % der Punkte liegen hinter der Kamera, daher ist nicht bekannt, wo { $part } ist
results-surplus-bytes = nach dem letzten Punkt der Datei folgen { $num } Bytes: Sie ist beschädigt und damit auch, was { $part } sein könnte
results-no-pose = keine Pose gefunden: { $why }
results-not-steady = { $part } hängt noch nicht still
results-few-frames = { $part } hängt still, seitdem wurden { $num } von { $needed } Bildern geprüft
results-undecided = { $agreeing } von { $num } Bildern akzeptieren { $part }, erforderlich sind { $needed }
results-poses-apart = die Posen von { $part } liegen in { $agreeing } von { $num } Bildern beieinander, erforderlich sind { $needed }

## The same where refusals are counted

results-kind-low-score = Score unter der Schwelle
results-kind-piece = Nur ein Stück des Teils sichtbar
results-kind-hardly-seen = Teil kaum sichtbar
results-kind-another-model = Anderes Modell
results-kind-another-make = Anderes Fabrikat
results-kind-ambiguous-pose = Passt an einer anderen Stelle des Teils fast gleich gut
results-kind-unconstrained = Pose nicht bestimmt
results-kind-uncertain = Pose zu unsicher
results-kind-unknown = Unbekannt: Kein eingelerntes Teil ist ähnlich
results-kind-mirrored = Spiegelbild eines eingelernten Teils
results-kind-mirrored-image = Links und rechts im Bild vermutlich vertauscht
results-kind-small-margin = Zwei Teile passen fast gleich gut
results-kind-unconfirmed = Nur nach dem Verfahren des Artikels, ohne Pose
results-kind-out-of-range = Außerhalb des Messbereichs der Kamera
results-kind-behind-camera = Punkte hinter der Kamera
results-kind-surplus-bytes = Datei beschädigt
results-kind-no-pose = Keine Pose gefunden
results-kind-not-steady = Hing noch nicht still
results-kind-few-frames = Zu wenige Bilder, seit es still hing
results-kind-undecided = Zu wenige Bilder akzeptieren das Teil
results-kind-poses-apart = Posen der Bilder liegen nicht beieinander

## What to do about it

results-low-score-advice = Prüfen, ob dieses Teil eingelernt und nicht verdeckt ist, dann erneut aufnehmen
results-small-margin-advice = Das Teil mit der Sichtseite zur Kamera drehen und erneut aufnehmen; stehen beide Namen für dasselbe Teil, einen aus der Bibliothek entfernen
results-hidden-piece-advice = Entfernen, was vor dem Teil steht, und erneut aufnehmen
results-outside-piece-advice = Das Teil weiter ins Bild hängen und erneut aufnehmen
results-piece-advice = Entfernen, was vor dem Teil steht, oder das Teil weiter ins Bild hängen, und erneut aufnehmen
results-hardly-seen-advice = Das Teil mit der Sichtseite zur Kamera drehen, ganz im Bild, und erneut aufnehmen
results-see-an-edge-advice = Die Kamera so bewegen, dass sie eine Ecke oder eine weitere Kante des Teils sieht, und erneut aufnehmen
results-another-model-advice = Soll auch dieses lackiert werden, als weitere Referenz von { $part } einlernen
results-unknown-advice = Das Teil einlernen, wenn es lackiert werden soll; ist es eingelernt, die Sichtseite zur Kamera drehen und erneut aufnehmen
results-mirrored-advice = Das Teil dieser Seite unter eigenem Namen einlernen und nicht mit der Bahn der anderen Seite lackieren
results-mirrored-image-advice = Den Roboter nicht nach diesem Bild bewegen: Ein Bild mit dem Teil vergleichen; sind links und rechts vertauscht, "mirrored": true in die JSON-Datei mit den Kameraparametern schreiben
results-unconfirmed-advice = Auch die Pose schätzen lassen: im Rezept „Pose durch“ auf „Global“ stellen
results-out-of-range-advice = Die Einheit der Datei oder der JSON-Datei der Kamera prüfen: Längen sind in Metern; dann erneut aufnehmen
results-behind-camera-advice = Die Aufnahme im Koordinatensystem der Kamera exportieren: x rechts, y unten, z vorn
results-surplus-bytes-advice = Die Datei aus dem Ursprungsprogramm erneut kopieren oder exportieren
results-not-steady-advice = Das Teil eine Sekunde still hängen lassen
results-few-frames-advice = Einen Moment warten
results-undecided-advice = Einen Moment warten; bleibt es dabei, die Sichtseite des Teils zur Kamera drehen und entfernen, was davor steht
results-poses-apart-advice = Das Teil so aufhängen, dass nichts schwingt, und einen Moment warten; bleibt es dabei, die Sichtseite zur Kamera drehen

## Why there is no part

results-too-few-readings = die Szene hat { $found } Messwerte, mindestens { $needed } sind erforderlich
results-too-few-readings-advice = Prüfen, ob die Kamera angeschlossen, nicht verdeckt und 0.6 bis 3 m vom Teil entfernt ist, dann erneut aufnehmen
results-too-wide = die Szene ist { $extent } m groß und enthält nichts von der Größe eines Teils
results-too-wide-advice = „Als Millimeter lesen“ drücken, falls unten angeboten, oder in Metern exportieren; bei einem Tiefenbild metres_per_unit in der JSON-Datei daneben berichtigen
results-only-background = vor dem Hintergrund ist nichts von der Größe eines Teils ({ $planes ->
        [one] 1 Ebene entfernt
       *[other] { $planes } Ebenen entfernt
    }, größter Rest { $found } m², erforderlich { $needed } m²)
results-only-background-advice = Das Teil mindestens 10 cm vor der Wand vor die Kamera hängen und erneut aufnehmen
results-known-cell-advice = Das Teil mindestens 10 cm vor der Wand vor die Kamera hängen und erneut aufnehmen; hing es dort, als die leere Zelle aufgenommen wurde, diese ohne das Teil neu aufnehmen
results-empty-library = in der Bibliothek ist kein Teil eingelernt
results-empty-library-advice = Zuerst ein Teil einlernen, unter „Einlernen“
results-no-plane = die { $num } Punkte des Teils liegen auf einer Linie oder einem Fleck ({ $width } m breit)
results-no-plane-advice = Das Teil mit der Sichtseite zur Kamera drehen und erneut aufnehmen
results-too-large = das Teil ist { $found } m groß, ein Bild deckt { $limit } m ab
results-too-large-advice = Prüfen, ob die Datei in Metern ist, oder alles außer dem Teil aus der Szene entfernen; bei einem Tiefenbild metres_per_unit in der JSON-Datei daneben berichtigen
results-no-shape = das Binärbild enthält keine Form mit einer Fläche ({ $num } Pixel gesetzt)
results-no-shape-advice = Größere Lücken schließen lassen oder das Teil näher an die Kamera bringen und erneut aufnehmen
results-no-outline = der Umriss aus { $num } Punkten hat keine Länge
results-no-outline-advice = Das Teil näher an die Kamera bringen und erneut aufnehmen

## Poses

results-slide-long = verschiebbar entlang der langen Seite
results-slide-short = verschiebbar entlang der kurzen Seite
results-slide-normal = verschiebbar senkrecht zur Oberfläche
results-turn-long = drehbar um die lange Seite
results-turn-short = drehbar um die kurze Seite
results-turn-normal = drehbar um die Achse senkrecht zur Oberfläche
results-anyhow = verschiebbar oder drehbar
results-source = Quelle
results-target = Ziel
results-few-points = die Punktwolke ({ $which }) hat { $found } Punkte, mindestens { $needed } sind erforderlich
results-few-points-advice = Das Teil aus geringerer Entfernung aufnehmen oder neu einlernen
results-degenerate = die Punktwolke ({ $which }) lässt die Pose offen: Ihre Punkte liegen auf einer Linie oder einem Fleck ({ $width } m breit)
results-degenerate-advice = Eine Punktwolke verwenden, die eine Fläche zeigt, keine Linie und keinen einzelnen Fleck
results-one-sided-pairs = die nächsten Punkte aller { $num } Paare liegen auf einem Fleck oder einer Linie, Abstand { $rms }
results-no-overlap = die Punktwolken haben nur { $found } Punktpaare innerhalb von { $reach }, mindestens { $needed } sind erforderlich
results-no-overlap-advice = Prüfen, ob beide Punktwolken dasselbe Teil in Metern zeigen
results-sizes-differ = eine Punktwolke ist { $ratio }-mal so groß wie die andere
results-sizes-differ-advice = Beide in Metern exportieren: Eine scheint in Millimetern zu sein
results-too-far-out = die Punktwolke ({ $which }) liegt { $distance } m vom Ursprung entfernt, zu weit, um ihre Punkte aufzulösen
results-too-far-out-advice = Vor dem Export von beiden Punktwolken denselben Versatz abziehen
results-no-reference-cloud = die Referenz ist eine flache Form ohne Punktwolke
results-no-reference-cloud-advice = Das Teil aus einer Aufnahme, einer Punktwolke oder einem Netz einlernen
results-pose-cancelled = die Schätzung wurde abgebrochen
results-pose-cancelled-advice = Erneut starten
results-little-overlap = nur { $overlap } % der Quelle liegen auf dem Ziel, mindestens { $needed } % sind erforderlich
results-another-pose = eine andere Pose passt ebenso gut (ihre Kosten sind { $ratio }-mal so hoch)
results-larger = was die Kamera sieht, ist { $percent } % größer als die Referenz
results-smaller = was die Kamera sieht, ist { $percent } % kleiner als die Referenz
results-off-scale-advice = Einheit der Tiefenwerte und Brennweiten (fx, fy) der Kamera prüfen: Die Pose ist um ebenso viele Prozent des Abstands falsch
results-loose = die Pose ist nicht bestimmt: { $freedom }
results-unsettled = die Pose bewegte sich nach { $num } Iterationen noch
results-little-overlap-advice = Prüfen, ob beide Punktwolken dasselbe zeigen und mindestens die Hälfte davon gemeinsam haben
results-converged = konvergiert
results-below-target = unter Zielwert
results-iteration-limit = Iterationsgrenze
results-no-progress = kein Fortschritt

## The check of the cell

results-cell-in-place = Kamera und Teil sind an ihrem Platz
results-cell-in-place-advice = Es ist nichts zu tun
results-cell-part-moved = das Teil hat sich bewegt, die Kamera nicht
results-cell-part-moved-advice = Das Teil wie zuvor aufhängen oder seine Halterung prüfen und erneut kontrollieren; soll es so bleiben, einen neuen Ausgangszustand aufnehmen
results-cell-camera-moved = die Kamera hat sich bewegt
results-cell-camera-moved-advice = Die Kamera befestigen, neu kalibrieren, dann einen neuen Ausgangszustand aufnehmen
results-cell-part-or-camera-moved = das Teil oder die Kamera hat sich bewegt
results-cell-part-or-camera-moved-advice = Das Teil wie zuvor aufhängen und erneut kontrollieren; hilft das nicht, hat sich die Kamera bewegt: Sie neu kalibrieren und einen neuen Ausgangszustand aufnehmen
results-cell-noisier = Kamera und Teil sind an ihrem Platz, aber die Messwerte rauschen stärker
results-cell-noisier-advice = Das Fenster der Kamera reinigen, auf Streulicht oder Nebel davor achten und erneut kontrollieren
results-cell-no-frame = kein Bild
results-cell-no-frame-advice = Das Teil für die Zellenkontrolle aufnehmen und die Datei angeben
results-cell-moving = die Bilder stimmen nicht überein: Das Teil ist in Bild { $frame } um { $shift } und { $turn } anders als im ersten
results-cell-moving-advice = Das Teil still hängen lassen, die Kamera nicht bewegen und erneut aufnehmen
results-cell-other-part = nur { $overlap } % dessen, was in Bild { $frame } zu sehen ist, liegen auf dem Teil des Ausgangszustands
results-cell-other-part-advice = Das Teil des Ausgangszustands an seinen üblichen Platz hängen, mit nichts davor; hängt es dort, hat sich Kamera oder Teil um mehrere Zentimeter bewegt
results-cell-pose = Bild { $frame }: { $error }

## The simulated cell

results-object-hood = Motorhaube
results-object-wheel = Rad
results-object-box = Kiste
results-object-chair = Stuhl
results-object-board = Brett
results-object-ladder = Leiter
results-object-stool = Hocker
results-object-bucket = Eimer

## The recipe

results-group-segmentation = Segmentierung
results-group-binary-image = Binärbild
results-group-contour = Kontur und Strahlen
results-group-match = Vergleich
results-group-pose = Pose
results-group-icp-ga = ICP-GA
results-group-acceptance = Akzeptanz
results-group-stand-off = Düsenabstand
results-segment-plane-distance = Ebenenabstand
results-segment-plane-distance-help = d_t des Artikels: Ein Punkt, der näher als dies (plus Rauschen) an einer Hintergrundebene liegt, gehört zu ihr. Höhere Werte entfernen, was nahe an der Wand ist.
results-segment-noise-at-1m = Tiefenrauschen bei 1 m
results-segment-noise-at-1m-help = Standardabweichung der Tiefe bei 1 m; sie wächst mit dem Quadrat der Tiefe. Gilt, bis eine Ebene das wirkliche Rauschen zeigt.
results-segment-noise-factor = Rauschfaktor
results-segment-noise-factor-help = Wie viele Standardabweichungen des Rauschens noch zu einer Ebene gehören. Höhere Werte entfernen, was nahe an der Wand ist, niedrigere lassen Reste der Wand stehen.
results-segment-good-sample-probability = Wahrsch. guter Stichprobe
results-segment-good-sample-probability-help = p aus Gl. 1 des Artikels: die Wahrscheinlichkeit, dass mindestens eine Stichprobe gut ist. Höhere Werte kosten Zeit.
results-segment-max-planes = Ebenen höchstens
results-segment-max-planes-help = Höchstzahl der Hintergrundebenen, die entfernt werden: Wand, Boden und eine weitere. Höhere Werte kosten Zeit und können ein flaches Teil entfernen.
results-segment-link-distance = Verbindungsabstand
results-segment-link-distance-help = Benachbarte Punkte mit größerem Abstand (plus Rauschen) gelten als nicht verbunden. Höhere Werte verbinden, was nahe am Teil hängt, niedrigere zerreißen das Teil.
results-segment-min-part-area = Kleinste Teilfläche
results-segment-min-part-area-help = Kleinere Flächen sind kein Teil. Höhere Werte lehnen kleine Teile ab, niedrigere halten Störobjekte für Teile.
results-segment-seed = Startwert der Ebenen
results-segment-seed-help = Startwert der Zufallsstichproben. Ein anderer kostet nichts; ein Ergebnis, das sich dadurch ändert, ist schwach begründet.
results-project-pixel = Pixel
results-project-pixel-help = Seitenlänge eines Pixels im Binärbild. Unterhalb des Punktabstands entstehen Lücken; höhere Werte verwischen den Umriss.
results-project-closed-gap = Lücken schließen bis
results-project-closed-gap-help = Lücken bis zu dieser Breite werden geschlossen. Höhere Werte füllen schmale echte Öffnungen.
results-contour-min-opening-area = Kleinste Öffnung
results-contour-min-opening-area-help = Kleinere Öffnungen gelten als Aussetzer des Sensors. Höhere Werte verlieren echte Öffnungen.
results-signature-num-rays = Strahlen
results-signature-num-rays-help = Strahlen rund um den Umriss. Mehr kosten Zeit in der Rangliste und lösen feinere Details auf.
results-signature-smoothing = Glättung
results-signature-smoothing-help = Über diese Länge wird der Umriss gemittelt, bevor die Strahlen gezogen werden. Höhere Werte verzeihen raue Kanten und runden Ecken ab.
results-rank-matcher = Vergleichsverfahren
results-rank-matcher-help = Standard: zyklische Korrelation der Strahlen als komplexe Zahlen, dann Überlappung der Bilder. Artikel: Algorithmus 2 wörtlich; er hat keine eigene Schwelle.
results-rank-num-overlaid = Überlagerte Lagen
results-rank-num-overlaid-help = Lagen jedes eingelernten Teils, die über das Bild der Szene gelegt werden. Höhere Werte kosten Zeit und helfen bei fast symmetrischen Teilen.
results-rank-outline-tolerance = Umrisstoleranz
results-rank-outline-tolerance-help = Abstand der Umrisse, bei dem der Score auf 1/e gefallen ist. Höhere Werte verzeihen abweichende Umrisse.
results-rank-num-compared = Ganz verglichen
results-rank-num-compared-help = Höchstzahl der eingelernten Referenzen, die ganz verglichen werden, die in Größe und grober Form ähnlichsten zuerst. Höhere Werte kosten bei Tausenden von Teilen Zeit und finden Teile, von denen wenig zu sehen ist.
results-rank-parallel-from = Alle Kerne ab
results-rank-parallel-from-help = Ab so vielen eingelernten Referenzen rechnen alle Kerne; die Rangliste bleibt gleich. Niedrigere Werte kosten Zeit, wo der Start länger dauert als die Rangliste.
results-pose = Pose durch
results-pose-help = Global: Die besten Teile werden an ihren Platz gelegt und dort gesucht. ICP: das Verfahren des Artikels, von einem Start. Keine: Das Ergebnis beruht nur auf dem Umriss und ist schneller.
results-confirm-num-references = Gesuchte Teile
results-confirm-num-references-help = Zahl der bestplatzierten Teile, die in der Szene bestätigt werden. Höhere Werte kosten je etwa 1.5 ms und helfen bei halb verdeckten Teilen.
results-confirm-tolerance = Flächentoleranz
results-confirm-tolerance-help = Abstand vom eingelernten Teil, bei dem ein Punkt ohne Rauschen noch darauf liegt. Höhere Werte verzeihen Dellen und ähnliche Teile.
results-confirm-seed = Startwert der Ausdünnung
results-confirm-seed-help = Startwert für das Ausdünnen der Punkte. Ein anderer wählt andere Punkte und kostet nichts.
results-icp-max-iterations = ICP-Iterationen höchstens
results-icp-max-iterations-help = Höchstzahl der Iterationen von ICP. Die Zeit wächst im gleichen Verhältnis.
results-icp-target-e-m2 = ICP genügt unter
results-icp-target-e-m2-help = Algorithmus 3 hört unter diesem E auf; die 1e-6 m² des Artikels sind 1 mm². Höhere Werte beenden die Suche früher und gröber.
results-icp-max-source-points = ICP-Punkte höchstens
results-icp-max-source-points-help = Punkte des Teils der Szene, die ICP verwendet, gleichmäßig ausgedünnt. Die Zeit wächst im gleichen Verhältnis.
results-icp-shift-tolerance = ICP kleinste Verschiebung
results-icp-shift-tolerance-help = Ein Schritt, der weniger verschiebt (und wenig dreht), beendet die Suche. Höhere Werte beenden sie früher.
results-icp-turn-tolerance = ICP kleinste Drehung
results-icp-turn-tolerance-help = Ein Schritt, der weniger dreht (und wenig verschiebt), beendet die Suche. Höhere Werte beenden sie früher.
results-icp-ga-target-e-m2 = ICP-GA Ziel-E
results-icp-ga-max-rounds = Runden höchstens
results-icp-ga-patience = Geduld
results-icp-ga-least-progress = Kleinster Fortschritt
results-icp-ga-vicinity-range = Umgebung
results-icp-ga-turn-range = Drehungen anderswo
results-icp-ga-shift-range = Verschiebungen anderswo
results-icp-ga-num-fine-points = Punkte nah
results-icp-ga-num-coarse-points = Punkte anderswo
results-icp-ga-seed = ICP-GA Startwert
results-icp-ga-icp-max-iterations = Runde: ICP-Iterationen
results-icp-ga-icp-target-e-m2 = Runde: ICP Ziel-E
results-icp-ga-icp-max-source-points = Runde: ICP-Punkte
results-icp-ga-icp-shift-tolerance = Runde: ICP kleinste Verschiebung
results-icp-ga-icp-turn-tolerance = Runde: ICP kleinste Drehung
results-icp-ga-vicinity-population = Nah: Population
results-icp-ga-vicinity-generations = Nah: Generationen
results-icp-ga-vicinity-tournament = Nah: Turnier
results-icp-ga-vicinity-crossover-rate = Nah: Kreuzung
results-icp-ga-vicinity-mutation-rate = Nah: Mutation
results-icp-ga-vicinity-mutation-decades = Nah: Mutationsdekaden
results-icp-ga-vicinity-half-turn-rate = Nah: halbe Drehungen
results-icp-ga-elsewhere-population = Anderswo: Population
results-icp-ga-elsewhere-generations = Anderswo: Generationen
results-icp-ga-elsewhere-tournament = Anderswo: Turnier
results-icp-ga-elsewhere-crossover-rate = Anderswo: Kreuzung
results-icp-ga-elsewhere-mutation-rate = Anderswo: Mutation
results-icp-ga-elsewhere-mutation-decades = Anderswo: Mutationsdekaden
results-icp-ga-elsewhere-half-turn-rate = Anderswo: halbe Drehungen
results-accept-min-score = Akzeptieren ab
results-accept-min-score-help = Mindestscore. Höhere Werte machen aus falschen Ergebnissen Ablehnungen, und aus einigen richtigen auch.
results-accept-min-likeness = Anderes Fabrikat ab
results-accept-min-likeness-help = Ab dieser Ähnlichkeit wird ein nicht eingelerntes Teil als anderes Fabrikat benannt. Höhere Werte nennen mehr davon unbekannt.
results-accept-min-margin = Vorsprung mindestens
results-accept-min-margin-help = Mindestvorsprung vor dem nächsten Teil und vor einer anderen Pose: die Differenz der Wahrscheinlichkeiten, wenn nur eines richtig sein kann. Höhere Werte lehnen ähnliche Teile ab.
results-accept-unknown-below = Unbekannt unter
results-accept-unknown-below-help = Ein bester Treffer unter diesem Score gilt als unbekannt. Höhere Werte benennen weniger halb verdeckte Teile.
results-accept-max-relief = Gleiches Modell: Fläche
results-accept-max-relief-help = Wie weit die Fläche gegenüber der Referenz vor- oder zurückstehen darf. Höhere Werte akzeptieren andere Modelle mit ungefährer Pose.
results-accept-max-missing = Gleiches Modell: Fehlendes
results-accept-max-missing-help = Anteil der Referenz, der in der Szene fehlen darf. Höhere Werte akzeptieren andere Modelle mit ungefährer Pose.
results-accept-max-outline-shift = Gleiches Modell: Umriss
results-accept-max-outline-shift-help = Wie weit Abschnitte des Umrisses von der Referenz abweichen dürfen. Höhere Werte akzeptieren andere Modelle mit ungefährer Pose.
results-accept-max-uncertainty = Pose-Unsicherheit höchstens
results-accept-max-uncertainty-help = Größte Schranke (95 %) der Verschiebung der Pose. Höhere Werte akzeptieren weniger genau bekannte Posen.
results-stand-off-taught = Eingelernter Abstand
results-stand-off-taught-help = Abstand der Düse vom Teil, als die Bahn eingelernt wurde (Standard-d des Artikels).
results-stand-off-nearest = Band von
results-stand-off-nearest-help = Kleinster Abstand, der noch gut beschichtet. Höhere Werte nennen mehr von der Bahn zu nah.
results-stand-off-farthest = Band bis
results-stand-off-farthest-help = Größter Abstand, der noch gut beschichtet. Höhere Werte verzeihen mehr von der Bahn.
results-stand-off-num-rays = Strahlen der Bahn
results-stand-off-num-rays-help = Punkte der angenommenen Bahn, die ausgewertet werden. Höhere Werte kosten je etwa 2 µs und finden eine kleinere schlechteste Stelle.
results-option-default = Standard
results-option-paper = Artikel
results-option-global = Global
results-option-none = Keine
