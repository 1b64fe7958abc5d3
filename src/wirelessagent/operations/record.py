"""Answers: typed, JSON-able, and able to show themselves as text and tables on any surface."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import BaseModel, BeforeValidator, ConfigDict

from wirelessagent.telling.catalogue import Table

Lines: TypeAlias = tuple[str, ...]


@dataclass(frozen=True)
class Files:
    """Files or other places, and what was done with them; a surface breaks no path, so that it can be copied."""

    done: str
    paths: tuple[Path | str, ...]


Block: TypeAlias = str | Lines | Table | Files
"""A paragraph on one line, several lines, a table, or files. A line break inside a line or a cell is no layout of ours:
it came with a name or a sentence, and a surface writes it out."""


Conclusion: TypeAlias = Literal["done", "failed", "unclear", "unmet"]
"""What an operation came to, for a surface to tell in its own way, as by an exit code: done; failed; unclear (a
question back, a plan that waits for a yes, input of which a part could not be read); unmet (infeasible, or undecided).
What could not be tried at all is an error instead."""


def of_decision(status: str) -> Conclusion:
    """What a decision of this status comes to."""
    return "done" if status in ("optimal", "feasible") else "unmet"


class Record(BaseModel):
    """The base of all records. NaN and infinity become null in JSON."""

    model_config = ConfigDict(extra="forbid", frozen=True, ser_json_inf_nan="null", defer_build=True)

    def blocks(self) -> list[Block]:
        """The record as paragraphs and tables, in the order in which people read them."""
        return []

    @property
    def conclusion(self) -> Conclusion:
        """What the operation came to."""
        return "done"

    @property
    def raw_lines(self) -> list[str] | None:
        """What is printed as it stands, one line each, in the place of blocks and of JSON; None for most records."""
        return None

    @property
    def faults(self) -> tuple[str, ...]:
        """What went wrong in parts, for the error output."""
        return ()


def as_json(record: Record) -> Any:
    """A record as plain data that JSON can hold: what the command line prints."""
    return json.loads(record.model_dump_json())


def _as_list(value: Any) -> Any:
    return value.tolist() if hasattr(value, "tolist") else value  # an array; numpy is not loaded for the asking


Vector: TypeAlias = Annotated[list[float], BeforeValidator(_as_list)]
Matrix: TypeAlias = Annotated[list[list[float]], BeforeValidator(_as_list)]
GapMatrix: TypeAlias = Annotated[list[list[float | None]], BeforeValidator(_as_list)]  # NaN, which is null in JSON
Integers: TypeAlias = Annotated[list[int], BeforeValidator(_as_list)]
Switches: TypeAlias = Annotated[list[bool], BeforeValidator(_as_list)]
SwitchMatrix: TypeAlias = Annotated[list[list[bool]], BeforeValidator(_as_list)]
