"""WirelessAgent: from an operator's words to a certified OFDMA allocation.

>>> import wirelessagent as wa
>>> cell = wa.Cell(max_power_w=20)
>>> scene = wa.simulate("rayleigh", cell, num_users=4, seed=1)
>>> estimate = wa.repair(scene.observe(wa.loss.random(0.2), seed=2))
>>> wa.decide(estimate, wa.Problem("max_rate"), cell).status
'optimal'

Names load when they are first used, so that importing the package costs next to nothing. Who writes a plug-in imports
from here and nowhere else.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from wirelessagent.model import doors

if TYPE_CHECKING:
    from wirelessagent import plugins, testing
    from wirelessagent.acting.base_station import BaseStation, check_applicable
    from wirelessagent.acting.file import FileBaseStation
    from wirelessagent.acting.simulated import SimulatedBaseStation
    from wirelessagent.agent.session import Session, ask
    from wirelessagent.agent.turn import Run, Turn
    from wirelessagent.chain import decide, decide_batch, perfect, repair, simulate
    from wirelessagent.comparison import Comparison, compare
    from wirelessagent.deciding.core.certificate import certified
    from wirelessagent.deciding.core.normal_form import NormalForm
    from wirelessagent.deciding.method import Method
    from wirelessagent.kernels import kernel
    from wirelessagent.model import units
    from wirelessagent.model.batch_decision import BatchDecision
    from wirelessagent.model.cell import Cell
    from wirelessagent.model.decision import Bracket, Decision, Prices
    from wirelessagent.model.errors import (
        InputError,
        MissingDependencyError,
        UnsupportedProblemError,
        WirelessAgentError,
    )
    from wirelessagent.model.estimate import ChannelEstimate
    from wirelessagent.model.fading_posterior import FadingPosterior
    from wirelessagent.model.metrics import LinkMetrics, link_metrics
    from wirelessagent.model.objective import Objective
    from wirelessagent.model.observation import ChannelObservation
    from wirelessagent.model.outcome import Outcome
    from wirelessagent.model.phrases import phrases
    from wirelessagent.model.posterior import GammaPosterior, Posterior
    from wirelessagent.model.problem import Problem
    from wirelessagent.model.scene import Scene
    from wirelessagent.repairing.kriging import Kriging
    from wirelessagent.repairing.repairer import Repairer
    from wirelessagent.sensing import loss
    from wirelessagent.sensing.files import read
    from wirelessagent.sensing.source import ChannelSource
    from wirelessagent.telling.report import Report, report

__version__ = "0.2.0"

_HOMES = {
    "BaseStation": "acting.base_station",
    "BatchDecision": "model.batch_decision",
    "Bracket": "model.decision",
    "Cell": "model.cell",
    "ChannelEstimate": "model.estimate",
    "ChannelObservation": "model.observation",
    "ChannelSource": "sensing.source",
    "Comparison": "comparison",
    "Decision": "model.decision",
    "FadingPosterior": "model.fading_posterior",
    "FileBaseStation": "acting.file",
    "GammaPosterior": "model.posterior",
    "InputError": "model.errors",
    "Kriging": "repairing.kriging",
    "LinkMetrics": "model.metrics",
    "Method": "deciding.method",
    "MissingDependencyError": "model.errors",
    "NormalForm": "deciding.core.normal_form",
    "Objective": "model.objective",
    "Outcome": "model.outcome",
    "Posterior": "model.posterior",
    "Prices": "model.decision",
    "Problem": "model.problem",
    "Repairer": "repairing.repairer",
    "Report": "telling.report",
    "Run": "agent.turn",
    "Scene": "model.scene",
    "Session": "agent.session",
    "SimulatedBaseStation": "acting.simulated",
    "Turn": "agent.turn",
    "UnsupportedProblemError": "model.errors",
    "WirelessAgentError": "model.errors",
    "ask": "agent.session",
    "certified": "deciding.core.certificate",
    "check_applicable": "acting.base_station",
    "compare": "comparison",
    "decide": "chain",
    "decide_batch": "chain",
    "kernel": "kernels",
    "link_metrics": "model.metrics",
    "loss": "sensing",
    "perfect": "chain",
    "phrases": "model.phrases",
    "plugins": "",
    "read": "sensing.files",
    "repair": "chain",
    "report": "telling.report",
    "simulate": "chain",
    "testing": "",
    "units": "model",
}

__all__ = [  # kept in the order of _HOMES; a test compares the two
    "BaseStation", "BatchDecision", "Bracket", "Cell", "ChannelEstimate", "ChannelObservation", "ChannelSource",
    "Comparison", "Decision", "FadingPosterior", "FileBaseStation", "GammaPosterior", "InputError", "Kriging",
    "LinkMetrics", "Method", "MissingDependencyError", "NormalForm", "Objective", "Outcome", "Posterior", "Prices",
    "Problem", "Repairer", "Report", "Run", "Scene", "Session", "SimulatedBaseStation", "Turn",
    "UnsupportedProblemError", "WirelessAgentError", "ask", "certified", "check_applicable", "compare", "decide",
    "decide_batch", "kernel", "link_metrics", "loss", "perfect", "phrases", "plugins", "read", "repair", "report",
    "simulate", "testing", "units",
]  # fmt: skip


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'wirelessagent' has no attribute {name!r}")
    home = _HOMES[name]
    module = importlib.import_module(f"wirelessagent.{home}" if home else "wirelessagent")
    is_module = home in ("", "sensing", "model")
    value = importlib.import_module(f"{module.__name__}.{name}") if is_module else getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """What is meant for users, and nothing else that happens to be loaded."""
    return [*__all__, "__version__"]


doors.install("check_objective", lambda: importlib.import_module("wirelessagent.plugins").check_objective)
doors.install("draw", lambda: importlib.import_module("wirelessagent.pictures.gallery").draw)
