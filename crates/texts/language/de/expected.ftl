# Warum Teile nicht erwartet werden können

expected-too-many = { $found } Teile werden erwartet, und ein Bild kann { $limit } zeigen
    .advice = Bis zu { $limit } Teile erwarten
expected-not-enrolled = { $name } wird erwartet, ist aber nicht eingelernt
    .advice = Das Teil einlernen oder seinen Namen berichtigen
expected-no-such-place = ein Teil wird am Platz „{ $place }“ erwartet, den das Gestell nicht hat
    .advice = { $has_places ->
        [true] Einen Platz des Gestells angeben: { $known }
       *[false] Ein Gestell öffnen, das den Platz hat, oder den Platz weglassen
    }
expected-place-twice = zwei Teile werden am Platz „{ $place }“ erwartet, an dem eines hängen kann
    .advice = An jedem Platz ein Teil erwarten

expected-recipe = Rezept { $recipe }: { $why }
