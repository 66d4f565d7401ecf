## The list
history-empty-advice = 请按“采集”：每次检测都会列在此处，关闭窗口后仍会保留
history-in-memory = 仅保存在内存中：{ $reason }
history-none-listed = 没有符合条件的检测：请更改筛选条件
history-column-score = 得分
history-column-ms = ms
history-column-time = 时间
history-part-again = { $part } · 重检 { $count } 次
history-row =
    { $count ->
        [0] 检测 { $number }：{ $part }，{ $verdict }
       *[other] 检测 { $number }：{ $part }，{ $verdict }，重新检测 { $count } 次
    }

## The bar above the list
history-show-all = 显示全部
history-counted = { $matching } / { $count } 条记录
history-export-csv-hint = 将列出的检测写入表格
history-export-cases = 导出样本…
history-export-cases-hint = 将列出的检测中带有深度帧和实际零件的保存为样本，供“比较”和 partsight evaluate 使用
history-statistics = 统计
history-statistics-hint = 按班次、零件和原因统计所列检测的 OK 和 NG；仅在没有列出其他检测时统计仿真帧
history-frames-button = 深度帧…
history-frames-button-hint = 保留哪些深度帧以及保留多久
history-find = 查找
history-find-hint = 零件、序列号或备注
history-filter-days = 日期
history-filter-all-verdicts = 全部
history-filter-all-parts = 全部
history-days-all = 全部日期
history-days-week = 近 7 天
history-days-month = 近 30 天
history-days-typed = 起止日期
history-from = 从
history-to = 到
history-first-day = 起始日期
history-last-day = 截止日期
history-day-format = 日期请写成“年-月-日”：2026-11-20

## The inspection on the right
history-choose = 选择一次检测以查看详情
history-inspection = 检测 { $number }
history-no-picture = 该场景没有行列结构，因此没有图像
history-picture = 检测 { $number } 的分割结果
history-of-part = 该零件的各次检测
history-counts = 计入
history-of-this-part = 该零件：检测 { $number }，{ $verdict }
history-found-same = 检测 { $number } 的结果相同
history-found-other = 检测 { $number } 的结果不同
history-figure-source = 来源
history-figure-time = 时间
history-figure-serial = 序列号
history-figure-score = 得分
history-figure-margin = 裕度
history-figure-library = 零件库
history-figure-program = 程序
history-figure-frame = 深度帧
history-figure-verdict = 判定
history-figure-nearest = 最接近
history-frame-not-kept = 未保留
history-frame-lost = 未保留：{ $why }
history-frame-kept = 已保留，{ $megabytes } MB
history-rz = rz（Rz·Ry·Rx）
history-stage-segment = 分割
history-stage-project = 投影
history-stage-contour = 轮廓
history-stage-signature = 特征曲线
history-stage-rank = 排名
history-stage-pose = 位姿
history-stage-total = 总计
history-times = 用时
history-open = 打开
history-open-hint = 使用其自身的配方打开，并显示所有阶段
history-again = 重新检测
history-again-hint = 使用当前的配方和零件库；变化会显示在此处
history-frame-gone = “{ $scene }”的深度帧未保留
history-frame-gone-advice = 今后请保留更多深度帧：列表上方的“深度帧…”
history-actual-part = 实际零件
history-labelled = 已存入历史记录。实际零件：{ $part }
history-label-undone = 已撤销：实际零件恢复为之前的值
history-remark = 备注
history-your-remark = 您的备注

## What differs
history-differences = 重新检测
history-same-today = 今天的结果相同
history-other-today = 今天的结果不同
history-then = 当时
history-today = 今天
history-pose-differs = 位姿相差 { $shift } 和 { $rotation }

## Keys
history-key-newer = 较新的检测
history-key-older = 较早的检测
history-key-open = 打开并显示所有阶段
history-key-again = 使用当前的配方和零件库重新检测

## Frames to keep
history-keep-title = 深度帧保留设置
history-keep-why = 保留深度帧后，可以重新打开该次检测并查看所有阶段。检测记录本身会永久保留。“未接受的”还会保留最近 { $num } 个已接受零件的深度帧，以便之后标注误接受的零件。
history-keep-which = 保留哪些检测的深度帧
history-keep-days = 最多保留（天）
history-keep-gigabytes = 最大占用（GB）
history-keep-used = 当前：{ $count } 个深度帧，{ $size }。最旧的先删除
history-keep-marked = 带有备注或实际零件的会保留：{ $size }

