"""Everything that a line of a talk may change of what holds, by its figures, its users and what was said before.

Which of it the line means is weighed elsewhere (:mod:`.weighing`); nothing else can be meant, so that no line changes a
figure that neither it nor the talk says.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Iterator, Mapping, Sequence

from wirelessagent.language.acts import Act, Aim, Drop, Everybody, LeaveOut, Limit, Named, Others, Scale, Serve, Undo
from wirelessagent.language.comparators import speaks_of
from wirelessagent.language.conversation.anchors import Anchor
from wirelessagent.language.conversation.possible import LIMITS, POWERS, Change, Group, Possible, in_its_unit
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, RATES
from wirelessagent.language.moods import may_be_lifted, named_in
from wirelessagent.language.request import Key, acts_between, changed, with_the_assumed
from wirelessagent.language.sentence import BUILT_IN
from wirelessagent.language.stated import CHANGED_BY
from wirelessagent.language.text import clause_end

_BLOCKS = "resource_block_group_size"
_DIVISORS = (2, 3, 4, 5, 10)
_LIKENED = ("named", "last", "spoken", "out")
_MOST_STEPS = 3


def changes_of(possible: Possible) -> list[Change]:
    """Each that a line may say; what can't hold, or holds already, comes to nothing."""
    sayings = (_of_figures, _of_shares, _corrected, _like_another, _of_users, _of_limits, _back_and_aims)
    found = itertools.chain.from_iterable(said(possible) for said in sayings)
    return [dataclasses.replace(each, effect=possible.able_effect(each.acts)) for each in found if each.acts]


def _of_figures(possible: Possible) -> Iterator[Change]:
    """By figures of the line: set, or so much more or less than what holds."""
    for figure, kind in itertools.product(possible.line.figures, LIMITS):
        for value, group in itertools.product(possible.values(figure, kind), possible.groups_for(kind, figure)):
            yield from _figure_for(possible, figure, kind, value, group)
    yield from _respectively(possible)
    for limit in possible.last:
        one = in_its_unit(1.0, limit)
        ways = [("one more", limit.value + one), ("one less", limit.value - one)] if one else []
        ways = [(form, value) for form, value in ways if value > 0]
        if limit.kind in (*RATES, *POWERS):  # "kilobits, sorry"
            ways += [("in thousands", limit.value * 1e3), ("in thousandths", limit.value * 1e-3)]
        for form, value in ways:
            yield Change((dataclasses.replace(limit, value=value),), form, limit.kind, "last")


def _figure_for(possible: Possible, figure: Anchor, kind: str, value: float, group: Group) -> Iterator[Change]:
    """A figure for a group: in the place of theirs, or so much more or less."""
    limit = Limit(kind=kind, value=value, whom=group.whom)
    if not figure.is_negative:
        yield group.change([limit], "set", kind, figure)
    if {*group.users} & {*possible.out}:
        yield group.change([Serve(whom=group.whom), limit], "serve", kind, figure)
    if figure in possible.line.becoming or kind not in (*FIGURES_OF_USERS, *POWERS):
        return
    held, ways = possible.limits_of(kind, group), (("plus", 1), ("minus", -1))
    if not held and kind == "max_power_w":  # what is radiated, which can only become less
        held, ways = [Limit(kind=kind, value=possible.radiated_w)], ways[1:]
    of_one = kind in FIGURES_OF_USERS and not group.users and len(held) == 1 and isinstance(held[0].whom, Named)
    of_one = of_one and not CHANGED_BY.is_at(possible.line.plain, figure.start, figure.end)
    for form, sign in ways if held and not of_one else ():  # one who has a figure is not everybody
        sums = [dataclasses.replace(each, value=each.value + sign * value) for each in held]
        yield group.change(sums, form, kind, figure)


def _respectively(possible: Possible) -> Iterator[Change]:
    """Several figures, each for one of as many users: "weights 2, 3 and 4 for 6, 7 and 8"."""
    for group in possible.groups:
        users = group.users if group.source == "named" else ()
        figures = [figure for figure in possible.line.figures if figure not in group.anchors]
        for kind in FIGURES_OF_USERS if len(users) == len(figures) > 1 else ():
            values = [max(possible.values(figure, kind), default=0.0) for figure in figures]
            if all(values):
                acts = [Limit(kind=kind, value=value, whom=Named((user,)))
                        for user, value in zip(users, values, strict=True)]  # fmt: skip
                yield group.change(acts, "each", kind, figures[0])


