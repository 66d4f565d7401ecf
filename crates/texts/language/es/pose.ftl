# Poses

## Why there is no pose

pose-too-few-points = { $found ->
        [one] la nube de { cloud-role } tiene { $found } punto; se necesitan al menos { $needed }
       *[other] la nube de { cloud-role } tiene { $found } puntos; se necesitan al menos { $needed }
    }
    .advice = Capturar la pieza desde más cerca, o registrarla de nuevo
pose-degenerate = la nube de { cloud-role } deja la pose libre: sus puntos están en una línea o un punto ({ FIXED($width_m, 5) } m de ancho)
    .advice = Usar una nube que muestre una superficie, no una línea ni un único punto
pose-one-sided-pairs = los puntos más próximos de los { $num_pairs } pares están en un punto o una línea, a { MM($rms_m, 1) } mm
    .advice = { pose-no-overlap.advice }
pose-no-overlap = { $found ->
        [one] las nubes solo tienen { $found } par de puntos a menos de { MM($reach_m, 1) } mm; se necesitan al menos { $needed }
       *[other] las nubes solo tienen { $found } pares de puntos a menos de { MM($reach_m, 1) } mm; se necesitan al menos { $needed }
    }
    .advice = Comprobar que ambas nubes muestran la misma pieza en metros
pose-sizes-differ = una nube es { FIXED($ratio, 0) } veces mayor que la otra
    .advice = Exportar ambas en metros: una parece estar en milímetros
pose-too-far-out = la nube de { cloud-role } está a { FIXED($distance_m, 0) } m del origen, demasiado lejos para resolver sus puntos
    .advice = Restar un mismo desplazamiento a ambas nubes antes de exportarlas
pose-no-reference-cloud = la referencia es una forma plana sin nube
    .advice = Registrar la pieza a partir de una captura, una nube o una malla
pose-cancelled = se canceló la estimación
    .advice = Iniciarla de nuevo

## Why a pose should not be relied upon

pose-little-overlap = solo el { PERCENT($overlap, 0) } % del origen está sobre el destino; se necesita al menos el { PERCENT($needed, 0) } %
    .advice = Comprobar que ambas nubes muestran lo mismo y comparten al menos la mitad
pose-ambiguous = otra pose encaja igual de bien (su coste es { FIXED($ratio, 2) } veces mayor)
pose-off-scale = lo que ve la cámara es un { PERCENT($by, 0) } % más { $is_larger ->
        [true] grande
       *[false] pequeño
    } que la referencia
    .advice = Comprobar la unidad de las profundidades de la cámara y sus distancias focales (fx, fy): la pose se desvía ese mismo porcentaje de la distancia
pose-loose = la pose no está determinada: { free-motion }
pose-unsettled = la pose seguía moviéndose tras { $num_iterations } iteraciones

## Por qué no hay distancia

stand-off-no-surface = la pieza registrada no tiene superficie con normales
stand-off-none-meets = ninguna de las { $num_taught } posiciones de boquilla supuestas apunta a la pieza

## Parts of these texts

free-motion = { $motion ->
        [slide] { $axis ->
            [long] puede deslizarse a lo largo de su lado largo
            [short] puede deslizarse a lo largo de su lado corto
           *[other] puede moverse perpendicularmente a su superficie
        }
        [turn] { $axis ->
            [long] puede girar en torno a su lado largo
            [short] puede girar en torno a su lado corto
           *[other] puede girar en torno al eje perpendicular a su superficie
        }
       *[other] puede deslizarse o girar
    }
cloud-role = { $which ->
        [source] origen
       *[other] destino
    }

## Which clouds
pose-onto = { $source } sobre { $target }
