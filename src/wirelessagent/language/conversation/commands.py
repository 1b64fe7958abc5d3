"""Commands that refer to the conversation itself: how much to undo, what to cancel, which turn is meant."""

from __future__ import annotations

import re

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Detail, Intent
from wirelessagent.language.numerals import chinese_value

_COUNTS = {
    word: float(number)
    for number, words in enumerate(
        (
            "once one", "twice two both couple", "thrice three", "four", "five", "six", "seven", "eight", "nine", "ten",
        ),
        start=1,
    )
    for word in words.split()
}  # fmt: skip
_N = r"(?:the\s+)?(?:last\s+|previous\s+|latest\s+)?(?P<n>\d{1,9}|(?:a\s+)?[a-z]+)"
_ZH_N = r"(?P<zh_n>\d{1,9}|[一二两三四五六七八九十]{1,3})"
_TURN = r"(?:the\s+(?:state|result|decision|plan|request|allocation)\s+(?:of|in|from|after|at)\s+)?turn"
_REF = r"(?:no\.?\s*|number\s+|#)?(?P<turn>[-+]?[\w.]*\w)"
_ZH_REF = r"第?\s*(?P<zh>[-+]?[\w.]+?)\s*(?:轮|回合)"
_ZH_NTH = _ZH_REF.replace("第?", "第")
_UNDO = r"(?:undo|revert|roll\s?back|take\s+back|go\s+back|step\s+back)"
_ZH_UNDO = "(?:撤销|撤回|回退|退回|后退|还原|退)"
_CHANGES = r"(?:times?|steps?|turns?|changes?|moves?|requests?|things?)"
_ZH_CHANGES = "(?:改动|更改|修改|操作|变更|要求|请求|内容)"

