# The bars, the source, settings, files and shortcuts

## Bars

shell-capture = Aufnehmen
shell-live = Live
shell-open = Öffnen…
shell-robot = Roboter…
shell-help = Hilfe
shell-cancel = Abbrechen
shell-close = Schließen
shell-redo = Wiederholen
shell-more = Mehr zu { $group } ({ $count })
shell-export-csv = CSV exportieren…
shell-export = Exportieren…
shell-save-as = Speichern unter…
shell-save = Speichern
shell-wrote = { $path } geschrieben
shell-writing = { $file } wird geschrieben
shell-csv-files = Kommagetrennte Werte
shell-stop-live-says = Quelle nicht mehr verfolgen (L)
shell-live-says = Quelle verfolgen und möglichst viele Bilder prüfen (L)
shell-robot-says = Kalibrierung, Zellenkontrolle und Antworten an Roboter (B)
shell-calibrated-by = Kalibriert durch { $name }
shell-no-flange-pose = Die Flanschpose bei der Aufnahme ist nicht bekannt
shell-calibration-edited = Die Zahlen der Kalibrierung wurden geändert und nicht bestätigt
shell-not-calibrated = Lage der Kamera in der Roboterzelle: nicht kalibriert
shell-dark = Dunkel
shell-light = Hell
shell-to-dark = Zu Dunkel wechseln (T)
shell-to-light = Zu Hell wechseln (T)
shell-to-units = Zu { $units } wechseln (U)
shell-language-says = Sprache des Fensters
shell-language-of = Sprache: { $language }
shell-num-parts = { $num ->
        [one] { $num } Teil
       *[other] { $num } Teile
    }
shell-library-named = { $num ->
        [one] { $num } Teil · { $name }
       *[other] { $num } Teile · { $name }
    }
shell-no-library = Keine Bibliothek
shell-library-in-use = Verwendete Bibliothek
shell-library-version = Version { $version } von { $store }
shell-library-version-changed = Version { $version } von { $store }, seither hier geändert
shell-use-another-library = Andere Bibliothek verwenden…
shell-use-usual-library = Übliche Bibliothek verwenden
shell-progress = { $work } · { $done } von { $total }

## Workspaces and views

shell-inspect = Prüfen
shell-enrol = Einlernen
shell-compare = Vergleich
shell-align = Ausrichten
shell-paint = Lackieren
shell-servo = Servo
shell-history = Verlauf
shell-operator = Bediener
shell-engineer = Einrichter
shell-operators-view = Bedieneransicht
shell-engineers-view = Einrichteransicht
shell-to-engineer = Zur Einrichteransicht wechseln (Strg K)
shell-set-pin = PIN festlegen…
shell-set-pin-says = Mit PIN startet das Fenster in der Bedieneransicht
shell-change-pin = PIN ändern…
shell-remove-pin = PIN entfernen
shell-remove-pin-asked = Die PIN entfernen? Dann kann jeder zur Einrichteransicht wechseln
shell-lock-after = Sperren nach
shell-minutes = { $num ->
        [one] { $num } Minute
       *[other] { $num } Minuten
    }
shell-enter-pin = PIN eingeben, um Rezept, Schwellen, Bibliothek, Zelle und Quelle zu ändern
shell-unlock = Entsperren
shell-may-change = In dieser Ansicht lassen sich Rezept, Schwellen, Bibliothek, Zelle und Quelle ändern
shell-switch = Wechseln
shell-new-pin = Neue PIN
shell-new-pin-says = Vier bis acht Ziffern zum Schutz der Einrichteransicht
shell-next = Weiter
shell-same-digits = Dieselben Ziffern noch einmal eingeben
shell-set-the-pin = PIN festlegen
shell-pin-forgotten = Vergessen? Den Einrichter rufen
shell-num-digits = { $num ->
        [one] { $num } Ziffer
       *[other] { $num } Ziffern
    }
shell-erase = Löschen
shell-digit = Ziffer { $digit }
shell-locked = Gesperrt: Das Fenster wurde eine Weile nicht benutzt
shell-pin-removed = PIN entfernt
shell-wrong-pin = Falsche PIN
shell-four-digits = Mindestens vier Ziffern
shell-pins-differ = Die beiden stimmen nicht überein: neue PIN eingeben
shell-pin-set = PIN festgelegt: Das Fenster startet jetzt in der Bedieneransicht

## What a scene truly shows

