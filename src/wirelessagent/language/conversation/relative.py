"""Figures that are said by what holds: "double the rates", "half the power", "2 W less power", "功率降20%".

A change is a share ("a third", "20 %", "10 dB") or an amount in W or bit/s, which what holds becomes ("of", "to") or by
which it becomes less or more. Asked about, it is a what-if; asked what it is worth ("how much would 10 % less power
cost?"), a what-if of a share or a step of an amount. The details "share_of" and "share_how" remember what was changed
and how, for "no, a third" behind it.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

from wirelessagent.language.acts import Act, Drop, Everybody, Limit, Named, Others, Scale, Whom
from wirelessagent.language.conversation.figure_in_place import as_held, value_of
from wirelessagent.language.conversation.line import has
from wirelessagent.language.conversation.tokens import NOUNS, UNITS, Words, own_users
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, Constraint, Detail, Intent
from wirelessagent.language.quantities import Quantity

_SAID = (
    "than", "possessed", "both",
    "users", "every", "others", "each", "pronoun", "it", "lead", "make", "more", "less", "ratio", "factor", "weight",
    "rate", "promise", "power", "limit", "again", "by", "to", "figure", "decibel", "bare", "at_most", "suppose",
    "worth", "spend", "effect", "been", "with", "one", "grant", "group", "circuit", "subcarrier", "further",
)  # fmt: skip
_SCALED = (
    "max_power_w", "min_rate_bps", "max_rate_bps", "circuit_power_w", "subcarrier_max_power_w",
    "resource_block_group_size",
)  # fmt: skip

Basis = float | Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class _Change:
    """By which factor something changes, or by which figure: ``how`` is "of", "less" or "more"."""

    how: str
    factor: float = 1.0
    figure: Quantity | None = None

    @property
    def step(self) -> float:
        if self.figure is None:
            return 0.0
        return -self.figure.value if self.how == "less" else self.figure.value

    def of(self, basis: Basis) -> Basis:
        if isinstance(basis, Mapping):
            return {user: figure * self.factor + self.step for user, figure in basis.items()}
        return basis * self.factor + self.step


def read_relative(words: Words, *, wonders: bool = False) -> Intent | None:
    """A change of a limit by what holds, or what would be if it were so changed; None for any other line."""
    weighed = any(act.kind == "weights" for act in words.last(Limit))
    corrects = words.has("correct") and (bool(words.line.context.share_of) or weighed)
    change = _change(words, corrects=corrects)
    if change is None or not words.only(*_SAID, *(("correct",) if corrects else ())):
        return None
    if len(_groups(words)) > 1:  # one of whom has what the other is to have a share of
        return None
    asked = words.line.is_asked and not has("polite", words.line.shape)
    supposes = wonders or words.has("suppose") or words.has("worth")
    if (asked or words.has("been") or (words.has("effect") and not words.has("less"))) and not supposes:
        return None
    if corrects and not weighed:
        return _instead(words, change)
    if words.has("worth") and change.figure is not None:
        return _worth(words, change.figure, change.step)
    if not supposes and change.figure is None:
        weighed = _weighed(words, change.factor)
        if weighed is not None:
            return weighed
    stays = words.has(*NOUNS) and not words.last(Limit, Scale)  # "double the floor" behind one that was taken off
    name, whom = _changed_limit(words, change), words.whom() or (Everybody() if stays else words.last_whom())
    if name is None or ((words.has("pronoun") or words.has("one")) and not isinstance(whom, Named)):
        return None
    of_users = name in FIGURES_OF_USERS
    if not of_users and (words.users or isinstance(whom, Others)):
        return None
    whom = whom if of_users else Everybody()
    users = whom.users if isinstance(whom, Named) else (EVERYBODY,) if isinstance(whom, Others) else ()
    basis = _of_users(_held(words, name), users)
    if basis is None:
        if words.has("worth") and name == "min_rate_bps":
            return words.line.question("step", rate_share=change.factor - 1.0)
        return words.line.ask("no_rate_to_change")
    return _result(words, name, basis, change, supposes=supposes, whom=whom)


def read_repeated(words: Words) -> Intent | None:
    """ "Again": what was changed last by what holds, once more."""
    context, scaled = words.line.context, words.last(Scale)
    if scaled:
        return words.acts(scaled) if len(scaled) == len(context.acts) else None
    if context.share_how == "of" or context.supposed_objective is not None:
        return None
    for name, basis in context.share_of.items():
        held = words.held.get(name)
        if isinstance(held, float) and isinstance(basis, float):
            again = 2 * held - basis
            details: dict[str, Detail] = {"share_of": {name: held}, "share_how": context.share_how}
            return (
                words.line.amend({name: again}, details=details) if again > 0 else words.line.ask("nothing_left_of_it")
            )
    return None


def _result(
    words: Words, name: str, basis: Basis, change: _Change, *, supposes: bool, whom: Whom | None = None,
    anew: bool = False,
) -> Intent:  # fmt: skip
    """The limit after the change, as a what-if or as a request; ``anew`` where the basis no longer holds."""
    value = change.of(basis)
    if min(value.values() if isinstance(value, Mapping) else (value,)) <= 0:
        return words.line.ask("nothing_left_of_it")
    details: dict[str, Detail] = {"share_of": {name: basis}, "share_how": change.how}
    if supposes:
        return words.line.question("what_if", constraints={name: value}, **details)
    above_the_cell = name == "max_power_w" and words.held.get(name, basis) != basis
    if anew or change.figure is not None or above_the_cell:
        return words.line.amend({name: value}, details=details)
    radiated = name == "max_power_w" and words.has("power")
    act: Act = Scale(
        kind=name, factor=change.factor, whom=whom or Everybody(), reference="radiated" if radiated else "held",
    )  # fmt: skip
    return words.acts([act], details)


def _instead(words: Words, change: _Change) -> Intent | None:
    """ "No, a third": the change of the line before by another amount."""
    context = words.line.context
    name, basis = next(iter(context.share_of.items()))
    kind = "power" if name == "max_power_w" else "rate"
    if isinstance(basis, tuple) or (change.figure is not None and change.figure.kind != kind):
        return None
    scaled = words.last(Scale)
    if scaled and change.figure is None:
        last = scaled[-1]
        details: dict[str, Detail] = {"share_of": context.share_of, "share_how": change.how}
        return words.acts([Scale(kind=last.kind, factor=change.factor / last.factor, whom=last.whom)], details)
    return _result(words, name, basis, change, supposes=context.supposed_objective is not None, anew=True)


def _change(words: Words, *, corrects: bool) -> _Change | None:
    """The one share or amount of a line, and how it changes what holds."""
    figures, factors = words.figures, [token.factor for token in words.tokens if token.factor is not None]
    if len(figures) + len(factors) != 1:
        return None
    more, less, to = (words.has(name) for name in ("more", "less", "to"))
    if to or more == less:
        how = "of" if to or not corrects else words.line.context.share_how
    else:
        how = "less" if less else "more"
    further = words.has("further") and how == "of" and not to and bool(words.line.context.share_of)
    if further and not factors:  # "another 2"
        how = words.line.context.share_how
    if factors:
        return _of_share(factors[0], how) if factors[0] < 1 else _Change(how="of", factor=factors[0])
    figure = figures[0]
    if figure.kind == "ratio":
        clear = how != "of" or corrects or to or (words.has("power") and not words.has("make"))
        return _of_share(figure.value, how) if clear else None
    if figure.kind == "bare" and words.has("decibel") and how != "of":
        return _Change(how="of", factor=10.0 ** ((-figure.value if how == "less" else figure.value) / 10))
    is_step = how != "of" and (corrects or further or _is_by(words, figure))
    figure = _with_unit(words, figure) if is_step and figure.kind == "bare" else figure
    return _Change(how=how, figure=figure) if is_step and figure.kind in ("power", "rate") else None


def _with_unit(words: Words, figure: Quantity) -> Quantity:
    """A figure without a unit in that of the limit that was stated last: "4 less"; as it is where it may be a user."""
    models = [*words.last(Limit), *(as_held(words, act) for act in words.last(Scale))]
    kinds = [kind for kind in ("power", "rate") if {act.kind for act in models} <= {*UNITS[kind]}]
    counts = figure.value in range(1, len(words.line.context.user_names) + 1)
    if len(models) != 1 or len(kinds) != 1 or (counts and kinds == ["rate"]):
        return figure
    value = value_of(figure, models[0].kind, models[0])
    return figure if value is None else dataclasses.replace(figure, value=value, kind=kinds[0])


def _of_share(share: float, how: str) -> _Change | None:
    factor = {"of": share, "less": 1 - share, "more": 1 + share}[how]
    return _Change(how=how, factor=factor) if factor > 0 else None


def _is_by(words: Words, figure: Quantity) -> bool:
    """Whether a figure says by how much: "by 2 W", "2 W less", "add 2 W", "少2瓦"."""
    place = next(place for place, token in enumerate(words.tokens) if token.figure is figure)
    beside = [token.classes & {"more", "less"} for token in words.tokens[place + 1 :]]
    ahead = words.tokens[place - 1].classes if place else frozenset[str]()
    led = "step" in ahead or (words.line.voice.language == "zh" and ahead & {"more", "less", "by"})
    return words.has("by") or any(beside) or bool(led)


def _weighed(words: Words, factor: float) -> Intent | None:
    """ "Double his weight": a weight is a multiple of the others'."""
    limits = words.last(Limit)
    weights = [act for act in limits if act.kind == "weights"]
    alone = len(weights) == len(limits) or words.has("correct")
    if not (words.has("weight") or (weights and alone and factor > 1)):
        return None
    whom = words.whom() or (weights[-1].whom if len(weights) == 1 else None)
    if not isinstance(whom, Named):
        return None
    own, scaled = own_users(words.held.get("weights")), Scale(kind="weights", factor=factor, whom=whom)
    places = [at for at, token in enumerate(words.tokens) if "weight" in token.classes or token.factor]
    apart = places[-1] - places[0] if places else 0
    of_what_holds = factor < 1 or apart > 1  # "double his weight", and no "double weight"
    anew = not {*whom.users} <= {*own} or words.has("correct", "make") or not of_what_holds
    return words.acts([Limit(kind="weights", value=factor, whom=whom) if anew else scaled])


