"""Questions that name a figure are answered for that figure, with the offline recogniser."""

from __future__ import annotations

from typing import Any

import pytest
from conversations import LOSS, SCENE, SEED, PartlyScripted, means

from wirelessagent.agent.session import Session
from wirelessagent.agent.turn import Turn
from wirelessagent.model.units import human

pytestmark = pytest.mark.machine_code

HELD = "highest total rate, at most 10 W"


def answered(*lines: str) -> Turn:
    """The last turn of a conversation that changes nothing of what is held."""
    session = Session(SCENE, LOSS, seed=SEED, confirm=False)
    turns = [session.say(line) for line in (HELD, *lines)]
    assert session.request is not None
    assert dict(session.request.constraints) == {"max_power_w": 10.0}
    return turns[-1]


@pytest.mark.parametrize(
    ("said", "step"),
    [
        ("what would 5 more Mbit/s cost?", {"rate_bps": 5e6}),
        ("再多5兆要多少功率?", {"rate_bps": 5e6}),
        ("how much would 5 Mbit/s more for user 3 cost?", {"rate_bps": 5e6, "user": "3"}),
        ("3号再多5兆要多少功率?", {"rate_bps": 5e6, "user": "3"}),
        ("what would 100 kbit/s more each cost?", {"rate_bps": 1e5, "each": 1.0}),
        ("what would one more watt buy?", {"power_w": 1.0}),
        ("what would 2 W less cost?", {"power_w": -2.0}),
    ],
)
def test_a_step_is_the_one_that_is_named(said: str, step: dict[str, Any]) -> None:
    turn = answered(said)
    assert (turn.intent.topic, dict(turn.intent.details), turn.stage) == ("step", step, "answered")
    if "each" not in step:
        assert " W" in turn.reply


@pytest.mark.parametrize(
    "said",
    [
        "how much would 10 % less power cost?",
        "少10%功率会损失多少?",
        "what do we lose with 10 % less power?",
        "功率降10%会怎样?",
    ],
)
def test_a_share_less_is_solved_and_the_loss_told(said: str) -> None:
    turn = answered(said)
    assert turn.run is not None
    assert turn.run.decision.problem.max_power_w == 9.0
    assert "bit/s less than now (" in turn.reply or "比现在少 " in turn.reply


def test_a_budget_that_is_not_used_is_told() -> None:
    session = Session(SCENE, LOSS, seed=SEED, confirm=False)
    turns = [
        session.say(line) for line in ("least power with 100 kbit/s each", "what if at most 18 W?", "如果最多18瓦呢?")
    ]
    assert "A budget of 18 W changes nothing: only" in turns[1].reply
    assert "18 W 的预算不会改变什么" in turns[2].reply
    assert "changes nothing" not in answered("what if 10 % less power?").reply


def test_a_share_more_of_the_rate_is_told_in_watts() -> None:
    assert dict(answered("what would 10 % more rate cost?").intent.details) == {"rate_share": pytest.approx(0.1)}
    assert "W" in answered("速率提高10%要多少功率?").reply


@pytest.mark.parametrize(
    ("said", "power", "outage", "told"),
    [
        ("what's the most I could promise everyone at 10 W?", 10.0, 0.05, "each of the 4 users"),
        ("10瓦下最多能给每个人保证多少?", 10.0, 0.05, "这 4 个用户每人"),
        ("how much can we promise everyone at 99 %?", 10.0, 0.01, "99 %"),
        ("what can we promise at most?", 10.0, 0.05, "each of the 4 users"),
        ("最多能承诺多少?", 10.0, 0.05, "这 4 个用户每人"),
        ("最多能给每个人保证多少,不算3号", 10.0, 0.05, "这 3 个用户每人"),
        ("how much can I promise user 3 with 5 W?", 5.0, 0.05, "With 5 W, user 3"),
    ],
)
def test_the_most_that_can_be_promised_is_solved_and_proven(said: str, power: float, outage: float, told: str) -> None:
    turn = answered(said)
    assert turn.run is not None
    decision = turn.run.decision
    assert (decision.problem.max_power_w, decision.problem.outage_probability) == (power, outage)
    for figure in (told, human(decision.value, "bit/s"), human(decision.bound, "bit/s")):
        assert figure in turn.reply
    session = Session(SCENE, LOSS, seed=SEED, confirm=False)
    for line in (HELD, said, "do that"):
        session.say(line)
    assert session.request is not None
    assert session.request.constraints["outage_probability"] == outage


@pytest.mark.parametrize(
    "said", ["how many users get at most 1 Mbit/s?", "why does user 3 get the most?", "least power"]
)
def test_other_lines_ask_for_no_such_promise(said: str) -> None:
    session = Session(SCENE, LOSS, seed=SEED, confirm=False)
    assert "asked" not in [session.say(line) for line in (HELD, said)][-1].intent.details


