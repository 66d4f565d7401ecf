# The server that robots ask

open-to-network = { $at } 对网络开放且未加密：任何能访问的人都可触发检测并读取位姿
    .advice = 请使用工位专用网络，并在防火墙中只允许机器人和 PLC 访问此端口
numbers-not-stored = 零件编号无法保存，添加或移除零件时编号会改变：{ $reason }
