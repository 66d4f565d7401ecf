## The case in front
compare-case = Fall
compare-case-hint = Welche Szene betrachtet wird
compare-no-case = keiner
compare-in-front = { $scene } (angezeigt)
compare-kept-cases = Gespeicherte Fälle
compare-no-cases-listed = Noch keine
compare-asked = welches Teil ist es?
compare-taken-for = erkannt als
compare-nearest-to = am nächsten
compare-nothing = nichts
compare-accepted-asked = akzeptiert · welches Teil ist es?
compare-not-accepted-asked = nicht akzeptiert · welches Teil ist es?
compare-accepted-right = akzeptiert, und es ist
compare-not-accepted-right = nicht akzeptiert, und es ist
compare-accepted-wrong = akzeptiert, es ist aber
compare-not-accepted-wrong = nicht akzeptiert, es ist aber
compare-choose-truth = Auswählen…
compare-truth-hint = Was tatsächlich vor der Kamera hing
compare-against = verglichen mit
compare-against-none = kein Teil
compare-against-hint = Das eingelernte Teil, mit dem der Fall verglichen wird
compare-against-follows = Das tatsächliche, sonst das beste
compare-against-choice = Verglichen mit: { $part }
compare-keep-case = Fall speichern
compare-keep-case-hint = Diese Szene mit ihrem tatsächlichen Teil speichern
compare-keep-case-first = Zuerst auswählen, was es ist
compare-kept-case = Gespeicherter Fall
compare-remove-case = Fall entfernen
compare-run-all = Alle Fälle prüfen
compare-run-all-hint = Jeden gespeicherten Fall mit dem Rezept rechts prüfen
compare-undo-keep = Speichern rückgängig
compare-undo-removal = Fall zurückholen
compare-undo-truth = Tatsächliches Teil rückgängig
compare-undo-recipe = Rezept zurückholen
compare-undo-use = Verwenden rückgängig
compare-undo-open = Öffnen rückgängig

## The pictures
compare-nothing-to-compare = Noch nichts zu vergleichen
compare-nothing-to-compare-advice = Eine Szene aufnehmen (Leertaste), eine öffnen oder einen gespeicherten Fall öffnen
compare-no-outline = Es gibt keinen Umriss zum Vergleichen: { $reason }
compare-no-outline-reason = kein Umriss
compare-contours = Konturen beim besten Lag
compare-signatures-default = Szene und Teil, Teil um den Lag verschoben
compare-signatures-paper = wie im Artikel: ohne Lag, Θ gefaltet
compare-correlations = Auto- und Kreuzkorrelation
compare-correlations-default = Standard: findet den Lag · ‖A − C‖₁ { $share } von ‖A‖₁ · Achse nicht ab 0
compare-correlations-paper = Artikel: ‖A − C‖₁ { $value } px² + rad² · { $share } von ‖A‖₁
compare-no-lag = kein Lag gefunden
compare-overlay = Lag { $lag } von { $rays } · gedreht { $angle } · Abstand { $distance }
compare-legend-query = — Szene
compare-rays = Strahlen, m²
compare-lag-zero-rays = Lag 0, in Strahlen
compare-lag-zero-pixels = Lag 0, in Pixeln
compare-lag-read = Lag { $lag }: A { $auto }, C { $cross }
compare-auto = A: selbst
compare-cross = C: Szene

## The distances
compare-distances = Abstand je Teil
compare-distances-none = Benötigt einen Umriss
compare-distance-default = Standard: Abstand der Umrisse
compare-distance-paper = Artikel: ‖A − C‖₁, px² + rad²
compare-distance-in-use = { $name } (aktiv)
compare-distance-paper-hint = Die Größe des Artikels (Gl. 11): Summe der Unterschiede der Korrelationen, der Längen in Quadratpixeln und der Winkel in Quadratradiant
compare-compare-with = Vergleichen mit { $part }: { $figures }
compare-distance-hint = Abstand der Umrisse { $outline } (Standard) · ‖A − C‖₁ { $paper } px² + rad² (Artikel) · Score am Ende { $score }

