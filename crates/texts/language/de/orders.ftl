# Warum eine Auftragstabelle nicht gelesen werden kann

orders-file = { $what }
    .advice = { $is_damaged ->
        [true] { $to_do }; eine Tabellenkalkulation speichert eine Tabelle als CSV UTF-8
       *[false] { $to_do }
    }
orders-column = { $path }, Zeile 1: { $found } Spalten heißen { $column }
    .advice = Die Spalten in der ersten Zeile order, serial und parts nennen; serial kann fehlen
orders-none = { $path }: die Tabelle hat keine Aufträge
    .advice = Unter der ersten Zeile eine Zeile für jeden Auftrag einfügen
orders-cell = { $path }, Zeile { $line }, Spalte { $column }: { $why }

## Was an einer Zelle falsch ist

orders-empty = die Zelle ist leer
    .advice = Die Zelle ausfüllen oder die Zeile löschen
orders-not-one-line = die Zelle hat Zeilenumbrüche oder mehr als { $limit } Zeichen
    .advice = Sie kürzen; davor nach einem fehlenden Anführungszeichen suchen
orders-again = Auftrag und Seriennummer sind die der Zeile { $first }
    .advice = Alle Teile, die zusammen hängen, in eine Zeile schreiben

## Warum nicht bekannt ist, was ein Auftrag erwartet

order-too-long = Auftrag oder Seriennummer haben mehr als { $limit } Zeichen oder Zeilenumbrüche
    .advice = Prüfen, was gescannt wurde
order-not-given = es ist kein Auftrag eingegeben
    .advice = Den Auftrag eingeben oder scannen
order-unknown-order = Auftrag { $order } steht nicht in der Auftragstabelle
    .advice = Den Auftrag prüfen oder die Tabelle ergänzen lassen
order-unknown-serial = Seriennummer { $serial } steht nicht in der Auftragstabelle
    .advice = Die Seriennummer prüfen oder die Tabelle ergänzen lassen
order-serial-not-given = Auftrag { $order } unterscheidet sich je Seriennummer
    .advice = Die Seriennummer scannen
order-other-order = Seriennummer { $serial } gehört zu Auftrag { $other }, nicht { $order }
    .advice = Auftrag und Seriennummer prüfen
order-several = mehrere Aufträge haben die Seriennummer { $serial }
    .advice = { order-not-given.advice }
