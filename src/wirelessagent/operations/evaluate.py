"""evaluate repair, evaluate decision: repairers and their competitors beside each other, with confidence intervals.

Another evaluation is a subclass of :class:`wirelessagent.experiments.evaluation.Evaluation`, a request that makes it,
and a call of :func:`evaluation_operation`.
"""

from __future__ import annotations

import contextlib
from abc import abstractmethod
from collections.abc import Callable, Generator
from concurrent.futures import Executor, ProcessPoolExecutor
from pathlib import Path
from typing import Annotated, Any, TypeVar, cast

from pydantic import Field

from wirelessagent import plugins
from wirelessagent.experiments.competitors import COMPETITORS
from wirelessagent.experiments.evaluate_decision import EvaluateDecision
from wirelessagent.experiments.evaluate_repair import EvaluateRepair
from wirelessagent.experiments.evaluated_channels import SIMULATED, EvaluatedChannel, parse_channel
from wirelessagent.experiments.evaluated_methods import ORACLE, all_methods, check_methods, installed_methods
from wirelessagent.experiments.evaluation import Evaluated, Evaluation, make_folder, rows_of, write
from wirelessagent.experiments.repair_error import comparable_repairers
from wirelessagent.experiments.table import Table as Figures
from wirelessagent.model.arrays import whole
from wirelessagent.model.errors import InputError
from wirelessagent.operations.cell_options import CellOptions
from wirelessagent.operations.evaluate_tables import decision_tables, repair_tables
from wirelessagent.operations.fields import Advanced, Known, Local, OptionsOf, PluginOptions, Positional
from wirelessagent.operations.operation import Event, Operation, Progress, Request
from wirelessagent.operations.record import Block, Files, Record, Table
from wirelessagent.operations.simulate import loss_patterns
from wirelessagent.sensing.loss import parse as parse_loss
from wirelessagent.sensing.rayleigh import Rayleigh


class EvaluateRequest(Request):
    """What every evaluation takes: how much of it, and where to."""

    draws: int = Field(200, description="channel draws for each channel and loss")
    seed: int = Field(1, description="seed of every draw")
    workers: Annotated[int, Local()] = Field(
        1, description="processes that share the draws; with several, times are less exact"
    )
    out: Path | None = Field(None, description="folder for the tables (CSV), the record (JSON) and the pictures (PNG)")

    @abstractmethod
    def evaluation(self) -> Evaluation:
        """What is to be run.

        Raises:
            InputError: something in it cannot be.
        """


class ChannelsRequest(EvaluateRequest, CellOptions):
    """Evaluations of methods on channels of which entries get lost."""

    panel = "Options"

    channels: Annotated[list[str], Positional()] = Field(
        default_factory=list,
        description="channels: rayleigh:NANOSECONDS of delay spread, rayleigh:mixed, or files with complete gains",
    )
    loss: Annotated[list[str], Known(loss_patterns)] = Field(
        default_factory=list, description="what gets lost, such as random:0.2; give several to compare them"
    )
    methods: list[str] = Field(
        default_factory=list,
        description=f"methods; if none are named, those that are installed: registered repairers, "
        f"{', '.join((*COMPETITORS, ORACLE))}",
    )
    snr_db: Annotated[float | None, Advanced()] = Field(
        30.0, description="SNR of the measurements of simulated channels, dB; inf for exact ones"
    )
    file_snr_db: Annotated[float | None, Advanced()] = Field(
        None, description="SNR of noise added to files, dB; none if not given"
    )
    history: Annotated[int, Advanced()] = Field(1, description="slots observed, the last one the current one")
    simulation_options: Annotated[
        PluginOptions, OptionsOf("channel_source", only="rayleigh", but=("rms_delay_spread_s", "snr_db", "num_slots"))
    ] = Field(default_factory=dict, description="options of the simulated channels")
    file_options: Annotated[PluginOptions, OptionsOf("channel_source", only="file", but=("path", "drop"))] = Field(
        default_factory=dict, description="how to read the files"
    )

    def evaluated_channels(self, default: tuple[str, ...]) -> tuple[EvaluatedChannel, ...]:
        """The channels named, else the default ones; each is drawn once, so that an error shows now."""
        snr_db = None if self.snr_db == float("inf") else self.snr_db
        history = whole("history", self.history)
        options = {**self.simulation_options, "num_slots": history, "snr_db": snr_db}
        source = cast(Rayleigh, plugins.create("channel_source", SIMULATED, options))
        channels = tuple(
            parse_channel(
                text, source=source, cell=self.cell(), options=self.file_options, file_snr_db=self.file_snr_db,
                rule=self.cell,
            )
            for text in self.channels or default
        )  # fmt: skip
        names = [channel.name for channel in channels]
        if len(set(names)) < len(names):
            raise InputError(f"two channels have the same name, so their figures could not be told apart: {names}")
        for channel in channels:
            drawn = channel.drawn(0)
            for loss in self.loss:
                drawn.scene.observe(parse_loss(loss))
        return channels


