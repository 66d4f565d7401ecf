## Part and coat
paint-no-part = 零件库中没有可喷涂的零件
paint-no-such-part = { $part } 已不在零件库中
paint-part = 喷涂零件：{ $part }
paint-part-hint = 要喷涂的已注册零件
paint-recognised-gone = 上次识别的零件已不再注册：请选择要喷涂的零件
paint-film-within = 漆膜：{ $share } % 的表面在 { $target } ± { $tolerance } µm 内
paint-film-within-hint = 膜厚在公差内的可喷涂面积占比；{ $least } % 及以上为合格
paint-side-none = 选择要喷涂的一侧
paint-side-hint = 喷枪喷涂的一侧，以零件前方的相机视角为准；随零件保存
paint-side-unclear-advice = 请在上方选择从哪一侧喷涂
paint-scope-one-side = 仅限注册时相机看到的一侧
paint-scope-all-around = 此侧；零件各面均已知
paint-scope-several-sides = 朝向一侧的部分；零件从多侧注册
paint-coat = 涂层
paint-coat-changed = { $coat }，已更改
paint-coat-named = 涂层：{ $coat }
paint-coat-name = 涂层名称
paint-saved-coat = 已保存涂层 { $coat }
paint-no-coat-folder = 没有涂层文件夹
paint-no-coat-folder-advice = 请以有主文件夹的用户启动窗口

## What the film comes to
paint-thinnest-thickest = 最薄 · 最厚
paint-mean = 平均
paint-missed = 漏喷
paint-double = 双倍
paint-paintable = 可喷涂面积
paint-landed = 零件上的固体分
paint-time = 用时
paint-points = 轨迹点数
paint-histogram = 各膜厚的面积占比
paint-histogram-hint = 按目标膜厚百分比统计的面积占比；绿色在公差内

## Tools
paint-regions = 区域
paint-keep-out = 排除
paint-box = 框选
paint-keep-out-box = 排除：框选
paint-keep-out-lasso = 排除：套索
paint-brush = 画笔
paint-keep-out-brush = 排除：画笔
paint-keep-out-hint = 拖动圈出不喷涂的部分。按 Esc 恢复旋转
paint-brush-hint = 拖动涂过不喷涂的部分。按 Esc 恢复旋转
paint-only = 仅喷
paint-in-box = 框内
paint-only-box = 仅喷：框内
paint-in-lasso = 套索内
paint-only-lasso = 仅喷：套索内
paint-only-hint = 拖动圈出唯一要喷涂的部分；多个区域可叠加。按 Esc 恢复旋转
paint-clear = 清除
paint-clear-hint = 清除所有区域和手动移动的内容
paint-by-hand = 手动修正
paint-move-stroke = 移动行程
paint-move-stroke-hint = 将行程拖到应有的位置。按 Esc 恢复旋转
paint-move-point = 移动点
paint-move-point-hint = 拖动行程上的一点；相邻点随之移动。按 Esc 恢复旋转
paint-turn-gun = 转动喷枪
paint-turn-gun-hint = 从行程上的一点拖动，使喷枪向该方向倾斜。按 Esc 恢复旋转
paint-edits-dropped = 手动移动的内容属于先前的轨迹，已丢弃
paint-edits-dropped-advice = 可用“撤销”恢复；请最后再手动修正轨迹
paint-drawn-dropped = 在喷涂中于 { $part } 上绘制的内容已丢弃
paint-drawn-dropped-undo = 可用“撤销”恢复
paint-drawn-dropped-again = 该零件已移除或重新注册；请重新绘制仍需要的内容
paint-film-colours = 膜厚着色
paint-film-colours-hint = 按膜厚为零件着色

## View and timeline
paint-view = 零件及其喷涂轨迹的三维视图
paint-gun-off = 喷枪关
paint-key-play = 让喷枪沿轨迹运行或停止
paint-key-back = 上一行程
paint-key-on = 下一行程
paint-place-on = { $time } / { $end } · 行程 { $stroke } / { $all } · 喷枪开
paint-place-off = { $time } / { $end } · 行程 { $stroke } / { $all } · 喷枪关
paint-path-takes = 轨迹 { $length } m · 涂料 { $paint } ml
paint-timeline = 喷枪在轨迹上的位置，秒
paint-timeline-keys = 方向键移动喷枪，空格键播放
paint-blocks-are-strokes = 色块：喷枪开
paint-drag-to-move = 拖动可移动喷枪

