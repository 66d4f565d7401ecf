# Enrolling

## Names that are not valid

name-empty = der Name ist leer
    .advice = { name-advice }
name-too-long = der Name hat { $found } Zeichen, höchstens { $limit } sind erlaubt
    .advice = { name-advice }
name-bad-character = { $name } ist kein gültiger Name: er enthält { $character }
    .advice = { name-advice }
name-bad-beginning = { $name } ist kein gültiger Name: er beginnt mit { $character }
    .advice = { name-advice }
name-reserved = { $name } ist kein gültiger Name: unter Windows ist er ein Gerätename
    .advice = { name-advice }
name-advice = Bis zu { $most } Kleinbuchstaben ohne Umlaute, Ziffern, _ und - verwenden, zum Beispiel { $example }

## Warnings about a part

enrol-touches-edge = das Teil reicht bis an den Bildrand, ein Stück davon fehlt vielleicht
    .advice = Die Kamera weiter weg stellen oder das Teil in die Mitte rücken und erneut einlernen
enrol-background = dies ist vielleicht Hintergrund: { background-sign }
    .advice = Im Bild prüfen; ist es nicht das Teil, stattdessen das Teil nehmen
enrol-on-background = { $percent } % des Behaltenen liegen auf der Wand, dem Boden oder einer anderen entfernten Ebene
    .advice = Hintergrund entfernen: eine Prüfung entfernt ihn und vergleicht den Rest
enrol-apart = { $percent } % des Behaltenen liegen abseits vom Rest
    .advice = Entfernen, was nicht zum Teil gehört
enrol-too-little = vom Teil ist zu wenig da, um es zu erkennen: dieselbe Ansicht hätte den Score { FIXED($score, 2) }, nötig ist { FIXED($needed, 2) }
    .advice = Mehr vom Teil einlernen: mit der Kamera zurückgehen oder mehrere Aufnahmen als Scan einlernen
enrol-unconstrained = die Form legt die Pose nicht fest: { free-motion }
    .advice = Mehr vom Teil einlernen, damit Ecken oder Öffnungen die Pose bestimmen
enrol-symmetric = das Teil sieht um { $degrees }° gedreht gleich aus, die beiden Posen sind nicht unterscheidbar
    .advice = Es mit einem Merkmal im Bild einlernen und prüfen, das gedreht nicht gleich aussieht, etwa einem Halter oder einem Ausschnitt: ohne das bekommt kein Roboter seine Pose
enrol-side-unclear = es ist nicht klar, welche Seite des Teils die Außenseite ist
    .advice = In Lackieren die zu lackierende Seite wählen, bevor eine Bahn geplant wird
enrol-goes-on-unseen = auf { $percent } % des Umrisses der gescannten Fläche endet die Sicht aller Aufnahmen: das Teil geht dort vielleicht weiter
    .advice = Aufnahmen hinzufügen, die die fehlenden Seiten zeigen, und erneut einlernen
background-sign = { $sign ->
        [behind] die Fläche liegt auf { PERCENT($share, 0) } % ihres Randes hinter anderen Flächen
        [cut] der Bildrand schneidet die Fläche auf { $sides } Seiten ab
       *[other] die Fläche ist eben und { FIXED($area, 2) } m² groß
    }

## Why a part cannot be enrolled

reference-no-outline = die Punktwolke mit { $num_points } Punkten hat von keiner Seite einen Umriss
    .advice = Prüfen, ob die Punktwolke die Oberfläche eines einzigen Teils zeigt und in Metern ist
reference-too-large = das Teil ist { FIXED($found, 1) } m groß, erwartet werden höchstens { FIXED($limit, 0) } m
    .advice = In Metern exportieren (das sind wohl Millimeter) oder das eine Teil aus der Szene ausschneiden
not-enrolled-background = die gefundene Fläche ist vielleicht Hintergrund: { background-sign }
    .advice = Die Fläche wählen, die das Teil ist
not-enrolled-no-such-surface = die Szene hat keine Fläche { $wanted }; { $found } wurden gefunden
    .advice = Eine der gefundenen Flächen wählen
not-enrolled-too-few-points = { $found ->
        [one] die Punktwolke hat { $found } Punkt, mindestens { $needed } sind erforderlich
       *[other] die Punktwolke hat { $found } Punkte, mindestens { $needed } sind erforderlich
    }
    .advice = Das Teil aus der Nähe aufnehmen oder die Punktwolke mit mehr Punkten exportieren
not-enrolled-too-few-kept = { $found ->
        [one] { $found } Punkt wird behalten, mindestens { $needed } sind erforderlich
       *[other] { $found } Punkte werden behalten, mindestens { $needed } sind erforderlich
    }
    .advice = Entferntes zurückholen: „Rückgängig“, „Zurücksetzen“ oder „Ergänzen“
not-enrolled-no-part-in-scan = in keiner der { $num_frames } Aufnahmen wurde ein Teil gefunden
    .advice = Das Teil mit „Ergänzen“ und Box oder Lasso behalten oder mindestens 10 cm vor dem Hintergrund aufnehmen
not-enrolled-no-area = das Netz mit { $num_triangles } Dreiecken hat keine Fläche
    .advice = Das Netz mit seinen Flächen erneut exportieren

## Als was ein Netz erkannt wurde

enrolled-closed-sheet = geschlossenes Blech, etwa { MM($thickness_m, 1) } mm dick
enrolled-open-surface = offene Fläche ohne Dicke ({ $percent } %): sie wird von beiden Seiten erkannt
enrolled-turned = gewendet: { $percent } % der Dreiecke zeigten nach innen
enrolled-hidden = { $percent } % der Fläche liegen innen, wo keine Kamera sie sieht, und werden weggelassen

## What was enrolled

shared-title = { $other } hat ebenfalls den Titel „{ $title }“
    .advice = Einen anderen Titel wählen: Ergebnisse und Listen unterscheiden Teile danach
enrolled-from-segmented = Teil in einer aufgenommenen Szene
enrolled-from-whole-cloud = ganze Punktwolke
enrolled-from-mesh = Netz
enrolled-from-scan = Scan
renamed = { $before } in { $now } umbenannt
no-such-part = die Bibliothek hat kein Teil { $name }
mesh-no-area = { $path }: Das Netz hat keine Fläche
    .advice = { not-enrolled-no-area.advice }
