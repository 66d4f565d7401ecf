# The 3-D view and the plots
view-segments = Segmente
view-height = Höhe
view-deviation = Abweichung
view-plain = Einfarbig
view-height-scale = Höhe, mm
view-deviation-scale = Abweichung, mm
view-measure-first = Messen: einen Punkt der Punktwolke anklicken
view-measure-second = Messen: einen zweiten Punkt anklicken
view-keys = 3D-Ansicht. Pfeiltasten drehen, mit Umschalt verschieben sie, Plus und Minus zoomen, F passt ein, X, Y und Z blicken entlang einer Achse, M misst
view-no-view = Keine 3D-Ansicht
view-ray = Strahl { $place }: Anfrage { $query }, Teil { $part } { $unit }
