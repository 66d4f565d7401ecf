# Recipes

recipe-exists = 已有名为 { $name } 的配方
recipe-as-in-the-paper = 论文的匹配方法，位姿用 ICP-GA；仅用于比较，接受的零件少得多
