"""What a base station writes and reads back: users by index said so, power in the steps that it can set."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.acting.file import FileBaseStation
from wirelessagent.acting.simulated import SimulatedBaseStation
from wirelessagent.model.rates import user_rate_bps

SCENE = wa.simulate("rayleigh", num_users=4, num_subcarriers=12, seed=1)
ESTIMATE = wa.perfect(SCENE)


def test_a_written_allocation_says_that_an_owner_is_an_index(tmp_path: Path) -> None:
    decision = wa.decide(ESTIMATE, wa.Problem("max_rate", users=("user 4",)), SCENE.cell)
    for suffix in ("json", "csv", "npz"):
        FileBaseStation(SCENE, path=tmp_path / f"allocation.{suffix}").apply(decision)
    written = json.loads((tmp_path / "allocation.json").read_text())
    with np.load(tmp_path / "allocation.npz") as arrays:
        read = {name: arrays[name].tolist() for name in arrays}
    for found in (written, read):
        assert "index from 0 into user_names" in found["owner_means"]
        assert {found["user_names"][owner] for owner in found["owner"] if owner >= 0} == {"user 4"}
    with (tmp_path / "allocation.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert {(row["owner_from_0"], row["user_name"]) for row in rows} <= {("3", "user 4"), ("-1", "")}


# Power in steps

STEP_W = 0.01


def decided(**limits: object) -> wa.Decision:
    return wa.decide(ESTIMATE, wa.Problem("min_power", min_rate_bps=2e5, **limits), SCENE.cell)


def test_promises_are_kept_on_a_base_station_with_coarse_steps() -> None:
    """Rounded to the nearest step, some would be short by a part in some thousands."""
    decision = decided()
    nearest = np.round(decision.power_w / STEP_W) * STEP_W
    rate = user_rate_bps(ESTIMATE.gain, decision.owner, nearest, SCENE.cell)
    assert np.any(rate < decision.rate_bps * (1 - 1e-4))
    outcome = SimulatedBaseStation(SCENE, power_resolution_w=STEP_W).apply(decision)
    assert not outcome.missed.any()
    assert outcome.achieved is not None
    assert outcome.achieved.goodput_bps == pytest.approx(decision.committed_bps.sum(), rel=1e-12)
    assert np.all(outcome.achieved.user_rate_bps >= decision.rate_bps * (1 - 1e-9))
    assert outcome.power_w / STEP_W == pytest.approx(np.round(outcome.power_w / STEP_W), abs=1e-6)
    assert np.all((outcome.power_w >= decision.power_w * (1 - 1e-9)) & (outcome.power_w < decision.power_w + STEP_W))


def test_the_decision_and_its_certificate_stay_as_they_are() -> None:
    decision = decided()
    before = decision.power_w.tobytes(), decision.value, decision.bound
    SimulatedBaseStation(SCENE, power_resolution_w=STEP_W).apply(decision)
    assert (decision.power_w.tobytes(), decision.value, decision.bound) == before


@pytest.mark.parametrize("step_w", [1e-3, 0.03, 0.7, 30.0])
def test_rounding_never_breaks_the_budget_or_a_cap(step_w: float) -> None:
    """What would break one is rounded down; that takes less than a step is worth, and is no miss."""
    problem = wa.Problem("max_rate", max_power_w=5.0, subcarrier_max_power_w=0.61)
    decision = wa.decide(ESTIMATE, problem, SCENE.cell)
    outcome = SimulatedBaseStation(SCENE, power_resolution_w=step_w).apply(decision)
    assert outcome.power_w.sum() <= 5.0 * (1 + 1e-9)
    assert np.all(outcome.power_w <= 0.61 * (1 + 1e-9))
    assert np.all(np.abs(outcome.power_w - decision.power_w) < step_w)
    assert not outcome.missed.any()
    left = 5.0 - outcome.power_w.sum()  # no step that fits is left out
    could = (outcome.power_w < decision.power_w) & (outcome.power_w + step_w <= 0.61)
    assert left < step_w or not could.any()


def test_a_channel_that_carries_less_is_still_a_miss() -> None:
    decision = decided()
    worse = wa.Scene(cell=SCENE.cell, sensed=SCENE.sensed, truth=SCENE.current_truth * 0.9)
    outcome = SimulatedBaseStation(worse, power_resolution_w=1e-4).apply(decision)
    assert outcome.missed.all()


def test_a_file_holds_what_can_be_set(tmp_path: Path) -> None:
    path, decision = tmp_path / "allocation.json", decided()
    outcome = FileBaseStation(SCENE, path=path, power_resolution_w=STEP_W).apply(decision)
    assert json.loads(path.read_text())["power_w"] == outcome.power_w.tolist() != decision.power_w.tolist()


@pytest.mark.parametrize("kind", [SimulatedBaseStation, FileBaseStation])
def test_a_step_that_cannot_be_is_refused(kind: type[wa.BaseStation]) -> None:
    with pytest.raises(wa.InputError, match="power_resolution_w must be zero or more and finite; got -1"):
        kind(SCENE, power_resolution_w=-1)  # type: ignore[call-arg]
