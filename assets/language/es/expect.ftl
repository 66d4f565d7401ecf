# Lo que debe colgar ante la cámara

expect-title = Esperado
expect-anything = Cualquier pieza
expect-at-place = { $part } ({ $place })
expect-not-known = Desconocido
expect-says = Qué piezas deben colgar ahí: otra se rechaza, y se muestra lo que falta
expect-one-more = Una más
expect-one-less = Una menos
expect-elsewhere-heading = En cualquier otro lugar
expect-as-recipe = Como en la receta { $recipe }
expect-orders = Órdenes…
expect-orders-says = Una tabla (CSV) de órdenes con las piezas que cuelgan ahí para cada una
expect-by-orders = Según la tabla de órdenes
expect-close-orders = Cerrar la tabla
expect-table = Tabla de órdenes
expect-table-used = Lo esperado se toma de { $file }
expect-table-unusable = No se puede usar la tabla de órdenes: { $error }
expect-reading = Leyendo la tabla de órdenes { $file }
expect-watching = Se vigila la tabla de órdenes

## El resultado

expect-num-met = { $num } de { $all } según lo esperado
expect-is-met-and-posed = Según lo esperado, y su pose es conocida
expect-missing = Falta: { $parts }
expect-wrong = Pieza equivocada: { $part } en lugar de { $expected }
expect-elsewhere = Lugar equivocado: { $part }, se espera en { $place }
expect-surplus = No esperada: { $part }
expect-of-order = Orden { $order }: { $says }
expect-hang-missing = Colgar las piezas que faltan y capturar de nuevo, o corregir lo esperado
expect-as-expected = esperada
expect-wrong-part = equivocada
expect-wrong-place = lugar equivocado
expect-not-expected = no esperada
expect-is-missing = falta
expect-nothing-hangs = No cuelga ahí
