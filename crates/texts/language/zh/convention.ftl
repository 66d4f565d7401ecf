# 位姿的书写方式，以及文本或数值不是位姿的原因

convention = { $convention ->
       *[matrix] 4×4 矩阵
        [quaternion-xyzw] 四元数 x y z w
        [rotation-vector] 旋转矢量
        [kuka] KUKA A B C
        [fanuc] FANUC W P R
        [abb] ABB q1 q2 q3 q4
        [universal-robots] Universal Robots
        [yaskawa] Yaskawa Rx Ry Rz
        [staubli] Stäubli rx ry rz
        [doosan] Doosan A B C
    }
    .meaning = { $convention ->
       *[matrix] 4×4 矩阵，逐行排列：3×3 旋转，第四列为 x y z，单位为米，最后一行为 0 0 0 1；从左侧乘以列 [x y z 1]
        [quaternion-xyzw] x y z 单位为米，然后是单位四元数 qx qy qz qw，标量 qw 在最后且不为负
        [rotation-vector] x y z 单位为米，然后是 rx ry rz：旋转轴乘以旋转角，单位为弧度，0 至 π；不是依次旋转的三个角
        [kuka] X Y Z 单位为毫米，然后是 A B C，单位为度：A 绕 Z，B 绕新的 Y，C 绕新的 X，即 Z-Y'-X''，R = Rz(A)·Ry(B)·Rx(C)，B 在 ±90 以内
        [fanuc] X Y Z 单位为毫米，然后是 W P R，单位为度：W 绕固定的 X，然后 P 绕固定的 Y，然后 R 绕固定的 Z，即 X-Y-Z，R = Rz(R)·Ry(P)·Rx(W)，P 在 ±90 以内
        [abb] x y z 单位为毫米，然后是单位四元数 q1 q2 q3 q4，标量 q1 在最前且不为负，与 RAPID 的 pos 和 orient 相同
        [universal-robots] x y z 单位为米，然后是 rx ry rz：旋转轴乘以旋转角，单位为弧度，0 至 π，与 URScript 的 p[x, y, z, rx, ry, rz] 相同；不是示教器上的 roll、pitch 和 yaw
        [yaskawa] X Y Z 单位为毫米，然后是 Rx Ry Rz，单位为度：Rx 绕固定的 X，然后 Ry 绕固定的 Y，然后 Rz 绕固定的 Z，即 X-Y-Z，R = Rz(Rz)·Ry(Ry)·Rx(Rx)，Ry 在 ±90 以内
        [staubli] x y z 单位为毫米，然后是 rx ry rz，单位为度：rx 绕 X，ry 绕新的 Y，rz 绕新的 Z，即 X-Y'-Z''，R = Rx(rx)·Ry(ry)·Rz(rz)，ry 在 ±90 以内，与 VAL 3 的 trsf 相同
        [doosan] X Y Z 单位为毫米，然后是 A B C，单位为度：A 绕 Z，B 绕新的 Y，C 绕新的 Z，即 Z-Y'-Z''，R = Rz(A)·Ry(B)·Rz(C)，B 为 0 至 180，与 posx 相同
    }

written-no-such-convention = 没有名为 { $name } 的约定
    .advice = 先写约定，例如 "kuka 1450 -310 890 10 20 30"：{ $names }
written-no-convention = { $found } 个数值缺少约定的名称
    .advice = { written-no-such-convention.advice }
written-no-number = { $word } 不是数值
    .advice = 数值用小数点，以空格分隔
written-too-far = 位置距离为 { FIXED($distance_m, 0) } m，应不超过 { $most } m
    .advice = 按 { $name } 的单位 { $unit } 输入位置
written-nozzle = 喷嘴距法兰 { MM($distance_m, 3) } mm，应为 { MM($from_m, 0) } 至 { MM($to_m, 0) } mm
    .advice = 按 { $name } 的单位 { $unit } 输入位置；只有控制器的法兰坐标系已在喷嘴处时才用 0 0 0
written-count = { convention } 有 { $needed } 个数值 ({ $names })，给出了 { $found } 个
    .advice = 按此顺序输入：{ convention.meaning }
written-not-finite = { $name } 为 { $value }，应为有限的数值
    .advice = 重新从控制器读取数值
written-not-unit = 四元数的长度为 { FIXED($length, 4) }，应为 1
    .advice = 四个数值均保留至少 4 位小数，并检查哪一个是标量
written-long-rotation = 旋转向量的长度为 { FIXED($length, 2) }，应不大于 2π
    .advice = 请以弧度给出旋转向量；这些数值看起来是角度
written-not-rigid = 这 16 个数值不是刚体变换：有拉伸、镜像，或不以 0 0 0 1 结尾
    .advice = 输入旋转和平移，逐行排列，保留至少 4 位小数；检查行与列是否颠倒
