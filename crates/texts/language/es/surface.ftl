# Superficies

## Verdicts

surface-ok = OK
surface-not-judged = no evaluada
surface-rework = retrabajo
surface-scrap = rechazo

## What a region is

region-dent = abolladura
region-bump = abombamiento
region-missing = superficie ausente

## Why a surface is not judged

surface-little-in-sight = solo se ve bien el { PERCENT($seen, 0) } % de este lado de la pieza, se necesita el { PERCENT($needed, 0) } %
    .advice = Gire la pieza hacia la cámara y encuádrela entera
surface-too-far = desde { FIXED($distance_m, 1) } m solo son seguras las desviaciones de más de { MM($certain_m, 1) } mm; se buscan las de { MM($needed_m, 1) } mm
    .advice = Acerque la cámara a { FIXED($nearer_m, 1) } m de la pieza
surface-too-noisy = { $num_frames ->
        [1] en un fotograma
       *[other] en { $num_frames } fotogramas promediados
    } solo son seguras las desviaciones de más de { MM($certain_m, 1) } mm; se buscan las de { MM($needed_m, 1) } mm
    .advice = Promedie más fotogramas de la pieza en reposo, regístrela a partir de fotogramas promediados o de su malla CAD, o admita una tolerancia mayor
deviation-no-picture = las lecturas no forman una imagen de una cámara conocida
    .advice = Compruebe la superficie en una imagen de profundidad o una nube organizada
deviation-frames-differ = los fotogramas que se van a promediar son de distinto tamaño o de distintas cámaras
    .advice = Promedie fotogramas que una misma cámara tomó de la pieza con ambas en reposo
deviation-moved = entre los fotogramas que se van a promediar la pieza se movió { MM($by_m, 1) } mm; se admiten { MM($limit_m, 1) } mm como máximo
    .advice = Promedie fotogramas de una pieza que cuelgue en reposo
deviation-no-surface = la referencia no tiene superficie con normales
    .advice = Registre la pieza a partir de una captura, una nube o una malla
deviation-little-seen = solo se ve bien el { PERCENT($seen, 0) } % de la referencia para medirla, se necesita el { PERCENT($needed, 0) } %
    .advice = Gire la pieza hacia la cámara y encuádrela entera
