# Outcomes of inspections, estimations and cases, and names of frames

verdict-accepted = Akzeptiert
verdict-not-accepted = Nicht akzeptiert
verdict-unknown = Unbekannt
verdict-no-part = Kein Teil
another-make = { $part }, anderes Fabrikat
another-model = { $part }, anderes Modell
mirror-image = Spiegelbild von { $part }
other-half = Spiegelbild des eingelernten Stücks von { $part }
simulated-frame = simuliertes Bild { $number }
no-more-frames = { $source } hat keine weiteren Bilder
keep-all = Alle
keep-not-accepted = Nicht akzeptierte
keep-none = Keine
frame-loss-disk-full = Datenträger voll
frame-loss-not-writable = nicht schreibbar
frame-loss-slow-disk = Datenträger zu langsam
stopped-converged = konvergiert
stopped-below-target = unter der Schwelle
stopped-iteration-limit = Iterationsgrenze
stopped-no-progress = kein Fortschritt
outcome-right = richtig
outcome-refused = abgewiesen
outcome-wrong-accepted = Falschakzeptanz
no-calibration = Kalibrierung: nichts wurde als Teil erkannt
