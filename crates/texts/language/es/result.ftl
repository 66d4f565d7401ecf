# Outcomes of inspections, estimations and cases, and names of frames

verdict-accepted = Aceptada
verdict-not-accepted = No aceptada
verdict-unknown = Desconocida
verdict-no-part = Sin pieza
another-make = { $part }, otra marca
another-model = { $part }, otro modelo
mirror-image = imagen reflejada de { $part }
other-half = imagen reflejada del trozo registrado de { $part }
simulated-frame = imagen simulada { $number }
no-more-frames = { $source } no tiene más imágenes
keep-all = Todas
keep-not-accepted = Las no aceptadas
keep-none = Ninguna
frame-loss-disk-full = disco lleno
frame-loss-not-writable = no se pudo escribir
frame-loss-slow-disk = disco demasiado lento
stopped-converged = convergió
stopped-below-target = bajo el umbral
stopped-iteration-limit = límite de iteraciones
stopped-no-progress = sin avance
outcome-right = correcto
outcome-refused = rechazada
outcome-wrong-accepted = falsa aceptación
no-calibration = Calibración: no se reconoció ninguna pieza
