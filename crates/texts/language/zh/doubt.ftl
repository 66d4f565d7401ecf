# 机器人不得依据某个结果动作的原因

doubt-past = 不可用于机器人：{ $why }

doubt-reported-wrong = 零件已被报告为误识别
    .advice = 请检查现在悬挂的是哪个零件，然后重新采集
    .past = 零件已被报告为误识别
doubt-source-lost = 来源已断开，无法得知现在挂着什么
    .advice = 请重新连接来源，并重新采集零件
    .past = 数据源已丢失
doubt-moving = 零件在移动
    .advice = 请等零件静止
    .past = 零件当时在移动
doubt-superseded = 那里现在可能挂着另一个零件
    .advice = 请重新采集零件
    .past = 当时悬挂的可能已是另一个零件
doubt-other-order = 其订单要求的零件与检测时预期的不同
    .advice = 请重新采集零件
    .past = 其订单当时要求其他零件
doubt-not-accepted = 零件未接受
    .advice = 请重新采集零件
    .past = 零件未接受
doubt-no-pose = 零件没有位姿
    .advice = 请选择估计位姿的配方，并重新检测零件
    .past = 零件当时没有位姿
doubt-not-calibrated = 工位未标定
    .advice = 请在上方“机器人…”中标定相机在机器人工位中的位置
    .past = 工位当时未标定
doubt-clock-ahead = 采集的时间比现在晚 { FIXED($seconds, 0) } 秒，因此无法得知其新旧
    .advice = 请让本机和写出该采集的计算机与同一时间服务器对时，然后重新采集零件
    .past = 采集的时间比本机时钟晚
doubt-old = 采集已超过 10 分钟，或新旧未知
    .advice = 请重新采集零件
    .past = 采集当时已超过 10 分钟，或新旧未知
doubt-ambiguous-pose = 零件的另一个位姿几乎同样吻合
    .advice = 请将零件正面朝向相机，并使其完整位于画面内；如果转动后外观相同，请在注册和检测时让能区分的特征（如支架或切口）可见
    .past = 零件的另一个位姿当时几乎同样吻合
doubt-surface = 零件表面不合格
    .advice = 请查看检测圈出的部位，返工或取下该零件
    .past = 零件表面当时不合格
doubt-off-scale =
    .past = 零件比其参考大或小
doubt-frames-disagree = 各次拍摄可能不吻合：{ $frame } 与其他拍摄共同看到的部分有 { PERCENT($disagreeing, 1) } % 不一致，通常最多 { PERCENT($most, 0) } %
    .advice = 请检查每个位姿是否属于其拍摄，以及各次拍摄之间是否有物体移动
    .past = 扫描的各次拍摄不一致
doubt-poses-apart = 位姿相互矛盾：{ $one } 与 { $other } 只有在其中一个移动 { MM($apart_m, 1) } mm 后才吻合
    .advice = 请检查每个位姿是否属于其拍摄、机械臂是否静止以及其标定是否仍然有效；零件在机器人基坐标系中位置的可靠程度取决于位姿的一致程度
    .past = 扫描的各个位姿相互矛盾
doubt-off-the-part = 喷涂轨迹未对准零件（{ $num_too_near ->
        [0] 喷枪打开的 { $num_spraying } 个点中只有 { $num_aiming } 个对准
       *[other] 喷枪打开的 { $num_spraying } 个点中有 { $num_too_near } 个点喷嘴距零件不足 { MM($least_m, 0) } mm 或位于其表面之后
    }）
    .advice = 请检查轨迹是否属于此零件，或在“喷涂”中重新规划并保存
doubt-not-reached = { $arm } 有 { $num_missed } 个点不可达，共 { $num_points } 个{ $num_collisions ->
        [0] {""}
       *[other] ，其中 { $num_collisions } 个点会碰撞
    }
    .advice = 请移动零件或机械臂底座，或修改轨迹
doubt-film-off-plan = 该程序只会使 { PERCENT($written, 1) } % 的表面处于目标的 { PERCENT($tolerance, 0) } % 以内，平均 { UM($written_m, 1) } µm，而计划为 { PERCENT($planned, 1) } % 和 { UM($planned_m, 1) } µm；喷枪打开时会停顿 { $num_stops } 次
    .advice = 请规划不含侧面行程的轨迹（侧面倾角设为 0），或为能在运动中开关喷枪的控制器写出程序
