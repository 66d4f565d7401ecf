# 机械臂为何不能走轨迹上的某个点

point-out-of-reach = 超出范围
point-joint-limit = 关节 { $joint } 需要 { DEGREES($angle, 0) }°
    .reason = 关节 { $joint } 超出限位
point-near-singularity = 接近奇异点：{ $singularity ->
        [wrist] 手腕伸直
        [elbow] 手臂伸直
       *[shoulder] 手腕在关节 1 上方
    }
point-too-fast = 关节 { $joint } 需要 { DEGREES($speed, 0) }°/s
    .reason = 关节 { $joint } 太快
point-rail-too-fast = 导轨需要 { MM($speed, 0) } mm/s
    .reason = 导轨太快
point-joint-acceleration = 关节 { $joint } 需要 { DEGREES($acceleration, 0) }°/s²，只有 { DEGREES($limit, 0) }
    .reason = 关节 { $joint } 加速太慢
point-rail-acceleration = 导轨需要 { MM($acceleration, 0) } mm/s²，只有 { MM($limit, 0) }
    .reason = 导轨加速太慢
point-configuration-change = 机械臂需要翻转
point-collision = { near-body }离{ near-obstacle }太近

near-body = { $body ->
        [gun] 喷枪
        [wrist] 手腕
        [forearm] 前臂
       *[upper_arm] 上臂
    }
near-obstacle = { $obstacle ->
        [part] 零件
        [other_part] 挂着的另一个零件
        [floor] 地面
        [upper_arm] 上臂
        [forearm] 前臂
        [base_column] 底座立柱
       *[box] 长方体“{ $name }”
    }
