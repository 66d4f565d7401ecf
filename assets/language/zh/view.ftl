# The 3-D view and the plots
view-segments = 分割区域
view-height = 高度
view-deviation = 偏差
view-plain = 单色
view-height-scale = 高度，mm
view-deviation-scale = 偏差，mm
view-measure-first = 测量：点击点云中的一个点
view-measure-second = 测量：点击第二个点
view-keys = 三维视图。方向键旋转，配合 Shift 平移，加减号缩放，F 适配，X、Y、Z 沿轴观察，M 测量
view-no-view = 无三维视图
view-ray = 射线 { $place }：查询 { $query }，零件 { $part } { $unit }
