# The operator's view
operator-ok = IO
operator-not-ok = NIO
operator-wait = Einen Moment warten
operator-opening-camera = Kamera wird geöffnet…
operator-no-camera = Keine Kamera
operator-inspecting = Prüfung läuft…
operator-no-result = Kein Ergebnis
operator-no-result-next = Den Einrichter rufen oder mit „Aufnehmen“ erneut versuchen
operator-no-library = Keine Bibliothek
operator-no-parts = Keine Teile eingelernt
operator-no-parts-why = In der Bibliothek ist kein Teil eingelernt
operator-ask-to-enrol = Den Einrichter bitten, die Teile einzulernen
operator-looking = Suche läuft
operator-nothing-captured = Noch nichts aufgenommen
operator-ready = Bereit
operator-nothing-inspected = Noch nichts geprüft
operator-hang-and-capture = Ein Teil aufhängen und „Aufnehmen“ drücken
operator-from-history = Aus dem Verlauf, nicht das aktuelle Teil
operator-capture-current = Für das aktuelle Teil „Aufnehmen“ drücken
operator-simulated-next = Den Einrichter eine Kamera wählen lassen: Dieses Bild ist simuliert
operator-ambiguous-next = Prüfen, wie herum das Teil hängt, dann den Roboter starten
operator-file-next = Aus einer Datei: Prüfen, ob sie dieses Teil zeigt, wie es hängt, dann den Roboter starten
operator-start-robot = Roboter starten
operator-recognised = Erkannt, Pose bekannt
operator-an-enrolled-part = ein eingelerntes Teil
operator-next = Nächster Schritt
operator-last-parts = Letzte Teile dieser Schicht
operator-none-yet = Noch keine
operator-counting = Wird gezählt…

## Why a part is not accepted

operator-low-score = Passt nicht gut genug zu: { $nearest }
operator-piece = Nur ein Stück sichtbar von: { $nearest }
operator-hardly-seen = Zu wenig davon ist sichtbar
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

## What an operator can do about it

operator-uncover-next = Entfernen, was das Teil verdeckt, und „Aufnehmen“ drücken; bleibt es dabei, den Einrichter rufen
operator-all-in-picture-next = Die Sichtseite ganz im Bild zur Kamera drehen und „Aufnehmen“ drücken
operator-enrol-if-painted-next = Soll es lackiert werden, den Einrichter bitten, es einzulernen
operator-turn-next = Die Sichtseite zur Kamera drehen und „Aufnehmen“ drücken; bleibt es dabei, den Einrichter rufen
operator-turn-or-enrol-next = Die Sichtseite zur Kamera drehen und „Aufnehmen“ drücken; soll es lackiert werden, den Einrichter bitten, es einzulernen
operator-mirrored-next = Nicht wie { $nearest } lackieren: Den Einrichter bitten, das Teil dieser Seite einzulernen
operator-mirrored-image-next = Roboter nicht starten: Den Einrichter bitten, die Kamera richtig einzustellen
operator-small-margin-next = Die Sichtseite zur Kamera drehen und „Aufnehmen“ drücken; bleibt es dabei, den Einrichter bitten, eines der beiden aus der Bibliothek zu entfernen
operator-unconfirmed-next = Den Einrichter bitten, auch die Pose schätzen zu lassen
operator-check-camera-next = Den Einrichter bitten, Kamera und Dateien zu prüfen
operator-hang-next = Das Teil mindestens 10 cm vor der Wand vor die Kamera hängen und „Aufnehmen“ drücken
operator-hang-or-empty-cell-next = Das Teil mindestens 10 cm vor der Wand vor die Kamera hängen und „Aufnehmen“ drücken; hängt es schon dort, den Einrichter bitten, die leere Zelle neu aufzunehmen
operator-uncover-camera-next = Entfernen, was die Kamera verdeckt, und „Aufnehmen“ drücken; bleibt es dabei, den Einrichter rufen
operator-turn-part-next = Die Sichtseite des Teils zur Kamera drehen und „Aufnehmen“ drücken; bleibt es dabei, den Einrichter rufen
operator-ask = Den Einrichter rufen
operator-reaches-edge = Es reicht bis an den Bildrand: So aufhängen, dass es ganz im Bild ist
operator-reaches-edge-ok = Es reicht bis an den Bildrand: Das nächste Teil weiter innen aufhängen

## The bars above and below

operator-locked-says = Gesperrt: PIN erforderlich (Strg K)
operator-history-says = Alle geprüften Teile
operator-shift-since = Schicht seit { $time }
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
operator-source = Quelle: { $source }
operator-serial = Serien-Nr.
operator-serial-hint = scannen oder eingeben
operator-serial-for-next = Für das nächste Teil, das geprüft wird
operator-serial-entered = Seriennummer { $serial } übernommen
operator-serial-known = { $serial } ist schon die Nummer dieses Teils
operator-serial-in-shift = { $serial } ist schon die Nummer eines Teils dieser Schicht
operator-serial-in-shift-next = Prüfen: Wenn sie falsch ist, die richtige Nummer scannen
operator-serial-replaced = { $serial } ersetzt { $former }, die noch kein Teil hat
operator-serial-replaced-next = Wenn { $former } richtig war, noch einmal scannen
operator-robots-without-pose = Roboter bekommen keine Pose: Den Einrichter bitten, die Zelle zu kalibrieren
operator-robots-without-frames = Roboter bekommen keine Bilder: Live drücken
operator-robots-without-source = Roboter bekommen keine Bilder: Den Einrichter bitten, eine Kamera zu wählen
operator-not-recorded = Nicht gespeichert
operator-not-recorded-says = Der Verlauf ist nicht beschreibbar: den Einrichter rufen. Bis dahin sind Prüfungen nur im Arbeitsspeicher
operator-order = Auftrag
operator-operator = Bediener
