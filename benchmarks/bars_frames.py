"""The bars of the guard: how often is acted upon what must not be, and how often is a plain wish asked back about.

Run with ``python benchmarks/bars_frames.py FILE.jsonl [--quiet] [--later]``. Each line is ``{"text", "language",
"frame", "act", "objective", "constraints"}``; each sentence is said first, in a fresh conversation with users 1 to 8,
or, with ``--later``, where a request holds (figures are then those of the sentence alone). A file of ``wirelessagent
evaluate intents`` is read as well: its kind says what may act. ``--quiet`` prints no sentence, for sets that nobody is
to read.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any, cast

from bars_talks import by_user, is_same

from wirelessagent.language.conversation import understood
from wirelessagent.language.guard import CHANGING
from wirelessagent.language.intent import Intent
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context
from wirelessagent.language.request import numbered, users_in

USERS = tuple(f"user {number}" for number in range(1, 9))
FIRST = Context(user_names=USERS)
LATER = Context(user_names=USERS, objective="proportional_fairness", constraints={"max_power_w": 16.0}, language="en")
RECOGNISER = OfflineRecogniser()


def read(path: Path) -> list[dict[str, Any]]:
    """The sentences of a file, each with its frame and whether it acts."""
    rows = [cast("dict[str, Any]", json.loads(line)) for line in path.read_text(encoding="utf-8").splitlines() if line]
    for row in rows:
        row.setdefault("act", row.get("kind") in ("allocate", "command"))
        row.setdefault("frame", "plain" if row.get("kind") == "allocate" else str(row.get("kind")))
    return rows


def acts(intent: Intent) -> bool:
    """Whether something would change; a session asks who is meant where a user is named whom the cell does not have."""
    known = all(f"user {numbered(user)}" in USERS for user in users_in(intent.constraints))
    return (intent.kind == "allocate" and known) or (intent.kind == "command" and intent.topic in CHANGING)


def verdict(row: dict[str, Any], intent: Intent) -> str:
    """ "right", "wrong act", "asked" or "wrong figures"."""
    if not row["act"]:
        return "wrong act" if acts(intent) else "right"
    if row["frame"] != "plain":
        return "right"
    if intent.kind != "allocate":
        return "asked"
    meant, found = (by_user(given, 0.0) for given in (row.get("constraints", {}), intent.constraints))
    aim = row.get("objective") in (None, intent.objective)
    same = meant.keys() == found.keys() and all(is_same(value, found[name]) for name, value in meant.items())
    return "right" if aim and same else "wrong figures"


def score(rows: list[dict[str, Any]], context: Context = FIRST) -> list[tuple[dict[str, Any], str]]:
    """What comes of each sentence."""
    return [(row, verdict(row, understood(row["text"], context, RECOGNISER))) for row in rows]


def counted(scored: Iterable[tuple[str, Iterable[str]]]) -> Counter[tuple[str, str]]:
    """How often something came of the sentences of each of their groups."""
    return Counter((group, what) for said, groups in scored for group in groups for what in ("sentences", said))


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("file", type=Path)
    parser.add_argument("--quiet", action="store_true")
    parser.add_argument("--later", action="store_true", help="say each sentence where a request holds already")
    given = parser.parse_args()
    scored = score(read(given.file), LATER if given.later else FIRST)
    total = counted((said, (row["frame"], row["language"], "all")) for row, said in scored)
    columns = ("sentences", "wrong act", "asked", "wrong figures")
    print(f"{'':16}" + "".join(f"{column:>15}" for column in columns))
    for group in dict.fromkeys(group for group, _ in total):
        print(f"{group:16}" + "".join(f"{total[group, column]:15}" for column in columns))
    share = 100 * total["all", "wrong act"] / max(len(scored), 1)
    print(f"acted upon wrongly: {share:.1f} % of all sentences (bar: at most 3 %)")
    for row, said in () if given.quiet else scored:
        if said != "right":
            print(f"{said:14}{row['frame']:14}{row['text']}")


if __name__ == "__main__":
    main()
