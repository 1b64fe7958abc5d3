"""Which constraint each figure of a sentence means, or the question that it raises.

What a power, a rate or a percentage is there for, and for whom, a small model judges from the words beside it
(``judged``); where it is not sure, and where a figure does not fit in whatever role (a total rate, an amount to save,
no unit, zero watts), a doubt is raised instead of dropping or bending the figure.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from wirelessagent.language import figure_words
from wirelessagent.language.allotments import Allotments, Target
from wirelessagent.language.clauses import clause_end, clause_start
from wirelessagent.language.intent import Constraint
from wirelessagent.language.judged import Judged
from wirelessagent.language.nines import nines
from wirelessagent.language.numerals import chinese_value
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.surroundings import beside, describes_all, is_calculated, is_cells_power

_SURE, _CERTAIN = 0.6, 0.8
_SURE_OF_A_LIMIT = 0.75  # most figures are limits, so that the model takes a strange one for one too easily
_MOST_POWERS = 4
_ONCE = ("max_power_w", "circuit_power_w")
_NOTHING_AHEAD = ("", "with", "at", "use", "using")  # of "10 W in total"
_RANGE_GAP = 8
_NEAR = 30
_TURNED = re.compile(
    rf"(?i)\s*[,;.\uff0c；。]?\s*(?:oh\s+)?(?:{figure_words.CORRECTION.pattern.removeprefix('(?ia)')})[\s,\uff0c]*"
)
_PUSHED = 0.3  # a power that has no role only because another has it: "10 W or 12 W"
_BOUNDS = {"at_least": "min_rate_bps", "at_most": "max_rate_bps"}
_CONTRARY = {"at_least": "max_rate_bps", "at_most": "min_rate_bps"}
_CONTRARY_CHANCE = 0.1  # "at least" seldom caps


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
    ``missing`` is a share of the channel that is said to be missing, ``steps`` amounts to add, by detail name, ``back``
    users to be taken in again, ``named`` everybody who is named.
    """

    values: Mapping[str, Constraint]
    evidence: Mapping[str, str]
    doubts: Sequence[Doubt]
    not_used: Sequence[str]
    masked: Sequence[tuple[int, int]]
    counted: Sequence[tuple[int, int]]
    exact: frozenset[str]
    missing: float | None = None
    steps: Mapping[str, float] = field(default_factory=dict[str, float])
    back: tuple[str, ...] = ()
    named: tuple[str, ...] = ()


def read_constraints(
    text: str, plain: str, quantities: Sequence[Quantity], *, names: Sequence[str] = (), max_power_w: float = 20.0
) -> Reading:
    """The constraints in a sentence: its original text, the same normalised, and its quantities.

    ``names`` are the channel's users, ``max_power_w`` what shares of the power refer to.
    """
    reader = _Reader(text, plain, quantities, names, max_power_w)
    reader.take_numbers()
    reader.take_figures()
    reader.take_users()
    return reader.result()