def read_of_another(words: Words) -> Intent | None:
    """ "User 8 the same as user 3", "half of that for 6", "5 like the others": by the figure of somebody else."""
    figures = [figure for figure in words.figures if figure.kind == "ratio"]
    shares = [*(figure.value for figure in figures), *(token.factor for token in words.tokens if token.factor)]
    if len(shares) > 1 or figures != words.figures:
        return None
    more = words.has("more") - words.has("less")
    factor = (1 + more * shares[0] if more else shares[0]) if shares else 1.0
    if factor <= 0:
        return None
    groups = _groups(words)
    if len(groups) == 1 and len(groups[0][1]) == 2 and not shares:  # "用户5和用户2一样", one list of two
        groups = [(0, (groups[0][1][0],)), (0, (groups[0][1][1],))]
    models = [users for place, users in groups if _is_model(words, place)] or [
        users for _, users in groups[1:] if not shares
    ]
    theirs = [users for _, users in groups if users not in models]
    spoken = words.spoken_of.users if words.spoken_of else ()
    if spoken and len(groups) < 2:
        theirs, models = (theirs or [spoken]), (models or [spoken] if theirs else [])
    if len(theirs) != 1 or (models and (len(models) != 1 or len(models[0]) != 1)):
        return None
    common = words.has("others", "every")
    weighed = {act.kind for act in words.last(Limit)} == {"weights"}
    if shares and weighed and not words.has("than", "too", "equal"):  # "7 double", behind another weight
        return None
    last = [*words.last(Limit), *(as_held(words, act) for act in words.last(Scale))]
    found: dict[str, float] = {}
    for kind in [kind for kind in words.named_kinds() or FIGURES_OF_USERS if kind in FIGURES_OF_USERS]:
        held = words.held.get(kind)
        own = held if isinstance(held, Mapping) else {EVERYBODY: held} if isinstance(held, float) else {}
        anew = [act for act in last if act.kind == kind and words.has("it") and shares]
        those = {act.value for act in anew if not isinstance(act.whom, Named) or not {*theirs[0]} & {*act.whom.users}}
        those = {own[user] for user in own_users(held)} if words.has("both") else those
        model = (models[0][0] if models else EVERYBODY) if models or common else ""
        figure = own.get(model, own.get(EVERYBODY) if shares and model else None)
        figure = those.pop() if not model and len(those) == 1 else figure
        if common and not shares and not (isinstance(held, Mapping) and {*theirs[0]} <= held.keys()):
            continue
        if figure is not None:
            found[kind] = figure * factor
    if common and not shares:
        return words.acts([Drop(kind=kind, whom=Named(theirs[0]), own=True) for kind in found]) if found else None
    latest = {act.kind for act in last} & found.keys()
    kinds = [*latest] if len(latest) == 1 else [*found]
    acts = [Limit(kind=kind, value=found[kind], whom=Named(theirs[0])) for kind in kinds]
    return words.acts(acts) if len(acts) == 1 else None