## The kept cases
compare-all-cases = Gespeicherte Fälle
compare-looking = Gespeicherte Fälle werden gesucht
compare-no-cases-in = Keine gespeicherten Fälle in { $folder }
compare-no-cases = Noch keine gespeicherten Fälle
compare-no-cases-advice = Eine Szene aufnehmen, auswählen, was es ist, und „Fall speichern“ drücken; gespeicherte Fälle zeigen, was ein anderes Rezept verbessert und was es verschlechtert
compare-folder = Ordner…
compare-folder-of-cases = Ordner der Fälle…
compare-back = Zur Matrix
compare-earlier = Früherer Lauf…
compare-earlier-label = Mit einem früheren Lauf vergleichen…
compare-earlier-hint = Vergleichen mit dem, was partsight evaluate --json von einem früheren Lauf geschrieben hat
compare-ran-at = um { $time }
compare-false-accepts =
    { $count ->
        [0] keine Falschakzeptanz
        [one] 1 Falschakzeptanz
       *[other] { $count } Falschakzeptanzen
    }
compare-tally =
    { $right } von { $total } richtig · { $refused ->
        [0] keiner
       *[other] { $refused }
    } zu Unrecht abgewiesen
compare-num-unreadable = { $count } nicht lesbar
compare-run-running = läuft, { $done } von { $total } fertig
compare-run-stopped = abgebrochen, { $done } von { $total } fertig
compare-other-recipe = mit einem anderen Rezept
compare-run-covers = veraltet: { $done } von { $total } gespeicherten Fällen
compare-cases-removed = veraltet: ein Fall wurde entfernt
compare-running = Läuft
compare-run-hint = „Alle Fälle prüfen“ (Strg R) zeigt, als was jeder jetzt erkannt wird
compare-it-is = es ist: { $part }
compare-cell-taken-for = { $truth } erkannt als { $part }: { $count }
compare-cell-not-accepted = { $truth }, nicht akzeptiert: { $count }
compare-open-case = { $name } öffnen
compare-open-case-hint = Diesen Fall anzeigen
compare-remove-named = { $name } entfernen
compare-cell-refused = zu Unrecht abgewiesen
compare-matrix-hint = Zeilen: was es ist · Spalten: als was es akzeptiert wurde · eine Zelle öffnet ihre Fälle

## Changes since an earlier run
compare-num-worse =
    { $count ->
        [0] keiner schlechter
       *[other] { $count } schlechter
    }
compare-num-better = { $count } besser
compare-num-rescored = { $count } mit anderem Score
compare-num-common = { $count ->
        [one] { $count } Fall in beiden
       *[other] { $count } Fälle in beiden
    }
compare-num-new = { $count } neu
compare-num-gone = { $count } fehlend oder beschädigt
compare-against-file = gegenüber { $file }
compare-no-changes = Jeder Fall beider Läufe endete wie zuvor
compare-worse = schlechter
compare-better = besser
compare-change-same = { $change }: { $before } → { $now }
compare-change = { $change }: { $is }, vorher { $was } · { $before } → { $now }