shell-actual-part = Tatsächliches Teil: { $part }
shell-truth-not-set = offen
shell-truth-not-enrolled = Nicht eingelernt
shell-truth-nothing = Nichts (leere Zelle)

## The status bar

shell-days = { $num ->
        [one] 1 Tag
       *[other] { $num } Tage
    }
shell-status-from-pairs = Hand-Auge-Kalibrierung
shell-status-made-ago = { $kind }, Alter: { $age }
shell-status-edited = geändert
shell-status-no-flange-pose = keine Flanschpose
shell-status-not-calibrated = nicht kalibriert
shell-status-robots-off = Roboter aus
shell-status-robots-off-says = Kein Roboter erhält Antwort: Das Antworten ist ausgeschaltet
shell-status-not-answered = keine Antwort
shell-status-no-frames = keine Bilder
shell-status-robots-start = startet
shell-status-listens = bereit
shell-status-last-answer = Letzte Antwort: { $answer }
shell-status-live-off = Live aus
shell-status-live-off-says = Live ist aus: Ob das Teil ruhig hängt, wird nicht beobachtet
shell-status-motion-unknown = Es kommen keine Bilder: Ob das Teil ruhig hängt, ist nicht bekannt
shell-status-no-frame = Es wurde noch kein Bild aufgenommen
shell-status-frame-age = Alter des Bildes auf dem Bildschirm: { $age }
shell-status-speed = Dieser Rechner prüft { $inspected } von { $frames } Bildern
shell-status-speed-unknown = Die Geschwindigkeit dieses Rechners wird gemessen, während Live läuft
shell-status-drift = Drift

## The source

shell-simulated-cell = Simulierte Zelle
shell-source-button = Quelle · { $source }
shell-source-says = Woher Aufnehmen und Live ihre Szenen nehmen
shell-simulated = Simuliert · { $what }
shell-scan-of = Scan { $name }
shell-cell-set-up = Simulierte Zelle, eingerichtet
shell-recording-of = Aufzeichnung { $name }
shell-folder-of = Ordner { $name }
shell-set-up-cell = Zelle einrichten…
shell-cameras-and-folders = Kameras und Ordner
shell-play-recording = Aufzeichnung abspielen…
shell-play-recording-says = Ein Ordner mit Tiefenbildern oder Punktwolken: Live spielt ab und hält an, Aufnehmen nimmt das nächste Bild
shell-watch-folder = Ordner überwachen…
shell-watch-folder-says = Jede Aufnahme, die ein anderes Programm dort speichert, wird geprüft
shell-open-file = Datei öffnen…
shell-open-file-says = Eine einzelne Aufnahme
shell-open-scan = Scan öffnen…
shell-open-scan-says = Ein Ordner mit mehreren Aufnahmen eines Teils, jede mit der Pose ihrer Kamera (Strg Umschalt O)
shell-average-depth = Live mittelt die Tiefe über
shell-one-frame = 1 Bild
shell-recent-files = Zuletzt geöffnet
shell-empty-cell = Leere Zelle
shell-capture-empty-cell = Leere Zelle aufnehmen
shell-capture-empty-cell-says = Die angezeigte Szene wird zur leeren Zelle: Nichts darin wird künftig für ein Teil gehalten
shell-discard-empty-cell = Leere Zelle verwerfen
shell-no-empty-cell = Es wurde keine leere Zelle aufgenommen
shell-empty-cell-discarded = Leere Zelle verworfen
shell-cell-not-empty = Die Zelle ist nicht leer: Darin hängt ein Teil
shell-cell-not-empty-advice = Das Teil entfernen, aufnehmen, dann „Leere Zelle aufnehmen“ drücken
shell-empty-cell-doubt = Leere Zelle aufgenommen, aber darin ist etwas von der Größe eines Teils
shell-empty-cell-doubt-advice = Ist das ein Teil: Quelle, „Leere Zelle verwerfen“; dann das Teil entfernen und zuerst aufnehmen
shell-empty-cell-captured = Leere Zelle aufgenommen: Ab der nächsten Aufnahme wird nichts darin für ein Teil gehalten

## What is at work