def _of_shares(possible: Possible) -> Iterator[Change]:
    """By shares and multiples of what holds, or of what was said last; "double the rates" is about no power."""
    plain = possible.line.plain
    noun = speaks_of(plain) if possible.line.figures else ()
    named = {name for _, name in named_in(plain)}
    nouns = POWERS if "power" in noun else RATES
    able = LIMITS if len(noun) != 1 else [kind for kind in LIMITS if kind in nouns or may_be_lifted(kind, named)]
    of_the_noun = not noun or any(may_be_lifted(kind, named) for kind in nouns)
    if named and of_the_noun and clause_end(plain, 0) == len(plain.rstrip(".!。")):
        able = [kind for kind in able if may_be_lifted(kind, named)]  # "triple the power limit"
    if _BLOCKS not in possible.last_kinds | named:
        able = [kind for kind in able if kind != _BLOCKS]  # which nobody triples by the way
    most_w = possible.figures.get(("max_power_w", EVERYBODY), math.inf)
    of_the_cell = most_w > possible.context.max_power_w and not may_be_lifted("max_power_w", named)
    of_the_cell &= bool(noun) or "max_power_w" not in possible.last_kinds  # "make that a quarter less"
    kinds = [kind for kind in dict.fromkeys((*possible.held, "min_rate_bps")) if kind in able]
    kinds = [kind for kind in kinds if kind != "max_power_w" or not of_the_cell]  # it may radiate less than its limit
    for figure in possible.line.figures:
        becomes = figure in possible.line.becoming
        groups = possible.groups_for(RATES[0], figure)
        for form, factor in _ways_of(figure):
            if becomes and form in ("less", "more"):
                continue
            for kind in kinds:
                for group in possible.groups_for(kind, figure):
                    yield group.change([Scale(kind=kind, factor=factor, whom=group.whom)], form, kind, figure)
            if "max_power_w" in able and "max_power_w" not in kinds:
                limit = Limit(kind="max_power_w", value=possible.radiated_w * factor)
                yield Change((limit,), form, "max_power_w", "cell", figure)
            for last, group in itertools.product(possible.last, groups):  # "half of that for 7"
                if last.kind in FIGURES_OF_USERS and group.whom != last.whom:
                    limit = Limit(kind=last.kind, value=last.value * factor, whom=group.whom)
                    yield group.change([limit], f"{form} of that", last.kind, figure)


def _ways_of(figure: Anchor) -> Iterator[tuple[str, float]]:
    """How something may be changed by a figure of a line: to a share of it, by it less, by it more, to a multiple."""
    share = figure.value
    if figure.kind not in ("ratio", "factor") and not (figure.kind == "number" and (share in _DIVISORS or share % 1)):
        return
    if figure.kind != "ratio" and share > 1:
        yield from (("times", share), ("part", 1 / share))
    else:
        ways = (("to", share), ("less", 1 - share), ("more", 1 + share))
        yield from ((form, factor) for form, factor in ways if factor > 0)


def _corrected(possible: Possible) -> Iterator[Change]:
    """What the line says in the place of the last change: "not half, a third", "by 300k, not 200k"."""
    base = None if possible.supposed or not possible.context.past else possible.context.past[-1]
    kinds = possible.last_kinds
    if base is None or not kinds:
        return
    context = dataclasses.replace(possible.context, objective=base.objective, constraints=base.constraints, past=())
    then = Possible(possible.line, context)
    for change in itertools.chain(_of_figures(then), _of_shares(then)):
        of_last = change.kind in kinds and change.source in ("", "cell", "last", "named", "everybody")
        if of_last and (change.form != "set" or change.source == "named"):
            acts = acts_between(possible.figures, changed(then.figures, change.acts))
            yield dataclasses.replace(change, acts=acts, form=f"{change.form} instead")
    for limit in possible.last:
        if limit.kind in RATES:  # "minimum, not maximum"
            other = dataclasses.replace(limit, kind=RATES[limit.kind == RATES[0]])
            acts = acts_between(possible.figures, changed(then.figures, [other]))
            yield Change(acts, "other bound", other.kind, "last")
    yield from _same_step_of_another(possible, then)


def _same_step_of_another(possible: Possible, then: Possible) -> Iterator[Change]:
    """The step of the last change, of another limit instead: "the floor, not the cap" behind "double the cap"."""
    before = {key: then.figures.get(key, then.figures.get((key[0], EVERYBODY))) for key in possible.figures}
    steps = {key: (old, after) for key, after in possible.figures.items()
             if after and (old := before[key]) and old != after}  # fmt: skip
    for kind in (*RATES, "max_power_w"):
        others = {user: step for (name, user), step in steps.items() if name != kind}
        users = {EVERYBODY: next(iter(others.values()))} if kind == "max_power_w" and len(others) == 1 else others
        held = {(kind, user): figure for user in users if (figure := _held(then.figures, kind, user))}
        moved, scaled = _alike(held, {(kind, user): step for user, step in users.items()})
        for form, after in (("other scaled", scaled), ("other moved", moved)):
            if after and all(value > 0 for value in after.values()):
                yield Change(acts_between(possible.figures, {**then.figures, **after}), form, kind, "last")


