## The case in front
compare-case = 样本
compare-case-hint = 正在查看的场景
compare-no-case = 无
compare-in-front = { $scene }（当前显示）
compare-kept-cases = 已保存的样本
compare-no-cases-listed = 暂无
compare-asked = 实际是哪个零件？
compare-taken-for = 识别为
compare-nearest-to = 最接近
compare-nothing = 无
compare-accepted-asked = 已接受 · 实际是哪个零件？
compare-not-accepted-asked = 未接受 · 实际是哪个零件？
compare-accepted-right = 已接受，实际也是
compare-not-accepted-right = 未接受，实际也是
compare-accepted-wrong = 已接受，但实际是
compare-not-accepted-wrong = 未接受，但实际是
compare-choose-truth = 选择…
compare-truth-hint = 相机前实际悬挂的是什么
compare-against = 对比
compare-against-none = 无零件
compare-against-hint = 与该样本进行比较的已注册零件
compare-against-follows = 实际零件，否则取最佳者
compare-against-choice = 对比：{ $part }
compare-keep-case = 保存样本
compare-keep-case-hint = 将此场景与其实际零件一起保存
compare-keep-case-first = 请先选择它是什么
compare-kept-case = 已保存的样本
compare-remove-case = 移除样本
compare-run-all = 检测全部样本
compare-run-all-hint = 使用右侧的配方检测每个已保存的样本
compare-undo-keep = 撤销保存
compare-undo-removal = 恢复样本
compare-undo-truth = 撤销实际零件
compare-undo-recipe = 恢复配方
compare-undo-use = 撤销使用
compare-undo-open = 撤销打开

## The pictures
compare-nothing-to-compare = 还没有可比较的内容
compare-nothing-to-compare-advice = 请采集场景（空格键）、打开场景，或打开已保存的样本
compare-no-outline = 没有可比较的轮廓：{ $reason }
compare-no-outline-reason = 无轮廓
compare-contours = 最佳滞后下的轮廓
compare-signatures-default = 场景与零件，零件按滞后量平移
compare-signatures-paper = 按论文的写法：无滞后，Θ 折叠
compare-correlations = 自相关与互相关
compare-correlations-default = 默认：求滞后量 · ‖A − C‖₁ 为 ‖A‖₁ 的 { $share } · 坐标轴不从 0 开始
compare-correlations-paper = 论文：‖A − C‖₁ { $value } px² + rad² · 为 ‖A‖₁ 的 { $share }
compare-no-lag = 未找到滞后量
compare-overlay = 滞后 { $lag } / { $rays } · 旋转 { $angle } · 相距 { $distance }
compare-legend-query = — 场景
compare-rays = 射线，m²
compare-lag-zero-rays = 滞后 0（射线）
compare-lag-zero-pixels = 滞后 0（像素）
compare-lag-read = 滞后 { $lag }：A { $auto }，C { $cross }
compare-auto = A：自身
compare-cross = C：场景

## The distances
compare-distances = 各零件的距离
compare-distances-none = 需要轮廓
compare-distance-default = 默认：轮廓间距
compare-distance-paper = 论文：‖A − C‖₁，px² + rad²
compare-distance-in-use = { $name }（使用中）
compare-distance-paper-hint = 论文中的指标（式 11）：长度相关之差（平方像素）与角度相关之差（平方弧度）之和
compare-compare-with = 与 { $part } 比较：{ $figures }
compare-distance-hint = 轮廓间距 { $outline }（默认）· ‖A − C‖₁ { $paper } px² + rad²（论文）· 最终得分 { $score }

## The kept cases
compare-all-cases = 所有已保存的样本
compare-looking = 正在查找已保存的样本
compare-no-cases-in = { $folder } 中没有已保存的样本
compare-no-cases = 还没有已保存的样本
compare-no-cases-advice = 请采集场景、选择它是什么，然后按“保存样本”；保存的样本可显示换用其他配方后哪些变好、哪些变差
compare-folder = 文件夹…
compare-folder-of-cases = 样本文件夹…
compare-back = 返回矩阵
compare-earlier = 先前的结果…
compare-earlier-label = 与先前的结果比较…
compare-earlier-hint = 与 partsight evaluate --json 写出的先前结果比较
compare-ran-at = 检测于 { $time }
compare-false-accepts =
    { $count ->
        [0] 无误接受
       *[other] { $count } 次误接受
    }
