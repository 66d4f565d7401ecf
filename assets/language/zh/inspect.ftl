# The Inspect workspace

## The verdict

inspect-unknown-part = 未知零件
inspect-not-recognised = 未识别
inspect-no-verdict = 无判定
inspect-live-stopped = “实时”在判定生效前已停止
inspect-stopped-moving = 停止“实时”时有物体在移动
inspect-press-capture = 按“采集”
inspect-something-moves = 相机前有物体在移动
inspect-looking = 正在查看
inspect-not-long-enough = 观察时间不足
inspect-it-is-steady = 零件已静止
inspect-not-accepted-yet = 尚未接受
inspect-nearest = 最接近：{ $part }
inspect-recognised = 已识别
inspect-hold-simulated = 仿真：未读取相机
inspect-hold-replayed = 回放自录制：零件并未悬挂在那里
inspect-hold-choose-camera = 选择相机作为来源
inspect-hold-choose-camera-operator = 请工程师选择相机
inspect-hold-not-calibrated = 未标定：机器人得不到位姿
inspect-hold-not-calibrated-operator = 请勿启动机器人：请联系工程师标定工位
inspect-hold-clock-operator = 请勿启动机器人：请联系工程师校准时钟
inspect-hold-old = 采集已超过 10 分钟：零件现在的位置可能不同
inspect-hold-old-file = 来自超过 10 分钟的文件：零件现在的位置可能不同
inspect-hold-open-newer = 打开更新的采集，或选择相机作为来源

## The card

inspect-previous-result = 上次结果：正在进行新的检测
inspect-outdated = 上次结果：此后来源未提供新数据
inspect-from-history = 来自历史记录，不是当前零件
inspect-other-empty-cell = 空单元来自另一台相机，未被使用；请用这台相机重新采集
inspect-touches-edge = 零件到达画面边缘：部分可能缺失
inspect-approximate = 位姿为近似值：可能是该零件的其他型号
inspect-parts-accepted = { $all } 个中 { $num } 个已接受
inspect-export = 导出…
inspect-export-says = 报告：JSON、一页 PDF、位姿表中的一行以及所有步骤的图片 (Ctrl E)
inspect-wrong-part = 零件不对？
inspect-wrong-part-says = 在“比较”中查看为何识别为该零件
inspect-why = 为什么？
inspect-why-says = 在“比较”中查看为何未被接受
inspect-enrol-this = 注册此零件
inspect-add-reference = 添加参考
inspect-calibrate = 标定工位
inspect-copy-pose = 复制位姿
inspect-copy-pose-says = 采用所选约定，首行注明名称 (Ctrl Shift C)
inspect-score-itself = 零件本身的得分（非镜像）
inspect-as-part = 按“{ $part }”计（未接受）
inspect-next = 次优：{ $part } { $score }
inspect-threshold = 阈值 { $score }
inspect-margin = 与次优零件的裕度 { $margin }
inspect-margin-says = 仅可能是两个零件之一时两者概率之差；不是得分之差
inspect-offset = 相对标准位置的偏移
inspect-measured-from = 以该零件的另一参考“{ $part }”为基准测量
inspect-offset-note = 零件中心，相机坐标轴 · R = Rz·Ry·Rx
inspect-fit = 拟合
inspect-rms = rms
inspect-overlap = 重叠率
inspect-unconstrained = 未约束：{ $freedom }
inspect-pose-uncertainty = 位姿不确定度 (95 %)
inspect-runner-up = 次优位姿
inspect-times-worse = 差 { $ratio } 倍
inspect-as-good = 同样好
inspect-iterations = { $num } 次迭代
inspect-ambiguous = 另一位姿同样匹配：请确认零件的悬挂方向
inspect-surface = 表面
inspect-surface-is = 表面：{ $verdict }
inspect-surface-advice = 在零件继续流转之前，请查看圈出的部位
inspect-surface-region = 偏差部位
inspect-surface-frames = 平均帧数
inspect-surface-seen = 面向相机一侧的已判定比例
inspect-surface-noise = 平均值的噪声
inspect-surface-smallest = 宽 { $width } 的凹陷，可检出深度
inspect-inspection = 检测
inspect-time = 耗时
inspect-scene = 场景
inspect-simulated = 仿真
inspect-serial = 序列号
inspect-order = 订单
inspect-operator = 操作员
inspect-recipe = 配方

