"""A turn as a row: what was said, understood, seen, decided and done, as plain data.

The row holds all that is needed to do the work again: the objective with its options, every constraint, the cell, the
tools with theirs, and the channel by the hash of its content.
"""

from __future__ import annotations

import dataclasses
import functools
import math
import platform
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from wirelessagent import plugins
from wirelessagent.agent.turn import Run, Turn
from wirelessagent.language.acts import shown
from wirelessagent.language.intent import Intent
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.problem import Problem
from wirelessagent.plugin_options import options_of
from wirelessagent.store.content import Content, estimate_content, observation_content
from wirelessagent.store.plain import plain
from wirelessagent.telling.catalogue import Said

APPLIED = ("applied", "reverted")
"""Stages in which the run was applied; in others its outcome is what it would be, or what an earlier turn applied."""

FIGURES = ("value", "bound", "gap")
ALLOCATION = ("owner", "power_w", "rate_bps")
CERTIFICATE = (
    "reason", "price_of_power", "price_of_rate", "needed_power_w", "rate_scaling", "iterations", "restarts", "steps",
    "prices", "expected_rate_bps", "outage", "forecast",
)  # fmt: skip
"""What is kept of a decision beside its allocation and the figures that have columns."""

CONSTRAINTS = (
    "weights", "min_rate_bps", "max_rate_bps", "max_power_w", "subcarrier_max_power_w", "forbidden", "users",
    "resource_block_group_size", "outage_probability",
)  # fmt: skip


def record_of(turn: Turn) -> tuple[dict[str, Any], tuple[Content, ...]]:
    """A turn's row without its number and hashes, and the contents that it speaks of."""
    row: dict[str, Any] = {
        **{name: getattr(turn, name) for name in ("session", "at_utc", "text", "recogniser", "reply", "stage")},
        "turn": turn.number,
        "intent": understood(turn),
        "objective": turn.intent.objective,
        "restored": _outcome(turn.restored),
        "seed": turn.seed,
        "version": turn.version,
        "platform": this_platform(),
    }
    if turn.run is None:
        return _plain_columns(row), ()
    row["platform"] = {**this_platform(), "kernels": ran(turn.run.estimate, turn.run.decision)}
    contents = observation_content(turn.run.observation), estimate_content(turn.run.estimate)
    row.update(_run_columns(turn.run), observation=contents[0].hash, estimate=contents[1].hash)
    outcome = _outcome(turn.run.outcome) if turn.stage in APPLIED else None
    row["applied"] = None if outcome is None else {**outcome, "options": turn.run.tools.base_station_options}
    return _plain_columns(row), contents


def understood(turn: Turn) -> dict[str, Any]:
    """What a turn was understood to mean, what it changed, and what was said.

    ``schema`` counts the forms that this has had.
    """
    lines = {field.name: getattr(turn.lines, field.name) for field in dataclasses.fields(turn.lines)}
    return {
        **_meant(turn.intent),
        "schema": 4,
        "acts": [shown(act) for act in turn.acts],
        "diff": plain(turn.diff),
        "shift": plain(turn.shift),
        "lines": {name: str(line) for name, line in lines.items()},
        "messages": {name: line.messages() if isinstance(line, Said) else [] for name, line in lines.items()},
        **({"by": turn.by} if turn.by else {}),
        **({"pressed": turn.pressed} if turn.pressed else {}),
    }


def _meant(intent: Intent) -> dict[str, Any]:
    guess = None if intent.guess is None else _meant(intent.guess)
    return {**plain(intent), "acts": [shown(act) for act in intent.acts], "guess": guess}


def _run_columns(run: Run) -> dict[str, Any]:
    tools, decision = run.tools, run.decision
    objective = decision.problem.objective
    repairer = tools.repairer or (run.estimate.method if run.estimate.method in plugins.names("repairer") else None)
    return {
        "objective": objective if isinstance(objective, str) else objective.name,
        "facts": run.scene.facts,
        "repairer": {"name": repairer, "options": tools.repairer_options},
        "problem": problem_columns(decision.problem),
        "cell": decision.cell,
        "method": {"name": tools.method or decision.method, "options": tools.method_options},
        **decision_columns(decision),
        "notes": run.notes,
        "explanation": run.explanation,
    }


def decision_columns(decision: Decision) -> dict[str, Any]:
    """The columns that say what was decided."""
    return _plain_columns(
        {
            "status": decision.status,
            **{name: getattr(decision, name) for name in FIGURES},
            "unit": decision.unit,
            "allocation": {name: getattr(decision, name) for name in ALLOCATION},
            "certificate": {name: getattr(decision, name) for name in CERTIFICATE},
        }
    )


def _plain_columns(row: Mapping[str, Any]) -> dict[str, Any]:
    """Columns as plain data; the figures that have columns of their own stay numbers, null for NaN."""
    return {name: _figure(value) if name in FIGURES else plain(value) for name, value in row.items()}


def _figure(value: float | None) -> float | None:
    return None if value is None or math.isnan(value) else float(value)


def problem_columns(problem: Problem) -> dict[str, Any]:
    """A problem with every figure."""
    objective = problem.objective
    stated = {name: getattr(problem, name) for name in CONSTRAINTS}
    if isinstance(objective, str):
        return {"objective": {"name": objective, "options": {}}, **stated}
    options = {option.name: getattr(objective, option.name) for option in options_of(type(objective))}
    return {"objective": {"name": objective.name, "options": options}, **stated}


def _outcome(outcome: Outcome | None) -> dict[str, Any] | None:
    """What the base station did, as it was read back."""
    if outcome is None:
        return None
    names = ("base_station", "owner", "power_w", "promised_bps", "achieved", "written_to", "slack_bps")
    return {name: getattr(outcome, name) for name in names}


def ran(estimate: ChannelEstimate, decision: Decision) -> str:
    """Whether kernels were interpreted for these, on which the last bits of figures depend, too."""
    return "interpreted" if "interpreted" in (estimate.kernels, decision.kernels) else "compiled"


@functools.cache
def this_platform() -> Mapping[str, str]:
    """What figures may depend on down to their last bit, beside the version of this package."""
    return {
        "system": platform.system(),
        "machine": platform.machine(),
        "processor": _processor(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        **{package: plugins.version_of(package) for package in ("scipy", "numba")},
    }


def _processor() -> str:
    """The processor's name: kernels are compiled for it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return platform.processor()
    named = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(named, platform.processor())
