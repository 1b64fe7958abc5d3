"""Acts on a request: what they change is what the diff says, and nothing that was asked for vanishes in silence."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from wirelessagent.language.acts import (
    Act,
    Aim,
    Apply,
    AskProof,
    Drop,
    Everybody,
    Forget,
    LeaveOut,
    Limit,
    Named,
    Others,
    Prefer,
    Scale,
    Serve,
    Suppose,
    Whom,
    act_of,
    shown,
)  # fmt: skip
from wirelessagent.language.intent import EVERYBODY, LISTS_OF_USERS
from wirelessagent.language.request import (
    Change,
    Diff,
    Request,
    acts_between,
    applied,
    changed,
    constraints_of,
    difference,
    figures_of,
)  # fmt: skip

USERS = ("1", "2", "3", "4")
OF_USERS = ("min_rate_bps", "max_rate_bps", "weights")
OF_THE_CELL = ("max_power_w", "circuit_power_w", "subcarrier_max_power_w")
AIMS = ("max_rate", "min_power", "max_energy_efficiency", "proportional_fairness", "max_min_rate")

named = st.lists(st.sampled_from(USERS), min_size=1, max_size=2, unique=True).map(lambda users: Named(tuple(users)))
whom: st.SearchStrategy[Whom] = st.one_of(st.just(Everybody()), st.just(Others()), named)
figures = st.sampled_from((1.0, 2.0, 5e5, 1e6))


def limit_acts() -> st.SearchStrategy[Act]:
    of_users = st.builds(lambda kind, who, value: Limit(kind=kind, value=value, whom=who),
                         st.sampled_from(OF_USERS), whom, figures)  # fmt: skip
    of_the_cell = st.builds(lambda kind, value: Limit(kind=kind, value=value), st.sampled_from(OF_THE_CELL), figures)
    return of_users | of_the_cell


changing: st.SearchStrategy[Act] = st.one_of(
    st.builds(lambda aim: Aim(objective=aim), st.sampled_from(AIMS)),
    limit_acts(),
    st.builds(lambda kind, who: Drop(kind=kind, whom=who), st.sampled_from(OF_USERS), whom),
    st.builds(lambda kind: Drop(kind=kind), st.sampled_from(OF_THE_CELL)),
    st.builds(lambda kind, factor, who: Scale(kind=kind, factor=factor, whom=who),
              st.sampled_from(OF_USERS), st.sampled_from((0.5, 2.0)), whom),
    st.builds(lambda factor: Scale(kind="max_power_w", factor=factor, reference="radiated"), st.just(0.5)),
    st.builds(lambda who, alone: Serve(whom=who, alone=alone), named | st.just(Everybody()), st.booleans()),
    st.builds(lambda who: LeaveOut(whom=who), named),
    st.builds(lambda name: Prefer(method=name), st.sampled_from(("dual", ""))),
    st.just(Forget()),
)  # fmt: skip
idle: st.SearchStrategy[Act] = st.sampled_from(
    (Suppose(acts=(Limit(kind="max_power_w", value=1.0),)), AskProof(), Apply())
)
lines = st.lists(st.lists(changing | idle, min_size=1, max_size=3), min_size=1, max_size=6)


_INSTEAD: list[Act] = [
    Serve(whom=Named(("1",)), alone=True), LeaveOut(whom=Named(("1",))), Serve(whom=Named(("2",)))
]  # fmt: skip


def requests_after(said: list[list[Act]]) -> list[tuple[Request | None, list[Act], Request | None]]:
    before: Request | None = Request(objective="max_rate")
    found: list[tuple[Request | None, list[Act], Request | None]] = []
    for acts in said:
        after, _ = applied(before, acts, radiated_w=3.0)
        found.append((before, acts, after))
        before = after
    return found


def same(one: Request | None, other: Request | None) -> bool:
    """Whether two requests ask for the same, in whatever order their users were named."""
    if one is None or other is None:
        return one is other
    heads = (one.objective, one.method) == (other.objective, other.method)
    return heads and figures_of(one.constraints) == figures_of(other.constraints)


def covered(diff: Diff, acts: Sequence[Act]) -> bool:
    """Whether an act took off each limit that is gone: nothing vanishes in silence."""
    return all(any(_takes_off(act, one) for act in acts) for one in diff.changes if one.after is None)


def _takes_off(act: Act, change: Change) -> bool:
    if isinstance(act, Forget):
        return True
    if isinstance(act, Serve | LeaveOut):
        return change.kind in LISTS_OF_USERS
    if isinstance(act, Drop | Limit):  # a figure for everybody is in the place of those of named users
        named = isinstance(act.whom, Named) and change.user not in act.whom.users
        others = isinstance(act.whom, Others) and (isinstance(act, Limit) or change.user != EVERYBODY)
        return act.kind == change.kind and not named and not others
    return False


def made_of(before: Request | None, diff: Diff) -> Request | None:
    """The request that a diff makes of the one before it."""
    if diff.objective[1] is None:
        return None
    figures = {} if before is None else figures_of(before.constraints)
    for one in diff.changes:
        figures.pop((one.kind, one.user), None)
        if one.after is not None:
            figures[one.kind, one.user] = one.after
    return Request(objective=diff.objective[1], constraints=constraints_of(figures), method=diff.method[1])


@given(lines)
def test_the_diff_makes_the_new_request_of_the_old_and_back(said: list[list[Act]]) -> None:
    for before, acts, after in requests_after(said):
        _, diff = applied(before, acts, radiated_w=3.0)
        assert same(made_of(before, diff), after)
        assert same(made_of(after, difference(after, before)), before), "undo is an inverse"


@given(lines)
def test_no_limit_goes_without_an_act_that_takes_it_off(said: list[list[Act]]) -> None:
    for before, acts, _ in requests_after(said):
        _, diff = applied(before, acts, radiated_w=3.0)
        assert covered(diff, acts), (diff.gone, acts)


@given(lines, st.lists(idle, min_size=1))
def test_questions_and_suppositions_change_nothing(said: list[list[Act]], acts: list[Act]) -> None:
    request = requests_after(said)[-1][2]
    after, diff = applied(request, acts)
    assert (after, diff.changes) == (request, ())


@given(lines, limit_acts())
def test_a_limit_said_twice_is_a_limit_said_once(said: list[list[Act]], act: Act) -> None:
    once, _ = applied(requests_after(said)[-1][2], [act])
    again, diff = applied(once, [act])
    assert (again, diff.changes) == (once, ())


def after(before: dict[str, Any], *acts: Act, radiated_w: float = 0.0) -> dict[str, Any]:
    request, _ = applied(Request(objective="max_rate", constraints=before), acts, radiated_w=radiated_w)
    assert request is not None
    return dict(request.constraints)


RATE = "min_rate_bps"


@pytest.mark.parametrize(
    ("before", "act", "expected"),
    [
        ({RATE: {"6": 1.5e6}}, Limit(kind=RATE, value=3e5, whom=Others()), {RATE: {"6": 1.5e6, "all": 3e5}}),
        ({RATE: {"6": 1.5e6, "all": 2e5}}, Limit(kind=RATE, value=3e5), {RATE: 3e5}),
        ({RATE: 2e5}, Limit(kind=RATE, value=1e6, whom=Named(("user 2",))), {RATE: {"all": 2e5, "2": 1e6}}),
        ({RATE: 2e5}, Drop(kind=RATE, whom=Named(("2",))), {RATE: {"all": 2e5, "2": 0.0}}),
        ({RATE: {"2": 2e5}}, Drop(kind=RATE, whom=Named(("2",))), {}),
        ({"users": ("1", "7")}, LeaveOut(whom=Named(("7",))), {"users": ("1",)}),
        ({"leave_out": ("1", "7")}, Serve(whom=Named(("7",))), {"leave_out": ("1",)}),
        ({"users": ("1",)}, Serve(whom=Named(("7",))), {"users": ("1", "7")}),
        ({"leave_out": ("1",)}, Serve(whom=Named(("2",)), alone=True), {"users": ("2",)}),
        ({"users": ("1",)}, Serve(whom=Everybody()), {}),
        ({}, Scale(kind="max_power_w", factor=0.5, reference="radiated"), {"max_power_w": 1.0}),
        ({RATE: {"all": 1.0, "3": 2.0}}, Scale(kind=RATE, factor=2, whom=Named(("3",))), {RATE: {"all": 1, "3": 4}}),
    ],
)  # fmt: skip
def test_acts_do_what_they_say(before: dict[str, Any], act: Act, expected: dict[str, Any]) -> None:
    found = after(before, act, radiated_w=2.0)
    assert {name: dict(value) if hasattr(value, "items") else value for name, value in found.items()} == expected


def test_who_is_served_instead_of_the_last_one_left_is_the_only_one() -> None:
    assert changed({}, _INSTEAD) == {("users", "2"): 1.0}


def test_a_rate_assumed_for_each_user_holds_for_the_others() -> None:
    request, _ = applied(Request(objective="min_power"), [Limit(kind=RATE, value=1e6, whom=Named(("3",)))])
    assert request is not None
    assert request.constraints[RATE] == {"all": 2e5, "3": 1e6}


@given(st.from_type(Act))
def test_an_act_that_is_shown_can_be_read_again(act: Act) -> None:
    assert repr(act_of(json.loads(json.dumps(shown(act))))) == repr(act)


listless = st.lists(changing, max_size=5).map(lambda acts: [act for act in acts if not isinstance(act, Aim | Forget)])


@example([], _INSTEAD)
@example(
    [Serve(whom=Named(("1",)), alone=True), LeaveOut(whom=Named(("1", "2")))], [Serve(whom=Named(("1",)), alone=True)]
)
@given(listless, listless)
def test_acts_between_two_requests_make_one_of_the_other(one: list[Act], other: list[Act]) -> None:
    before, after = (changed({}, acts, radiated_w=3.0) for acts in (one, other))
    made = changed(before, acts_between(before, after))
    served = {user for kind, user in after if kind == "users"}
    lists = {key for key in {*made, *after} if key[0] == "leave_out" and served}  # a list of who is served says it all
    assert {key: made[key] for key in made.keys() - lists} == {key: after[key] for key in after.keys() - lists}