def _alike(held: Mapping[Key, float], steps: Mapping[Key, tuple[float, float]]) -> tuple[dict[Key, float], ...]:
    """Figures changed by as much, and as many times, as a step goes from one figure to another."""
    by_much = {key: figure + steps[key][1] - steps[key][0] for key, figure in held.items()}
    return by_much, {key: figure * steps[key][1] / steps[key][0] for key, figure in held.items()}


def _held(figures: Mapping[Key, float], kind: str, user: str) -> float | None:
    """The figure of a user, else everybody's."""
    return figures.get((kind, user)) or figures.get((kind, EVERYBODY))


def _like_another(possible: Possible) -> Iterator[Change]:
    """The figure of one user, or a share of it, for others: "8 the same as 3", "half of what 1 gets for 6"."""
    alone = [(users[0], anchors[0]) for users, anchors in possible.named if len(users) == 1]
    for group, (model, other) in itertools.product(possible.groups, alone):
        users = group.users if group.source in _LIKENED else ()
        if not users or other in group.anchors or model in users:
            continue
        side = "of" if not group.anchors else "ahead" if group.anchors[0].start < other.start else "behind"
        yield from _moved(possible, group, model, other, side)
        found = {kind: possible.before.get((kind, model)) for kind in FIGURES_OF_USERS}
        limits = [Limit(kind=kind, value=figure, whom=group.whom) for kind, figure in found.items()
                  if isinstance(figure, float)]  # fmt: skip
        if len(limits) > 1:
            yield group.change(limits, f"all like {side}", model=other)
        for limit in limits:
            yield group.change([limit], f"like {side}", limit.kind, model=other)
            for share in possible.line.figures:
                sums = [("plus", limit.value + share.value), ("minus", limit.value - share.value)]
                ways = [(form, limit.value * factor) for form, factor in _ways_of(share)]
                for form, value in sums if share.kind == "rate" and limit.kind in RATES else ways:
                    of_it = dataclasses.replace(limit, value=value)
                    yield group.change([of_it], f"{form} like {side}", limit.kind, share, other)
    for group in possible.groups:
        for kind in FIGURES_OF_USERS if len(group.users) == 2 else ():
            one, other = (possible.figures.get((kind, user)) for user in group.users)
            if one and other:
                acts = [Limit(kind=kind, value=other, whom=Named(group.users[:1])),
                        Limit(kind=kind, value=one, whom=Named(group.users[1:]))]  # fmt: skip
                yield group.change(acts, "swap", kind)


def _moved(possible: Possible, group: Group, model: str, other: Anchor, side: str) -> Iterator[Change]:
    """What is said of one user, of others instead: "user 4 is the one in the call, not 2"."""
    for kind in FIGURES_OF_USERS:
        figure = possible.figures.get((kind, model))
        if figure:
            acts = [Drop(kind=kind, whom=Named((model,)), own=True), Limit(kind=kind, value=figure, whom=group.whom)]
            yield group.change(acts, f"moved {side}", kind, model=other)
    if model in possible.out:
        acts = [Serve(whom=Named((model,))), LeaveOut(whom=group.whom)]
        yield group.change(acts, f"out instead {side}", model=other)
    elif possible.out:
        acts = [LeaveOut(whom=Named((model,))), Serve(whom=group.whom)]
        yield group.change(acts, f"in instead {side}", model=other)


def _of_users(possible: Possible) -> Iterator[Change]:
    """Who is served and who is not, and of whom what was said last is said, too."""
    for group in possible.groups:
        if isinstance(group.whom, Named):
            yield group.change([LeaveOut(whom=group.whom)], "out")
            yield group.change([Serve(whom=group.whom)], "in")
            yield group.change([Serve(whom=group.whom, alone=True)], "only")
            if group.source != "last":
                yield from _of_these_too(possible, group, group.whom)
            yield from _of_these_instead(possible, group, group.whom)
            yield group.change([Serve(whom=Everybody()), LeaveOut(whom=group.whom)], "all in but")
    yield Change((Serve(whom=Everybody()),), "all in")


def _of_these_too(possible: Possible, group: Group, whom: Named) -> Iterator[Change]:
    """What was said last, of these users too."""
    for limit in possible.last:
        if limit.kind in FIGURES_OF_USERS:
            acts = [dataclasses.replace(limit, whom=whom)]
            yield group.change(acts, "too", limit.kind)
            if {*whom.users} & {*possible.out}:  # "6 comes in as well, the same rate"
                yield group.change([Serve(whom=whom), *acts], "in too", limit.kind)
    yield from _stepped(possible, group)
    for act in possible.said:
        if isinstance(act, Scale) and act.kind in FIGURES_OF_USERS:
            yield group.change([dataclasses.replace(act, whom=whom)], "too scaled", act.kind)
        elif isinstance(act, Drop) and act.kind in possible.held and act.kind in FIGURES_OF_USERS:
            yield group.change(dropped(act.kind, whom, possible.figures, possible.users), "too dropped", act.kind)


