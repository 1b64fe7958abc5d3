"""Changes without a figure of the line: who is served, whose figure another has, which limit is no more."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator, Mapping, Sequence

from wirelessagent.language.acts import Act, Drop, Everybody, LeaveOut, Limit, Named, Others, Scale, Serve
from wirelessagent.language.conversation.anchors import Anchor
from wirelessagent.language.conversation.change import Change, change_for, changed_by
from wirelessagent.language.conversation.figures_said import stepped, ways_of
from wirelessagent.language.conversation.possible import OF_THE_CELL, RATES, Group, Possible
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS
from wirelessagent.language.request import Key, acts_between, changed, with_the_assumed

_LIKENED = ("named", "last", "spoken", "out")


def like_another(possible: Possible) -> Iterator[Change]:
    """The figure of one user, or a share of it, for others: "8 the same as 3", "half of what 1 gets for 6"."""
    alone = [(users[0], anchors[0]) for users, anchors in possible.named if len(users) == 1]
    for group, (model, other) in itertools.product(possible.groups, alone):
        users = group.whom.users if isinstance(group.whom, Named) and group.source in _LIKENED else ()
        if not users or other in group.anchors or model in users:
            continue
        side = "of" if not group.anchors else "ahead" if group.anchors[0].start < other.start else "behind"
        yield from _moved(possible, group, model, other, side)
        found = {kind: possible.before.get((kind, model)) for kind in FIGURES_OF_USERS}
        limits = [Limit(kind=kind, value=figure, whom=group.whom) for kind, figure in found.items()
                  if isinstance(figure, float)]  # fmt: skip
        if len(limits) > 1:
            yield change_for(group, limits, f"all like {side}", model=other)
        for limit in limits:
            yield change_for(group, [limit], f"like {side}", limit.kind, model=other)
            for share in possible.line.figures:
                sums = [("plus", limit.value + share.value), ("minus", limit.value - share.value)]
                ways = [(form, limit.value * factor) for form, factor in ways_of(share)]
                for form, value in sums if share.kind == "rate" and limit.kind in RATES else ways:
                    of_it = dataclasses.replace(limit, value=value)
                    yield change_for(group, [of_it], f"{form} like {side}", limit.kind, share, other)
    for group in possible.groups:
        users = group.whom.users if isinstance(group.whom, Named) else ()
        for kind in FIGURES_OF_USERS if len(users) == 2 else ():
            one, other = (possible.figures.get((kind, user)) for user in users)
            if one and other:
                acts = [Limit(kind=kind, value=other, whom=Named(users[:1])),
                        Limit(kind=kind, value=one, whom=Named(users[1:]))]  # fmt: skip
                yield change_for(group, acts, "swap", kind)


def _moved(possible: Possible, group: Group, model: str, other: Anchor, side: str) -> Iterator[Change]:
    """What is said of one user, of others instead: "user 4 is the one in the call, not 2"."""
    for kind in FIGURES_OF_USERS:
        figure = possible.figures.get((kind, model))
        if figure:
            acts = [Drop(kind=kind, whom=Named((model,)), own=True), Limit(kind=kind, value=figure, whom=group.whom)]
            yield change_for(group, acts, f"moved {side}", kind, model=other)
    if model in possible.out:
        acts = [Serve(whom=Named((model,))), LeaveOut(whom=group.whom)]
        yield change_for(group, acts, f"out instead {side}", model=other)
    elif possible.out:
        acts = [LeaveOut(whom=Named((model,))), Serve(whom=group.whom)]
        yield change_for(group, acts, f"in instead {side}", model=other)


def of_users(possible: Possible) -> Iterator[Change]:
    for group in possible.groups:
        if not isinstance(group.whom, Named):
            continue
        yield change_for(group, [LeaveOut(whom=group.whom)], "out")
        yield change_for(group, [Serve(whom=group.whom)], "in")
        yield change_for(group, [Serve(whom=group.whom, alone=True)], "only")
        yield from _too(possible, group, group.whom)
        yield change_for(group, [Serve(whom=Everybody()), LeaveOut(whom=group.whom)], "all in but")
    yield changed_by([Serve(whom=Everybody())], "all in")


def _too(possible: Possible, group: Group, whom: Named) -> Iterator[Change]:
    """What was said last, of these users too, or of them instead."""
    if group.source != "last":
        yield from _of_these_too(possible, group, whom)
    past = () if possible.supposed else possible.context.past[-1:]
    of_users = [act for act in possible.context.acts if isinstance(act, Serve | LeaveOut)
                or (isinstance(act, Limit | Scale | Drop) and act.kind in FIGURES_OF_USERS)]  # fmt: skip
    for base in past if of_users else ():
        meant = [dataclasses.replace(act, whom=whom) if act in of_users else act for act in possible.context.acts]
        held = with_the_assumed(None if base is None else base.objective, possible.past[0], meant)
        acts = acts_between(possible.figures, changed(held, meant))
        if acts:
            yield change_for(group, acts, "instead")


def _of_these_too(possible: Possible, group: Group, whom: Named) -> Iterator[Change]:
    for limit in possible.last:
        if limit.kind in FIGURES_OF_USERS:
            acts = [dataclasses.replace(limit, whom=whom)]
            yield change_for(group, acts, "too", limit.kind)
            if {*whom.users} & {*possible.out}:  # "6 comes in as well, the same rate"
                yield change_for(group, [Serve(whom=whom), *acts], "in too", limit.kind)
    yield from stepped(possible, group, whom.users)
    for act in possible.said:
        if isinstance(act, Scale) and act.kind in FIGURES_OF_USERS:
            yield change_for(group, [dataclasses.replace(act, whom=whom)], "too scaled", act.kind)
        elif isinstance(act, Drop) and act.kind in possible.held and act.kind in FIGURES_OF_USERS:
            yield change_for(group, dropped(act.kind, whom, possible.figures, possible.users), "too dropped", act.kind)


def of_limits(possible: Possible) -> Iterator[Change]:
    for kind in (*FIGURES_OF_USERS, *OF_THE_CELL):
        if kind not in FIGURES_OF_USERS or kind not in possible.held:
            yield changed_by([Drop(kind=kind)], "drop", kind)
            continue
        for group in possible.groups:
            if isinstance(group.whom, Named):
                yield change_for(group, dropped(kind, group.whom, possible.figures, possible.users), "drop", kind)
                yield change_for(group, [Drop(kind=kind, whom=group.whom, own=True)], "drop own", kind)
            else:
                own = isinstance(group.whom, Others)
                yield change_for(group, [Drop(kind=kind, whom=group.whom, own=own)], "drop", kind)


def dropped(kind: str, whom: Named, figures: Mapping[Key, float], users: Sequence[str]) -> list[Act]:
    """A limit taken off some users; a ceiling of all is written out for the others, as there is none for nobody."""
    common = figures.get((kind, EVERYBODY))
    if kind != "max_rate_bps" or common is None:
        return [Drop(kind=kind, whom=whom)]
    kept = [user for user in users if user not in whom.users]
    return [Drop(kind=kind), *(Limit(kind=kind, value=figures.get((kind, user), common), whom=Named((user,)))
                               for user in kept)]  # fmt: skip
