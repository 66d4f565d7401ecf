# The operator's view
operator-ok = OK
operator-not-ok = NG
operator-wait = 请稍候
operator-opening-camera = 正在打开相机…
operator-no-camera = 无相机
operator-inspecting = 正在检测…
operator-no-result = 无结果
operator-no-result-next = 请联系工程师，或按“采集”重试
operator-no-library = 无零件库
operator-no-parts = 未注册零件
operator-no-parts-why = 零件库中没有已注册的零件
operator-ask-to-enrol = 请工程师注册零件
operator-looking = 正在查看
operator-nothing-captured = 尚未采集
operator-ready = 就绪
operator-nothing-inspected = 尚未检测
operator-hang-and-capture = 挂上零件，然后按“采集”
operator-from-history = 来自历史记录，不是当前零件
operator-capture-current = 按“采集”检测当前零件
operator-simulated-next = 请工程师选择相机：此帧为仿真数据
operator-ambiguous-next = 确认零件的悬挂方向，然后启动机器人
operator-file-next = 来自文件：确认文件显示的是当前悬挂的零件，再启动机器人
operator-start-robot = 启动机器人
operator-recognised = 已识别，位姿已知
operator-an-enrolled-part = 某个已注册零件
operator-next = 下一步
operator-last-parts = 本班最近的零件
operator-none-yet = 暂无
operator-counting = 正在统计…

## Why a part is not accepted

operator-low-score = 与“{ $nearest }”的匹配度不足
operator-piece = 只能看到“{ $nearest }”的一部分
operator-hardly-seen = 可见部分太少
operator-another-model = 与“{ $nearest }”相似，但形状不同
operator-another-make = 与“{ $nearest }”相似，但尺寸不同
operator-uncertain-pose = 已识别，但位姿不确定
operator-unknown = 没有与之相似的已注册零件
operator-mirrored = 看起来是“{ $nearest }”的镜像
operator-mirrored-image = 相机图像是镜像的
operator-small-margin = 有两个已注册零件的匹配度几乎相同
operator-unconfirmed = 仅比较了轮廓
operator-out-of-range = 距相机太近或太远
operator-damaged-file = 采集文件已损坏
operator-no-pose = 可能是“{ $nearest }”，但未找到位姿
operator-not-steady = 零件尚未静止
operator-few-frames = 已检测的帧数不足
operator-undecided = 各帧结果不一致

## What an operator can do about it

operator-uncover-next = 移开遮挡零件的物体，然后按“采集”；若仍如此，请联系工程师
operator-all-in-picture-next = 将零件正面朝向相机并完全置于画面内，然后按“采集”
operator-enrol-if-painted-next = 若需喷涂，请工程师注册该零件
operator-turn-next = 将零件正面朝向相机，然后按“采集”；若仍如此，请联系工程师
operator-turn-or-enrol-next = 将零件正面朝向相机，然后按“采集”；若需喷涂，请工程师注册该零件
operator-mirrored-next = 请勿按“{ $nearest }”喷涂：请工程师注册这一侧的零件
operator-mirrored-image-next = 请勿启动机器人：请工程师纠正相机设置
operator-small-margin-next = 将零件正面朝向相机，然后按“采集”；若仍如此，请工程师从零件库中移除其中一个
operator-unconfirmed-next = 请工程师启用位姿估计
operator-check-camera-next = 请工程师检查相机及其文件
operator-hang-next = 将零件挂在相机前，距墙至少 10 cm，然后按“采集”
operator-hang-or-empty-cell-next = 将零件挂在相机前，距墙至少 10 cm，然后按“采集”；若零件已挂好，请工程师重新采集空工位
operator-uncover-camera-next = 移开遮挡相机的物体，然后按“采集”；若仍如此，请联系工程师
operator-turn-part-next = 将零件正面朝向相机，然后按“采集”；若仍如此，请联系工程师
operator-ask = 请联系工程师
operator-reaches-edge = 零件到达画面边缘：请将其完全挂在画面内
operator-reaches-edge-ok = 零件到达画面边缘：请将下一件挂得更靠内

## The bars above and below

operator-locked-says = 已锁定：需要输入 PIN (Ctrl K)
operator-history-says = 所有已检测的零件
operator-shift-since = 本班自 { $time }
operator-num-parts = { $num } 件
operator-num-ok = { $num } OK
operator-num-not-ok = { $num } NG
operator-stop-live-says = 停止自动检测每个零件 (L)
operator-live-says = 零件静止后自动检测 (L)
operator-wrong-part = 零件不对？
operator-wrong-part-says = 打开历史记录，指明实际零件
operator-source = 来源：{ $source }
operator-serial = 序列号
operator-serial-hint = 扫描或输入
operator-serial-for-next = 用于下一个检测的零件
operator-serial-entered = 已输入序列号 { $serial }
operator-serial-known = { $serial } 已是此零件的序列号
operator-serial-in-shift = { $serial } 已是本班次某个零件的序列号
operator-serial-in-shift-next = 请核对：如果不对，请扫描正确的序列号
operator-serial-replaced = { $serial } 已替换尚未用于任何零件的 { $former }
operator-serial-replaced-next = 如果 { $former } 才正确，请重新扫描
operator-robots-without-pose = 机器人得不到位姿：请工程师标定工位
operator-robots-without-frames = 机器人未收到帧：请按“实时”
operator-robots-without-source = 机器人未收到帧：请工程师选择相机
operator-not-recorded = 未保存
operator-not-recorded-says = 无法写入历史：请询问工程师。在此之前检测仅保留在内存中
operator-order = 订单
operator-operator = 操作员
