"""Every registered plug-in keeps its kind's contract. Built-in ones enter by the same door as anybody's."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent import plugins
from wirelessagent.testing.channels import rayleigh_gain
from wirelessagent.testing.contract import Contract

SUITES: dict[plugins.Kind, tuple[type[Contract], str]] = {
    "channel_source": (wa.testing.ChannelSourceContract, "source"),
    "repairer": (wa.testing.RepairerContract, "repairer"),
    "objective": (wa.testing.ObjectiveContract, "objective"),
    "method": (wa.testing.MethodContract, "method"),
    "base_station": (wa.testing.BaseStationContract, "base_station"),
}

CHECKS = [
    pytest.param(kind, name, check, id=f"{kind}-{name}-{check}")
    for kind, (suite, _) in SUITES.items()
    for name in plugins.names(kind)
    for check in suite.checks()
]


def options_for(kind: plugins.Kind, name: str, folder: Path) -> dict[str, Any]:
    """What a plug-in needs to be made: files need a path."""
    if (kind, name) == ("channel_source", "file"):
        np.save(folder / "gains.npy", rayleigh_gain(8, 20, seed=0)[0])
        return {"path": folder / "gains.npy"}
    if (kind, name) == ("base_station", "file"):
        return {"path": folder / "allocation.json"}
    return {}


@pytest.mark.parametrize(("kind", "name", "check"), CHECKS)
def test_contract(kind: plugins.Kind, name: str, check: str, tmp_path: Path) -> None:
    suite, attribute = SUITES[kind]
    options = options_for(kind, name, tmp_path)
    if kind == "base_station":
        subject: Any = staticmethod(lambda scene: plugins.create(kind, name, options, scene))
    else:
        subject = plugins.create(kind, name, options)
    members = {attribute: subject, "random": (kind, name) != ("channel_source", "file")}
    getattr(type("Suite", (suite,), members)(), check)()


@pytest.mark.parametrize("kind", SUITES)
def test_there_is_something_to_check(kind: plugins.Kind) -> None:
    assert plugins.names(kind)
