## Before there is a draft
enrol-show-part = 请将要注册的零件置于相机前
enrol-capture-replacement = 采集用于替换 { $part } 的零件
enrol-how = 将零件挂在相机前并按“采集”；也可以打开采集文件、点云或网格，或将文件拖到此处
enrol-take-shown = 使用“检测”中显示的 { $scene }
enrol-use-shown = 使用已检测的场景
enrol-see-inspected = 已保存：在“检测”中查看
enrol-open-scan-hint = 从多个方向的多次拍摄，每次均带相机位姿 (Ctrl Shift O)
enrol-step-capture = 1  采集零件，或打开其文件
enrol-step-correct = 2  查看保留的内容并修正
enrol-step-title = 3  输入标题
enrol-step-save = 4  保存：之后的检测即可识别它

## The card of the draft
enrol-new-part = 新零件
enrol-replaces = 替换 { $part }
enrol-previous-draft = 这是上一份草稿：正在准备新的草稿
enrol-as-new = 改为作为新零件注册
enrol-unready-problem = 暂时无法保存：见上文
enrol-unready-title = 请先输入标题
enrol-unready-name = 请先修正名称
enrol-unready-library = 无法更改此零件库：见上文
enrol-unready-unknown = 要保存的内容尚未确定
enrol-points-kept = 保留 { $points } 个点
enrol-outline = 轮廓 { $length }
enrol-openings = 开口 { $count }
enrol-seen-one-side = 从一侧观测
enrol-seen-all-around = 从四周观测
enrol-seen-several-sides = 从多侧观测
enrol-painted-from-front = 从前面喷涂
enrol-painted-from-back = 从后面喷涂
enrol-painted-from-left = 从左侧喷涂
enrol-painted-from-right = 从右侧喷涂
enrol-painted-from-top = 从上方喷涂
enrol-painted-from-bottom = 从下方喷涂
enrol-examining = 正在分析零件…
enrol-stored-unknown = 要保存的内容未确定
enrol-look-again = 重新分析
enrol-title = 标题
enrol-title-hint = 标题，即通常的叫法
enrol-title-full = 标题最多 { $limit } 个字符；其余内容请写入说明
enrol-name-hint = 根据标题自动生成
enrol-notes = 说明
enrol-reference-of = 附加参考所属零件
enrol-reference-of-chosen = 附加参考所属零件：{ $part }
enrol-reference-of-none = 无（独立零件）
enrol-reference-choice = 参考所属零件：{ $part }
enrol-reference-of-hint = 已注册零件的另一视图或型号：判定结果显示该零件
enrol-namesake = { $part } 已使用此名称
enrol-namesake-advice = 保存将替换它；之前的版本可以恢复
enrol-most-similar = 最相似：{ $part }（相似度 { $percent } %）
enrol-most-similar-mirrored = 最相似：{ $part }（镜像相似度 { $percent } %）
enrol-distinguishable = 两者可以区分
enrol-indistinguishable = 两者无法区分
enrol-indistinguishable-advice = 检测其中任何一个时得分会非常接近：请保存为该零件的附加参考、替换该零件，或采集两者有差异的一侧
enrol-replace = 替换 { $part }
enrol-add-reference = 作为“{ $part }”的附加参考
enrol-discard = 放弃
enrol-saving = 正在保存…
enrol-save-and-replace = 保存并替换

## The meshes of a file
enrol-meshes = { $file } 中的网格
enrol-meshes-hint = 选择要注册的零件：依次成为草稿
enrol-meshes-find = 查找网格
enrol-meshes-find-hint = 名称中的文字
enrol-meshes-order = 按{ $order }排序
enrol-meshes-size = 尺寸
enrol-meshes-unit = 长度单位：{ $unit }
enrol-meshes-counted = { $shown } / { $count } 个网格
enrol-meshes-none = 没有名称包含这些文字的网格
enrol-meshes-figures = { $size } · 三角形：{ $triangles }
enrol-meshes-enrol =
    { $count ->
        [0] 注册网格
       *[other] 注册 { $count } 个网格
    }
enrol-meshes-whole = 全部作为一个零件
enrol-meshes-whole-hint = 整个文件只表示一个零件
enrol-mesh-number = 第 { $number } / { $count } 个网格
enrol-mesh-skip = 略过
enrol-mesh-leave-out = 略过其余

## The card of an enrolled part
enrol-rename = 重命名
enrol-spray-path = 喷涂轨迹…
enrol-remove-path = 移除喷涂轨迹
enrol-anew = 重新注册
enrol-origin = { $time } 注册，来源 { $source }（{ $method }）
enrol-origin-points = { $points } 个点
enrol-origin-simulated = 仿真数据，并非来自相机
enrol-origin-seen = 由相机采集
enrol-origin-path = 喷涂轨迹含 { $count } 个点
enrol-origin-number = 机器人使用的编号：{ $number }

## The strip of enrolled parts
enrol-enrolled-parts = 已注册零件
enrol-library-loading = 正在加载零件库…
enrol-num-parts =
    { $count ->
        [0] 尚未注册零件：保存的第一个零件会显示在此处
       *[other] 已注册 { $count } 个零件
    }
