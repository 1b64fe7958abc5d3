"""Which objective a sentence means: directions paired with what they apply to, negations, and the wish for a balance.

"Higher" beside "speed" is a signal for max_rate, "save" beside "power" for min_power; a term may also be a signal by
itself. A wish for rate that is said of the slowest user is one for the largest smallest rate. A negation turns off the
first thing named after it in its clause. One objective with enough weight and no rival is clear; anything else is not,
and says why.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

from wirelessagent.language.vocabulary import Found

Verdict: TypeAlias = Literal["clear", "none", "weak", "contradiction", "negated", "opposite"]

ENOUGH = 0.7
_WHOLE_PREDICATE = 3  # "不在乎", "dont care about": words enough to stand behind what they refer to
_REACH_BEFORE, _REACH_AFTER, _REACH_OF_NOT, _REACH_TO_TURN = 4, 3, 6, 2

_DIRECTIONS = ("up", "down", "want", "keep", "waste", "bad")
_OPPOSITES = {
    "max_rate": "less_rate", "min_power": "more_power", "max_energy_efficiency": "less_efficiency",
    "proportional_fairness": "less_fairness", "max_min_rate": "less_fairness",
}  # fmt: skip
_UNSERVED = (*dict.fromkeys(_OPPOSITES.values()), "waste_power")
_TURNED_FROM_BEHIND = ("max_energy_efficiency", "proportional_fairness", "max_min_rate")
_DENYING = ("not", "isnt", "undo")
_SPOILERS = (*_DENYING, "not_after", "bad", "down", "waste", "over", "join")

# What an object means by itself ("") and with each direction, and how much that weighs. What weighs 0.5 is below what
# is enough: said of a fault as often as of a wish, so that it is asked about.
_MEANT: Mapping[str, Mapping[str, tuple[str, float]]] = {
    "rate": {
        "": ("max_rate", 0.4), "up": ("max_rate", 1.0), "want": ("max_rate", 0.8), "keep": ("max_rate", 0.8),
        "down": ("less_rate", 1.0), "bad": ("less_rate", 0.5),
    },
    "stream": {"up": ("max_rate", 0.7)},
    "power": {
        "down": ("min_power", 1.0), "keep": ("min_power", 0.8), "up": ("more_power", 1.0), "bad": ("more_power", 0.5),
        "waste": ("waste_power", 1.0),
    },
    "battery": {
        "": ("min_power", 0.4), "up": ("min_power", 0.8), "down": ("min_power", 1.0), "want": ("min_power", 0.8),
        "keep": ("min_power", 0.8), "bad": ("more_power", 0.5), "waste": ("waste_power", 1.0),
    },
    "efficiency": {
        "": ("max_energy_efficiency", 0.4), "up": ("max_energy_efficiency", 0.7),
        "want": ("max_energy_efficiency", 0.7), "down": ("less_efficiency", 1.0), "bad": ("less_efficiency", 1.0),
    },
    "worst": {
        "": ("max_min_rate", 0.4), "up": ("max_min_rate", 1.0), "want": ("max_min_rate", 0.8),
        "down": ("less_rate", 1.0), "bad": ("less_rate", 1.0),
    },
}  # fmt: skip
_CONTRASTED = 0.8
# Readings that yield to a nearer or plainer one: "save as much power as you can" asks for less of it.
_VAGUE = {("want", "rate"): 1.5, ("want", "battery"): 1.5, ("want", "efficiency"): 1.5, ("up", "power"): 3.0}


@dataclass(frozen=True, kw_only=True)
class Signal:
    """A hint at an objective: where it stands, how much it weighs, whether it was negated."""

    objective: str
    weight: float
    start: int
    end: int
    first: int
    last: int
    clause: int
    corrected: bool
    negated: bool = False


@dataclass(frozen=True, kw_only=True)
class Goal:
    """The objective that a sentence means, or why none is clear.

    Attributes:
        objective: its name where the verdict is clear; the best guess where it is weak; else empty.
        options: the objectives that are in play, best first.
        spans: the characters [start, end) that say so, from left to right.
        confidence: 0 to 1.
    """

    verdict: Verdict
    objective: str = ""
    options: tuple[str, ...] = ()
    spans: tuple[tuple[int, int], ...] = ()
    confidence: float = 0.0


def goal_of(found: Sequence[Found]) -> Goal:
    """The goal that the terms of a sentence make together."""
    signals = _balanced(_negate([_for_the_worst(signal, found) for signal in _signals(found)], found), found)
    wished, negated = [s for s in signals if not s.negated], {s.objective for s in signals if s.negated}
    positive: dict[str, float] = {}
    for signal in wished:
        positive[signal.objective] = positive.get(signal.objective, 0.0) + signal.weight
    strong = [name for name in sorted(positive, key=lambda name: -positive[name]) if positive[name] >= ENOUGH]
    own = [s for s in wished if s.objective in strong[:1]]
    spans = tuple((s.start, s.end) for s in own)
    if any(name in _UNSERVED for name in strong):
        return Goal(verdict="opposite", options=tuple(strong), spans=spans)
    if len(strong) > 1 or (strong and strong[0] in negated):
        return Goal(verdict="contradiction", options=tuple(strong), spans=spans)
    if not strong:
        return _contrasted(signals) or _unclear(positive, negated)
    if strong[0] != "max_min_rate" and "max_min_rate" in positive:
        return Goal(verdict="contradiction", options=(strong[0], "max_min_rate"), spans=spans)
    if _is_joined(wished, own, found):
        return Goal(verdict="contradiction", options=tuple(positive), spans=spans)
    slips, best = any(s.corrected for s in own), max(s.weight for s in own)
    others = sum(weight for name, weight in positive.items() if name != strong[0])
    confidence = 0.8 + 0.075 * min(best, 2.0) - 0.1 * slips - 0.1 * min(others, 1.0)
    return Goal(verdict="clear", objective=strong[0], options=tuple(strong), spans=spans, confidence=confidence)


def _of(found: Sequence[Found], *concepts: str) -> list[Found]:
    return [item for item in found if item.concept in concepts]


def _beside(item: Found | Signal, found: Sequence[Found], *concepts: str) -> Found | None:
    """The first term of some concepts in the clause of ``item``."""
    return next((other for other in _of(found, *concepts) if other.clause == item.clause), None)


def _is_joined(wished: Sequence[Signal], own: Sequence[Signal], found: Sequence[Found]) -> bool:
    """Whether an "and" ties the clear wish to a bare word for another one: "battery saving and speed"."""
    joins = {item.first for item in _of(found, "join")}
    return any(
        (a.last in joins and b.first == a.last + 1) or (b.last in joins and a.first == b.last + 1)
        for a in own
        for b in wished
        if a.objective != b.objective
    )


def _contrasted(signals: Sequence[Signal]) -> Goal | None:
    """The one aim that is named where another is denied in a clause of its own: "speed, not power saving"."""
    wished, denied = [s for s in signals if not s.negated], [s for s in signals if s.negated]
    named, clauses = {signal.objective for signal in wished}, {signal.clause for signal in denied}
    apart = all(signal.clause not in clauses for signal in wished)
    if len(named) != 1 or not denied or named & {*(signal.objective for signal in denied), *_UNSERVED} or not apart:
        return None
    spans = tuple((signal.start, signal.end) for signal in wished)
    return Goal(verdict="clear", objective=(one := named.pop()), options=(one,), spans=spans, confidence=_CONTRASTED)


def _unclear(positive: dict[str, float], negated: set[str]) -> Goal:
    if negated:
        return Goal(verdict="negated", options=tuple(sorted(negated)))
    served = [name for name in positive if name not in _UNSERVED]
    if served:
        best = max(served, key=lambda name: positive[name])
        return Goal(verdict="weak", objective=best, options=(best,))
    return Goal(verdict="opposite" if positive else "none", options=tuple(positive))


def _signals(found: Sequence[Found]) -> Iterator[Signal]:
    pairs = _pair(found)
    for item in found:
        if item.concept == "direct":
            turned = _turned_round(item, found, pairs)
            meant = item.term.objective if turned is None else _OPPOSITES[item.term.objective]
            yield _signal(turned or item, item, meant, item.term.weight)
        elif item.concept in _MEANT:
            direction = pairs.get(item.first)
            meaning = _MEANT[item.concept].get("" if direction is None else direction.concept)
            if meaning is not None and meaning[0] == "waste_power" and _beside(item, found, "down") is not None:
                meaning = _MEANT["power"]["down"]  # "reduce the wasted power"
            if meaning is not None:
                yield _signal(direction or item, item, *meaning)
        elif item.concept == "fairly" and _is_of_sharing(item, found):
            yield _signal(item, item, "proportional_fairness", 1.0)
        elif item.concept == "same":
            everyone = _beside(item, found, "everyone")
            if everyone is not None:
                yield _signal(item, everyone, "max_min_rate", 1.0)


def _is_of_sharing(item: Found, found: Sequence[Found]) -> bool:
    """Whether "fairly" says how to share rates: "share it fairly", not "fairly fast" nor "share the power fairly"."""
    share = _beside(item, found, "share")
    if share is None or any(other.first == item.last for other in _of(found, "up", "down", "bad", "direct")):
        return False
    return not any(0 <= other.first - share.last <= _REACH_TO_TURN for other in _of(found, "power", "battery"))


def _for_the_worst(signal: Signal, found: Sequence[Found]) -> Signal:
    """A wish for rate that stands beside the slowest user, and nothing that may turn it round, is for that user."""
    user = _beside(signal, found, "worst")
    if signal.objective != "max_rate" or user is None or _beside(signal, found, *_SPOILERS) is not None:
        return signal
    gap = max(user.first - signal.last, signal.first - user.last)
    return replace(signal, objective="max_min_rate") if gap <= _REACH_AFTER else signal


def _turned_round(item: Found, found: Sequence[Found], pairs: Mapping[int, Found]) -> Found | None:
    """The word that makes a term the opposite of its wish: "lowest energy efficiency", "more buffering"."""
    if item.term.objective not in _OPPOSITES:
        return None
    spoken_for = {direction.first for direction in pairs.values()}
    for word in _of(found, *(("up", "want") if item.term.complaint else ("down", "bad"))):
        before = word.last <= item.first
        gap = item.first - word.last if before else word.first - item.last
        sided = before or (not item.term.complaint and item.term.objective in _TURNED_FROM_BEHIND)
        if word.clause == item.clause and word.first not in spoken_for and sided and gap <= _REACH_TO_TURN:
            return word
    return None


def _signal(one: Found, other: Found, objective: str, weight: float) -> Signal:
    a, b = (one, other) if one.first <= other.first else (other, one)
    return Signal(
        objective=objective, weight=weight, start=a.start, end=b.end, first=a.first, last=b.last, clause=a.clause,
        corrected=a.corrected or b.corrected,
    )  # fmt: skip


def _pair(found: Sequence[Found]) -> dict[int, Found]:
    """The direction of each object, by the object's first unit: the nearest in its clause, before rather than after."""
    candidates: list[tuple[float, Found, Found]] = []
    for place, item in enumerate(found):
        meant = _MEANT.get(item.concept, {})
        for direction in found[max(0, place - _REACH_BEFORE - 1) : place + _REACH_AFTER + 2]:
            before = direction.last <= item.first
            gap = item.first - direction.last if before else direction.first - item.last
            reach = 1 if item.concept == "stream" else _REACH_BEFORE if before else _REACH_AFTER
            able = direction.concept in meant and direction.clause == item.clause and gap <= reach
            if able and not _is_blocked(found, direction, item):
                cost = gap + (0.0 if before else 0.5) + _VAGUE.get((direction.concept, item.concept), 0.0)
                candidates.append((cost, item, direction))
    chosen: dict[int, Found] = {}
    taken: set[int] = set()
    for _, item, direction in sorted(candidates, key=lambda entry: entry[0]):
        after = direction.first >= item.last
        if item.first not in chosen and not (after and direction.first in taken):
            chosen[item.first] = direction
            taken.add(direction.first)
    return chosen


