# Recipes

recipe-exists = es gibt bereits ein Rezept namens { $name }
recipe-as-in-the-paper = Der Vergleich des Artikels, und ICP-GA für die Pose: zum Vergleichen, denn so werden viel weniger Teile akzeptiert
