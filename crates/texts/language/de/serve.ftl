# The server that robots ask

open-to-network = { $at } ist ohne Verschlüsselung vom Netzwerk erreichbar: Wer es erreicht, kann Prüfungen auslösen und Posen lesen
    .advice = Ein eigenes Netzwerk der Zelle verwenden und in der Firewall nur Roboter und SPS zu diesem Port durchlassen
numbers-not-stored = Nummern von Teilen können nicht gespeichert werden und ändern sich, wenn ein Teil hinzukommt oder wegfällt: { $reason }
