# The bars, the source, settings, files and shortcuts

## Bars

shell-capture = 采集
shell-live = 实时
shell-open = 打开…
shell-robot = 机器人…
shell-help = 帮助
shell-cancel = 取消
shell-close = 关闭
shell-redo = 重做
shell-more = 更多{ $group }参数（{ $count }）
shell-export-csv = 导出 CSV…
shell-export = 导出…
shell-save-as = 另存为…
shell-save = 保存
shell-wrote = 已写入 { $path }
shell-writing = 正在写入 { $file }
shell-csv-files = 逗号分隔值
shell-stop-live-says = 停止跟踪来源 (L)
shell-live-says = 跟踪来源，检测尽可能多的帧 (L)
shell-robot-says = 标定、工位检查和对机器人的应答 (B)
shell-calibrated-by = 标定文件：{ $name }
shell-no-flange-pose = 采集时的法兰位姿未知
shell-calibration-edited = 标定的数值被更改且未确认
shell-not-calibrated = 相机在机器人工位中的位置：未标定
shell-dark = 深色
shell-light = 浅色
shell-to-dark = 切换为深色 (T)
shell-to-light = 切换为浅色 (T)
shell-to-units = 切换为 { $units } (U)
shell-language-says = 界面语言
shell-language-of = 语言：{ $language }
shell-num-parts = { $num } 个零件
shell-library-named = { $num } 个零件 · { $name }
shell-no-library = 无零件库
shell-library-in-use = 当前零件库
shell-library-version = { $store } 的版本 { $version }
shell-library-version-changed = { $store } 的版本 { $version }，此后在本机有改动
shell-use-another-library = 使用其他零件库…
shell-use-usual-library = 使用默认零件库
shell-progress = { $work } · { $done }/{ $total }

## Workspaces and views

shell-inspect = 检测
shell-enrol = 注册
shell-compare = 比较
shell-align = 配准
shell-paint = 喷涂
shell-servo = 伺服
shell-history = 历史
shell-operator = 操作员
shell-engineer = 工程师
shell-operators-view = 操作员视图
shell-engineers-view = 工程师视图
shell-to-engineer = 切换到工程师视图 (Ctrl K)
shell-set-pin = 设置 PIN…
shell-set-pin-says = 设置 PIN 后，窗口以操作员视图启动
shell-change-pin = 更改 PIN…
shell-remove-pin = 移除 PIN
shell-remove-pin-asked = 移除 PIN？之后任何人都可以切换到工程师视图
shell-lock-after = 自动锁定
shell-minutes = { $num } 分钟
shell-enter-pin = 输入 PIN 以更改配方、阈值、零件库、工位和来源
shell-unlock = 解锁
shell-may-change = 在此视图中可更改配方、阈值、零件库、工位和来源
shell-switch = 切换
shell-new-pin = 新 PIN
shell-new-pin-says = 四至八位数字，用于保护工程师视图
shell-next = 下一步
shell-same-digits = 再次输入相同的数字
shell-set-the-pin = 设置 PIN
shell-pin-forgotten = 忘记 PIN？请询问工程师
shell-num-digits = { $num } 位数字
shell-erase = 删除
shell-digit = 数字 { $digit }
shell-locked = 已锁定：窗口已闲置一段时间
shell-pin-removed = PIN 已移除
shell-wrong-pin = PIN 错误
shell-four-digits = 至少四位数字
shell-pins-differ = 两次输入不一致：请输入新 PIN
shell-pin-set = PIN 已设置：窗口将以操作员视图启动

## What a scene truly shows

shell-actual-part = 实际零件：{ $part }
shell-truth-not-set = 未设置
shell-truth-not-enrolled = 未注册
shell-truth-nothing = 无（空工位）

## The status bar

shell-days = { $num } 天
shell-status-from-pairs = 手眼标定
shell-status-made-ago = { $kind }，{ $age }前
shell-status-edited = 已修改
shell-status-no-flange-pose = 无法兰位姿
shell-status-not-calibrated = 未标定
shell-status-robots-off = 未应答机器人
shell-status-robots-off-says = 没有机器人得到应答：应答已关闭
shell-status-not-answered = 无应答
shell-status-no-frames = 无帧
shell-status-robots-start = 正在启动
shell-status-listens = 监听中
shell-status-last-answer = 上次应答：{ $answer }
shell-status-live-off = “实时”已关
shell-status-live-off-says = “实时”已关闭：不监视零件是否静止
shell-status-motion-unknown = 没有收到帧：不知道零件是否静止
shell-status-no-frame = 尚未采集任何帧
shell-status-frame-age = 屏幕上的帧的时间：{ $age }前
shell-status-speed = 此计算机检测了 { $frames } 帧中的 { $inspected } 帧
shell-status-speed-unknown = “实时”开启时测量此计算机的速度
shell-status-drift = 漂移

