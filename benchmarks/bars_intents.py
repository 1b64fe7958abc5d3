"""The bars of understanding, offline: the development set, times, and ten thousand utterances that wish for nothing.

Run with ``python benchmarks/bars_intents.py [FILE.jsonl]`` from the repository; takes a minute or two.
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests" / "support"))

from hypothesis import HealthCheck, given, settings  # noqa: E402
from utterances import LONG, NOTHING_WISHED  # noqa: E402

from wirelessagent.interfaces.cli import run  # noqa: E402
from wirelessagent.language.offline import recognise  # noqa: E402

UTTERANCES = 10_000
acted: list[str] = []
tried = 0


@settings(deadline=None, max_examples=UTTERANCES, database=None, suppress_health_check=list(HealthCheck))
@given(NOTHING_WISHED)
def fuzz(text: str) -> None:
    global tried
    tried += 1
    intent = recognise(text)
    if intent.kind == "allocate" or (intent.kind == "command" and intent.topic in ("apply", "undo", "reset")):
        acted.append(text)


if __name__ == "__main__":
    run(["evaluate", "intents", sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "tests/intents/development.jsonl")])
    fuzz()
    for long in LONG:
        assert recognise(long).kind == "clarify"
    print(f"{tried} utterances that wish for nothing: no exception, {len(acted)} acted upon")
    for text in acted:
        print(repr(text))
