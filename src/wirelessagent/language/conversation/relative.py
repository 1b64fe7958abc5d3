"""Figures that are said by what holds: "double the rates", "half the power", "速率提高一倍"."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.intent import EVERYBODY, Constraint, Intent
from wirelessagent.language.recogniser import Context

_OWN = r"(?:(?:the|our|its|their|my|all|of|every(?:one|body)(?:'s)?|each|users?'?|@'?s?|for|this|that)\s+)*+"
_POWER = (
    rf"{_OWN}(?:(?:total|transmit(?:ted)?|tx|radiated|maximum|max)\s+)*(?:power|budget|wattage)"
    r"(?:\s+(?:limit|budget|cap))?"
)
_RATE = (
    rf"{_OWN}(?:(?:minimum|min|guaranteed|promised|data|maximum|max|bit)\s+)*(?:rates?|speeds?|throughputs?|bitrates?)"
    r"(?:\s+(?:floor|limit|cap|guarantee|requirement)s?)?(?:\s+(?:of|for)\s+(?:@|everyone|everybody|all|each(?:\s+user)?|"
    r"(?:all\s+)?(?:the\s+)?users))?"
)
_NOUN = rf"(?P<noun>{_POWER}|{_RATE}|it|that|this)"
_ZH_NOUN = (
    r"(?:把|将|让|使)?(?:@的?)?(?:(?:大家|每个用户|每个人|所有用户|所有人|全部用户|用户|各用户)的?)?(?P<noun>"
    r"(?:总|发射|最大)?功率(?:上限|限制|预算)?|(?:最低|最小|最高|最大|保证|保底|承诺)?的?(?:速率|速度|网速)"
    r"(?:要求|保证|下限|上限)?)"
)
_PERCENT = r"(?P<percent>\d+(?:\.\d+)?)\s*(?:%|percent|per\s+cent)"
_ZH_PERCENT = r"(?:(?P<percent>\d+(?:\.\d+)?)\s*%|百分之(?P<zh_percent>\d+))"
_BE = r"(?:were|was|is|are|being|been|be|should|to|would|has|had|gets|get|got|goes|went)"
_MORE = r"(?:(?P<up>more|higher)|(?P<down>less|lower))"
_ZH_ALSO = "(?:再|都|全部|整体|统一|也|能)*+"

_TWICE = r"(?:doubled?|twice|two\s+times)"
_FACTORS: tuple[tuple[float, str], ...] = (
    (0.5, r"halved?|half|cut\s+(?:in|by)\s+half|half\s+as\s+(?:much|high|big|fast)"),
    (2.0, rf"{_TWICE}(?:\s+as\s+(?:much|high|big|fast))?"),
    (3.0, r"tripled?|trebled?|thrice|three\s+times(?:\s+as\s+(?:much|high|big|fast))?"),
    (4.0, r"quadrupled?|four\s+times(?:\s+as\s+(?:much|high|big|fast))?"),
    (10.0, r"ten\s+times(?:\s+as\s+(?:much|high|big|fast))?"),
)
_FACTOR = "(?:" + "|".join(f"(?P<a{place}>{words})" for place, (_, words) in enumerate(_FACTORS)) + ")"
_ZH_UP, _ZH_DOWN = "(?:提高|增加|提升|加大|增大|调高|加快|升高)", "(?:减少|降低|减小|缩小|下降|调低)"
_ZH_TO = "(?:到|成|为|至)(?:现在|原来)?的?"
_ZH_HALF = (
    f"减半|砍半|折半|(?:{_ZH_DOWN}|降|少|砍|减)(?:掉|了)?一半|(?:{_ZH_DOWN}|降|变|减){_ZH_TO}一半|"
    "(?:只有|是)(?:现在|原来)?的?一半"
)
_ZH_TWICE = (
    f"翻倍|加倍|翻一番|翻番|翻一倍|(?:{_ZH_UP}|快|多|高|加)(?:了)?一倍|(?:{_ZH_UP}|变|加){_ZH_TO}[两二2]倍|"
    "是?(?:现在|原来)的[两二2]倍"
)
_ZH_FACTORS: tuple[tuple[float, str], ...] = (
    (0.5, _ZH_HALF),
    (2.0, _ZH_TWICE),
    (3.0, f"(?:{_ZH_UP}|变|加){_ZH_TO}[三3]倍|是?(?:现在|原来)的[三3]倍|{_ZH_UP}[两二2]倍"),
    (4.0, f"翻两番|(?:{_ZH_UP}|变|加){_ZH_TO}[四4]倍|是?(?:现在|原来)的[四4]倍|{_ZH_UP}[三3]倍"),
)
_ZH_FACTOR = "(?:" + "|".join(f"(?P<zh{place}>{words})" for place, (_, words) in enumerate(_ZH_FACTORS)) + ")"

_PATTERNS = (
    # "double the rate", "half the power", "cut the power in half", "the power were halved"
    rf"{_FACTOR}\s+(?:of\s+)?{_NOUN}",
    rf"(?:cut|reduce|lower|decrease|drop|bring)\s+{_NOUN}\s+(?:down\s+)?(?:(?:in|by|to)\s+)?(?:a\s+)?(?P<half>half)",
    rf"{_NOUN}\s+(?:{_BE}|only|increased?|rises?|raised|grows?|cut|reduced|times|\s)*+(?:(?:to|by|in)\s+)?{_FACTOR}(?:\s+it)?",
    rf"(?:make|set|raise|increase|boost)\s+{_NOUN}\s+(?:to\s+)?{_FACTOR}",
    # "raise the power by 20 %", "20 % less power", "the power were 20 % lower"
    rf"(?:(?P<up>increase|raise|boost|lift)|(?P<down>decrease|reduce|lower|cut|drop))\s+{_NOUN}\s+by\s+{_PERCENT}",
    rf"{_PERCENT}\s+{_MORE}\s+{_NOUN}",
    rf"{_NOUN}\s+(?:{_BE}|\s)*+{_PERCENT}\s+{_MORE}",
    rf"{_NOUN}\s+(?:{_BE}|\s)*+(?:(?P<up>increased|raised|up)|(?P<down>decreased|reduced|lowered|cut|down))\s+by\s+{_PERCENT}",
    # "速率提高一倍", "一半的功率", "功率降低20%"
    rf"(?:{_ZH_NOUN}|把?它)?{_ZH_ALSO}{_ZH_FACTOR}",
    rf"(?:只)?(?:用|有|给)?(?:(?P<half>一半|半数)|(?P<twice>[两二2]倍|双倍))的?{_ZH_NOUN}",
    rf"{_ZH_NOUN}{_ZH_ALSO}(?:(?P<up>{_ZH_UP}|上调|多)|(?P<down>{_ZH_DOWN}|下调|少))(?:了)?{_ZH_PERCENT}",
)
_SHAPES = tuple(re.compile(pattern) for pattern in _PATTERNS)
_CHANGING = re.compile(
    r"(?:(?:now|actually|also|then|just|only|use|with|at\s+most|no\s+more\s+than)\s+|(?:现在|再|也|最多|只用)[,，]?)*"
)
_WILL_YOU = re.compile(r"(?:please\s+)?(?:could|can|would|will)\s+you\b|能不能|可以|能否|可否")
_SUPPOSING = re.compile(
    r"(?:(?:and|but|so)\s+)?(?:what\s+(?:if|about|happens\s+(?:if|with)|would\s+happen\s+(?:if|with))|suppose|supposing|"
    r"imagine|assume|how\s+about|if)\s+(?:(?:we|you|i|they|it|the\s+cell)\s+)?(?:(?:only|had|have|has|got|used?|were\s+to|could)\s+)*|"
    r"(?:那|那么|但|但是)?(?:如果|要是|假如|假设|若是?|倘若|万一|设想)(?:把|将|我们|只)*"
)
_SUPPOSED_END = re.compile(
    r"[,，]?\s*(?:(?:then\s+)?what(?:\s+(?:would\s+happen|then|happens))?|又?会?(?:怎么样|怎样|如何|怎么办)|的话|呢|结果如何)*"
    r"[?？。.\s]*$"
)


@dataclass(frozen=True, kw_only=True)
class Scaled:
    """A figure that is to be a multiple of what holds: of "power", "rate" or "that"; a floor unless ``cap``."""

    of: str
    factor: float
    cap: bool

    def name_in(self, context: Context) -> str | None:
        """The constraint that is meant; None where "that" could be several or none."""
        if self.of != "that":
            return "max_power_w" if self.of == "power" else "max_rate_bps" if self.cap else "min_rate_bps"
        stated = [name for name in ("max_power_w", "min_rate_bps", "max_rate_bps") if name in context.stated]
        return stated[0] if len(stated) == 1 else None


def read_relative(line: Line) -> Intent | None:
    """A change of a limit by a factor, or what would be if it were so changed; None for any other line."""
    context = line.context
    if context.objective is None or line.figures or len(line.users) > 1:
        return None
    lead = _SUPPOSING.match(line.wish)
    said = line.wish if lead is None else line.wish[lead.end() :]
    if lead is not None:
        said = _SUPPOSED_END.sub("", said)
    elif _WILL_YOU.match(line.shape):
        said = _WILL_YOU.sub("", said).rstrip("?？吗 ")
    scaled = scaled_in(_CHANGING.sub("", said, count=1))
    if scaled is None:
        return None
    name = scaled.name_in(context)
    if name is None:
        return None
    value = _times(_held(scaled, name, context), scaled.factor, line.users)
    if value is None:
        return line.ask("no_rate_to_change")
    if lead is not None:
        return line.question("what_if", constraints={name: value})
    return line.allocate(context.objective, {name: value}, amends=True)


def scaled_in(said: str) -> Scaled | None:
    """What a shape without its lead-in changes, and by which factor.

    >>> scaled_in("double the rates")
    Scaled(of='rate', factor=2.0, cap=False)
    """
    match = next((match for match in (shape.fullmatch(said.strip()) for shape in _SHAPES) if match is not None), None)
    if match is None:
        return None
    noun = match["noun"] or "it"
    of = "power" if re.search("power|budget|wattage|功率", noun) else "rate"
    of = "that" if noun in ("it", "that", "this") else of
    return Scaled(of=of, factor=_factor(match), cap=re.search(r"max|cap|limit|上限|最高|最大", noun) is not None)


def _factor(match: re.Match[str]) -> float:
    groups = match.groupdict()
    percent = groups.get("percent") or groups.get("zh_percent")
    if percent:
        return 1 + float(percent) / 100 if groups.get("up") else 1 - float(percent) / 100
    if groups.get("half") or groups.get("twice"):
        return 0.5 if groups.get("half") else 2.0
    prefix, factors = ("zh", _ZH_FACTORS) if "zh0" in groups else ("a", _FACTORS)
    return next(factor for place, (factor, _) in enumerate(factors) if groups[f"{prefix}{place}"])


def _held(scaled: Scaled, name: str, context: Context) -> Constraint | None:
    """What the factor is of: the limit that holds, which for power is the cell's where it is the lower one."""
    held = context.constraints.get(name)
    if name == "max_power_w":
        return min(held, context.max_power_w) if isinstance(held, float) else context.max_power_w
    stated = context.stated.get(name)
    if scaled.of == "that" and isinstance(stated, Mapping) and isinstance(held, Mapping):
        return {user: held[user] for user in stated if user in held} or None
    return held


def _times(held: Constraint | None, factor: float, users: tuple[str, ...]) -> Constraint | None:
    """What holds times a factor, for these users alone where any are named; None where they have no figure."""
    if held is None or factor <= 0 or isinstance(held, tuple):
        return None
    if not users:
        return _each(held, factor) if isinstance(held, Mapping) else held * factor
    own = held.get(users[0], held.get(EVERYBODY)) if isinstance(held, Mapping) else held
    return None if own is None else {users[0]: own * factor}


def _each(held: Mapping[str, float], factor: float) -> dict[str, float]:
    return {user: figure * factor for user, figure in held.items()}
