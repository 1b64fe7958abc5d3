"""Verdicts on the paper's claims: computed from figures and their intervals, and those that the documentation shows."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from wirelessagent.experiments import run_time
from wirelessagent.experiments.catalogue import EXPERIMENTS, judged, reproduce
from wirelessagent.experiments.claims import CLAIMS
from wirelessagent.experiments.experiment import Result
from wirelessagent.experiments.intervals import Measure
from wirelessagent.experiments.rate_versus_power import RateVersusPower
from wirelessagent.experiments.run_time import RunTime, scaling
from wirelessagent.experiments.table import table_of
from wirelessagent.experiments.verdict import FEWEST_DRAWS, Bar, Claim, Reading, judge, markdown
from wirelessagent.interfaces.cli import run

pytestmark = pytest.mark.machine_code

DOCS = Path(__file__).parents[2] / "docs" / "paper.md"


def claim(side: str = "at least", *, otherwise: tuple[Reading, ...] = ()) -> Claim:
    bar = Bar(measure="printed", what="as printed", side=side, limit=5.0)
    return Claim(
        words="it is so", place="section I", experiments=("x",), printed=(bar,), otherwise=otherwise, comment="{ours}!"
    )


def only_if(limit: float) -> Reading:
    return Reading(condition="ours ({ours})", bars=(Bar(measure="ours", what="as ours", side="at least", limit=limit),))


def measures(low: float, high: float) -> dict[str, Measure]:
    value = (low + high) / 2.0
    return {
        "printed": Measure(value=value, low=low, high=high, unit="%"),
        "ours": Measure(value=9.0, low=8.0, high=10.0, unit="%"),
    }


@pytest.mark.parametrize(
    ("side", "interval", "limit_of_ours", "verdict"),
    [
        ("at least", (5.0, 7.0), None, "holds"),
        ("at least", (4.9, 7.0), None, "no verdict"),
        ("at least", (3.0, 4.9), None, "does not hold"),
        ("at most", (3.0, 5.0), None, "holds"),
        ("at most", (4.9, 5.1), None, "no verdict"),
        ("at most", (5.1, 7.0), None, "does not hold"),
        ("at least", (3.0, 4.9), 8.0, "holds only if"),
        ("at least", (3.0, 4.9), 9.0, "no verdict"),
        ("at least", (3.0, 4.9), 11.0, "does not hold"),
        ("at least", (4.9, 7.0), 8.0, "no verdict"),
        ("at least", (float("nan"), float("nan")), None, "no verdict"),
    ],
)
def test_a_verdict_follows_from_the_interval_alone(side, interval, limit_of_ours, verdict):
    readings = () if limit_of_ours is None else (only_if(limit_of_ours),)
    found = judge(claim(side, otherwise=readings), measures(*interval), draws=FEWEST_DRAWS)

    assert found.verdict == verdict
    assert ("ours (9.0 % (8.0 to 10.0))" in found.reason) == (verdict == "holds only if")
    assert found.reason.endswith("9.0 % (8.0 to 10.0)!")
    assert found.measured[0].startswith("as printed: ")
    assert f", asked {side} 5 %" in found.measured[0]
    json.dumps(found.to_dict(), allow_nan=False)


def test_few_draws_give_no_verdict():
    found = judge(claim(), measures(6.0, 7.0), draws=FEWEST_DRAWS - 1)

    assert found.verdict == "no verdict"
    assert f"give {FEWEST_DRAWS} or more" in found.reason


def test_every_claim_is_quoted_placed_and_measured_by_its_experiments():
    assert len({one.words for one in CLAIMS}) == len(CLAIMS)
    for one in CLAIMS:
        assert one.words
        assert one.place
        assert set(one.experiments) <= EXPERIMENTS.keys()


TIMES = {"subcarriers": 1.0, "users": 1.0, "levels": 1.0}


def timed(noise: float, exponents: dict[str, float] = TIMES, seed: int = 1) -> dict[str, Result]:
    """A run whose times follow power laws with so much noise."""
    sizes = {"subcarriers": RunTime().num_subcarriers, "users": RunTime().num_users, "levels": RunTime().num_levels}
    rng = np.random.default_rng(seed)
    rows = [
        (sweep, *(size if sweep == one else 1 for one in sizes), stage, size**power * np.exp(rng.normal(scale=noise)))
        for stage in ("repair_by_nncf_paper", "max_energy_efficiency_by_paper_scan")
        for sweep, power in exponents.items()
        for size in sizes[sweep]
    ]
    columns = ("sweep", "num_subcarriers", "num_users", "num_levels", "stage", "time_least_ms")
    return {"run_time": Result(table=(table := table_of(columns, rows)), measures=scaling(table), draws=20)}


def verdicts(results: dict[str, Result]) -> list[str]:
    return [one.verdict for one in judged(results)]


def test_a_quiet_machine_gets_the_exponent_right():
    assert verdicts(timed(0.01)) == ["holds", "holds"]
    assert verdicts(timed(0.01, {**TIMES, "levels": 1.5})) == ["holds", "does not hold"]
    assert verdicts(timed(0.01, {**TIMES, "users": 2.0})) == ["does not hold", "does not hold"]


def test_a_noisy_machine_gets_no_verdict_rather_than_a_wrong_one():
    found = [verdict for seed in range(40) for verdict in verdicts(timed(0.5, seed=seed))]

    assert found.count("no verdict") > 0.9 * len(found)
    assert found.count("does not hold") <= 0.05 * len(found)


def test_sizes_are_timed_in_turn_and_the_least_time_counts(monkeypatch):
    calls: list[int] = []
    now = [0.0]

    def work(size: int) -> None:
        calls.append(size)
        now[0] += size * (100.0 if len(calls) % 3 == 0 else 1.0)  # every third call is disturbed

    monkeypatch.setattr(run_time.time, "process_time", lambda: now[0])
    points = {("users", size, 1, 1, "work"): (lambda size=size: work(size)) for size in (1, 2, 3, 4)}
    times = run_time._times_ms(points, 20, 1e9, 1, None)

    rounds = [tuple(calls[start : start + 4]) for start in range(0, len(calls), 4)]
    assert all(sorted(one) == [1, 2, 3, 4] for one in rounds)
    assert len(set(rounds)) > 10, "in another order each round"
    assert [min(found) for found in times.values()] == pytest.approx([1e3, 2e3, 3e3, 4e3])


def test_mean_filling_keeps_the_sum_rate_and_loses_the_goodput():
    experiment = RateVersusPower(max_powers_w=(20.0,))
    results = {"rate_versus_power": experiment.run(draws=60, seed=1)}
    close, degraded, gains = judged(results)

    assert close.verdict == "holds"
    assert (degraded.verdict, gains.verdict) == ("holds only if", "holds only if")
    measures = results["rate_versus_power"].measures
    assert measures["least_sum_rate_share_of_user_mean"].low > 97
    assert str(measures["least_sum_rate_share_of_user_mean"]) in degraded.reason
    assert str(measures["least_goodput_share_of_user_mean"]) in degraded.reason
    assert "goodput" in degraded.reason


def test_verdicts_are_printed_and_written(tmp_path, capsys):
    assert run(["reproduce", "channel_recovery", "--draws", "20", "--out", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    record = json.loads((tmp_path / "verdicts.json").read_text(encoding="utf-8"))

    assert "Verdicts" in told
    assert "holds only if" in told
    (fit,) = record["claims"]
    assert fit["claim"].startswith("It accurately reconstructs")
    states = [reading["state"] for reading in fit["readings"]]
    assert (states[0], states[-1]) == ("failed", "passed"), "as printed, and the default repairer"
    assert (record["seed"], record["draws"]) == (1, 20)
    assert (tmp_path / "verdicts.md").read_text(encoding="utf-8").startswith("| the paper says | measured")


def test_claims_without_all_their_figures_are_left_out(tmp_path):
    made = reproduce(["error_versus_loss"], out=tmp_path, draws=1)

    assert made.verdicts == ()
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "error_versus_loss.csv", "error_versus_loss.json", "error_versus_loss.png",
    ]  # fmt: skip


def test_the_documentation_shows_the_claims_that_are_judged():
    """Verdicts and figures there are those of the run that it names; the claims are these, word for word."""
    row = markdown([judge(claim(), measures(6.0, 7.0), draws=20)]).splitlines()[2]
    assert row.startswith("| “it is so” (section I) | ")
    rows = re.findall(r"^\| (“.*?” \(.*?\)) \| .*? \| \*\*(.*?)\*\* \| .* \|$", DOCS.read_text(encoding="utf-8"), re.M)

    assert [told for told, _ in rows] == [f"“{one.words}” ({one.place})" for one in CLAIMS]
    assert {verdict for _, verdict in rows} <= {"holds", "holds only if", "does not hold", "no verdict"}
