# The shots of a scan
shots-shots = 拍摄
shots-add = 添加拍摄…
shots-add-says = 同一零件的一帧；其位姿须在位姿文件或同目录的 poses.json 中
shots-redo-label = 重做拍摄更改
shots-undo-label = 撤销拍摄更改
shots-all-used = { $num } 次拍摄
shots-some-used = 使用 { $num } 次拍摄中的 { $used } 次
shots-agree = { $used } · 一致性 { $rms } rms
shots-use = 使用 { $name }
shots-drop-says = 去除此次拍摄：其余拍摄重新合并
shots-take-back-says = 恢复此次拍摄
shots-mark = 标出仅第 { $shot } 次拍摄看到的部分
shots-dropped = 已去除
shots-left-out = 已排除：{ $why }
shots-left-out-says = { $why }。{ $advice }
shots-shot-left-out = 第 { $shot } 次拍摄已排除：{ $why }
shots-seen = 零件的 { $share } %
shots-seen-says = 看到零件的 { $num } 个点
shots-alone = 独有 { $share }
shots-no-part-says = 由其他拍摄确定其中哪些属于零件
shots-moved = 修正 { $shift } · { $turn }
shots-rms = rms { $rms }
shots-to-be-dropped = 将被去除…

## The summary

shots-scan = 扫描
shots-used = 使用的拍摄
shots-num-used = { $used }/{ $num }
shots-refined-by = 位姿最大修正
shots-agree-to = 拍摄一致性 rms
shots-points = 零件点数
shots-outline-open = 轮廓未闭合
shots-not-seen = 所有拍摄均未看到 · 占已注册表面的 { $share }
shots-unseen = 未看到：零件可能延伸至此 · 占轮廓的 { $share }
shots-seen-by-one = 仅第 { $shot } 次拍摄看到 · 占零件的 { $share }

## Files

shots-add-a-frame = 向扫描添加一帧
shots-poses-file = 各次拍摄的位姿文件
shots-poses = 位姿
shots-at-least = 扫描至少需要 { $num } 次拍摄
shots-take-another = 请先恢复另一次拍摄
shots-putting-together = 正在合并拍摄
shots-adding = 正在添加 { $name }