_SOME_STEPS = deferred(
    rf"{_UNDO}\s+(?:it\s+|that\s+)?(?:{_N}(?:\s+{_CHANGES})?|(?P<times>once|twice|thrice))(?:\s+back)?|"
    rf"(?:再)?{_ZH_UNDO}(?:最近|最后|前面?|上面?|掉)?的?{_ZH_N}\s*(?:次|步|轮|个|项){_ZH_CHANGES}?"
)
_ALL_STEPS = deferred(
    r"(?:undo|revert|roll\s?back|take\s+back)\s+(?:everything|it\s+all|all(?:\s+(?:of\s+(?:it|them|that)|"
    rf"(?:of\s+)?(?:the\s+|my\s+)?{_CHANGES}|that))?)|"
    rf"(?:全部|所有|一切|统统)的?{_ZH_CHANGES}?(?:都|全)?(?:撤销|撤回|还原|回退)(?:掉|了)?|"
    rf"(?:撤销|撤回|回退|还原)(?:掉)?(?:全部|所有|一切)的?{_ZH_CHANGES}?"
)
_AS_AT_THE_START = deferred(
    r"(?:put|set|take|bring|get|change|turn|restore|return|revert|undo)\s+(?:everything|it(?:\s+all)?|all(?:\s+of\s+it)?|"
    r"(?:all\s+)?things|the\s+(?:cell|lot))\s+(?:back\s+)?(?:to\s+)?(?:how|the\s+way|what|where|as)\s+(?:it|they|things|"
    r"everything|we)\s+(?:was|were|all\s+(?:was|were)|started|began)(?:\s+(?:at|in|from)\s+the\s+(?:very\s+)?(?:start|"
    r"beginning|outset)|\s+(?:originally|initially|before\s+(?:i|we)\s+(?:started|began)))|"
    r"(?:把)?(?:一切|全部|所有(?:设置|东西)?)(?:都|全)?(?:恢复|还原|退回|回)(?:到|成|为)?(?:最初|最开始|一开始|刚开始|开始|开头)"
    r"(?:的)?(?:样子|状态|时候)?"
)
_FORGET = deferred(
    r"(?:forget|wipe|erase|clear|reset)\s+(?:about\s+)?(?:the\s+(?:whole|entire)\s+(?:thing|lot|request)|the\s+lot|"
    r"everything|(?:it|that)\s+all|all\s+(?:of\s+)?(?:it|that)|everything\s+(?:i|we)\s+(?:said|asked(?:\s+for)?))|"
    r"(?:整个|全部)(?:都)?(?:忘掉|忘了|作废|不要了)"
)
_BACK_TO = deferred(
    rf"(?:(?:go|turn|switch|come|get|change|revert|return|roll|undo|take\s+(?:it|me|us)|bring\s+(?:it|me|us))?\s*back\s+"
    rf"to|(?:revert|return|rewind|undo|reset|rollback|switch)\s+to|restore|redo|reuse)\s+{_TURN}\s+{_REF}|"
    rf"(?:回到|退回到?|回退到|恢复到?|撤销到|返回到?|还原到?|用回|回){_ZH_REF}的?(?:状态|结果|要求|请求|方案|分配|"
    r"那样|时候)?"
)
_CANCEL = deferred(
    r"(?:cancel|abort|drop|discard|scrap)(?:\s+(?:it|that|this|(?:the\s+|this\s+|that\s+)?(?:plan|question|proposal)))?|"
    r"never\s?mind|forget\s+(?:it|that)|"
    r"取消(?:掉)?(?:这个|该|刚才的?|当前的?)?(?:计划|方案|问题)?(?:了)?|算了|作废|放弃(?:这个)?(?:计划|方案)?"
)
_COMPARE = deferred(
    rf"(?:how\s+does\s+(?:it|this|that)\s+)?compare\s+(?:it\s+|this\s+|that\s+)?(?:with\s+|to\s+|against\s+)?{_TURN}s?\s+"
    rf"{_REF}(?:\s*(?:,|with|to|and|against|vs\.?)\s*(?:turn\s+)?(?P<beside>[-+]?\w+))?|"
    rf"(?:比较|对比)?(?:一下)?(?:跟|和|与|同)?{_ZH_REF}的?(?:结果)?(?:(?:和|与|跟|同)第?(?P<other>[-+]?\w+?)(?:轮|回合)"
    r"的?(?:结果)?)?(?:做?个?比较|对比|相比|比一比|比)?(?:一下|怎么样|如何)?"
)
_COMPARES = deferred("compare|比")
_EXPLAIN = deferred(
    rf"(?:explain|describe|justify)\s+{_TURN}\s+{_REF}|(?:解释|说明)(?:一下)?{_ZH_REF}的?(?:结果|决定|方案|分配)?"
)
_SHOW = deferred(
    r"(?:(?:show|display|give|tell)\s+(?:me\s+)?|repeat\s+)?(?:the\s+)?(?:history\s+(?:of\s+)?)?"
    rf"(?:turn|entry)\s+{_REF}|"
    r"(?:(?:show|display)\s+(?:me\s+)?)?(?:the\s+)?history\s+(?:no\.?\s*|#)?(?P<number>[-+]?\d[\w.]*)|"
    rf"(?:显示|查看|看看|看一下|看)?(?:历史(?:记录)?)?{_ZH_NTH}的?(?:内容|记录|对话|结果|请求|要求|说了什么)?|"
    r"what\s+(?:was\s+(?:said|asked|decided)|did\s+(?:i|you|we)\s+(?:say|ask|decide))\s+in\s+turn\s+"
    r"(?P<said>[-+]?[\w.]*\w)|"
    r"(?:显示|查看|看看|看一下|看)?历史(?:记录)?\s*第?(?P<past>[-+]?[\d.]+|[一二三四五六七八九十]+)(?:轮|条|次)?"
)
_NO_REFERENCE = {
    "off", "on", "up", "down", "around", "over", "back", "out", "in", "into", "to", "it", "the", "this", "that", "last",
    "previous", "left", "right",
}  # fmt: skip
_STOP = deferred(
    r"stop(?:\s+(?:it|that|there|here))?|(?:do\s+not|don't)\s+(?:change|touch|do)\s+anything(?:\s+(?:now|yet|for\s+now))?|"
    r"leave\s+(?:it|everything)\s+(?:as\s+it\s+is|alone)|停|停下|(?:先)?(?:什么都)?(?:不要|别)(?:再)?(?:改|动)(?:任何东西|了)?"
)
_FIRST = deferred(
    r"compare\s+(?:it\s+|this\s+|that\s+)?(?:with|to|against)\s+the\s+(?:very\s+)?first(?:\s+(?:one|result|plan|decision|"
    r"request|turn))?|(?:比较|对比)?(?:跟|和|与|同)?(?:第一|最初|最开始)(?:次|个|的)?(?:结果|方案|那个|那次)?的?(?:比一比|比较|对比|相比|比)"
    r"(?:一下)?"
)
_THIS_OR = deferred(rf"(?:this(?:\s+one)?|now|the\s+current\s+one)\s*,?\s*(?:or|vs\.?|versus)\s+{_TURN}\s+{_REF}")
_APPLY = deferred(
    r"(?:(?:go\s+(?:on|ahead)|yes|fine|good|great|right|alright|sure)[,，.!\s]+(?:and\s+|then\s+)?)*+(?:(?:apply|activate|deploy|use|take)\s+(?:it|that|this)|do\s+(?:it|that|this|so)(?:\s+then)?(?:\s+(?:anyway|anyhow|regardless|all\s+the\s+same|nevertheless))?|"
    r"(?:go|proceed)\s+with\s+(?:it|that|this)|make\s+it\s+so|(?:go|do)\s+(?:for\s+it|it\s+that\s+way|like\s+that))|"
    r"(?:就|照|按)*(?:这么|这样|这个)(?:方案)?(?:去)?(?:办|做|定|来|干|执行|吧)|(?:就)?(?:用|采用)(?:这个|它)(?:方案)?|应用(?:它|这个)?"
)
_POLITE = deferred(r"\b(?:you|please)\b|请|麻烦|帮")
_THAT = deferred(r"(?:apply|activate|deploy|use|take)\s+it|应用(?:它)?")
"""Words that mean the plan that waits, where one does."""