## The recipe
compare-recipe-named = Rezept { $recipe }
compare-built-in-hint = Alle Parameter auf Vorgabewert
compare-is-default = Standard
compare-duplicate = Duplizieren
compare-rename = Umbenennen…
compare-delete = Löschen
compare-set-default = Als Standard festlegen
compare-built-in-stays = Eingebaute Rezepte lassen sich nicht ändern
compare-nothing-to-save = Seit dem Speichern hat sich nichts geändert
compare-not-kept = Es ist nicht unter den gespeicherten Rezepten
compare-default-already = Es ist bereits der Standard
compare-import = Importieren…
compare-take-rename = Ändern
compare-name-hint = Name
compare-name = Name des Rezepts
compare-save-name = Unter diesem Namen speichern
compare-rename-name = In diesen Namen umbenennen
compare-cancel-name = Namenseingabe abbrechen
compare-replace-title = Rezept { $name } ersetzen?
compare-replace-why = Ein anderes Programm hat es geändert, während es hier ausprobiert wurde; dessen Fassung ginge verloren
compare-replace = Ersetzen
compare-expects = Erwartet { $parts }
compare-num-changed = { $count } geändert
compare-list-changes = Anzeigen
compare-reset-all = Zurücksetzen
compare-reset-all-hint = Alle Parameter auf ihren Vorgabewert zurücksetzen
compare-parameter-change = { $parameter }: { $value } (Vorgabe: { $default })
compare-scaling = Skalierung: ein Kern oder mehrere
compare-more-changed = Mehr zu { $group } ({ $count }, { $changed } geändert)
compare-case-is-pending = Ergebnis mit diesem Rezept…
compare-case-is = Ergebnis mit diesem Rezept
compare-verdict-nearest = Nicht akzeptiert · am nächsten { $part } { $score }
compare-verdict-nothing = Nicht akzeptiert · kein Teil gefunden
compare-right-accepted = Richtig und akzeptiert
compare-rightly-refused = Zu Recht abgewiesen
compare-truth-not-set = Das tatsächliche Teil ist nicht angegeben
compare-use = Dieses Rezept verwenden
compare-use-hint = Ab jetzt werden Szenen damit geprüft
compare-in-use-hint = Szenen werden bereits mit diesem Rezept geprüft

## Why a case is refused
compare-refused = Abgewiesen: { $reason }
compare-refused-apart = Abgewiesen: { $reason }; Abstand der Umrisse { $distance }

## The plots
compare-calibration = Kalibrierung
compare-calibration-caption = richtig über Score · Fehler { $error }
compare-calibration-caption-none = richtig über Score
compare-calibration-hint = Die jeweils beste Vermutung aller Fälle nach Score: Auf der Linie stimmt ein Score von 0.9 in neun von zehn Fällen. Die Zahlen geben an, wie viele Vermutungen es sind
compare-calibration-bin = { $from } bis { $to }, { $right } von { $count } richtig
compare-calibration-words = Kalibrierung: erwarteter Fehler { $error }; { $bins }
compare-threshold = Schwelle
compare-threshold-caption = Anteil über Mindestscore
compare-threshold-words = Schwelle: bei { $threshold } akzeptiert der Score allein { $wrong } von { $cases } Fällen fälschlich und weist { $refused } von { $enrolled } Teilen ab
compare-threshold-hint = Was jeder Mindestscore von allen Fällen fälschlich akzeptieren und von den eingelernten Teilen abweisen würde, allein nach dem Score. Die senkrechte Linie ist die des Rezepts
compare-plot-false-accepts = Falschakzeptanz
compare-plot-refused = abgewiesene Teile
compare-scaling-says = Ordnet 8 bis 2048 simulierte Referenzen nach Ähnlichkeit zu einer Szene, mit 1, 2, 4 und 8 Threads; dauert einige Sekunden
compare-measure = Messen
compare-measure-label = Skalierung messen
compare-scaling-cores = { $cores ->
        [one] { $cores } Kern
       *[other] { $cores } Kerne
    }
compare-scaling-cores-shared = { $cores ->
        [one] { $cores } Kern; ab { $workers } Threads wird er geteilt
       *[other] { $cores } Kerne; ab { $workers } Threads werden sie geteilt
    }
compare-scaling-from = { $count ->
        [one] { $cores }: mehrere lohnen sich ab { $count } Referenz
       *[other] { $cores }: mehrere lohnen sich ab { $count } Referenzen
    }
compare-scaling-never = { $cores }: mehrere lohnten sich nie
compare-scaling-plot = Dauer der Rangliste über der Zahl der Referenzen; { $words }
compare-one-worker = 1 Thread

## Keys
compare-key-keep = Angezeigten Fall speichern
compare-key-run = Alle gespeicherten Fälle prüfen
compare-key-undo = Speichern oder Entfernen eines Falls, Angabe seines tatsächlichen Teils, Löschen, Verwenden oder Öffnen eines Rezepts zurücknehmen

