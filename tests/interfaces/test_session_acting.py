"""Plan, confirm, apply, read back, compare with the promise, revert: on base stations that do as they please."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import cast

import numpy as np
import pytest
from conversations import LOSS, SCENE, SEED, Scripted, asks, means

import wirelessagent as wa
from wirelessagent.agent.acting import carry_out, same_allocation
from wirelessagent.agent.session import Session
from wirelessagent.agent.state import Site
from wirelessagent.agent.turn import Run, Tools, Turn
from wirelessagent.language.intent import Intent
from wirelessagent.language.recogniser import Context, Recogniser
from wirelessagent.language.request import Request
from wirelessagent.model.rates import user_rate_bps
from wirelessagent.operations.in_effect import followed
from wirelessagent.store.store import Store

YES, NO = means("command", topic="confirm"), means("command", topic="reject")
UNDO, APPLY, STATUS = (means("command", topic=topic) for topic in ("undo", "apply", "status"))
SAID = {"confirm": "yes", "apply": "apply it", "reject": "no"}
"""Only such words apply or refuse a plan, whatever a recogniser makes of others."""


@dataclass(frozen=True)
class Moody(wa.BaseStation):
    """A base station that does as its moods say, one per allocation; without moods it obeys."""

    name = "moody"

    scene: wa.Scene | None = SCENE
    moods: list[str] = field(default_factory=list[str])
    applied: list[wa.Decision] = field(default_factory=list[wa.Decision])

    def apply(self, decision: wa.Decision) -> wa.Outcome:
        self.applied.append(decision)
        mood = self.moods.pop(0) if self.moods else "obey"
        if mood == "raise":
            raise OSError("the radio link broke off half-way")
        assert self.scene is not None
        outcome = wa.SimulatedBaseStation(self.scene).apply(decision)
        half = np.arange(decision.owner.size) < decision.owner.size // 2
        match mood:
            case "drop power":
                return replace(outcome, power_w=outcome.power_w * 0.5)
            case "half":
                return replace(outcome, power_w=np.where(half, outcome.power_w, 0.0))
            case "swap":
                return replace(outcome, owner=np.where(half, (outcome.owner + 1) % 4, outcome.owner))
            case "cut":
                return replace(outcome, owner=outcome.owner[half], power_w=outcome.power_w[half])
            case "lists":
                return replace(outcome, owner=outcome.owner.tolist(), power_w=outcome.power_w.tolist())
            case "square":
                return replace(outcome, owner=outcome.owner[None], power_w=outcome.power_w[None])
            case "words":
                return cast(wa.Outcome, "done")
            case "figure in words":
                assert outcome.achieved is not None
                much = cast(float, "much")
                return replace(outcome, achieved=replace(outcome.achieved, sum_rate_bps=much))
            case "exit":
                raise SystemExit(3)
            case "colour":
                raise OSError("\x1b[31mlink\x07\ndown\x1b[0m")
            case "unmeasured":
                assert outcome.achieved is not None
                rate = outcome.achieved.user_rate_bps * np.nan
                return replace(outcome, achieved=replace(outcome.achieved, user_rate_bps=rate))
            case "fade" | "dip":
                assert outcome.achieved is not None
                rate = outcome.achieved.user_rate_bps * (0.8 if mood == "fade" else 0.95)
                return replace(outcome, achieved=replace(outcome.achieved, user_rate_bps=rate))
            case _:
                return outcome


class Knowing(Recogniser):
    """Means what stands in ``next``."""

    name = "scripted"

    def __init__(self, intents: Sequence[Intent]) -> None:
        self.next = intents[0]

    def read(self, text: str, context: Context | None = None) -> Intent:
        return self.next


def talk(station: wa.BaseStation | None, *intents: Intent, confirm: bool | None = False) -> tuple[Session, list[Turn]]:
    """A session after these turns, on a station that needs no yes unless it is said so."""
    script = Knowing(intents)
    session = Session(SCENE, LOSS, seed=SEED, recogniser=script, base_station=station, confirm=confirm)
    turns = list[Turn]()
    for script.next in intents:
        turns.append(session.say(SAID.get(script.next.topic or "", "…")))
    return session, turns


def run_of(objective: str, method: str | None = None, **constraints: object) -> Run:
    """A plan on the scene, by a method of one's choice."""
    tools = Tools(method=method)
    request = Request(objective=objective, constraints=constraints)  # type: ignore[arg-type]
    return Site(SCENE, (LOSS,), seed=SEED, tools=tools).plan(asks(objective), request)


