"""Changes by the figures of a line: set, added to what holds, shares of it, and in the place of what was said last."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Iterator, Sequence

from wirelessagent.language.acts import Limit, Named, Scale, Serve
from wirelessagent.language.comparators import speaks_of
from wirelessagent.language.conversation.anchors import Anchor
from wirelessagent.language.conversation.change import Change, change_for, changed_by
from wirelessagent.language.conversation.possible import OF_THE_CELL, POWERS, RATES, Group, Possible, in_its_unit
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS
from wirelessagent.language.lifted import named_in
from wirelessagent.language.request import acts_between, changed

_BLOCKS = "resource_block_group_size"
_DIVISORS = (2, 3, 4, 5, 10)


def of_figures(possible: Possible) -> Iterator[Change]:
    for figure in possible.line.figures:
        for kind in FIGURES_OF_USERS:
            for value in possible.values(figure, kind):
                for group in possible.groups:
                    if figure not in group.anchors:
                        yield from _figure_for(possible, figure, kind, value, group)
        for kind in OF_THE_CELL:
            for value in possible.values(figure, kind):
                if not figure.is_negative:
                    yield changed_by([Limit(kind=kind, value=value)], "set", kind, figure=figure)
                if figure in possible.line.becoming:
                    continue
                held = possible.figures.get((kind, EVERYBODY))
                if held is None and kind == "max_power_w":  # the cell's, which can only become less
                    less = possible.context.max_power_w - value
                    yield changed_by([Limit(kind=kind, value=less)], "minus", kind, figure=figure)
                if held is not None and kind in POWERS:
                    for form, sum_ in (("plus", held + value), ("minus", held - value)):
                        yield changed_by([Limit(kind=kind, value=sum_)], form, kind, figure=figure)
    yield from _respectively(possible)
    for limit in possible.last:  # "one more"
        one = in_its_unit(1.0, limit)
        for form, value in (("one more", limit.value + one), ("one less", limit.value - one)):
            if one and value > 0:
                yield changed_by([dataclasses.replace(limit, value=value)], form, limit.kind, "last")
        for form, factor in (("in thousands", 1e3), ("in thousandths", 1e-3)):  # "kilobits, sorry"
            if limit.kind in (*RATES, *POWERS):
                again = dataclasses.replace(limit, value=limit.value * factor)
                yield changed_by([again], form, limit.kind, "last")


def _respectively(possible: Possible) -> Iterator[Change]:
    """Several figures, each for one of as many users: "weights 2, 3 and 4 for 6, 7 and 8"."""
    for group in possible.groups:
        users = group.whom.users if isinstance(group.whom, Named) and group.source == "named" else ()
        figures = [figure for figure in possible.line.figures if figure not in group.anchors]
        for kind in FIGURES_OF_USERS if len(users) == len(figures) > 1 else ():
            values = [max(possible.values(figure, kind), default=0.0) for figure in figures]
            if all(values):
                acts = [Limit(kind=kind, value=value, whom=Named((user,)))
                        for user, value in zip(users, values, strict=True)]  # fmt: skip
                yield change_for(group, acts, "each", kind, figures[0])


def _figure_for(possible: Possible, figure: Anchor, kind: str, value: float, group: Group) -> Iterator[Change]:
    """A figure for a group: in the place of theirs, or so much more or less."""
    whom = group.whom
    if not figure.is_negative:
        yield change_for(group, [Limit(kind=kind, value=value, whom=whom)], "set", kind, figure)
    if isinstance(whom, Named) and {*whom.users} & {*possible.out}:
        yield change_for(group, [Serve(whom=whom), Limit(kind=kind, value=value, whom=whom)], "serve", kind, figure)
    if kind not in possible.held or figure in possible.line.becoming:
        return
    for form, sign in (("plus", 1), ("minus", -1)):
        sums = [(whose, held + sign * value) for whose, held in possible.figures_of(kind, whom)]
        if sums:
            acts = [Limit(kind=kind, value=sum_, whom=whose) for whose, sum_ in sums]
            yield change_for(group, acts, form, kind, figure)


def of_shares(possible: Possible) -> Iterator[Change]:
    """By shares and multiples of what holds, or of what was said last; "double the rates" is about no power."""
    noun = speaks_of(possible.line.plain) if possible.line.figures else ()
    others = () if len(noun) != 1 else RATES if "power" in noun else POWERS
    if _BLOCKS not in possible.last_kinds.union(name for _, name in named_in(possible.line.plain)):
        others = (*others, _BLOCKS)  # which nobody triples by the way
    kinds = [kind for kind in dict.fromkeys((*possible.held, "min_rate_bps")) if kind not in others]
    most_w = possible.figures.get(("max_power_w", EVERYBODY), math.inf)
    of_the_cell = most_w > possible.context.max_power_w  # what it may radiate at all is less than the limit
    for figure in possible.line.figures:
        becomes = figure in possible.line.becoming
        for form, factor in ways_of(figure):
            if becomes and form in ("less", "more"):
                continue
            for kind in kinds:
                if kind in FIGURES_OF_USERS:
                    for group in possible.groups:
                        if figure not in group.anchors:
                            scaled = [Scale(kind=kind, factor=factor, whom=group.whom)]
                            yield change_for(group, scaled, form, kind, figure)
                elif kind != "max_power_w" or not of_the_cell:
                    yield changed_by([Scale(kind=kind, factor=factor)], form, kind, figure=figure)
            if of_the_cell and "max_power_w" not in others:
                limit = Limit(kind="max_power_w", value=possible.context.max_power_w * factor)
                yield changed_by([limit], form, "max_power_w", "cell", figure)
            for last, group in itertools.product(possible.last, possible.groups):  # "half of that for 7"
                if last.kind in FIGURES_OF_USERS and group.whom != last.whom and figure not in group.anchors:
                    limit = Limit(kind=last.kind, value=last.value * factor, whom=group.whom)
                    yield change_for(group, [limit], f"{form} of that", last.kind, figure)


def corrected(possible: Possible) -> Iterator[Change]:
    """What the line says in the place of the last change: "not half, a third", "by 300k, not 200k"."""
    base = None if possible.supposed or not possible.context.past else possible.context.past[-1]
    kinds = possible.last_kinds
    if base is None or not kinds:
        return
    context = dataclasses.replace(possible.context, objective=base.objective, constraints=base.constraints, past=())
    then = Possible(possible.line, context)
    for change in itertools.chain(of_figures(then), of_shares(then)):
        of_last = change.kind in kinds and change.source in ("", "cell", "last", "named", "everybody")
        if of_last and (change.form != "set" or change.source == "named"):
            acts = acts_between(possible.figures, changed(then.figures, change.acts))
            if acts:
                yield dataclasses.replace(change, acts=tuple(acts), form=f"{change.form} instead")
    for limit in possible.last:
        if limit.kind in RATES:  # "minimum, not maximum"
            other = dataclasses.replace(limit, kind=RATES[limit.kind == RATES[0]])
            acts = acts_between(possible.figures, changed(then.figures, [other]))
            yield changed_by(acts, "other bound", other.kind, "last")
    yield from _same_step_of_another(possible, then)


def _same_step_of_another(possible: Possible, then: Possible) -> Iterator[Change]:
    """The step of the last change, of another limit instead: "the floor, not the cap" behind "double the cap"."""
    before = {key: then.figures.get(key, then.figures.get((key[0], EVERYBODY))) for key in possible.figures}
    steps = {key: (old, after) for key, after in possible.figures.items()
             if after and (old := before[key]) and old != after}  # fmt: skip
    for kind in (*RATES, "max_power_w"):
        others = {user: step for (name, user), step in steps.items() if name != kind}
        users = {EVERYBODY: next(iter(others.values()))} if kind == "max_power_w" and len(others) == 1 else others
        held = {user: then.figures.get((kind, user)) or then.figures.get((kind, EVERYBODY)) for user in users}
        scaled = {(kind, user): old * users[user][1] / users[user][0] for user, old in held.items() if old}
        moved = {(kind, user): old + users[user][1] - users[user][0] for user, old in held.items() if old}
        for form, after in (("other scaled", scaled), ("other moved", moved)):
            if after and all(value > 0 for value in after.values()):
                yield changed_by(acts_between(possible.figures, {**then.figures, **after}), form, kind, "last")


def stepped(possible: Possible, group: Group, users: Sequence[str]) -> Iterator[Change]:
    """By as much, or as many times, as somebody's figure was changed last, for others too or in their place."""
    before = possible.past[0] if possible.past and not possible.supposed else {}
    for kind in dict.fromkeys(limit.kind for limit in possible.last if limit.kind in FIGURES_OF_USERS):
        steps = {(before.get((kind, user)) or before.get((kind, EVERYBODY)), possible.figures.get((kind, user)))
                 for user in possible.last_users}  # fmt: skip
        old, new = steps.pop() if len(steps) == 1 else (None, None)
        if not old or not new or old == new:
            continue
        for place, base in (("too", possible.figures), ("instead", before)):
            held = [((kind, user), base.get((kind, user)) or base.get((kind, EVERYBODY))) for user in users]
            by_much = {key: figure + new - old for key, figure in held if figure}
            by_times = {key: figure * new / old for key, figure in held if figure}
            for form, figures in (("as much", by_much), ("as many times", by_times)):
                acts = acts_between(possible.figures, {**base, **figures}) if figures else ()
                if acts:
                    yield change_for(group, acts, f"{form} {place}", kind)


def ways_of(figure: Anchor) -> Iterator[tuple[str, float]]:
    """How something may be changed by a figure of a line, where it is a share or a multiple."""
    share = figure.value
    if figure.kind in ("ratio", "factor") or (figure.kind == "number" and (share in _DIVISORS or share % 1)):
        multiple = figure.kind != "ratio" and share > 1
        yield from (("times", share), ("part", 1 / share)) if multiple else _ways(share)


def _ways(share: float) -> Iterator[tuple[str, float]]:
    """How something may be changed by a share: to it, by it less, by it more."""
    for form, factor in (("to", share), ("less", 1 - share), ("more", 1 + share)):
        if factor > 0:
            yield form, factor
