# Outcomes of inspections, estimations and cases, and names of frames

verdict-accepted = 已接受
verdict-not-accepted = 未接受
verdict-unknown = 未知
verdict-no-part = 无零件
another-make = { $part }（其他品牌）
another-model = { $part }（其他型号）
mirror-image = “{ $part }”的镜像
other-half = “{ $part }”已注册部分的镜像
simulated-frame = 仿真帧 { $number }
no-more-frames = { $source } 没有更多帧
keep-all = 全部
keep-not-accepted = 未接受的
keep-none = 不保留
frame-loss-disk-full = 磁盘已满
frame-loss-not-writable = 无法写入
frame-loss-slow-disk = 磁盘太慢
stopped-converged = 已收敛
stopped-below-target = 低于阈值
stopped-iteration-limit = 达到迭代上限
stopped-no-progress = 无进展
outcome-right = 正确
outcome-refused = 拒绝
outcome-wrong-accepted = 误接受
no-calibration = 校准：没有任何结果被识别为零件
