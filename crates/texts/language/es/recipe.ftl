# Recipes

recipe-exists = ya existe una receta llamada { $name }
recipe-as-in-the-paper = El comparador del artículo, e ICP-GA para la pose: para comparar, ya que acepta muchas menos piezas
