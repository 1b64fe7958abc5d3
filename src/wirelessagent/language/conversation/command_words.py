"""The words that a command to apply, undo or start over may consist of, with politeness and what stands between."""

from __future__ import annotations

_AROUND = """
please pls kindly ok okay well now then just so and but hey oh ah oops whoops sorry damn thanks thank cheers
right good great fine perfect nice alright agreed happy satisfied content sounds looks works quickly immediately
once already at the a an this that these those it its all whole everything thing things lot of to from for with
in into onto on up out off over by me us my our i i'd i'm we we'd we're let let's lets you've i've want need
like is was were be had have has as how way what where when again before after since last previous prior earlier
former latest old initial original first one ones time start beginning ago minutes five mistake mistaken made
wrong worse better bad yes sure
"""
_UNDO = """
undo undid revert rollback roll rolling back backwards step steps take taking go going went gone get put bring
set change changes changed move moves restore return reverse cancel withdraw retract reinstate reactivate switch
turn fall state states setting settings setup configuration config version plan solution allocation result
decision action request requests command order edit modification
"""
_START_OVER = """
reset clear wipe erase forget delete drop scrap discard flush empty restart afresh anew scratch zero new fresh
clean slate square default defaults factory values begin session conversation requirements limits constraints
objectives goals wishes said asked told say game
"""
_APPLY = """
apply applied activate deploy implement execute push commit install enact enforce use send load write transfer
live effect force operation operational active effective happen air production practice service proceed ahead
carry make do engage run using enough any ship radio cell network base station gnb real proposal worked green
light
"""
_OTHERS = """
por favor deshaz deshacer deshazlo vuelve volver atrás revierte revertir el la lo los las último cambio restaura
anterior estado al de como estaba antes empieza empezar empecemos empezamos nuevo reinicia reiniciar reinícialo
todo todos borra bórralo borrar cero desde olvida olvídalo principio y aplica aplícalo aplicar esto eso ponlo
pon en marcha actívalo activa ejecútalo ejecuta despliégalo adelante hazlo envíalo celda configuración ahora sí
si vale s'il vous te plaît plait annule annuler annulez ça ca le les l l'état état dernier dernière changement
reviens revenir revenez arrière défais défaire retour précédent précédente restaure l'ancien ancien recommence
recommençons recommencer zéro efface effacez tout tous réinitialise réinitialiser oublie repartons à et du début
applique appliquer appliquez applique-le mets mets-le mettez œuvre active-le exécute déploie déploie-le vas-y
envoie cellule maintenant oui d'accord cette bitte rückgängig mach mache machen das zurück zum vorigen nimm
nehmen stell den alten zustand wieder her letzte letzten änderung schritt einen zurücknehmen geh zur alles
zurücksetzen von vorn vorne fang neu anfangen lösche löschen vergiss setz auf anfang anwenden wende es übernimm
übernehmen aktiviere aktivieren ausführen ausrollen spiel ein leg um die zelle damit ja und jetzt
"""
_CHINESE = """
应用 执行 下发 部署 生效 启用 实施 落地 采用 提交 激活 推送 上线 投入 运行 推到 投入运行 写进 写入 装上 动手
开始 正式 立即 立刻 马上 直接 撤销 撤消 撤回 撤掉 撤 回退 回滚 取消 还原 恢复 退回 倒回 收回 后退 往回 返回 切回
改回 换回 变回 调回 回到 退 重置 清空 清除 清掉 清零 清 初始化 推倒 推翻 从头 重来 重新 来过 从零 归零 默认 出厂
复位 忘掉 忘记 忘 删掉 删除 删 去掉 作废 全部 统统 所有 一切 全 都 上一步 上一次 上一个 上一版 上一条 上次
前一版 前一个 最后 最近 最初 初始 这次 这一步 那一步 这步 那步 刚才 刚刚 刚 之前 以前 原来 先前 前面 一次 一步
一下 操作 改动 修改 更改 变更 要求 请求 限制 约束 条件 设置 设定 配置 分配 方案 结果 状态 版本 决定 计划 会话
对话 样子 说的 说过 的话 到 基站 小区 现网 网络 设备 这份 算好 一版 希望 我希望 功率 后悔 手滑 按错 点错 弄错
搞错 错 不好 更差 变差 不对 谢谢 麻烦 帮我 帮忙 请 给我 把 将 被 就 那 这 这样 这么 按 照 用 它 个 些 份 套 版
的 了 吧 啊 呀 呢 哦 哎呀 嗯 好 好的 可以 行 没问题 是 是的 对 确认 确定 同意 我 我们 要 想 来 去 回 办 做 干 定
上 下 里 给 再 先 现在 让 掉 成 改 换 变 调 切 发 推 写 装 开 新 次 步 轮
"""

WORDS = frozenset(" ".join((_AROUND, _UNDO, _START_OVER, _APPLY, _OTHERS)).split())
"""In English, Spanish, French and German."""

CHINESE = tuple(sorted(_CHINESE.split(), key=len, reverse=True))
"""The Chinese ones, the longest first."""
