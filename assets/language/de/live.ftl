# The followed source
live-record = Aufzeichnen…
live-record-says = Jedes Bild der Quelle unverändert speichern (Strg L)
live-stop-recording = Aufzeichnung beenden
live-stop-recording-so-far = Aufzeichnung beenden · { $num ->
        [one] { $num } Bild, { $size }
       *[other] { $num } Bilder, { $size }
    }
live-recorded = { $num ->
        [one] { $num } Bild, { $size }, in { $folder } aufgezeichnet
       *[other] { $num } Bilder, { $size }, in { $folder } aufgezeichnet
    }
live-playing = Wiedergabe
live-watching = Ordner
live-lost = getrennt, neuer Versuch
live-opening = wird geöffnet
live-file-is-part = jede Datei ist ein Teil
live-looking = sucht
live-moving = Bewegung
live-steady-for = ruhig seit { $seconds } s
live-file-by-file = Jede neue Datei wird einzeln geprüft
live-no-verdict = Kein Ergebnis, bis das Teil still hängt
live-frames-of = { $num } von { $needed ->
        [one] { $needed } Bild
       *[other] { $needed } Bildern
    }
live-frames-agree = { $agreeing } von { $num ->
        [one] { $num } Bild stimmt überein
       *[other] { $num } Bildern stimmen überein
    }
live-averaged = { $evidence } · Tiefe aus { $num }
live-dropped = { $num } verworfen
live-rates = { $captured } Bilder/s, { $inspected } geprüft
live-scan-cannot = Ein Scan kann nicht verfolgt werden: Er ändert sich nicht
live-file-cannot = Eine einzelne Datei kann nicht verfolgt werden: Sie ändert sich nicht
live-cannot-advice = Im Quellenmenü eine Kamera, eine Aufzeichnung oder einen Ordner wählen
live-closing = Kamera wird geschlossen
live-inspects-each = Jede Aufnahme im Ordner wird geprüft, sobald sie gespeichert ist
live-ended = Live ist beendet: es wurde ein Bild aufgenommen
live-ended-past = Live ist beendet: eine frühere Prüfung wurde geöffnet oder wiederholt
live-ended-advice = L drücken, um Live wieder einzuschalten
live-source-back = Die Quelle ist wieder da

## Setting up the simulated cell

live-what-hangs = Was dort hängt
live-hangs = Dort hängt: { $what }
live-side = Seite
live-side-left = Links
live-side-right = Rechts
live-model = Automodell
live-model-says = 0 ist das eingelernte
live-hung = Aufhängung
live-with-care = Sorgfältig
live-anyhow = Beliebig
live-turned-away = Abgewandt
live-noise = Rauschen
live-no-noise = Keins
live-kinect-noise = Wie Kinect
live-three-times = Dreifach
live-clutter = Störobjekte
live-no-clutter = Keine
live-on-floor = Am Boden
live-plank = Brett davor
live-line-runs = Linie läuft, ein Teil alle { $seconds } s
live-racks-run = Linie läuft, drei Teile nebeneinander alle { $seconds } s
live-conveyor-runs = Linie läuft ohne Halt mit { $speed } mm/s
live-nothing = Nichts
