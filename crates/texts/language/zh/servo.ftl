# 由相机引导的机器人为何保持不动或停止

servo-not-accepted = 机器人已停止，因为没有零件被接受：{ $why }
servo-another-part = 机器人已停止，因为挂着的是“{ $other }”，而不是“{ $part }”
    .advice = 挂上正确的零件，或选择已挂上的零件，然后重新开始
servo-ambiguous = 机器人已停止，因为“{ $part }”的位姿不确定：另一个位姿几乎同样吻合，或尺寸不符
    .advice = 将零件正面转向相机，使整个零件位于画面内，然后重新开始
servo-no-bounds = 机器人已停止，因为检测没有给出“{ $part }”位姿的不确定度
    .advice = 选择用全局方法估计位姿的配方，然后重新开始
servo-moved = 机器人已停止，因为零件在相邻两帧之间似乎移动了 { MM($shift_m, 0) } mm 和 { DEGREES($turn_rad, 1) }°
    .advice = 让零件静止后重新开始；如果零件本来就静止，请检查标定，以及相机与机器人的时间是否一致
servo-lost = 机器人已停止，因为已有 { FIXED($age_s, 1) } s 没有被接受的帧
    .advice = 检查相机及其线缆，并确认整个零件保持在画面内，然后重新开始
servo-stale = 机器人已停止，因为一帧在采集 { FIXED($age_s, 1) } s 之后才到达
    .advice = 关闭占用本机的其他程序，或增大帧的最大时延，然后重新开始
servo-frame-times = 机器人已停止，因为帧的时间有 { FIXED($off_s, 2) } s 的错误：晚于当前时间或顺序不对
    .advice = 让相机、机器人和本机使用同一时间服务器校时，然后重新开始
servo-arm-times = 机器人已停止，因为其位姿的两次报告相隔 { FIXED($gap_s, 3) } s
    .advice = 检查与机器人控制器的连接，然后重新开始
servo-arm-astray = 机器人已停止，因为它偏离指定路径 { MM($shift_m, 0) } mm 和 { DEGREES($turn_rad, 1) }°
    .advice = 查看示教器上是否有消息，并检查基座和工具是否与标定时相同，然后重新开始
servo-too-far = 机器人已停止，因为目标相距 { MM($shift_m, 0) } mm 和 { DEGREES($turn_rad, 0) }°
    .advice = 将机器人移近目标，使相机看到整个零件，然后重新开始
servo-outside-volume = 机器人已停止，因为它将超出工作空间 { MM($beyond_m, 0) } mm
    .advice = 将零件挂在别处；如果有空间，可扩大工作空间
servo-too-near = 机器人已停止，因为其{ $body ->
        [gun] 喷枪
        [wrist] 手腕
        [forearm] 前臂
        [upper_arm] 上臂
       *[tool] 工具
    }将过于靠近{ near-obstacle }
    .advice = 将零件挂在别处，从另一侧开始，或检查障碍物及其最小距离
servo-out-of-reach = 机器人已停止，因为手臂到不了通往目标的路径
    .advice = 将零件挂得更靠近可达范围的中间，或以手臂的另一种构型开始
servo-joint-limit = 机器人已停止，因为关节 { $joint } 将超出限位
    .advice = 以手臂的另一种构型开始，或将零件挂在别处
servo-singular = 机器人已停止，因为手臂将接近奇异位形
    .advice = 以手臂的另一种构型开始，或将零件挂在别处
servo-uncertain = 已到达目标，但精度未达要求：连同不确定度为 { MM($shift_m, 1) } mm 和 { DEGREES($turn_rad, 2) }°，允许 { MM($most_m, 1) } mm 和 { DEGREES($most_rad, 2) }°
    .advice = 让相机更近地看到整个零件；若目标是喷嘴，请重新标定；或增大公差
servo-not-settling = 机器人已停止，因为经过 { $num_rounds } 次修正后仍剩 { MM($shift_m, 1) } mm 和 { DEGREES($turn_rad, 2) }°
    .advice = 让零件静止，或增大死区；如果没有东西在动，请检查标定
servo-time-over = 机器人已停止，因为未能在 { FIXED($limit_s, 0) } s 内到达目标
    .advice = 从更靠近目标处开始，或增大最长时间
servo-robot-stopped = 机器人已停止，因为其程序已停止或不再接受位姿
    .advice = 重新启动机器人程序，然后再次开始伺服
servo-by-person = 机器人已按要求停止
    .advice = 工位清空后重新开始

# Before it moves
servo-waits-for-robot = 等待机器人：{ $robot }
servo-not-simulated = 仿真工位中没有 { $part }
