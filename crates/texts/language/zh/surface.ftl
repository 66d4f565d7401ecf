# 表面

## Verdicts

surface-ok = OK
surface-not-judged = 未判定
surface-rework = 返修
surface-scrap = 报废

## What a region is

region-dent = 凹陷
region-bump = 凸起
region-missing = 缺失的表面

## Why a surface is not judged

surface-little-in-sight = 零件这一侧只有 { PERCENT($seen, 0) } % 看得足够清楚，需要 { PERCENT($needed, 0) } %
    .advice = 请将零件转向相机，并使其完整进入画面
surface-too-far = 在 { FIXED($distance_m, 1) } m 处只能确定大于 { MM($certain_m, 1) } mm 的偏差，而需要检出 { MM($needed_m, 1) } mm
    .advice = 请将相机移到距零件 { FIXED($nearer_m, 1) } m 处
surface-too-noisy = { $num_frames ->
        [1] 在一帧中
       *[other] 在 { $num_frames } 帧的平均中
    }只能确定大于 { MM($certain_m, 1) } mm 的偏差，而需要检出 { MM($needed_m, 1) } mm
    .advice = 请对静止零件的更多帧取平均，或用平均帧或其 CAD 网格重新注册，或允许更大的公差
deviation-no-picture = 读数不是已知相机的图像
    .advice = 请在深度图像或有序点云中检查表面
deviation-frames-differ = 要平均的帧大小不同，或来自不同的相机
    .advice = 请对同一相机在自身与零件都静止时拍摄的帧取平均
deviation-moved = 在要平均的各帧之间，零件移动了 { MM($by_m, 1) } mm，最多允许 { MM($limit_m, 1) } mm
    .advice = 请对悬挂静止的零件的帧取平均
deviation-no-surface = 参考没有带法线的表面
    .advice = 请用采集、点云或网格注册该零件
deviation-little-seen = 参考只有 { PERCENT($seen, 0) } % 看得足够清楚、可以测量，需要 { PERCENT($needed, 0) } %
    .advice = 请将零件转向相机，并使其完整进入画面
