"""A worker: the process in which operations run and conversations live, so that the server's own stays light and safe.

It is told what to do by lines of JSON on its standard input and answers by lines of JSON on its standard output; it can
be ended at any moment, and what was recorded is all that its successor needs.

    {"id": 1, "do": "operation", "name": "solve", "form": {…}, "channel": "/…/gains.csv"}
    {"id": 1, "begun": true}
    {"id": 1, "event": {"stage": "repair", …}}
    {"id": 1, "done": {…}}        or        {"id": 1, "failed": {"title": "…", "detail": "…", "status": 422}}
"""

from __future__ import annotations

import base64
import json
import os
import sys
import tempfile
from collections import OrderedDict
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import IO, Any

from wirelessagent.operations.allocation_file import allocation_file
from wirelessagent.operations.catalogue import OPERATIONS, load
from wirelessagent.operations.chat import CHAT, ChatRequest
from wirelessagent.operations.forms import (
    can_be_filled,
    filled,
    form_of,
    needs_channel,
    takes_channel,
    telling_what_is_wrong,
)
from wirelessagent.operations.hosted import Hosted, facts_of, seen_in
from wirelessagent.operations.intended import sentence_of
from wirelessagent.operations.operation import (
    Event,
    InputError,
    NothingRecordedError,
    Progress,
    WirelessAgentError,
)
from wirelessagent.operations.outputs import can_draw
from wirelessagent.operations.paragraphs import as_plain
from wirelessagent.operations.record import Record, as_json

_DEFAULT_MEMORY_BYTES = 6 << 30

_MOST_HOSTED = 50
"""Conversations in memory; the one that was left longest ago is taken up again where it goes on after all."""


class Worker:
    """What a worker can do; each method is one thing to be told."""

    def __init__(self) -> None:
        self._hosted: OrderedDict[str, Hosted] = OrderedDict()

    def operation(self, told: Mapping[str, Any], progress: Progress) -> Any:
        """Run an operation of the catalogue on a form."""
        operation = load(told["name"])
        if operation.local:
            raise InputError(f"{operation.name!r} is only for whoever sits at the machine")
        channel = told.get("channel")
        if channel is None and needs_channel(operation):
            raise InputError(f"{operation.name} needs a channel: give the id of an observation in 'observation'")
        with telling_what_is_wrong(operation.name):
            form = form_of(operation)(**told["form"])
        request = filled(operation, form, channel)
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / "picture.svg"
            files = {"out": Path(told["out"])} if "out" in told else {}  # gains to be kept, where the server says
            if told.get("picture") and "plot" in operation.request.model_fields and can_draw():
                files["plot"] = picture
            record = operation.run(request.model_copy(update=files), progress)
            drawn = picture.read_text(encoding="utf-8") if picture.exists() else None
        record = record.model_copy(update=dict.fromkeys(files))  # where they are is nobody else's business
        return {
            "record": as_json(record),
            "blocks": [as_plain(block) for block in record.blocks()],
            "conclusion": record.conclusion,
            "picture": drawn,
        }

    def forms(self, told: Mapping[str, Any], progress: Progress) -> Any:
        """The JSON Schema of each operation's form and of its record, and of a cell's options."""
        del told, progress
        found = [one for one in map(load, OPERATIONS) if not one.local and can_be_filled(one)]
        forms = [
            {
                "name": operation.name,
                "summary": operation.summary,
                "channel": "needed" if needs_channel(operation) else "possible" if takes_channel(operation) else "no",
                "recorded": operation.recorded,
                "schema": form_of(operation).model_json_schema(),
                "record": operation.record.model_json_schema(mode="serialization"),
            }
            for operation in found
        ]
        return {"operations": forms, "cell": form_of(CHAT).model_json_schema()}

    def facts(self, told: Mapping[str, Any], progress: Progress) -> Any:
        """What a cell is."""
        return facts_of(_cell(told), progress)

    def say(self, told: Mapping[str, Any], progress: Progress) -> Any:
        """A line of a conversation."""
        hosted = self._conversation(told, progress)
        known = min(told["turns"], hosted.number)
        hosted.say(told["text"], progress, by=told["by"])
        return _since(hosted, known)

    def press(self, told: Mapping[str, Any], progress: Progress) -> Any:
        """A button of a conversation, where it is as whoever pressed has seen it; else nothing is pressed."""
        hosted = self._conversation(told, progress)
        known = min(told["turns"], hosted.number)
        if hosted.number != told["turns"]:
            return {**_since(hosted, known), "stale": True}
        hosted.press(told["button"], progress, by=told["by"])
        return _since(hosted, known)

    def intended(self, told: Mapping[str, Any], progress: Progress) -> Any:
        """The sentence that asks for what an intent of TMF921 says."""
        del progress
        return sentence_of(told["intent"], told["user_names"])

    def broke_off(self, told: Mapping[str, Any], progress: Progress) -> Any:
        """A button whose process ended before anybody was told what came of it; it is told now, as it was recorded.

        Where nothing was recorded, that it broke off is what is recorded.
        """
        hosted = self._conversation(told, progress)
        known = min(told["turns"], hosted.number)
        if hosted.number == told["turns"]:
            hosted.broke_off(told["button"], progress, by=told["by"])
        return _since(hosted, known)

    def trade_off(self, told: Mapping[str, Any], progress: Progress) -> Any:
        """The curve that a turn's decision lies on."""
        return self._conversation(told, progress).trade_off(told["number"], progress)

    def inspect(self, told: Mapping[str, Any], progress: Progress) -> Any:
        """What a file with gains holds; written as it was understood, where that is wanted."""
        return seen_in(_cell(told), progress, Path(told["out"]) if told.get("out") else None)

    def allocation(self, told: Mapping[str, Any], progress: Progress) -> Any:
        """The allocation of a recorded turn as a file."""
        del progress
        media_type, content = allocation_file(told["number"], told["format"])
        return {"media_type": media_type, "content": base64.b64encode(content).decode("ascii")}

    def _conversation(self, told: Mapping[str, Any], progress: Progress) -> Hosted:
        """The conversation that is meant; taken up where this process does not have it, or not as far as it is."""
        identity = told["session"]
        hosted = self._hosted.pop(identity, None)
        if hosted is not None and told["turns"] > hosted.number:  # another server went on with it
            hosted.catch_up(progress)
        if hosted is None or told["turns"] != hosted.number:
            recalled = [(text, pressed) for text, pressed in told.get("recalled", ())]
            hosted = Hosted(_cell(told), identity, progress, recalled=recalled)
        self._hosted[identity] = hosted
        while len(self._hosted) > _MOST_HOSTED:
            self._hosted.popitem(last=False)
        return hosted


