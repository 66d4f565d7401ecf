# The operator's view
operator-ok = IO
operator-not-ok = NIO
operator-opening-camera = Kamera wird geöffnet…
operator-no-camera = Keine Kamera
operator-no-camera-next = Stecker und Stromversorgung der Kamera prüfen. Bleibt es dabei, die Instandhaltung rufen
operator-no-folder = Ordner nicht erreichbar
operator-no-folder-next = Netzlaufwerk oder Freigabe prüfen. Bleibt es dabei, die Instandhaltung rufen
operator-lost = Neuer Versuch läuft von selbst
operator-inspecting = Prüfung läuft…
operator-no-result = Kein Ergebnis
operator-no-result-next = Den Einrichter rufen oder mit „Aufnehmen“ erneut versuchen
operator-unreadable = { $file } ist nicht lesbar
operator-unreadable-next = Die Aufnahme erneut im Ordner speichern; bleibt es dabei, den Einrichter rufen
operator-no-parts = Keine Teile eingelernt
operator-no-parts-why = In der Bibliothek ist kein Teil eingelernt
operator-ask-to-enrol = Den Einrichter bitten, die Teile einzulernen
operator-no-new-file = Noch keine neue Datei im Ordner
operator-save-capture = Eine Aufnahme im Ordner speichern: Sie wird automatisch geprüft
operator-nothing-captured = Noch nichts aufgenommen
operator-ready = Bereit
operator-nothing-inspected = Noch nichts geprüft
operator-counts-no-longer = Das letzte Ergebnis gilt nicht mehr
operator-hang-and-capture = Ein Teil aufhängen und „Aufnehmen“ drücken
operator-capture-current = Für das aktuelle Teil „Aufnehmen“ drücken
operator-follow-current = Für das aktuelle Teil „Live“ oder „Aufnehmen“ drücken
operator-file-next = Aus einer Datei: Prüfen, ob sie dieses Teil zeigt, wie es hängt, dann den Roboter starten
operator-check-part-next = Teil prüfen, dann Roboter starten
operator-start-robot = Roboter starten
operator-recognised = Erkannt, Pose bekannt
operator-reported-wrong = Als falsch gemeldet
operator-reported-wrong-next = Roboter nicht starten: Den Einrichter rufen
operator-an-enrolled-part = ein eingelerntes Teil
operator-next = Nächster Schritt
operator-last-parts = Letzte Teile dieser Schicht
operator-none-yet = Noch keine
operator-counting = Wird gezählt…

## Why a part is not accepted

operator-low-score = Passt nicht gut genug zu: { $nearest }
operator-piece = Nur ein Stück sichtbar von: { $nearest }
operator-hardly-seen = Zu wenig vom Teil ist sichtbar
operator-another-model = Ähnlich wie { $nearest }, aber andere Form
operator-another-make = Ähnlich wie { $nearest }, aber andere Maße
operator-uncertain-pose = Erkannt, aber die Pose ist unsicher
operator-unknown = Kein eingelerntes Teil ist ähnlich
operator-mirrored = Sieht aus wie das Spiegelbild von { $nearest }
operator-mirrored-image = Das Kamerabild ist gespiegelt
operator-small-margin = Zwei eingelernte Teile passen fast gleich gut
operator-unconfirmed = Nur der Umriss wurde verglichen
operator-out-of-range = Es ist zu nah an der Kamera oder zu weit entfernt
operator-damaged-file = Die aufgenommene Datei ist beschädigt
operator-no-pose = Vielleicht { $nearest }, aber keine Pose gefunden
operator-not-steady = Das Teil hängt noch nicht still
operator-few-frames = Bisher zu wenige Bilder geprüft
operator-undecided = Die Bilder stimmen nicht überein
operator-nothing-hangs = Vor der Kamera hängt kein Teil
operator-hardly-a-reading = Die Kamera sieht fast nichts
operator-too-wide = Die Szene ist viel größer als eine Zelle
operator-fault = Das Programm ist an diesem Bild gescheitert

## What an operator can do about it

