"""What a conversation answers: figures solved for, users by name, and nothing English in a Chinese sentence."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from conversations import LOSS, SCENE, SEED, Scripted, asks, means

import wirelessagent as wa
from wirelessagent.agent.turn import Turn, restated
from wirelessagent.language.intent import Intent
from wirelessagent.language.request import Request
from wirelessagent.model.units import human
from wirelessagent.telling.parts import cannot_be_served

pytestmark = pytest.mark.machine_code

_FIGURE_OR_UNIT = re.compile(r"Mbit|kbit|bit|µW|mW|MW|kW|dB|Hz|Jain|PF|ts28312|tmf921|TMF921|TS|GPP|quit|CSI")


def talk(*intents: Intent, scene: wa.Scene = SCENE) -> tuple[Turn, ...]:
    session = wa.Session(scene, LOSS, seed=SEED, recogniser=Scripted(intents))
    return tuple(session.say(f"line {number}") for number in range(len(intents)))


def question(topic: str, language: str = "en", **details: Any) -> Intent:
    return means("question", topic=topic, language=language, details=details)


def english_in(turn: Turn) -> list[str]:
    """Latin words that are neither figures nor units, of what is said and shown."""
    cells = [cell for table in turn.tables for cell in (table.title, *table.columns, *sum(table.rows, ()))]
    said = _FIGURE_OR_UNIT.sub("", " ".join([turn.reply.replace("line", ""), *cells]).replace("line", ""))
    return re.findall(r"[A-Za-z_]{3,}", said)


def test_what_is_said_in_chinese_has_no_english_words() -> None:
    zh, few = "zh", {"resource_block_group_size": 32.0}
    told = talk(
        asks("max_rate", language=zh, max_power_w=10.0),
        *(question(topic, zh) for topic in ("certificate", "uncertainty", "prices", "users", "other")),
        question("why_user", zh, user="1"), question("why_user", zh, user="3"), question("users", zh, user="2"),
        question("why_user", zh), question("why_user", zh, user="9"), question("why_user", zh, user="2", rate_bps=1e6),
        question("step", zh, power_w=5.0), question("step", zh, rate_bps=1e5, user="2"),
        question("step", zh, users=1.0),
        question("what_if", zh, constraints={"max_power_w": 50.0}), question("what_if", zh, objective="min_power"),
        question("what_if", zh, missing_share=0.4), question("what_if", zh, constraints={"min_rate_bps": 1e9}),
        means("command", topic="compare", language=zh, details={"with": "greedy,kriging,paper_inversion,paper_scan"}),
        means("command", topic="explain", language=zh), means("command", topic="status", language=zh),
        means("command", topic="history", language=zh), means("command", topic="undo", language=zh),
        asks("proportional_fairness", language=zh, **few), means("command", topic="explain", language=zh),
        asks("max_energy_efficiency", language=zh, amends=True, circuit_power_w=1e-9, weights={"2": 2.0}),
        asks("max_rate", language=zh, min_rate_bps=1e9), question("why_infeasible", zh), question("prices", zh),
        means("command", topic="explain", language=zh), question("step", zh, power_w=1.0),
        asks("min_power", language=zh, min_rate_bps=3e6, subcarrier_max_power_w=1e-4), question("why_infeasible", zh),
        asks("max_min_rate", language=zh, leave_out=("1",), users=("1", "2")), question("step", zh, users=1.0),
    )  # fmt: skip
    assert {turn.reply: english_in(turn) for turn in told if english_in(turn)} == {}


@pytest.mark.parametrize("language", ["en", "zh"])
def test_whether_a_user_can_get_a_rate_is_solved_for(language: str) -> None:
    asked, can, cannot = talk(
        asks("max_rate", language=language, max_power_w=10.0),
        question("why_user", language, user="4", rate_bps=1e6),
        question("other", language, rate_bps=1e8),
    )
    assert can.run is not None
    assert asked.run is not None
    assert can.run.decision.rate_bps[3] >= 1e6 * (1 - 1e-9)
    value = can.run.decision.value
    for figure in (value, asked.run.decision.value - value):
        assert human(figure, "bit/s") in can.reply
    assert cannot.run is not None
    assert cannot.run.decision.status == "infeasible"
    best = wa.decide(cannot.run.estimate, wa.Problem("max_min_rate", max_power_w=10.0, outage_probability=0.05))
    offered = [float(found) for found in re.findall(r"\d\. \D*([\d.]+) Mbit/s", cannot.reply)]
    assert any(figure == pytest.approx(best.value / 1e6, rel=0.02) for figure in offered)
    assert all(
        ("没有作任何更改" if language == "zh" else "Nothing was changed") in turn.reply for turn in (can, cannot)
    )


def test_values_are_put_beside_each_other_where_they_mean_the_same() -> None:
    _, same, weighted, power = talk(
        asks("max_rate", max_power_w=10.0),
        question("what_if", constraints={"max_power_w": 5.0}),
        question("what_if", constraints={"weights": {"2": 2.0}}),
        question("what_if", objective="min_power"),
    )
    assert ["than now" in turn.reply for turn in (same, weighted, power)] == [True, False, False]


def test_a_what_if_says_what_it_assumes_beside_what_holds() -> None:
    _, above, again = talk(
        asks("min_power", min_rate_bps=1e5),
        question("what_if", constraints={"max_power_w": 50.0}),
        question("what_if", constraints={"max_power_w": 10.0}),
    )
    assert "above the cell's limit of 20 W" in above.reply
    assert ".." not in above.reply
    assert "Note" not in again.reply


@pytest.mark.parametrize("language", ["en", "zh"])
def test_a_question_about_a_users_share_is_answered_with_that_users_figures(language: str) -> None:
    asked, told = talk(asks("max_min_rate", language=language), question("users", language, user="2"))
    assert asked.run is not None
    decision = asked.run.decision
    power = float(decision.power_w[decision.owner == 1].sum())
    assert human(float(decision.rate_bps[1]), "bit/s") in told.reply
    assert human(power, "W") in told.reply
    assert [len(table.rows) for table in told.tables] == [1]


def test_one_more_user_is_the_best_of_those_left_out_or_not_known() -> None:
    asked, more, _, nobody, _, unmet = talk(
        asks("max_rate", leave_out=("1", "2"), max_power_w=10.0),
        question("step", users=1.0),
        means("allocate", "max_rate", amends=True, dropped=("leave_out",)),
        question("step", users=1.0),
        asks("max_rate", min_rate_bps=1e8),
        question("step", users=1.0),
    )
    assert asked.run is not None
    values = {
        user: wa.decide(
            asked.run.estimate, wa.Problem("max_rate", users=(f"user {user + 1}", "user 3", "user 4"), max_power_w=10.0)
        ).value
        for user in (0, 1)
    }
    best = max(values, key=lambda user: values[user])
    assert f"user {best + 1}" in more.reply.lower()
    assert human(values[best], "bit/s") in more.reply
    assert "All 4 users" in nobody.reply
    assert "What can be met" in unmet.reply


def test_a_method_that_does_not_solve_it_says_what_it_does_not_know() -> None:
    _, compared = talk(
        asks("max_rate", weights={"2": 2.0}, max_power_w=10.0),
        means("command", topic="compare", details={"with": "paper_inversion,paper_bisection"}),
    )
    assert "The paper's inversion does not aim for that: the highest total rate." in compared.reply
    assert "The paper's bisection knows nothing of weights." in compared.reply


def test_who_cannot_be_served_is_counted_in_both_languages() -> None:
    crowd = wa.perfect(wa.simulate("rayleigh", num_users=4, num_subcarriers=3, seed=1))
    decision = wa.decide(crowd, wa.Problem("proportional_fairness"))
    assert cannot_be_served(decision) == "1 of 4 users cannot be served: there are only 3 subcarriers"
    assert cannot_be_served(decision, "zh") == "4 个用户中有 1 个无法服务：只有 3 个子载波"
    assert np.count_nonzero(decision.rate_bps) == 3


def test_the_same_figures_of_several_users_are_told_together() -> None:
    weights = Request(objective="max_rate", constraints={"weights": {"3": 2.0, "user 4": 2.0, "all": 0.5}})
    assert restated(weights) == "The highest total rate: weight 2 for user 3 and user 4, weight 0.5 for everyone else."
    assert restated(weights, "zh") == "总速率最高：用户3和用户4的权重为 2，其余用户的权重为 0.5。"
    three = Request(objective="min_power", constraints={"min_rate_bps": {"all": 1e6}, "leave_out": ("1", "2", "eve")})
    assert restated(three) == "The least power: at least 1 Mbit/s for each user, without user 1, user 2 and eve."
    assert restated(three, "zh") == "功率最低：每个用户至少 1 Mbit/s，不服务用户1、用户2和eve。"


@pytest.mark.parametrize(("language", "figure"), [("en", "weighted total rate"), ("zh", "加权总速率")])
def test_a_value_that_is_not_what_its_unit_says_is_named(language: str, figure: str) -> None:
    weighted, plain, lowest = talk(
        asks("max_rate", language=language, weights={"2": 3.0}),
        means("allocate", "max_rate", language=language, amends=True, dropped=("weights",)),
        asks("max_min_rate", language=language),
    )
    assert weighted.run is not None
    assert f"{figure} {human(weighted.run.decision.value, 'bit/s')}".lower() in weighted.reply.lower()
    assert figure not in plain.reply
    assert ("lowest rate" if language == "en" else "最低速率") in lowest.reply.lower()


@pytest.mark.parametrize("language", ["en", "zh"])
def test_weights_that_leave_nobody_are_asked_about(language: str) -> None:
    nobody, served = talk(
        asks("max_rate", language=language, weights={"all": 0.0}),
        asks("max_rate", language=language, weights={"1": 0.0}, users=("1",)),
    )
    assert [nobody.stage, served.stage] == ["asked", "asked"]
    assert "0" in nobody.reply
    assert english_in(nobody) == [] or language == "en"


def test_what_a_user_costs_is_told_of_that_user() -> None:
    asked, told = talk(asks("min_power", min_rate_bps=1e6), question("prices", user="2"))
    assert asked.run is not None
    price = float(asked.run.decision.price_of_rate[1]) * 1e5
    assert "user 2" in told.reply.lower()
    assert "user 1" not in told.reply
    assert price > 0
    assert human(price, "W") in told.reply