def applied(run: Run) -> Run:
    return run.with_outcome(wa.SimulatedBaseStation(SCENE).apply(run.decision))


@pytest.mark.parametrize(
    ("mood", "told"),
    [
        ("drop power", "It radiates 2.5 W instead of 5 W"),
        ("half", "instead of 5 W"),
        ("swap", "10 of 20 subcarriers serve somebody else"),
        ("cut", "10 subcarriers instead of 20"),
        ("raise", "The base station moody failed: the radio link broke off half-way."),
        ("fade", "promised arrive, 2"),
        ("unmeasured", "promised arrive, 100 % too little"),
        ("lists", "The base station moody reports something that is no allocation."),
        ("square", "reports something that is no allocation."),
        ("words", "reports something that is no allocation."),
        ("figure in words", "reports something that is no allocation."),
        ("exit", "The base station moody failed: 3."),
        ("colour", "The base station moody failed: link down."),
    ],
)
def test_what_is_not_as_decided_or_promised_is_taken_back(mood: str, told: str) -> None:
    station = Moody(moods=["obey", mood])
    session, turns = talk(station, asks("max_rate", max_power_w=10.0), asks("max_rate", max_power_w=5.0), STATUS)
    assert [turn.stage for turn in turns[:2]] == ["applied", "reverted"]
    assert told in turns[1].reply
    assert "The last good allocation is in effect again: 10 W" in turns[1].reply
    first, bad = turns[0].run, turns[1].run
    assert first is not None
    assert bad is not None
    assert turns[1].restored is not None
    assert np.array_equal(turns[1].restored.power_w, first.decision.power_w)
    assert [decision.total_power_w for decision in station.applied] == pytest.approx([10, 5, 10])
    assert (bad.outcome is None) == (mood in ("raise", "lists", "square", "words", "figure in words", "exit", "colour"))
    assert session.state.on_air is first
    assert session.request == Request(objective="max_rate", constraints={"max_power_w": 5.0})
    assert "In effect: 10 W" in turns[2].reply


def test_what_was_taken_back_is_exported_as_deactivated() -> None:
    asked = (asks("max_rate", max_power_w=10.0), asks("max_rate", max_power_w=5.0), means("command", topic="export"))
    _, turns = talk(Moody(moods=["obey", "half"]), *asked)
    assert '"DEACTIVATED"' in turns[-1].reply
    _, turns = talk(Moody(), *asked)
    assert '"ACTIVATED"' in turns[-1].reply


def test_a_reverted_request_can_be_applied_again_or_undone() -> None:
    station = Moody(moods=["obey", "half"])
    session, turns = talk(station, asks("max_rate", max_power_w=10.0), asks("max_rate", max_power_w=5.0), APPLY)
    assert turns[2].stage == "applied"
    assert session.state.on_air is turns[2].run
    station = Moody(moods=["obey", "half"])
    session, turns = talk(station, asks("max_rate", max_power_w=10.0), asks("max_rate", max_power_w=5.0), UNDO)
    assert turns[2].stage == "undone"
    assert len(station.applied) == 3  # the revert put it back already
    assert session.request == Request(objective="max_rate", constraints={"max_power_w": 10.0})


@pytest.mark.parametrize(("mood", "stage"), [("half", "applied"), ("raise", "nothing"), ("fade", "applied")])
def test_without_an_earlier_allocation_there_is_nothing_to_go_back_to(mood: str, stage: str) -> None:
    session, (turn,) = talk(Moody(moods=[mood]), asks("max_rate"))
    assert turn.stage == stage
    assert "no earlier allocation to go back to" in turn.reply
    assert session.state.last_good is None
    assert (session.state.on_air is None) == (mood != "fade")


