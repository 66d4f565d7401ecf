# The parameters of a coat
coat-group-gun = Gun and paint
coat-group-path = Path
coat-group-film = Film
coat-option-gaussian = Gaussian
coat-option-beta = Beta
coat-option-raster = Raster
coat-option-cross-hatch = Cross-hatch
coat-option-contour = Contour
coat-option-principal-axis = Principal axis
coat-option-angle = Angle
coat-notes-primer = Two-component primer filler: thick, high solids, slow enough to fill.
coat-notes-base-coat = Water-borne base coat: thin, low solids, colour and effect; rows close together against clouds.
coat-notes-clear-coat = Two-component clear coat: thick and wet, gloss comes from an even film.
