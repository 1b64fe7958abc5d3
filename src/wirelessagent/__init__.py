"""WirelessAgent: from an operator's words to a certified OFDMA allocation.

>>> import wirelessagent as wa
>>> cell = wa.Cell(max_power_w=20)
>>> scene = wa.simulate("rayleigh", cell, num_users=4, seed=1)
>>> estimate = wa.repair(scene.observe(wa.loss.random(0.2), seed=2))
>>> wa.decide(estimate, wa.Problem("max_rate"), cell).status
'optimal'

Names load when they are first used, so that importing the package costs next to nothing.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from wirelessagent import plugins, testing
    from wirelessagent.acting.base_station import BaseStation
    from wirelessagent.acting.file import FileBaseStation
    from wirelessagent.acting.simulated import SimulatedBaseStation
    from wirelessagent.agent.session import Session, ask
    from wirelessagent.chain import decide, decide_batch, perfect, repair, simulate
    from wirelessagent.comparison import compare
    from wirelessagent.deciding.method import Method
    from wirelessagent.explain.report import report
    from wirelessagent.kernels import kernel
    from wirelessagent.model import units
    from wirelessagent.model.batch_decision import BatchDecision
    from wirelessagent.model.cell import Cell
    from wirelessagent.model.decision import Bracket, Decision, Prices
    from wirelessagent.model.errors import InputError, WirelessAgentError
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

__version__ = "0.1.0"

_HOMES = {
    "BaseStation": "acting.base_station",
    "BatchDecision": "model.batch_decision",
    "Bracket": "model.decision",
    "Cell": "model.cell",
    "ChannelEstimate": "model.estimate",
    "ChannelObservation": "model.observation",
    "ChannelSource": "sensing.source",
    "Decision": "model.decision",
    "FadingPosterior": "model.fading_posterior",
    "FileBaseStation": "acting.file",
    "GammaPosterior": "model.posterior",
    "InputError": "model.errors",
    "Kriging": "repairing.kriging",
    "LinkMetrics": "model.metrics",
    "Method": "deciding.method",
    "Objective": "model.objective",
    "Outcome": "model.outcome",
    "Posterior": "model.posterior",
    "Prices": "model.decision",
    "Problem": "model.problem",
    "Repairer": "repairing.repairer",
    "Scene": "model.scene",
    "Session": "agent.session",
    "SimulatedBaseStation": "acting.simulated",
    "WirelessAgentError": "model.errors",
    "ask": "agent.session",
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
    "report": "explain.report",
    "simulate": "chain",
    "testing": "",
    "units": "model",
}

__all__ = [  # kept in the order of _HOMES; a test compares the two
    "BaseStation", "BatchDecision", "Bracket", "Cell", "ChannelEstimate", "ChannelObservation", "ChannelSource",
    "Decision", "FadingPosterior", "FileBaseStation", "GammaPosterior", "InputError", "Kriging", "LinkMetrics",
    "Method", "Objective", "Outcome", "Posterior", "Prices", "Problem", "Repairer", "Scene", "Session",
    "SimulatedBaseStation", "WirelessAgentError", "ask", "compare", "decide", "decide_batch", "kernel", "link_metrics",
    "loss", "perfect", "phrases", "plugins", "read", "repair", "report", "simulate", "testing", "units",
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
    return sorted({*globals(), *_HOMES})
