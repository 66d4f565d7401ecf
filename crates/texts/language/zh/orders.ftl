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
