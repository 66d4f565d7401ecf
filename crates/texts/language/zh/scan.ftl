# 扫描中某一帧未被采用的原因

excluded-wrong-pose = 位姿错误：该帧在偏移 { MM($shift_m, 1) } mm、{ DEGREES($turn_rad, 2) }° 处匹配
    .advice = 确认该位姿属于该帧，并在机械臂静止时重新采集
    .short = 位姿错误
excluded-contradicts = 与其他帧矛盾：共同可见部分仅 { PERCENT($share, 0) } % 一致
    .advice = { excluded-wrong-pose.advice }
    .short = 与其他帧矛盾
excluded-looked-past = 与其他帧矛盾：双方应共同看到的部分有 { PERCENT($share, 1) } % 被其中一帧看穿
    .advice = { excluded-wrong-pose.advice }
    .short = { excluded-contradicts.short }
excluded-overlaps-none = 与其他拍摄无重叠，无法检查其位姿
    .advice = 确认该位姿属于该帧，或增加一次同时拍到该帧与另一帧表面的拍摄
    .short = 与其他拍摄无重叠
excluded-part-moved = 零件移动：工位与其他帧一致，零件仅 { PERCENT($share, 0) } % 一致
    .advice = 在零件静止时重新采集该帧
    .short = 零件移动

# Frames of a scan
left-out = 已排除 { $name }：{ $why }
no-part-in-frame = 未找到零件
