"""Which constraint each figure of a sentence means, or the question that it raises.

A power is the budget unless the words around it say circuit; a rate is promised to every user unless it is bounded
from above; a percentage is an outage or a reliability. Everything that does not fit (a total rate, one user's rate, an
amount to save, a figure without a unit, zero watts) raises a doubt instead of being dropped or bent.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from wirelessagent.language.quantities import Quantity
from wirelessagent.language.surroundings import describes_all, is_calculated, is_cells_power
from wirelessagent.language.text import CLAUSE_END

_HUGE_POWER_W = 1e5  # no cell radiates this much: a megawatt is a misspelt milliwatt

_CIRCUIT = re.compile(
    r"(?i)\b(?:circuit|static|fixed|idle|overhead|baseline)\b(?:\s+(?:power|energy|consumption|draw)\b)*|\bp_?c\b|"
    r"(?:电路|静态|固定)(?:功率|功耗|能耗|消耗)?"
)
_CORRECTION = re.compile(
    r"(?i)\b(?:no,? wait|wait|sorry|i mean|i meant|make that|scratch that|rather|correction|oops)\b|"
    r"不对|应该是|改成|算了"
)
_PER_USER = re.compile(
    r"(?i)\s*(?:each\b|apiece\b|(?:per|a|for (?:each|every))\s+(?:user|ue|person|head|subscriber|device|sensor|"
    r"subcarrier|channel|carrier|antenna)|/\s*(?:user|ue)|每)"
)
_TOTAL_BEFORE = re.compile(
    r"(?i)(?:\b(?:total|sum|overall|aggregate|combined|cell|network)\s+(?:data\s+)?(?:rate|throughput|speed|capacity)|"
    r"总速率|总吞吐量?|和速率|总共|合计|一共)[\w\s:=]{0,8}$"
)
_TOTAL_AFTER = re.compile(r"(?i)\s*(?:of\s+)?(?:in\s+total|total|altogether|overall|combined|in\s+sum)\b")
_CHANGE_BEFORE = re.compile(
    r"(?i)(?:\b(?:by|save|saves|saving|cut|another|extra|additional|reduce|plus|increase)\s*(?:about|around|roughly)?|"
    r"(?:减少|降低|节省|省下?|增加|提高|再加|多给|下降|提升|升高)了?)\s*$"
)
_CHANGE_AFTER = re.compile(
    r"(?i)\s*(?:(?:of\s+)?(?:more|less|lower|higher|faster|extra)\b|of\s+(?:the\s+)?\w*\s?(?:power|energy)\b)"
)
_SET_TO = re.compile(
    r"(?i)(?:\b(?:reduce|lower|cut|drop|bring|decrease|turn|raise|increase|set|limit)\s+(?:down\s+|up\s+)?(?:the\s+)?"
    r"(?:total\s+|max\w*\s+)?(?:transmit\s+|tx\s+|radiated\s+)?(?:power|budget)(?:\s+budget)?\s+(?:down\s+|up\s+)?(?:to|at)|"
    r"(?:总?发?射?功率)(?:降低?|减[小少]?|调|提高|升|增加?|设)(?:到|至|为)|(?:降低?|减[小少]?|提高)(?:总?发?射?功率)(?:到|至))\s*$"
)
_RATE_SET_TO = re.compile(
    r"(?i)\b(?:raise|increase|bring|set|lift|boost|push|lower|reduce)\s+(?:the\s+|each\s+|every\s+|their\s+)*"
    r"(?:min\w*\s+|user\w*\s+|data\s+|bit\s+)*(?:rates?|speeds?|throughput)\s+(?:up\s+|down\s+)?to\s+$|"
    r"(?:速率|速度|网速)(?:提高|提升|增加|升|调|设)(?:到|至|为)\s*$"
)
_STATUS = re.compile(
    r"(?i)\b(?:currently|right now|at the moment|at present|only (?:get|gets|getting|have))\b|目前|当前|现在只|只有"
)
_OUTAGE = re.compile(r"(?i)\b(?:outage|fail\w*|miss(?:es)?|risk|violat\w*|drop\w*)\b|中断|失败|违约|风险")
_RELIABLE = re.compile(
    r"(?i)\b(?:reliab\w*|availab\w*|confiden\w*|certain\w*|sure|guarantee\w*|probability|success)\b|可靠|把握|置信|成功|概率"
)
_MISSING = re.compile(r"(?i)\b(?:missing|lost|loss|unknown|holes?|absent)\b|缺失|丢失|缺少|丢包|未知")
_NAMED_USER = re.compile(
    r"(?i)\b(?:users?|ues?|subscribers?|subcarriers?|channels?|carriers?|slots?|devices?|sensors?)\s*(?:no\.?\s*|number\s*|#\s*)?"
    r"(?P<number>[0-9]+)|#\s*(?P<hash>[0-9]+)|(?:用户|子载波|信道|时隙)\s*(?P<zh>[0-9一二三四五六七八九十]+)|(?P<hao>[0-9]+)\s*号"
    r"|\b(?:first|second|third|last)\s+(?:user|ue|subcarrier)\b|第[0-9一二三四五六七八九十]+个"
)
_COUNTED_USERS = re.compile(
    r"(?i)(?<![\w.,/^*-])(?:[0-9]+|two|three|four|five|six|seven|eight|nine|ten|twelve|sixteen|twenty) (?:users|ues|"
    r"subscribers|devices|sensors|terminals|subcarriers|channels)\b|[0-9两二三四五六七八九十]+\s*个(?:用户|设备|传感器|子载波)"
)
_SOME_USERS = re.compile(
    r"(?i)\b(?:one|most|some|a few|several|many|certain|part)\s+(?:of\s+)?(?:the\s+|our\s+)?(?:users?|ues?)\b|"
    r"(?:部分|一些|某些|某个)用户"
)
_HALVED = re.compile(r"(?i)\bby (?:a )?(?:half|third|quarter)\b|\bhalf (?:the|of the|as much)\b|\bhalve\b|减半|一半")
_CUT = re.compile(CLAUSE_END)


@dataclass(frozen=True, kw_only=True)
class Doubt:
    """A question that must be asked before acting: the key of its sentence, and what it names."""

    key: str
    names: Mapping[str, str] = field(default_factory=dict[str, str])


@dataclass(frozen=True, kw_only=True)
class Reading:
    """The constraints of a sentence, the words that each came from, and what is in doubt.

    ``masked`` are the spans that are used up, so that their words do not count as wishes again; ``not_used`` are
    figures that describe the channel rather than ask for something, ``counted`` the spans of those that count.
    """

    values: Mapping[str, float]
    evidence: Mapping[str, str]
    doubts: Sequence[Doubt]
    not_used: Sequence[str]
    masked: Sequence[tuple[int, int]]
    counted: Sequence[tuple[int, int]]
    exact: frozenset[str]


def read_constraints(text: str, plain: str, quantities: Sequence[Quantity]) -> Reading:
    """The constraints in a sentence: its original text, the same normalised, and its quantities."""
    reader = _Reader(text, plain, quantities)
    for index in range(len(quantities)):
        reader.take(index)
    reader.take_users()
    return reader.result()


class _Reader:
    """One pass over the figures of a sentence."""

    def __init__(self, text: str, plain: str, quantities: Sequence[Quantity]) -> None:
        self._text, self._plain, self._quantities = text, plain, quantities
        self._values: dict[str, float] = {}
        self._evidence: dict[str, str] = {}
        self._last_end: dict[str, int] = {}
        self._doubts: list[Doubt] = []
        self._not_used: list[str] = []
        self._masked: list[tuple[int, int]] = []
        self._counted: list[tuple[int, int]] = []
        self._exact: set[str] = set()
        self._used_to = 0

    def result(self) -> Reading:
        low, high = self._values.get("min_rate_bps"), self._values.get("max_rate_bps")
        if low is not None and high is not None and low > high:
            names = {"low": self._evidence["min_rate_bps"], "high": self._evidence["max_rate_bps"]}
            self._doubts.append(Doubt(key="rates_crossed", names=names))
        return Reading(
            values=self._values, evidence=self._evidence, doubts=self._doubts, not_used=self._not_used,
            masked=self._masked, counted=self._counted, exact=frozenset(self._exact),
        )  # fmt: skip

    def take(self, index: int) -> None:
        figure = self._quantities[index]
        before_from = max(self._quantities[index - 1].end, self._used_to) if index else 0
        after_to = self._quantities[index + 1].phrase_start if index + 1 < len(self._quantities) else len(self._plain)
        cuts = [cut.end() for cut in _CUT.finditer(self._plain, before_from, figure.start)]
        before = self._plain[max([before_from, *cuts]) : figure.start]
        cut = _CUT.search(self._plain, figure.end, after_to)
        after = self._plain[figure.end : cut.start() if cut else after_to]
        self._masked.append((figure.phrase_start, figure.phrase_end))
        if figure.kind == "bare" and 0 < figure.value < 1 and _is_probability(before, after):
            self._take_ratio(figure, before, after)
        elif figure.kind == "bare":
            self._doubt("unit_missing", figure)
        elif figure.kind == "other":
            self._doubt("not_understood", figure)
        elif figure.doubtful:
            self._doubt("bits_or_bytes", figure)
        elif is_calculated(before, after):
            self._doubt("calculated", figure)
        elif figure.kind == "ratio":
            self._take_ratio(figure, before, after)
        elif not 0 < figure.value < math.inf:
            self._doubt("impossible", figure)
        elif figure.kind == "power":
            self._take_power(figure, before, after)
        else:
            self._take_rate(figure, before, after)

    def take_users(self) -> None:
        """How many users there are is the channel's affair; a user or subcarrier that is named can't be served yet."""
        for match in _COUNTED_USERS.finditer(self._plain):
            if any(figure.start <= match.start() < figure.end for figure in self._quantities):
                continue
            words = self._text[match.start() : match.end()]
            self._counted.append(match.span())
            if describes_all(*self._clause_around(*match.span())):
                self._not_used.append(words)
            else:
                self._doubts.append(Doubt(key="some_users", names={"text": words}))
        some = _SOME_USERS.search(self._plain)
        if some is not None:
            self._doubts.append(Doubt(key="some_users", names={"text": self._text[some.start() : some.end()]}))
        halved = _HALVED.search(self._plain)
        if halved is not None:
            self._doubts.append(Doubt(key="change", names={"text": self._text[halved.start() : halved.end()]}))
        for match in _NAMED_USER.finditer(self._plain):
            group = match.lastgroup
            place = match.start(group) if group is not None else match.start()
            if not any(figure.start <= place < figure.end for figure in self._quantities):
                name = self._text[match.start() : match.end()]
                self._doubts.append(Doubt(key="named_user", names={"text": name}))
                return

    def _clause_around(self, start: int, end: int) -> tuple[str, str]:
        """What stands before and after a span within its clause, figures being borders too."""
        from_ = max([0, *(figure.phrase_end for figure in self._quantities if figure.phrase_end <= start)])
        to = min(
            [len(self._plain), *(figure.phrase_start for figure in self._quantities if figure.phrase_start >= end)]
        )
        cuts = [cut.end() for cut in _CUT.finditer(self._plain, from_, start)]
        cut = _CUT.search(self._plain, end, to)
        return self._plain[max([from_, *cuts]) : start], self._plain[end : cut.start() if cut else to]

    def _take_power(self, figure: Quantity, before: str, after: str) -> None:
        circuit = _CIRCUIT.search(before) or _CIRCUIT.search(after)
        setting = _SET_TO.search(before)
        if circuit is not None:
            offset = figure.start - len(before) if _CIRCUIT.search(before) else figure.end
            self._masked.append((offset + circuit.start(), offset + circuit.end()))
            self._used_to = offset + circuit.end()
            self._set("circuit_power_w", figure.value, figure)
        elif figure.value > _HUGE_POWER_W:
            self._doubt("huge", figure)
        elif _PER_USER.match(after):
            self._doubt("power_per_user", figure)
        elif figure.comparator == "at_least":
            self._doubt("power_floor", figure)
        elif _is_change(before, after):
            self._doubt("change", figure)
        elif not is_cells_power(before, after):
            self._doubt("whose_power", figure)
        else:
            if setting is not None:
                self._masked.append((figure.start - len(before) + setting.start(), figure.end))
            self._set("max_power_w", figure.value, figure)

    def _take_rate(self, figure: Quantity, before: str, after: str) -> None:
        lead = (
            before[: len(before) - (figure.start - figure.phrase_start)]
            if figure.phrase_start < figure.start
            else before
        )
        setting = _RATE_SET_TO.search(before)
        if setting is not None:
            self._masked.append((figure.start - len(before) + setting.start(), figure.end))
        if not _PER_USER.match(after) and (_TOTAL_BEFORE.search(lead) or _TOTAL_AFTER.match(after)):
            self._doubt("total_rate", figure)
        elif _is_change(before, after):
            self._doubt("change", figure)
        elif figure.comparator is None and _STATUS.search(before + after):
            self._doubt("status", figure)
        elif figure.comparator == "at_most":
            self._set("max_rate_bps", figure.value, figure)
        else:
            self._set("min_rate_bps", figure.value, figure)
            if figure.comparator == "exactly":
                self._set("max_rate_bps", figure.value, figure)

    def _take_ratio(self, figure: Quantity, before: str, after: str) -> None:
        around = before + " " + after
        if _MISSING.search(around):
            self._not_used.append(figure.text)
            return
        if _is_change(before, after) or not (_OUTAGE.search(around) or _RELIABLE.search(around)):
            self._doubt("share", figure)
            return
        outage = figure.value if _OUTAGE.search(around) else round(1 - figure.value, 15)
        if not 0 < outage < 1:
            self._doubt("impossible", figure)
        else:
            self._set("outage_probability", outage, figure)

    def _set(self, name: str, value: float, figure: Quantity) -> None:
        """Take a value, the later one after words of correction; two values without them are a doubt."""
        if name in self._values and self._values[name] != value:
            between = self._plain[self._last_end[name] : figure.start]
            correction = _CORRECTION.search(between)
            if correction is None:
                names = {"one": self._evidence[name], "other": figure.text}
                self._doubts.append(Doubt(key="conflict", names=names))
                return
            start = self._last_end[name]
            self._masked.append((start + correction.start(), start + correction.end()))
        if figure.comparator == "exactly":
            self._exact.add(name)
        self._values[name] = value
        self._evidence[name] = figure.text
        self._last_end[name] = figure.end

    def _doubt(self, key: str, figure: Quantity) -> None:
        self._doubts.append(Doubt(key=key, names={"text": figure.text}))


def _is_probability(before: str, after: str) -> bool:
    return any(pattern.search(before + " " + after) for pattern in (_OUTAGE, _RELIABLE, _MISSING))


def _is_change(before: str, after: str) -> bool:
    """Whether the figure is an amount to save or to add, not a limit."""
    return _CHANGE_BEFORE.search(before) is not None or _CHANGE_AFTER.match(after) is not None
