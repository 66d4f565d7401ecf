# Lo que no se comprobó de una trayectoria

unchecked-arm = alcance y colisiones
    .advice = Escribir un programa e indicar su brazo, con la pose de la boquilla en la brida, o vigilar la primera ejecución del robot a baja velocidad
unchecked-moving-part = alcance y colisiones, porque la línea mueve la pieza mientras el robot trabaja
    .advice = Ejecutar primero el programa sin pintura con la línea a baja velocidad, y vigilar el robot
unchecked-surroundings = colisiones con algo que no sea la pieza o el brazo, como el soporte de la pieza
    .advice = Describir las cajas y el suelo de la celda en un archivo, o vigilar la primera ejecución del robot a baja velocidad
unchecked-film = la película que deja el programa, porque la trayectoria no nombra ninguna capa
    .advice = Planificar de nuevo la trayectoria, para que nombre su capa
unchecked-accelerations =
    { $what ->
        [joints] aceleraciones de las articulaciones
        [rail] aceleración del carril
       *[both] aceleraciones de las articulaciones y del carril
    }
    .advice = Añadir los límites al archivo del brazo
unchecked-not-seen = la distancia de boquilla en { $num } de { $num_points } puntos, donde la cámara no vio superficie
    .advice = Capturar la pieza de modo que la cámara vea más de ella, o escanearla, si la trayectoria debe apuntar a ella allí

not-checked = sin comprobar: { $what }