operator-uncover = Entfernen, was das Teil verdeckt
operator-all-in-picture = Die Sichtseite ganz im Bild zur Kamera drehen
operator-turn = Die Sichtseite zur Kamera drehen
operator-hang = Das Teil mindestens 10 cm vor der Wand vor die Kamera hängen
operator-uncover-camera = Entfernen, was die Kamera verdeckt
operator-then-capture = Dann „Aufnehmen“ drücken
operator-next-file = Die nächste Datei wird automatisch geprüft
operator-if-it-persists = Bleibt es dabei, den Einrichter rufen
operator-if-two-alike = Bleibt es dabei, den Einrichter bitten, eines der beiden aus der Bibliothek zu entfernen
operator-if-it-hangs-there = Hängt es schon dort, den Einrichter bitten, die leere Zelle neu aufzunehmen
operator-enrol-if-painted-next = Soll es lackiert werden, den Einrichter bitten, es einzulernen
operator-mirrored-next = Nicht wie { $nearest } lackieren: Den Einrichter bitten, das Teil dieser Seite einzulernen
operator-mirrored-image-next = Roboter nicht starten: Den Einrichter bitten, die Kamera richtig einzustellen
operator-unconfirmed-next = Den Einrichter bitten, auch die Pose schätzen zu lassen
operator-check-camera-next = Den Einrichter bitten, Kamera und Dateien zu prüfen
operator-ask = Den Einrichter rufen
operator-reaches-edge = Es reicht bis an den Bildrand: So aufhängen, dass es ganz im Bild ist
operator-reaches-edge-ok = Nicht ganz im Bild
operator-approximate-ok = Vielleicht anderes Modell

## The bars above and below

operator-locked-says = Gesperrt: PIN erforderlich (Strg K)
operator-history-says = Alle geprüften Teile
operator-shift-since = Schicht seit { $time }
operator-shift-says = Teile dieser Schicht aus dieser Quelle
operator-num-parts = { $num ->
        [one] { $num } Teil
       *[other] { $num } Teile
    }
operator-num-ok = { $num } IO
operator-num-not-ok = { $num } NIO
operator-stop-live-says = Automatische Prüfung beenden (L)
operator-live-says = Jedes Teil automatisch prüfen, sobald es still hängt (L)
operator-wrong-part = Falsches Teil?
operator-wrong-part-says = Verlauf öffnen und angeben, welches Teil es ist
operator-wrong-part-not-now = Möglich, sobald das Teil auf dem Bildschirm ein Ergebnis hat
operator-source = Quelle: { $source }
operator-serial = Serien-Nr.
operator-serial-hint-this = für dieses Teil
operator-serial-hint-next = für das nächste Teil
operator-serial-for-next = Für das nächste Teil, das geprüft wird
operator-serial-entered = Seriennummer { $serial } gilt für das nächste Teil
operator-serial-of-part = Seriennummer { $serial } → { $part }, { $time }
operator-serial-move-next = Dem nächsten Teil geben
operator-serial-move-this = Diesem Teil geben
operator-serial-known = { $serial } ist schon die Nummer dieses Teils
operator-serial-in-shift = { $serial } ist schon die Nummer eines Teils dieser Schicht
operator-serial-in-shift-next = Prüfen: Falls die Nummer falsch ist, die richtige scannen
operator-serial-replaced = { $former } war noch keinem Teil zugeordnet und wurde durch { $serial } ersetzt
operator-serial-replaced-next = Falls { $former } richtig war, diese Nummer noch einmal scannen
operator-robots-without-pose = Roboter bekommen keine Pose: Den Einrichter bitten, die Zelle zu kalibrieren
operator-robots-without-frames = Roboter bekommen keine Bilder: Live drücken
operator-robots-without-source = Roboter bekommen keine Bilder: Den Einrichter bitten, eine Kamera zu wählen
operator-not-recorded = Nicht gespeichert
operator-not-recorded-says = Der Verlauf ist nicht beschreibbar: den Einrichter rufen. Bis dahin sind Prüfungen nur im Arbeitsspeicher
operator-order = Auftrag
operator-operator = Bediener
