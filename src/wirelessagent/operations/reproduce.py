"""reproduce: the paper's figures, each as a picture, a table and a record of how it was made."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import Field

from wirelessagent.experiments.catalogue import EXPERIMENTS, reproduce
from wirelessagent.model.errors import InputError, UnknownNameError
from wirelessagent.operations.fields import Positional
from wirelessagent.operations.operation import Event, Operation, Progress, Request
from wirelessagent.operations.record import Block, Record, Table


class ReproduceRequest(Request):
    names: Annotated[list[str], Positional()] = Field(
        default_factory=list, description=f"figures to reproduce, all if none are named: {', '.join(EXPERIMENTS)}"
    )
    out: Path = Field(Path("reproduced"), description="folder for the pictures, tables and records")
    draws: int = Field(2000, description="channel draws per point")
    seed: int = Field(1, description="seed of every draw")


class ReproducedFigure(Record):
    """One experiment's files."""

    name: str
    summary: str
    files: list[Path]


class ReproduceRecord(Record):
    """The files written."""

    figures: list[ReproducedFigure]

    def blocks(self) -> list[Block]:
        rows = tuple(
            (one.name, one.summary, str(path)) if path is one.files[0] else ("", "", str(path))
            for one in self.figures
            for path in one.files
        )
        return [Table(title="Reproduced", columns=("figure", "what it shows", "files"), rows=rows)]


def run(request: ReproduceRequest, progress: Progress) -> ReproduceRecord:
    names = request.names or list(EXPERIMENTS)
    for name in names:
        if name not in EXPERIMENTS:
            raise UnknownNameError("figure", name, EXPERIMENTS)
    if request.draws < 1:
        raise InputError(f"draws must be 1 or more; got {request.draws}")
    return ReproduceRecord(figures=[_reproduce(name, request, progress) for name in names])


def _reproduce(name: str, request: ReproduceRequest, progress: Progress) -> ReproducedFigure:
    def told(done: int, total: int) -> None:
        progress(Event(stage=name, message=EXPERIMENTS[name].summary, done=done, total=total))

    files = reproduce(name, out=request.out, draws=request.draws, seed=request.seed, progress=told)
    return ReproducedFigure(name=name, summary=EXPERIMENTS[name].summary, files=files)


REPRODUCE = Operation(
    name="reproduce",
    summary="Reproduce the paper's figures: a picture, a CSV table and a JSON record each",
    request=ReproduceRequest,
    record=ReproduceRecord,
    run=run,
)