## The path
paint-planning = 正在规划轨迹
paint-not-planned = 未规划：请重新选择零件
paint-previous-path = 上一条轨迹的数值
paint-proposing = 正在求取行距和速度
paint-storing-side = 正在保存喷涂侧
paint-storing = 正在保存轨迹
paint-propose = 推荐
paint-propose-hint = 求取使膜厚达到目标的行距和速度
paint-export-hint = 将轨迹写成表格
paint-export-title = 导出喷涂轨迹
paint-store = 随零件保存
paint-store-hint = 将轨迹随零件保存；此后检测和机器人程序将使用它
paint-is-stored = 此轨迹已随零件保存
paint-planned-path = 已规划
paint-stored-path = 已保存，{ $count } 个点
paint-unsaved = 喷涂中绘制的区域尚未保存为轨迹

## The robot
paint-robot = 机器人
paint-arm-group = 机械臂与喷嘴
paint-cell-group = 工位与控制器
paint-reach-group = 可达范围
paint-arm = 机械臂：{ $arm }
paint-arm-hint = 检查可达范围的机械臂；不选则不检查
paint-no-arm = 无机械臂
paint-from-file = 从文件…
paint-arm-title = 打开机械臂
paint-nozzle = 喷嘴在法兰上的位置
paint-nozzle-hint = 喷嘴口在法兰上的位置，z 为喷射方向：约定名加六个数，或矩阵的 16 个数
paint-example = 例如 { $example }
paint-no-nozzle-advice = 请在“喷嘴在法兰上的位置”中填写，或不选机械臂
paint-base = 机械臂底座
paint-base-hint = 机械臂底座在标定坐标系中的位姿，按 KUKA 的写法：先绕竖直的 z 轴转 A，再绕新的 y 轴转 B，再绕新的 x 轴转 C。全为 0：两个坐标系相同
paint-base-number = 机械臂底座：{ $name }
paint-rail = 导轨
paint-rail-hint = 机械臂所在的导轨：标定坐标系的轴、起点和终点（mm）；若沿轨迹移动，再写最高速度（mm/s），已知时再写加速度（mm/s²）。留空：用机械臂文件中的导轨
paint-no-obstacles = 仅零件
paint-obstacles = 障碍物：{ $file }
paint-obstacles-hint = 除零件外喷枪和机械臂不能碰到的东西：工位中的长方体和地面，来自 TOML 文件
paint-obstacles-title = 打开工位中的长方体
paint-more-robot = 工具、喷枪与速度
paint-tool = 控制器上的工具
paint-tool-hint = KUKA、FANUC 和 Yaskawa 用编号，ABB 和 Doosan 用名称
paint-tilted = 在 { $num } 个机械臂无法跟随的点，喷枪最多倾斜 { $degrees }°。
paint-changed-moves = 不喷涂的移动：{ $slower } 段慢于规划，{ $joints } 段为关节运动。
paint-slower-spraying = 喷涂时有 { $num } 段移动已减速，使机械臂跟得上；膜厚仍在公差内。
paint-not-calibrated = 请先在上方“机器人…”中标定工位
paint-checking-reach = 正在检查可达范围
paint-arm-not-checked = 机械臂：未检查
paint-arm-reaches-all = 机械臂：轨迹 100 % 可达，全部 { $all } 个点
paint-arm-reaches-some = 机械臂：轨迹 { $share } % 可达，{ $all } 个点中有 { $missed } 个不可达
paint-arm-reaches-hint = 机械臂无碰撞可达的轨迹点占比；全部可达才合格
paint-acceleration-advice = 用更小的涂料流量规划，在加速太慢处降低速度，或加大拐角半径
paint-joints-advice = 尝试喷嘴的其他角度、更大的喷枪倾斜、底座的其他位置或更低的速度
paint-collisions = 碰撞
paint-collisions-not-checked = 未检查
paint-no-collisions-reached = 可达处无
paint-no-collisions-part = 与零件和机械臂无
paint-num-collisions =
    { $count ->
        [0] 无
       *[other] { $count } 个点
    }
paint-show-unreached = 显示下一个
paint-rail-moves = 沿轨迹导轨位于 { $from } 至 { $to } mm 之间
paint-rail-at = 导轨在 { $at } mm 时可达 { $count } 个点
paint-base-moved = 底座移动 { $by } mm 后可达 { $count } 个点
paint-apply-rail = 把底座沿导轨移到该处
paint-apply-base = 把底座移到该处
paint-export-program = 导出程序…
paint-export-program-hint = 把轨迹写成机器人控制器的程序，零件按注册时的位置悬挂
paint-program-title = 导出机器人程序
