"""intent: what a sentence is understood to mean, without doing anything."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from wirelessagent.language.intent import Intent
from wirelessagent.language.offline import recognise
from wirelessagent.operations.fields import Positional
from wirelessagent.operations.operation import Operation, Progress, Request
from wirelessagent.operations.record import Block, Record, Table


class IntentRequest(Request):
    text: Annotated[str, Positional()] = Field(description="what the cell should do, in English or Chinese")


class IntentRecord(Record):
    """What was understood. ``objective`` is a registered name or null, ``reply`` what the agent says to it."""

    text: str
    kind: str
    objective: str | None
    constraints: dict[str, float]
    language: str
    confidence: float
    evidence: dict[str, str]
    reply: str
    recogniser: str

    @classmethod
    def of(cls, text: str, intent: Intent) -> IntentRecord:
        names = set(cls.model_fields) - {"text"}
        values = {name: getattr(intent, name) for name in names}
        values["constraints"] = dict(intent.constraints)
        values["evidence"] = dict(intent.evidence)
        return cls(text=text, **values)

    @property
    def needs_answer(self) -> bool:
        return self.kind == "clarify"

    def blocks(self) -> list[Block]:
        rows = [("objective", self.objective or "–", self.evidence.get("objective", ""))]
        rows += [(name, f"{value:g}", self.evidence.get(name, "")) for name, value in self.constraints.items()]
        table = Table(title="Understood", columns=("field", "value", "from the words"), rows=tuple(rows))
        return [table, self.reply] if self.kind == "allocate" else [self.reply]


def run(request: IntentRequest, progress: Progress) -> IntentRecord:
    del progress
    return IntentRecord.of(request.text, recognise(request.text))


INTENT = Operation(
    name="intent",
    summary="Show what a sentence is understood to mean, without doing anything",
    request=IntentRequest,
    record=IntentRecord,
    run=run,
)
