# 轨迹中未检查的内容

unchecked-arm = 可达范围和碰撞
    .advice = 请写出程序并指定机械臂及喷嘴在法兰上的位姿，或以低速观察机器人的首次运行
unchecked-moving-part = 可达范围和碰撞，因为机器人工作时产线带动零件移动
    .advice = 请先在产线低速时不喷漆运行程序，并观察机器人
unchecked-surroundings = 与零件和机械臂以外物体（如零件支架）的碰撞
    .advice = 请在文件中描述工位的方箱和地面，或以低速观察机器人的首次运行
unchecked-film = 程序形成的漆膜，因为轨迹未注明涂层
    .advice = 请重新规划轨迹，使其注明涂层
unchecked-accelerations =
    { $what ->
        [joints] 关节加速度
        [rail] 导轨加速度
       *[both] 关节和导轨的加速度
    }
    .advice = 请在机械臂文件中补充限值
unchecked-not-seen = { $num_points } 个点中 { $num } 个点的喷距，相机在那里未看到表面
    .advice = 若轨迹应在该处对准零件，请重新采集以使相机看到更多零件，或扫描零件

not-checked = 未检查：{ $what }
