# Cajas de archivos

box-number = { $field } de { $name } es { $found }
    .advice = Corregir los números
box-thin = ningún lado de { $name } mide { $least } mm o más: su size_mm es { $found }
    .advice = Indicar los lados en milímetros

# Por qué un bastidor no se puede leer, escribir o usar

rack-file = { $what }
    .advice = { $to_do }
rack-garbled = { $path } no es un bastidor: { $why }
    .advice = Corregir el archivo; la guía muestra uno (docs/guide/racks.md)
rack-not-enrolled = el lugar «{ $place }» del bastidor es para { $name }, que no está registrada
    .advice = Registrar la pieza o corregir su nombre en el lugar
rack-not-calibrated = el bastidor está dado en la base del robot, y la celda no está calibrada
    .advice = Calibrar la celda, o dar el bastidor en el sistema de la cámara

## Qué está mal

rack-toml = { $what }
rack-boxes = { $found } cajas del volumen, se esperan como máximo { $limit }
rack-places = { $found } lugares, se esperan como máximo { $limit }
rack-empty = ni un volumen ni un lugar
rack-name = { $is_place ->
        [true] el nombre de un lugar debe tener de 1 a { $limit } caracteres imprimibles
       *[false] su nombre debe tener de 1 a { $limit } caracteres imprimibles
    }
rack-same-name = dos lugares se llaman «{ $place }»
rack-overlap = los lugares «{ $place }» y «{ $over }» se solapan
rack-max-turn = max_turn_deg del lugar «{ $place }» es { $found }, se espera más de 0, hasta 180
