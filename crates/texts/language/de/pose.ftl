# Poses

## Why there is no pose

pose-too-few-points = { $found ->
        [one] die Punktwolke ({ cloud-role }) hat { $found } Punkt, mindestens { $needed } sind erforderlich
       *[other] die Punktwolke ({ cloud-role }) hat { $found } Punkte, mindestens { $needed } sind erforderlich
    }
    .advice = Das Teil aus geringerer Entfernung aufnehmen oder neu einlernen
pose-degenerate = die Punktwolke ({ cloud-role }) lässt die Pose offen: Ihre Punkte liegen auf einer Linie oder einem Fleck ({ FIXED($width_m, 5) } m breit)
    .advice = Eine Punktwolke verwenden, die eine Fläche zeigt, keine Linie und keinen einzelnen Fleck
pose-one-sided-pairs = die nächsten Punkte aller { $num_pairs } Paare liegen auf einem Fleck oder einer Linie, Abstand { MM($rms_m, 1) } mm
    .advice = { pose-no-overlap.advice }
pose-no-overlap = { $found ->
        [one] die Punktwolken haben nur { $found } Punktpaar innerhalb von { MM($reach_m, 1) } mm, mindestens { $needed } sind erforderlich
       *[other] die Punktwolken haben nur { $found } Punktpaare innerhalb von { MM($reach_m, 1) } mm, mindestens { $needed } sind erforderlich
    }
    .advice = Prüfen, ob beide Punktwolken dasselbe Teil in Metern zeigen
pose-sizes-differ = eine Punktwolke ist { FIXED($ratio, 0) }-mal so groß wie die andere
    .advice = Beide in Metern exportieren: Eine scheint in Millimetern zu sein
pose-too-far-out = die Punktwolke ({ cloud-role }) liegt { FIXED($distance_m, 0) } m vom Ursprung entfernt, zu weit, um ihre Punkte aufzulösen
    .advice = Vor dem Export von beiden Punktwolken denselben Versatz abziehen
pose-no-reference-cloud = die Referenz ist eine flache Form ohne Punktwolke
    .advice = Das Teil aus einer Aufnahme, einer Punktwolke oder einem Netz einlernen
pose-cancelled = die Schätzung wurde abgebrochen
    .advice = Erneut starten

## Why a pose should not be relied upon

pose-little-overlap = nur { PERCENT($overlap, 0) } % der Quelle liegen auf dem Ziel, mindestens { PERCENT($needed, 0) } % sind erforderlich
    .advice = Prüfen, ob beide Punktwolken dasselbe zeigen und mindestens die Hälfte davon gemeinsam haben
pose-ambiguous = eine andere Pose passt ebenso gut (ihre Kosten sind { FIXED($ratio, 2) }-mal so hoch)
pose-off-scale = was die Kamera sieht, ist { PERCENT($by, 0) } % { $is_larger ->
        [true] größer
       *[false] kleiner
    } als die Referenz
    .advice = Einheit der Tiefenwerte und Brennweiten (fx, fy) der Kamera prüfen: Die Pose ist um ebenso viele Prozent des Abstands falsch
pose-loose = die Pose ist nicht bestimmt: { free-motion }
pose-unsettled = die Pose bewegte sich nach { $num_iterations } Iterationen noch

## Warum es keinen Abstand gibt

stand-off-no-surface = das eingelernte Teil hat keine Oberfläche mit Normalen
stand-off-none-meets = keine der { $num_taught } angenommenen Düsenpositionen zeigt auf das Teil

## Parts of these texts

free-motion = { $motion ->
        [slide] { $axis ->
            [long] verschiebbar entlang der langen Seite
            [short] verschiebbar entlang der kurzen Seite
           *[other] verschiebbar senkrecht zur Oberfläche
        }
        [turn] { $axis ->
            [long] drehbar um die lange Seite
            [short] drehbar um die kurze Seite
           *[other] drehbar um die Achse senkrecht zur Oberfläche
        }
       *[other] verschiebbar oder drehbar
    }
cloud-role = { $which ->
        [source] Quelle
       *[other] Ziel
    }

## Which clouds
pose-onto = { $source } auf { $target }
