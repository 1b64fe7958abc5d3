"""What a sentence means within a conversation: limits that go, users who come back, wishes that keep the limits."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import CONSTRAINTS, EVERYBODY, FIGURES_OF_USERS, Constraint
from wirelessagent.language.stated import Reading

if TYPE_CHECKING:
    from wirelessagent.language.recogniser import Context

_GO = (
    r"(?:without|drop|remove|lift|forget(?:\s+about)?|no\s+more|no|cancel|get\s+rid\s+of|take\s+away|delete|ignore|"
    r"scrap|waive|"
    r"abolish|clear|relax|undo|loosen|sin|quita|elimina|sans|supprime|enlève|ohne|entferne|streiche|lass)"
    r"(?:\s+(?:the|any|all|my|our|that|those|el|la|los|las|le|les|die|den|das|de))*\s+"
)
_LIMITS: tuple[tuple[str, str, str], ...] = (
    ("subcarrier_max_power_w", (r"(?:per[- ])?sub-?carrier\s+(?:power\s+)?(?:limit|cap|"
        r"ceiling)s?"), "子载波(?:功率)?(?:限制|上限)"),
    ("max_power_w", (r"(?:power|transmit power|tx power|watt)\s*(?:limit|cap|budget|ceiling|restriction|constraint|"
        r"bound)s?|limit\s+(?:on|of|for)\s+(?:the\s+)?power|"
     r"l[ií]mite\s+de\s+potencia|limite\s+de\s+puissance|leistungs(?:grenze|limit|"
     r"begrenzung)"), "(?:总|发射)?功率(?:的)?(?:限制|上限|约束|预算|封顶)"),
    ("max_rate_bps", (r"(?:max(?:imum)?\s+rates?|rate\s+(?:cap|limit|ceiling)s?|speed\s+(?:cap|"
        r"limit)s?)"), "速率(?:的)?(?:上限|封顶|限制)|最高速率|限速"),
    ("min_rate_bps", (r"(?:min(?:imum)?\s+(?:data\s+)?(?:rates?|speeds?)|rate\s+(?:floor|guarantee|promise|"
        r"requirement)s?|guarantees?|promises?|floors?|guaranteed\s+rates?|"
     r"(?:tasa|velocidad)\s+mínima|débit\s+minim(?:al|um)|"
     r"mindestrate)"), "最低速率|保底(?:速率)?|速率(?:保证|要求|下限)|最小速率"),
    ("outage_probability", (r"(?:outage(?:\s+probability|\s+limit)?|reliability(?:\s+requirement|"
        r"\s+target)?)"), "中断概率(?:限制|要求)?|可靠性(?:要求)?"),
    ("weights", (r"(?:weights?|weighting|priorit(?:y|ies)|priorités?|poids|prioridad(?:es)?|pesos?|"
     r"priorität(?:en)?|gewichtung(?:en)?|gewichte?)"), "权重|优先级"),
    ("circuit_power_w", r"circuit\s+power", "电路功率"),
    ("resource_block_group_size", r"(?:groups?|blocks?|grouping)(?:\s+of\s+subcarriers)?", "(?:子载波)?分组"),
)  # fmt: skip
_ALL = deferred(
    rf"(?i)\b{_GO}(?:limits?|constraints?|restrictions?|conditions?|caps?|ceiling|límites?|limites?|grenzen?)\b|"
    r"(?:去掉|取消|不要|解除|拿掉|撤掉|放开|删除|没有)(?:所有|全部|一切)?的?(?:限制|约束|条件|上限)(?!为|在)"
)
_ZH_GO = "(?:去掉|取消|不要|解除|拿掉|撤掉|放开|删除|删掉|撤销|不用|忽略|别管|没有|不设|移除)(?:了|掉)?"
_ZH_GONE = "(?:去掉|取消|不要了|解除|拿掉|撤掉|放开|删掉|不设|没有了|免了|作废)"
_GENERAL = ("max_power_w", "min_rate_bps", "max_rate_bps", "outage_probability", "subcarrier_max_power_w")
_SAME = deferred(
    r"(?i)\b(?:same|instead|keep(?:ing)?\s+(?:the\s+)?(?:limits?|rest|everything\s+else|constraints?|figures)|"
    r"otherwise|rather|but\s+with|still|also|too|switch|change)\b|"
    r"^\s*(?:and|now|but|then|plus|ok,?\s+now|what\s+about|how\s+about)\b|条件不变|其他不变|其余不变|限制不变|改为|"
    r"改成|改用|换成|换为|换用|切换|(?:同样|相同|一样)的?(?:条件|限制|要求|需求|约束|前提|指标)|(?:要求|需求|约束|指标)(?:都)?不变|"
    r"保持(?:原有|现有|原来)?的?(?:条件|限制|要求|需求|约束)|还是"
)


_GOES = deferred(rf"(?i)(?<![A-Za-z]){_GO}|{_ZH_GO}|{_ZH_GONE}|\s(?:is|are)\s+(?:gone|off|lifted|no\s+longer|void)")


def dropped_in(plain: str, context: Context | None) -> tuple[tuple[str, ...], tuple[tuple[int, int], ...]]:
    """The constraints that a sentence lifts, and the spans of the words that say so.

    >>> dropped_in("without the power limit", None)[0]
    ('max_power_w',)
    """
    names: list[str] = []
    spans: list[tuple[int, int]] = []
    for name, english, chinese in _LIMITS if _GOES.search(plain) else ():
        match = re.search(
            rf"(?i)(?<![A-Za-z]){_GO}(?:{english})(?![A-Za-z])|{_ZH_GO}(?:{chinese})|(?:{chinese})(?:也|都|"
            rf"就)?{_ZH_GONE}"
            rf"|(?<![A-Za-z])(?:{english})\s+(?:is|are)\s+(?:gone|off|lifted|no\s+longer\s+\w+|void)",
            plain,
        )  # fmt: skip
        if match is not None and not any(start < match.end() and match.start() < end for start, end in spans):
            names.append(name)
            spans.append(match.span())
    for name, english, _ in _LIMITS * bool(spans):  # "forget the weights, and the power limit too"
        behind = re.compile(
            rf"(?i)(?:\s*,|\s+(?:and|or|nor))+\s+(?:(?:the|any|all|my|our|that)\s+)?(?:{english})(?![A-Za-z])"
        )
        found = (behind.match(plain, end) for _, end in spans)
        match = next((each for each in found if each is not None), None)
        if match is not None and name not in names:
            names.append(name)
            spans.append(match.span())
    match = _ALL.search(plain) or re.search("功率(?:不设限|不限制|不限|没有上限|随便用)|不限功率", plain)
    if match is not None and not names:
        held = tuple(context.constraints) if context is not None else ()
        power = "功率" in match.group()
        names = ["max_power_w"] if power else [name for name in _GENERAL if name in held] or ["max_power_w"]
        spans.append(match.span())
    return tuple(name for name in CONSTRAINTS if name in names), tuple(spans)


def with_users_back(reading: Reading, context: Context) -> tuple[dict[str, Constraint], tuple[str, ...]]:
    """What a sentence that takes users in again changes: constraints to state, and those to drop before."""
    values, dropped = taken_in(reading.back, context)
    return {**reading.values, **values}, dropped


def taken_in(users: tuple[str, ...], context: Context) -> tuple[dict[str, Constraint], tuple[str, ...]]:
    """What serving these users too changes: constraints to state, and those to drop before; nothing where they are."""
    wanted = numbers_of(users, context.user_names)
    left_out, served = context.constraints.get("leave_out"), context.constraints.get("users")
    values, dropped = dict[str, Constraint](), list[str]()
    if isinstance(left_out, tuple) and wanted & numbers_of(left_out, context.user_names):
        remaining = tuple(user for user in left_out if not wanted & numbers_of((user,), context.user_names))
        dropped.append("leave_out")
        values |= {"leave_out": remaining} if remaining else {}
    if isinstance(served, tuple) and not wanted <= numbers_of(served, context.user_names):
        values["users"] = tuple(dict.fromkeys((*served, *users)))
    return values, tuple(dropped)


def users_in(constraints: Mapping[str, Constraint]) -> list[str]:
    """Everybody whom constraints name, each once, in their order; "all" is nobody's name.

    >>> users_in({"max_power_w": 5.0, "min_rate_bps": {"all": 1e5, "3": 1e6}, "users": ("3", "5")})
    ['3', '5']
    """
    named = (value for value in constraints.values() if isinstance(value, Mapping | tuple))
    return list(dict.fromkeys(user for users in named for user in users if user != EVERYBODY))


def numbers_of(users: Iterable[str], user_names: Sequence[str]) -> set[int | str]:
    """Which users are meant, from 1, so that "2" and "user 2" are the same; a name that nobody has stays itself.

    >>> numbers_of(("2", "Ada"), ("user 1", "user 2", "Ada"))
    {2, 3}
    """
    places: dict[str, int] = {}
    for place, name in enumerate(user_names, start=1):
        places[name.casefold()] = place
        places[name.casefold().removeprefix("user ")] = place
    for place in range(1, len(user_names) + 1):
        places.setdefault(str(place), place)
    return {places.get(user.casefold(), user.casefold()) for user in users}


def keeps_the_limits(plain: str) -> bool:
    """Whether a sentence with a wish changes the request at hand rather than replacing it."""
    return _SAME.search(plain) is not None


def merged(earlier: Mapping[str, Constraint], later: Mapping[str, Constraint]) -> dict[str, Constraint]:
    """Constraints read before, with those of a later line, such as the answer to a question."""
    return {**earlier, **{name: joined(name, earlier.get(name), value) for name, value in later.items()}}


def joined(name: str, held: Constraint | None, stated: Constraint) -> Constraint:
    """One constraint after another statement of it.

    Figures of named users join those that hold; a figure for everybody replaces them all. Users to leave out add up.
    """
    if name == "leave_out" and isinstance(held, tuple) and isinstance(stated, tuple):
        return tuple(dict.fromkeys((*held, *stated)))
    if name not in FIGURES_OF_USERS or held is None or not isinstance(stated, Mapping) or EVERYBODY in stated:
        return stated
    assert not isinstance(held, tuple)
    return {**(held if isinstance(held, Mapping) else {EVERYBODY: held}), **stated}