def _groups(words: Words) -> list[tuple[int, tuple[str, ...]]]:
    """The users of a line with their places, those that are listed together."""
    groups, listed = list[tuple[int, tuple[str, ...]]](), False
    for place, token in enumerate(words.tokens):
        if token.users:
            groups = (
                [*groups[:-1], (groups[-1][0], groups[-1][1] + token.users)]
                if listed
                else [*groups, (place, token.users)]
            )
        listed = bool(token.users) or (listed and "lead" in token.classes)
    return groups


def _is_model(words: Words, place: int) -> bool:
    """Whether the users at a place are those whose figure is taken: "half of what 1 gets", "1号的一半"."""
    for token in words.tokens[:place][::-1]:
        if "than" in token.classes:
            return True
        if "skip" not in token.classes:
            break
    behind = next((token for token in words.tokens[place + 1 :] if "possessed" not in token.classes), None)
    return words.language == "zh" and behind is not None and bool(behind.factor)


def _worth(words: Words, figure: Quantity, step: float) -> Intent:
    """What an amount more or less of power, or of rate for one user or for each, is worth."""
    if figure.kind == "power":
        return words.line.question("step", power_w=step)
    each: dict[str, Detail] = {"each": 1.0} if words.has("each") or words.has("every") else {}
    return words.line.question("step", rate_bps=step, **({"user": words.users[0]} if words.users else each))


