"""Every experiment by name, and how some of them become files and verdicts on the paper's claims."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import wirelessagent
from wirelessagent.experiments.channel_recovery import ChannelRecovery
from wirelessagent.experiments.claims import CLAIMS
from wirelessagent.experiments.error_sweep import ErrorVersusDelaySpread, ErrorVersusLoss, ErrorVersusUserCorrelation
from wirelessagent.experiments.experiment import Experiment, Result
from wirelessagent.experiments.modes import Modes
from wirelessagent.experiments.rate_versus_power import RateVersusPower
from wirelessagent.experiments.run_time import RunTime
from wirelessagent.experiments.verdict import Judged, judge, markdown
from wirelessagent.model.atomic import write_atomically
from wirelessagent.model.errors import InputError, UnknownNameError
from wirelessagent.pictures.canvas import require_matplotlib

_ALL: tuple[Experiment, ...] = (
    ChannelRecovery(), RateVersusPower(), ErrorVersusLoss(), ErrorVersusDelaySpread(), ErrorVersusUserCorrelation(),
    Modes(), RunTime(),
)  # fmt: skip

EXPERIMENTS: Mapping[str, Experiment] = MappingProxyType({experiment.name: experiment for experiment in _ALL})
"""The experiments with the paper's settings, in the order of the paper's figures."""


VERDICTS = "verdicts"
"""The stem of the files that hold the verdicts."""


@dataclass(frozen=True, kw_only=True)
class Reproduced:
    """What a run of some experiments left.

    Attributes:
        files: the paths written, by experiment, and of the verdicts under ``VERDICTS``.
        verdicts: on the claims that rest on these experiments.
    """

    files: Mapping[str, Sequence[Path]]
    verdicts: Sequence[Judged]


def reproduce(
    names: Sequence[str],
    *,
    out: Path,
    draws: int = 2000,
    seed: int = 1,
    progress: Callable[[str, int, int], None] | None = None,
    executor: Executor | None = None,
) -> Reproduced:
    """Run experiments, write ``<name>.png``, ``.csv`` and ``.json`` of each into the folder ``out``, and judge.

    The verdicts on the claims that rest on these experiments are written as ``verdicts.json`` and ``verdicts.md``. The
    JSON of an experiment holds seed, configuration, version and measures, and no date: the same seed on the same
    version and platform writes the same files, whatever the executor. Only the times that ``run_time`` measures differ.

    Args:
        names: of experiments, each once.
        out: a folder, made where it is not there.
        draws: channel draws per point.
        seed: of every draw.
        progress: called with an experiment's name, how much of it is done and how much there is.
        executor: runs the draws.

    Raises:
        UnknownNameError: no experiment of this name.
        InputError: no draws, a negative seed, or a folder that cannot be made or written to.
        MissingDependencyError: matplotlib is not installed.
    """
    for name in names:
        if name not in EXPERIMENTS:
            raise UnknownNameError("figure", name, EXPERIMENTS)
    if draws < 1 or seed < 0:
        raise InputError(f"draws must be 1 or more and seed 0 or more; got {draws!r} and {seed!r}")
    require_matplotlib()
    out = Path(out)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"the folder {out} cannot be made: {error.strerror}; choose another one") from error
    results: dict[str, Result] = {}
    files: dict[str, Sequence[Path]] = {}
    for name in dict.fromkeys(names):

        def told(done: int, total: int, name: str = name) -> None:
            if progress is not None:
                progress(name, done, total)

        results[name] = EXPERIMENTS[name].run(draws=draws, seed=seed, progress=told, executor=executor)
        files[name] = _write(EXPERIMENTS[name], results[name], seed, out)
    verdicts = judged(results)
    if verdicts:
        files[VERDICTS] = _write_verdicts(verdicts, {"seed": seed, "draws": draws}, out)
    return Reproduced(files=files, verdicts=verdicts)


def judged(results: Mapping[str, Result]) -> tuple[Judged, ...]:
    """The verdicts on the claims all of whose experiments have a result."""
    measures = {name: one for result in results.values() for name, one in result.measures.items()}
    return tuple(
        judge(claim, measures, draws=min(results[name].draws for name in claim.experiments))
        for claim in CLAIMS
        if results.keys() >= set(claim.experiments)
    )


def _write(experiment: Experiment, result: Result, seed: int, out: Path) -> list[Path]:
    """The picture, the table and the record of an experiment."""
    picture, table, record = (out / f"{experiment.name}{suffix}" for suffix in (".png", ".csv", ".json"))
    experiment.picture(result).save(picture)
    _write_text(table, result.table.to_csv())
    made = {
        "experiment": experiment.name,
        "summary": experiment.summary,
        "version": wirelessagent.__version__,
        "seed": seed,
        "draws": result.draws,
        "configuration": experiment.configuration(),
        "measures": {name: one.to_dict() for name, one in result.measures.items()},
    }
    _write_text(record, _json(made))
    return [picture, table, record]


def _write_verdicts(verdicts: Sequence[Judged], how: Mapping[str, Any], out: Path) -> list[Path]:
    record, table = out / f"{VERDICTS}.json", out / f"{VERDICTS}.md"
    made = {"version": wirelessagent.__version__, **how, "claims": [one.to_dict() for one in verdicts]}
    _write_text(record, _json(made))
    _write_text(table, markdown(verdicts))
    return [record, table]


def _json(value: Mapping[str, Any]) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False, indent=1) + "\n"


def _write_text(path: Path, text: str) -> None:
    write_atomically(path, lambda stream: stream.write(text.encode()))