shell-capturing = Aufnahme läuft
shell-opening = { $name } wird geöffnet
shell-waiting-for-file = Warten auf neue Datei
shell-same-capture = { $scene } wurde noch einmal geprüft: seither unverändert
shell-inspecting-again = Erneute Prüfung
shell-opening-library = Bibliothek wird geöffnet
shell-loading-library = Bibliothek wird geladen
shell-reloading-library = Bibliothek wird neu geladen
shell-library-reloaded = { $num ->
        [one] Bibliothek neu geladen, ein anderes Programm hat sie geändert: { $num } Teil
       *[other] Bibliothek neu geladen, ein anderes Programm hat sie geändert: { $num } Teile
    }
shell-path-off-part = { $part }: Die gespeicherte Lackierbahn zielt nicht auf das Teil; Roboter bekommen sie nicht
shell-counting-parts = Teile werden gezählt
shell-writing-settings = Einstellungen werden gespeichert

## Settings

shell-settings-not-used = Die Einstellungen werden nicht verwendet: { $why }
shell-settings-set-aside = Sie wurden nach { $path } verschoben; das Fenster startet mit Standardeinstellungen
shell-settings-values-not-used = { $keys } in { $path } { $num ->
    [one] ist nicht verwendbar und hat den Standardwert
   *[other] sind nicht verwendbar und haben Standardwerte
}; alle anderen Einstellungen bleiben
shell-settings-kept-beside = Die Datei, wie sie war, ist { $path }
shell-settings-move-away = Die Datei verschieben: Sie konnte nicht beiseitegelegt werden ({ $why })
shell-settings-not-kept = Die Einstellungen werden nicht gespeichert: { $why }
shell-settings-not-kept-advice = { $advice }; bis dahin werden Einstellungen nicht gespeichert
shell-report-settings = Die geänderten Einstellungen melden

## Files

shell-all-files = Alle Dateien
shell-scenes-clouds-meshes = Szenen, Punktwolken und Netze
shell-captured-scenes = Aufgenommene Szenen
shell-open-scene = Aufgenommene Szene öffnen
shell-scan-folder = Ordner eines Scans: Bilder und ihre Posen
shell-another-library = Andere Bibliothek verwenden
shell-a-recording = Aufzeichnung abspielen
shell-record-to = Ordner für die Aufzeichnung der Quelle
shell-watched-folder = Ordner, in den Aufnahmen gespeichert werden
shell-open-part = Szene, Punktwolke oder Netz zum Einlernen öffnen
shell-cannot-be-made = { $path } kann nicht angelegt werden: { $why }
shell-choose-another-folder = Einen anderen Ordner wählen
shell-type-a-path = Einen Pfad eingeben
shell-add-a-name = Das ist ein Ordner: einen Dateinamen ergänzen
shell-no-such-file = Diese Datei gibt es nicht
shell-no-such-folder = Diesen Ordner gibt es nicht
shell-not-a-folder = Das ist eine Datei, kein Ordner
shell-confirm-replace = Eine Datei dieses Namens existiert: zum Ersetzen erneut bestätigen
shell-no-parent-folder = Der Ordner dieser Datei existiert nicht
shell-no-file-dialog = Der Desktop bietet keinen Dateidialog (Paket xdg-desktop-portal-gtk oder zenity): Pfad eingeben oder unten wählen
shell-path = Pfad
shell-ok = OK

## Notices and closing

shell-dismiss = Ausblenden
shell-dismiss-all = Alle ausblenden
shell-more-like-it = { $num } weitere dieser Art
shell-read-in-millimetres = Als Millimeter lesen
shell-too-wide = Die Punkte erstrecken sich über { $extent } m
shell-too-wide-advice = Die Einheit der Datei prüfen
shell-undo = Rückgängig
shell-close-without-saving = Ohne Speichern schließen?
shell-not-written = { $num ->
        [one] { $num } Prüfung ist nur im Arbeitsspeicher
       *[other] { $num } Prüfungen sind nur im Arbeitsspeicher
    }: Der Verlauf ist nicht beschreibbar
shell-keep-open = Fenster offen lassen
shell-close-anyway = Ohne Speichern schließen
shell-stop-answering = Robotern nicht mehr antworten?
shell-robots-without-answer = Roboter, die unter { $at } anfragen, erhalten keine Antwort, solange das Fenster geschlossen ist
shell-close-and-stop-answering = Schließen und nicht mehr antworten

## Shortcuts