compare-tally =
    { $total } 个中 { $right } 个正确 · { $refused ->
        [0] 无误拒绝
       *[other] { $refused } 个误拒绝
    }
compare-num-unreadable = { $count } 个无法读取
compare-run-running = 检测中，已完成 { $done } / { $total }
compare-run-stopped = 已停止，已完成 { $done } / { $total }
compare-other-recipe = 使用了其他配方
compare-run-covers = 已过时：{ $total } 个已保存样本中的 { $done } 个
compare-cases-removed = 已过时：有样本被移除
compare-running = 检测中
compare-run-hint = “检测全部样本”(Ctrl R) 显示每个样本现在被识别为什么
compare-it-is = 实际：{ $part }
compare-cell-taken-for = { $truth } 识别为 { $part }：{ $count }
compare-cell-not-accepted = { $truth }，未接受：{ $count }
compare-open-case = 打开 { $name }
compare-open-case-hint = 显示此样本
compare-remove-named = 移除 { $name }
compare-cell-refused = 误拒绝
compare-matrix-hint = 行：实际零件 · 列：接受为 · 单击单元格可打开其中的样本

## Changes since an earlier run
compare-num-worse =
    { $count ->
        [0] 无变差
       *[other] { $count } 个变差
    }
compare-num-better = { $count } 个变好
compare-num-rescored = { $count } 个得分改变
compare-num-common = 两次均有 { $count } 个样本
compare-num-new = 新增 { $count } 个
compare-num-gone = { $count } 个缺失或损坏
compare-against-file = 相对于 { $file }
compare-no-changes = 两次共有的样本结果均与之前相同
compare-worse = 变差
compare-better = 变好
compare-change-same = { $change }：{ $before } → { $now }
compare-change = { $change }：{ $is }（原为{ $was }）· { $before } → { $now }

## The recipe
compare-recipe-named = 配方 { $recipe }
compare-built-in-hint = 所有参数均为默认值
compare-is-default = 默认
compare-duplicate = 创建副本
compare-rename = 重命名…
compare-delete = 删除
compare-set-default = 设为默认
compare-built-in-stays = 内置配方不可更改
compare-nothing-to-save = 保存后没有更改
compare-not-kept = 不在已保存的配方中
compare-default-already = 已是默认配方
compare-import = 导入…
compare-take-rename = 重命名
compare-name-hint = 名称
compare-name = 配方名称
compare-save-name = 以此名称保存
compare-rename-name = 改为此名称
compare-cancel-name = 取消命名
compare-replace-title = 替换配方 { $name }？
compare-replace-why = 在此试用期间，其他程序更改了它；该版本将丢失
compare-replace = 替换
compare-expects = 预期 { $parts }
compare-num-changed = { $count } 项与默认值不同
compare-list-changes = 列出
compare-reset-all = 全部重置
compare-reset-all-hint = 将所有参数恢复为默认值
compare-parameter-change = { $parameter }：{ $value }（默认值：{ $default }）
compare-scaling = 扩展性：单核与多核对比
compare-more-changed = 更多{ $group }参数（{ $count }，已改 { $changed }）
compare-case-is-pending = 使用此配方的结果…
compare-case-is = 使用此配方的结果
compare-verdict-nearest = 未接受 · 最接近 { $part } { $score }
compare-verdict-nothing = 未接受 · 未找到零件
compare-right-accepted = 正确并已接受
compare-rightly-refused = 正确拒绝
compare-truth-not-set = 未设置实际零件
compare-use = 使用此配方
compare-use-hint = 从现在起使用它检测场景
compare-in-use-hint = 场景已在使用此配方检测

## Why a case is refused
compare-refused = 拒绝：{ $reason }
compare-refused-apart = 拒绝：{ $reason }；轮廓相距 { $distance }