class _Reader:
    """One pass over the figures of a sentence."""

    def __init__(
        self, text: str, plain: str, quantities: Sequence[Quantity], names: Sequence[str], max_power_w: float
    ) -> None:
        self._text, self._plain, self._quantities = text, plain, quantities
        self._max_power_w = max_power_w
        self._values: dict[str, float] = {}
        self._evidence: dict[str, str] = {}
        self._last_end: dict[str, int] = {}
        self._doubts: list[Doubt] = []
        self._not_used: list[str] = []
        self._masked: list[tuple[int, int]] = []
        self._counted: list[tuple[int, int]] = []
        self._exact: set[str] = set()
        self._steps: dict[str, float] = {}
        self._missing: float | None = None
        self._spoken_for: list[tuple[int, int]] = []
        self._take_blocks()
        self._take_share()
        self._judged = Judged(plain, quantities, names, self._spoken_for)
        self._figures = self._judged.figures
        self._allotments = Allotments(text, plain, self._judged)
        self._target = Target(role="everybody")

    def result(self) -> Reading:
        allotted = self._allotments
        for one, other, key in allotted.crossed():
            names = {"low": one, "high": other} if key == "rates_crossed" else {"one": one, "other": other}
            self._doubts.append(Doubt(key=key, names=names))
        values: dict[str, Constraint] = {**self._values, **allotted.values()}
        return Reading(
            values=values, evidence=self._evidence | allotted.evidence(), doubts=self._doubts, not_used=self._not_used,
            masked=[*self._masked, *allotted.spans], counted=self._counted,
            exact=frozenset(self._exact | allotted.exact), missing=self._missing, steps=self._steps,
            back=allotted.back, named=allotted.named,
        )  # fmt: skip

    def take_numbers(self) -> None:
        """Numbers without a unit: users, weights, descriptions and what borrows a unit are settled."""
        self._counted += self._judged.harmless
        named = [(m.start, m.end) for m in self._judged.mentions if m.role == "named"]
        read = [(figure.start, figure.end) for figure in self._figures]
        settled = [*self._counted, *named, *read, *self._allotments.spans, *self._spoken_for]
        for figure in self._quantities:
            if figure.kind != "bare" or any(start < figure.end and figure.start < end for start, end in settled):
                continue
            self._masked.append((figure.phrase_start, figure.phrase_end))
            self._doubt("unit_missing", figure)
        for start, end in self._judged.doubtful:
            self._doubts.append(Doubt(key="unit_missing", names={"text": self._text[start:end]}))

    def take_figures(self) -> None:
        """Powers, rates and percentages, from left to right."""
        roles = self._roles_of_powers()
        for index, figure in enumerate(self._figures):
            before, after = beside(self._plain, self._figures, index)
            self._masked.append((figure.phrase_start, figure.phrase_end))
            if figure.kind == "other":
                self._doubt("not_understood", figure)
            elif figure.doubtful:
                self._doubt("bits_or_bytes", figure)
            elif is_calculated(before, after):
                self._doubt("calculated", figure)
            elif figure.kind == "ratio":
                self._take_ratio(figure, before, after, self._judged.figure(index))
            elif not 0 < figure.value < math.inf:
                self._doubt("impossible", figure)
            elif figure.kind == "power":
                role, certain = roles.get(index, ("", False))
                self._take_power(figure, before, after, role, certain=certain)
            elif self._is_replaced(index):
                self._counted.append((figure.start, figure.end))
            else:
                self._take_rate(index, before, after)

        for one, other in itertools.pairwise(self._figures):
            self._doubt_a_choice(one, other)

    def _doubt_a_choice(self, one: Quantity, other: Quantity) -> None:
        """Two figures of which one has to be chosen: "10 W or 12 W", "1号至少1兆，不，2号至少1兆"."""
        if one.kind != other.kind or one.kind not in ("power", "rate"):
            return
        gap = self._plain[one.end : other.start]
        between = [m for m in self._judged.mentions if m.role == "named" and one.end <= m.start < other.start]
        target = self._allotments.target_of(one.start) if between and one.kind == "rate" else None
        others = target is not None and target.role == "named" and set(target.users).isdisjoint(between[0].users)
        corrected = others and _TURNED.fullmatch(self._plain, one.end, between[0].start) is not None
        if (figure_words.EITHER.fullmatch(gap) and one.value != other.value) or corrected:
            start = between[0].start if corrected else other.start
            first = (
                target.mention.start if corrected and target is not None and target.mention is not None else one.start
            )
            names = {"one": self._text[min(first, one.start) : one.end], "other": self._text[start : other.end]}
            self._doubts.append(Doubt(key="conflict", names=names))

    def _roles_of_powers(self) -> dict[int, tuple[str, bool]]:
        """The role of each power and whether it is certain, "" where it is unsure; there is one limit, not two."""
        chances = {
            index: self._judged.figure(index)
            for index, q in enumerate(self._figures)
            if q.kind == "power" and not self._is_of_a_subcarrier(index)
        }
        for index in chances:
            before, after = beside(self._plain, self._figures, index)
            if before.strip().lower() in _NOTHING_AHEAD and figure_words.TOTAL_AFTER.match(after):
                chances[index] = {role: float(role == "max_power_w") for role in chances[index]}
        places = sorted(chances)[:_MOST_POWERS]
        for index in places:
            self._supersede(chances, index)
        together: dict[tuple[str, ...], float] = {}
        for roles in itertools.product(*(chances[index] for index in places)):
            held = {
                (role, self._figures[index].value) for role, index in zip(roles, places, strict=True) if role != "none"
            }
            twice = len(held) > len({value for _, value in held})  # the same figure is the same thing
            if not twice and all(sum(role == name for role, _ in held) < 2 for name in _ONCE):
                together[roles] = math.prod(chances[index][role] for role, index in zip(roles, places, strict=True))
        likeliest = max(together, key=lambda roles: together[roles])
        total = sum(together.values())
        sure = together[likeliest] / total if total > 0 else 0.0
        fits = sure > (_SURE_OF_A_LIMIT if set(likeliest) == {"max_power_w"} else _SURE)
        forced = {
            i for i, role in zip(places, likeliest, strict=True) if role == "none" and chances[i]["none"] < _PUSHED
        }
        certain = {index: chances[index][role] > _CERTAIN for index, role in zip(places, likeliest, strict=True)}
        return {
            index: (role if fits and index not in forced else "", certain[index])
            for index, role in zip(places, likeliest, strict=True)
        }

    def _is_replaced(self, index: int) -> bool:
        """Whether a rate is corrected by the next figure, nobody being named between: "1 Mbit/s, sorry, 2 each"."""
        if {each.kind for each in self._figures[index : index + 2]} != {"rate"} or index + 1 == len(self._figures):
            return False
        figure, other = self._figures[index], self._figures[index + 1]
        named = any(m.role == "named" and figure.end <= m.start < other.start for m in self._judged.mentions)
        gap = self._plain[figure.end : other.start]
        return not named and len(gap) < _NEAR and figure_words.CORRECTION.search(gap) is not None

    def _is_of_a_subcarrier(self, index: int) -> bool:
        before, after = beside(self._plain, self._figures, index)
        return bool(figure_words.SUBCARRIER.match(after) or figure_words.SUBCARRIER_BEFORE.search(before))

    def _supersede(self, chances: dict[int, Mapping[str, float]], index: int) -> None:
        """A power that the next one corrects says nothing any more, but what that one is."""
        first, second = chances[index], chances.get(index + 1)
        if second is None:
            return
        low, high = self._figures[index], self._figures[index + 1]
        same = max(first, key=lambda role: first[role]) == max(second, key=lambda role: second[role])
        doubtful = max(second.values()) < _CERTAIN
        if (same or doubtful) and figure_words.CORRECTION.search(self._plain, low.end, high.start):
            chances[index] = {**dict.fromkeys(first, 0.0), "none": 1.0}
            chances[index + 1] = {role: max(first[role], second[role]) if role != "none" else 0.0 for role in second}

    def take_users(self) -> None:
        """How many users there are is the channel's affair; a user who is named and gets nothing raises a doubt."""
        for match in figure_words.COUNTED_USERS.finditer(self._plain):
            taken = [(figure.start, figure.end) for figure in self._quantities] + self._spoken_for
            described = any(match.start() <= start < match.end() for start, _ in self._judged.recounted)
            if described or any(start <= match.start() < end for start, end in [*taken, *self._allotments.spans]):
                continue
            words = self._text[match.start() : match.end()]
            self._counted.append(match.span())
            if describes_all(*self._clause_around(*match.span())):
                self._not_used.append(words)
            else:
                self._doubts.append(Doubt(key="some_users", names={"text": words}))
        some = figure_words.SOME_USERS.search(self._plain)
        if some is not None:
            self._doubts.append(Doubt(key="some_users", names={"text": self._text[some.start() : some.end()]}))
        halved = figure_words.HALVED.search(self._plain)
        settled = [*self._spoken_for, *self._allotments.spans, *self._counted]
        if halved is not None and not any(start < halved.end() and halved.start() < end for start, end in settled):
            self._doubts.append(Doubt(key="change", names={"text": self._text[halved.start() : halved.end()]}))
        others = figure_words.OTHERS_HALVED.search(self._plain)
        if others is not None:
            self._doubts.append(Doubt(key="change", names={"text": self._text[others.start() : others.end()]}))
        nobody = figure_words.NOBODY.search(self._plain)
        if nobody is not None:
            self._doubts.append(Doubt(key="some_users", names={"text": self._text[nobody.start() : nobody.end()]}))
        for start, end in self._allotments.take_users():
            self._doubts.append(Doubt(key="named_user", names={"text": self._text[start:end]}))
        step = figure_words.STEP.search(self._plain)
        if step is not None:
            self._steps.setdefault("power_w", 1.0)

    def _take_blocks(self) -> None:
        match = figure_words.BLOCKS.search(self._plain)
        if match is None or match.lastgroup is None:
            return
        word = match[match.lastgroup].lower()
        size = int(word) if word.isdigit() else figure_words.BLOCK_WORDS.get(word) or int(chinese_value(word) or 0)
        self._spoken_for.append(match.span())
        self._masked.append(match.span())
        words = self._text[match.start() : match.end()]
        if size < 1:
            self._doubts.append(Doubt(key="impossible", names={"text": words}))
        else:
            self._values["resource_block_group_size"] = float(size)
            self._evidence["resource_block_group_size"] = words

    def _take_share(self) -> None:
        """A share of the power, of the cell's limit: "with half the power"."""
        match = figure_words.SHARE.search(self._plain)
        before = self._plain[: match.start()] if match is not None else ""
        if match is None or figure_words.CHANGE_BEFORE.search(before) or figure_words.MOVE_BEFORE.search(before):
            return
        if any(each.start < match.start() < each.end for each in self._quantities):  # "two and a half watts"
            return
        group = match.lastgroup or ""
        tenths = figure_words.TENTHS.get(match[group]) if group.endswith("tenths") else None
        share = figure_words.SHARES.get(group) or tenths or float(match[group]) / 100
        words = self._text[match.start() : match.end()]
        self._spoken_for.append(match.span())
        self._masked.append(match.span())
        if not 0 < share <= 1:
            self._doubts.append(Doubt(key="impossible", names={"text": words}))
            return
        self._values["max_power_w"] = share * self._max_power_w
        self._evidence["max_power_w"] = words
        self._last_end["max_power_w"] = match.end()

    def _clause_around(self, start: int, end: int) -> tuple[str, str]:
        """What stands before and after a span within its clause, figures being borders too."""
        from_ = max([0, *(figure.phrase_end for figure in self._quantities if figure.phrase_end <= start)])
        to = min(
            [len(self._plain), *(figure.phrase_start for figure in self._quantities if figure.phrase_start >= end)]
        )
        return self._plain[clause_start(self._plain, start, from_) : start], self._plain[
            end : clause_end(self._plain, end, to)
        ]

    def _take_power(self, figure: Quantity, before: str, after: str, role: str, *, certain: bool) -> None:
        circuit = role == "circuit_power_w"
        known = circuit and (certain or figure_words.CIRCUIT.search(before + " " + after) is not None)
        if _is_change(before, after):
            self._steps["power_w"] = figure.value
            self._doubt("change", figure)
        elif (
            figure.comparator == "at_least"
            and (role != "none" or self._ends_a_range(self._figures.index(figure) + 1))
            and not figure_words.NEGATED.search(before + after)
        ):
            self._doubt("power_floor", figure)
        elif not (known or (certain and role == "max_power_w") or is_cells_power(before, after)):
            self._doubt("whose_power", figure)
        elif circuit:
            self._mask_circuit(figure, before, after)
            self._set("circuit_power_w", figure.value, figure)
        elif figure.value > figure_words.HUGE_POWER_W:
            self._doubt("huge", figure)
        elif figure_words.SUBCARRIER.match(after) or figure_words.SUBCARRIER_BEFORE.search(before):
            self._set("subcarrier_max_power_w", figure.value, figure)
        elif figure_words.PER_USER.match(after):
            self._doubt("power_per_user", figure)
        elif role == "none":
            self._counted.append((figure.start, figure.end))
        elif role == "":
            self._doubt("whose_power", figure)
        else:
            setting = figure_words.SET_TO.search(before)
            if setting is not None:
                self._masked.append((figure.start - len(before) + setting.start(), figure.end))
            self._set("max_power_w", figure.value, figure)

    def _mask_circuit(self, figure: Quantity, before: str, after: str) -> None:
        """The words for the circuits are no wish for a "fixed" or a "constant" anything."""
        for words, offset in ((before, figure.start - len(before)), (after, figure.end)):
            circuit = figure_words.CIRCUIT.search(words)
            if circuit is not None:
                self._masked.append((offset + circuit.start(), offset + circuit.end()))

    def _take_rate(self, index: int, before: str, after: str) -> None:
        figure = self._figures[index]
        lead = before[: max(0, len(before) - (figure.start - figure.phrase_start))]
        setting = figure_words.RATE_SET_TO.search(before)
        if setting is not None:
            self._masked.append((figure.start - len(before) + setting.start(), figure.end))
        if not self._ends_a_range(index):
            self._target = self._allotments.target_of(figure.start)
            if index and self._is_replaced(index - 1) and self._target.mention is None:
                self._target = self._allotments.target_of(self._figures[index - 1].start)
        target, chances = self._target, self._roles_of_rate(index)
        role = max(chances, key=lambda name: chances[name])
        sure = chances[role] / sum(chances.values())
        if (
            not figure_words.PER_USER.match(after)
            and target.role == "everybody"
            and (figure_words.TOTAL_BEFORE.search(lead) or figure_words.TOTAL_AFTER.match(after))
        ):
            self._doubt("total_rate", figure)
        elif _is_change(before, after):
            self._steps["rate_bps"] = figure.value
            self._doubt("change", figure)
        elif role == "none" and sure > _SURE:
            self._counted.append((figure.start, figure.end))
        elif sure < _SURE or chances["none"] > 1 - _SURE_OF_A_LIMIT:
            self._doubt("status", figure)
        elif not target.sure:
            self._doubt("whose_rate", figure)
        else:
            for name in ("min_rate_bps", "max_rate_bps"):
                if role in (name, "both"):
                    self._allot(name, target, figure)

    def _roles_of_rate(self, index: int) -> Mapping[str, float]:
        """How likely a rate is a floor, a cap, both or nothing."""
        figure = self._figures[index]
        if self._ends_a_range(index) or self._ends_a_range(index + 1):
            return {"max_rate_bps" if figure.comparator == "at_most" else "min_rate_bps": 1.0, "none": 0.0}
        chances = self._judged.figure(index)
        if index and self._is_replaced(index - 1):
            first, bound = self._judged.figure(index - 1), figure.comparator or self._figures[index - 1].comparator
            if bound in _BOUNDS:
                return {_BOUNDS[bound]: 1.0, "none": 0.0}
            chances = {role: max(first[role], chances[role]) if role != "none" else 0.0 for role in chances}
        before, after = beside(self._plain, self._figures, index)
        exact = figure_words.EXACT.match(after) or figure_words.EXACT_BEFORE.search(before)
        if figure.comparator == "exactly" or exact:
            return {"both": 1.0 - chances["none"], "none": chances["none"]}
        contrary = _CONTRARY.get(figure.comparator or "")
        return {role: chance * (_CONTRARY_CHANCE if role == contrary else 1) for role, chance in chances.items()}

    def _ends_a_range(self, index: int) -> bool:
        """Whether a figure is the upper end of a range, and so for whomever the lower one is."""
        if not 0 < index < len(self._figures):
            return False
        lower, figure = self._figures[index - 1], self._figures[index]
        near = figure.start - lower.end <= _RANGE_GAP and lower.kind == figure.kind
        parted = any(lower.end <= mention.start < figure.start for mention in self._judged.mentions)
        return near and not parted and (lower.comparator, figure.comparator) == ("at_least", "at_most")

    def _allot(self, name: str, target: Target, figure: Quantity) -> None:
        earlier = self._allotments.give(name, target, figure, corrects=figure_words.CORRECTION)
        if earlier is not None:
            self._doubts.append(Doubt(key="conflict", names={"one": earlier, "other": figure.text}))

    def _take_ratio(self, figure: Quantity, before: str, after: str, chances: Mapping[str, float]) -> None:
        around = before + " " + after
        if figure_words.MISSING.search(around):
            self._missing = figure.value
            self._not_used.append(figure.text)
            return
        if any(figure.start == each.start for each in nines(self._plain)):
            chances = {"reliability": 1.0}
        role = max(chances, key=lambda name: chances[name])
        if role == "none" and chances[role] > _SURE and not _is_change(before, after):
            self._counted.append((figure.start, figure.end))
        elif role == "none" or chances[role] < _SURE or _is_change(before, after):
            self._doubt("share", figure)
        elif not 0 < figure.value < 1:
            self._doubt("impossible", figure)
        else:
            outage = figure.value if role == "outage" else round(1 - figure.value, 15)
            self._set("outage_probability", outage, figure)

    def _set(self, name: str, value: float, figure: Quantity) -> None:
        """Take a value, the later one after words of correction; two values without them are a doubt."""
        if name in self._values and self._values[name] != value:
            between = self._plain[self._last_end[name] : figure.start]
            correction = figure_words.CORRECTION.search(between)
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


def _is_change(before: str, after: str) -> bool:
    """Whether the figure is an amount to save or to add, not a limit."""
    return figure_words.CHANGE_BEFORE.search(before) is not None or figure_words.CHANGE_AFTER.match(after) is not None
