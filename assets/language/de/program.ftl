## Robot programs
program-files = Roboterprogramme
program-no-nozzle = Ohne die Lage der Düse am Flansch lässt sich die Reichweite nicht prüfen
program-no-nozzle-advice = In Lackieren unter dem Arm eintragen oder keinen Arm wählen
program-not-written = Kein Programm geschrieben: { $why }
program-written = { $count ->
        [one] { $path } geschrieben: { $count } Punkt als { $format }
       *[other] { $path } geschrieben: { $count } Punkte als { $format }
    }
program-written-parts = { $parts ->
        [one] { $path } und { $parts } Programm geschrieben, das es aufruft: { $count } Punkte als { $format }; die Steuerung braucht beide
       *[other] { $path } und { $parts } Programme geschrieben, die es aufruft: { $count } Punkte als { $format }; die Steuerung braucht sie alle
    }
program-gun-output = Ausgang, der die Pistole öffnet
program-gun-output-help = Nummer des digitalen Ausgangs, der die Pistole öffnet
program-gun-radius = Radius der Pistole
program-gun-radius-help = Radius der Pistole um die Linie vom Flansch zur Düsenmündung; höchstens die halbe Länge der Pistole zählt
program-clearance = Abstand von Pistole und Arm
program-clearance-help = Kleinster Abstand von Pistole und Arm zu Teil, Quadern und Boden
program-speed = Geschwindigkeit, wo die Bahn keine hat
program-speed-help = Geschwindigkeit der Düse, wo die Bahn keine vorgibt
program-approach = An- und Rückzug
program-approach-help = Abstand der Anfahrpunkte vom ersten und letzten Punkt der Bahn
program-blend = Überschleifradius
program-blend-help = Radius, in dem der Roboter Ecken abkürzen darf
program-max-tilt = Neigung der Pistole bei Bedarf, bis
program-max-tilt-help = Größte Neigung der Düse um den Punkt, auf den sie zielt; nur dort, wo der Arm der Bahn sonst nicht folgen kann
