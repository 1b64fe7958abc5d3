"""simulate: draw a channel, lose some of it, and write both."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field

from wirelessagent.operations.cell_options import CellOptions
from wirelessagent.operations.fields import Known, OptionsOf, PluginName, PluginOptions
from wirelessagent.operations.operation import Event, Operation, Progress
from wirelessagent.operations.outputs import channel_meta, check_gains
from wirelessagent.operations.record import Block, Files, Matrix, Record, Table, Vector

if TYPE_CHECKING:
    from wirelessagent.model.observation import ChannelObservation
    from wirelessagent.model.scene import Scene


def loss_patterns() -> list[str]:
    """How each pattern of what gets lost is written."""
    from wirelessagent.sensing.loss import PATTERNS

    return [pattern.usage for pattern in PATTERNS.values()]


class SimulateRequest(CellOptions):
    panel = "Options"

    source: Annotated[str, PluginName("channel_source")] = Field("rayleigh", description="channel source")
    source_options: Annotated[PluginOptions, OptionsOf("channel_source")] = Field(
        default_factory=dict, description="options of the channel source"
    )
    loss: Annotated[list[str], Known(loss_patterns)] = Field(
        default_factory=list, description="what gets lost, such as random:0.2 or bursts:0.2+users:1"
    )
    seed: int = Field(1, description="seed of every draw")
    out: Path | None = Field(None, description="NPZ file to write the observed and the true gains to")


class SimulateRecord(Record):
    """A drawn channel. ``gain`` is the current slot as observed, null = missing; ``truth`` without the loss."""

    facts: dict[str, str]
    num_slots: int
    num_users: int
    num_subcarriers: int
    missing: int
    user_names: list[str]
    user_mean_gain: Vector
    gain: Matrix
    truth: Matrix | None
    seed: int
    out: Path | None

    def blocks(self) -> list[Block]:
        import numpy as np

        from wirelessagent.model.units import db

        gains = [f"{float(db(gain, floor_db=-400.0)):.1f} dB" for gain in self.user_mean_gain]
        lost = [f"{sum(np.isnan(row))} of {len(row)}" for row in self.gain]
        rows = tuple(zip(self.user_names, gains, lost, strict=True))
        said: list[Block] = [
            tuple(f"{label}: {text}" for label, text in self.facts.items()),
            Table(title="Channel", columns=("user", "mean gain", "missing subcarriers"), rows=rows),
        ]
        return [*said, Files("written to", (self.out,))] if self.out else said


def run(request: SimulateRequest, progress: Progress) -> SimulateRecord:
    from wirelessagent import chain
    from wirelessagent.agent.state import describe
    from wirelessagent.sensing.loss import parse
    from wirelessagent.sensing.npz import write_npz

    check_gains(request.out)
    losses = [parse(text) for text in request.loss]
    scene = chain.simulate(request.source, request.cell(), seed=request.seed, **request.source_options)
    seen = scene.observe(*losses, seed=request.seed)
    progress(Event(stage="sense", message=describe(seen)))
    if request.out is not None:
        write_npz(request.out, *scene_arrays(scene, seen))
    truth = scene.current_truth
    return SimulateRecord(
        facts=dict(scene.facts),
        num_slots=seen.num_slots,
        num_users=seen.num_users,
        num_subcarriers=seen.num_subcarriers,
        missing=int(seen.missing.sum()),
        user_names=list(seen.user_names),
        user_mean_gain=(seen.current if truth is None else truth).mean(axis=1),  # pyright: ignore[reportArgumentType]
        gain=seen.current,  # pyright: ignore[reportArgumentType]
        truth=truth,  # pyright: ignore[reportArgumentType]
        seed=request.seed,
        out=request.out,
    )


def scene_arrays(scene: Scene, seen: ChannelObservation) -> tuple[dict[str, Any], dict[str, Any]]:
    """The arrays and the metadata under which an observed scene is written, and read back by the file source."""
    import numpy as np

    arrays: dict[str, Any] = {"gain": seen.gain, "user_names": np.array(seen.user_names)}
    optional = {
        "truth": scene.truth,
        "noise_variance": seen.noise_variance,
        "repaired": seen.estimated,
        "subcarrier_frequencies_hz": seen.subcarrier_frequencies_hz,
        "slot_times_s": seen.slot_times_s,
    }
    arrays.update({name: value for name, value in optional.items() if value is not None})
    meta = channel_meta(scene.cell, axes="slot,user,subcarrier" if seen.gain.ndim == 3 else "user,subcarrier")
    return arrays, meta


SIMULATE = Operation(
    name="simulate",
    request=SimulateRequest,
    record=SimulateRecord,
    run=run,
    examples=(
        "simulate --num-users 8 --loss random:0.2 --out seen.npz",
        "simulate --source cqi --loss bursts:0.2",
    ),
)
