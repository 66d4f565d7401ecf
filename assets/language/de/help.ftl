# Hilfe: Handbuch, Programm und Computer, Problemberichte und die Suche

help-guide = Handbuch
help-about = Info
help-report = Problem melden
help-search = Tasten und Handbuch durchsuchen
help-nothing-found = Nichts gefunden: versuchen Sie weniger oder kürzere Wörter
help-keys-and-actions = Tasten und Aktionen
help-guide-in-english = Das Handbuch ist auf Englisch
help-version = Version
help-system = System
help-graphics = Grafikadapter
help-folders = Benutzte Ordner
help-library = Bibliothek
help-cases = Fälle
help-recipes = Rezepte
help-settings = Einstellungen
help-copy = Kopieren
help-copy-path = Pfad kopieren: { $what }
help-licences = Lizenzen
help-licences-say = Partsight ist freie Software unter der MIT- oder der Apache-2.0-Lizenz. docs/DEPENDENCIES.md nennt die Pakete, aus denen es gebaut ist, und wie man deren Lizenzen auflistet
help-report-says = Ein Problembericht ist eine ZIP-Datei mit allem, was jemand anderes braucht, um dasselbe zu sehen wie Sie. Er bleibt auf diesem Computer, bis Sie ihn verschicken
help-report-inside = Er wird enthalten
help-report-no-scene = Keine Szene: noch wurde nichts geprüft
help-report-scene = Die Szene auf dem Bildschirm: { $scene }, mit ihrem Ergebnis
help-report-first-shot = Die erste Aufnahme von { $scene }, mit dem Ergebnis des Scans
help-report-entries = { $num ->
        [one] Den Eintrag der Bibliothek, mit dem sie verglichen wurde: { $part }
       *[other] Die { $num } Einträge der Bibliothek, mit denen sie verglichen wurde: { $part }
    }
help-report-recipe = Das Rezept { $recipe }
help-report-system = Die Versionen von Programm und System sowie den Grafikadapter
help-report-settings = Die Einstellungen des Fensters, mit den Pfaden Ihrer Dateien
help-report-log = { $num ->
        [one] { $num } Meldung dieses Fensters
       *[other] { $num } Meldungen dieses Fensters
    }
help-report-without = PIN, Netzwerkadressen, Seriennummern, Aufträge und der Name des Bedieners stehen weder in den Einstellungen noch im Ergebnis
help-report-save = Bericht speichern…
help-report-writing = Problembericht wird geschrieben
help-zip-files = ZIP-Archive
