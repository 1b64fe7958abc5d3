"""A figure in the place of one that was said before: "make it 9", "the others 400k", "and with 8?", "take the 8".

Which limit it is of, for whom and in which unit is as the line says it, else as that was of what was said last.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
import re
from collections.abc import Mapping, Sequence

from wirelessagent.language.acts import Drop, Everybody, Limit, Named, Others, Scale, Suppose, Whom
from wirelessagent.language.conversation.tokens import NOUNS, UNITS, Words
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, Constraint, Intent
from wirelessagent.language.intent_acts import stated
from wirelessagent.language.moods import is_ordered
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.model.units import human

_SAID = (
    "users", "every", "others", "pronoun", "one", "it", "lead", "make", "correct", "suppose", "take", "figure",
    "ratio", "bare", "with", "grant", "too", "by", "to", "revise", "both", "at_most", "up_to", "moves", "except",
    *NOUNS,
)  # fmt: skip
_COUNTS = ("weights", "resource_block_group_size")
"""Limits without a unit."""
_NUMBER = re.compile(r"^[-+\d.,\s]+")
_FAR = 20.0
"""How many times a figure may change where its unit is left out."""


def read_figure(words: Words) -> Intent | None:
    """The limit of which a line says the one figure; None for any other line."""
    further = ["been"] if words.has("suppose") else []
    further += ["more", "less"] if words.has("to", "up_to", "make") else []
    replaced, strict = _replaced(words), words.replaced is not None
    stands = [] if replaced is None else holding(words, replaced)
    figures = [figure for figure in words.figures if figure is not replaced]
    if len(figures) != 1 or not words.only(*_SAID, *further) or words.has("instead") or (strict and not stands):
        return None
    figure, corrects = figures[0], words.has("correct")
    if figure.kind == "bare" and words.has("serve") and not words.has("to"):  # "bring 3 back", who is served
        return None
    supposed = [act for one in words.last(Suppose) for act in one.acts if isinstance(act, Limit)]
    before = supposed or [*words.last(Limit), *(as_held(words, act) for act in words.last(Scale))]
    if corrects and words.taken_off:
        before = [act for act in stated(words.taken_off) if isinstance(act, Limit)]
    before = stands or before
    kinds = _kinds_of(words, figure, before)
    if len(kinds) != 1:
        return None
    kind = kinds[0]
    models = [act for act in before if act.kind == kind]
    model = _model(words, figure, kind, models)
    says_whose = words.users or words.spoken_of or words.has("others", "every", "both")
    several = len({act.whom for act in models}) > 1 and not says_whose and not stands
    if several and model is not None and corrects:
        users = [user for act in models if isinstance(act.whom, Named) for user in act.whom.users]
        return words.line.ask("whose_figure", text=figure.text, users=words.line.voice.users(users))
    of_share = bool(words.line.context.share_of) and figure.kind == "bare"
    if several or (corrects and (of_share or (model is None and words.last(Drop)))):
        return None
    if _caps(words) and kind not in ("max_rate_bps", *UNITS["power"]):
        return None
    value, whom = value_of(figure, kind, model), _whom(words, kind, model)
    if value is None or whom is None or not (stands or _leans(words, figure, model, supposes=bool(supposed))):
        return None
    wondered = words.line.is_asked or words.has("suppose") or supposed
    orders = is_ordered(words.line.text) and not words.line.is_asked
    if not wondered or words.has("take", "make", "correct") or orders:
        said = f"{figure.value:g} {unit_of(model)}" if _is_bare(figure, kind) and model is not None else figure.text
        theirs = [act.whom for act in models] if stands and not says_whose else [whom]
        return words.acts([Limit(kind=kind, value=value, whom=whose, words=said) for whose in theirs])
    if isinstance(whom, Others) or not (words.has("suppose") or supposed):
        return None
    users = dict.fromkeys(whom.users, value) if isinstance(whom, Named) else value
    return words.line.question("what_if", constraints={kind: users})


def _replaced(words: Words) -> Quantity | None:
    """The figure in whose place the line has another one: "the 800 should be 600", "14, no, 13 W"."""
    if words.replaced is not None or words.corrected is not None:
        return words.replaced or words.corrected
    becomes = len(words.figures) == 2 and words.has("make", "revise", "to", "correct")
    return words.figures[0] if becomes and holding(words, words.figures[0]) else None


def holding(words: Words, figure: Quantity) -> list[Limit]:
    """The limits that hold with a figure."""
    found = list[Limit]()
    for kind, held in words.held.items():
        own = held.items() if isinstance(held, Mapping) else [(EVERYBODY, held)]
        for user, value in own:
            act = Limit(kind=kind, value=value) if isinstance(value, float) else None
            if act is not None and math.isclose(value_of(figure, kind, act) or 0.0, act.value):
                common: Whom = Others() if isinstance(held, Mapping) else Everybody()
                found.append(dataclasses.replace(act, whom=common if user == EVERYBODY else Named((user,))))
    return found


def as_held(words: Words, act: Scale) -> Limit:
    """A figure that was scaled, as it holds."""
    held = words.held.get(act.kind)
    users = act.whom.users if isinstance(act.whom, Named) else (EVERYBODY,)
    value = held.get(users[0], held.get(EVERYBODY, 1.0)) if isinstance(held, Mapping) else held
    return Limit(kind=act.kind, value=value if isinstance(value, float) else 1.0, whom=act.whom)


def _kinds_of(words: Words, figure: Quantity, before: Sequence[Limit]) -> list[str]:
    """The limits that a figure may be, the closest first by what was said last."""
    fitting = UNITS.get(figure.kind, ())
    named = words.named_kinds()
    possible = [kind for kind in named if not fitting or kind in fitting] if named else list(fitting)
    if _caps(words):  # what the hardware draws is no limit
        before = [act for act in before if act.kind != "circuit_power_w"]
    whose = FIGURES_OF_USERS if words.users and figure.kind == "bare" else [act.kind for act in before]
    known = [act.kind for act in before if (not (named or fitting) or act.kind in possible) and act.kind in whose]
    if not named and words.has(*NOUNS):
        return []
    if words.has("up_to") and words.users and figure.kind in ("rate", "bare"):  # "user 3 may go up to 8"
        return ["max_rate_bps"] if "max_rate_bps" in words.held else []
    if figure.kind == "bare" and not named:
        return known[-1:]
    held = [kind for kind in possible if kind in words.held]
    if known or len(held) == 1:
        return known[-1:] or held
    return possible[:1] if figure.kind == "rate" or (named and len(possible) == 1) else []


def _model(words: Words, figure: Quantity, kind: str, models: Sequence[Limit]) -> Limit | None:
    """What the figure stands in the place of: what was said last, else what holds and is named by a noun."""
    model, held = models[-1] if models else None, words.held.get(kind)
    if not models and kind == "max_power_w":
        held = held or words.line.context.max_power_w
    if not models and figure.kind == "bare" and kind in words.named_kinds() and isinstance(held, float):
        model = Limit(kind=kind, value=held)
    if words.has("others", "every") or words.users:
        return next((act for act in models if isinstance(act.whom, Named) is bool(words.users)), model)
    return model


def _caps(words: Words) -> bool:
    """Whether a line sets the most of something; "bump her up to 600 kbit/s" does not."""
    raised = words.has("more", "make")
    return any("at_most" in token.classes and not (raised and "to" in token.classes) for token in words.tokens)


def _leans(words: Words, figure: Quantity, model: Limit | None, *, supposes: bool) -> bool:
    """Whether a line says no more than what a figure is to be now, and so leans on what was said before."""
    classes = ["correct", "take", "others", "both", "at_most", "subcarrier", "group", "pronoun", "one"]
    classes += ["up_to", "except"] if words.users or words.spoken_of else []
    classes += ["whose"] if not words.is_read else []
    says_what = words.is_read and words.has(*NOUNS)  # whose sentences are the recogniser's
    classes += ["moves"] if model is not None and model.kind in words.held and not says_what else []
    unread = not words.is_read or words.was_too_much or figure.kind == "ratio"
    classes += ["make"] if model is not None and unread else []
    classes += ["make", "lead", "with", "suppose", "grant"] if figure.kind == "bare" or supposes else []
    classes += (["to"] if words.users else ["more", "less"]) if figure.kind == "bare" and words.has("to") else []
    classes += ["revise"] if model is not None and isinstance(model.whom, Named) else []
    if len(words.named_kinds()) == 1:
        classes += ["make", "promise"] if words.users or not words.is_read else ["make", "limit", "to"]
    says_nothing_else = all(token.figure or "skip" in token.classes for token in words.tokens)
    alone = model is not None and words.line.context.awaits == "nothing" and says_nothing_else
    alone = alone or bool(words.about)
    leans = alone or words.has(*classes) or (words.has("limit", "power") and figure.kind == "power")
    if not leans or (words.has("by") and words.has("make")):
        return False
    pairs = itertools.pairwise(words.tokens)
    led = words.has("lead", "correct", "with", "make", "at_most", "grant", "to", "up_to", "moves", "except")
    led = led or any(token.figure and "promise" in behind.classes for token, behind in pairs)  # "1 Mbit/s promised"
    return led or not words.users or not words.is_read


def _whom(words: Words, kind: str, model: Limit | None) -> Whom | None:
    """For whom a limit is; None where no such limit is for whom the line says."""
    whom = words.whom() or (model.whom if model is not None else Everybody())
    if words.has("both") and not words.users:
        return None
    if kind not in FIGURES_OF_USERS:
        if words.users or words.has("others"):
            return None
        whom = Everybody()
    named = isinstance(whom, Named)
    if (words.has("one") and not named) or (words.has("pronoun") and words.has("each") and named):
        return None
    return whom


def figures_of(held: Constraint | None) -> tuple[float, ...]:
    """All figures of a limit that holds."""
    if isinstance(held, Mapping):
        return tuple(held.values())
    return (held,) if isinstance(held, float) else ()


def _is_bare(figure: Quantity, kind: str) -> bool:
    """Whether a figure is without the unit that it has."""
    return figure.kind == "bare" and kind not in _COUNTS


def value_of(figure: Quantity, kind: str, model: Limit | None) -> float | None:
    """A figure in SI units; one without a unit has that of the figure in whose place it is."""
    value, bare = figure.value, _is_bare(figure, kind)
    if bare:
        unit = None if model is None else unit_of(model)
        found = parse_quantities(f"{figure.value:g} {unit}" if unit else "")
        value = found[0].value if found and found[0].kind != "bare" else math.nan
    if kind == "outage_probability":
        value = round(1 - value if value > 0.5 else value, 12)
    if bare and (model is None or not model.value / _FAR < value < model.value * _FAR):  # another unit may be meant
        return None
    return value if 0 < value < (1 if kind == "outage_probability" else math.inf) else None


def unit_of(model: Limit) -> str:
    """The unit in which a limit was said, or in which it is shown."""
    for one in parse_quantities(model.words):
        if one.kind in UNITS and one.text[:1].isdigit() and (one.value == model.value or one.kind == "ratio"):
            return _NUMBER.sub("", one.text).strip() or "W"
    if model.kind == "outage_probability":
        return "%"
    return _NUMBER.sub("", human(model.value, "W" if model.kind.endswith("_w") else "bit/s")).strip()