def test_a_revert_that_fails_is_told_and_what_is_in_effect_is_not_known() -> None:
    station = Moody(moods=["obey", "half", "raise"])
    session, turns = talk(station, asks("max_rate"), asks("max_rate", max_power_w=5.0), asks("max_rate"))
    assert turns[1].stage == "applied"
    assert "could not be put back: The base station moody failed" in turns[1].reply
    assert turns[1].restored is None
    assert turns[2].stage == "applied"  # what is in effect is not known, so it is not "nothing to change"
    assert session.state.on_air is turns[2].run


def test_what_cannot_be_told_after_an_undo_is_trouble_and_no_traceback() -> None:
    station = Moody(moods=["obey", "obey", "figure in words"])
    session, turns = talk(station, asks("max_rate", max_power_w=10.0), asks("max_rate", max_power_w=5.0), UNDO)
    assert turns[2].stage == "undone"
    assert "reports something that is no allocation" in turns[2].reply
    assert session.state.on_air is None


def test_after_a_revert_that_failed_status_tells_that_it_is_not_known_and_what_was_read_back() -> None:
    for moods, read in ((["raise", "raise"], "nothing"), (["half", "drop power"], "5 W on 20 of 20 subcarriers")):
        station = Moody(moods=["obey", *moods])
        ten, five = (asks("max_rate", max_power_w=power) for power in (10.0, 5.0))
        session, turns = talk(station, ten, five, STATUS)
        assert session.state.on_air is None
        assert "What is in effect is not known" in turns[2].reply
        assert f"Reported since: {read}." in turns[2].reply
        _, turns = talk(Moody(), ten, STATUS)
        assert "In effect: 10 W" in turns[1].reply


def test_a_few_missed_promises_are_chance_and_many_are_not() -> None:
    for outage, faults in ((0.05, 1), (0.9, 0), (None, 1)):
        constraints = {} if outage is None else {"outage_probability": outage}
        run = run_of("min_power", min_rate_bps=1e6, **constraints)
        effect = carry_out(run, Moody(moods=["dip"]), None)
        assert len(effect.faults) == faults, effect.faults
        assert all("4 of 4 promises are missed, more than a reliability of 95 %" in fault for fault in effect.faults)


def test_the_tolerance_is_as_it_was_set() -> None:
    run = run_of("min_power", min_rate_bps=1e6, outage_probability=0.9)
    assert not carry_out(run, Moody(moods=["dip"]), None, tolerance=0.1).faults
    assert len(carry_out(run, Moody(moods=["dip"]), None, tolerance=0.01).faults) == 1
    assert not carry_out(run, Moody(moods=["fade"]), None, tolerance=0.3).faults


def test_what_is_worse_than_before_for_the_same_request_is_taken_back() -> None:
    good, poor = applied(run_of("max_rate")), run_of("max_rate", "round_robin")
    station = Moody()
    effect = carry_out(poor, station, good)
    assert len(effect.faults) == 1
    assert "does better on the same channel" in effect.faults[0]
    assert effect.restored is not None
    assert np.array_equal(effect.restored.power_w, good.decision.power_w)
    saving, wasting = applied(run_of("min_power", min_rate_bps=1e6)), run_of("max_rate", min_rate_bps=1e6)
    assert not carry_out(wasting, Moody(), saving).faults
    assert not carry_out(run_of("min_power", min_rate_bps=1e6), Moody(), applied(wasting)).faults


def weakened(run: Run) -> Run:
    """The same plan at a third of its power, with the rates that the true channel then carries."""
    plain, truth = run.decision, SCENE.current_truth
    assert truth is not None
    power = plain.power_w * 0.3
    rate = user_rate_bps(truth, plain.owner, power, plain.cell)
    return replace(run, decision=replace(plain, power_w=power, rate_bps=rate, estimate=None))


