# 为什么订单表不能读取

orders-file = { $what }
    .advice = { $is_damaged ->
        [true] { $to_do }；电子表格可将表另存为 CSV UTF-8
       *[false] { $to_do }
    }
orders-column = { $path }，第 1 行：有 { $found } 列名为 { $column }
    .advice = 请在第一行命名列 order、serial 和 parts；serial 可以省略
orders-none = { $path }：表中没有订单
    .advice = 请在第一行下面为每个订单添加一行
orders-cell = { $path }，第 { $line } 行，列 { $column }：{ $why }

## 单元格有什么错误

orders-empty = 单元格为空
    .advice = 请填写单元格，或删除该行
orders-not-one-line = 单元格有换行，或超过 { $limit } 个字符
    .advice = 请缩短；检查前面是否缺少引号
orders-again = 订单和序列号与第 { $first } 行相同
    .advice = 请将一起悬挂的所有零件放在一行

## 为何不知道订单的预期

order-too-long = 订单号或序列号超过 { $limit } 个字符，或含有换行符
    .advice = 检查扫描的内容
order-not-given = 尚未输入订单
    .advice = 请输入或扫描订单
order-unknown-order = 订单 { $order } 不在订单表中
    .advice = 请核对订单，或请人补充订单表
order-unknown-serial = 序列号 { $serial } 不在订单表中
    .advice = 请核对序列号，或请人补充订单表
order-serial-not-given = 订单 { $order } 的零件因序列号而异
    .advice = 请扫描序列号
order-other-order = 序列号 { $serial } 属于订单 { $other }，而不是 { $order }
    .advice = 请核对订单和序列号
order-several = 多个订单有序列号 { $serial }
    .advice = { order-not-given.advice }
