## The list
history-empty-advice = „Aufnehmen“ drücken: Jede Prüfung erscheint hier und bleibt nach dem Schließen des Fensters erhalten
history-in-memory = Nur im Arbeitsspeicher: { $reason }
history-none-listed = Keine passenden Prüfungen: Filter ändern
history-column-score = Score
history-column-ms = ms
history-column-time = Zeitpunkt
history-part-again = { $part } · { $count }× erneut
history-row =
    { $count ->
        [0] Prüfung { $number }: { $part }, { $verdict }
        [one] Prüfung { $number }: { $part }, { $verdict }, einmal erneut geprüft
       *[other] Prüfung { $number }: { $part }, { $verdict }, { $count }-mal erneut geprüft
    }

## The bar above the list
history-show-all = Alle zeigen
history-counted = { $count ->
        [one] { $matching } von { $count } Eintrag
       *[other] { $matching } von { $count } Einträgen
    }
history-export-csv-hint = Die angezeigten Prüfungen in eine Tabelle schreiben
history-export-cases = Fälle exportieren…
history-export-cases-hint = Die angezeigten Prüfungen, zu denen es ein Bild und ein tatsächliches Teil gibt, als Fälle für „Vergleich“ und partsight evaluate speichern
history-statistics = Statistik
history-statistics-hint = IO und NIO nach Schicht, Teil und Grund, für die angezeigten Prüfungen; simulierte Bilder nur, wo sonst nichts angezeigt wird
history-frames-button = Bilder…
history-frames-button-hint = Welche Bilder wie lange aufbewahrt werden
history-find = Suchen
history-find-hint = Teil, Serien-Nr., Szene
history-filter-days = Tage
history-filter-all-verdicts = Alle
history-filter-all-parts = Alle
history-days-all = Alle Tage
history-days-week = 7 Tage
history-days-month = 30 Tage
history-days-typed = Von … bis
history-from = von
history-to = bis
history-first-day = Erster Tag
history-last-day = Letzter Tag
history-day-format = Datum als Jahr-Monat-Tag schreiben: 2026-11-20

## The inspection on the right
history-choose = Prüfung auswählen, um mehr zu sehen
history-inspection = Prüfung { $number }
history-no-picture = Die Szene hat keine Zeilen und Spalten, daher gibt es kein Bild
history-picture = Segmentierung der Prüfung { $number }
history-of-part = Prüfungen dieses Teils
history-counts = zählt
history-of-this-part = Dieses Teil: Prüfung { $number }, { $verdict }
history-found-same = Prüfung { $number }: gleiches Ergebnis
history-found-other = Prüfung { $number }: anderes Ergebnis
history-figure-source = Quelle
history-figure-time = Zeitpunkt
history-figure-serial = Seriennummer
history-figure-score = Score
history-figure-margin = Vorsprung
history-figure-library = Bibliothek
history-figure-program = Programm
history-figure-frame = Bild
history-figure-verdict = Ergebnis
history-figure-nearest = am nächsten
history-frame-not-kept = nicht aufbewahrt
history-frame-lost = fehlt: { $why }
history-frame-kept = aufbewahrt, { $megabytes } MB
history-rz = rz, aus Rz·Ry·Rx
history-stage-segment = Segmentierung
history-stage-project = Projektion
history-stage-contour = Kontur
history-stage-signature = Signatur
history-stage-rank = Rangliste
history-stage-pose = Pose
history-stage-total = gesamt
history-times = Zeiten
history-open = Öffnen
history-open-hint = Mit allen Stufen öffnen, mit dem eigenen Rezept der Prüfung
history-again = Erneut prüfen
history-again-hint = Mit dem aktuellen Rezept und der aktuellen Bibliothek; Änderungen werden hier angezeigt
history-frame-gone = Das Bild zu „{ $scene }“ wurde nicht aufbewahrt
history-frame-gone-advice = Künftig mehr Bilder aufbewahren: „Bilder…“ über der Liste
history-actual-part = Tatsächliches Teil
history-labelled = Im Verlauf gespeichert. Tatsächliches Teil: { $part }
history-label-undone = Rückgängig gemacht: das tatsächliche Teil ist wie vorher
history-remark = Bemerkung
history-your-remark = Eigene Bemerkung

## What differs
history-differences = Erneut geprüft
history-same-today = Heute gleiches Ergebnis
history-other-today = Heute anderes Ergebnis
history-then = damals
history-today = heute
history-pose-differs = Die Pose weicht um { $shift } und { $rotation } ab

## Keys
history-key-newer = Die neuere Prüfung
history-key-older = Die ältere Prüfung
history-key-open = Mit allen Stufen öffnen
history-key-again = Mit aktuellem Rezept und aktueller Bibliothek erneut prüfen

## Frames to keep
history-keep-title = Aufbewahrte Bilder
history-keep-why = Mit ihrem Bild lässt sich eine Prüfung später mit allen Stufen öffnen. Die Prüfungen selbst bleiben dauerhaft erhalten. „Nicht akzeptierte“ behält auch die Bilder der letzten { $num } akzeptierten Teile, damit ein falsches später gekennzeichnet werden kann.
history-keep-which = Von welchen Prüfungen
history-keep-days = Höchstens, Tage
history-keep-gigabytes = Höchstens, Gigabyte
history-keep-used =
    Jetzt: { $count ->
        [one] 1 Bild
       *[other] { $count } Bilder
    }, { $size }. Die ältesten werden zuerst gelöscht
history-keep-marked = Solche mit Bemerkung oder tatsächlichem Teil bleiben erhalten: { $size }

