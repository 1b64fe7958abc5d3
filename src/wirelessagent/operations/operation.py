"""What every surface is derived from: an operation is one request, one function and one record.

A surface (command line, REST, MCP, console) reads the list in :mod:`wirelessagent.operations.catalogue`. The request's
fields are its options, the record's fields its answer; nothing about an operation is written down a second time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, Generic, TypeAlias, TypeVar

from pydantic import BaseModel, ConfigDict, field_validator

from wirelessagent import __version__
from wirelessagent.model.errors import InputError, WirelessAgentError
from wirelessagent.operations.record import Record

__all__ = [
    "AnyOperation", "Event", "InputError", "Operation", "Progress", "Request", "WirelessAgentError",
    "installed_version", "silent",
]  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Event:
    """Something that just happened in a running operation.

    Attributes:
        stage: "read", "understand", "note", "sense", "repair", "decide", "act" or the name of a piece of long work.
        message: one sentence for the user.
        done, total: how far counted work has come; both 0 where nothing is counted.
    """

    stage: str
    message: str
    done: int = 0
    total: int = 0


def installed_version() -> str:
    """The version of this package."""
    return __version__


Progress: TypeAlias = Callable[[Event], None]


def silent(event: Event) -> None:
    """A progress listener for callers that want none."""
    del event


class Request(BaseModel):
    """The base of all requests. ``panel`` is the heading under which its own fields are listed."""

    model_config = ConfigDict(extra="forbid", frozen=True, arbitrary_types_allowed=True)

    panel: ClassVar[str] = "Options"

    @field_validator("*", mode="before")
    @classmethod
    def _is_text(cls, value: Any) -> Any:
        """Refuse text that is not Unicode, such as bytes of another encoding on a command line."""
        if isinstance(value, str) and not value.isprintable() and any("\ud800" <= sign <= "\udfff" for sign in value):
            raise ValueError("this is not text in UTF-8")
        return value


Req = TypeVar("Req", bound=Request)
Rec = TypeVar("Rec", bound=Record)


@dataclass(frozen=True, kw_only=True)
class Operation(Generic[Req, Rec]):
    """One thing that can be asked for.

    Attributes:
        name: as typed on the command line.
        summary: one sentence.
        request: the type of its request.
        record: the type of its record.
        run: the function.
    """

    name: str
    summary: str
    request: type[Req]
    record: type[Rec]
    run: Callable[[Req, Progress], Rec]


AnyOperation: TypeAlias = Operation[Any, Any]
