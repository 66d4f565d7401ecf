## What is aligned
align-moved-copy = 移动的副本
align-files = 两个文件
align-run = 运行
align-run-hint = 用每种方法配准 (R)
align-view-menu-hint = 应用于所有三维视图
align-library-failed = 无法加载零件库
align-part-hint = 作为参考的已注册零件
align-start = 起始
align-custom = 自定义…
align-random = 随机
align-random-hint = 下一个随机起始位姿
align-random-prefix = 编号
align-random-number = 随机起始位姿编号 { $number }
align-numbers = rx { $rx }°，ry { $ry }°，rz { $rz }°，然后 x { $x } mm，y { $y } mm，z { $z } mm
align-custom-hint = rx ry rz x y z，例如 0 0 30deg 100mm 0 0
align-custom-label = 自定义起始位姿，六个数值
align-use-start = 使用此起始位姿
align-custom-units = 弧度和米，或带单位：deg、mm、cm、m；R = Rz·Ry·Rx
align-scene-part = { $scene }：找到的零件，{ $count } 个点，从其所在位置开始
align-source = 源
align-target = 目标
align-source-hint = 被移动的点云或网格
align-target-hint = 保持不动的点云或网格
align-custom-start = 自定义起始位姿
align-random-start = 随机起始位姿 { $seed }
align-from = { $part } · { $start }
align-library-has-no-part = 零件库中没有零件：请在“注册”中注册
align-nothing-inspected = 尚未检测：请按“采集”
align-no-part-in-scene = 场景中未找到零件：请重新采集
align-choose-source = 请选择被移动的文件：源…
align-choose-target = 请选择保持不动的文件：目标…

## The views
align-view-of = 三维视图，{ $method }
align-previous-result = 这是上一次的结果：正在重新配准
align-at-work = 运行中…
align-not-run = 未运行
align-figures = E { $e } m² · rms { $rms }（重叠 { $overlap } %）· { $time } ms
align-no-pose-figures = 无位姿 · { $time } ms
align-end = 结束，共 { $count } 次迭代
align-iteration-e = 迭代 { $iteration } / { $last } · E { $e } m²
align-aligning-now = 正在配准…
align-nothing-aligned = 尚未配准
align-nothing-aligned-advice = 在上方选择零件和起始位姿，然后按“运行”
align-ended-below-threshold = 已达阈值：E 低于 1e-6 m²，{ $count } 次迭代
align-ended-below-threshold-says = E（式 12）低于 1e-6 m² 时，算法 3 结束
align-ended-elsewhere = { $count } 次迭代后收敛到其他位置
align-ended-elsewhere-says = 最后一步低于限值，但与真实位姿相差超过 5°：E 的局部极小值
align-ended-converged = { $count } 次迭代后收敛
align-ended-converged-says = 最后一步低于限值：位姿不再变化
align-ended-above-threshold = 未达阈值：{ $count } 次迭代中的最佳结果
align-ended-above-threshold-says = E 低于 1e-6 m² 时，算法 3 结束。E 一直高于该值，且最后几轮未找到更好的位姿：这是最佳位姿。无论位姿多好，仅相机噪声就会使 E 高于阈值
align-ended-limit = 已达最大迭代次数：{ $count }
align-ended-limit-says = 最后一步时位姿仍在变化
align-nearer-or-same-part = 请选择更近的起始位姿，或检查两个点云是否都以米为单位显示同一零件
align-which-way-round = 检查零件的朝向
align-look-for-edge = 请寻找零件上唯一的边缘或弯折
align-other-method = 请尝试其他方法，或更近的起始位姿
align-nearer-start = 请选择更近的起始位姿

## The plot
align-genetic-search = 遗传搜索
align-threshold = 阈值 1e-6（算法 3）
align-iteration = 迭代 { $iteration } / { $last }
align-iteration-hint = 迭代 { $iteration } / { $last } · 拖动以查看，按 P 播放
align-scrubber = 显示的迭代
align-scrubber-keys = 每次迭代的 E。左右键移动一次迭代，Page Up 和 Page Down 移动十次，Home 和 End 到两端，P 播放
align-no-way = 没有方法找到位姿：无过程可显示
align-way = 按“运行”后，此处显示均方距离 E 逐次迭代下降的过程

## Table I
align-table = 表 I
align-table-says = 每个已注册零件按 T1 至 T5（式 15）移动，再用每种方法还原：E 单位为 m²，每行标出最佳者
align-cancel-table = 取消表 I
align-run-table = 计算表 I
align-go-on = 继续
align-go-on-table = 继续计算表 I
align-again = 重新运行
align-table-again = 重新计算表 I
align-rows-done-left = 已完成 { $done } / { $total } · 约剩 { $time }
align-rows-done = 已完成 { $done } / { $total }
align-rows = { $total } 行
align-rows-stopped = 停在 { $done } / { $total }
align-rows-all = 全部 { $total } 行完成
align-column-part = 零件，起始
align-none = 无
align-best = 最佳
align-no-pose = 无位姿
align-true-error = 该起始位姿下的真实误差
align-uncertainty = 配准的不确定度（95 %）
align-uncertainty-says = 仅凭两个点云的点，这些位姿可能的偏差。检测还利用图像中的轮廓，因此其位姿的不确定度通常更小
align-method = 方法
align-rotation = 旋转
align-shift = 平移
align-unconstrained = 未约束
align-copy = 复制
align-copy-hint = 将表 I 作为文本，单元格以制表符分隔

## Keys
align-key-run = 运行所有方法
align-key-play = 播放或暂停迭代
align-key-back = 后退一次迭代
align-key-on = 前进一次迭代
align-keys-play = P，或在图中按空格键
align-keys-back = , 或在图中按 ←
align-keys-on = . 或在图中按 →

## Work and notices
align-open-title = 打开点云或网格
align-export-title = 导出表 I
align-aligning = 正在配准
align-copied = 已复制表 I