def read_command(line: Line) -> Intent | None:
    """The command about the conversation that a line is as a whole, or None."""
    said = line.wish.rstrip("?？").strip()
    if said != line.wish.strip() and not _POLITE.search(line.shape):  # what is only asked about is not done
        return _about_a_turn(line, said)
    return _taken_up(line, said) or _undone(line, said) or _about_a_turn(line, said)


def _taken_up(line: Line, said: str) -> Intent | None:
    """A what-if that becomes the request, for "do that" right behind it."""
    context = line.context
    if not _APPLY.fullmatch(said) or context.awaits == "clarification":
        return None
    if context.ways and context.awaits == "nothing":
        return line.command("confirm", way="which")
    if context.supposed_objective is None:
        return None
    if context.awaits == "confirmation" and _THAT.fullmatch(said):
        return None
    return line.allocate(context.supposed_objective, context.supposed, amends=False)


def _undone(line: Line, said: str) -> Intent | None:
    if _FORGET.fullmatch(said):
        open_ = line.context.awaits != "nothing"
        return line.command("reject", cancel="pending") if open_ else line.command("reset")
    if _ALL_STEPS.fullmatch(said) or _AS_AT_THE_START.fullmatch(said):
        return line.command("undo", steps="all")
    if _STOP.fullmatch(said):
        return line.command("reject", cancel="pending", stop="all")
    if _CANCEL.fullmatch(said):
        return line.command("reject", cancel="pending")
    match = _BACK_TO.fullmatch(said)
    if match is not None:
        return line.command("undo", turn=_reference(match))
    match = _SOME_STEPS.fullmatch(said)
    count = _number(_first(match, "n", "zh_n", "times").removeprefix("a ")) if match is not None else None
    return None if count is None or count < 1 else line.command("undo", steps=count)


def _about_a_turn(line: Line, said: str) -> Intent | None:
    if _FIRST.fullmatch(said):
        return line.command("compare", turn="first")
    match = _THIS_OR.fullmatch(said)
    if match is not None and not _is_idiom(match):
        return line.command("compare", turn=_reference(match))
    match = _COMPARE.fullmatch(said) if _COMPARES.search(said) else None
    if match is not None and not _is_idiom(match):
        details: dict[str, Detail] = {"turn": _reference(match)}
        beside = _first(match, "beside", "other")
        return line.command("compare", **details, **({"beside": _named(beside)} if beside else {}))
    match = _EXPLAIN.fullmatch(said)
    if match is not None and not _is_idiom(match):
        return line.command("explain", turn=_reference(match))
    match = _SHOW.fullmatch(said)
    if match is not None and not _is_idiom(match):
        return line.command("history", turn=_reference(match))
    return None


def _is_idiom(match: re.Match[str]) -> bool:
    """Whether what follows "turn" is no reference: "turn it off"."""
    return _first(match, "turn") in _NO_REFERENCE


def _reference(match: re.Match[str]) -> Detail:
    return _named(_first(match, *match.re.groupindex))


def _named(word: str) -> Detail:
    """A turn's number, or the word that should have been one."""
    number = _number(word)
    return word if number is None else number


def _number(word: str) -> float | None:
    if re.fullmatch(r"[-+]?\d+(?:\.\d+)?", word):
        return float(word)
    value = _COUNTS.get(word)
    if value is None and re.fullmatch("[一二两三四五六七八九十]+", word):
        value = float(chinese_value(word) or 0)
    return value


def _first(match: re.Match[str], *names: str) -> str:
    """What the first of the groups that took part holds; "" where none did."""
    groups = match.groupdict()
    return next((groups[name] for name in names if groups.get(name)), "")
