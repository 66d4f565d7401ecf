## Robot programs
program-files = Roboterprogramme
program-no-nozzle = Ohne die Lage der Düse am Flansch lässt sich die Reichweite nicht prüfen
program-no-nozzle-advice = In Lackieren unter dem Arm eintragen oder keinen Arm wählen
program-stale = Nichts geschrieben: Die Aufnahme ist älter als 10 Minuten
program-stale-advice = Das Teil neu aufnehmen
program-clock-ahead = Nichts geschrieben: Die Aufnahme ist um { $seconds } s später als jetzt datiert, ihr Alter ist also nicht bekannt
program-clock-ahead-advice = Die Uhren dieses Rechners und des Rechners, der die Aufnahme geschrieben hat, nach demselben Zeitserver stellen und das Teil neu aufnehmen
program-ambiguous = Nichts geschrieben: Eine andere Lage des Teils passt ebenso gut
program-ambiguous-advice = Das ganze Teil erneut aufnehmen, damit nur eine Lage passt
program-off-part = Kein Programm geschrieben: Die Lackierbahn zielt nicht auf das Teil (nur bei { $aiming } von { $all } Punkten mit eingeschalteter Pistole)
program-off-part-advice = Prüfen, ob die Bahn zu diesem Teil gehört, oder in Lackieren eine neue planen und speichern
program-not-reached = Kein Programm geschrieben: { $arm } erreicht { $missed } von { $all } Punkten nicht
program-not-reached-advice = Das Teil oder den Fuß des Arms versetzen oder die Bahn ändern
program-film-off-plan = Kein Programm geschrieben: Es brächte { $written } % der Fläche in { $tolerance } % um den Sollwert, im Mittel { $written_um } µm; geplant sind { $planned } % und { $planned_um } µm. Mit offener Pistole hielte es { $stops }-mal an
program-film-off-plan-advice = Die Bahn ohne Züge entlang von Flanken planen (Neigung zu Flanken 0) oder das Programm für eine Steuerung schreiben, die die Pistole während der Bewegung schaltet
program-written = { $path } geschrieben: { $count } Punkte als { $format }
program-written-parts = { $path } und { $parts } Programme geschrieben, die es aufruft: { $count } Punkte als { $format }; die Steuerung braucht sie alle
