"""What each power of a sentence is there for: the limit, the circuits, a single subcarrier, or nothing."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping

from wirelessagent.language.deferred import deferred
from wirelessagent.language.judged import Judged
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.stated import Notes
from wirelessagent.language.surroundings import (
    CIRCUIT,
    CORRECTION,
    PER_USER,
    SUBCARRIER,
    TOTAL_AFTER,
    Neighbours,
    is_cells_power,
    is_change,
)

_HUGE_POWER_W = 1e5  # no cell radiates this much: a megawatt is a misspelt milliwatt
_NEGATED = deferred(  # "more than 10 W are not to be had", 超过4瓦不行
    r"(?i)\b(?:not|no|never|nicht|ned|nie|kein\w*|nunca|sin|pas|jamais|garde-toi|évite|vermeide|avoid|gibt's aber)\b|"
    r"[别不勿禁]|报警|跳闸"
)
_SET_TO = deferred(
    r"(?i)(?:\b(?:reduce|lower|cut|drop|bring|decrease|turn|raise|increase|set|limit)\s+(?:down\s+|up\s+)?(?:the\s+)?"
    r"(?:total\s+|max\w*\s+)?(?:transmit\s+|tx\s+|radiated\s+)?(?:power|budget)(?:\s+budget)?\s+(?:down\s+|"
    r"up\s+)?(?:to|at)|"
    r"(?:总?发?射?功率)(?:降低?|减[小少]?|调|提高|升|增加?|设)(?:到|至|为)|(?:降低?|减[小少]?|"
    r"提高)(?:总?发?射?功率)(?:到|至))\s*$"
)

_SURE, _CERTAIN = 0.6, 0.8
_SURE_OF_A_LIMIT = 0.75  # most figures are limits, so that the model takes a strange one for one too easily
_MOST_POWERS = 4
_ONCE = ("max_power_w", "circuit_power_w")
_NOTHING_AHEAD = ("", "with", "at", "use", "using")  # of "10 W in total"
_PUSHED = 0.3  # a power that has no role only because another has it: "10 W or 12 W"


class Powers:
    """The powers of a sentence, whose roles are judged together: there is one limit, not two."""

    def __init__(self, notes: Notes, judged: Judged, neighbours: Neighbours) -> None:
        self._notes, self._plain = notes, notes.plain
        self._judged, self._neighbours, self._figures = judged, neighbours, neighbours.figures
        self._roles = self._likeliest_roles(self._chances())

    def _chances(self) -> dict[int, Mapping[str, float]]:
        """How likely each of the first powers has each role."""
        chances = {
            index: self._judged.figure(index)
            for index, q in enumerate(self._figures)
            if q.kind == "power" and not self._neighbours.is_of_a_subcarrier(index)
        }
        for index in chances:
            before, after = self._neighbours.beside(index)
            if before.strip().lower() in _NOTHING_AHEAD and TOTAL_AFTER.match(after):
                chances[index] = {role: float(role == "max_power_w") for role in chances[index]}
        places = sorted(chances)[:_MOST_POWERS]
        for index in places:
            self._supersede(chances, index)
        return {index: chances[index] for index in places}

    def _likeliest_roles(self, chances: Mapping[int, Mapping[str, float]]) -> dict[int, tuple[str, bool]]:
        """The role of each power and whether it is certain; "" where it is unsure."""
        places = list(chances)
        together: dict[tuple[str, ...], float] = {}
        for roles in itertools.product(*chances.values()):
            held = {(role, self._figures[i].value) for role, i in zip(roles, places, strict=True) if role != "none"}
            twice = len(held) > len({value for _, value in held})  # the same figure is the same thing
            if not twice and all(sum(role == name for role, _ in held) < 2 for name in _ONCE):
                together[roles] = math.prod(chances[index][role] for role, index in zip(roles, places, strict=True))
        likeliest = max(together, key=lambda roles: together[roles])
        total = sum(together.values())
        sure = together[likeliest] / total if total > 0 else 0.0
        fits = sure > (_SURE_OF_A_LIMIT if set(likeliest) == {"max_power_w"} else _SURE)
        found: dict[int, tuple[str, bool]] = {}
        for index, role in zip(places, likeliest, strict=True):
            forced = role == "none" and chances[index]["none"] < _PUSHED
            found[index] = (role if fits and not forced else "", chances[index][role] > _CERTAIN)
        return found

    def _supersede(self, chances: dict[int, Mapping[str, float]], index: int) -> None:
        """A power that the next one corrects says nothing any more, but what that one is."""
        first, second = chances[index], chances.get(index + 1)
        if second is None:
            return
        low, high = self._figures[index], self._figures[index + 1]
        same = max(first, key=lambda role: first[role]) == max(second, key=lambda role: second[role])
        doubtful = max(second.values()) < _CERTAIN
        if (same or doubtful) and CORRECTION.search(self._plain, low.end, high.start):
            chances[index] = {**dict.fromkeys(first, 0.0), "none": 1.0}
            chances[index + 1] = {role: max(first[role], second[role]) if role != "none" else 0.0 for role in second}

    def take(self, index: int) -> None:
        """Take the power at a place, or raise what is in doubt about it."""
        figure, (before, after) = self._figures[index], self._neighbours.beside(index)
        role, certain = self._roles.get(index, ("", False))
        circuit = role == "circuit_power_w"
        known = circuit and (certain or CIRCUIT.search(before + " " + after) is not None)
        if is_change(before, after):
            self._notes.steps["power_w"] = figure.value
            self._notes.doubt("change", text=figure.text)
        elif (
            figure.comparator == "at_least"
            and (role != "none" or self._neighbours.ends_a_range(index + 1))
            and not _NEGATED.search(before + after)
        ):
            self._notes.doubt("power_floor", text=figure.text)
        elif not (known or (certain and role == "max_power_w") or is_cells_power(before, after)):
            self._notes.doubt("whose_power", text=figure.text)
        elif circuit:
            self._mask_circuit(figure, before, after)
            self._notes.take("circuit_power_w", figure.value, figure)
        elif figure.value > _HUGE_POWER_W:
            self._notes.doubt("huge", text=figure.text)
        elif self._neighbours.is_of_a_subcarrier(index):
            of_each = SUBCARRIER.match(after)
            if of_each is not None:  # "on a single subcarrier" counts nothing
                self._notes.masked.append((figure.end, figure.end + of_each.end()))
            self._notes.take("subcarrier_max_power_w", figure.value, figure)
        elif PER_USER.match(after):
            self._notes.doubt("power_per_user", text=figure.text)
        elif role == "none":
            self._notes.counted.append((figure.start, figure.end))
        elif role == "":
            self._notes.doubt("whose_power", text=figure.text)
        else:
            setting = _SET_TO.search(before)
            if setting is not None:
                self._notes.masked.append((figure.start - len(before) + setting.start(), figure.end))
            self._notes.take("max_power_w", figure.value, figure)

    def _mask_circuit(self, figure: Quantity, before: str, after: str) -> None:
        """The words for the circuits are no wish for a "fixed" or a "constant" anything."""
        for words, offset in ((before, figure.start - len(before)), (after, figure.end)):
            circuit = CIRCUIT.search(words)
            if circuit is not None:
                self._notes.masked.append((offset + circuit.start(), offset + circuit.end()))
