# Was an einer Bahn nicht geprüft wurde

unchecked-arm = Reichweite und Kollisionen
    .advice = Ein Programm schreiben und seinen Arm nennen, mit der Pose der Düse am Flansch, oder den ersten Lauf des Roboters bei geringer Geschwindigkeit beobachten
unchecked-moving-part = Reichweite und Kollisionen, weil die Linie das Teil bewegt, während der Roboter arbeitet
    .advice = Das Programm zuerst ohne Lack bei langsamer Linie laufen lassen und den Roboter beobachten
unchecked-surroundings = Kollisionen mit anderem als Teil und Arm, etwa mit der Halterung des Teils
    .advice = Die Kästen und den Boden der Zelle in einer Datei beschreiben oder den ersten Lauf des Roboters bei geringer Geschwindigkeit beobachten
unchecked-film = die Schicht, die das Programm aufträgt, weil die Bahn keine Lackschicht nennt
    .advice = Die Bahn neu planen, damit sie ihre Lackschicht nennt
unchecked-accelerations =
    { $what ->
        [joints] Beschleunigungen der Gelenke
        [rail] Beschleunigung der Schiene
       *[both] Beschleunigungen von Gelenken und Schiene
    }
    .advice = Die Grenzen in der Datei des Arms ergänzen
unchecked-not-seen = der Düsenabstand an { $num } von { $num_points } Punkten, wo die Kamera keine Oberfläche sah
    .advice = Das Teil so aufnehmen, dass die Kamera mehr davon sieht, oder es scannen, falls die Bahn dort auf das Teil zielen soll

not-checked = nicht geprüft: { $what }
