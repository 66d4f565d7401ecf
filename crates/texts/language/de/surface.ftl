# Oberflächen

## Verdicts

surface-ok = IO
surface-not-judged = nicht beurteilt
surface-rework = Nacharbeit
surface-scrap = Ausschuss

## What a region is

region-dent = Delle
region-bump = Beule nach außen
region-missing = fehlende Oberfläche

## Why a surface is not judged

surface-little-in-sight = nur { PERCENT($seen, 0) } % dieser Seite des Teils sind gut genug zu sehen, { PERCENT($needed, 0) } % sind erforderlich
    .advice = Das Teil zur Kamera drehen und ganz ins Bild bringen
surface-too-far = aus { FIXED($distance_m, 1) } m sind nur Abweichungen über { MM($certain_m, 1) } mm sicher, { MM($needed_m, 1) } mm sollen gefunden werden
    .advice = Die Kamera auf { FIXED($nearer_m, 1) } m an das Teil heranfahren
surface-too-noisy = { $num_frames ->
        [1] in einem Bild
       *[other] in { $num_frames } gemittelten Bildern
    } sind nur Abweichungen über { MM($certain_m, 1) } mm sicher, { MM($needed_m, 1) } mm sollen gefunden werden
    .advice = Mehr Bilder des stehenden Teils mitteln, es aus gemittelten Bildern oder seinem CAD-Netz einlernen oder eine größere Toleranz zulassen
deviation-no-picture = die Messwerte sind kein Bild einer bekannten Kamera
    .advice = Die Oberfläche in einem Tiefenbild oder einer organisierten Punktwolke prüfen
deviation-frames-differ = die zu mittelnden Bilder haben verschiedene Größen oder sind von verschiedenen Kameras
    .advice = Bilder mitteln, die eine Kamera vom Teil aufnahm, während beide stillstanden
deviation-moved = zwischen den zu mittelnden Bildern hat sich das Teil um { MM($by_m, 1) } mm bewegt, höchstens { MM($limit_m, 1) } mm sind zulässig
    .advice = Bilder eines Teils mitteln, das ruhig hängt
deviation-no-surface = die Referenz hat keine Oberfläche mit Normalen
    .advice = Das Teil aus einer Aufnahme, einer Punktwolke oder einem Netz einlernen
deviation-little-seen = nur { PERCENT($seen, 0) } % der Referenz sind gut genug zu sehen, um gemessen zu werden, { PERCENT($needed, 0) } % sind erforderlich
    .advice = Das Teil zur Kamera drehen und ganz ins Bild bringen
