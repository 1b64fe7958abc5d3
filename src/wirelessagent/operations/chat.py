"""chat: a conversation about one cell, line by line."""

from __future__ import annotations

from pathlib import Path

from pydantic import Field

from wirelessagent.model.errors import InputError
from wirelessagent.operations.operation import Conversation, Operation, Progress
from wirelessagent.operations.record import Block, Conclusion, Record
from wirelessagent.operations.recording import RecordingOptions
from wirelessagent.operations.site_options import SiteOptions
from wirelessagent.operations.turn_record import TurnRecord

_OPENING = (
    'Say what the cell should do, such as "Highest total rate, at most 10 W"; go on with "at least 1 Mbit/s for '
    'user 2", "how sure is this?", "what if we had 20 W?" or "undo". "quit" leaves.'
)
_LEAVE = frozenset({"quit", "exit", "bye", "q", "退出", "再见"})


class ChatRequest(RecordingOptions, SiteOptions):
    panel = "Options"

    say: list[str] | None = Field(
        None, description="what the operator says, once per turn; read as it comes if not given"
    )
    script: Path | None = Field(None, description="text file with what the operator says, one turn per line")

    def lines(self) -> list[str] | None:
        """What is said; None where that is still to come.

        Raises:
            InputError: both or neither can be had, or the file cannot be read.
        """
        if self.script is None:
            return self.say
        if self.say is not None:
            raise InputError("what is said comes from --say or from --script, not from both")
        try:
            return self.script.read_text(encoding="utf-8-sig").splitlines()
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"the script {self.script} cannot be read as UTF-8 text: {error}") from error


class ChatRecord(Record):
    """A whole conversation."""

    turns: list[TurnRecord]

    def blocks(self) -> list[Block]:
        return [block for turn in self.turns for block in (f"> {turn.text}", *turn.blocks())]

    @property
    def conclusion(self) -> Conclusion:
        """That of the last turn."""
        return self.turns[-1].conclusion if self.turns else "done"


def converse(request: ChatRequest, progress: Progress) -> Conversation:
    """Open a conversation: each line gets its turn, empty ones and one that takes leave get none."""
    lines = request.lines()
    session = request.session(progress)

    def answer(line: str) -> TurnRecord | None:
        if line.strip().casefold() in _LEAVE:
            return None
        turn, stored = request.said(session, line)
        return TurnRecord.of(turn, session, stored)

    return Conversation(answer=answer, lines=lines, opening=_OPENING)


def run(request: ChatRequest, progress: Progress) -> ChatRecord:
    conversation = converse(request, progress)
    if conversation.lines is None:
        raise InputError("nothing is said: give what the operator says in say, one text per turn")
    turns: list[TurnRecord] = []
    for line in conversation.lines:
        if line.strip():
            record = conversation.answer(line)
            if not isinstance(record, TurnRecord):
                break
            turns.append(record)
    return ChatRecord(turns=turns)


CHAT = Operation(
    name="chat",
    request=ChatRequest,
    record=ChatRecord,
    local=True,
    recorded=True,
    run=run,
    converse=converse,
    examples=("chat", "chat --csi gains.csv", 'chat --say "maximum rate" --say "why user 3?"'),
)
