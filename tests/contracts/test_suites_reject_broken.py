"""The contract suites tested: each broken plug-in fails exactly the check it names, and no check goes untested."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import wirelessagent as wa
from wirelessagent.acting.file import FileBaseStation
from wirelessagent.acting.simulated import SimulatedBaseStation
from wirelessagent.testing.broken import base_stations, methods, objectives, repairers, sources
from wirelessagent.testing.channels import known_scene
from wirelessagent.testing.contract import Contract
from wirelessagent.testing.kinked import KinkedLogarithm

SUITES: dict[str, tuple[type[Contract], Any, Any]] = {
    "source": (wa.testing.ChannelSourceContract, sources.BROKEN, sources.Fading()),
    "repairer": (wa.testing.RepairerContract, repairers.BROKEN, repairers.MeanFill()),
    "objective": (wa.testing.ObjectiveContract, objectives.BROKEN, objectives.SumRate()),
    "method": (wa.testing.MethodContract, methods.BROKEN, methods.InTurn()),
    "base_station": (wa.testing.BaseStationContract, base_stations.BROKEN, base_stations.Obedient),
}


def suite_of(kind: str, subject: Any) -> Contract:
    attribute = staticmethod(subject) if kind == "base_station" else subject
    return type("Suite", (SUITES[kind][0],), {kind: attribute})()


def plugin_of(kind: str, subject: Any) -> Any:
    return subject(known_scene()) if kind == "base_station" else subject


EVERY_BROKEN_PLUGIN = [
    pytest.param(kind, subject, id=f"{kind}-{type(plugin_of(kind, subject)).__name__}")
    for kind, (_, subjects, _) in SUITES.items()
    for subject in subjects
]


@pytest.mark.parametrize("kind", SUITES)
def test_what_the_broken_ones_are_made_from_is_sound(kind: str) -> None:
    assert suite_of(kind, SUITES[kind][2]).failures() == {}


@pytest.mark.parametrize(("kind", "subject"), EVERY_BROKEN_PLUGIN)
def test_a_broken_plugin_fails_the_check_it_names_and_no_other(kind: str, subject: Any) -> None:
    assert list(suite_of(kind, subject).failures()) == [plugin_of(kind, subject).caught_by]


@pytest.mark.parametrize("kind", SUITES)
def test_every_check_rejects_some_broken_plugin(kind: str) -> None:
    suite, subjects, _ = SUITES[kind]
    assert set(suite.checks()) == {plugin_of(kind, subject).caught_by for subject in subjects}


def test_corners_are_sound_if_the_conjugate_has_them() -> None:
    kinked = KinkedLogarithm(knots=(1e5, 3e5, 4e5, 1e7))
    assert suite_of("objective", kinked).failures() == {}


def test_a_source_that_does_not_draw_must_not_depend_on_the_seed() -> None:
    class Suite(wa.testing.ChannelSourceContract):
        source = sources.Fading()
        random = False

    assert list(Suite().failures()) == ["test_the_seed_matters_if_it_draws"]


@pytest.mark.parametrize("step_w", [1e-4, 1e-3, 0.1, 0.7])
@pytest.mark.parametrize("kind", [SimulatedBaseStation, FileBaseStation])
def test_a_coarse_power_setting_is_sound_if_it_is_stated(kind: type[Any], step_w: float, tmp_path: Path) -> None:
    options = {"path": tmp_path / "allocation.json"} if kind is FileBaseStation else {}

    class Suite(wa.testing.BaseStationContract):
        def base_station(self, scene: wa.Scene) -> wa.BaseStation:
            return kind(scene, power_resolution_w=step_w, **options)

    assert Suite().failures() == {}


def test_a_failure_says_what_was_wrong_and_what_was_received() -> None:
    message = str(suite_of("objective", objectives.BadlyNamed()).failures()["test_has_a_name"])
    assert "lower case" in message
    assert "'Sum Rate'" in message


def test_the_suites_need_neither_pytest_nor_hypothesis() -> None:
    blocked = "import sys; sys.modules['pytest'] = sys.modules['hypothesis'] = sys.modules['_pytest'] = None"
    run = "from wirelessagent.testing.broken.objectives import SumRate; import wirelessagent as wa"
    suite = "S = type('S', (wa.testing.ObjectiveContract,), {'objective': SumRate()}); assert S().failures() == {}"
    subprocess.run([sys.executable, "-c", f"{blocked}; {run}; {suite}"], check=True, timeout=60)