class EvaluateRepairRequest(ChannelsRequest):
    panel = "Options"

    def evaluation(self) -> EvaluateRepair:
        return EvaluateRepair(
            channels=self.evaluated_channels(
                ("rayleigh:30", "rayleigh:100", "rayleigh:300", "rayleigh:1000", "rayleigh:mixed")
            ),
            losses=_each_once(self.loss or ["random:0.1", "random:0.2", "random:0.3", "random:0.5", "bursts:0.2"]),
            methods=check_methods(self.methods or installed_methods()),
        )


class EvaluateDecisionRequest(ChannelsRequest):
    panel = "Options"

    min_rate_bps: float = Field(500e3, description="rate promised to each user at the least power, bit/s")
    outage_probability: float = Field(
        0.05,
        description="accepted probability that a user's true rate stays below the promised one; "
        "0 promises on the estimate as it stands",
    )
    max_power_w: float | None = Field(None, description="radiated power budget, W; the cell's limit if not given")

    def evaluation(self) -> EvaluateDecision:
        return EvaluateDecision(
            channels=self.evaluated_channels(("rayleigh:100", "rayleigh:300")),
            losses=_each_once(self.loss or ["random:0.1", "random:0.2", "random:0.3", "random:0.5"]),
            methods=check_methods(self.methods or comparable_repairers()),
            min_rate_bps=self.min_rate_bps,
            outage_probability=self.outage_probability or None,
            max_power_w=self.max_power_w,
        )


def _each_once(losses: list[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(losses))


class EvaluateRecord(Record):
    """What an evaluation found; ``rows`` are those of the CSV table, null where a figure is not known."""

    draws: int
    seed: int
    left_out: list[str]
    configuration: dict[str, Any]
    findings: dict[str, Any]
    rows: list[dict[str, Any]]
    files: list[Path]
    tables: list[Table] = Field(exclude=True)

    def blocks(self) -> list[Block]:
        said: list[Block] = [*self.tables, "In brackets: 95 % bootstrap intervals; all methods see the same draws."]
        if self.left_out:
            missing = ", ".join(self.left_out)
            said.append(
                f"left out, as scikit-learn is not installed (pip install 'wirelessagent[evaluate]'): {missing}"
            )
        return [*said, *([Files("written:", tuple(self.files))] if self.files else [])]


Asked = TypeVar("Asked", bound=EvaluateRequest)


def evaluation_operation(
    name: str, request: type[Asked], tables: Callable[[Figures], list[Table]], examples: tuple[str, ...]
) -> Operation[Asked, EvaluateRecord]:
    """The operation ``evaluate`` ``name``; ``tables`` shows its figures to people, ``examples`` what they type."""

    def run(asked: Asked, progress: Progress) -> EvaluateRecord:
        whole("draws", asked.draws)
        whole("seed", asked.seed, smallest=0)
        whole("workers", asked.workers)
        evaluation = asked.evaluation()
        if asked.out is not None:
            _check_out(asked.out)

        def told(done: int, total: int) -> None:
            progress(Event(stage=f"evaluate {name}", message=evaluation.summary, done=done, total=total))

        with _executor(asked.workers) as executor:
            result = evaluation.run(draws=asked.draws, seed=asked.seed, progress=told, executor=executor)
        files = [] if asked.out is None else write(evaluation, result, asked.out)
        return _record(asked, evaluation, result, files, tables(result.table))

    return Operation(
        name=f"evaluate {name}", request=request, record=EvaluateRecord, run=run,
        examples=tuple(f"evaluate {name} {typed}" for typed in examples),
    )  # fmt: skip


def _check_out(out: Path) -> None:
    """Raise an error where the files cannot be written, before the work."""
    from wirelessagent.pictures.canvas import require_matplotlib

    require_matplotlib()
    make_folder(out)


@contextlib.contextmanager
def _executor(workers: int) -> Generator[Executor | None]:
    """So many processes, none beside this one for a single worker."""
    if workers == 1:
        yield None
        return
    import multiprocessing

    with ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn")) as executor:
        yield executor


def _record(
    asked: EvaluateRequest, evaluation: Evaluation, result: Evaluated, files: list[Path], tables: list[Table]
) -> EvaluateRecord:
    chosen = isinstance(asked, EvaluateRepairRequest) and not asked.methods
    left_out = [name for name in all_methods() if name not in installed_methods()] if chosen else []
    return EvaluateRecord(
        draws=result.draws,
        seed=result.seed,
        left_out=left_out,
        configuration=evaluation.configuration(),
        findings=dict(result.findings),
        rows=rows_of(result.table),
        files=files,
        tables=tables,
    )


EVALUATE_REPAIR = evaluation_operation(
    "repair",
    EvaluateRepairRequest,
    repair_tables,
    ("rayleigh:100 --draws 50", "gains.npz --loss random:0.2 --out found"),
)

EVALUATE_DECISION = evaluation_operation(
    "decision", EvaluateDecisionRequest, decision_tables, ("rayleigh:100 --draws 50 --methods kriging,user_mean",)
)
