# Was vor der Kamera hängen soll

expect-title = Erwartet
expect-anything = Jedes Teil
expect-at-place = { $part } ({ $place })
expect-not-known = Unbekannt
expect-says = Welche Teile dort hängen sollen: ein anderes wird abgelehnt, und was fehlt, wird angezeigt
expect-one-more = Eines mehr
expect-one-less = Eines weniger
expect-elsewhere-heading = An jedem anderen Platz
expect-as-recipe = Wie im Rezept { $recipe }
expect-orders = Aufträge…
expect-orders-says = Eine Tabelle (CSV) der Aufträge mit den Teilen, die dafür dort hängen
expect-by-orders = Nach Auftragstabelle
expect-close-orders = Tabelle schließen
expect-table = Auftragstabelle
expect-table-used = Was erwartet wird, steht in { $file }
expect-table-unusable = Die Auftragstabelle ist nicht verwendbar: { $error }
expect-reading = Die Auftragstabelle { $file } wird gelesen
expect-watching = Auftragstabelle wird beobachtet

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