def _is_blocked(found: Sequence[Found], direction: Found, item: Found) -> bool:
    """Whether another object stands between the two, unless "and" or "or" joins it to this one."""
    low, high = min(direction.last, item.last), max(direction.first, item.first)
    between = [other for other in found if low <= other.first < high]
    if direction.concept == "up" and direction.first >= item.last and _of(between, "question"):
        return True  # "the speed is good" says how it is
    return bool(_of(between, *_MEANT, "direct")) and not _of(between, "join")


def _negate(signals: Sequence[Signal], found: Sequence[Found]) -> list[Signal]:
    """Signals with those turned off that a negation refers to; a negated wish for less rate is one for rate."""
    turned_off: set[int] = set()
    joins = [item.first for item in _of(found, "join")]
    for item in _of(found, *_DENYING, "over", "not_after"):
        same = [other for other in _of(found, *_MEANT, "direct", "same", "fairly") if other.clause == item.clause]
        behind = [other for other in same if item.first - _REACH_OF_NOT <= other.first < item.first]
        if item.concept in _DENYING or (item.concept == "over" and _prefers(found, item)):
            ahead = [other for other in same if item.last <= other.first < item.last + _REACH_OF_NOT]
            turned_off.update(other.first for other in _with_joined(ahead, joins))
            if not ahead and _is_predicate(item, found):
                turned_off.update(other.first for other in behind[-1:])
        elif item.concept == "not_after":
            turned_off.update(other.first for other in behind[-1:])
    result: list[Signal] = []
    denied = min((item.start for item in _of(found, *_DENYING)), default=0)
    for signal in signals:
        hit = any(signal.first <= place < signal.last for place in turned_off)
        wish = {"less_rate": "max_rate", "waste_power": "min_power"}.get(signal.objective)
        if not hit or signal.objective not in _UNSERVED:
            result.append(replace(signal, negated=hit))
        elif wish is not None:  # "don't waste power": the negation is a part of the wish
            result.append(replace(signal, objective=wish, weight=0.8, start=min(denied, signal.start)))
    return result