def _changed_limit(words: Words, change: _Change) -> str | None:
    """The limit that is changed: what is named, or what was stated last."""
    if words.has("power"):
        return "max_power_w"
    kinds = words.named_kinds() or [act.kind for act in words.last(Limit, Scale)]
    if change.figure is not None:
        kinds = [kind for kind in dict.fromkeys(kinds) if kind in UNITS[change.figure.kind]]
    if change.figure is not None and change.figure.kind == "power":
        return kinds[0] if len(kinds) == 1 else "max_power_w"
    held = list(dict.fromkeys(kind for kind in kinds or UNITS["rate"] if kind in words.held))
    if not held and (words.has("rate") or words.has("promise")):
        return "min_rate_bps"
    return held[0] if len(held) == 1 and held[0] in _SCALED else None


def _held(words: Words, name: str) -> Constraint | None:
    """What the change is of: the limit that holds, which for power is the cell's where it is the lower one."""
    held, limit = words.held.get(name), words.line.context.max_power_w
    if name == "max_power_w":
        return min(held, limit) if isinstance(held, float) else limit
    return held


def _of_users(held: Constraint | None, users: tuple[str, ...]) -> Basis | None:
    """What holds, for these users alone where any are named; None where they have no figure."""
    if held is None or isinstance(held, tuple) or not users:
        return None if isinstance(held, tuple) else held
    own = {user: held.get(user, held.get(EVERYBODY)) if isinstance(held, Mapping) else held for user in users}
    known = {user: figure for user, figure in own.items() if figure is not None}
    return known if len(known) == len(own) else None
