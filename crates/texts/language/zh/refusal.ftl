# Why a part is not accepted, or nothing is recognised. Of each kind: the reason; `advice`, what to do, and `command-advice`
# where commands advise something else; `kind`, its name where refusals are counted; `short`, the reason for an operator;
# what an operator can do, as `step` and `otherwise`, between which the window says how to inspect again, or as `next`,
# or else `advice`; `compared`, the reason beside the figures of Compare.

## A part is not accepted

refusal-low-score = 最佳匹配“{ $part }”得分 { FIXED($score, 2) }，低于阈值 { FIXED($threshold, 2) }
    .advice = 确认该零件已注册且未被遮挡，然后重新采集
    .kind = 得分低于阈值
    .short = 与“{ $nearest }”的匹配度不足
    .step = { step-uncover }
    .otherwise = { step-if-it-persists }
    .compared = 得分 { FIXED($score, 2) } 低于 { FIXED($threshold, 2) }
refusal-piece = 只能看到“{ $part }”的一部分（{ PERCENT($hidden, 0) } % 被遮挡，{ PERCENT($outside, 0) } % 在画面外）；得分 { FIXED($score, 2) }，低于阈值 { FIXED($threshold, 2) }
    .advice = { PERCENT($hidden, 0) ->
        [0] { PERCENT($outside, 0) ->
            [0] { piece-hidden-or-outside }
           *[other] { piece-outside }
        }
       *[other] { PERCENT($outside, 0) ->
            [0] { piece-hidden }
           *[other] { piece-hidden-or-outside }
        }
    }
    .kind = 只能看到零件的一部分
    .short = 只能看到“{ $nearest }”的一部分
    .compared = 得分 { FIXED($score, 2) } 低于 { FIXED($threshold, 2) }：只能看到一部分
refusal-hardly-seen = 疑似“{ $part }”的物体几乎不可见：近乎侧对相机，或大部分边缘被截断
    .advice = 将零件正面朝向相机并完全置于画面内，然后重新采集
    .kind = 零件几乎不可见
    .short = { short-hardly-seen }
    .step = { step-all-in-picture }
    .compared = 得分 { FIXED($score, 2) }：几乎不可见
refusal-another-model = 与“{ $part }”相似但不相同：{ LIST(model-surface, model-outline, model-missing, between: "，", last: "，", end: "；") }属于其他车型，位姿仅为近似值
    .advice = 若该零件也需喷涂，请将其注册为“{ $part }”的另一参考
    .kind = 其他车型
    .short = 与“{ $nearest }”相似，但形状不同
    .next = { step-enrol-if-painted-next }
    .compared = { LIST(model-surface, model-outline, model-missing, between: "，", last: "，", end: "：") }其他型号
refusal-another-make = 与“{ $part }”类型相同，但不是已注册的零件：其他品牌，尺寸或形状不同
    .advice = { refusal-another-model.advice }
    .kind = 其他品牌
    .short = 与“{ $nearest }”相似，但尺寸不同
    .next = { step-enrol-if-painted-next }
    .compared = 属于同类型的概率为 { FIXED($likeness, 2) }：其他品牌
refusal-ambiguous-pose = “{ $part }”的可见部分与零件的另一位置匹配程度几乎相同（相对该位置的裕度 { FIXED($margin, 2) }，要求 { FIXED($threshold, 2) }）
    .advice = { see-an-edge }
    .kind = 与零件的另一位置匹配程度几乎相同
    .short = { short-uncertain-pose }
    .step = { step-see-an-edge }
    .otherwise = { step-if-it-persists }
    .compared = 相对另一位姿的裕度为 { FIXED($margin, 2) }，低于 { FIXED($threshold, 2) }
refusal-unconstrained = 可见部分不足以确定“{ $part }”的位姿：{ free-motion }
    .advice = { see-an-edge }
    .kind = 位姿未约束
    .short = { short-uncertain-pose }
    .step = { step-see-an-edge }
    .otherwise = { step-if-it-persists }
    .compared = 位姿未约束：{ free-motion }
