# Why a part is not accepted, or nothing is recognised. Of each kind: the reason; `advice`, what to do, and `command-advice`
# where commands advise something else; `kind`, its name where refusals are counted; `short`, the reason for an operator;
# what an operator can do, as `step` and `otherwise`, between which the window says how to inspect again, or as `next`,
# or else `advice`; `compared`, the reason beside the figures of Compare.

## A part is not accepted

refusal-low-score = der beste Treffer, { $part }, hat den Score { FIXED($score, 2) } und liegt unter der Schwelle { FIXED($threshold, 2) }
    .advice = Prüfen, ob dieses Teil eingelernt und nicht verdeckt ist, dann erneut aufnehmen
    .kind = Score unter der Schwelle
    .short = Passt nicht gut genug zu: { $nearest }
    .step = { step-uncover }
    .otherwise = { step-if-it-persists }
    .compared = Score { FIXED($score, 2) } liegt unter { FIXED($threshold, 2) }
refusal-piece = von { $part } ist nur ein Stück sichtbar ({ PERCENT($hidden, 0) } % verdeckt, { PERCENT($outside, 0) } % außerhalb des Bildes); Score { FIXED($score, 2) }, Schwelle { FIXED($threshold, 2) }
    .advice = { PERCENT($hidden, 0) ->
        [0] { PERCENT($outside, 0) ->
            [0] { piece-hidden-or-outside }
           *[other] { piece-outside }
        }
       *[other] { PERCENT($outside, 0) ->
            [0] { piece-hidden }
           *[other] { piece-hidden-or-outside }
        }
    }
    .kind = Nur ein Stück des Teils sichtbar
    .short = Nur ein Stück sichtbar von: { $nearest }
    .compared = Score { FIXED($score, 2) } liegt unter { FIXED($threshold, 2) }: nur ein Stück ist sichtbar
refusal-hardly-seen = was { $part } sein könnte, ist kaum sichtbar: fast von der Kante gesehen oder an den meisten Seiten abgeschnitten
    .advice = Das Teil mit der Sichtseite zur Kamera drehen, ganz im Bild, und erneut aufnehmen
    .kind = Teil kaum sichtbar
    .short = { short-hardly-seen }
    .step = { step-all-in-picture }
    .compared = Score { FIXED($score, 2) }: kaum sichtbar
refusal-another-model = ähnlich wie { $part }, aber nicht gleich: { LIST(model-surface, model-outline, model-missing, between: ", ", last: ", und ", end: "; ") }anderes Modell, die Pose ist nur ungefähr
    .advice = Soll auch dieses lackiert werden, als weitere Referenz von { $part } einlernen
    .kind = Anderes Modell
    .short = Ähnlich wie { $nearest }, aber andere Form
    .next = { step-enrol-if-painted-next }
    .compared = { LIST(model-surface, model-outline, model-missing, between: ", ", last: ", ", end: ": ") }anderes Modell
refusal-another-make = vom Typ { $part }, aber nicht das eingelernte Teil: anderes Fabrikat mit anderen Maßen oder anderer Form
    .advice = { refusal-another-model.advice }
    .kind = Anderes Fabrikat
    .short = Ähnlich wie { $nearest }, aber andere Maße
    .next = { step-enrol-if-painted-next }
    .compared = vom gleichen Typ mit Wahrscheinlichkeit { FIXED($likeness, 2) }: anderes Fabrikat
refusal-ambiguous-pose = was von { $part } sichtbar ist, passt an einer anderen Stelle fast gleich gut (Vorsprung vor dieser Stelle { FIXED($margin, 2) }, erforderlich { FIXED($threshold, 2) })
    .advice = { see-an-edge }
    .kind = Passt an einer anderen Stelle des Teils fast gleich gut
    .short = { short-uncertain-pose }
    .step = { step-see-an-edge }
    .otherwise = { step-if-it-persists }
    .compared = der Vorsprung vor einer anderen Pose beträgt { FIXED($margin, 2) }, weniger als { FIXED($threshold, 2) }