@pytest.mark.parametrize(
    ("constraints", "faults"),
    [
        ({}, 1),
        ({"max_power_w": 12.0}, 0),
        ({"leave_out": ("2",)}, 0),
        ({"leave_out": ("3",)}, 1),
        ({"min_rate_bps": {"3": 1e5}}, 0),
        ({"subcarrier_max_power_w": 0.8}, 0),
        ({"resource_block_group_size": 4.0}, 0),
        ({"max_rate_bps": 5e6}, 0),
    ],
    ids=str,
)
def test_what_was_before_is_a_measure_where_it_keeps_the_request(constraints: dict[str, object], faults: int) -> None:
    good = applied(run_of("max_rate"))
    assert len(carry_out(weakened(run_of("max_rate", **constraints)), Moody(), good).faults) == faults


def test_another_channel_is_no_measure() -> None:
    good, poor = applied(run_of("max_rate")), run_of("max_rate", "round_robin")
    assert SCENE.truth is not None
    elsewhere = replace(good, scene=replace(SCENE, truth=SCENE.truth * 2))
    assert not carry_out(poor, Moody(), elsewhere).faults


def test_the_same_allocation_is_the_same_within_rounding() -> None:
    decision = run_of("max_rate").decision
    nudged = replace(decision, power_w=decision.power_w * (1 + 1e-12))
    assert same_allocation(decision, nudged)
    assert not same_allocation(decision, replace(decision, power_w=decision.power_w * 0.999))
    assert not same_allocation(decision, replace(decision, owner=np.roll(decision.owner, 1)))
    certain = replace(decision, estimate=None)
    assert not same_allocation(certain, replace(certain, rate_bps=certain.rate_bps * 0.9))


def test_nothing_is_applied_before_a_yes() -> None:
    station = Moody()
    session, (turn,) = talk(station, asks("max_rate", max_power_w=5.0), confirm=None)
    assert turn.stage == "planned"
    assert turn.reply.endswith("Apply it?")
    assert session.state.awaits == "confirmation"
    assert station.applied == []
    session, turns = talk(station, asks("max_rate", max_power_w=5.0), STATUS, YES, YES, confirm=None)
    assert [turn.stage for turn in turns] == ["planned", "answered", "applied", "answered"]
    assert "waits for your yes" in turns[1].reply
    assert "Nothing waits" in turns[3].reply
    assert len(station.applied) == 1
    assert session.state.on_air is turns[2].run
    assert session.state.awaits == "nothing"


def test_after_a_no_the_request_stands_and_can_be_changed_or_applied() -> None:
    station = Moody()
    session, turns = talk(station, asks("max_rate", max_power_w=5.0), NO, NO, confirm=None)
    assert [turn.stage for turn in turns] == ["planned", "nothing", "answered"]
    assert station.applied == []
    assert session.request == Request(objective="max_rate", constraints={"max_power_w": 5.0})
    _, turns = talk(station, asks("max_rate", max_power_w=5.0), NO, APPLY, confirm=None)
    assert turns[2].stage == "applied"
    _, turns = talk(station, asks("max_rate"), asks("max_rate", amends=True, max_power_w=4.0), YES, confirm=None)
    assert turns[2].run is not None
    assert turns[2].run.decision.total_power_w == pytest.approx(4)


def test_a_yes_after_a_question_back_applies_nothing() -> None:
    station = Moody()
    unclear = means("clarify", reply="Which aim?")
    unknown = asks("max_rate", amends=True, leave_out=("9",))
    for between in (unclear, unknown):
        _, turns = talk(station, asks("max_rate"), between, YES, confirm=None)
        assert [turn.stage for turn in turns] == ["planned", "asked", "answered"]
    assert station.applied == []


def test_an_undo_asks_before_it_puts_something_back() -> None:
    station = Moody()
    start = asks("max_rate", max_power_w=10.0), YES, asks("max_rate", amends=True, max_power_w=5.0), YES, UNDO
    session, turns = talk(station, *start, YES, confirm=None)
    assert [turn.stage for turn in turns[3:]] == ["applied", "planned", "undone"]
    assert "Put the earlier allocation back (10 W" in turns[4].reply
    assert [decision.total_power_w for decision in station.applied] == pytest.approx([10, 5, 10])
    assert session.state.on_air is not None
    assert session.state.on_air.decision.total_power_w == pytest.approx(10)
    session, turns = talk(Moody(), *start, NO, confirm=None)
    assert session.request == Request(objective="max_rate", constraints={"max_power_w": 10.0})
    assert session.state.on_air is not None
    assert session.state.on_air.decision.total_power_w == pytest.approx(5)