refusal-uncertain = “{ $part }”的位姿不确定度为 { MM($shift_m, 1) } mm，允许值为 { MM($limit_m, 1) } mm
    .advice = { $frames_disagree ->
        [true] { scan-poses }
       *[other] { see-an-edge }
    }
    .kind = 位姿不确定度超过允许值
    .short = { short-uncertain-pose }
    .step = { $frames_disagree ->
        [true] { step-scan-again }
       *[other] { step-see-an-edge }
    }
    .otherwise = { step-if-it-persists }
    .compared = 位姿不确定度为 { MM($shift_m, 1) } mm，允许 { MM($limit_m, 1) } mm
refusal-unknown = 未知：没有相似的已注册零件{ $like ->
        [true] ；最接近的“{ $nearest }”得分 { FIXED($score, 2) }
       *[other] { "" }
    }
    .advice = 若需喷涂，请注册该零件；若已注册，请将其正面朝向相机后重新采集
    .kind = 未知：没有相似的已注册零件
    .short = 没有与之相似的已注册零件
    .step = { step-turn }
    .otherwise = { step-enrol-if-painted-next }
    .compared = 得分 { FIXED($score, 2) }：未知
refusal-mirrored = 看起来是“{ $part }”的镜像（得分 { FIXED($score, 2) }）：车身另一侧的零件
    .advice = 请以单独的名称注册这一侧的零件，不要使用另一侧的轨迹喷涂
    .kind = 已注册零件的镜像
    .short = 看起来是“{ $nearest }”的镜像
    .next = 请勿按“{ $nearest }”喷涂：请工程师注册这一侧的零件
    .compared = 看起来像 { $part } 的镜像
refusal-mirrored-image = 仅以镜像形式与“{ $part }”匹配（得分 { FIXED($score, 2) }），而“{ $part }”不分左右：图像左右可能颠倒
    .advice = 请勿按此图像移动机器人：将图像与零件对比，若左右颠倒，请在相机内参的 JSON 文件中添加 "mirrored": true
    .kind = 图像左右可能颠倒
    .short = 相机图像是镜像的
    .next = 请勿启动机器人：请工程师纠正相机设置
    .compared = 仅其镜像与 { $part } 匹配：图像可能是镜像的
refusal-off-scale = 相机看到的“{ $part }”比参考{ $is_larger ->
        [true] 大
       *[false] 小
    } { PERCENT($by, 0) } %：相机参数有误，或是其他品牌
    .advice = 请先检查相机深度的单位及其焦距（fx、fy）；只有尺寸确实不同时，才将其注册为“{ $part }”的另一参考
    .kind = 尺寸与参考不同：相机参数有误或其他品牌
    .short = 相机显示的“{ $nearest }”尺寸不同
    .next = 请勿启动机器人：请工程师检查相机
    .compared = 尺寸与参考不同
refusal-other-half = 看起来是“{ $part }”已注册部分的镜像（得分 { FIXED($score, 2) }）：“{ $part }”只注册了一部分，这可能是它的另一半
    .advice = 请注册完整的“{ $part }”，或将这一半注册为它的另一参考
    .kind = 可能是零件未注册的另一半
    .short = 可能是“{ $nearest }”的另一半
    .next = 请工程师注册完整的“{ $nearest }”
    .compared = 看起来是 { $part } 已注册部分的镜像
refusal-small-margin = “{ $part }”与“{ $other }”的匹配程度几乎相同（裕度 { FIXED($margin, 2) }，要求 { FIXED($threshold, 2) }）
    .advice = 将零件正面朝向相机后重新采集；若两个名称指同一零件，请从零件库中移除其中一个
    .kind = 两个零件的匹配程度几乎相同
    .short = 有两个已注册零件的匹配度几乎相同
    .step = { step-turn }
    .otherwise = { step-if-two-alike }
    .compared = 相对 { $other } 的裕度为 { FIXED($margin, 2) }，低于 { FIXED($threshold, 2) }