refusal-unconstrained = die Pose von { $part } ist durch das Sichtbare nicht bestimmt: { free-motion }
    .advice = { see-an-edge }
    .kind = Pose nicht bestimmt
    .short = { short-uncertain-pose }
    .step = { step-see-an-edge }
    .otherwise = { step-if-it-persists }
    .compared = die Pose ist nicht bestimmt: { free-motion }
refusal-uncertain = die Pose von { $part } ist um { MM($shift_m, 1) } mm unsicher, zulässig sind { MM($limit_m, 1) } mm
    .advice = { $frames_disagree ->
        [true] { scan-poses }
       *[other] { see-an-edge }
    }
    .kind = Pose zu unsicher
    .short = { short-uncertain-pose }
    .step = { $frames_disagree ->
        [true] { step-scan-again }
       *[other] { step-see-an-edge }
    }
    .otherwise = { step-if-it-persists }
    .compared = die Pose ist um { MM($shift_m, 1) } mm unsicher, zulässig sind { MM($limit_m, 1) } mm
refusal-unknown = unbekannt: Kein eingelerntes Teil ist ähnlich{ $like ->
        [true] ; das nächste, { $nearest }, hat den Score { FIXED($score, 2) }
       *[other] { "" }
    }
    .advice = Das Teil einlernen, wenn es lackiert werden soll; ist es eingelernt, die Sichtseite zur Kamera drehen und erneut aufnehmen
    .kind = Unbekannt: Kein eingelerntes Teil ist ähnlich
    .short = Kein eingelerntes Teil ist ähnlich
    .step = { step-turn }
    .otherwise = { step-enrol-if-painted-next }
    .compared = Score { FIXED($score, 2) }: unbekannt
refusal-mirrored = sieht aus wie das Spiegelbild von { $part } (Score { FIXED($score, 2) }): das Teil der anderen Fahrzeugseite
    .advice = Das Teil dieser Seite unter eigenem Namen einlernen und nicht mit der Bahn der anderen Seite lackieren
    .kind = Spiegelbild eines eingelernten Teils
    .short = Sieht aus wie das Spiegelbild von { $nearest }
    .next = Nicht wie { $nearest } lackieren: Den Einrichter bitten, das Teil dieser Seite einzulernen
    .compared = sieht aus wie das Spiegelbild von { $part }
refusal-mirrored-image = passt zu { $part } nur als Spiegelbild (Score { FIXED($score, 2) }), und { $part } gibt es nur einmal: Vermutlich sind links und rechts im Bild vertauscht
    .advice = Den Roboter nicht nach diesem Bild bewegen: Ein Bild mit dem Teil vergleichen; sind links und rechts vertauscht, "mirrored": true in die JSON-Datei mit den Kameraparametern schreiben
    .kind = Links und rechts im Bild vermutlich vertauscht
    .short = Das Kamerabild ist gespiegelt
    .next = Roboter nicht starten: Den Einrichter bitten, die Kamera richtig einzustellen
    .compared = passt zu { $part } nur als Spiegelbild: das Bild ist vermutlich gespiegelt
refusal-off-scale = was die Kamera von { $part } sieht, ist { PERCENT($by, 0) } % { $is_larger ->
        [true] größer
       *[false] kleiner
    } als die Referenz: Die Zahlen der Kamera sind falsch, oder es ist ein anderes Fabrikat
    .advice = Zuerst Einheit der Tiefenwerte und Brennweiten (fx, fy) der Kamera prüfen; nur dann als weitere Referenz von { $part } einlernen, wenn es wirklich eine andere Größe hat
    .kind = Andere Größe als die Referenz: falsche Zahlen der Kamera oder anderes Fabrikat
    .short = Die Kamera zeigt { $nearest } in anderer Größe
    .next = Roboter nicht starten: Den Einrichter bitten, die Kamera zu prüfen
    .compared = andere Größe als die Referenz
