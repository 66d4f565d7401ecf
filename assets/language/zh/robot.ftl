# The robot's cell
robot-title = 机器人
robot-in-use = 当前使用
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
robot-edited = 文件已被编辑：其数值视为手动输入
robot-edited-advice = 重新标定以获得残差
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
robot-store = 保存

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