refusal-wrong-part = 零件错误：挂着的是“{ $part }”，而不是“{ $expected }”
    .advice = 请挂上“{ $expected }”，或更正期望的零件
    .kind = 与期望的零件不同
    .short = 挂着的是“{ $nearest }”，而不是“{ $expected }”
    .compared = 期望的是“{ $expected }”
refusal-not-expected = 零件过多：“{ $part }”不在期望之列
    .advice = 请取下“{ $part }”，或更正期望的零件
    .kind = 非期望的零件
    .short = “{ $nearest }”不在期望之列
    .compared = 不在期望之列
refusal-expected-elsewhere = 位置错误：“{ $part }”挂在“{ $place }”，而它应挂在“{ $expected_at }”
    .advice = 请将“{ $part }”挂到“{ $expected_at }”，或更正期望的零件
    .kind = 挂在期望位置以外的零件
    .short = “{ $nearest }”应挂在“{ $expected_at }”，而不是“{ $place }”
    .compared = 它应挂在“{ $expected_at }”
refusal-cut-by-volume = “{ $part }”超出工作空间，其内部分过少
    .advice = 请在挂架文件中扩大工作空间，或将“{ $part }”挂到其中
    .kind = 被工作空间截断
    .short = “{ $nearest }”超出工作空间
    .compared = 超出工作空间
refusal-wrong-place = 位置错误：“{ $part }”不能挂在“{ $place }”
    .advice = 请将“{ $part }”挂到它自己的位置，或在挂架文件中允许它挂在“{ $place }”
    .kind = 挂在其他零件的位置
    .short = “{ $nearest }”不能挂在“{ $place }”
    .compared = 不能挂在“{ $place }”
refusal-beside-places = “{ $part }”挂在挂架最近位置“{ $place }”旁 { MM($distance_m, 0) } mm 处
    .advice = 请将“{ $part }”挂到挂架的位置上，或在挂架文件中移动该位置
    .kind = 不在挂架的位置上
    .short = “{ $nearest }”挂在“{ $place }”旁 { MM($distance_m, 0) } mm 处
    .compared = 挂在“{ $place }”旁 { MM($distance_m, 0) } mm 处
refusal-turned = “{ $part }”在“{ $place }”挂错：旋转了 { DEGREES($turn_rad, 0) }°，允许 { DEGREES($limit_rad, 0) }°
    .advice = 请按正确方向挂“{ $part }”，或在挂架文件中允许此方向
    .kind = 在其位置上旋转
    .short = “{ $nearest }”在“{ $place }”旋转了 { DEGREES($turn_rad, 0) }°
    .compared = 旋转了 { DEGREES($turn_rad, 0) }°，允许 { DEGREES($limit_rad, 0) }°
refusal-unconfirmed = “{ $part }”的轮廓最接近；仅凭论文的匹配器无法将其与未知零件区分
    .advice = 同时估计位姿：在配方中将“位姿方法”设为“全局”
    .kind = 仅凭论文的匹配器，未估计位姿
    .short = 仅比较了轮廓
    .next = { step-unconfirmed-next }
    .compared = 仅凭论文的匹配器无法将其与未知零件区分
refusal-out-of-range = 疑似“{ $part }”的物体距相机 { FIXED($depth_m, 2) } m：深度相机的测量范围为 { $from } 至 { $to } m
    .advice = 检查文件或相机 JSON 的单位：长度单位为米；然后重新采集
    .kind = 超出相机的测量范围
    .short = 距相机太近或太远
    .next = { step-check-camera-next }
refusal-behind-camera = { PERCENT($share, 1) } % 的点位于相机后方，无法确定“{ $part }”的位置
    .advice = 以相机自身坐标系导出采集：x 向右，y 向下，z 向前
    .kind = 点位于相机后方
    .short = { short-damaged-file }
    .next = { step-check-camera-next }