enrol-damaged = 已损坏
enrol-tile-reference = 参考：{ $part }
enrol-enrolled = 已注册：{ $part }
enrol-renamed-at = { $time } 重命名
enrol-brought-back-at = { $time } 恢复
enrol-saved-at = { $time } 保存
enrol-path-changed-at = { $time } 更改轨迹

## What corrects the draft
enrol-in-front = 背景前方
enrol-everything = 全部
enrol-box = 框选
enrol-box-hint = 在三维视图或图像中拖出矩形框（D）
enrol-lasso-hint = 在三维视图或图像中拖出套索（按两次 D）
enrol-keep = 保留
enrol-drop = 去除
enrol-add = 添加
enrol-keep-hint = 外部的点将被去除
enrol-drop-hint = 内部的点将被去除
enrol-add-hint = 内部的所有点都会被选取，包括背景
enrol-drag-box = 拖出矩形框
enrol-drag-lasso = 拖出套索
enrol-picture-hint = 在此图像中{ $drag }。{ $does }。单击可选取或去除一个分割区域
enrol-view-hint = { $drag }。{ $does }，不论深度。按 Esc 恢复旋转
enrol-picture = 保留内容的图像
enrol-mesh-is-whole = 网格会整体注册：请在生成它的程序中裁剪
enrol-undo-step = 撤销上一步
enrol-redo-step = 重做上一步
enrol-reset-all = 重置所有修正
enrol-both = 两者
enrol-picture-pane = 图像
enrol-view-pane = 三维
enrol-show-both = 显示两者
enrol-show-picture = 显示图像
enrol-show-view = 显示三维视图
enrol-segment-partly = { $segment } · 保留 { $kept } / { $all }
enrol-kept = 保留
enrol-partly-kept = 部分保留
enrol-dropped = 去除
enrol-take-it = 选取
enrol-drop-it = 去除
enrol-segment-stand = 支架
enrol-segment-surface = 表面 { $number }
enrol-segment-background = 背景 { $number }
enrol-segment-piece = 块 { $number }
enrol-segment-specks = 散点
enrol-segment-mesh = 网格
enrol-segment-cell = 周围工位
enrol-view = 草稿的三维视图

## Keys
enrol-key-redo = 重做上一次撤销的更改
enrol-key-undo = 撤销上一次修正；没有草稿时撤销零件库更改
enrol-key-save = 保存零件
enrol-key-draw = 框选；再按一次为套索
enrol-key-rotate = 恢复为拖动旋转三维视图

## Work and notices
enrol-path-file-title = 喷嘴在该零件上的轨迹
enrol-path-files = 表格
enrol-examining-part = 正在分析零件
enrol-taking-scan = 正在使用当前显示的扫描
enrol-taking-scene = 正在使用当前显示的场景
enrol-live-stopped = 实时检测已停止：下一个文件用于注册
enrol-live-stopped-advice = 之后按 L 重新开始实时检测
enrol-changing-library = 正在更改零件库
enrol-unsaved = “注册”中的零件尚未保存
enrol-unsaved-titled = “注册”中的零件 { $part } 尚未保存
enrol-bringing-back = 正在恢复草稿
enrol-writing-draft = 正在保留草稿
enrol-draft-back = 未保存的草稿已恢复
enrol-draft-differs = 草稿现在保留的点不同：其场景或配方已更改
enrol-draft-differs-advice = 保存零件前请检查保留的内容
enrol-draft-no-scene = 无法再次获得未保存草稿的场景
enrol-draft-no-scene-advice = 请重新采集零件：已输入的标题、名称和说明已保留
enrol-draft-not-used = 未使用草稿：{ $why }
enrol-draft-set-aside = 已将其移至 { $path }
enrol-draft-not-kept = 草稿未保留：{ $why }
enrol-draft-too-large-advice = 请保存零件，或撤销部分修正
enrol-nothing-to-save = 还没有可保存的内容
enrol-nothing-to-save-advice = 请在显示将保存内容的图像后再保存
enrol-outline-nothing = 该轮廓没有改变任何内容
enrol-outline-nothing-advice = 请围住可保留或去除的点，或撤销
enrol-other-program = 打开此零件库之后，另一程序保存了名为 { $name } 的零件
enrol-other-program-advice = 再次保存以替换它，或为此零件另取名称
enrol-changed-since = { $part } 保持不变：此后另一窗口或程序更改了它
enrol-changed-since-advice = 请在已注册的零件中打开它，以重命名或移除
enrol-saved = 已保存 { $part }
enrol-saved-over = 已保存 { $part }；之前的版本保留在零件库的回收站中
enrol-saved-over-path = 已保存 { $part }；之前的版本及其喷涂轨迹保留在零件库的回收站中：请为新坐标系保存喷涂轨迹
enrol-title-changed = 已更改 { $part } 的标题
enrol-removed = 已移除 { $part }
enrol-brought-back = 已恢复 { $part }
enrol-stored-path = 已为 { $part } 保存含 { $count } 个点的喷涂轨迹
enrol-removed-path = 已移除 { $part } 的喷涂轨迹
enrol-undone = 已撤销：“{ $what }”
