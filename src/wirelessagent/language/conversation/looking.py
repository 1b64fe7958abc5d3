"""Questions for what was measured and what holds the result back: "what is the SNR of user 3?", "who limits us?"

The detail "asked" is "gain", "limits" or "duration"; "user" and "subcarrier" (its number from 1) say whose gain.
"""

from __future__ import annotations

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Detail, Intent
from wirelessagent.language.numerals import chinese_value
from wirelessagent.language.text import normalise

_GAIN = deferred(
    r"\b(?:s(?:i)?nr|signal[-\s]to[-\s]noise(?:\s+ratio)?|(?:channel\s+)?gains?|path\s*loss)\b|信噪比|增益|路径损耗"
)
_ASKS = deferred(
    r"^(?:and\s+)?(?:what|how|which|tell|show|give)\b|\?$|？$|多少|多大|多高|是什么|怎么样|如何|[吗呢]$|^(?:the\s+)?(?:sinr|snr|gain)\b"
)
_SUBCARRIER = deferred(
    r"\bsubcarrier\s*(?:no\.?|number|#)?\s*(\d+)|(?:第\s*)?(\d+|[一二三四五六七八九十]+)\s*(?:号|个)?子载波|子载波\s*(\d+)"
)
_DURATION = deferred(
    r"how\s+(?:long|much\s+time)\s+(?:did|does|will|would)\s+(?:it|that|this|the\s+\w+|you)\s+(?:take|need|run|compute|calculate)\b.*|"
    r".*\b(?:comput\w+|calculation|solv\w+|run|running)\s+time\b.*|how\s+(?:fast|quick)\w*\s+(?:did|was|were)\s+(?:you|it|that)\b.*|"
    r".*(?:花|用|算|耗)了?(?:多久|多长时间|多少时间).*|.*(?:计算|求解|运行)(?:时间|耗时|用时).*"
)
_LIMITS = deferred(
    r"(?:who|what|which\s+(?:user|one|limit|constraint)s?)(?:'s|\s+is|\s+are)?\s+(?:it\s+that\s+)?(?:mainly\s+|really\s+|now\s+)?"
    r"(?:limit\w*|restrict\w*|constrain\w*|bottleneck\w*|slow\w*|drag\w*|hold(?:s|ing)?\s+(?:\w+\s+)?back)\b.*|"
    r".*\b(?:the|a|our)\s+(?:bottleneck|limiting\s+(?:factor|user)|binding\s+constraint)s?\b.*|"
    r".*(?:瓶颈|拖后腿|拖累|受什么限制|被什么限制|限制了(?:我们|速率|性能|结果|大家)|卡在哪).*"
)


def read_looked(line: Line) -> Intent | None:
    """The question of a line for gains, for the time it took or for what holds the result back; None for any other."""
    said = line.wish.strip()
    if line.context.objective is None or line.figures:
        return None
    plain = said.rstrip("?？ .。")
    if _DURATION.fullmatch(plain):
        return line.question("other", asked="duration")
    if _LIMITS.fullmatch(plain) and not line.users:
        return line.question("other", asked="limits")
    if not _GAIN.search(said) or not _ASKS.search(said):
        return None
    place = _SUBCARRIER.search(normalise(line.text).lower())
    if len(line.users) != 1 and place is None:
        return None
    user: dict[str, Detail] = {"user": line.users[0]} if line.users else {}
    word = "" if place is None else next(one for one in place.groups() if one)
    number = float(word if word.isdecimal() else chinese_value(word) or 0) if word else 0.0
    where: dict[str, Detail] = {"subcarrier": number} if word else {}
    return line.question("users", asked="gain", **user, **where)