shell-shortcuts = Tastenkürzel
shell-key-ctrl = Strg
shell-key-shift = Umschalt
shell-key-space = Leertaste
shell-key-enter = Eingabe
shell-key-up = Pfeil auf
shell-key-down = Pfeil ab
shell-does-capture = Aufnehmen und prüfen oder einlernen
shell-does-live = Live: Quelle verfolgen oder anhalten
shell-does-record = Quelle aufzeichnen oder anhalten
shell-does-open-scan = Scan öffnen: mehrere Aufnahmen mit ihren Posen
shell-does-export = Angezeigte Prüfung exportieren
shell-does-robot = Roboterzelle: Lage der Kamera
shell-does-units = Millimeter und Grad oder Meter und Radiant
shell-does-theme = Dunkel oder hell
shell-does-role = Bediener- oder Einrichteransicht
shell-does-quit = Fenster schließen
shell-does-help = Hilfe: Tasten, Handbuch, Problem melden
shell-does-size = Alles größer, kleiner, wie üblich
shell-does-escape = Vergrößerte Stufe schließen; Box oder Lasso abbrechen
shell-keys-tab = Tab, Eingabe
shell-does-tab = Zum nächsten Bedienelement gehen, es drücken
shell-keys-turn = Pfeiltasten, links ziehen
shell-does-turn = 3D-Ansicht drehen
shell-keys-shift = Umschalt + diese, rechts ziehen
shell-does-shift = Verschieben
shell-keys-zoom = + −, Mausrad
shell-does-zoom = Zoomen
shell-keys-fit = F, Umschalt F
shell-does-fit = Teil einpassen, alles einpassen
shell-does-look = Von vorn, oben, von der Seite ansehen
shell-does-measure = Zwischen zwei angeklickten Punkten messen
shell-keys-drawing = Links ziehen, Esc
shell-does-drawing = Box oder Lasso ziehen, abbrechen
shell-keys-box = Pfeiltasten, Eingabe
shell-does-box = Rahmen im Bild bewegen, anwenden
shell-keys-resize = Umschalt + Pfeiltasten
shell-does-resize = Diesen Rahmen vergrößern oder verkleinern

## The simulated cell

shell-every-part = Alle Teile der Reihe nach
shell-not-enrolled = Nicht eingelernt: { $what }
shell-of-simulator = { $name }, simuliert
shell-gone = { $path } existiert nicht mehr
shell-gone-advice = Stattdessen wird die simulierte Zelle verwendet
shell-device-lost = Das Grafikgerät ging verloren; das Fenster wurde neu geöffnet
shell-device-lost-advice = Alles Gespeicherte ist da; ein nicht gespeicherter Entwurf kommt zurück, wenn seine Szene noch zu haben ist. Wenn es wieder vorkommt, den Grafiktreiber aktualisieren
shell-second-window = Partsight ist mit diesem Datenordner schon geöffnet: mit Live in beiden Fenstern zählt jedes Teil doppelt
shell-second-window-advice = Eines der beiden schließen. Dieses ist ohne Live gestartet und merkt sich keine Einstellungen
shell-no-thread = Das System stellt dafür keinen Thread bereit: { $error }
shell-no-thread-advice = Andere Programme schließen und erneut versuchen
shell-library-not-loaded = Die Bibliothek konnte nicht geladen werden: { $error }
shell-library-not-loaded-advice = { $advice }, oder oben rechts eine andere wählen; bis dahin wird nichts erkannt
shell-library-still-in-use = Die Bibliothek im Speicher wird weiter verwendet: { $error }
shell-library-inside = Die Bibliothek liegt im Programm und kann nicht geändert werden ({ $reason })
shell-inside-program = Die Bibliothek liegt im Programm und lässt sich nicht ändern
shell-inside-program-advice = Oben rechts einen eigenen Ordner wählen
shell-choose-library = Oben rechts { $path } wählen
shell-choose-or-go-on = Oben rechts eine andere wählen oder fortfahren: Das erste gespeicherte Teil wird dort abgelegt
shell-holds-no-library = { $path } enthält keine Teilebibliothek
shell-sentence = { $text }.
shell-about-scene = { $scene }: { $what }

## Words of several areas

shell-view = Ansicht
shell-part = Teil
shell-no-part = keines
shell-remove = Entfernen
shell-name = Name
shell-notes-hint = Alles Wissenswerte
shell-reset = Zurücksetzen
shell-wait = Einen Moment warten
shell-apply = Übernehmen
shell-pose = Pose
shell-robot-base = Roboterbasis
shell-store = Speichern
shell-library-loading = Die Bibliothek wird geladen
shell-choose-another-part = Ein anderes Teil wählen
shell-nothing-inspected = Noch nichts geprüft
