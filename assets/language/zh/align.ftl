# align
