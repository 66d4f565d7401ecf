# Quader in Dateien

box-number = { $field } von { $name } ist { $found }
    .advice = Die Zahlen berichtigen
box-thin = keine Seite von { $name } ist mindestens { $least } mm lang: size_mm ist { $found }
    .advice = Die Seiten in Millimetern angeben

# Warum ein Gestell nicht gelesen, geschrieben oder benutzt werden kann

rack-file = { $what }
    .advice = { $to_do }
rack-garbled = { $path } ist kein Gestell: { $why }
    .advice = Die Datei berichtigen; das Handbuch zeigt eine (docs/guide/racks.md)
rack-not-enrolled = Platz „{ $place }“ des Gestells ist für { $name }, das nicht eingelernt ist
    .advice = Das Teil einlernen oder seinen Namen am Platz berichtigen
rack-not-calibrated = das Gestell ist im Basissystem des Roboters angegeben, und die Zelle ist nicht kalibriert
    .advice = Die Zelle kalibrieren oder das Gestell im Kamerasystem angeben

## Was daran falsch ist

rack-toml = { $what }
rack-boxes = { $found } Quader des Arbeitsraums, höchstens { $limit } erwartet
rack-places = { $found } Plätze, höchstens { $limit } erwartet
rack-empty = weder ein Arbeitsraum noch ein Platz
rack-name = { $is_place ->
        [true] der Name eines Platzes muss 1 bis { $limit } druckbare Zeichen haben
       *[false] sein Name muss 1 bis { $limit } druckbare Zeichen haben
    }
rack-same-name = zwei Plätze heißen „{ $place }“
rack-overlap = die Plätze „{ $place }“ und „{ $over }“ überschneiden sich
rack-max-turn = max_turn_deg des Platzes „{ $place }“ ist { $found }, erwartet wird mehr als 0, bis 180
