"""Figures that are said by what holds: "double the rates", "half the power", "2 W less power", "功率降20%".

A share, an amount in W or bit/s and one in dB are read alike: "~", "#" and "^" stand for them in the shapes.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from wirelessagent.language.conversation.amounts import Amount, with_amount
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import EVERYBODY, Constraint, Detail, Intent
from wirelessagent.language.recogniser import Context

CORRECTING = (
    r"(?:nope|no|sorry|oops|wait|hmm|actually|rather|instead|i\s+(?:meant|mean|said)|correction|make\s+(?:it|that|this)|"
    r"(?:it|that|this)\s+(?:should|must)\s+be|should\s+(?:be|have\s+been)|change\s+(?:it|that|this)\s+to|"
    r"(?:it's|that's|it\s+is|that\s+is|that\s+was)|不对|不是|不|说错了|搞错了|错了|其实|我是说|我说的是|我的意思是|我是指|"
    "我指的是|应该是|应当是|应该|改成|改为|换成|抱歉|对不起|更正)"
)
BESIDE = r"(?:for|to|the|one|of|be|与|给|的|是|[,，\s])"
CORRECTS = deferred(CORRECTING)
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
_ZH_POWER = "(?:总|发射|最大)?功率(?:上限|限制|预算)?|用?电量?|能耗|功耗|耗电量?"
_BE = r"(?:were|was|is|are|being|been|be|should|to|would|has|had|gets|get|got|goes|went)"
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
_ZH_UP, _ZH_DOWN = (
    "(?:提高|增加|提升|加大|增大|调高|加快|升高|上调|涨)",
    "(?:减少|降低|减小|缩小|下降|调低|下调|削减|压低|减掉|省掉|省下)",
)
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
    # "速率提高一倍", "一半的功率", "功率降低20%"
    rf"(?:{_ZH_NOUN}|把?它)?{_ZH_ALSO}{_ZH_FACTOR}",
    rf"(?:只)?(?:用|有|给)?(?:(?P<half>一半|半数)|(?P<twice>[两二2]倍|双倍))的?{_ZH_NOUN}",
)
_SHAPES = tuple(deferred(pattern) for pattern in _PATTERNS)

_RAISE, _LOWER = "(?P<up>increase|raise|boost|lift)", "(?P<down>decrease|reduce|lower|cut|drop|shrink|trim)"
_TURN = "(?:turn|bring|take|dial)"
_LESS = r"(?:(?P<up>more|higher|up|extra)|(?P<down>less|lower|down|fewer))"
_BY = r"(?:by\s+[~#^]|[~^])"
_ZH_CHANGE = f"(?:(?P<up>{_ZH_UP}|多|升|加)|(?P<down>{_ZH_DOWN}|少|降|减|砍|省|节省))(?:了|掉)?"
_ZH_USED = f"(?:(?P<up>{_ZH_UP}|多用|多给|多)|(?P<down>{_ZH_DOWN}|少用|少给|少|降|减|省|节省|节约))(?:了|掉)?"
_OF_NOW = r"(?:\s+of\s+(?:(?:the\s+)?current\s+(?:one|limit|value)|it|that|what\s+it\s+(?:is|was)(?:\s+now)?))?"
_USING = r"(?:(?:run|work|live|operate|manage|do|go)\s+(?:on|with|at)\s+|(?:use|take|have)\s+)?(?:(?:only|just)\s+)?"
_AMOUNT_PATTERNS = (
    # "raise the power by 20 %", "lower the power by 2 W", "turn the power down by 3 dB", "20 % less power"
    rf"(?:{_RAISE}|{_LOWER})\s+{_NOUN}\s+(?:(?:up|down)\s+)?{_BY}",
    rf"{_TURN}\s+{_NOUN}\s+{_LESS}\s+{_BY}",
    rf"{_TURN}\s+{_LESS}\s+{_NOUN}\s+{_BY}",
    rf"[~#^](?:\s+of)?\s+{_LESS}(?:\s+{_NOUN})?",
    rf"{_NOUN}\s+(?:{_BE}|\s)*+[~#^]\s+{_LESS}",
    rf"{_NOUN}\s+(?:{_BE}|\s)*+(?:(?P<up>increased|raised|up)|(?P<down>decreased|reduced|lowered|cut|down))\s+{_BY}",
    # "run on a third of the power", "reduce the power to a third"
    rf"{_USING}~\s+(?:of\s+)?{_NOUN}",
    rf"(?:cut|reduce|lower|decrease|drop|bring|set|make|limit|raise|increase)\s+{_NOUN}\s+(?:down\s+)?to\s+~{_OF_NOW}",
    # "总功率降20%", "降低20%功率", "功率降到三分之一", "只用三分之一的功率"
    rf"{_ZH_NOUN}{_ZH_ALSO}{_ZH_CHANGE}[~#^]",
    rf"{_ZH_ALSO}{_ZH_USED}[~#^]的?(?:{_ZH_NOUN}|(?P<power>{_ZH_POWER}))?",
    rf"{_ZH_NOUN}(?:{_ZH_ALSO}|只)*+(?:{_ZH_DOWN}|{_ZH_UP}|降|减|变|改|调|设|用|限制|压)?(?:到|成|为|至)(?:现在|原来)?的?~",
    rf"{_ZH_NOUN}只(?:用|有|是|给)?(?:现在|原来)?的?~",
    rf"(?:只)?(?:用|有|给)?~的?(?:{_ZH_NOUN}|(?P<power>{_ZH_POWER}))(?:就行|就够了?|就好|行不行)?",
)
_AMOUNT_SHAPES = tuple(deferred(pattern) for pattern in _AMOUNT_PATTERNS)
_OTHER_AMOUNT = deferred(
    rf"(?:{CORRECTING}|{BESIDE}|(?:by|only|just|about)\s|[只降减少])*+(?:到|成|为)?[~#^]"
    rf"(?:of\s+(?:it|that|the\s+power)|less|more|的?功率|{CORRECTING}|才对|[,，\s])*+"
)
_CHANGING = deferred(
    r"(?:(?:now|actually|also|then|just|only|use|with|at\s+most|no\s+more\s+than)\s+|(?:现在|再|也|最多|只用)[,，]?)*"
)
_WILL_YOU = deferred(r"(?:please\s+)?(?:could|can|would|will)\s+you\b|可以")
_SUPPOSING = deferred(
    r"(?:(?:and|but|so)\s+)?(?:what\s+(?:if|about|happens\s+(?:if|with)|would\s+happen\s+(?:if|with))|suppose|supposing|"
    r"imagine|assume|how\s+about|if)\s+(?:(?:we|you|i|they|it|the\s+cell)\s+)?(?:(?:only|had|have|has|got|used?|were\s+to|could)\s+)*|"
    r"(?:那|那么|但|但是)?(?:如果|要是|假如|假设|若是?|倘若|万一|设想)(?:把|将|我们|只)*"
)
_SUPPOSED_END = deferred(
    r"[,，]?\s*(?:(?:then\s+)?what(?:\s+(?:would\s+happen|then|happens))?|又?会?(?:怎么样|怎样|如何|怎么办)|的话|呢|结果如何)*"
    r"[?？。.\s]*$"
)
_AND_WHAT = deferred(r"呢[?？]*$")
_OUTCOME = r"(?:rates?|throughput|speed|power|watts?)"
_LOSES = r"(?:cost|lose|save|bring|buy|gain|mean|give|take|do|change|matter)"
_FOR_WHOM = deferred(
    r"\s+(?:each|apiece|per\s+(?:user|head)|for\s+(?:@|each(?:\s+user)?|every\w*(?:\s+user)?|all(?:\s+users)?))$|"
    r"^(?:每[个位名]?(?:用户|人)?|大家|所有人|所有用户|各用户|@)(?=[少多降减提增])"
)
_WORTH = deferred(
    rf"(?:how\s+much|what)(?:\s+(?:total\s+)?{_OUTCOME})?\s+(?:would|does|do|will|could)\s+(?P<said>.+?)\s+{_LOSES}"
    rf"(?:\s+(?:us|me|them|the\s+\w+|(?:in|of)\s+(?:the\s+)?(?:total\s+)?{_OUTCOME}))*|"
    rf"(?:how\s+much|what)(?:\s+(?:total\s+)?{_OUTCOME})?\s+(?:would|do|does|will|can|could)\s+(?:we|i|it|they|the\s+\w+)\s+"
    r"(?:lose|save|gain|get|have|give\s+up)\s+(?:(?:with|at|for|on|by|if)\s+)(?:we\s+|i\s+|you\s+)?(?:had\s+|used?\s+)?"
    r"(?P<with>.+)|"
    r"(?P<zh>.+?)(?:的话)?[,，]?(?:会|能|将|可以|大概|我们|总?速率|吞吐量)*"
    r"(?:损失|需?要|得|少|失去|多|增加|带来|换来|换|省|节省|影响|掉|降低?|下降|提高|付出|牺牲|有)(?:掉|下|出)?(?:多少|什么|多大)"
    r"(?:的?(?:总?速率|吞吐量?|功率|兆|瓦|代价|影响|好处))?|(?P<zh_then>.+?)(?:的话)?[,，]?(?:会|又会)(?:怎么样|怎样|如何)"
)
"""What a change is worth: "how much would 10 % less power cost?", "少10%功率会损失多少?"."""
_TO_AMOUNT = deferred(r"\bto\s+[~#^]|[到成为]\s*[~#^]")


@dataclass(frozen=True, kw_only=True)
class Scaled:
    """A figure that is to be changed by what holds: of "power", "rate" or "that"; a floor unless ``cap``.

    Attributes:
        how: "of" for a multiple of what holds, "less" or "more" for a change by it.
        factor: of what holds.
        signed: 1 or -1 where the figure that is said is added, in W or bit/s; else 0.
    """

    of: str
    factor: float
    cap: bool = False
    how: str = "of"
    signed: int = 0

    def name_in(self, context: Context) -> str | None:
        """The constraint that is meant; None where "that" could be several or none."""
        if self.of != "that":
            return "max_power_w" if self.of == "power" else "max_rate_bps" if self.cap else "min_rate_bps"
        stated = [name for name in ("max_power_w", "min_rate_bps", "max_rate_bps") if name in context.stated]
        return stated[0] if len(stated) == 1 else None


def read_relative(line: Line) -> Intent | None:
    """A change of a limit by what holds, or what would be if it were so changed; None for any other line."""
    context = line.context
    if context.objective is None or len(line.figures) > 1 or len(line.users) > 1:
        return None
    other = _other_amount(line)
    if other is not None:
        return other
    weighed = _weighed(line)
    if weighed is not None:
        return weighed
    lead = _SUPPOSING.match(line.wish)
    said = line.wish if lead is None else line.wish[lead.end() :]
    supposed = lead is not None or _AND_WHAT.search(said) is not None
    if supposed:
        said = _SUPPOSED_END.sub("", said)
    elif _WILL_YOU.match(line.shape):
        said = _WILL_YOU.sub("", said).rstrip("?？吗 ")
    scaled = scaled_in(_CHANGING.sub("", said, count=1))
    name = None if scaled is None else scaled.name_in(context)
    if scaled is None or name is None or not _fits(line, scaled, name):
        return None
    basis = _of_users(_held(scaled, name, context), line.users)
    if basis is None:
        return line.ask("no_rate_to_change")
    return _changed(line, name, basis, scaled, supposed=supposed)


def _weighed(line: Line) -> Intent | None:
    """A change of which is asked what it is worth: a what-if of a share, a step of a figure; else None."""
    match = _WORTH.fullmatch(line.wish.rstrip("?？吗呢 "))
    said = "" if match is None else next(said for said in match.groupdict().values() if said)
    plain = _FOR_WHOM.sub("", said)
    scaled = scaled_in(plain)
    if scaled is None:
        return None
    if scaled.signed:
        figure = line.figures[0]
        user: dict[str, Detail] = {"user": line.users[0]} if line.users else {"each": 1.0} if plain != said else {}
        user = user if figure.kind == "rate" else {}
        step = scaled.signed * figure.value
        return line.question("step", **{"rate_bps" if figure.kind == "rate" else "power_w": step}, **user)
    name = scaled.name_in(line.context)
    basis = None if name is None else _of_users(_held(scaled, name, line.context), line.users)
    if name is not None and basis is not None:
        return _changed(line, name, basis, scaled, supposed=True)
    return line.question("step", rate_share=scaled.factor - 1.0) if scaled.of == "rate" and not line.users else None


def _fits(line: Line, scaled: Scaled, name: str) -> bool:
    """Whether the figure that is to be added, if any, is of the limit's kind."""
    kinds = {"power"} if name == "max_power_w" else {"rate"}
    return {figure.kind for figure in line.figures} == (kinds if scaled.signed else set())