## The source

shell-simulated-cell = 仿真工位
shell-source-button = 来源 · { $source }
shell-source-says = “采集”和“实时”的场景来源
shell-simulated = 仿真 · { $what }
shell-scan-of = 扫描 { $name }
shell-cell-set-up = 仿真工位（自定义）
shell-recording-of = 录制 { $name }
shell-folder-of = 文件夹 { $name }
shell-set-up-cell = 设置工位…
shell-cameras-and-folders = 相机和文件夹
shell-play-recording = 播放录制…
shell-play-recording-says = 深度图像或点云的文件夹：“实时”播放和暂停，“采集”取下一帧
shell-watch-folder = 监视文件夹…
shell-watch-folder-says = 检测其他程序保存到该文件夹的每次采集
shell-open-file = 打开文件…
shell-open-file-says = 单次采集
shell-open-scan = 打开扫描…
shell-open-scan-says = 同一零件多次拍摄的文件夹，每次拍摄均带相机位姿 (Ctrl Shift O)
shell-average-depth = “实时”深度平均帧数
shell-one-frame = 1 帧
shell-recent-files = 最近的文件
shell-empty-cell = 空工位
shell-capture-empty-cell = 采集空工位
shell-capture-empty-cell-says = 当前场景成为空工位：此后其中的任何物体都不视为零件
shell-discard-empty-cell = 放弃空工位
shell-no-empty-cell = 尚未采集空工位
shell-empty-cell-discarded = 已放弃空工位
shell-cell-not-empty = 工位不是空的：其中挂有零件
shell-cell-not-empty-advice = 移走零件并采集，然后按“采集空工位”
shell-empty-cell-doubt = 已采集空工位，但其中有零件大小的物体
shell-empty-cell-doubt-advice = 若为零件：在“来源”中选择“放弃空工位”，移走零件后先采集
shell-empty-cell-captured = 已采集空工位：从下次采集起，其中的任何物体都不视为零件

## What is at work

shell-capturing = 正在采集
shell-opening = 正在打开 { $name }
shell-waiting-for-file = 等待新文件
shell-same-capture = 已再次检测 { $scene }：其内容未变化
shell-inspecting-again = 正在重新检测
shell-opening-library = 正在打开零件库
shell-loading-library = 正在加载零件库
shell-reloading-library = 正在重新加载零件库
shell-library-reloaded = 零件库已重新加载（被其他程序更改）：{ $num } 个零件
shell-path-off-part = { $part }：保存的喷涂轨迹未对准零件，机器人不会得到它
shell-counting-parts = 正在统计零件
shell-writing-settings = 正在保存设置

## Settings

shell-settings-not-used = 未使用设置：{ $why }
shell-settings-set-aside = 已将其移至 { $path }；窗口以默认设置启动
shell-settings-values-not-used = 无法使用 { $path } 中的 { $keys }，{ $num ->
   *[other] 使用默认值
}；其他设置不变
shell-settings-kept-beside = 原文件保存为 { $path }
shell-settings-move-away = 请移走该文件：无法自动移开（{ $why }）
shell-settings-not-kept = 设置未保存：{ $why }
shell-settings-not-kept-advice = { $advice }；在此之前不保存设置
shell-report-settings = 请报告所更改的设置

## Files

shell-all-files = 所有文件
shell-scenes-clouds-meshes = 场景、点云和网格
shell-captured-scenes = 采集的场景
shell-open-scene = 打开采集的场景
shell-scan-folder = 扫描文件夹：各帧及其位姿
shell-another-library = 使用其他零件库
shell-a-recording = 播放录制
shell-record-to = 用于录制来源的文件夹
shell-watched-folder = 保存采集的文件夹
shell-open-part = 打开要注册的场景、点云或网格
shell-cannot-be-made = 无法创建 { $path }：{ $why }
shell-choose-another-folder = 请选择其他文件夹
shell-type-a-path = 请输入路径
shell-add-a-name = 这是文件夹：请补充文件名
shell-no-such-file = 文件不存在
shell-no-such-folder = 文件夹不存在
shell-not-a-folder = 这是文件，不是文件夹
shell-confirm-replace = 已有同名文件：再次确认以替换
shell-no-parent-folder = 该文件所在的文件夹不存在
shell-no-file-dialog = 桌面环境不提供文件对话框（软件包 xdg-desktop-portal-gtk 或 zenity）：请输入路径，或在下方选择
shell-path = 路径
shell-ok = 确定

