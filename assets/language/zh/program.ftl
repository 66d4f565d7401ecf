## Robot programs
program-files = 机器人程序
program-no-nozzle = 没有喷嘴在法兰上的位置，无法检查可达范围
program-no-nozzle-advice = 请在“喷涂”中机械臂下方填写，或不选机械臂
program-not-written = 未写出程序：{ $why }
program-written = 已写出 { $path }：{ $count } 个点，{ $format }
program-written-parts = 已写出 { $path } 和 { $parts } 个子程序：{ $count } 个点，{ $format }；控制器需要所有文件
