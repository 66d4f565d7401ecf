# 相机前应悬挂的零件

expect-title = 预期
expect-anything = 任意零件
expect-at-place = { $part }（{ $place }）
expect-not-known = 未知
expect-says = 应悬挂哪些零件：其他零件会被拒绝，并显示缺少的零件
expect-one-more = 增加一个
expect-one-less = 减少一个
expect-elsewhere-heading = 在其他任意位置
expect-as-recipe = 按配方 { $recipe }
expect-orders = 订单表…
expect-orders-says = 订单表（CSV），列出每个订单应悬挂的零件
expect-by-orders = 按订单表
expect-close-orders = 关闭订单表
expect-table = 订单表
expect-table-used = 预期零件取自 { $file }
expect-table-unusable = 无法使用订单表：{ $error }
expect-reading = 正在读取订单表 { $file }
expect-watching = 正在监视订单表

## 结果

expect-num-met = { $all } 个中 { $num } 个符合预期
expect-is-met-and-posed = 符合预期，位姿已知
expect-missing = 缺少：{ $parts }
expect-wrong = 零件错误：{ $part }，应为 { $expected }
expect-elsewhere = 位置错误：{ $part }，应在{ $place }
expect-surplus = 非预期零件：{ $part }
expect-of-order = 订单 { $order }：{ $says }
expect-hang-missing = 请挂上缺少的零件并重新采集，或更正预期零件
expect-as-expected = 符合预期
expect-wrong-part = 零件错误
expect-wrong-place = 位置错误
expect-not-expected = 非预期
expect-is-missing = 缺少
expect-nothing-hangs = 未悬挂
