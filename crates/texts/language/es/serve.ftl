# The server that robots ask

open-to-network = { $at } está abierto a la red sin cifrado: quien llegue a él puede iniciar inspecciones y leer poses
    .advice = Usar una red propia de la celda y dejar que el cortafuegos solo permita el robot y el PLC en este puerto
numbers-not-stored = los números de las piezas no se pueden guardar y cambian al añadir o quitar una pieza: { $reason }
