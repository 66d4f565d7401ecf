## How a run is described
servoing-standard-position = 标准位置
servoing-camera-pose = 记录的相机位姿
servoing-path-start = 喷涂轨迹起点
servoing-looking = 正在寻找零件
servoing-moving = 正在移动
servoing-waiting = 等待“下一步”
servoing-holding = 暂停
servoing-checking = 静止检查中
servoing-arrived = 已到达目标
servoing-arrived-approximately = 已大致到达目标：零件可能是其他型号
servoing-stopped = 已停止
servoing-state-left = { $state }：还差 { $left }
servoing-tolerance = 公差
servoing-shift-left = 剩余平移，mm
servoing-turn-left = 剩余旋转，°

## The page
servoing-start = 开始
servoing-stop = 停止
servoing-stop-keys = 空格键和 Esc 也可停止
servoing-key-stop = 停止机器人
servoing-key-next = 允许下一步
servoing-running = 正在伺服
servoing-begins = 正在准备运行
servoing-stopping = 机器人正在制动
servoing-waits-for-robot-advice = 请在机器人控制器上启动程序
servoing-nothing-yet = 尚无运行
servoing-nothing-yet-advice = 请在右侧选择零件和机器人，然后按“开始”
servoing-left = 因为您离开了伺服页面，机器人已停止
servoing-left-advice = 机器人移动时请留在此页面
servoing-view = 运行的三维视图
servoing-target = 目标
servoing-nozzle = 喷嘴
servoing-flange = 法兰
servoing-error = 剩余误差
servoing-bounds = 不确定度，95 %
servoing-took = 用时
servoing-looks = 已接受的帧
servoing-looks-of = { $accepted } / { $count }
servoing-delay = 从帧到判定

## What is servoed
servoing-part-and-target = 零件和目标
servoing-remove-frame = 从目标中移除此帧
servoing-add-frame = 添加帧…
servoing-frame-title = 在相机应处的位置拍摄的零件帧
servoing-simulated = 仿真
servoing-simulated-says = 仿真工位中法兰上装有相机的机械臂，其标定误差最多为 20 mm 和 2°
servoing-listen-at = 本计算机的地址和端口
servoing-connect-to = 机器人的地址
servoing-no-safety = 伺服不是安全功能，尚未在控制器上测试：请低速试用，手不离停止按钮
servoing-limits = 限制
servoing-speed = 最高速度
servoing-in-steps = 分步
servoing-in-steps-hint = 每一步最多 50 mm 和 5°，机器人等待“下一步”后才移动
servoing-volume-says = 机器人基座坐标系中的长方体，法兰、相机和喷嘴绝不离开
servoing-clearance = 安全距离
servoing-arm = 机械臂
servoing-no-nozzle = 无
servoing-to-robot = 在“喷涂”中更改

## What is missing
servoing-no-part = 没有注册任何零件
servoing-no-part-advice = 请在“注册”中注册零件，或选择其他零件库
servoing-not-simulated-advice = 请选择程序自带的零件，或使用真实机器人
servoing-no-address = 机器人的地址缺失或有误
servoing-listen-advice = 请输入本计算机的地址和接收控制器数据包的端口，例如 192.168.1.10:6510
servoing-connect-advice = 请输入机器人的地址，例如 192.168.1.20
servoing-no-camera = 来源不是相机：帧必须显示现在悬挂的零件
servoing-no-camera-advice = 请在状态栏选择相机作为来源，或使用仿真机器人
servoing-no-frames = 目标还没有帧
servoing-no-frames-advice = 请添加在相机应处的位置拍摄的零件帧
servoing-no-arm = KUKA 机器人接收关节角，因此必须知道机械臂型号
servoing-no-arm-advice = 请在“喷涂”的“机器人”中选择机械臂并填写喷嘴
servoing-not-calibrated = 不知道相机的位置
servoing-not-calibrated-advice = 请先标定：按 B，然后选择标定

## Runs in the history
servoing-runs = 伺服运行
servoing-runs-hint = 显示视觉伺服的运行，而不是检测
servoing-runs-counted = { $matching } / { $count } 次运行
servoing-no-runs-listed = 没有符合筛选条件的运行
servoing-choose-run = 请选择一次运行以查看其曲线
servoing-row = 运行 { $number }：{ $part }，{ $end }
servoing-run-number = 运行 { $number }
servoing-source = 来源
servoing-time = 时间
servoing-wrote = 已将 { $count } 次运行写入 { $path }
