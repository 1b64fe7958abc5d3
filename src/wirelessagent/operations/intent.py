"""intent: what sentences are understood to mean, without doing anything."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

from pydantic import Field

from wirelessagent.model.errors import InputError
from wirelessagent.operations.fields import Positional
from wirelessagent.operations.operation import Operation, Progress
from wirelessagent.operations.recognisers import RecogniserOption
from wirelessagent.operations.record import Block, Conclusion, Record, Table
from wirelessagent.telling.catalogue import message

if TYPE_CHECKING:
    from wirelessagent.language.intent import Constraint, Detail, Intent
    from wirelessagent.language.recogniser import Recogniser


class IntentRequest(RecogniserOption):
    text: Annotated[str | None, Positional()] = Field(
        None, description="what the cell should do, in English or Chinese; plain requests in Spanish, French and German"
    )
    batch: Path | None = Field(None, description='file of JSON lines, {"text": …} each; answered with a JSON line each')


class IntentRecord(Record):
    """What was understood. ``objective`` is a registered name or null, ``reply`` what the agent says to it."""

    text: str
    kind: str
    objective: str | None
    constraints: dict[str, Any]
    language: str
    confidence: float
    evidence: dict[str, str]
    reply: str
    recogniser: str
    topic: str | None = None
    details: dict[str, Any] = Field(default_factory=dict)
    amends: bool = False
    dropped: list[str] = Field(default_factory=list)
    pending: dict[str, Any] = Field(default_factory=dict)

    @classmethod
    def of(cls, text: str, intent: Intent) -> IntentRecord:
        names = set(cls.model_fields) - {"text"}
        values: dict[str, Any] = {name: getattr(intent, name) for name in names}
        values |= {name: plain(values[name]) for name in ("constraints", "details", "pending", "evidence")}
        values["dropped"] = list(intent.dropped)
        return cls(text=text, **values)

    @property
    def conclusion(self) -> Conclusion:
        return "unclear" if self.kind == "clarify" else "done"

    def blocks(self) -> list[Block]:
        rows = [("objective", self.objective or "–", self.evidence.get("objective", ""))]
        rows += [(name, shown(value), self.evidence.get(name, "")) for name, value in self.constraints.items()]
        columns = tuple(message(self.language, f"label.{column}") for column in ("field", "given", "from_the_words"))
        table = Table(title=message(self.language, "label.understood"), columns=columns, rows=tuple(rows))
        reply = tuple(self.reply.split("\n"))
        return [table, reply] if self.kind == "allocate" else [reply]


class IntentsRecord(Record):
    """What each line of a file was understood to mean; a line that could not be read has its error instead."""

    intents: list[IntentRecord | dict[str, Any]]

    @property
    def faults(self) -> tuple[str, ...]:
        return tuple(str(each["error"]) for each in self.intents if isinstance(each, dict))

    @property
    def conclusion(self) -> Conclusion:
        return "unclear" if self.faults else "done"

    @property
    def raw_lines(self) -> list[str]:
        return [
            json.dumps(each, ensure_ascii=False) if isinstance(each, dict) else each.model_dump_json()
            for each in self.intents
        ]


def plain(value: Constraint | Detail | Mapping[str, Any]) -> Any:
    """A value as JSON has it."""
    if isinstance(value, Mapping):
        return {str(key): plain(each) for key, each in value.items()}
    return list(value) if isinstance(value, tuple) else value


def shown(value: Any) -> str:
    """A constraint's value on one line: "2e+06", "user 3: 2e+06", "3, 5"."""
    if isinstance(value, dict):
        return ", ".join(f"{user}: {figure:g}" for user, figure in cast("dict[str, float]", value).items())
    return ", ".join(cast("list[str]", value)) if isinstance(value, list) else f"{value:g}"


def run(request: IntentRequest, progress: Progress) -> Record:
    del progress
    if (request.text is None) == (request.batch is None):
        raise InputError("say either a sentence or --batch FILE, one of the two")
    recogniser = request.chosen_recogniser()
    if request.text is not None:
        return IntentRecord.of(request.text, recogniser.recognise(request.text))
    assert request.batch is not None
    return IntentsRecord(intents=[
        _understood(line, number, recogniser)
        for number, line in enumerate(lines_of(request.batch), start=1) if line.strip()
    ])  # fmt: skip


def lines_of(path: Path) -> list[str]:
    """The lines of a text file.

    Raises:
        InputError: the file cannot be read.
    """
    try:
        return path.read_text(encoding="utf-8-sig", errors="replace").split("\n")
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror or error}") from error


def text_of(line: str) -> str:
    """The text of a line {"text": …}.

    Raises:
        ValueError: it is no such line; the message says what is wrong.
    """
    try:
        row = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"not JSON ({getattr(error, 'msg', 'nested too deep')})") from error
    text = cast("dict[str, Any]", row).get("text") if isinstance(row, dict) else None
    if not isinstance(text, str):
        raise ValueError('no {"text": "…"}')
    return text.encode("utf-8", "replace").decode("utf-8")


def _understood(line: str, number: int, recogniser: Recogniser) -> IntentRecord | dict[str, Any]:
    try:
        text = text_of(line)
    except ValueError as error:
        return {"line": number, "error": f"line {number}: {error}"}
    return IntentRecord.of(text, recogniser.recognise(text))


INTENT = Operation[IntentRequest, Record](
    name="intent",
    request=IntentRequest,
    record=IntentRecord,
    run=run,
    examples=(
        'intent "At least 500 kbps for everyone with as little power as possible"',
        "intent --batch wishes.jsonl",
    ),
)
