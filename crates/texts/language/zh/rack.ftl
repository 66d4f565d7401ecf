# 文件中的长方体

box-number = { $name } 的 { $field } 为 { $found }
    .advice = 请更正这些数字
box-thin = { $name } 没有一条边达到 { $least } mm：其 size_mm 为 { $found }
    .advice = 请以毫米给出边长

# 为什么挂架不能读取、写入或使用

rack-file = { $what }
    .advice = { $to_do }
rack-garbled = { $path } 不是挂架：{ $why }
    .advice = 请更正该文件；指南中有示例（docs/guide/racks.md）
rack-not-enrolled = 挂架的位置“{ $place }”用于“{ $name }”，而它没有登记
    .advice = 请登记该零件，或更正该位置的零件名称
rack-not-calibrated = 挂架以机器人基坐标系给出，而单元没有标定
    .advice = 请标定单元，或以相机坐标系给出挂架

## 有什么错误

rack-toml = { $what }
rack-boxes = 工作空间有 { $found } 个长方体，最多 { $limit } 个
rack-places = 有 { $found } 个位置，最多 { $limit } 个
rack-empty = 既没有工作空间，也没有位置
rack-name = { $is_place ->
        [true] 位置的名称须有 1 到 { $limit } 个可打印字符
       *[false] 它的名称须有 1 到 { $limit } 个可打印字符
    }
rack-same-name = 两个位置都叫“{ $place }”
rack-overlap = 位置“{ $place }”和“{ $over }”重叠
rack-max-turn = 位置“{ $place }”的 max_turn_deg 为 { $found }，应大于 0，最大 180