refusal-other-half = sieht aus wie das Spiegelbild dessen, was von { $part } eingelernt ist (Score { FIXED($score, 2) }): Von { $part } ist nur ein Stück eingelernt, und dies kann die andere Hälfte sein
    .advice = { $part } ganz einlernen, oder diese Hälfte als weitere Referenz davon
    .kind = Vielleicht die nicht eingelernte Hälfte eines Teils
    .short = Es kann die andere Hälfte von { $nearest } sein
    .next = Den Einrichter bitten, { $nearest } ganz einzulernen
    .compared = sieht aus wie das Spiegelbild des eingelernten Stücks von { $part }
refusal-small-margin = { $part } und { $other } passen fast gleich gut (Vorsprung { FIXED($margin, 2) }, erforderlich { FIXED($threshold, 2) })
    .advice = Das Teil mit der Sichtseite zur Kamera drehen und erneut aufnehmen; stehen beide Namen für dasselbe Teil, einen aus der Bibliothek entfernen
    .kind = Zwei Teile passen fast gleich gut
    .short = Zwei eingelernte Teile passen fast gleich gut
    .step = { step-turn }
    .otherwise = { step-if-two-alike }
    .compared = der Vorsprung vor { $other } beträgt { FIXED($margin, 2) }, weniger als { FIXED($threshold, 2) }
refusal-wrong-part = falsches Teil: dort hängt { $part } statt { $expected }
    .advice = { $expected } dort aufhängen, oder berichtigen, was erwartet wird
    .kind = Anderes Teil als erwartet
    .short = Dort hängt { $nearest } statt { $expected }
    .compared = erwartet wird { $expected }
refusal-not-expected = zu viele Teile: { $part } wird nicht erwartet
    .advice = { $part } wegnehmen, oder berichtigen, was erwartet wird
    .kind = Teil nicht erwartet
    .short = { $nearest } wird nicht erwartet
    .compared = es wird nicht erwartet
refusal-expected-elsewhere = falscher Platz: { $part } hängt an { $place } und wird an { $expected_at } erwartet
    .advice = { $part } an { $expected_at } hängen, oder berichtigen, was erwartet wird
    .kind = Teil an anderem Platz als erwartet
    .short = { $nearest } wird an { $expected_at } erwartet, nicht an { $place }
    .compared = wird an { $expected_at } erwartet
refusal-cut-by-volume = { $part } ragt aus dem Arbeitsraum, und zu wenig davon liegt darin
    .advice = Den Arbeitsraum in der Gestelldatei vergrößern, oder { $part } hinein hängen
    .kind = Vom Arbeitsraum abgeschnitten
    .short = { $nearest } ragt aus dem Arbeitsraum
    .compared = ragt aus dem Arbeitsraum
refusal-wrong-place = falscher Platz: { $part } darf nicht an { $place } hängen
    .advice = { $part } an den eigenen Platz hängen, oder es in der Gestelldatei an { $place } zulassen
    .kind = Teil am Platz eines anderen
    .short = { $nearest } darf nicht an { $place } hängen
    .compared = darf nicht an { $place } hängen
refusal-beside-places = { $part } hängt { MM($distance_m, 0) } mm neben { $place }, dem nächsten Platz des Gestells
    .advice = { $part } an einen Platz des Gestells hängen, oder den Platz in der Gestelldatei verschieben
    .kind = Neben den Plätzen des Gestells
    .short = { $nearest } hängt { MM($distance_m, 0) } mm neben { $place }
    .compared = hängt { MM($distance_m, 0) } mm neben { $place }
refusal-turned = { $part } hängt falsch an { $place }: um { DEGREES($turn_rad, 0) }° gedreht, erlaubt sind { DEGREES($limit_rad, 0) }°
    .advice = { $part } richtig herum aufhängen, oder diese Lage in der Gestelldatei zulassen
    .kind = An seinem Platz verdreht
    .short = { $nearest } hängt um { DEGREES($turn_rad, 0) }° gedreht an { $place }
    .compared = um { DEGREES($turn_rad, 0) }° gedreht, erlaubt sind { DEGREES($limit_rad, 0) }°
