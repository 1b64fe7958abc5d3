"""Sentences of known meaning, composed: wishes x frames x limits x languages, and what comes of each.

Run with ``python benchmarks/bars_composed.py [--list]``. The parts stand in ``composed/<language>.toml``: a wish of
each aim, a limit with its meaning, and frames that leave an order an order ("acts") or make it none ("asks": forbidden,
reported, supposed, …). Every wording of a frame meets every aim, with and without a limit in turn, so that combinations
are covered and not listed. Each sentence is said first and where a request holds. A sentence is acted upon wrongly
where it orders nothing, or where another aim or other figures come of it; a needless question counts as mended where a
plain yes would do what was meant.
"""

from __future__ import annotations

import argparse
import dataclasses
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from bars_frames import FIRST, LATER, RECOGNISER, counted, verdict

from wirelessagent.language.conversation import understood
from wirelessagent.language.recogniser import Context

PARTS = Path(__file__).parent / "composed"
WRONG = ("wrong act", "wrong figures")


def composed() -> Iterator[dict[str, Any]]:
    """Every sentence, as ``bars_frames`` reads one; ``group`` is its frame, "plain" of whatever acts."""
    for path in sorted(PARTS.glob("*.toml")):
        parts = tomllib.loads(path.read_text(encoding="utf-8"))
        turn = 0
        for act, frames in ((True, parts["acts"]), (False, parts["asks"])):
            for group, wordings in frames.items():
                for wording in wordings:
                    for aim, wishes in parts["wishes"].items():
                        turn += 1
                        wish, limit = wishes[turn % len(wishes)], parts["limits"][turn // 2 % len(parts["limits"])]
                        said = parts["order"].format(wish=wish, limit=limit["text"]) if turn % 2 else wish
                        yield {
                            "text": _begun(wording.format(wish=said)), "language": path.stem, "group": group,
                            "frame": "plain" if act else group, "act": act, "objective": aim,
                            "constraints": limit["constraints"] if turn % 2 else {},
                        }  # fmt: skip


def _begun(text: str) -> str:
    return text[:1].upper() + text[1:]


def scored(context: Context) -> list[tuple[dict[str, Any], str]]:
    """What comes of each sentence: "right", "wrong act", "wrong figures", "asked", "asked, a yes will do"."""
    found: list[tuple[dict[str, Any], str]] = []
    for row in composed():
        intent = understood(row["text"], context, RECOGNISER)
        said = verdict(row, intent)
        if said == "asked" and intent.guess is not None:
            guess = verdict(row, dataclasses.replace(intent.guess, kind="allocate"))
            said = "asked, a yes will do" if guess == "right" else said
        found.append((row, said))
    return found


def groups_of(row: dict[str, Any]) -> tuple[str, ...]:
    """What a sentence is counted with."""
    return row["group"], row["language"], "all that acts" if row["act"] else "all that does not", "all"


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--list", action="store_true", help="each sentence that went wrong")
    given = parser.parse_args()
    for name, context in (("said first", FIRST), ("where a request holds", LATER)):
        rows = scored(context)
        total = counted((said, groups_of(row)) for row, said in rows)
        for row, said in rows if given.list else ():
            if said != "right":
                print(f"  {said}: {row['text']}")
        print(f"{name:24}{'sentences':>10}{'wrong %':>10}{'asked %':>10}{'yes does %':>12}")
        for group in sorted({group for group, _ in total}):
            count = total[group, "sentences"]
            asked = total[group, "asked"] + total[group, "asked, a yes will do"]
            wrong, mended = sum(total[group, word] for word in WRONG), total[group, "asked, a yes will do"]
            share = f"{100 * mended / asked:12.1f}" if asked else f"{'':12}"
            print(f"{group:24}{count:10}{100 * wrong / count:10.1f}{100 * asked / count:10.1f}{share}")


if __name__ == "__main__":
    main()
