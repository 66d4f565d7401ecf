# The operator's view
operator-ok = IO
operator-not-ok = NIO
operator-parts-ok = { $num } von { $all } IO
operator-parts-recognised = { $num } von { $all } erkannt
operator-opening-camera = Kamera wird geöffnet…
operator-no-camera = Keine Kamera
operator-no-camera-next = Stecker und Stromversorgung der Kamera prüfen. Bleibt es dabei, die Instandhaltung rufen
operator-no-folder = Ordner nicht erreichbar
operator-no-folder-next = Netzlaufwerk oder Freigabe prüfen. Bleibt es dabei, die Instandhaltung rufen
operator-lost = Partsight versucht es weiter
operator-inspecting = Prüfung läuft…
operator-no-result = Kein Ergebnis
operator-no-result-next = Den Einrichter rufen oder mit „Aufnehmen“ erneut versuchen
operator-unreadable = { $file } ist nicht lesbar
operator-unreadable-next = Die Aufnahme erneut im Ordner speichern; bleibt es dabei, den Einrichter rufen
operator-no-parts = Keine Teile eingelernt
operator-ask-to-enrol = Den Einrichter bitten, die Teile einzulernen
operator-no-new-file = Noch keine neue Datei im Ordner
operator-save-capture = Eine Aufnahme im Ordner speichern: Sie wird automatisch geprüft
operator-nothing-captured = Noch nichts aufgenommen
operator-ready = Bereit
operator-nothing-inspected = Noch nichts geprüft
operator-counts-no-longer = Das letzte Ergebnis gilt nicht mehr
operator-hang-and-capture = Ein Teil aufhängen und „Aufnehmen“ drücken
operator-follow-current = Für das aktuelle Teil „Live“ oder „Aufnehmen“ drücken
operator-file-next = Aus einer Datei: Prüfen, ob sie dieses Teil zeigt, wie es hängt, dann den Roboter starten
operator-check-part-next = Teil prüfen, dann Roboter starten
operator-start-robot = Roboter starten
operator-recognised = Erkannt, Pose bekannt
operator-reported-wrong = Als falsch gemeldet
operator-reported-wrong-next = Roboter nicht starten: Den Einrichter rufen
operator-next = Nächster Schritt
operator-last-parts = Letzte Teile dieser Schicht
operator-none-yet = Noch keine
operator-counting = Wird gezählt…

## What an operator can do about it

operator-then-capture = Dann „Aufnehmen“ drücken
operator-then-open = Dann die neue Aufnahme öffnen
operator-next-file = Die nächste Datei wird automatisch geprüft
operator-reaches-edge = Es reicht bis an den Bildrand: So aufhängen, dass es ganz im Bild ist
operator-reaches-edge-ok = Nicht ganz im Bild
operator-approximate-ok = Vielleicht anderes Modell

## The bars above and below

operator-locked-says = Gesperrt: PIN erforderlich (Strg K)
operator-history-says = Alle geprüften Teile
operator-shift-since = Schicht seit { $time }
operator-shift-says = Teile, die seit Schichtbeginn vor dieser Quelle hingen, jedes einmal gezählt. Eine leere Zelle ist kein Teil; geöffnete Dateien und einzelne Aufnahmen der simulierten Zelle zählen nicht. IO: akzeptiert und nicht als falsch gemeldet. Die Statistik im Verlauf zählt genauso
operator-num-parts = { $num ->
        [one] { $num } Teil
       *[other] { $num } Teile
    }
operator-num-ok = { $num } IO
operator-num-not-ok = { $num } NIO
operator-num-not-judged = { $num } nicht beurteilt
operator-stop-live-says = Automatische Prüfung beenden (L)
operator-live-says = Jedes Teil automatisch prüfen, sobald es still hängt (L)
operator-wrong-part = Falsches Teil?
operator-wrong-part-says = Angeben, welches Teil es wirklich ist
operator-wrong-part-not-now = Möglich, sobald das Teil auf dem Bildschirm ein Ergebnis hat
operator-back = Zurück
operator-back-says = Zurück zum Teil, ohne Änderung (Esc)
operator-which-part = { $part }, { $time }: Welches Teil ist es wirklich?
operator-find-part = Teil suchen
operator-no-such-part = Kein Teil hat diesen Namen
operator-none-of-these = Keines davon
operator-none-of-these-says = Das Teil ist nicht eingelernt
operator-recognised-as-this = Als dieses erkannt
operator-labelled-as-this = Bisher angegeben
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