refusal-unconfirmed = { $part } hat den ähnlichsten Umriss; das Verfahren des Artikels allein kann es nicht von einem unbekannten Teil unterscheiden
    .advice = Auch die Pose schätzen lassen: im Rezept „Pose durch“ auf „Global“ stellen
    .kind = Nur nach dem Verfahren des Artikels, ohne Pose
    .short = Nur der Umriss wurde verglichen
    .next = { step-unconfirmed-next }
    .compared = das Verfahren des Artikels allein kann es nicht von einem unbekannten Teil unterscheiden
refusal-out-of-range = was { $part } sein könnte, ist { FIXED($depth_m, 2) } m von der Kamera entfernt: Tiefenkameras messen von { $from } bis { $to } m
    .advice = Die Einheit der Datei oder der JSON-Datei der Kamera prüfen: Längen sind in Metern; dann erneut aufnehmen
    .kind = Außerhalb des Messbereichs der Kamera
    .short = Es ist zu nah an der Kamera oder zu weit entfernt
    .next = { step-check-camera-next }
refusal-behind-camera = { PERCENT($share, 1) } % der Punkte liegen hinter der Kamera, daher ist nicht bekannt, wo { $part } ist
    .advice = Die Aufnahme im Koordinatensystem der Kamera exportieren: x rechts, y unten, z vorn
    .kind = Punkte hinter der Kamera
    .short = { short-damaged-file }
    .next = { step-check-camera-next }
refusal-surplus-bytes = { $num ->
        [one] nach dem letzten Punkt der Datei folgt { $num } Byte: Sie ist beschädigt und damit auch, was { $part } sein könnte
       *[other] nach dem letzten Punkt der Datei folgen { $num } Bytes: Sie ist beschädigt und damit auch, was { $part } sein könnte
    }
    .advice = Die Datei aus dem Ursprungsprogramm erneut kopieren oder exportieren
    .kind = Datei beschädigt
    .short = { short-damaged-file }
    .next = { step-check-camera-next }
refusal-no-pose = keine Pose gefunden: { $why }
    .kind = Keine Pose gefunden
    .short = Vielleicht { $nearest }, aber keine Pose gefunden
    .step = { step-turn }
    .otherwise = { step-if-it-persists }
refusal-not-steady = { $part } hängt noch nicht still
    .advice = Das Teil eine Sekunde still hängen lassen
    .kind = Hing noch nicht still
    .short = Das Teil hängt noch nicht still
refusal-passing = { $part } läuft auf der Linie vorbei, doch erst { $num_frames } von { $needed } Bildern zeigen das ganze Teil
    .advice = Einen Moment warten
    .kind = Zu wenige Bilder auf der Linie
    .short = Bisher zeigen es zu wenige Bilder
refusal-smeared = { $part } bewegte sich während einer Belichtung um { MM($smear_m, 1) } mm, zulässig sind { MM($limit_m, 1) } mm
    .advice = Die Linie verlangsamen oder die Belichtung der Kamera verkürzen; ist sie kürzer, als die Datei der Linie angibt, dort exposure_ms berichtigen
    .kind = Linie zu schnell für die Belichtung
    .short = Die Linie ist zu schnell für die Belichtung der Kamera
refusal-few-frames = { $part } hängt still, seitdem wurden { $num_frames } von { $needed } Bildern geprüft
    .advice = Einen Moment warten
    .kind = Zu wenige Bilder, seit es still hing
    .short = Bisher zu wenige Bilder geprüft
refusal-too-slow = nicht beurteilt: Dieser Rechner ist zu langsam ({ $num_inspected } von { $num_frames } Bildern geprüft)
    .advice = Ein kleineres Bild oder ein anderes Rezept wählen, weniger Teile suchen (max_parts) oder andere Programme schließen
    .kind = Nicht beurteilt: Rechner zu langsam
    .short = Dieser Rechner ist zu langsam: { $num_inspected } von { $num_frames } Bildern geprüft