## Work and notices
compare-cases-title = Ordner der gespeicherten Fälle
compare-earlier-title = Ausgabe von partsight evaluate --json
compare-evaluation-files = Auswertungen
compare-recipe-files = Rezepte
compare-import-title = Zu importierendes Rezept
compare-export-title = Rezept exportieren
compare-comparing = Vergleich läuft
compare-listing-cases = Gespeicherte Fälle werden gelesen
compare-keeping-case = Fall wird gespeichert
compare-removing-case = Fall wird entfernt
compare-restoring-case = Fall wird zurückgeholt
compare-saving-truth = Tatsächliches Teil wird gespeichert
compare-running-cases = Gespeicherte Fälle werden geprüft
compare-measuring = Dauer der Rangliste wird gemessen
compare-comparing-earlier = Vergleich mit einem früheren Lauf
compare-changing-recipes = Rezepte werden geändert
compare-inspecting = Prüfung mit einem anderen Rezept
compare-nothing-to-keep = Noch kein Fall zum Speichern
compare-nothing-to-keep-advice = Eine Szene aufnehmen oder öffnen und warten, bis sie geprüft ist
compare-kept-already = Dieser Fall ist bereits gespeichert
compare-kept-already-advice = Eine andere Szene aufnehmen oder öffnen
compare-no-truth = Ein Fall ohne tatsächliches Teil ist wertlos
compare-no-cases-to-run = Es gibt keine gespeicherten Fälle zum Prüfen
compare-no-cases-to-run-advice = Zuerst einen Fall speichern oder einen Ordner mit Fällen wählen
compare-no-run = Es gibt keinen Lauf zum Vergleich mit einem früheren
compare-no-run-advice = Zuerst alle Fälle prüfen
compare-kept-as = Gespeichert als { $name }
compare-removed-case = { $name } entfernt; der Eintrag im Verlauf bleibt, wie er ist
compare-restored-case = { $name } ist wieder da
compare-truth-saved = Tatsächliches Teil von { $name } gespeichert; der Eintrag im Verlauf bleibt, wie er ist
compare-case-gone = Es gibt keinen gespeicherten Fall namens { $name } mehr
compare-case-gone-advice = Alle Fälle erneut prüfen
compare-front-gone = Der gespeicherte Fall { $name } fehlt oder ist beschädigt
compare-front-gone-advice = Stattdessen wird die zuletzt geprüfte Szene gezeigt; zum erneuten Vergleichen den Fall in seinen Ordner zurückkopieren
compare-recipe-changed-elsewhere = Rezept { $name } wurde von einem anderen Programm geändert
compare-recipe-changed-elsewhere-advice = Zum Verwenden in „Vergleich“ öffnen; bis dahin gelten die bisherigen Parameter
compare-tried-changed-elsewhere-advice = Zum Ausprobieren dieser Fassung erneut öffnen; vor dem Ersetzen durch die eigene wird gefragt
compare-recipe-gone = Rezept { $name } ist nicht mehr unter den gespeicherten Rezepten
compare-recipe-gone-advice = Ein anderes Programm hat es umbenannt oder gelöscht: seine Parameter in „Vergleich“ unter einem Namen speichern oder ein anderes Rezept öffnen
compare-saved-recipe = Rezept { $name } gespeichert
compare-restored-recipe = Rezept { $name } ist wieder da
compare-renamed-recipe = Rezept { $before } heißt jetzt { $now }
compare-removed-recipe = Rezept { $name } gelöscht
compare-default-recipe = Befehle ohne --recipe verwenden jetzt „{ $name }“
compare-imported-recipe = Rezept { $name } importiert
compare-recipe-used =
    Szenen werden jetzt mit Rezept { $recipe } geprüft: { $count ->
        [one] { $count } Parameter weicht
       *[other] { $count } Parameter weichen
    } von der Vorgabe ab