def _since(hosted: Hosted, number: int) -> dict[str, Any]:
    """The turns behind the one of this number, and what is known of the channel."""
    turns = [turn for turn in hosted.turns if turn.record.number > number]
    channel = hosted.channel()
    return {
        "number": hosted.number,
        "stale": False,
        "turns": [as_json(turn) for turn in turns],
        "channel": None if channel is None else as_json(channel),
    }


def _cell(told: Mapping[str, Any]) -> ChatRequest:
    with telling_what_is_wrong("options"):
        form = form_of(CHAT)(**told["options"])
    request = filled(CHAT, form, told.get("channel"))
    assert isinstance(request, ChatRequest)
    return request


def _told(error: BaseException) -> dict[str, Any]:
    if isinstance(error, NothingRecordedError):
        return {"status": 404, "title": "There is no such thing", "detail": str(error)}
    if isinstance(error, InputError):
        return {"status": 422, "title": "This cannot be used", "detail": str(error)}
    if isinstance(error, WirelessAgentError):
        return {"status": 500, "title": "This failed", "detail": str(error)}
    if isinstance(error, MemoryError):
        return {"status": 422, "title": "Too large", "detail": "not enough memory for this input"}
    return {"status": 500, "title": "Internal error", "detail": f"{type(error).__name__}; the server's log says more"}


def serve(lines: IO[str], answers: IO[str]) -> None:
    """Do what each line says until there are no more."""
    worker = Worker()

    def answer(identity: int, **what: Any) -> None:
        answers.write(json.dumps({"id": identity, **what}, ensure_ascii=True, separators=(",", ":")) + "\n")
        answers.flush()

    for line in lines:
        told = json.loads(line)
        identity = told["id"]
        answer(identity, begun=True)

        def progress(event: Event, identity: int = identity) -> None:
            shown = {"stage": event.stage, "label": event.label, "message": event.message}
            answer(identity, event={**shown, "done": event.done, "total": event.total})

        try:
            do: Callable[[Mapping[str, Any], Progress], Any] = getattr(worker, told["do"])
            found = do(told, progress)
        except Exception as error:  # noqa: BLE001  # whatever happens, the server is told, and the next line is read
            if not isinstance(error, WirelessAgentError):
                _log(error)
            answer(identity, failed=_told(error))
        else:
            answer(identity, done=as_json(found) if isinstance(found, Record) else found)


def _log(error: BaseException) -> None:
    import traceback

    traceback.print_exception(error, file=sys.stderr)


def _limit_memory() -> None:
    try:
        import resource
    except ImportError:  # Windows
        return
    most = int(os.environ.get("WIRELESSAGENT_WORKER_MEMORY_BYTES", _DEFAULT_MEMORY_BYTES))
    resource.setrlimit(resource.RLIMIT_DATA, (most, most))


def main() -> None:
    """Run as ``python -m wirelessagent.service.worker``."""
    _limit_memory()
    answers = os.fdopen(os.dup(1), "w", encoding="ascii")
    os.dup2(2, 1)  # what libraries print goes to the log, and never between the answers
    serve(sys.stdin, answers)


if __name__ == "__main__":
    main()