## The plots
compare-calibration = 校准
compare-calibration-caption = 正确率–得分 · 误差 { $error }
compare-calibration-caption-none = 正确率–得分
compare-calibration-hint = 所有样本的最佳猜测，按得分分组：落在线上表示得分 0.9 时十次有九次正确。数字为猜测次数
compare-calibration-bin = { $from } 至 { $to }，{ $count } 个中 { $right } 个正确
compare-calibration-words = 校准：期望误差 { $error }；{ $bins }
compare-threshold = 阈值
compare-threshold-caption = 比例–最低得分
compare-threshold-words = 阈值：取 { $threshold } 时，仅凭得分会误接受 { $cases } 个样本中的 { $wrong } 个，并拒绝 { $enrolled } 个零件中的 { $refused } 个
compare-threshold-hint = 仅凭得分，各最低得分会误接受多少样本，以及会拒绝多少已注册零件。竖线为配方所用的值
compare-plot-false-accepts = 误接受
compare-plot-refused = 被拒绝的零件
compare-scaling-says = 用 1、2、4 和 8 个线程对一个场景的 8 至 2048 个仿真参考进行排名；需要几秒钟
compare-measure = 测量
compare-measure-label = 测量扩展性
compare-scaling-cores = { $cores } 个核心
compare-scaling-cores-shared = { $cores } 个核心；{ $workers } 个及以上线程共用核心
compare-scaling-from = { $cores }：参考达到 { $count } 个时多线程开始有利
compare-scaling-never = { $cores }：多线程始终无利
compare-scaling-plot = 排名用时与参考数量的关系；{ $words }
compare-one-worker = 1 个线程

## Keys
compare-key-keep = 保存当前样本
compare-key-run = 检测所有已保存的样本
compare-key-undo = 撤销保存或移除样本、设置其实际零件，或撤销移除、使用或打开配方

## Work and notices
compare-cases-title = 已保存样本的文件夹
compare-earlier-title = partsight evaluate --json 写出的文件
compare-evaluation-files = 评估结果
compare-recipe-files = 配方
compare-import-title = 要导入的配方
compare-export-title = 导出配方
compare-comparing = 正在比较
compare-listing-cases = 正在列出已保存的样本
compare-keeping-case = 正在保存样本
compare-removing-case = 正在移除样本
compare-restoring-case = 正在恢复样本
compare-saving-truth = 正在保存实际零件
compare-running-cases = 正在检测已保存的样本
compare-measuring = 正在测量排名用时
compare-comparing-earlier = 正在与先前的结果比较
compare-changing-recipes = 正在更改配方
compare-inspecting = 正在用其他配方检测
compare-nothing-to-keep = 还没有可保存的样本
compare-nothing-to-keep-advice = 请采集或打开场景，并等待检测完成
compare-kept-already = 此样本已保存
compare-kept-already-advice = 请采集或打开其他场景
compare-no-truth = 没有实际零件的样本没有意义
compare-no-cases-to-run = 没有可检测的已保存样本
compare-no-cases-to-run-advice = 请先保存样本，或选择样本文件夹
compare-no-run = 没有可供比较的检测结果
compare-no-run-advice = 请先检测全部样本
compare-kept-as = 已保存为 { $name }
compare-removed-case = 已移除 { $name }；历史中的记录保持不变
compare-restored-case = 已恢复 { $name }
compare-truth-saved = 已保存 { $name } 的实际零件；历史中的记录保持不变
compare-case-gone = 名为 { $name } 的已保存样本已不存在
compare-case-gone-advice = 请重新检测全部样本
compare-front-gone = 已保存样本 { $name } 缺失或已损坏
compare-front-gone-advice = 现在显示最近检测的场景；如需再次比较，请将样本复制回其文件夹
compare-recipe-changed-elsewhere = 配方 { $name } 已被其他程序更改
compare-recipe-changed-elsewhere-advice = 请在“比较”中打开以使用它；在此之前使用其原有参数
compare-tried-changed-elsewhere-advice = 请重新打开以试用该版本；用自己的版本替换之前会先询问
compare-recipe-gone = 配方 { $name } 已不在已保存的配方中
compare-recipe-gone-advice = 其他程序已将其重命名或删除：请在“比较”中以某个名称保存其参数，或打开其他配方
compare-saved-recipe = 已保存配方 { $name }
compare-restored-recipe = 已恢复配方 { $name }
compare-renamed-recipe = 配方 { $before } 现名为 { $now }
compare-removed-recipe = 已删除配方 { $name }
compare-default-recipe = 不带 --recipe 的命令现在使用“{ $name }”
compare-imported-recipe = 已导入配方 { $name }
compare-recipe-used = 现在使用配方 { $recipe } 检测场景：{ $count } 个参数与默认值不同