def _changed(line: Line, name: str, basis: float | Mapping[str, float], scaled: Scaled, *, supposed: bool) -> Intent:
    """The limit after the change, as a request or a what-if that remembers what the change was of."""
    step = scaled.signed * float(line.figures[0].value) if scaled.signed else 0.0
    value = _each(basis, scaled.factor, step)
    if min(value.values() if isinstance(value, Mapping) else (value,)) <= 0:
        return line.ask("nothing_left_of_it")
    share: dict[str, Detail] = {"share_of": {name: basis}, "share_how": scaled.how}
    if supposed:
        return line.question("what_if", constraints={name: value}, **share)
    return line.allocate(str(line.context.objective), {name: value}, amends=True, details=share)


def _other_amount(line: Line) -> Intent | None:
    """ "No, a third": the change of the line before by another amount; asked about where there was none."""
    said, amount = with_amount(line.wish)
    match = _OTHER_AMOUNT.fullmatch(said)
    if match is None or line.users or not CORRECTS.search(said):
        return None
    context = line.context
    if not context.share_of:
        return line.ask("what_changes") if amount is not None and "outage_probability" not in context.stated else None
    name, basis = next(iter(context.share_of.items()))
    how = "of" if _TO_AMOUNT.search(said) else context.share_how
    scaled = _scaled(how, amount, "that", cap=False)
    if scaled is None or isinstance(basis, tuple) or not _fits(line, scaled, name):
        return None
    return _changed(line, name, basis, scaled, supposed=context.supposed_objective is not None)


