"""What each rate of a sentence is, a floor, a cap, both or nothing, and for whom."""

from __future__ import annotations

from collections.abc import Mapping

from wirelessagent.language.allotments import Allotments, Target
from wirelessagent.language.deferred import deferred
from wirelessagent.language.judged import Judged
from wirelessagent.language.moods import is_taken_up
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.stated import Notes
from wirelessagent.language.surroundings import CORRECTION, PER_USER, TOTAL_AFTER, Neighbours, is_change

_EXACT = deferred(
    r"(?i)(?:\s+(?:each|apiece|per user|por usuario|par personne|chacun|cada uno|pro nutzer))?\s*,?\s*(?:exactly|exact|"
    r"precisely|no more,? no less|exact[oa]s?|clavad[oa]s?|ni más ni menos|exactement|pile|tout rond|"
    r"ni plus ni moins|genau|exakt)\b"
)
_EXACT_BEFORE = deferred(
    r"(?i)\b(?:exactly|precisely|exactamente|exactement|précisément|genau|exakt)\s+$|(?:锁定?在?|锁死在|恰好|正好|刚好)\s*$"
)
_TOTAL_BEFORE = deferred(r"(?:总速率|总吞吐量?|和速率|总共|合计|一共)[\w\s:=]{0,8}$")
_RATE_SET_TO = deferred(
    r"(?i)\b(?:raise|increase|bring|set|lift|boost|push|lower|reduce)\s+(?:the\s+|each\s+|every\s+|their\s+)*"
    r"(?:min\w*\s+|user\w*\s+|data\s+|bit\s+)*(?:rates?|speeds?|throughput)\s+(?:up\s+|down\s+)?to\s+$"
)
_EITHER = deferred(  # between two figures
    r"(?i)\s*,?\s*(?:or|o|ou|oder|或者?|还是|(?:or\s+)?(?:if\s+possible|ideally|preferably),?\s+(?:else|otherwise|or)|else|otherwise)\s*"
)

_SURE = 0.6
_SURE_OF_A_LIMIT = 0.75  # most figures are limits, so that the model takes a strange one for one too easily
_BOUNDS = {"at_least": "min_rate_bps", "at_most": "max_rate_bps"}
_CONTRARY = {"at_least": "max_rate_bps", "at_most": "min_rate_bps"}
_CONTRARY_CHANCE = 0.1  # "at least" seldom caps
_TURNED = deferred(rf"(?i)\s*[,;.\uff0c；。]?\s*(?:oh\s+)?(?:{CORRECTION.pattern.removeprefix('(?ia)')})[\s,\uff0c]*")


class Rates:
    """The rates of a sentence, from left to right: the end of a range is for whomever its beginning is for."""

    def __init__(self, notes: Notes, judged: Judged, neighbours: Neighbours, allotments: Allotments) -> None:
        self._notes, self._plain, self._allotments = notes, notes.plain, allotments
        self._judged, self._neighbours, self._figures = judged, neighbours, neighbours.figures
        self._target = Target(role="everybody")

    def take(self, index: int) -> None:
        """Take the rate at a place for whomever it is for, or raise what is in doubt about it."""
        figure, (before, after) = self._figures[index], self._neighbours.beside(index)
        lead = before[: max(0, len(before) - (figure.start - figure.phrase_start))]
        setting = _RATE_SET_TO.search(before)
        if setting is not None:
            self._notes.masked.append((figure.start - len(before) + setting.start(), figure.end))
        if not self._neighbours.ends_a_range(index):
            self._target = self._allotments.target_of(figure.start)
            if index and self._neighbours.is_replaced(index - 1) and self._target.mention is None:
                self._target = self._allotments.target_of(self._figures[index - 1].start)
        target, chances = self._target, self._roles_of_rate(index)
        role = max(chances, key=lambda name: chances[name])
        sure = chances[role] / sum(chances.values())
        if (
            not PER_USER.match(after)
            and target.role == "everybody"
            and (_TOTAL_BEFORE.search(lead) or TOTAL_AFTER.match(after))
        ):
            self._notes.doubt("total_rate", text=figure.text)
        elif is_change(before, after):
            self._notes.steps["rate_bps"] = figure.value
            self._notes.doubt("change", text=figure.text)
        elif role == "none" and sure > _SURE:
            self._notes.counted.append((figure.start, figure.end))
        elif (sure < _SURE or chances["none"] > 1 - _SURE_OF_A_LIMIT) and not self._is_taken_up(index):
            self._notes.doubt("status", text=figure.text)
        elif not target.sure:
            self._notes.doubt("whose_rate", text=figure.text)
        else:
            role = "min_rate_bps" if role == "none" else role  # "she pays for 2 Mbit/s, give her that"
            for name in ("min_rate_bps", "max_rate_bps"):
                if role in (name, "both"):
                    self._allot(name, target, figure)

    def _is_taken_up(self, index: int) -> bool:
        """Whether an order that has no rate of its own carries out what was told: "she pays for 2 Mbit/s, give it"."""
        last = all(figure.kind != "rate" for figure in self._figures[index + 1 :])
        return last and is_taken_up(self._plain, self._figures[index].end)

    def _roles_of_rate(self, index: int) -> Mapping[str, float]:
        """How likely a rate is a floor, a cap, both or nothing."""
        figure = self._figures[index]
        if self._neighbours.ends_a_range(index) or self._neighbours.ends_a_range(index + 1):
            return {"max_rate_bps" if figure.comparator == "at_most" else "min_rate_bps": 1.0, "none": 0.0}
        chances = self._judged.figure(index)
        if index and self._neighbours.is_replaced(index - 1):
            first, bound = self._judged.figure(index - 1), figure.comparator or self._figures[index - 1].comparator
            if bound in _BOUNDS:
                return {_BOUNDS[bound]: 1.0, "none": 0.0}
            chances = {role: max(first[role], chances[role]) if role != "none" else 0.0 for role in chances}
        before, after = self._neighbours.beside(index)
        exact = _EXACT.match(after) or _EXACT_BEFORE.search(before)
        if figure.comparator == "exactly" or exact:
            return {"both": 1.0 - chances["none"], "none": chances["none"]}
        contrary = _CONTRARY.get(figure.comparator or "")
        return {role: chance * (_CONTRARY_CHANCE if role == contrary else 1) for role, chance in chances.items()}

    def _allot(self, name: str, target: Target, figure: Quantity) -> None:
        earlier = self._allotments.give(name, target, figure, corrects=CORRECTION)
        if earlier is not None:
            self._notes.doubt("conflict", one=earlier, other=figure.text)

    def doubt_a_choice(self, one: Quantity, other: Quantity) -> None:
        """Two figures of which one has to be chosen: "10 W or 12 W", "1号至少1兆，不，2号至少1兆"."""
        if one.kind != other.kind or one.kind not in ("power", "rate"):
            return
        gap = self._plain[one.end : other.start]
        between = [m for m in self._judged.mentions if m.role == "named" and one.end <= m.start < other.start]
        target = self._allotments.target_of(one.start) if between and one.kind == "rate" else None
        others = target is not None and target.role == "named" and set(target.users).isdisjoint(between[0].users)
        corrected = others and _TURNED.fullmatch(self._plain, one.end, between[0].start) is not None
        if (_EITHER.fullmatch(gap) and one.value != other.value) or corrected:
            start = between[0].start if corrected else other.start
            owner = target.mention if corrected and target is not None else None
            first = one.start if owner is None else min(owner.start, one.start)
            self._notes.doubt(
                "conflict", one=self._notes.text[first : one.end], other=self._notes.text[start : other.end]
            )
