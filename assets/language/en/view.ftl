# The 3-D view and the plots
view-segments = Segments
view-height = Height
view-deviation = Deviation
view-plain = Plain
view-height-scale = height, mm
view-deviation-scale = deviation, mm
view-measure-first = Measure: click a point of the cloud
view-measure-second = Measure: click a second point
view-keys = 3-D view. Arrow keys turn, with Shift they shift, plus and minus zoom, F fits, X, Y and Z look along an axis, M measures
view-no-view = No 3-D view
view-ray = ray { $place }: query { $query }, part { $part } { $unit }
