# Recipes

recipe-exists = there is a recipe named { $name } already
recipe-as-in-the-paper = The paper's matcher, and ICP-GA for the pose: for comparison, since it accepts far fewer parts