## Stand-off

inspect-stand-off = 假定轨迹的喷距
inspect-stand-off-stored = 已存轨迹的喷距
inspect-mean = 平均
inspect-worst-of = { $value }，最差 { $worst }
inspect-in-band = 合格范围内
inspect-points-in-band = { $inside } / { $num } 个点
inspect-points-not-seen = { $all } 个点中有 { $count } 个点相机看不到零件，未检查
inspect-path-not-seen = 相机在轨迹的任何点都看不到零件
inspect-angle = 角度
inspect-angle-counts = { $count ->
        [0] 合格还要求角度不超过 { $limit }
       *[other] 合格还要求角度不超过 { $limit }；有 { $count } 个点超过
    }
inspect-path-fits = 无需位姿即可使用该轨迹
inspect-path-needs-pose = 机器人程序必须将位姿应用于轨迹
inspect-stand-off-of = 喷距 { $mean }，范围 { $nearest } 至 { $farthest }

## The pose for the robot

inspect-robot-frame = 机器人基坐标系，依据 { $name }
inspect-camera-frame = 相机坐标系：工位未标定
inspect-camera-frame-only = 相机坐标系：机器人不得使用此结果
inspect-convention-of = 约定：{ $name }
inspect-convention-says = 位姿显示、复制和写出时的约定；应答机器人的约定在“机器人…”中
inspect-no-pose-to-copy = 没有可复制的位姿：零件未被接受
inspect-no-pose-advice = 按照卡片上的提示操作，然后重新采集
inspect-pose-copied = 已按约定 { $convention } 复制 { $name }

## The view

inspect-colour = 着色 · { $colouring }
inspect-show = 显示
inspect-export-path = 导出喷涂轨迹…
inspect-export-path-says = 需要已接受且存有喷涂轨迹的零件，以及已标定的工位
inspect-measure = 测量
inspect-measure-says = 点击两个点 (M)
inspect-picture = 图片…
inspect-picture-says = 保存视图图片 (P)
inspect-fit-view = 适配
inspect-fit-view-says = 适配零件 (F)
inspect-front = 正面
inspect-top = 顶面
inspect-side = 侧面
inspect-part-axes = 零件坐标轴
inspect-part-camera = 深度相机
inspect-part-outline = 已注册轮廓
inspect-part-nozzle-middle = 中部上方的喷嘴
inspect-part-nozzle-worst = 最差部位的喷嘴
inspect-part-spray-path = 喷涂轨迹
inspect-part-shot-cameras = 各次拍摄的相机
inspect-part-unseen = 所有拍摄均未看到
inspect-needs-pose = 需要已识别且已找到位姿的零件
inspect-needs-camera = 需要相机已知的单次采集
inspect-needs-no-path = 需要已接受且未存喷涂轨迹的零件
inspect-needs-path = 需要已接受且存有喷涂轨迹的零件
inspect-needs-calibration = 需要已标定的工位
inspect-needs-scan = 需要扫描
inspect-caption-planes = { $points } 个点 · 零件 { $part } · 已移除 { $planes } 个背景平面
inspect-caption-shots = { $points } 个点 · 零件 { $part } · 合并 { $shots } 次拍摄
inspect-no-camera-read = { $scene } · 未读取相机
inspect-view-of-scene = 场景三维视图
inspect-other-surface = 其他表面
inspect-taught-nozzle = 假定喷嘴
inspect-worst = 最差
inspect-path-in-band = 喷涂轨迹 · 已检查的 { $num } 点中 { $inside } 点在合格范围内

