"""reproduce: the paper's figures, each as a picture, a table and a record, and the verdicts on its claims."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from wirelessagent.experiments.catalogue import EXPERIMENTS, VERDICTS, reproduce
from wirelessagent.model.errors import InputError
from wirelessagent.operations.fields import Positional
from wirelessagent.operations.operation import Event, Operation, Progress, Request
from wirelessagent.operations.record import Block, Files, Record, Table


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
    """The files written and the verdicts: each claim with its place, verdict, figures and reason."""

    figures: list[ReproducedFigure]
    verdicts: list[dict[str, Any]]
    verdict_files: list[Path]

    def blocks(self) -> list[Block]:
        rows = tuple((one.name, one.summary) for one in self.figures)
        said: list[Block] = [
            Table(title="Reproduced", columns=("figure", "what it shows"), rows=rows),
            Files("written to", tuple(path for one in self.figures for path in one.files)),
        ]
        if not self.verdicts:
            return said
        claims = tuple(
            (f"“{one['claim']}” ({one['place']})", "; ".join(one["measured"]), one["verdict"], one["reason"])
            for one in self.verdicts
        )
        columns = ("the paper says", "measured (95 % interval)", "verdict", "why")
        table = Table(title="Verdicts", columns=columns, rows=claims)
        return [*said, table, Files("verdicts written to", tuple(self.verdict_files))]


def run(request: ReproduceRequest, progress: Progress) -> ReproduceRecord:
    if request.draws < 1:
        raise InputError(f"draws must be 1 or more; got {request.draws}")

    def told(name: str, done: int, total: int) -> None:
        progress(Event(stage=name, message=EXPERIMENTS[name].summary, done=done, total=total))

    names = request.names or list(EXPERIMENTS)
    made = reproduce(names, out=request.out, draws=request.draws, seed=request.seed, progress=told)
    return ReproduceRecord(
        figures=[
            ReproducedFigure(name=name, summary=EXPERIMENTS[name].summary, files=list(files))
            for name, files in made.files.items()
            if name != VERDICTS
        ],
        verdicts=[one.to_dict() for one in made.verdicts],
        verdict_files=list(made.files.get(VERDICTS, ())),
    )


REPRODUCE = Operation(
    name="reproduce",
    request=ReproduceRequest,
    record=ReproduceRecord,
    local=True,
    run=run,
    examples=("reproduce --draws 200", "reproduce rate_versus_power --out figures"),
)