## Statistics
history-none-counted = 没有符合条件的零件：请更改筛选条件
history-by-part = 按零件
history-by-rack = 按挂架
history-by-reason = 按原因
history-ok-share = OK，%
history-shift = { $start } 的班次：{ $ok } OK，{ $nok } NG
history-by-shift = 各班次零件数
history-not-ok-on-top = NG（上方）
history-total = { $count } 个零件，{ $share } OK
history-total-of-shifts = { $shifts } 个班次：{ $count } 个零件，{ $share } OK
history-others-left-out = 未计入其他来源的 { $count } 个零件
history-no-part-left-out = 未计入 { $count } 条无零件的记录
history-not-judged-left-out = { $count } 个零件未判定，未计入：检测的帧过少
history-drift = 漂移：{ $part }
history-drift-needs = 零件至少被接受 { $count } 次后才显示漂移
history-drift-shift-bound = 位置误差界限（95 %）
history-drift-fit = 与参考的偏差（rms）
history-drift-place-along = 零件沿 { $axis } 的位置
history-drift-mean = 平均值
history-drift-limit = 限值
history-drift-band = { $name }：平均值 { $mean }，3σ 范围 { $from } 至 { $to }
history-drift-band-limit = { $name }：平均值 { $mean }，3σ 范围 { $from } 至 { $to }，限值 { $limit }
history-drift-place = 零件位置，平均值 ± 3σ：x { $x }，y { $y }，z { $z }
history-drift-trend = { $name }：最近 { $count } 次检测的趋势为 { $from } 至 { $to }
history-drift-warning =
    { $count ->
        [0] { $part } 出现漂移：按此趋势，从现在起将有个别零件不被接受（{ $name }，限值 { $limit }）
       *[other] { $part } 出现漂移：按此趋势，再检测 { $count } 次后将有个别零件不被接受（{ $name }，限值 { $limit }）
    }
history-drift-warning-advice = 请提前查找原因：先清洁相机镜头窗口，再检查工位（机器人…，工位检查）、挂具和零件

## Work and notices
history-looking = 正在读取历史记录
history-export-csv-title = 导出列出的检测
history-export-cases-title = 列出检测的样本文件夹
history-wrote = 已将 { $count } 次检测写入 { $path }
history-no-cases = 没有检测可转为样本：{ $what }
history-no-cases-advice = 请为部分检测设置实际零件，并保留其深度帧
history-wrote-cases = { $path }：{ $what }
history-cases-kept = 样本：新增 { $new }，更新 { $updated }，未变 { $unchanged }
history-cases-without-truth = { $count } 次没有实际零件
history-cases-without-frame = { $count } 次未保留深度帧
history-cases-scans = { $count } 次为扫描
history-cases-unreadable = { $count } 次的深度帧无法读取
history-crowded = 历史记录来不及写入：部分检测的深度帧未保存
history-crowded-advice = 请减少保留的深度帧（“历史”中的“深度帧…”），或使用更快的磁盘
history-set-aside = 历史记录：{ $what }
history-set-aside-advice = 原文件已另存为 { $path }，并已新建历史记录
history-failed-advice = { $advice }；在此之前检测保存在内存中
history-works = 历史记录已恢复写入：已保存 { $count } 次等待中的检测
history-works-lost = 历史记录已恢复写入：已保存 { $count } 次等待中的检测，丢失 { $lost } 次
history-swept = 保留规则已从历史记录中移除 { $count } 个深度帧（{ $megabytes } MB）
history-inspecting-again = 正在重新检测 { $scene }
history-other-version = { $scene } 的配方由其他版本的 Partsight 写入
history-other-version-advice = 请按“重新检测”以使用当前配方
history-changed-frame = 其文件或深度帧
history-changed-recipe = 配方
history-changed-library = 零件库
history-changed-program = 程序
history-changed-both = { $first }、{ $second }
history-other-result = { $scene } 现在的结果不同；此后发生变化的是：{ $changed }
history-other-result-advice = 历史记录保留首次结果