def scaled_in(said: str) -> Scaled | None:
    """What a shape without its lead-in changes, and how.

    >>> scaled_in("double the rates").factor, scaled_in("20 % less power").factor
    (2.0, 0.8)
    """
    said = said.strip()
    shape, amount = with_amount(said)
    match = next((match for match in (each.fullmatch(shape) for each in _AMOUNT_SHAPES) if match is not None), None)
    if match is not None:
        groups = match.groupdict()
        how = "more" if groups.get("up") else "less" if groups.get("down") else "of"
        noun = groups.get("power") or groups.get("noun") or "it"
        return _scaled(how, amount, _of(noun), cap=_caps(noun))
    match = next((match for match in (each.fullmatch(said) for each in _SHAPES) if match is not None), None)
    if match is None:
        return None
    noun = match["noun"] or "it"
    return Scaled(of=_of(noun), factor=_factor(match), cap=_caps(noun))


def _scaled(how: str, amount: Amount | None, of: str, *, cap: bool) -> Scaled | None:
    """A change by a share, or by the figure of the line where there is none; None for a share of a figure."""
    if amount is not None:
        return Scaled(of=of, factor=amount.factor(how), cap=cap, how=how)
    return None if how == "of" else Scaled(of=of, factor=1.0, cap=cap, how=how, signed=1 if how == "more" else -1)


