# Por qué una tabla de órdenes no se puede leer

orders-file = { $what }
    .advice = { $is_damaged ->
        [true] { $to_do }; una hoja de cálculo guarda una tabla como CSV UTF-8
       *[false] { $to_do }
    }
orders-column = { $path }, línea 1: { $found } columnas se llaman { $column }
    .advice = Nombrar las columnas order, serial y parts en la primera línea; serial puede faltar
orders-none = { $path }: la tabla no tiene órdenes
    .advice = Añadir una fila por orden debajo de la primera línea
orders-cell = { $path }, línea { $line }, columna { $column }: { $why }

## Qué está mal en una celda

orders-empty = la celda está vacía
    .advice = Rellenar la celda o borrar la fila
orders-not-one-line = la celda tiene saltos de línea o más de { $limit } caracteres
    .advice = Acortarla; buscar antes de ella una comilla que falte
orders-again = la orden y el número de serie son los de la línea { $first }
    .advice = Poner en una fila todas las piezas que cuelgan juntas

## Por qué no se sabe qué espera una orden

order-too-long = la orden o el número de serie tiene más de { $limit } caracteres o saltos de línea
    .advice = Comprobar lo que se ha escaneado
order-not-given = no se ha introducido ninguna orden
    .advice = Introducir o escanear la orden
order-unknown-order = la orden { $order } no está en la tabla de órdenes
    .advice = Comprobar la orden o pedir que se complete la tabla
order-unknown-serial = el número de serie { $serial } no está en la tabla de órdenes
    .advice = Comprobar el número de serie o pedir que se complete la tabla
order-serial-not-given = la orden { $order } varía según el número de serie
    .advice = Escanear el número de serie
order-other-order = el número de serie { $serial } es de la orden { $other }, no de { $order }
    .advice = Comprobar la orden y el número de serie
order-several = varias órdenes tienen el número de serie { $serial }
    .advice = { order-not-given.advice }
