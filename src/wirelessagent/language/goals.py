"""Which objective a sentence means: directions paired with what they apply to, negations, and the wish for a balance.

"Higher" beside "speed" is a signal for max_rate, "save" beside "power" for min_power; a term may also be a signal by
itself. A wish for rate that is said of the slowest user is one for the largest smallest rate. A negation turns off the
first thing named after it in its clause. One objective with enough weight and no rival is clear; anything else is not,
and says why.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

from wirelessagent.language.vocabulary import Found

Verdict: TypeAlias = Literal["clear", "none", "weak", "contradiction", "negated", "opposite"]

ENOUGH = 0.7
_WHOLE_PREDICATE = 3  # "不在乎", "dont care about": words enough to stand behind what they refer to
_REACH_BEFORE, _REACH_AFTER, _REACH_OF_NOT, _REACH_TO_TURN = 4, 3, 6, 2

_DIRECTIONS = ("up", "down", "want", "keep", "waste", "bad")
_OBJECTS = ("rate", "stream", "power", "battery", "efficiency", "worst")
_OPPOSITES = {
    "max_rate": "less_rate", "min_power": "more_power", "max_energy_efficiency": "less_efficiency",
    "proportional_fairness": "less_fairness", "max_min_rate": "less_fairness",
}  # fmt: skip
_UNSERVED = (*dict.fromkeys(_OPPOSITES.values()), "waste_power")
_TURNED_FROM_BEHIND = ("max_energy_efficiency", "proportional_fairness", "max_min_rate")
_DENYING = ("not", "isnt", "undo")
_SPOILERS = (*_DENYING, "not_after", "bad", "down", "waste", "over", "join")

# What a direction and its object mean together, and how much that weighs.
_PAIRS: dict[tuple[str, str], tuple[str, float]] = {
    ("up", "rate"): ("max_rate", 1.0),
    ("want", "rate"): ("max_rate", 0.8),
    ("keep", "rate"): ("max_rate", 0.8),
    ("down", "rate"): ("less_rate", 1.0),
    ("up", "stream"): ("max_rate", 0.7),
    ("down", "power"): ("min_power", 1.0),
    ("keep", "power"): ("min_power", 0.8),
    ("waste", "power"): ("waste_power", 1.0),
    ("up", "power"): ("more_power", 1.0),
    ("up", "battery"): ("min_power", 0.8),
    ("down", "battery"): ("min_power", 1.0),
    ("want", "battery"): ("min_power", 0.8),
    ("keep", "battery"): ("min_power", 0.8),
    ("waste", "battery"): ("waste_power", 1.0),
    ("up", "efficiency"): ("max_energy_efficiency", 0.7),
    ("want", "efficiency"): ("max_energy_efficiency", 0.7),
    ("down", "efficiency"): ("less_efficiency", 1.0),
    ("up", "worst"): ("max_min_rate", 1.0),
    ("want", "worst"): ("max_min_rate", 0.8),
    ("down", "worst"): ("less_rate", 1.0),
    ("bad", "worst"): ("less_rate", 1.0),
    # Below what is enough: said of a fault as often as of a wish, so that it is asked about.
    ("bad", "rate"): ("less_rate", 0.5),
    ("bad", "power"): ("more_power", 0.5),
    ("bad", "battery"): ("more_power", 0.5),
    ("bad", "efficiency"): ("less_efficiency", 1.0),
}
_CONTRASTED = 0.8
# Readings that yield to a nearer or plainer one: "save as much power as you can" asks for less of it.
_VAGUE = {("want", "rate"): 1.5, ("want", "battery"): 1.5, ("want", "efficiency"): 1.5, ("up", "power"): 3.0}
_ALONE: dict[str, tuple[str, float]] = {
    "rate": ("max_rate", 0.4),
    "battery": ("min_power", 0.4),
    "efficiency": ("max_energy_efficiency", 0.4),
    "worst": ("max_min_rate", 0.4),
}


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
    signals = _balanced(_negate(_for_the_worst(_signals(found), found), found), found)
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
    if _joined_with_another(wished, own, found):
        return Goal(verdict="contradiction", options=tuple(positive), spans=spans)
    slips, best = any(s.corrected for s in own), max(s.weight for s in own)
    others = sum(weight for name, weight in positive.items() if name != strong[0])
    confidence = 0.8 + 0.075 * min(best, 2.0) - 0.1 * slips - 0.1 * min(others, 1.0)
    return Goal(verdict="clear", objective=strong[0], options=tuple(strong), spans=spans, confidence=confidence)


def _joined_with_another(wished: Sequence[Signal], own: Sequence[Signal], found: Sequence[Found]) -> bool:
    """Whether an "and" ties the clear wish to a bare word for another one: "battery saving and speed"."""
    joins = {item.first for item in found if item.term.concept == "join"}
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
    served = [name for name in positive if name not in _UNSERVED]
    if negated:
        return Goal(verdict="negated", options=tuple(sorted(negated)))
    if served:
        best = max(served, key=lambda name: positive[name])
        return Goal(verdict="weak", objective=best, options=(best,))
    opposed = [name for name in positive if name in _UNSERVED]
    return Goal(verdict="opposite" if opposed else "none", options=tuple(opposed))


def _signals(found: Sequence[Found]) -> list[Signal]:
    pairs = _pair(found)
    signals: list[Signal] = []
    for item in found:
        if item.term.concept == "direct":
            turned = _turned_round(item, found, pairs)
            meant = item.term.objective if turned is None else _OPPOSITES[item.term.objective]
            signals.append(_signal(turned or item, item, meant, item.term.weight))
        elif item.term.concept in _OBJECTS:
            direction = pairs.get(item.first)
            meaning = None if direction is None else _PAIRS.get((direction.term.concept, item.term.concept))
            if meaning is not None and meaning[0] == "waste_power" and _beside(item, found, "down") is not None:
                meaning = _PAIRS["down", "power"]  # "reduce the wasted power"
            if direction is not None and meaning is not None:
                signals.append(_signal(direction, item, *meaning))
            elif item.term.concept in _ALONE:
                signals.append(_signal(item, item, *_ALONE[item.term.concept]))
        elif item.term.concept == "fairly" and _of_sharing(item, found):
            signals.append(_signal(item, item, "proportional_fairness", 1.0))
        elif item.term.concept == "same":
            everyone = _beside(item, found, "everyone")
            signals += [_signal(item, everyone, "max_min_rate", 1.0)] if everyone is not None else []
    return signals


def _of_sharing(item: Found, found: Sequence[Found]) -> bool:
    """Whether "fairly" says how to share rates: "share it fairly", not "fairly fast" nor "share the power fairly"."""
    share = _beside(item, found, "share")
    if share is None:
        return False
    degree = any(other.first == item.last and other.term.concept in ("up", "down", "bad", "direct") for other in found)
    power = any(
        other.term.concept in ("power", "battery") and 0 <= other.first - share.last <= _REACH_TO_TURN
        for other in found
    )
    return not degree and not power


def _beside(item: Found | Signal, found: Sequence[Found], concept: str) -> Found | None:
    """The first term of a concept in the clause of ``item``."""
    return next((other for other in found if other.term.concept == concept and other.clause == item.clause), None)


def _for_the_worst(signals: list[Signal], found: Sequence[Found]) -> list[Signal]:
    """Wishes for rate that stand beside the slowest user, and nothing that may turn them round, are for that user."""
    result: list[Signal] = []
    for signal in signals:
        user = _beside(signal, found, "worst")
        if signal.objective == "max_rate" and user is not None:
            gap = max(user.first - signal.last, signal.first - user.last, 0)
            spoilt = any(other.term.concept in _SPOILERS and other.clause == signal.clause for other in found)
            signal = replace(signal, objective="max_min_rate") if gap <= _REACH_AFTER and not spoilt else signal
        result.append(signal)
    return result


def _turned_round(item: Found, found: Sequence[Found], pairs: Mapping[int, Found]) -> Found | None:
    """The word that makes a term the opposite of its wish: "lowest energy efficiency", "more buffering"."""
    if item.term.objective not in _OPPOSITES:
        return None
    turning = ("up", "want") if item.term.complaint else ("down", "bad")
    spoken_for = {direction.first for direction in pairs.values()}
    for word in found:
        free = word.term.concept in turning and word.clause == item.clause and word.first not in spoken_for
        before = word.last <= item.first
        gap = item.first - word.last if before else word.first - item.last
        sided = before or (not item.term.complaint and item.term.objective in _TURNED_FROM_BEHIND)
        if free and sided and gap <= _REACH_TO_TURN:
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
        if item.term.concept not in _OBJECTS:
            continue
        for direction in found[max(0, place - _REACH_BEFORE - 1) : place + _REACH_AFTER + 2]:
            if direction.term.concept not in _DIRECTIONS or direction.clause != item.clause:
                continue
            before = direction.last <= item.first
            gap = item.first - direction.last if before else direction.first - item.last
            reach = 1 if item.term.concept == "stream" else _REACH_BEFORE if before else _REACH_AFTER
            means = (direction.term.concept, item.term.concept) in _PAIRS
            if means and gap <= reach and not _blocked(found, direction, item):
                cost = gap + (0.0 if before else 0.5) + _VAGUE.get((direction.term.concept, item.term.concept), 0.0)
                candidates.append((cost, item, direction))
    chosen: dict[int, Found] = {}
    taken: set[int] = set()
    for _, item, direction in sorted(candidates, key=lambda entry: entry[0]):
        after = direction.first >= item.last
        if item.first not in chosen and not (after and direction.first in taken):
            chosen[item.first] = direction
            taken.add(direction.first)
    return chosen


def _blocked(found: Sequence[Found], direction: Found, item: Found) -> bool:
    """Whether another object stands between the two, unless "and" or "or" joins it to this one."""
    low, high = min(direction.last, item.last), max(direction.first, item.first)
    between = [other for other in found if low <= other.first < high and other is not item and other is not direction]
    stated = direction.term.concept == "up" and direction.first >= item.last
    if stated and any(other.term.concept == "question" for other in between):
        return True  # "the speed is good" says how it is
    objects = [other for other in between if other.term.concept in _OBJECTS or other.term.concept == "direct"]
    joined = any(other.term.concept == "join" for other in between)
    return bool(objects) and not joined


def _negate(signals: list[Signal], found: Sequence[Found]) -> list[Signal]:
    """Signals with those turned off that a negation refers to; a negated wish for less rate is one for rate."""
    turned_off: set[int] = set()
    first = min((item.start for item in found if item.term.concept in _DENYING), default=0)
    named = [item for item in found if item.term.concept in (*_OBJECTS, "direct", "same", "fairly")]
    joins = [item.first for item in found if item.term.concept == "join"]
    for item in found:
        same = [other for other in named if other.clause == item.clause]
        behind = [other for other in same if item.first - _REACH_OF_NOT <= other.first < item.first]
        if item.term.concept in _DENYING or (item.term.concept == "over" and _prefers(found, item)):
            ahead = [other for other in same if item.last <= other.first < item.last + _REACH_OF_NOT]
            turned_off.update(other.first for other in _with_joined(ahead, joins))
            if not ahead and _is_predicate(item, found):
                turned_off.update(other.first for other in behind[-1:])
        elif item.term.concept == "not_after":
            turned_off.update(other.first for other in behind[-1:])
    result: list[Signal] = []
    for signal in signals:
        hit = any(signal.first <= place < signal.last for place in turned_off)
        if hit and signal.objective in _UNSERVED:
            if signal.objective in ("less_rate", "waste_power"):
                wish = "max_rate" if signal.objective == "less_rate" else "min_power"
                start = min(first, signal.start)  # "don't waste power": the negation is a part of the wish
                result.append(replace(signal, objective=wish, weight=0.8, start=start))
            continue
        result.append(replace(signal, negated=hit))
    return result


def _is_predicate(negation: Found, found: Sequence[Found]) -> bool:
    """Whether a negation says something of what stands before it: "power saving is not the goal", "公平我不在乎"."""
    is_not = any(item.term.concept == "question" and item.last == negation.first for item in found)
    directed = any(
        item.term.concept in _DIRECTIONS and item.clause == negation.clause and 0 <= item.first - negation.last <= 1
        for item in found
    )
    whole = negation.term.concept == "not" and negation.last - negation.first >= _WHOLE_PREDICATE
    return negation.term.concept == "isnt" or whole or (negation.term.concept == "not" and (is_not or directed))


def _prefers(found: Sequence[Found], over: Found) -> bool:
    """Whether "over" ranks wishes, as in "prefer speed over battery life"."""
    return any(item.term.concept == "want" and item.clause == over.clause and item.first < over.first for item in found)


def _with_joined(ahead: Sequence[Found], joins: Sequence[int]) -> list[Found]:
    """The first of the things named, and those that stand right beside it after an "and" or an "or"."""
    reached = list(ahead[:1])
    for other in ahead[1:]:
        if other.first - reached[-1].last == 1 and reached[-1].last in joins:
            reached.append(other)
        else:
            break
    return reached


def _balanced(signals: list[Signal], found: Sequence[Found]) -> list[Signal]:
    """With a word of balance between rate and power, both wishes become one for energy efficiency."""
    words = [item for item in found if item.term.concept == "balance"]
    both = [item for item in found if item.term.concept == "both"]
    paired = [item for item in found if item.term.concept == "paired"]
    wishes = {signal.objective for signal in signals if not signal.negated}
    if not words and wishes >= {"max_rate", "min_power"}:
        words = both or (paired if len(paired) > 1 else [])
    concepts = {item.term.concept for item in found}
    for_rate = concepts & {"rate", "stream", "performance"} or "max_rate" in wishes
    for_power = concepts & {"power", "battery"} or "min_power" in wishes
    if any(signal.negated for signal in signals):
        return signals
    if words and for_rate and not for_power and "proportional_fairness" in wishes:  # "a balance of speed and fairness"
        kept = [s for s in signals if s.objective not in ("max_rate", *_UNSERVED)]
        return [*kept, _signal(words[0], words[-1], "proportional_fairness", 1.5)]
    if not words or not for_rate or not for_power:
        return signals
    kept = [s for s in signals if s.objective not in ("max_rate", "min_power", *_UNSERVED)]
    return [*kept, _signal(words[0], words[-1], "max_energy_efficiency", 1.5)]
