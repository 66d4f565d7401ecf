# Cómo se escriben las poses, y por qué un texto o unos números no son una pose

convention = { $convention ->
       *[matrix] Matriz 4×4
        [quaternion-xyzw] Cuaternión x y z w
        [rotation-vector] Vector de rotación
        [kuka] KUKA A B C
        [fanuc] FANUC W P R
        [abb] ABB q1 q2 q3 q4
        [universal-robots] Universal Robots
        [yaskawa] Yaskawa Rx Ry Rz
        [staubli] Stäubli rx ry rz
        [doosan] Doosan A B C
    }
    .meaning = { $convention ->
       *[matrix] matriz 4×4, fila a fila: rotación 3×3 con x y z en metros como cuarta columna, después 0 0 0 1; multiplica por la izquierda una columna [x y z 1]
        [quaternion-xyzw] x y z en metros, después un cuaternión unitario qx qy qz qw, con el escalar qw al final y no negativo
        [rotation-vector] x y z en metros, después rx ry rz: el eje de la rotación por su ángulo en radianes, de 0 a π; no tres ángulos sucesivos
        [kuka] X Y Z en milímetros, después A B C en grados: A alrededor de Z, B alrededor del nuevo Y, C alrededor del nuevo X (intrínseca Z-Y'-X''), R = Rz(A)·Ry(B)·Rx(C), B dentro de ±90
        [fanuc] X Y Z en milímetros, después W P R en grados: W alrededor del X fijo, luego P alrededor del Y fijo, luego R alrededor del Z fijo (extrínseca X-Y-Z), R = Rz(R)·Ry(P)·Rx(W), P dentro de ±90
        [abb] x y z en milímetros, después un cuaternión unitario q1 q2 q3 q4, con el escalar q1 al principio y no negativo, como pos y orient de RAPID
        [universal-robots] x y z en metros, después rx ry rz: el eje de la rotación por su ángulo en radianes, de 0 a π, como p[x, y, z, rx, ry, rz] de URScript; no los ángulos roll, pitch y yaw de la consola
        [yaskawa] X Y Z en milímetros, después Rx Ry Rz en grados: Rx alrededor del X fijo, luego Ry alrededor del Y fijo, luego Rz alrededor del Z fijo (extrínseca X-Y-Z), R = Rz(Rz)·Ry(Ry)·Rx(Rx), Ry dentro de ±90
        [staubli] x y z en milímetros, después rx ry rz en grados: rx alrededor de X, ry alrededor del nuevo Y, rz alrededor del nuevo Z (intrínseca X-Y'-Z''), R = Rx(rx)·Ry(ry)·Rz(rz), ry dentro de ±90, como trsf de VAL 3
        [doosan] X Y Z en milímetros, después A B C en grados: A alrededor de Z, B alrededor del nuevo Y, C alrededor del nuevo Z (intrínseca Z-Y'-Z''), R = Rz(A)·Ry(B)·Rz(C), B de 0 a 180, como posx
    }

written-no-such-convention = ninguna convención se llama { $name }
    .advice = Escribir primero la convención, por ejemplo "kuka 1450 -310 890 10 20 30": { $names }
written-no-convention = { $found ->
        [one] { $found } número sin el nombre de una convención
       *[other] { $found } números sin el nombre de una convención
    }
    .advice = { written-no-such-convention.advice }
written-no-number = { $word } no es un número
    .advice = Escribir los números con punto decimal, separados por espacios
written-too-far = la posición está a { FIXED($distance_m, 0) } m; se esperan como mucho { $most } m
    .advice = Escribir su posición en { $unit }, la unidad de { $name }
written-nozzle = la boquilla está a { MM($distance_m, 3) } mm de la brida; se esperan de { MM($from_m, 0) } a { MM($to_m, 0) } mm
    .advice = Escribir su posición en { $unit }, la unidad de { $name }; 0 0 0 solo si el sistema de la brida del controlador ya está en la boquilla
written-count = { convention } tiene { $needed } números ({ $names }) y se dan { $found }
    .advice = Indicarlos en este orden: { convention.meaning }
written-not-finite = { $name } es { $value }; se espera un número finito
    .advice = Leer de nuevo los números del controlador
written-not-unit = la longitud del cuaternión es { FIXED($length, 4) }; se espera 1
    .advice = Copiar los cuatro números con al menos 4 decimales y comprobar cuál es el escalar
written-long-rotation = la longitud del vector de rotación es { FIXED($length, 2) }; se espera 2π como máximo
    .advice = Indicar el vector de rotación en radianes; estos números parecen grados
written-not-rigid = los 16 números no son una transformación rígida: estiran, reflejan o no terminan en 0 0 0 1
    .advice = Indicar una rotación y un desplazamiento, fila a fila con al menos 4 decimales; no confundir filas y columnas
