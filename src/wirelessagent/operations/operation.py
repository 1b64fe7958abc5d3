"""What every surface is derived from: an operation is one request, one function and one record.

A surface (command line, REST, MCP, console) reads the list in :mod:`wirelessagent.operations.catalogue`. The request's
fields are its options, the record's fields its answer; nothing about an operation is written down a second time.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Generic, TypeAlias, TypeVar

from pydantic import BaseModel, ConfigDict, field_validator

from wirelessagent import __version__
from wirelessagent.model.errors import InputError, NothingRecordedError, WirelessAgentError
from wirelessagent.model.legible import legible, written_out
from wirelessagent.operations.catalogue import OPERATIONS
from wirelessagent.operations.record import Record
from wirelessagent.telling.catalogue import Event, Progress, silent

__all__ = [
    "AnyOperation", "Conversation", "Event", "InputError", "NothingRecordedError", "Operation", "Progress", "Request",
    "WirelessAgentError", "installed_version", "legible", "silent", "written_out",
]  # fmt: skip


def installed_version() -> str:
    """The version of this package."""
    return __version__


class Request(BaseModel):
    """The base of all requests. ``panel`` is the heading under which its own fields are listed."""

    model_config = ConfigDict(extra="forbid", frozen=True, arbitrary_types_allowed=True, defer_build=True)

    panel: ClassVar[str] = "Options"

    @field_validator("*", mode="before")
    @classmethod
    def _is_text(cls, value: Any) -> Any:
        """Refuse text that is not Unicode, such as bytes of another encoding on a command line."""
        if isinstance(value, str) and not value.isprintable() and any("\ud800" <= sign <= "\udfff" for sign in value):
            raise ValueError("this is not text in UTF-8")
        return value


@dataclass(frozen=True, kw_only=True)
class Conversation:
    """What goes on line by line.

    Attributes:
        answer: the record of a line; None where the line ends the conversation.
        lines: those that the request holds; None where they are still to come.
        opening: what can be said, for people who type it.
    """

    answer: Callable[[str], Record | None]
    lines: Sequence[str] | None = None
    opening: str = ""


Req = TypeVar("Req", bound=Request)
Rec = TypeVar("Rec", bound=Record)


@dataclass(frozen=True, kw_only=True)
class Operation(Generic[Req, Rec]):
    """One thing that can be asked for.

    Attributes:
        name: as the catalogue lists it, with its summary.
        request: the type of its request.
        record: the type of its record.
        run: the function.
        converse: of an operation that goes on line by line: opens it, so that each line gets a record, and None ends
            it. Where a surface can, it hands the lines over as they come; ``run`` takes those of the request.
        examples: what people type after the program's name.
        local: whether it is only for whoever sits at the machine: it reads or writes files of theirs.
        recorded: whether it leaves a turn in the audit store; without one and without files it changes nothing.
    """

    name: str
    request: type[Req]
    record: type[Rec]
    run: Callable[[Req, Progress], Rec]
    converse: Callable[[Req, Progress], Conversation] | None = None
    examples: tuple[str, ...] = ()
    local: bool = False
    recorded: bool = False

    @property
    def summary(self) -> str:
        """One sentence."""
        return OPERATIONS[self.name]


AnyOperation: TypeAlias = Operation[Any, Any]
