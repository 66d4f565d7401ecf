# 为什么不能期望这些零件

expected-too-many = 期望 { $found } 个零件，而一帧最多显示 { $limit } 个
    .advice = 最多期望 { $limit } 个零件
expected-not-enrolled = 期望“{ $name }”，但它没有登记
    .advice = 请登记该零件，或更正其名称
expected-no-such-place = 期望在位置“{ $place }”有零件，但挂架没有该位置
    .advice = { $has_places ->
        [true] 请给出挂架的位置：{ $known }
       *[false] 请打开有该位置的挂架，或不指定位置
    }
expected-place-twice = 期望在位置“{ $place }”有两个零件，而那里只能挂一个
    .advice = 每个位置只期望一个零件

expected-recipe = 配方 { $recipe }：{ $why }
