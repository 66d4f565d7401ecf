## What is aligned
align-moved-copy = Bewegte Kopie
align-files = Zwei Dateien
align-run = Starten
align-run-hint = Mit jedem Verfahren ausrichten (R)
align-view-menu-hint = Aller 3D-Ansichten
align-library-failed = Die Bibliothek konnte nicht geladen werden
align-part-hint = Das eingelernte Teil, das die Referenz ist
align-start = Start
align-custom = Eigener…
align-random = Zufällig
align-random-hint = Nächster zufälliger Start
align-random-prefix = Nr.
align-random-number = Zufälliger Start Nummer { $number }
align-numbers = rx { $rx }°, ry { $ry }°, rz { $rz }°, dann x { $x } mm, y { $y } mm, z { $z } mm
align-custom-hint = rx ry rz x y z, zum Beispiel 0 0 30deg 100mm 0 0
align-custom-label = Eigener Start, sechs Zahlen
align-use-start = Diesen Start verwenden
align-custom-units = Radiant und Meter oder mit Einheit: deg, mm, cm, m; R = Rz·Ry·Rx
align-scene-part = { $scene }: das gefundene Teil, { $count } Punkte, von seiner Lage aus
align-source = Quelle
align-target = Ziel
align-source-hint = Die Punktwolke oder das Netz, das bewegt wird
align-target-hint = Die Punktwolke oder das Netz, das stehen bleibt
align-custom-start = eigener Start
align-random-start = zufälliger Start { $seed }
align-from = { $part } · { $start }
align-library-has-no-part = Die Bibliothek hat kein Teil: eines unter „Einlernen“ einlernen
align-nothing-inspected = Noch nichts geprüft: „Aufnehmen“ drücken
align-no-part-in-scene = In der Szene wurde kein Teil gefunden: eine andere aufnehmen
align-choose-source = Die Datei wählen, die bewegt wird: Quelle…
align-choose-target = Die Datei wählen, die stehen bleibt: Ziel…

## The views
align-view-of = 3D-Ansicht, { $method }
align-previous-result = Voriges Ergebnis: eine neue Ausrichtung läuft
align-at-work = Läuft…
align-not-run = Nicht gelaufen
align-figures = E { $e } m² · rms { $rms } auf { $overlap } % · { $time } ms
align-no-pose-figures = Keine Pose · { $time } ms
align-end = { $count ->
        [one] Ende, nach { $count } Iteration
       *[other] Ende, nach { $count } Iterationen
    }
align-iteration-e = Iteration { $iteration } von { $last } · E { $e } m²
align-aligning-now = Wird ausgerichtet…
align-nothing-aligned = Noch nichts ausgerichtet
align-nothing-aligned-advice = Oben ein Teil und einen Start wählen, dann „Starten“ drücken
align-ended-below-threshold = { $count ->
        [one] Schwelle erreicht: E < 1e-6 m², { $count } Iteration
       *[other] Schwelle erreicht: E < 1e-6 m², { $count } Iterationen
    }
align-ended-below-threshold-says = Algorithmus 3 endet, sobald E (Gl. 12) unter 1e-6 m² liegt
align-ended-elsewhere = { $count ->
        [one] Nach { $count } Iteration an anderer Stelle konvergiert
       *[other] Nach { $count } Iterationen an anderer Stelle konvergiert
    }
align-ended-elsewhere-says = Der letzte Schritt lag unter der Grenze, aber mehr als 5° neben der wahren Lage: ein lokales Minimum von E
align-ended-converged = { $count ->
        [one] Nach { $count } Iteration konvergiert
       *[other] Nach { $count } Iterationen konvergiert
    }
align-ended-converged-says = Der letzte Schritt lag unter der Grenze: Die Lage ändert sich nicht mehr
align-ended-above-threshold = { $count ->
        [one] Schwelle nicht erreicht: beste von { $count } Iteration
       *[other] Schwelle nicht erreicht: beste von { $count } Iterationen
    }
align-ended-above-threshold-says = Algorithmus 3 endet, sobald E unter 1e-6 m² liegt. E blieb darüber, und die letzten Runden fanden keine bessere Lage: Dies ist die beste. Schon das Rauschen einer Kamera hält E über der Schwelle, wie gut die Lage auch ist
align-ended-limit = Höchstzahl der Iterationen: { $count }
align-ended-limit-says = Im letzten Schritt änderte sich die Lage noch
align-nearer-or-same-part = Einen näheren Start wählen oder prüfen, ob beide Punktwolken dasselbe Teil in Metern zeigen
align-which-way-round = Prüfen, wie herum das Teil liegt
align-look-for-edge = Eine Kante oder Biegung suchen, die nur eine Stelle des Teils hat
align-other-method = Ein anderes Verfahren oder einen näheren Start versuchen
align-nearer-start = Einen näheren Start wählen

## The plot
align-genetic-search = genetische Suche
align-threshold = Schwelle 1e-6 (Algorithmus 3)
align-iteration = Iteration { $iteration } von { $last }
align-iteration-hint = Iteration { $iteration } von { $last } · ziehen zum Durchgehen, P zum Abspielen
align-scrubber = Angezeigte Iteration
align-scrubber-keys = E je Iteration. Links und rechts gehen eine Iteration weiter, Bild auf und Bild ab zehn, Pos 1 und Ende an die Enden, P spielt ab
align-no-way = Kein Verfahren hat eine Pose gefunden: nichts darzustellen
align-way = „Starten“ zeigt hier, wie der mittlere quadratische Abstand E von Iteration zu Iteration sinkt

## Table I
align-table = Tabelle I
align-table-says = Jedes eingelernte Teil von T1 bis T5 (Gl. 15) verschoben und mit jedem Verfahren zurückgeführt: E in m², das beste je Zeile markiert
align-cancel-table = Tabelle I abbrechen
align-run-table = Tabelle I starten
align-go-on = Fortsetzen
align-go-on-table = Tabelle I fortsetzen
align-again = Erneut starten
align-table-again = Tabelle I erneut starten
align-rows-done-left = { $done } von { $total } fertig · noch etwa { $time }
align-rows-done = { $done } von { $total } fertig
align-rows = { $total ->
        [one] { $total } Zeile
       *[other] { $total } Zeilen
    }
align-rows-stopped = Bei { $done } von { $total } gestoppt
align-rows-all = Alle { $total } fertig
align-column-part = Teil, Start
align-none = keine
align-best = bestes
align-no-pose = keine Pose
align-true-error = Wahrer Fehler bei diesem Start
align-uncertainty = Unsicherheit der Ausrichtung (95 %)
align-uncertainty-says = Wie weit diese Lagen daneben liegen können, allein nach den Punkten der beiden Wolken. Prüfen nutzt auch den Umriss im Bild, daher ist die Unsicherheit seiner Lage meist kleiner
align-method = Verfahren
align-rotation = Drehung
align-shift = Verschiebung
align-unconstrained = nicht bestimmt
align-copy = Kopieren
align-copy-hint = Tabelle I als Text, Zellen durch Tabulatoren getrennt

## Keys
align-key-run = Alle Verfahren starten
align-key-play = Iterationen abspielen oder anhalten
align-key-back = Eine Iteration zurück
align-key-on = Eine Iteration weiter
align-keys-play = P oder Leertaste im Diagramm
align-keys-back = , oder ← im Diagramm
align-keys-on = . oder → im Diagramm

## Work and notices
align-open-title = Punktwolke oder Netz öffnen
align-export-title = Tabelle I exportieren
align-aligning = Ausrichtung läuft
align-copied = Tabelle I kopiert
