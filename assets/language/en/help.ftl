# Help: the guide, this program and computer, problem reports, and the search

help-guide = Guide
help-about = About
help-report = Report a problem
help-search = Search keys and guide
help-nothing-found = Nothing found: try fewer or shorter words
help-keys-and-actions = Keys and actions
help-guide-in-english = The guide is in English
help-version = Version
help-system = System
help-graphics = Graphics adapter
help-folders = Folders in use
help-library = Library
help-cases = Cases
help-recipes = Recipes
help-settings = Settings
help-copy = Copy
help-copy-path = Copy the path: { $what }
help-licences = Licences
help-licences-say = Partsight is free software under the MIT or the Apache 2.0 licence. docs/DEPENDENCIES.md names the packages that it is built from, and how to list their licences
help-report-says = A problem report is a ZIP file with what somebody else needs to see the same as you. It stays on this computer until you send it
help-report-inside = It will hold
help-report-no-scene = No scene: nothing has been inspected yet
help-report-scene = The scene on the screen: { $scene }, with its result
help-report-first-shot = The first shot of { $scene }, with the result of the scan
help-report-entries = { $num ->
        [one] The library entry that it was compared with: { $part }
       *[other] The { $num } library entries that it was compared with: { $part }
    }
help-report-recipe = The recipe { $recipe }
help-report-system = The versions of program and system, and the graphics adapter
help-report-settings = The settings of the window, with the paths of your files
help-report-log = { $num ->
        [one] { $num } notice of this window
       *[other] { $num } notices of this window
    }
help-report-without = PIN, network addresses, serial numbers, orders and the operator's name are left out of settings and result
help-report-save = Save the report…
help-report-writing = Writing a problem report
help-zip-files = ZIP archives
