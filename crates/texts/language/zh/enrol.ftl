# Enrolling

## Names that are not valid

name-empty = 名称为空
    .advice = { name-advice }
name-too-long = 名称有 { $found } 个字符，最多允许 { $limit } 个
    .advice = { name-advice }
name-bad-character = { $name } 不是有效名称：其中包含 { $character }
    .advice = { name-advice }
name-bad-beginning = { $name } 不是有效名称：不能以 { $character } 开头
    .advice = { name-advice }
name-reserved = { $name } 不是有效名称：Windows 将其保留为设备名
    .advice = { name-advice }
name-advice = 请使用小写字母、数字、_ 和 -，最多 { $most } 个字符，例如 { $example }

## Warnings about a part

enrol-touches-edge = 零件到达画面边缘，可能缺少一部分
    .advice = 将相机移远或将零件居中，然后重新注册
enrol-background = 这可能是背景：{ background-sign }
    .advice = 请查看图像；如果不是零件，请改选零件
enrol-on-background = 保留部分的 { $percent } % 位于墙面、地面或其他已移除的平面上
    .advice = 请去除背景：检测时会将其移除，只比较其余部分
enrol-apart = 保留部分的 { $percent } % 与其余部分分离
    .advice = 请去除不属于零件的部分
enrol-too-little = 零件可见部分太少，无法识别：同一视图的得分为 { FIXED($score, 2) }，至少需要 { FIXED($needed, 2) }
    .advice = 请注册零件的更多部分：将相机后移，或将多次拍摄作为扫描注册
enrol-unconstrained = 形状不能确定位姿：{ free-motion }
    .advice = 请注册零件的更多部分，使角或开口能约束其位姿
enrol-symmetric = 零件转动 { $degrees }° 后外观相同，无法区分这两个位姿
    .advice = 请在注册和检测时让转动后外观不同的特征（如支架或切口）可见：否则机器人得不到其位姿
enrol-side-unclear = 无法确定零件的哪一侧是外侧
    .advice = 规划路径之前，请在“喷涂”中选择要喷涂的一侧
enrol-goes-on-unseen = 扫描表面轮廓的 { $percent } % 处是所有拍摄的视野边界：零件可能在那里继续延伸
    .advice = 请添加能看到缺失侧面的拍摄，然后重新注册
background-sign = { $sign ->
        [behind] 其边缘的 { PERCENT($share, 0) } % 位于其他表面之后
        [cut] 画面在 { $sides } 侧将其截断
       *[other] 它是 { FIXED($area, 2) } m² 的平面
    }

## Why a part cannot be enrolled

reference-no-outline = 含 { $num_points } 个点的点云从任何一侧都没有轮廓
    .advice = 请检查点云是否只显示一个零件的表面，并以米为单位
reference-too-large = 零件跨度为 { FIXED($found, 1) } m，应不超过 { FIXED($limit, 0) } m
    .advice = 请以米为单位导出（这看起来是毫米），或从场景中截取单个零件
not-enrolled-background = 找到的表面可能是背景：{ background-sign }
    .advice = 请选择属于零件的表面
not-enrolled-no-such-surface = 场景中没有第 { $wanted } 个表面；共找到 { $found } 个
    .advice = 请选择找到的表面之一
not-enrolled-too-few-points = 点云有 { $found } 个点，至少需要 { $needed } 个
    .advice = 请更近地采集零件，或导出点数更多的点云
not-enrolled-too-few-kept = 保留 { $found } 个点，至少需要 { $needed } 个
    .advice = 请取回已去除的部分：撤销、重置或添加
not-enrolled-no-part-in-scan = 在 { $num_frames } 次拍摄中均未找到零件
    .advice = 请用“添加”和矩形框或套索保留零件，或在距背景至少 10 cm 处采集零件
not-enrolled-no-area = 含 { $num_triangles } 个三角形的网格没有面积
    .advice = 请重新导出带有面的网格

## 网格的判定结果

enrolled-closed-sheet = 封闭薄板，厚约 { MM($thickness_m, 1) } mm
enrolled-open-surface = 无厚度的开放曲面（{ $percent } %）：从两面均可识别
enrolled-turned = 已翻转：{ $percent } % 的三角形原本朝内
enrolled-hidden = { $percent } % 的表面在内部，相机看不到，已略去

## What was enrolled

shared-title = { $other } 的标题也是“{ $title }”
    .advice = 请另选标题：判定结果和列表以标题区分零件
enrolled-from-segmented = 在采集的场景中找到的零件
enrolled-from-whole-cloud = 整个点云
enrolled-from-mesh = 网格
enrolled-from-scan = 扫描
renamed = 已将 { $before } 重命名为 { $now }
no-such-part = 零件库中没有零件 { $name }
mesh-no-area = { $path }：网格没有面积
    .advice = { not-enrolled-no-area.advice }