refusal-undecided = { $num_agreeing } von { $num_frames } Bildern akzeptieren { $part }, erforderlich sind { $needed }
    .advice = Einen Moment warten; bleibt es dabei, die Sichtseite des Teils zur Kamera drehen und entfernen, was davor steht
    .kind = Zu wenige Bilder akzeptieren das Teil
    .short = { short-undecided }
refusal-poses-apart = die Posen von { $part } liegen in { $num_agreeing } von { $num_frames } Bildern beieinander, erforderlich sind { $needed }
    .advice = Das Teil so aufhängen, dass nichts schwingt, und einen Moment warten; bleibt es dabei, die Sichtseite zur Kamera drehen
    .kind = Posen der Bilder liegen nicht beieinander
    .short = { short-undecided }

## There is no part

refusal-too-few-points = { $found ->
        [one] die Szene hat { $found } Messwert, mindestens { $needed } sind erforderlich
       *[other] die Szene hat { $found } Messwerte, mindestens { $needed } sind erforderlich
    }
    .advice = Prüfen, ob die Kamera angeschlossen, nicht verdeckt und 0.6 bis 3 m vom Teil entfernt ist, dann erneut aufnehmen
    .short = Die Kamera sieht fast nichts
    .step = { step-uncover-camera }
    .otherwise = { step-if-it-persists }
refusal-too-wide = die Szene ist { FIXED($extent_m, 0) } m groß und enthält nichts von der Größe eines Teils
    .advice = „Als Millimeter lesen“ drücken, falls unten angeboten, oder in Metern exportieren; bei einem Tiefenbild metres_per_unit in der JSON-Datei daneben berichtigen
    .short = Die Szene ist viel größer als eine Zelle
    .next = { step-ask }
refusal-only-background = vor dem Hintergrund ist nichts von der Größe eines Teils ({ $planes ->
        [one] 1 Ebene entfernt
       *[other] { $planes } Ebenen entfernt
    }, größter Rest { FIXED($found_m2, 3) } m², erforderlich { FIXED($needed_m2, 3) } m²)
    .advice = { $knows_cell ->
        [true] Das Teil mindestens 10 cm vor der Wand vor die Kamera hängen und erneut aufnehmen; hing es dort, als die leere Zelle aufgenommen wurde, diese ohne das Teil neu aufnehmen
       *[other] Das Teil mindestens 10 cm vor der Wand vor die Kamera hängen und erneut aufnehmen
    }
    .short = Vor der Kamera hängt kein Teil
    .step = { step-hang }
    .otherwise = { $knows_cell ->
        [true] { step-if-it-hangs-there }
       *[other] { "" }
    }
refusal-no-plane = die { $num_points } Punkte des Teils liegen auf einer Linie oder einem Fleck ({ FIXED($width_m, 4) } m breit)
    .advice = Das Teil mit der Sichtseite zur Kamera drehen und erneut aufnehmen
    .short = { short-hardly-seen }
    .step = { step-turn }
    .otherwise = { step-if-it-persists }
refusal-too-large = das Teil ist { FIXED($found_m, 1) } m groß, ein Bild deckt { FIXED($limit_m, 1) } m ab
    .advice = Prüfen, ob die Datei in Metern ist, oder alles außer dem Teil aus der Szene entfernen; bei einem Tiefenbild metres_per_unit in der JSON-Datei daneben berichtigen
    .short = Etwas viel Größeres als ein Teil ist sichtbar
    .step = { step-clear }
    .otherwise = { step-if-it-persists }
refusal-no-shape = das Binärbild enthält keine Form mit einer Fläche ({ $num_set } Pixel gesetzt)
    .advice = Größere Lücken schließen lassen oder das Teil näher an die Kamera bringen und erneut aufnehmen
    .short = { short-hardly-seen }
    .step = { step-nearer }
    .otherwise = { step-if-it-persists }