## Statistics
history-none-counted = Keine passenden Teile: Filter ändern
history-by-part = Nach Teil
history-by-rack = Nach Gestell
history-by-reason = Nach Grund
history-ok-share = IO, %
history-shift = Schicht vom { $start }: { $ok } IO, { $nok } NIO
history-by-shift = Teile nach Schicht
history-not-ok-on-top = NIO, oben
history-total = { $count ->
        [one] { $count } Teil, { $share } IO
       *[other] { $count } Teile, { $share } IO
    }
history-total-of-shifts = { $count ->
        [one] { $shifts } Schichten: { $count } Teil, { $share } IO
       *[other] { $shifts } Schichten: { $count } Teile, { $share } IO
    }
history-others-left-out =
    { $count ->
        [one] 1 Teil anderer Quellen ist nicht mitgezählt
       *[other] { $count } Teile anderer Quellen sind nicht mitgezählt
    }
history-no-part-left-out =
    { $count ->
        [one] 1 Eintrag ohne Teil ist nicht mitgezählt
       *[other] { $count } Einträge ohne Teil sind nicht mitgezählt
    }
history-not-judged-left-out =
    { $count ->
        [one] 1 Teil wurde nicht beurteilt und ist nicht mitgezählt: zu wenige seiner Bilder wurden geprüft
       *[other] { $count } Teile wurden nicht beurteilt und sind nicht mitgezählt: zu wenige ihrer Bilder wurden geprüft
    }
history-drift = Verlauf der Messwerte: { $part }
history-drift-needs = Der Verlauf der Messwerte wird für ein Teil gezeigt, das mindestens { $count }-mal akzeptiert wurde
history-drift-shift-bound = Schranke des Positionsfehlers, 95 %
history-drift-fit = Abweichung von der Referenz, rms
history-drift-place-along = Lage des Teils entlang { $axis }
history-drift-mean = Mittelwert
history-drift-limit = Grenze
history-drift-band = { $name }: Mittelwert { $mean }, 3σ von { $from } bis { $to }
history-drift-band-limit = { $name }: Mittelwert { $mean }, 3σ von { $from } bis { $to }, Grenze { $limit }
history-drift-place = Lage des Teils, Mittelwert ± 3σ: x { $x }, y { $y }, z { $z }
history-drift-trend = { $name }: Trend von { $from } bis { $to } über die neuesten { $count } Prüfungen
history-drift-warning =
    { $count ->
        [0] { $part } driftet: Bei diesem Trend werden ab jetzt einzelne Teile abgewiesen ({ $name }, Grenze { $limit })
        [one] { $part } driftet: Bei diesem Trend werden nach 1 weiteren Prüfung einzelne Teile abgewiesen ({ $name }, Grenze { $limit })
       *[other] { $part } driftet: Bei diesem Trend werden nach { $count } weiteren Prüfungen einzelne Teile abgewiesen ({ $name }, Grenze { $limit })
    }
history-drift-warning-advice = Vorher die Ursache suchen: das Fenster der Kamera reinigen, dann die Zelle (Roboter…, Zellenkontrolle), die Gehänge und die Teile prüfen

## Work and notices
history-looking = Verlauf wird gelesen
history-export-csv-title = Angezeigte Prüfungen exportieren
history-export-cases-title = Ordner für die Fälle der angezeigten Prüfungen
history-wrote =
    { $count ->
        [one] Eine Prüfung
       *[other] { $count } Prüfungen
    } nach { $path } geschrieben
history-no-cases = Aus keiner Prüfung wurde ein Fall: { $what }
history-no-cases-advice = Für einige Prüfungen das tatsächliche Teil angeben und ihre Bilder aufbewahren
history-wrote-cases = { $path }: { $what }
history-cases-kept = Fälle: { $new } neu, { $updated } aktualisiert, { $unchanged } unverändert
history-cases-without-truth = { $count } ohne tatsächliches Teil
history-cases-without-frame = { $count } ohne aufbewahrtes Bild
history-cases-scans = { $count ->
        [one] { $count }, der ein Scan ist
       *[other] { $count }, die Scans sind
    }
history-cases-unreadable = { $count } mit unlesbarem Bild
history-crowded = Der Verlauf kommt nicht nach: Die Bilder einiger Prüfungen wurden nicht gespeichert
history-crowded-advice = Weniger Bilder aufbewahren („Bilder…“ im Verlauf) oder einen schnelleren Datenträger verwenden
history-set-aside = Verlauf: { $what }
history-set-aside-advice = Er wurde als { $path } beiseitegelegt; ein neuer wurde begonnen
history-failed-advice = { $advice }; bis dahin bleiben Prüfungen im Arbeitsspeicher
history-works =
    Der Verlauf ist wieder beschreibbar: { $count ->
        [one] eine wartende Prüfung
       *[other] { $count } wartende Prüfungen
    } gespeichert
history-works-lost =
    Der Verlauf ist wieder beschreibbar: { $count ->
        [one] eine wartende Prüfung
       *[other] { $count } wartende Prüfungen
    } gespeichert, { $lost ->
        [one] eine
       *[other] { $lost }
    } verloren
history-swept =
    Die Aufbewahrungsregel hat { $count ->
        [one] 1 Bild
       *[other] { $count } Bilder
    }, { $megabytes } MB, aus dem Verlauf entfernt
history-inspecting-again = { $scene } wird erneut geprüft
history-other-version = Das Rezept von { $scene } stammt von einer anderen Version von Partsight
history-other-version-advice = „Erneut prüfen“ drücken, um das aktuelle Rezept zu verwenden
history-changed-frame = Datei oder Bild
history-changed-recipe = Rezept
history-changed-library = Bibliothek
history-changed-program = Programm
history-changed-both = { $first }, { $second }
history-other-result = { $scene } liefert jetzt ein anderes Ergebnis; seither geändert: { $changed }
history-other-result-advice = Der Verlauf behält das erste Ergebnis
