"""Questions what could be promised at most: "what's the most I could promise everyone at 10 W?"

They are what-ifs of another aim, with the detail "asked": the highest rate for the slowest user, or for one user alone.
"""

from __future__ import annotations

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import EVERYBODY, Constraint, Detail, Intent
from wirelessagent.language.sentence import Sentence, own_words

_HOW_MUCH = deferred(r"\b(?:what|how\s+(?:much|high|fast|many))\b|多少|多高|多大|几兆|多快|什么速率|哪个速率")
_MOST = deferred(r"\b(?:most|max(?:imum|imal)?|highest|largest|biggest|best|top|up\s+to)\b|最多|最高|最大|最快|上限")
_CAN = deferred(r"\b(?:can|could|possible|possibly|able|may|might|at\s+(?:least|most))\b|能|可以|可|够")
_PROMISE = deferred(r"\b(?:promis\w+|guarantee\w*|assur\w+|ensur\w+|commit\w*|offer\w*)\b|保证|承诺|保底|保障|许诺")
_GIVE = deferred(r"\b(?:give|get|have|serve|provide|deliver|achieve|receive)s?\b|给|得到|分到|拿到|达到|有|提供")
_RATE = deferred(r"\b(?:rates?|speeds?|throughput|mbit|kbit)\b|速率|速度|兆")
_OF_ALL = deferred(
    r"\b(?:every(?:one|body)|each|all\s+(?:the\s+)?users|every\s+user|all\s+of\s+them|per\s+(?:user|head)|slowest|worst)\b|"
    r"每[个位名]?|大家|所有人|所有用户|各用户|人人|最慢的?|最差的?"
)
_NOT_THIS = deferred(r"\b(?:why|power\s+(?:do|does|would|is)|watts)\b|多少(?:功率|瓦|电)|为什么|用户数|子载波")
_LIMITS = ("max_power_w", "outage_probability", "users", "leave_out")


def read_promisable(line: Line) -> Intent | None:
    """The what-if of a question what could be promised at most; None for any other line."""
    said = line.shape
    if not _HOW_MUCH.search(said) or len(line.users) > 1 or _NOT_THIS.search(said):
        return None
    promises, most, can = (words.search(said) for words in (_PROMISE, _MOST, _CAN))
    if _OF_ALL.search(said) or line.users:
        asked = (promises and (most or can)) or (_GIVE.search(said) and most and can)
    else:
        asked = promises and can and (most or _RATE.search(said))
    if not asked:
        return None
    if any(figure.kind == "rate" for figure in line.figures):
        return None
    context = line.context
    sentence = Sentence(line.text, own_words(), names=context.user_names, max_power_w=context.max_power_w)
    limits: dict[str, Constraint] = {name: value for name, value in sentence.reading.values.items() if name in _LIMITS}
    one = line.users[0] if line.users and not _OF_ALL.search(said) else None
    if one is None:
        return _what_if(line, "max_min_rate", limits, "min_rate_bps weights")
    limits = {name: value for name, value in limits.items() if name not in ("users", "leave_out")}
    return _what_if(line, "max_rate", {**limits, "weights": {EVERYBODY: 0.0, one: 1.0}}, "weights", user=one)


def _what_if(line: Line, objective: str, limits: dict[str, Constraint], dropped: str, **details: Detail) -> Intent:
    further: dict[str, Detail] = {"constraints": limits} if limits else {}
    return line.question("what_if", asked="most", objective=objective, dropped=dropped, **further, **details)
