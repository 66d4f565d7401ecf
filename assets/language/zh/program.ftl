## Robot programs
program-files = 机器人程序
program-no-nozzle = 没有喷嘴在法兰上的位置，无法检查可达范围
program-no-nozzle-advice = 请在“喷涂”中机械臂下方填写，或不选机械臂
program-stale = 未写出文件：采集已超过 10 分钟
program-stale-advice = 请重新采集零件
program-clock-ahead = 未写出文件：采集的时间比现在晚 { $seconds } 秒，因此无法得知其新旧
program-clock-ahead-advice = 请让本机和写出该采集的计算机与同一时间服务器对时，然后重新采集零件
program-ambiguous = 未写出文件：零件的另一个位姿同样吻合
program-ambiguous-advice = 请重新采集完整零件，使只有一个位姿吻合
program-off-part = 未写出程序：喷涂轨迹未对准零件（喷枪打开的 { $all } 个点中只有 { $aiming } 个对准）
program-off-part-advice = 请检查轨迹是否属于此零件，或在“喷涂”中重新规划并保存
program-not-reached = 未写出程序：{ $arm } 有 { $missed } 个点不可达，共 { $all } 个
program-not-reached-advice = 请移动零件或机械臂底座，或修改轨迹
program-film-off-plan = 未写出程序：该程序只会使 { $written } % 的表面处于目标的 { $tolerance } % 以内，平均 { $written_um } µm，而计划为 { $planned } % 和 { $planned_um } µm；喷枪打开时会停顿 { $stops } 次
program-film-off-plan-advice = 请规划不含侧面行程的轨迹（侧面倾角设为 0），或为能在运动中开关喷枪的控制器写出程序
program-written = 已写出 { $path }：{ $count } 个点，{ $format }
program-written-parts = 已写出 { $path } 和 { $parts } 个子程序：{ $count } 个点，{ $format }；控制器需要所有文件
