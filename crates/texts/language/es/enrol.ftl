# Enrolling

## Names that are not valid

name-empty = el nombre está vacío
    .advice = { name-advice }
name-too-long = el nombre tiene { $found } caracteres; se permiten como máximo { $limit }
    .advice = { name-advice }
name-bad-character = { $name } no es un nombre válido: contiene { $character }
    .advice = { name-advice }
name-bad-beginning = { $name } no es un nombre válido: empieza por { $character }
    .advice = { name-advice }
name-reserved = { $name } no es un nombre válido: Windows lo reserva para un dispositivo
    .advice = { name-advice }
name-advice = Usar hasta { $most } letras minúsculas sin acentos, cifras, _ y -, por ejemplo { $example }

## Warnings about a part

enrol-touches-edge = la pieza llega al borde de la imagen: puede faltar un trozo
    .advice = Alejar la cámara o centrar la pieza, y volver a registrarla
enrol-background = esto puede ser fondo: { background-sign }
    .advice = Comprobarlo en la imagen; si no es la pieza, tomar la pieza en su lugar
enrol-on-background = el { $percent } % de lo conservado está en la pared, el suelo u otro plano eliminado
    .advice = Quitar lo que es fondo: una inspección lo elimina y compara el resto
enrol-apart = el { $percent } % de lo conservado está separado del resto
    .advice = Quitar lo que no es de la pieza
enrol-too-little = se ve demasiado poco de la pieza para reconocerla: esta misma vista tendría una puntuación de { FIXED($score, 2) } y se necesita { FIXED($needed, 2) }
    .advice = Registrar más de la pieza: alejar la cámara o registrar varias tomas como escaneo
enrol-unconstrained = la forma no fija la pose: { free-motion }
    .advice = Registrar más de la pieza, para que esquinas o aberturas determinen su pose
enrol-symmetric = la pieza girada { $degrees }° se ve igual, así que las dos poses no se distinguen
    .advice = Registrarla e inspeccionarla con algo a la vista que la distinga al girarla, como un soporte o un recorte: sin eso, ningún robot recibe su pose
enrol-side-unclear = no está claro qué lado de la pieza es el exterior
    .advice = Elegir en Pintar el lado que se pinta, antes de planificar una trayectoria
enrol-goes-on-unseen = en el { $percent } % del contorno de la superficie escaneada acaba la vista de todas las tomas: la pieza puede continuar ahí
    .advice = Añadir tomas que muestren los lados que faltan, y volver a registrarla
background-sign = { $sign ->
        [behind] queda detrás de otras superficies en el { PERCENT($share, 0) } % de su borde
        [cut] el borde de la imagen la corta por { $sides } lados
       *[other] es una superficie plana de { FIXED($area, 2) } m²
    }

## Why a part cannot be enrolled

reference-no-outline = la nube de { $num_points } puntos no tiene contorno desde ningún lado
    .advice = Comprobar que la nube muestra la superficie de una sola pieza y está en metros
reference-too-large = la pieza abarca { FIXED($found, 1) } m; se esperan como máximo { FIXED($limit, 0) } m
    .advice = Exportarla en metros (parecen milímetros), o recortar la pieza de su escena
not-enrolled-background = la superficie encontrada puede ser fondo: { background-sign }
    .advice = Elegir la superficie que es la pieza
not-enrolled-no-such-surface = la escena no tiene superficie { $wanted }; se encontraron { $found }
    .advice = Elegir una de las encontradas
not-enrolled-too-few-points = { $found ->
        [one] la nube tiene { $found } punto; se necesitan al menos { $needed }
       *[other] la nube tiene { $found } puntos; se necesitan al menos { $needed }
    }
    .advice = Capturar la pieza desde más cerca, o exportar la nube con más puntos
not-enrolled-too-few-kept = { $found ->
        [one] se conserva { $found } punto; se necesitan al menos { $needed }
       *[other] se conservan { $found } puntos; se necesitan al menos { $needed }
    }
    .advice = Recuperar lo que se quitó: Deshacer, Restablecer o Añadir
not-enrolled-no-part-in-scan = no se encontró ninguna pieza en ninguna de las { $num_frames } tomas
    .advice = Conservar la pieza con Añadir y un recuadro o un lazo, o capturarla a 10 cm o más del fondo
not-enrolled-no-area = la malla de { $num_triangles } triángulos no tiene área
    .advice = Exportar la malla de nuevo con sus caras

## Lo que resultó ser una malla

enrolled-closed-sheet = chapa cerrada, de unos { MM($thickness_m, 1) } mm de espesor
enrolled-open-surface = superficie abierta sin espesor ({ $percent } %): se reconoce por ambas caras
enrolled-turned = invertida: el { $percent } % de sus triángulos miraba hacia dentro
enrolled-hidden = el { $percent } % de su superficie está dentro, donde ninguna cámara la ve, y se omite

## What was enrolled

shared-title = { $other } también tiene el título «{ $title }»
    .advice = Elegir otro título: los resultados y las listas distinguen las piezas por él
enrolled-from-segmented = pieza hallada en una escena capturada
enrolled-from-whole-cloud = nube de puntos entera
enrolled-from-mesh = malla
enrolled-from-scan = escaneo
renamed = { $before } se llama ahora { $now }
no-such-part = la biblioteca no tiene la pieza { $name }
mesh-no-area = { $path }: la malla no tiene área
    .advice = { not-enrolled-no-area.advice }
