"""What a line means part by part: "circuits draw 3.8 W, and no floor for user 3 any more".

A part is weighed as a line of its own, behind what the parts ahead of it come to. The line means all of them where each
surely changes something that it names, and where it is hardly clear as a whole, or less as a whole.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable, Iterator
from typing import TypeAlias

from wirelessagent.language.acts import Act, Aim
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.conversation.possible import Possible, spoken_of
from wirelessagent.language.conversation.weighing import NOTHING, intent_of
from wirelessagent.language.intent import Intent, acts_of
from wirelessagent.language.mentions import JOINT
from wirelessagent.language.moods import named_in
from wirelessagent.language.recogniser import Context
from wirelessagent.language.request import Request, applied
from wirelessagent.language.text import AND, Span, overlaps
from wirelessagent.language.word_tables import deferred

Weigh: TypeAlias = Callable[[Line], tuple[Intent, bool]]
"""What says what a line means, and whether it surely does."""
_CUT = deferred(rf"(?i)\s*[,;\n\uff0c\uff1b。]\s*(?:(?:{AND})\s+)?|[.!](?:\s+(?:{AND})\b)?\s+|\s+(?:{AND})\s+")
_MOST_CUTS = 4
_WHO = ("users", "number")
_AT_ODDS = frozenset({"rates_crossed", "conflict", "one_of", "unit_missing", "impossible", "some_users"})
"""What is asked about a line whose parts can't all hold, or leave open which of two is meant."""


def by_parts(line: Line, whole: Intent, weigh: Weigh) -> Intent | None:
    """What a line means as the sum of its parts; None where that is not sure, or no more than it is as a ``whole``."""
    orders = line.sentence.chances.is_order and not line.is_asked and whole.kind in ("allocate", "clarify")
    if not orders or whole.asks in _AT_ODDS or line.context.awaits == "clarification":
        return None
    acts = _together(line, weigh)
    if not acts:
        return None
    possible = Possible(line.anchored, line.context)
    heard = whole if whole.kind == "allocate" else whole.guess
    said = acts_of(heard) if heard is not None and heard.kind == "allocate" else ()
    before, after = possible.effect(said) if said else NOTHING[1], possible.effect(acts)
    more = before < after or (before == after and whole.kind == "clarify")
    return intent_of(line, possible, acts) if more else None


def _cuts(line: Line) -> Iterator[Span]:
    """Where a line may be cut: within no figure and no list of users."""
    anchors, plain = line.anchored.anchors, line.anchored.plain
    cuts = [match.span() for match in itertools.islice(_CUT.finditer(plain), _MOST_CUTS)]
    pairs = [(one, other) for one, other in itertools.pairwise(anchors) if one.kind in _WHO and other.kind in _WHO]
    whole = [(anchor.start, anchor.end) for anchor in anchors]
    whole += [(one.end, other.start) for one, other in pairs if JOINT.fullmatch(plain, one.end, other.start)]
    yield from (cut for cut in cuts if not overlaps(cut, whole))


def _together(line: Line, weigh: Weigh) -> tuple[Act, ...]:
    """What a line comes to that is cut behind its first part that is sure; nothing where the rest is not."""
    for start, end in _cuts(line):
        first = Line.of(line.text[:start], line.context)
        one = _sure(first, weigh)
        if one:
            rest = Line.of(line.text[end:], _behind(first, one))
            more = _sure(rest, weigh) or _together(rest, weigh)
            return (*one, *more) if more else ()
    return ()


def _sure(line: Line, weigh: Weigh) -> tuple[Act, ...]:
    """What a part surely changes, if it names that."""
    intent, sure = weigh(line)
    found = acts_of(intent) if sure and intent.kind == "allocate" and intent.amends else ()
    acts = tuple(act for act in found if not (isinstance(act, Aim) and act.objective == line.context.objective))
    named = any(anchor.kind != "pronoun" for anchor in line.anchored.anchors) or named_in(line.anchored.plain)
    return acts if named or any(isinstance(act, Aim) for act in acts) else ()


def _behind(line: Line, acts: tuple[Act, ...]) -> Context:
    """The conversation behind a part of a line."""
    context = line.context
    before = Request(objective=str(context.objective), constraints=context.constraints)
    after, _ = applied(before, acts)
    assert after is not None
    return dataclasses.replace(
        context, objective=after.objective, constraints=after.constraints, acts=acts, earlier=(*context.earlier, acts),
        past=(*context.past, before), spoken_of=spoken_of(line.anchored, len(context.user_names), acts),
    )  # fmt: skip
