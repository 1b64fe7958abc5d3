"""The report of a decision: how sure it is, what was committed, and what not knowing the channel cost."""

from __future__ import annotations

import json

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.interfaces.cli import run
from wirelessagent.model.units import human, percent
from wirelessagent.telling.explanation import explain
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.report import Report, user_table

SCENE = wa.simulate("rayleigh", num_users=6, num_subcarriers=20, rms_delay_spread_s=300e-9, snr_db=30, seed=4)
ESTIMATE = wa.repair(SCENE.observe(wa.loss.random(0.3), seed=1))


def reported(objective: str, **problem: float) -> Report:
    decision = wa.decide(ESTIMATE, wa.Problem(objective, **problem), SCENE.cell)  # pyright: ignore[reportArgumentType]
    return wa.report(decision, wa.SimulatedBaseStation(SCENE).apply(decision))


def test_regret_is_what_perfect_knowledge_would_have_had_more() -> None:
    report = reported("max_rate")
    best = wa.decide(wa.perfect(SCENE), wa.Problem("max_rate"), SCENE.cell)
    assert report.perfect is not None
    assert report.achieved is not None
    assert report.perfect.value == best.value
    assert report.regret == pytest.approx(1 - report.achieved.sum_rate_bps / best.value, rel=1e-12)
    assert report.goodput_regret == pytest.approx(1 - report.achieved.goodput_bps / best.value, rel=1e-12)
    assert 0 < report.regret < report.goodput_regret
    assert ("Total rate", 4) in [(row[0], len(row)) for row in report.figures()]


def test_regret_of_promises_is_the_power_they_took_more() -> None:
    report = reported("min_power", min_rate_bps=3e5, outage_probability=0.05)
    best = wa.decide(wa.perfect(SCENE), wa.Problem("min_power", min_rate_bps=3e5), SCENE.cell)
    assert report.regret == pytest.approx(report.decision.value / best.value - 1, rel=1e-12)
    assert report.regret > 0
    said = " ".join(explain(ESTIMATE, report))
    assert f"not knowing cost {percent(report.regret)} more" in said


def test_no_regret_is_told_where_nothing_was_unknown() -> None:
    decision = wa.decide(wa.perfect(SCENE), wa.Problem("max_rate"), SCENE.cell)
    report = wa.report(decision, wa.SimulatedBaseStation(SCENE).apply(decision))
    assert report.perfect is None
    assert np.isnan(report.regret)
    assert np.isnan(wa.report(reported("max_rate").decision).regret)
    assert all(len(row) == 3 for row in report.figures())
    assert user_table(report).columns[-2:] == ("predicted rate", "achieved rate")


@pytest.mark.parametrize(
    ("language", "parts"),
    [
        ("en", ("with a probability of 90 % from", "are planned", "With every gain known", "was kept")),
        ("zh", ("以 90 % 的概率在", "其中计划", "若增益全部已知", "都已兑现")),
    ],
)
def test_sentences_say_how_sure_it_is_and_what_it_cost(language: str, parts: tuple[str, ...]) -> None:
    report = reported("max_rate")
    said = " ".join(explain(ESTIMATE, report, language=language))
    assert all(part in said for part in parts), said
    assert percent(report.goodput_regret) in said


def test_promises_on_the_estimate_as_it_stands_are_called_unsure() -> None:
    said = " ".join(explain(ESTIMATE, reported("min_power", min_rate_bps=3e5)))
    assert "asked for without a probability: the least sure one, 300 kbit/s for user 1, is kept with" in said
    assert "an outage probability makes promises of them" in said
    assert "are planned" not in said


def test_the_table_has_bands_and_commitments() -> None:
    report = reported("proportional_fairness")
    table = user_table(report, ESTIMATE)
    assert table.columns[-3:] == ("predicted rate (90 % band)", "planned rate (kept with)", "achieved rate")
    assert all("–" in row[-3] and "%" in row[-2] for row in table.rows)
    assert user_table(report, ESTIMATE, "zh").columns[-3:] == (
        "预测速率（90 % 区间）",
        "计划速率（兑现概率）",
        "实际速率",
    )


def test_the_record_has_it_all(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["ask", "Highest total rate", "--num-users", "4", "--snr-db", "30", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)["report"]
    forecast = report["forecast"]
    assert forecast["sum_low_bps"] < report["predicted"]["sum_rate_bps"] < forecast["sum_high_bps"]
    assert report["predicted"]["user_rate_bps"] == forecast["mean_bps"]
    best = report["perfect"]["sum_rate_bps"]
    assert report["regret"] == pytest.approx(1 - report["achieved"]["sum_rate_bps"] / best, rel=1e-9)
    assert report["goodput_regret"] >= report["regret"]


def test_the_value_that_was_decided_on_is_in_the_table_where_another_is_expected() -> None:
    scene = wa.simulate("cqi", wa.Cell.nr(), num_users=4, seed=1)
    estimate = wa.repair(scene.observe(wa.loss.random(0.2), seed=1))
    for objective in ("max_rate", "proportional_fairness", "max_energy_efficiency"):
        decision = wa.decide(estimate, wa.Problem(objective), scene.cell)
        told = [row[1] for row in wa.report(decision).figures()]
        assert human(decision.value, decision.unit) in told
        case = Case(decision=decision, estimate=estimate)
        assert case.rate_bps == pytest.approx(wa.report(decision).predicted.user_rate_bps)


@pytest.mark.parametrize(
    ("objective", "language", "name"),
    [
        ("max_energy_efficiency", "en", "weighted energy efficiency"),
        ("max_energy_efficiency", "zh", "加权能效"),
        ("max_rate", "en", "weighted total rate"),
    ],
)
def test_a_weighted_value_is_called_so_and_has_its_row(objective: str, language: str, name: str) -> None:
    scene = wa.simulate("rayleigh", num_users=3, seed=1)
    decision = wa.decide(wa.repair(scene.observe()), wa.Problem(objective, weights=(2.0, 1.0, 1.0)), scene.cell)
    (first, value, *_), *_ = wa.report(decision).figures(language)
    assert (first.lower(), value) == (name, human(decision.value, decision.unit))
