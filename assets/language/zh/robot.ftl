# The robot's cell
robot-title = 机器人
robot-in-use = 标定
robot-by-hand = 手动输入
robot-from-pairs = 由位姿对计算
robot-load-title = 加载机器人工位的标定
robot-calibrations = 标定
robot-pairs-title = 机器人与相机位姿对
robot-tables = 表格和 JSON
robot-forgotten = 不再使用该标定；其文件保留
robot-opening = 正在打开标定
robot-saving = 正在保存标定
robot-calculating = 正在计算相机位置
robot-no-folder = 没有用于存放标定的文件夹
robot-no-folder-advice = 用 partsight calibrate --out FILE 写入，然后在此加载该文件
robot-saved = 已保存；原标定保留在 { $path }

## In use

robot-not-calibrated = 工位未标定：位姿位于相机坐标系，机器人无法使用
robot-file = 文件
robot-edited = 标定的数值被更改且未确认：机器人得不到位姿
robot-edited-advice = 请在“机器人…”中检查数值；正确则确认，否则重新标定
robot-confirm = 确认…
robot-confirm-says = 相机确实在此处吗？数值将视为手动输入，机器人将按其获得位姿。旧文件会保留
robot-confirm-not = 暂不
robot-confirm-right = 数值正确
robot-load = 加载…
robot-forget = 弃用
robot-cell = 工位
robot-camera = 相机
robot-made = 创建
robot-from = 来源
robot-entered-by-hand = 手动输入
robot-pairs-of = { $file } 中的 { $num } 对
robot-residuals = 残差
robot-residuals-are = { $mm } mm 和 { $degrees }° rms，最差 { $worst } mm（{ $pair }）
robot-uncertainty = 不确定度 (95 %)
robot-mm-and-degrees = { $mm } mm 和 { $degrees }°
robot-flange-at-every = 每次采集的 robot_from_flange
robot-flange-unknown = 采集时的法兰位姿未知：没有可供机器人使用的位姿
robot-flange-unknown-advice = 按控制器显示输入法兰位姿并保存
robot-flange-at = 采集时的法兰

## By hand

robot-camera-in-cell = 相机固定于工位
robot-camera-on-flange = 相机安装于法兰
robot-numbers-of = 数值格式
robot-numbers-are-of = 数值格式：{ $convention }
robot-where-camera-stands = { $transform }：相机坐标系的位置
robot-name-of-cell = 工位名称
robot-use-it = 使用
robot-use-anyway = 仍然使用

## From pairs

robot-choose-pairs = 选择位姿对…
robot-choose-pairs-says = 机器人与相机位姿的表格或 JSON，8 至 15 对
robot-pairs-format = 每行包含机器人位姿（按控制器显示的法兰），然后是相机位姿（所见标定物的位置）。文件开头的 "# robot: kuka" 和 "# camera: matrix" 等行指明约定。已注册零件也可作为标定物：partsight calibrate hand-eye --captures
robot-counts = 计入
robot-off-mm = 偏差 mm
robot-off-degrees = 偏差 °
robot-worst = 最差
robot-left-out = 已排除
robot-rms = 残差 rms
robot-not-determined = 位姿对不足以确定
robot-flange-turned = 法兰转动
robot-span = 最大 { $turn }°，绕其他轴 { $other }°；标定物移动 { $travel } mm
robot-read-as = 读取格式
robot-conventions-are = 机器人 { $robot }，相机 { $camera }
robot-eye-to-hand = 眼在手外：相机固定于工位
robot-eye-in-hand = 眼在手上：相机安装于法兰

## Check of the cell

