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
