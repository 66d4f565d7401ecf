# Die Kontrolle der Zelle: ihr Ergebnis, und warum Bilder nicht verglichen werden können

cell-in-place = Kamera und Teil sind an ihrem Platz
    .advice = Es ist nichts zu tun
cell-part-moved = das Teil hat sich bewegt, die Kamera nicht
    .advice = Das Teil wie zuvor aufhängen oder seine Halterung prüfen und erneut kontrollieren; soll es so bleiben, einen neuen Ausgangszustand aufnehmen
cell-camera-moved = die Kamera hat sich bewegt
    .advice = Die Kamera befestigen, neu kalibrieren, dann einen neuen Ausgangszustand aufnehmen
cell-part-or-camera-moved = das Teil oder die Kamera hat sich bewegt
    .advice = Das Teil wie zuvor aufhängen und erneut kontrollieren; hilft das nicht, hat sich die Kamera bewegt: Sie neu kalibrieren und einen neuen Ausgangszustand aufnehmen
cell-noisier = Kamera und Teil sind an ihrem Platz, aber die Messwerte rauschen stärker
    .advice = Das Fenster der Kamera reinigen, auf Streulicht oder Nebel davor achten und erneut kontrollieren
cell-no-frame = kein Bild
    .advice = Das Teil für die Zellenkontrolle aufnehmen und die Datei angeben
cell-moving = die Bilder stimmen nicht überein: Das Teil ist in Bild { $frame } um { MM($shift_m, 1) } mm und { DEGREES($turn_rad, 2) }° anders als im ersten
    .advice = Das Teil still hängen lassen, die Kamera nicht bewegen und erneut aufnehmen
cell-other-part = nur { PERCENT($overlap, 0) } % dessen, was in Bild { $frame } zu sehen ist, liegen auf dem Teil des Ausgangszustands
    .advice = Das Teil des Ausgangszustands an seinen üblichen Platz hängen, mit nichts davor; hängt es dort, hat sich Kamera oder Teil um mehrere Zentimeter bewegt
cell-pose = Bild { $frame }: { $why }

cell-calibration = { $name }
cell-unnamed-calibration = eine Kalibrierung ohne Namen ({ $identity })
cell-scan-poses = die Posen des Scans