def _is_predicate(negation: Found, found: Sequence[Found]) -> bool:
    """Whether a negation says something of what stands before it: "power saving is not the goal", "公平我不在乎"."""
    if negation.concept != "not":
        return negation.concept == "isnt"
    directed = any(
        item.clause == negation.clause and 0 <= item.first - negation.last <= 1 for item in _of(found, *_DIRECTIONS)
    )
    whole = negation.last - negation.first >= _WHOLE_PREDICATE
    return whole or directed or any(item.last == negation.first for item in _of(found, "question"))


def _prefers(found: Sequence[Found], over: Found) -> bool:
    """Whether "over" ranks wishes, as in "prefer speed over battery life"."""
    return any(item.clause == over.clause and item.first < over.first for item in _of(found, "want"))


def _with_joined(ahead: Sequence[Found], joins: Sequence[int]) -> list[Found]:
    """The first of the things named, and those that stand right beside it after an "and" or an "or"."""
    reached = list(ahead[:1])
    for other in ahead[1:]:
        if other.first - reached[-1].last != 1 or reached[-1].last not in joins:
            break
        reached.append(other)
    return reached


def _balanced(signals: list[Signal], found: Sequence[Found]) -> list[Signal]:
    """With a word of balance between rate and power, both wishes become one for energy efficiency."""
    words, paired = _of(found, "balance"), _of(found, "paired")
    wishes = {signal.objective for signal in signals if not signal.negated}
    if not words and wishes >= {"max_rate", "min_power"}:
        words = _of(found, "both") or (paired if len(paired) > 1 else [])
    for_rate = _of(found, "rate", "stream", "performance") or "max_rate" in wishes
    for_power = _of(found, "power", "battery") or "min_power" in wishes
    if not words or not for_rate or any(signal.negated for signal in signals):
        return signals
    if for_power:
        gone, goal = ("max_rate", "min_power", *_UNSERVED), "max_energy_efficiency"
    elif "proportional_fairness" in wishes:  # "a balance of speed and fairness"
        gone, goal = ("max_rate", *_UNSERVED), "proportional_fairness"
    else:
        return signals
    return [*(s for s in signals if s.objective not in gone), _signal(words[0], words[-1], goal, 1.5)]
