# Poses

## Why there is no pose

pose-too-few-points = { cloud-role }点云有 { $found } 个点，至少需要 { $needed } 个
    .advice = 在更近处重新采集零件，或重新注册
pose-degenerate = { cloud-role }点云无法确定位姿：其点位于一条线或一个点上（宽 { FIXED($width_m, 5) } m）
    .advice = 请使用包含表面的点云，而不是一条线或一个点
pose-one-sided-pairs = 全部 { $num_pairs } 对最近点位于一个点或一条线上，相距 { MM($rms_m, 1) } mm
    .advice = { pose-no-overlap.advice }
pose-no-overlap = 两个点云在 { MM($reach_m, 1) } mm 内只有 { $found } 对点，至少需要 { $needed } 对
    .advice = 确认两个点云以米为单位且为同一零件
pose-sizes-differ = 一个点云的大小是另一个的 { FIXED($ratio, 0) } 倍
    .advice = 请均以米为单位导出：其中一个似乎为毫米
pose-too-far-out = { cloud-role }点云距原点 { FIXED($distance_m, 0) } m，过远而无法分辨各点
    .advice = 导出前从两个点云中减去相同的偏移量
pose-no-reference-cloud = 参考为平面形状，没有点云
    .advice = 请用采集、点云或网格注册该零件
pose-cancelled = 估计已取消
    .advice = 请重新开始

## Why a pose should not be relied upon

pose-little-overlap = 源点云仅有 { PERCENT($overlap, 0) } % 位于目标上，至少需要 { PERCENT($needed, 0) } %
    .advice = 确认两个点云为同一物体，且至少有一半重合
pose-ambiguous = 另一位姿同样匹配（其代价为 { FIXED($ratio, 2) } 倍）
pose-off-scale = 相机看到的部件比参考{ $is_larger ->
        [true] 大
       *[false] 小
    } { PERCENT($by, 0) } %
    .advice = 检查相机深度的单位及其焦距（fx、fy）：位姿的误差为距离的相同百分比
pose-loose = 位姿未被约束：{ free-motion }
pose-unsettled = 经过 { $num_iterations } 次迭代后位姿仍在变化

## 为何没有喷距

stand-off-no-surface = 已注册零件没有带法向的表面
stand-off-none-meets = { $num_taught } 个假定喷嘴位置均未指向零件

## Parts of these texts

free-motion = { $motion ->
        [slide] { $axis ->
            [long] 可沿长边滑动
            [short] 可沿短边滑动
           *[other] 可沿表面法向移动
        }
        [turn] { $axis ->
            [long] 可绕长边转动
            [short] 可绕短边转动
           *[other] 可绕表面法向转动
        }
       *[other] 可滑动或转动
    }
cloud-role = { $which ->
        [source] 源
       *[other] 目标
    }

## Which clouds
pose-onto = { $source } 到 { $target }
