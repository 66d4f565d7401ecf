# 工位检查：检查结果，以及无法比较各帧的原因

cell-in-place = 相机和零件均在原位
    .advice = 无需处理
cell-part-moved = 零件已移动；相机未移动
    .advice = 请将零件挂回原位或检查其固定装置，然后再次检查；若零件要保持现状，请采集新的基准
cell-camera-moved = 相机已移动
    .advice = 请固定相机并重新标定，然后采集新的基准
cell-part-or-camera-moved = 零件或相机已移动
    .advice = 请将零件挂回原位并再次检查；若仍无效，则相机已移动：请标定相机并采集新的基准
cell-noisier = 相机和零件均在原位，但测量值噪声增大
    .advice = 请清洁相机窗口，检查其前方是否有杂散光或雾气，然后再次检查
cell-no-frame = 没有帧
    .advice = 请采集用于检查工位的零件并指定文件
cell-moving = 各帧不一致：第 { $frame } 帧中的零件与第一帧相差 { MM($shift_m, 1) } mm 和 { DEGREES($turn_rad, 2) }°
    .advice = 请让零件保持静止，不要移动相机，然后重新采集
cell-other-part = 第 { $frame } 帧中所见仅有 { PERCENT($overlap, 0) } % 位于基准的零件上
    .advice = 请将基准的零件挂在其常用位置，前方不要有遮挡；若零件已挂在该处，则相机或零件移动了数厘米
cell-pose = 第 { $frame } 帧：{ $why }

cell-calibration = { $name }
cell-unnamed-calibration = 未命名的标定 ({ $identity })
cell-scan-poses = 扫描的各个位姿