def test_simulated_cells_apply_at_once_unless_they_are_to_ask() -> None:
    assert talk(None, asks("max_rate"), confirm=None)[1][0].stage == "applied"
    assert talk(None, asks("max_rate"), confirm=True)[1][0].stage == "planned"
    assert talk(Moody(), asks("max_rate"), confirm=False)[1][0].stage == "applied"


def test_without_a_base_station_plans_are_made() -> None:
    blind = replace(SCENE, truth=None)
    session = Session(blind, LOSS, seed=SEED, recogniser=Scripted([asks("max_rate"), APPLY]))
    first, second = session.say("…"), session.say("apply it")
    assert (first.stage, second.stage) == ("planned", "nothing")
    assert "true channel is not known" in first.reply
    assert "true channel is not known" in second.reply


class _Interrupted(wa.BaseStation):
    """Applies what it is told, and is interrupted on the way from its third time on, or its reader is."""

    name = "interrupted"

    def __init__(self) -> None:
        self.told = 0

    def apply(self, decision: wa.Decision) -> wa.Outcome:
        self.told += 1
        outcome = wa.SimulatedBaseStation(SCENE).apply(decision)
        if self.told > 2:
            raise KeyboardInterrupt
        return outcome


@pytest.mark.parametrize("last", [asks("max_rate", max_power_w=1.0), means("command", topic="undo")])
def test_after_an_interruption_it_is_not_known_what_is_in_effect(last: Intent, tmp_path: Path) -> None:
    station, script = _Interrupted(), Knowing([last])
    with Store.open(tmp_path / "audit.sqlite3", create=True) as store:
        session = Session(SCENE, LOSS, seed=SEED, recogniser=script, base_station=station, confirm=False, store=store)
        for script.next in (asks("max_rate", max_power_w=5.0), asks("max_rate", max_power_w=2.0)):
            session.say("…")
        before = session.request
        script.next = last
        with pytest.raises(KeyboardInterrupt):
            session.say("…")
        assert session.state.on_air is None
        assert session.request == before
        assert (session.turns[-1].stage, session.turns[-1].restored) == ("nothing", None)
        assert [turn.stage for turn in store.turns()] == ["applied", "applied", "nothing"]
        assert list(followed(store.turns()))[-1].after is None
        script.next = STATUS
        assert "What is in effect is not known" in session.say("…").reply


def test_an_interruption_before_the_base_station_was_told_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    session, _ = talk(Moody(), asks("max_rate", max_power_w=5.0))

    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("wirelessagent.chain.decide", interrupted)
    state = session.state
    with pytest.raises(KeyboardInterrupt):
        session.say("…")
    assert session.state.on_air is state.on_air
    assert len(session.turns) == 1


@dataclass(frozen=True)
class Rounding(wa.BaseStation):
    """Sets power in steps and does not say so."""

    name = "rounding"

    scene: wa.Scene | None = SCENE
    step_w: float = 1.0

    def apply(self, decision: wa.Decision) -> wa.Outcome:
        rounded = np.ceil(decision.power_w / self.step_w) * self.step_w
        return replace(self.read_back(decision), power_w=rounded)


def test_steps_that_a_base_station_states_are_no_difference() -> None:
    run = run_of("min_power", min_rate_bps=1e5)
    step_w = 0.1 * float(np.median(run.decision.power_w[run.decision.power_w > 0]))
    coarse = wa.SimulatedBaseStation(SCENE, power_resolution_w=step_w)
    read = coarse.apply(run.decision).power_w
    assert np.abs(read - run.decision.power_w).sum() > 1e-3 * run.decision.total_power_w
    assert carry_out(run, coarse, None).as_decided
    assert not carry_out(run, Rounding(step_w=step_w), None).as_decided
