"""Slips of the pen made good: Chinese characters that an input method mixes up, and Latin words a letter or two off."""

from __future__ import annotations

from collections.abc import Iterable

from wirelessagent.language.deferred import deferred
from wirelessagent.language.text import CJK

_SOUNDS = (  # characters that sound alike
    "例列利力立理里厉历丽 率律绿虑滤 功公工供攻共宫 平评苹凭瓶 效校小笑消晓 速素诉宿塑 度读堵渡 低底抵滴敌递 "
    "高搞告稿 吞屯 吐土图途 量亮良两谅 "
    "总综宗 最嘴罪醉 大打达 慢满漫曼 快块筷 省升生声胜圣 电店点典垫 节接洁捷结 耗好号浩毫 比必笔币毕 分份芬纷 "
    "配陪赔佩 均军君 衡横恒哼 "
    "焦交教骄 尔而儿耳 用拥永 户护互 样养洋 等灯登 传船川 发法罚 射设社摄 辐服福复幅 压押鸭牙 差查茶插 弱若 撤彻车 "
    "回会汇惠 退推腿 应映英 "
    "输书树术 释是式试室 兆照招找 限线现先 基机及级集 站占战展 信心新芯 道到倒 宽款 带代待戴 容融荣 流留刘 "
    "降将讲奖 优有又"
)
SOUND_OF = {letter: group[0] for group in _SOUNDS.split() for letter in group}
_WORDS = (
    "功率 速率 效率 能效 比例 公平 最低 最大 最小 最慢 最差 最高 吞吐 省电 节能 功耗 能耗 发射 带宽 容量 速度 网速 "
    "电费 焦耳 比特 用户 瓦特 中断 概率 "
    "可靠 权重 撤销 应用 解释 比较 历史 状态 帮助 平衡 均衡 辐射 电池 续航"
)
_MEANT = {"".join(SOUND_OF.get(letter, letter) for letter in word): word for word in _WORDS.split()}
_OTHER_WORDS = "公里 工会 公用 工作 小时 消费 小户 点击 有用 大家"
_RIGHT = frozenset(_WORDS.split()) | frozenset(_OTHER_WORDS.split())
_PAIR = deferred(f"(?=([{CJK}]{{2}}))")


def respelt(plain: str) -> str:
    """The text with words of the trade put right that sound as they should; same length.

    >>> respelt("发射功律要最抵"), respelt("比列公平")
    ('发射功率要最低', '比例公平')
    """
    letters = list(plain)
    for match in _PAIR.finditer(plain):
        pair, place = match[1], match.start()
        if pair in _RIGHT:
            continue
        meant = _MEANT.get("".join(SOUND_OF.get(letter, letter) for letter in pair))
        changed = meant is not None and sum(a != b for a, b in zip(meant, pair, strict=True)) == 1
        if meant is not None and changed:
            letters[place : place + 2] = meant
    return "".join(letters)


def nearest(word: str, known: Iterable[str], most: int = 2) -> str:
    """The one known word with the same first letter that is at most so many edits away; "" for none or several."""
    close = [other for other in known if other[0] == word[0] and abs(len(other) - len(word)) <= most]
    letters = set(word)
    near = [other for other in close if len(letters.difference(other)) <= most and _edits(word, other, most) <= most]
    return near[0] if len(near) == 1 else ""


def _edits(a: str, b: str, most: int) -> int:
    """Letters missing, added or changed between two words; anything beyond ``most`` is as good as another."""
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, start=1):
        previous, row[0] = row[0], i
        for j, y in enumerate(b, start=1):
            previous, row[j] = row[j], min(row[j] + 1, row[j - 1] + 1, previous + (x != y))
        if min(row) > most:
            return most + 1
    return row[-1]


def one_edit(a: str, b: str) -> bool:
    """Whether one letter missing, added, changed, or a swap of neighbours makes a into b."""
    if len(a) > len(b):
        a, b = b, a
    at = next((i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), len(a))
    if len(a) < len(b):
        return len(b) == len(a) + 1 and a[at:] == b[at + 1 :]
    swapped = a[at + 1 : at + 2] + a[at : at + 1] + a[at + 2 :]
    return a[at + 1 :] == b[at + 1 :] or swapped == b[at:]
