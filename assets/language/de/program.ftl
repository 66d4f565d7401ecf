## Robot programs
program-files = Roboterprogramme
program-no-nozzle = Ohne die Lage der Düse am Flansch lässt sich die Reichweite nicht prüfen
program-no-nozzle-advice = In Lackieren unter dem Arm eintragen oder keinen Arm wählen
program-not-written = Kein Programm geschrieben: { $why }
program-written = { $path } geschrieben: { $count } Punkte als { $format }
program-written-parts = { $path } und { $parts } Programme geschrieben, die es aufruft: { $count } Punkte als { $format }; die Steuerung braucht sie alle
