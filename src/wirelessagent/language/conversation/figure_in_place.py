"""A figure in the place of one that was said before: "make it 9", "the others 400k", "and with 8?", "take the 8".

Which limit it is of, for whom and in which unit is as the line says it, else as that was of what was said last.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Mapping, Sequence

from wirelessagent.language.acts import Everybody, Limit, Named, Others, Scale, Suppose, Whom
from wirelessagent.language.conversation.tokens import NOUNS, UNITS, Words, own_users
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, Intent
from wirelessagent.language.intent_acts import stated
from wirelessagent.language.moods import is_ordered
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.model.units import human

_SAID = (
    "users", "every", "others", "pronoun", "one", "it", "lead", "make", "correct", "suppose", "take", "figure",
    "ratio", "bare", "with", "grant", "too", "by", "to", "revise", "both", "at_most", "been", *NOUNS,
)  # fmt: skip
_COUNTS = ("weights", "resource_block_group_size")
"""Limits without a unit."""
_NUMBER = re.compile(r"^[-+\d.,\s]+")
_FAR = 20.0
"""How many times a figure may change where its unit is left out."""


def read_figure(words: Words) -> Intent | None:
    """The limit of which a line says the one figure; None for any other line."""
    further = ("more", "less") if words.has("to") or _says_anew(words) else ()
    if len(words.figures) != 1 or words.has("instead") or not words.only(*_SAID, *further):
        return None
    figure = words.figures[0]
    supposed = [act for one in words.last(Suppose) for act in one.acts if isinstance(act, Limit)]
    before = supposed or [*words.last(Limit), *(as_held(words, act) for act in words.last(Scale))]
    if words.taken_off:
        before = [act for act in stated(words.taken_off) if isinstance(act, Limit)]
    kinds = _kinds_of(words, figure, before)
    if len(kinds) != 1:
        return None
    kind = kinds[0]
    models = [act for act in before if act.kind == kind]
    if len({act.whom for act in models}) > 1 and not (words.whom() or words.has("both")):
        if not words.has("correct"):
            return None
        users = [user for act in models if isinstance(act.whom, Named) for user in act.whom.users]
        return words.line.ask("whose_figure", text=figure.text, users=words.line.voice.users(users))
    if _caps(words) and kind not in ("max_rate_bps", *UNITS["power"]):
        return None
    model = _model(words, figure, kind, models)
    value, whom = value_of(figure, kind, model), _whom(words, kind, model)
    if value is None or whom is None or not _leans(words, figure, model, supposes=bool(supposed)):
        return None
    wondered = words.line.is_asked or words.has("suppose") or supposed
    orders = is_ordered(words.line.text) and not words.line.is_asked
    if not wondered or words.has("take", "make", "correct") or orders:
        said = f"{figure.value:g} {_unit(model)}" if _is_bare(figure, kind) and model is not None else figure.text
        return words.acts([Limit(kind=kind, value=value, whom=whom, words=said)])
    if isinstance(whom, Others):
        return None
    users = dict.fromkeys(whom.users, value) if isinstance(whom, Named) else value
    return words.line.question("what_if", constraints={kind: users})


def _says_anew(words: Words) -> bool:
    """Whether a figure is what something is to be, and not by how much: "a bit more for everyone, say 350"."""
    pairs = itertools.pairwise(words.tokens)
    return any(
        behind.figure is not None and "make" in token.classes and not token.classes & {"more", "less"}
        for token, behind in pairs
    )


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
    known = [act.kind for act in before if not (named or fitting) or act.kind in possible]
    if not named and words.has(*NOUNS):
        return []
    held = [kind for kind in possible if kind in words.held]
    if known or len(held) == 1:
        return known[-1:] or held
    return possible[:1] if figure.kind == "rate" or (named and len(possible) == 1) else []


def _model(words: Words, figure: Quantity, kind: str, models: Sequence[Limit]) -> Limit | None:
    """What the figure stands in the place of: what was said last, else what holds and is named by a noun."""
    if models:
        return models[-1]
    held = words.held.get(kind) or (words.line.context.max_power_w if kind == "max_power_w" else None)
    return Limit(kind=kind, value=held) if figure.kind == "bare" and isinstance(held, float) else None


def _caps(words: Words) -> bool:
    """Whether a line sets the most of something; "bump her up to 600 kbit/s" does not."""
    raised = words.has("more", "make")
    return any("at_most" in token.classes and not (raised and "to" in token.classes) for token in words.tokens)


def _leans(words: Words, figure: Quantity, model: Limit | None, *, supposes: bool) -> bool:
    """Whether a line says no more than what a figure is to be now, and so leans on what was said before."""
    classes = ["correct", "take", "others", "both", "at_most", "subcarrier", "group", "pronoun", "one"]
    if figure.kind == "bare" or supposes:
        classes += ["make", "lead", "with", "suppose", "grant", "more", "less", *(["to"] if words.users else [])]
    classes += ["make"] if model is not None and not words.is_read else []
    classes += ["revise"] if model is not None and isinstance(model.whom, Named) else []
    if len(words.named_kinds()) == 1:
        classes += ["make", "promise"] if words.users else ["make", "limit"]
    says_nothing_else = all(token.figure or "skip" in token.classes for token in words.tokens)
    alone = model is not None and says_nothing_else
    leans = alone or words.has(*classes) or (words.has("limit") and figure.kind == "power")
    if not leans or (words.has("by") and words.has("make")):
        return False
    pairs = itertools.pairwise(words.tokens)
    led = words.has("lead", "correct", "with", "make", "at_most", "grant", "to")
    led = led or any(token.figure and "promise" in behind.classes for token, behind in pairs)  # "1 Mbit/s promised"
    return led or not words.users


def _whom(words: Words, kind: str, model: Limit | None) -> Whom | None:
    """For whom a limit is; None where no such limit is for whom the line says."""
    if kind not in FIGURES_OF_USERS:
        return None if words.users or words.has("others") else Everybody()
    if words.has("both"):
        both = own_users(words.held.get(kind))
        return Named(both) if len(both) == 2 else None
    whom = words.whom() or (model.whom if model is not None else Everybody())
    return None if words.has("one") and not isinstance(whom, Named) else whom


def _is_bare(figure: Quantity, kind: str) -> bool:
    """Whether a figure is without the unit that it has."""
    return figure.kind == "bare" and kind not in _COUNTS


def value_of(figure: Quantity, kind: str, model: Limit | None) -> float | None:
    """A figure in SI units; one without a unit has that of the figure in whose place it is."""
    value, bare = figure.value, _is_bare(figure, kind)
    if bare:
        unit = None if model is None else _unit(model)
        found = parse_quantities(f"{figure.value:g} {unit}" if unit else "")
        value = found[0].value if found and found[0].kind != "bare" else math.nan
    if kind == "outage_probability":
        value = round(1 - value if value > 0.5 else value, 12)
    if bare and (model is None or not model.value / _FAR < value < model.value * _FAR):  # another unit may be meant
        return None
    return value if 0 < value < (1 if kind == "outage_probability" else math.inf) else None


def _unit(model: Limit) -> str:
    """The unit in which a limit was said, or in which it is shown."""
    for one in parse_quantities(model.words):
        if one.kind in UNITS and one.text[:1].isdigit():
            return _NUMBER.sub("", one.text).strip()
    if model.kind == "outage_probability":
        return "%"
    return _NUMBER.sub("", human(model.value, "W" if model.kind.endswith("_w") else "bit/s")).strip()
