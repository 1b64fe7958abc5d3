"""Every experiment by name, and how one becomes files."""

from __future__ import annotations

import json
from collections.abc import Mapping
from concurrent.futures import Executor
from pathlib import Path
from types import MappingProxyType
from typing import Any

import wirelessagent
from wirelessagent.experiments.channel_recovery import ChannelRecovery
from wirelessagent.experiments.error_versus_delay_spread import ErrorVersusDelaySpread
from wirelessagent.experiments.error_versus_loss import ErrorVersusLoss
from wirelessagent.experiments.experiment import Experiment, Progress, Result
from wirelessagent.experiments.modes import Modes
from wirelessagent.experiments.rate_versus_power import RateVersusPower
from wirelessagent.experiments.run_time import RunTime
from wirelessagent.model.atomic import write_atomically
from wirelessagent.model.errors import InputError, UnknownNameError
from wirelessagent.pictures.canvas import require_matplotlib

_ALL: tuple[Experiment, ...] = (
    ChannelRecovery(), RateVersusPower(), ErrorVersusLoss(), ErrorVersusDelaySpread(), Modes(), RunTime(),
)  # fmt: skip

EXPERIMENTS: Mapping[str, Experiment] = MappingProxyType({experiment.name: experiment for experiment in _ALL})
"""The experiments with the paper's settings, in the order of the paper's figures."""


def reproduce(
    name: str,
    *,
    out: Path,
    draws: int = 2000,
    seed: int = 1,
    progress: Progress | None = None,
    executor: Executor | None = None,
) -> list[Path]:
    """Run an experiment and write ``<name>.png``, ``.csv`` and ``.json`` into the folder ``out``; their paths.

    The JSON holds seed, configuration, version and findings, and no date: the same seed on the same version and
    platform writes the same CSV and JSON, whatever the executor. Only the times that ``run_time`` measures differ.

    Raises:
        UnknownNameError: no experiment of this name.
        InputError: no draws, a negative seed, or a folder that cannot be made or written to.
        MissingDependencyError: matplotlib is not installed.
    """
    if name not in EXPERIMENTS:
        raise UnknownNameError("experiment", name, EXPERIMENTS)
    if draws < 1 or seed < 0:
        raise InputError(f"draws must be 1 or more and seed 0 or more; got {draws!r} and {seed!r}")
    require_matplotlib()
    out = Path(out)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"the folder {out} cannot be made: {error.strerror}; choose another one") from error
    experiment = EXPERIMENTS[name]
    result = experiment.run(draws=draws, seed=seed, progress=progress, executor=executor)
    picture, table, record = (out / f"{name}{suffix}" for suffix in (".png", ".csv", ".json"))
    experiment.picture(result).save(picture)
    write_atomically(table, lambda stream: stream.write(result.table.to_csv().encode()))
    text = json.dumps(_record(experiment, result, seed), ensure_ascii=False, allow_nan=False, indent=1)
    write_atomically(record, lambda stream: stream.write(f"{text}\n".encode()))
    return [picture, table, record]


def _record(experiment: Experiment, result: Result, seed: int) -> dict[str, Any]:
    """How the figure was made and what it says."""
    return {
        "experiment": experiment.name,
        "summary": experiment.summary,
        "version": wirelessagent.__version__,
        "seed": seed,
        "draws": result.draws,
        "configuration": experiment.configuration(),
        "findings": result.findings,
    }