robot-check = 工位检查
robot-check-says = 每天挂在同一位置的零件可显示相机和工位是否仍在原位。任何各方向都有边缘的刚性物体均可；画面中请保留部分墙或地面
robot-check-no-folder = 没有用于存放基准和检查结果的文件夹
robot-check-no-folder-advice = 请使用 partsight cell 并指定 --folder DIR
robot-no-baseline = 没有可供比较的基准
robot-no-baseline-advice = 请在工位状态正确时采集基准
robot-baseline = 基准
robot-taken-at = { $time }，{ $count } 帧
robot-allowed = 允许
robot-allowed-are = { $shift } 和 { $turn }
robot-no-wall = 基准画面中既没有墙也没有地面：检查无法区分是相机还是零件移动
robot-no-wall-advice = 请在画面中保留部分墙或地面，并采集新的基准
robot-frames-from = 帧来源
robot-new-baseline-allows = 新基准允许
robot-allowed-shift = 允许的平移，mm
robot-allowed-turn = 允许的旋转，度
robot-take-baseline = 采集基准
robot-take-new-baseline = 采集新的基准…
robot-check-now = 立即检查
robot-replace-says = 要替换基准吗？此后的检查将与新基准比较，旧基准不保留
robot-keep-baseline = 保留
robot-replace-baseline = 替换
robot-reading-checks = 正在读取基准和检查结果
robot-taking-baseline = 正在采集基准
robot-checking = 正在检查工位
robot-writing-checks = 正在写入检查结果
robot-check-of-scan = 扫描从多个位置拍摄，不能用于检查工位
robot-check-of-scan-advice = 请选择相机作为来源，或打开单次采集
robot-last-check = 最近一次检查
robot-checked = 检查时间
robot-of-allowed = { $value }，允许 { $limit }
robot-part-shifted = 零件平移
robot-along-axes = 沿相机 x、y、z 轴
robot-part-turned = 零件旋转
robot-wall-shifted = 墙和地面平移
robot-wall-not-found = 均未重新找到
robot-readings = 测量值
robot-readings-are = 相对基准 rms { $rms }，噪声为其 { $ratio } 倍
robot-checks-shown = 共 { $count } 次检查，显示最近 { $shown } 次
robot-shift-over-time = 相对基准的平移，沿相机 x、y、z 轴
robot-check-time = 时间
robot-check-shift = 平移
robot-check-turn = 旋转
robot-check-finding = 结果
robot-export-checks-title = 导出工位检查结果
robot-checks-written = 已将 { $count } 次检查写入 { $path }
robot-moved = 最近一次工位检查，{ $time }：{ $finding }
robot-moved-advice = 喷涂前请工程师查看：“机器人…”中的“工位检查”

## Answering robots

robot-answer = 应答机器人
robot-answer-says = 机器人和 PLC 通过 TCP 请求检测，并获得判定和位姿，与 partsight serve 相同。每次触发都由窗口来源在其后给出的一帧回答。SERVO 使用“伺服”页面的目标和限值
robot-protocol = 协议
robot-port = 端口，或 IP 地址和端口
robot-pose-of-part = 零件的位置
robot-pose-offset = 相对标准位置的偏移
robot-poses-as = 位姿格式
robot-answered-in = 应答约定：{ $convention }
robot-change-poses = 正在应答机器人：下一个位姿的数字含义将会改变
robot-change-poses-advice = 请先停止机器人并调整其程序。所有连接将断开，boot 编号会改变
robot-change-poses-do = 更改
robot-change-poses-not = 保持不变
robot-no-address = “{ $text }”不是端口，也不是带端口的 IP 地址
robot-no-address-advice = 输入 1 至 65535 的端口，或加上本机网卡的地址，例如 192.168.1.10:30100
robot-other-convention = 请选择其他约定
robot-turn-on = 打开
robot-turn-off = 关闭
robot-calibrate-first = 请先标定：否则无法给出位姿
robot-answers-at = 应答机器人 · { $at }
robot-answers-without-frames = 应答机器人，无帧
robot-answers-without-frames-advice = 请按“实时”：在此之前每次触发都返回错误
robot-answers-soon = 正在启动应答
robot-not-answered = 未应答机器人
robot-port-in-use = 无法使用 { $at }：其他程序正在使用此端口
robot-port-in-use-advice = 请关闭其他程序，或选择其他端口。每 3 秒重试一次
robot-cannot-listen-advice = 请选择 1024 以上的其他端口，或本机网卡的地址
robot-listens-at = 地址
robot-clients = 连接数
robot-last-client = 最近的连接
robot-client-connected = { $peer } 已连接
robot-client-left = { $peer } 已断开
robot-client-turned-away = { $peer } 被拒绝：连接数已达上限
robot-client-turned-away-advice = 请关闭未使用的连接
robot-last-trigger = 最近一次触发
robot-no-trigger = 尚无
robot-answer-number = 第 { $number } 次
robot-answer-age = 帧龄 { $age } ms
robot-answer-motion-unchecked = 未检查零件是否移动
robot-part-numbers = 零件编号

## Poses and conventions
robot-motion-unknown = 无法得知零件是否静止

## 未检查的内容
