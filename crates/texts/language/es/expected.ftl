# Por qué no se pueden esperar piezas

expected-too-many = se esperan { $found } piezas, y una imagen puede mostrar { $limit }
    .advice = Esperar hasta { $limit } piezas
expected-not-enrolled = se espera { $name }, pero no está registrada
    .advice = Registrar la pieza o corregir su nombre
expected-no-such-place = se espera una pieza en el lugar «{ $place }», que el bastidor no tiene
    .advice = { $has_places ->
        [true] Indicar un lugar del bastidor: { $known }
       *[false] Abrir un bastidor que tenga el lugar, o no indicarlo
    }
expected-place-twice = se esperan dos piezas en el lugar «{ $place }», donde puede colgar una
    .advice = Esperar una pieza en cada lugar

expected-recipe = receta { $recipe }: { $why }