def _of(noun: str) -> str:
    if noun in ("it", "that", "this"):
        return "that"
    return "power" if re.search("power|budget|wattage|功率|电|能耗|功耗", noun) else "rate"


def _caps(noun: str) -> bool:
    return re.search(r"max|cap|limit|上限|最高|最大", noun) is not None


def _factor(match: re.Match[str]) -> float:
    groups = match.groupdict()
    if groups.get("half") or groups.get("twice"):
        return 0.5 if groups.get("half") else 2.0
    prefix, factors = ("zh", _ZH_FACTORS) if "zh0" in groups else ("a", _FACTORS)
    return next(factor for place, (factor, _) in enumerate(factors) if groups[f"{prefix}{place}"])


def _held(scaled: Scaled, name: str, context: Context) -> Constraint | None:
    """What the change is of: the limit that holds, which for power is the cell's where it is the lower one."""
    held = context.constraints.get(name)
    if name == "max_power_w":
        return min(held, context.max_power_w) if isinstance(held, float) else context.max_power_w
    stated = context.stated.get(name)
    if scaled.of == "that" and isinstance(stated, Mapping) and isinstance(held, Mapping):
        return {user: held[user] for user in stated if user in held} or None
    return held


def _of_users(held: Constraint | None, users: tuple[str, ...]) -> float | Mapping[str, float] | None:
    """What holds, for these users alone where any are named; None where they have no figure."""
    if held is None or isinstance(held, tuple):
        return None
    if not users:
        return held
    own = held.get(users[0], held.get(EVERYBODY)) if isinstance(held, Mapping) else held
    return None if own is None else {users[0]: own}


def _each(basis: float | Mapping[str, float], factor: float, step: float) -> float | dict[str, float]:
    if isinstance(basis, Mapping):
        return {user: figure * factor + step for user, figure in basis.items()}
    return basis * factor + step
