# Was vor der Kamera hängen soll

expect-title = Erwartet
expect-anything = Jedes Teil
expect-at-place = { $part } ({ $place })
expect-not-known = Unbekannt
expect-says = Welche Teile dort hängen sollen: ein anderes wird abgelehnt, und was fehlt, wird angezeigt
expect-one-more = Eines mehr
expect-one-less = Eines weniger
expect-orders = Aufträge…
expect-orders-says = Eine Tabelle (CSV) der Aufträge mit den Teilen, die dafür dort hängen
expect-by-orders = Nach Auftragstabelle
expect-close-orders = Tabelle schließen
expect-table = Auftragstabelle
expect-table-used = Was erwartet wird, steht in { $file }
expect-table-unusable = Die Auftragstabelle ist nicht verwendbar: { $error }
expect-reading = Die Auftragstabelle { $file } wird gelesen
expect-watching = Auftragstabelle wird beobachtet

## Warum es nicht bekannt ist

expect-not-given = Es ist kein Auftrag eingegeben
expect-unknown-order = Auftrag { $order } steht nicht in der Auftragstabelle
expect-unknown-serial = Seriennummer { $serial } steht nicht in der Auftragstabelle
expect-serial-not-given = Auftrag { $order } unterscheidet sich je Seriennummer
expect-other-order = Seriennummer { $serial } gehört zu Auftrag { $other }, nicht { $order }
expect-several-orders = Mehrere Aufträge haben die Seriennummer { $serial }
expect-give-order = Den Auftrag eingeben oder scannen
expect-give-serial = Die Seriennummer scannen
expect-check-order = Den Auftrag prüfen oder die Tabelle ergänzen lassen
expect-check-serial = Die Seriennummer prüfen oder die Tabelle ergänzen lassen
expect-check-both = Auftrag und Seriennummer prüfen

## Das Ergebnis

expect-num-met = { $num } von { $all } wie erwartet
expect-is-met-and-posed = Wie erwartet, und seine Lage ist bekannt
expect-missing = Es fehlt: { $parts }
expect-wrong = Falsches Teil: { $part } statt { $expected }
expect-elsewhere = Falscher Platz: { $part }, erwartet an { $place }
expect-surplus = Nicht erwartet: { $part }
expect-of-order = Auftrag { $order }: { $says }
expect-hang-missing = Die fehlenden Teile aufhängen und neu aufnehmen, oder die Erwartung berichtigen
expect-as-expected = wie erwartet
expect-wrong-part = falsches Teil
expect-wrong-place = falscher Platz
expect-not-expected = nicht erwartet
expect-is-missing = fehlt
expect-nothing-hangs = Hängt nicht dort
