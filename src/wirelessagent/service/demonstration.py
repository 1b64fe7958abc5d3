"""The conversation that a server begins with: recorded, so that nothing has to be computed before it is shown.

``python -m wirelessagent.service.demonstration`` records it anew.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

_FILE = Path(__file__).with_name("demonstration.json")

_OPTIONS = {"seed": 2}
_LINES = (("Save power, at least 1 Mbit/s each", True), ("and user 3 at least 2 Mbit/s", False))
"""What is said, and whether the plan that it leads to is applied."""


def recorded_demonstration() -> dict[str, Any]:
    """The cell, its conversation, its turns and what is known of its channel, as a ledger keeps them."""
    return json.loads(_FILE.read_text(encoding="utf-8"))


def _record() -> dict[str, Any]:
    from wirelessagent.operations.chat import ChatRequest
    from wirelessagent.operations.hosted import Hosted, facts_of
    from wirelessagent.operations.operation import silent
    from wirelessagent.operations.record import as_json

    request = ChatRequest(**_OPTIONS, no_store=True)  # pyright: ignore[reportArgumentType]
    hosted, recalled = Hosted(request, "demonstration", silent), list[tuple[str, bool]]()
    for line, applied in _LINES:
        hosted.say(line, silent)
        recalled.append((line, False))
        if applied:
            hosted.press("yes", silent)
            recalled.append((hosted.turns[-1].record.text, True))
    turns = [as_json(turn) for turn in hosted.turns]
    last, channel = turns[-1], hosted.channel()
    assert channel is not None
    return {
        "cell": {"name": "Demonstration", "options": _OPTIONS, "observation": None,
                 **as_json(facts_of(request, silent))},
        "session": {"turns": len(turns), "recalled": recalled, "in_effect": last["in_effect"],
                    "language": last["language"], "awaits": "nothing"},
        "turns": [{**turn["record"], "by": "", "language": turn["language"]} for turn in turns],
        "channel": as_json(channel),
        "last": {**last, "record": {"stage": last["record"]["stage"], "number": last["record"]["number"]}},
    }  # fmt: skip


if __name__ == "__main__":
    _FILE.write_text(json.dumps(_record(), ensure_ascii=False, separators=(",", ":")) + "\n", encoding="utf-8")