def _stepped(possible: Possible, group: Group) -> Iterator[Change]:
    """By as much, or as many times, as somebody's figure was changed last, for others too or in their place."""
    before = possible.past[0] if possible.past and not possible.supposed else {}
    for kind in dict.fromkeys(limit.kind for limit in possible.last if limit.kind in FIGURES_OF_USERS):
        steps = {(_held(before, kind, user), possible.figures.get((kind, user))) for user in possible.last_users}
        old, new = steps.pop() if len(steps) == 1 else (None, None)
        if not old or not new or old == new:
            continue
        for place, base in (("too", possible.figures), ("instead", before)):
            held = {(kind, user): figure for user in group.users if (figure := _held(base, kind, user))}
            forms = zip(("as much", "as many times"), _alike(held, dict.fromkeys(held, (old, new))), strict=True)
            for form, figures in forms if held else ():
                yield group.change(acts_between(possible.figures, {**base, **figures}), f"{form} {place}", kind)


def _of_these_instead(possible: Possible, group: Group, whom: Named) -> Iterator[Change]:
    """What was said last, of these users and not of those of whom it was said."""
    of_users = [act for act in possible.context.acts if isinstance(act, Serve | LeaveOut)
                or (isinstance(act, Limit | Scale | Drop) and act.kind in FIGURES_OF_USERS)]  # fmt: skip
    if possible.past and of_users and not possible.supposed:
        base = possible.context.past[-1]
        meant = [dataclasses.replace(act, whom=whom) if act in of_users else act for act in possible.context.acts]
        held = with_the_assumed(None if base is None else base.objective, possible.past[0], meant)
        yield group.change(acts_between(possible.figures, changed(held, meant)), "instead")


def _of_limits(possible: Possible) -> Iterator[Change]:
    """Which limit is no more, and of whom."""
    for kind in LIMITS:
        for group in possible.groups_for(kind) if kind in possible.held else [possible.cell]:
            if isinstance(group.whom, Named):
                yield group.change(dropped(kind, group.whom, possible.figures, possible.users), "drop", kind)
                yield group.change([Drop(kind=kind, whom=group.whom, own=True)], "drop own", kind)
            else:
                own = isinstance(group.whom, Others)
                yield group.change([Drop(kind=kind, whom=group.whom, own=own)], "drop", kind)


def dropped(kind: str, whom: Named, figures: Mapping[Key, float], users: Sequence[str]) -> list[Act]:
    """A limit taken off some users; a ceiling of all is written out for the others, as there is none for nobody."""
    common = figures.get((kind, EVERYBODY))
    if kind != "max_rate_bps" or common is None:
        return [Drop(kind=kind, whom=whom)]
    kept = [user for user in users if user not in whom.users]
    return [Drop(kind=kind), *(Limit(kind=kind, value=figures.get((kind, user), common), whom=Named((user,)))
                               for user in kept)]  # fmt: skip


def _back_and_aims(possible: Possible) -> Iterator[Change]:
    """Another aim, and what was supposed or held before."""
    if possible.supposed:
        yield Change(possible.supposed, "as supposed")
    said = [int(figure.value) for figure in possible.line.figures if figure.kind == "number"]
    for steps in dict.fromkeys((*range(1, _MOST_STEPS + 1), *said)):
        if 0 < steps <= len(possible.past):
            form = f"undo {min(steps, _MOST_STEPS)}"
            yield Change((Undo(steps=steps),), form, source="said" if steps in said else "")
    for objective in BUILT_IN:
        yield Change((Aim(objective=objective),), "aim", objective)
    for kind in LIMITS:  # a limit as it last was: "the cap holds again", "back to ten"
        of_kind = [{key: figure for key, figure in held.items() if key[0] == kind}
                   for held in (possible.figures, *possible.past)]  # fmt: skip
        now, *earlier = of_kind
        then = next((held for held in earlier if held and held != now), None)
        if then is not None:
            yield Change(acts_between(now, then), "as before", kind, "held" if now else "gone")
    before = possible.past[0] if possible.past else {}
    stepped = {key: (before[key], after) for key, after in possible.figures.items() if after and before.get(key)}
    if any(one != other for one, other in stepped.values()) and not possible.line.figures:  # the last change again
        moved, scaled = _alike({key: after for key, (_, after) in stepped.items()}, stepped)
        scales = any(isinstance(act, Scale) for act in possible.said)
        form, figures = ("as much again", scaled) if scales else ("again", moved)
        yield Change(acts_between(possible.figures, {**possible.figures, **figures}), form, source="last")