@pytest.mark.parametrize(
    ("said", "columns", "limit", "values"),
    [
        ("compare 95 % and 99 %", ("95 %", "99 %"), "outage_probability", (0.05, 0.01)),
        ("可靠性95%和99%对比一下", ("95 %", "99 %"), "outage_probability", (0.05, 0.01)),
        ("compare 95, 99 and 99.9 %", ("95 %", "99 %", "99.9 %"), "outage_probability", (0.05, 0.01, 0.001)),
        ("which is better, 5 W or 8 W?", ("5 W", "8 W"), "max_power_w", (5.0, 8.0)),
        ("compare with 5 W", ("now", "5 W"), "max_power_w", (5.0,)),
        ("compare 50 % and 80 % of the power", ("5 W", "8 W"), "max_power_w", (5.0, 8.0)),
        ("compare 100 kbit/s and 200 kbit/s each", ("100 kbit/s", "200 kbit/s"), "min_rate_bps", (1e5, 2e5)),
    ],
)
def test_figures_are_compared_side_by_side(
    said: str, columns: tuple[str, ...], limit: str, values: tuple[float, ...]
) -> None:
    turn = answered(said)
    assert turn.tables[0].columns[1:] == columns
    stated = [value for key, value in turn.intent.details.items() if key.startswith("either_")]
    assert stated == [{limit: pytest.approx(value)} for value in values]
    assert all(f"{column}: " in turn.reply or f"{column}：" in turn.reply for column in columns[-1:])


def test_aims_and_several_methods_are_compared_side_by_side() -> None:
    assert len(answered("compare max rate and proportional fairness").tables[0].columns) == 3
    assert answered("compare with equal power and greedy").tables[0].columns[1:] == ("dual", "equal power", "greedy")
    assert answered("和论文的方法以及等功率比较").tables[0].columns[1:] == ("对偶法", "论文方法", "等功率法")
    assert answered("what's better, equal power or greedy?").tables[0].columns[2:] == ("equal power", "greedy")
    assert "Greedy: total rate" in answered("compare with greedy").reply


@pytest.mark.parametrize(
    ("said", "details"),
    [
        ("who gets the least?", {"rank": "least", "of": "rate"}),
        ("谁最少?", {"rank": "least", "of": "rate"}),
        ("who suffers most?", {"rank": "least", "of": "rate"}),
        ("谁最吃亏?", {"rank": "least", "of": "rate"}),
        ("who's the slowest?", {"rank": "least", "of": "rate"}),
        ("速率最低的是谁?", {"rank": "least", "of": "rate"}),
        ("who gets the most?", {"rank": "most", "of": "rate"}),
        ("谁的功率最大?", {"rank": "most", "of": "power"}),
        ("which user has the most subcarriers?", {"rank": "most", "of": "subcarriers"}),
        ("who is slowest right now?", {"rank": "least", "of": "rate"}),
        ("who uses up most of the power", {"rank": "most", "of": "power"}),
        ("谁用的电最多?", {"rank": "most", "of": "power"}),
        ("wer ist am langsamsten?", {"rank": "least", "of": "rate"}),
        ("¿quién recibe menos?", {"rank": "least", "of": "rate"}),
        ("qui a le moins de débit ?", {"rank": "least", "of": "rate"}),
        ("which subcarriers does user 3 have?", {"listed": "subcarriers", "user": "3"}),
        ("3号用户用哪些子载波?", {"listed": "subcarriers", "user": "3"}),
        ("user 3's subcarriers", {"listed": "subcarriers", "user": "3"}),
        ("列出每个用户的子载波", {"listed": "subcarriers"}),
        ("how many watts does user 3 use?", {"user": "3"}),
        ("3号用了多少功率?", {"user": "3"}),
        ("who has subcarrier 5?", {"subcarrier": 5.0}),
        ("5号子载波给了谁?", {"subcarrier": 5.0}),
    ],
)
def test_who_has_what_is_told_at_once(said: str, details: dict[str, Any]) -> None:
    turn = answered(said)
    assert (turn.intent.topic, dict(turn.intent.details)) == ("users", details)
    assert not turn.reply.startswith(("20 of 20", "20 个子载波中使用"))
    whole = "subcarrier" in details or details == {"listed": "subcarriers", "user": "3"}  # what the sentence says
    assert bool(turn.tables) != whole


@pytest.mark.parametrize("said", ["which subcarriers rest on repaired gains?", "who should get the most power?"])
def test_other_questions_of_users_are_left_to_the_recogniser(said: str) -> None:
    assert not {"rank", "listed", "subcarrier"} & set(answered(said).intent.details)


def test_weights_that_are_compared_are_no_powers() -> None:
    sides = {f"either_{number}": {"weights": {"2": number}} for number in (1.0, 3.0)}
    session = Session(
        SCENE,
        LOSS,
        seed=SEED,
        recogniser=PartlyScripted([("1 or 3?", means("command", topic="compare", details=sides))]),
    )
    turn = [session.say(line) for line in (HELD, "1 or 3?")][-1]
    assert turn.tables[0].columns[1:] == ("1", "3")
