# Lo que debe colgar ante la cámara

expect-title = Esperado
expect-anything = Cualquier pieza
expect-at-place = { $part } ({ $place })
expect-not-known = Desconocido
expect-says = Qué piezas deben colgar ahí: otra se rechaza, y se muestra lo que falta
expect-one-more = Una más
expect-one-less = Una menos
expect-orders = Órdenes…
expect-orders-says = Una tabla (CSV) de órdenes con las piezas que cuelgan ahí para cada una
expect-by-orders = Según la tabla de órdenes
expect-close-orders = Cerrar la tabla
expect-table = Tabla de órdenes
expect-table-used = Lo esperado se toma de { $file }
expect-table-unusable = No se puede usar la tabla de órdenes: { $error }
expect-reading = Leyendo la tabla de órdenes { $file }
expect-watching = Se vigila la tabla de órdenes

## Por qué no se sabe

expect-not-given = No se ha introducido ninguna orden
expect-unknown-order = La orden { $order } no está en la tabla de órdenes
expect-unknown-serial = El número de serie { $serial } no está en la tabla de órdenes
expect-serial-not-given = La orden { $order } varía según el número de serie
expect-other-order = El número de serie { $serial } es de la orden { $other }, no de { $order }
expect-several-orders = Varias órdenes tienen el número de serie { $serial }
expect-give-order = Introducir o escanear la orden
expect-give-serial = Escanear el número de serie
expect-check-order = Comprobar la orden o pedir que se complete la tabla
expect-check-serial = Comprobar el número de serie o pedir que se complete la tabla
expect-check-both = Comprobar la orden y el número de serie

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