refusal-no-outline = der Umriss aus { $num_points } Punkten hat keine Länge
    .advice = Das Teil näher an die Kamera bringen und erneut aufnehmen
    .short = { short-hardly-seen }
    .step = { step-nearer }
    .otherwise = { step-if-it-persists }
refusal-empty-library = in der Bibliothek ist kein Teil eingelernt
    .advice = Zuerst ein Teil einlernen, unter „Einlernen“
    .short = { short-no-parts-why }
    .next = { step-ask }
refusal-fault = interner Fehler des Programms: { $message }
    .advice = Die Datei oder das Bild aufbewahren und mit dieser Meldung einsenden; spätere Prüfungen sind nicht betroffen
    .short = { short-fault }
    .next = { step-ask }

## Parts of these texts

model-surface = { MM($relief_m, 1) ->
        [0.0] { "" }
       *[other] Die Oberfläche weicht um { MM($relief_m, 1) } mm ab
    }
model-outline = { MM($outline_m, 1) ->
        [0.0] { "" }
       *[other] { MM($relief_m, 1) ->
            [0.0] Der Umriss weicht um { MM($outline_m, 1) } mm ab
           *[other] der Umriss um { MM($outline_m, 1) } mm
        }
    }
model-missing = { PERCENT($missing, 1) ->
        [0.0] { "" }
       *[other] { PERCENT($missing, 1) } % fehlen
    }
piece-hidden = Entfernen, was vor dem Teil steht, und erneut aufnehmen
piece-outside = Das Teil weiter ins Bild hängen und erneut aufnehmen
piece-hidden-or-outside = Entfernen, was vor dem Teil steht, oder das Teil weiter ins Bild hängen, und erneut aufnehmen
see-an-edge = Das Teil drehen oder die Kamera bewegen, bis eine Ecke oder eine weitere Kante des Teils sichtbar ist, und erneut aufnehmen
scan-poses = Zuerst die Roboterpose jeder Aufnahme und die Hand-Auge-Kalibrierung prüfen, dann erneut scannen; stimmt beides, die Kamera so bewegen, dass sie eine Ecke oder eine weitere Kante des Teils sieht
short-uncertain-pose = Erkannt, aber die Pose ist unsicher
short-damaged-file = Die aufgenommene Datei ist beschädigt
short-undecided = Die Bilder stimmen nicht überein
short-hardly-seen = Zu wenig vom Teil ist sichtbar
short-fault = Das Programm ist an diesem Bild gescheitert
short-no-parts-why = In der Bibliothek ist kein Teil eingelernt
step-unconfirmed-next = Den Einrichter bitten, auch die Pose schätzen zu lassen
step-uncover = Entfernen, was das Teil verdeckt
step-all-in-picture = Die Sichtseite ganz im Bild zur Kamera drehen
step-see-an-edge = Das Teil drehen, bis eine Ecke oder eine weitere Kante sichtbar ist
step-turn = Die Sichtseite zur Kamera drehen
step-clear = Alles außer dem Teil wegnehmen
step-nearer = Das Teil näher an die Kamera hängen
step-scan-again = Das Teil noch einmal scannen, ohne dass sich etwas bewegt
step-hang = Das Teil mindestens 10 cm vor der Wand vor die Kamera hängen
step-uncover-camera = Entfernen, was die Kamera verdeckt
step-if-it-persists = Bleibt es dabei, den Einrichter rufen
step-if-two-alike = Bleibt es dabei, den Einrichter bitten, eines der beiden aus der Bibliothek zu entfernen
step-enrol-if-painted-next = Soll es lackiert werden, den Einrichter bitten, es einzulernen
step-check-camera-next = Den Einrichter bitten, Kamera und Dateien zu prüfen
step-ask = Den Einrichter rufen
step-if-it-hangs-there = Hängt es schon dort, den Einrichter bitten, die leere Zelle neu aufzunehmen
