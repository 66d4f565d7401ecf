# The 3-D view and the plots
view-segments = Segmentos
view-height = Altura
view-deviation = Desviación
view-plain = Liso
view-height-scale = altura, mm
view-deviation-scale = desviación, mm
view-measure-first = Medir: hacer clic en un punto de la nube
view-measure-second = Medir: hacer clic en un segundo punto
view-keys = Vista 3D. Las flechas giran, con Mayús desplazan, más y menos amplían y reducen, F encuadra, X, Y y Z miran a lo largo de un eje, M mide
view-no-view = Sin vista 3D
view-ray = rayo { $place }: consulta { $query }, pieza { $part } { $unit }