refusal-surplus-bytes = 文件最后一个点之后还有 { $num } 字节：文件已损坏，疑似“{ $part }”的数据也不可靠
    .advice = 从生成该文件的程序重新复制或导出
    .kind = 文件已损坏
    .short = { short-damaged-file }
    .next = { step-check-camera-next }
refusal-no-pose = 未找到位姿：{ $why }
    .kind = 未找到位姿
    .short = 可能是“{ $nearest }”，但未找到位姿
    .step = { step-turn }
    .otherwise = { step-if-it-persists }
refusal-not-steady = “{ $part }”尚未静止
    .advice = 让零件静止一秒
    .kind = 零件尚未静止
    .short = 零件尚未静止
refusal-passing = “{ $part }”正随产线通过，目前 { $needed } 帧中只有 { $num_frames } 帧拍到完整零件
    .advice = 请稍候
    .kind = 产线上的帧不足
    .short = 目前拍到完整零件的帧不足
refusal-smeared = 相机曝光一帧时“{ $part }”移动了 { MM($smear_m, 1) } mm，允许 { MM($limit_m, 1) } mm
    .advice = 降低产线速度或缩短相机曝光；如果实际曝光比产线文件所写的短，请修改其中的 exposure_ms
    .kind = 产线对曝光而言过快
    .short = 产线对相机曝光而言过快
refusal-few-frames = “{ $part }”已静止，此后已检测 { $needed } 帧中的 { $num_frames } 帧
    .advice = 请稍候
    .kind = 静止后检测的帧不足
    .short = 已检测的帧数不足
refusal-too-slow = 未判定：此计算机太慢（{ $num_frames } 帧中只检测了 { $num_inspected } 帧）
    .advice = 选用更小的画面或其他配方、减少要查找的零件数（max_parts），或关闭其他程序
    .kind = 未判定：计算机太慢
    .short = 此计算机太慢，{ $num_frames } 帧中只检测了 { $num_inspected } 帧
refusal-undecided = { $num_frames } 帧中有 { $num_agreeing } 帧接受“{ $part }”，需要 { $needed } 帧
    .advice = 请稍候；若仍如此，请将零件正面朝向相机并移开前方的物体
    .kind = 接受零件的帧不足
    .short = { short-undecided }
refusal-poses-apart = { $num_frames } 帧中有 { $num_agreeing } 帧的“{ $part }”位姿一致，需要 { $needed } 帧
    .advice = 固定零件使其不晃动并稍候；若仍如此，请将其正面朝向相机
    .kind = 各帧的位姿不一致
    .short = { short-undecided }

## There is no part

refusal-too-few-points = 场景仅有 { $found } 个读数，至少需要 { $needed } 个
    .advice = 检查相机是否已连接、未被遮挡且距零件 0.6 至 3 m，然后重新采集
    .short = 相机几乎看不到任何东西
    .step = { step-uncover-camera }
    .otherwise = { step-if-it-persists }
refusal-too-wide = 场景跨度为 { FIXED($extent_m, 0) } m，其中没有零件大小的物体
    .advice = 若下方提供“按毫米读取”，请按下，或以米为单位重新导出；深度图像请改正旁边 JSON 中的 metres_per_unit
    .short = 场景远大于工位
    .next = { step-ask }
refusal-only-background = 背景前没有零件大小的物体（已移除 { $planes } 个平面，最大剩余 { FIXED($found_m2, 3) } m²，要求 { FIXED($needed_m2, 3) } m²）
    .advice = { $knows_cell ->
        [true] 将零件挂在相机前，距墙至少 10 cm，然后重新采集；若采集空工位时零件已挂在那里，请移开零件后重新采集空工位
       *[other] 将零件挂在相机前，距墙至少 10 cm，然后重新采集
    }
    .short = 相机前没有悬挂零件
    .step = { step-hang }
    .otherwise = { $knows_cell ->
        [true] { step-if-it-hangs-there }
       *[other] { "" }
    }
