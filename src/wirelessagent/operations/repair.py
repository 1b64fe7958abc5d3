"""repair: fill the holes of a gain matrix, with how sure each filled entry is."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from wirelessagent import chain
from wirelessagent.model.arrays import BoolArray, FloatArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.units import db
from wirelessagent.operations.answers import EstimateAnswer
from wirelessagent.operations.channel_file import ChannelFile
from wirelessagent.operations.fields import OptionsOf, PluginName, PluginOptions
from wirelessagent.operations.operation import Event, Operation, Progress
from wirelessagent.operations.outputs import channel_meta, check_gains, check_picture, draw_repair, is_csv
from wirelessagent.operations.record import Block, Files, Record, Table
from wirelessagent.sensing.csv_gains import write_csv
from wirelessagent.sensing.npz import write_npz


class RepairRequest(ChannelFile):
    panel = "Options"

    method: Annotated[str | None, PluginName("repairer")] = Field(
        None, description="repairer; kriging if not given, with history the predictor"
    )
    method_options: Annotated[PluginOptions, OptionsOf("repairer")] = Field(
        default_factory=dict, description="options of the repairer"
    )
    out: Path | None = Field(
        None, description="file to write: NPZ with gain, gain_variance and repaired, or CSV with the gains alone"
    )
    plot: Path | None = Field(None, description="picture of the gains before and after: PNG, SVG or PDF")


class RepairRecord(Record):
    """A repaired gain matrix. The error is known only where the file holds the truth."""

    facts: dict[str, str]
    missing: int
    entries: int
    estimate: EstimateAnswer
    normalised_rmse: float | None
    out: Path | None
    plot: Path | None

    def blocks(self) -> list[Block]:
        said: list[Block] = [self._summary(), self._users()]
        if self.normalised_rmse is not None:
            said.append(f"error of the repaired entries: {self.normalised_rmse:.3g} of the user's mean gain (RMSE)")
        if self.out is not None:
            said.append(Files("written to", (self.out,)))
            said += [_GAINS_ALONE] * is_csv(self.out)
        return [*said, Files("written to", (self.plot,))] if self.plot else said

    def _summary(self) -> str:
        if not self.missing:
            return "nothing was missing, so nothing was repaired"
        return f"{self.missing} of {self.entries} gains repaired by {self.estimate.method}"

    def _users(self) -> Table:
        rows: list[tuple[str, ...]] = []
        for k, name in enumerate(self.estimate.user_names):
            gain, repaired = np.array(self.estimate.gain[k]), np.array(self.estimate.repaired[k])
            deviation = np.sqrt(np.array(self.estimate.gain_variance[k])[repaired])
            relative = f"{np.mean(deviation) / gain.mean():.0%} of the mean" if repaired.any() and gain.any() else "–"
            level = f"{float(db(gain.mean(), floor_db=-400.0)):.1f} dB"
            note = "never observed: a guess" if name in self.estimate.unobserved_users else ""
            rows.append((name, level, str(int(repaired.sum())), relative, note))
        return Table(
            title="Repaired channel",
            columns=("user", "mean gain", "repaired", "typical uncertainty", "note"),
            rows=tuple(rows),
        )


_GAINS_ALONE = "CSV holds the gains alone; which of them are repaired, how sure they are, noise and bandwidth need NPZ"


def run(request: RepairRequest, progress: Progress) -> RepairRecord:
    from wirelessagent.agent.state import describe

    check_gains(request.out, csv=True)
    check_picture(request.plot)
    scene = request.scene(progress)
    seen = scene.sensed
    estimate = chain.repair(seen, request.method, **request.method_options)
    progress(Event(stage="repair", message=describe(seen)))
    if request.out is not None:
        _write(request.out, estimate, scene.cell)
    if request.plot is not None:
        draw_repair(request.plot, seen, estimate)
    return RepairRecord(
        facts=dict(scene.facts),
        missing=int(seen.missing.sum()),
        entries=seen.missing.size,
        estimate=EstimateAnswer.of(estimate),
        normalised_rmse=_error(estimate.gain, scene.current_truth, estimate.repaired),
        out=request.out,
        plot=request.plot,
    )


def _write(path: Path, estimate: ChannelEstimate, cell: Cell) -> None:
    if is_csv(path):
        write_csv(path, estimate.gain, estimate.user_names)
        return
    arrays: dict[str, Any] = {
        "gain": estimate.gain,
        "gain_variance": estimate.gain_variance,
        "repaired": estimate.repaired,
        "user_names": np.array(estimate.user_names),
    }
    write_npz(path, arrays, channel_meta(cell, axes="user,subcarrier", maker=f", repairer {estimate.method}"))


def _error(gain: FloatArray, truth: FloatArray | None, repaired: BoolArray) -> float | None:
    """RMSE over the repaired entries, each in units of its user's mean true gain; None where it cannot be known."""
    if truth is None or not repaired.any() or not np.all(truth.mean(axis=1) > 0):
        return None
    error: FloatArray = (gain - truth) / truth.mean(axis=1, keepdims=True)
    return float(np.sqrt(np.mean(np.square(error[repaired]))))


REPAIR = Operation(
    name="repair",
    request=RepairRequest,
    record=RepairRecord,
    run=run,
    examples=("repair gains.csv --out repaired.npz", "repair seen.npz --method nncf --out repaired.npz"),
)