## The stages

inspect-contour = 轮廓
inspect-signatures = 特征曲线
inspect-ranking = 排名
inspect-alignment = 配准
inspect-enlarge-segmentation = 放大分割
inspect-enlarge-binary-image = 放大二值图像
inspect-enlarge-contour = 放大轮廓
inspect-enlarge-signatures = 放大特征曲线
inspect-enlarge-ranking = 放大排名
inspect-enlarge-alignment = 放大配准
inspect-enlarged = { $stage }（放大）
inspect-enlarged-without = { $stage }（放大）：{ $why }
inspect-says-segmentation = 背景平面为暗色，零件为亮色
inspect-says-binary-image = 零件在其两条最长主轴平面上的投影
inspect-says-contour = 轮廓、开口、自质心的射线；虚线：已注册零件
inspect-says-signatures = 射线的长度 L 和角度 Θ；虚线：已注册零件
inspect-says-ranking = 各已注册零件的得分与阈值
inspect-says-alignment = 每次迭代的均方距离 E（对数）
inspect-stages = 步骤
inspect-not-reached = 未到达
inspect-no-picture = 无图像：点云没有行和列
inspect-not-examined = 未检查
inspect-e-stayed-zero = E 保持为 0
inspect-ended-at = { $part } 结束时 rms { $rms }
inspect-papers-threshold = 论文阈值 1e−6 m²
inspect-not-asked-for = 未配准：未要求位姿
inspect-flat-shape = 未配准：注册为平面形状
inspect-no-pose-found = 未配准：未找到位姿
inspect-score-too-low = 未配准：得分过低，未尝试
inspect-capture-cell = 按“采集”获取仿真工位的一帧，或将采集的场景拖放到此处
inspect-capture-or-drop = 按“采集”，或将采集的场景拖放到此处

## Shortcuts and files

inspect-does-redo = 重做上次撤销的拍摄更改
inspect-does-undo = 撤销扫描拍摄的上次更改
inspect-does-picture = 保存三维视图图片
inspect-does-contour = 显示或隐藏已注册轮廓
inspect-does-nozzle = 显示或隐藏最差部位的喷嘴
inspect-does-copy = 按所选约定复制位姿
inspect-does-previous-part = 选择该帧的上一个零件
inspect-does-next-part = 选择该帧的下一个零件
inspect-report-folder = 本次检测报告的文件夹
inspect-save-picture = 保存视图图片
inspect-pictures = 图片
inspect-export-path-title = 为机器人导出喷涂轨迹
inspect-saving-picture = 正在保存图片
inspect-writing-report = 正在写入报告
inspect-writing-path = 正在写入喷涂轨迹
inspect-picture-saved = 已保存图片 { $path }
inspect-no-spray-path = 当前显示的零件没有喷涂轨迹
inspect-no-spray-path-advice = 为零件存储轨迹，并采集可被接受的零件
inspect-path-written = 已写入 { $path }：{ $num } 点中 { $inside } 点在合格范围内，格式 { $convention }
inspect-path-not-written = 未写出喷涂轨迹：{ $why }
inspect-report-written = 已将 { $files }、各步骤图片和 { $table } 中的一行写入 { $folder }
inspect-report-set-aside = 已将 { $files }、各步骤图片和 { $table } 中的一行写入 { $folder }；其最后一行不完整，已移至 { $aside }
inspect-watching-folder = 正在监视文件夹

## The values under the pointer

inspect-at-reading = 第 { $column } 列，第 { $row } 行：距相机 { $depth }
inspect-at-no-reading = 第 { $column } 列，第 { $row } 行：无读数
inspect-at-surface = x { $x }，y { $y }，高度 { $height }
inspect-at-plane = x { $x }，y { $y }
inspect-at-ray = x { $x }，y { $y } · 距质心 L { $length }，Θ { $angle }
inspect-at-iteration = 第 { $iteration } 次迭代：E { $e } m²