refusal-no-plane = 零件的 { $num_points } 个点位于一条线或一个点上（宽 { FIXED($width_m, 4) } m）
    .advice = 将零件正面朝向相机，然后重新采集
    .short = { short-hardly-seen }
    .step = { step-turn }
    .otherwise = { step-if-it-persists }
refusal-too-large = 零件跨度为 { FIXED($found_m, 1) } m，图像仅覆盖 { FIXED($limit_m, 1) } m
    .advice = 确认文件以米为单位，或从场景中移走零件以外的物体；深度图像请改正旁边 JSON 中的 metres_per_unit
    .short = 视野中有远大于零件的物体
    .step = { step-clear }
    .otherwise = { step-if-it-persists }
refusal-no-shape = 二值图像中没有具有面积的形状（{ $num_set } 个像素）
    .advice = 增大闭合间隙或使零件靠近相机，然后重新采集
    .short = { short-hardly-seen }
    .step = { step-nearer }
    .otherwise = { step-if-it-persists }
refusal-no-outline = { $num_points } 个点的轮廓没有长度
    .advice = 使零件靠近相机，然后重新采集
    .short = { short-hardly-seen }
    .step = { step-nearer }
    .otherwise = { step-if-it-persists }
refusal-empty-library = 零件库中没有已注册的零件
    .advice = 请先在“注册”工作区注册零件
    .short = { short-no-parts-why }
    .next = { step-ask }
refusal-fault = 程序内部错误：{ $message }
    .advice = 请保留该文件或帧，并连同此消息一起报告；之后的检测不受影响
    .short = { short-fault }
    .next = { step-ask }

## Parts of these texts

model-surface = { MM($relief_m, 1) ->
        [0.0] { "" }
       *[other] 表面偏差 { MM($relief_m, 1) } mm
    }
model-outline = { MM($outline_m, 1) ->
        [0.0] { "" }
       *[other] { MM($relief_m, 1) ->
            [0.0] 轮廓偏差 { MM($outline_m, 1) } mm
           *[other] 轮廓偏差 { MM($outline_m, 1) } mm
        }
    }
model-missing = { PERCENT($missing, 1) ->
        [0.0] { "" }
       *[other] 缺失 { PERCENT($missing, 1) } %
    }
piece-hidden = 移开零件前方的物体，然后重新采集
piece-outside = 将零件移入画面内，然后重新采集
piece-hidden-or-outside = 移开零件前方的物体或将零件移入画面内，然后重新采集
see-an-edge = 转动零件或移动相机，直到看到零件的拐角或另一条边，然后重新采集
scan-poses = 请先检查每次拍摄的机器人位姿和手眼标定，然后重新扫描；若两者都正确，再移动相机，使其看到零件的拐角或另一条边
short-uncertain-pose = 已识别，但位姿不确定
short-damaged-file = 采集文件已损坏
short-undecided = 各帧结果不一致
short-hardly-seen = 零件可见部分太少
short-fault = 程序处理此帧时出错
short-no-parts-why = 零件库中没有已注册的零件
step-unconfirmed-next = 请工程师启用位姿估计
step-uncover = 移开遮挡零件的物体
step-all-in-picture = 将零件正面朝向相机并完全置于画面内
step-see-an-edge = 转动零件，直到看到拐角或另一条边
step-turn = 将零件正面朝向相机
step-clear = 移走零件以外的所有物体
step-nearer = 将零件挂得离相机更近
step-scan-again = 重新扫描零件，期间不要移动任何物体
step-hang = 将零件挂在相机前，距墙至少 10 cm
step-uncover-camera = 移开遮挡相机的物体
step-if-it-persists = 若仍如此，请联系工程师
step-if-two-alike = 若仍如此，请工程师从零件库中移除其中一个
step-enrol-if-painted-next = 若需喷涂，请工程师注册该零件
step-check-camera-next = 请工程师检查相机及其文件
step-ask = 请联系工程师
step-if-it-hangs-there = 若零件已挂好，请工程师重新采集空工位