## Notices and closing

shell-dismiss = 忽略
shell-dismiss-all = 全部忽略
shell-more-like-it = 另有 { $num } 条类似通知
shell-read-in-millimetres = 按毫米读取
shell-too-wide = 点的范围为 { $extent } m
shell-too-wide-advice = 检查文件的单位
shell-undo = 撤销
shell-close-without-saving = 不保存就关闭？
shell-not-written = { $num } 次检测仅在内存中：无法写入历史
shell-keep-open = 保持窗口打开
shell-close-anyway = 不保存并关闭
shell-stop-answering = 停止应答机器人？
shell-robots-without-answer = 窗口关闭期间，向 { $at } 发出请求的机器人得不到应答
shell-close-and-stop-answering = 关闭并停止应答

## Shortcuts

shell-shortcuts = 快捷键
shell-key-ctrl = Ctrl
shell-key-shift = Shift
shell-key-space = 空格
shell-key-enter = Enter
shell-key-up = ↑
shell-key-down = ↓
shell-does-capture = 采集，并检测或注册
shell-does-live = 实时：跟踪来源或停止
shell-does-record = 录制来源或停止
shell-does-open-scan = 打开扫描：多次拍摄及其位姿
shell-does-export = 导出当前检测
shell-does-robot = 机器人工位：相机的位置
shell-does-units = 毫米和度，或米和弧度
shell-does-theme = 深色或浅色
shell-does-role = 操作员视图或工程师视图
shell-does-quit = 关闭窗口
shell-does-help = 帮助：按键、指南、报告问题
shell-does-size = 全部放大、缩小、恢复原大小
shell-does-escape = 关闭放大的步骤；放弃矩形框或套索
shell-keys-tab = Tab, Enter
shell-does-tab = 转到下一个控件，按下它
shell-keys-turn = 方向键、左键拖动
shell-does-turn = 旋转三维视图
shell-keys-shift = Shift + 方向键、右键拖动
shell-does-shift = 平移
shell-keys-zoom = + −、滚轮
shell-does-zoom = 缩放
shell-keys-fit = F、Shift F
shell-does-fit = 适配零件、适配全部
shell-does-look = 从正面、顶面、侧面观察
shell-does-measure = 测量所点击两点间的距离
shell-keys-drawing = 左键拖动、Esc
shell-does-drawing = 绘制框或套索，取消绘制
shell-keys-box = 方向键、Enter
shell-does-box = 移动图像中的框并应用
shell-keys-resize = Shift + 方向键
shell-does-resize = 放大或缩小该框

## The simulated cell

shell-every-part = 依次显示各零件
shell-not-enrolled = 未注册：{ $what }
shell-of-simulator = { $name }（仿真）
shell-gone = { $path } 已不存在
shell-gone-advice = 改用仿真工位
shell-device-lost = 图形设备已丢失，窗口已重新打开
shell-device-lost-advice = 已保存的内容都在；未保存的草稿在场景仍可获得时会恢复。如再次发生，请更新显卡驱动
shell-second-window = Partsight 已打开此数据文件夹：若两个窗口都开启实时检测，每个零件会计数两次
shell-second-window-advice = 请关闭其中一个窗口。此窗口启动时未开启实时检测，也不保存设置
shell-no-thread = 系统无法为此创建线程：{ $error }
shell-no-thread-advice = 关闭其他程序后重试
shell-library-not-loaded = 无法加载零件库：{ $error }
shell-library-not-loaded-advice = { $advice }，或在右上角选择其他零件库；在此之前无法识别
shell-library-still-in-use = 继续使用内存中的零件库：{ $error }
shell-library-inside = 零件库内置于程序中，无法更改（{ $reason }）
shell-inside-program = 该零件库位于程序内部，无法更改
shell-inside-program-advice = 请在右上角选择自己的文件夹
shell-choose-library = 在右上角选择 { $path }
shell-choose-or-go-on = 在右上角选择其他零件库，或继续：保存的第一个零件将存放在此处
shell-holds-no-library = { $path } 中没有零件库
shell-sentence = { $text }。
shell-about-scene = { $scene }：{ $what }

## Words of several areas

shell-view = 视图
shell-part = 零件
shell-no-part = 无
shell-remove = 移除
shell-name = 名称
shell-notes-hint = 任何值得记录的内容
shell-reset = 重置
shell-wait = 请稍候
shell-apply = 应用
shell-pose = 位姿
shell-robot-base = 机器人基座
shell-store = 保存
shell-library-loading = 正在加载零件库
shell-choose-another-part = 请选择其他零件
shell-nothing-inspected = 尚无检测记录
