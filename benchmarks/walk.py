"""The walk of a line from ``Session.say`` to its reply: the modules of the talking half that it enters.

Run with ``python benchmarks/walk.py ["a line" …] [--list]``. The talking half is ``language``, ``telling``, ``agent``;
what senses, repairs and decides is not counted. The first line of each talk is said before, so that what is loaded once
is loaded; the last line is walked.
"""

from __future__ import annotations

import argparse
import collections
import sys
from collections.abc import Sequence
from types import FrameType
from typing import Any

import wirelessagent as wa

HALF = ("wirelessagent.language.", "wirelessagent.telling.", "wirelessagent.agent.")
TALKS = (
    ("Highest total rate", "now with 5 W"),
    ("Highest total rate, at most 10 W", "why does user 3 get so little?"),
    ("Highest total rate, at most 10 W", "what if we had 5 W?"),
    ("Highest total rate, at most 10 W", "undo"),
    ("Highest total rate, at most 10 W", "how sure is this?"),
    ("Highest total rate", "Save power, 200 kbit/s each"),
)


def walked(talk: Sequence[str]) -> tuple[list[str], str]:
    """The modules that the last line of a talk enters, in their order, and what it came to."""
    scene = wa.simulate("rayleigh", wa.Cell(max_power_w=20), num_users=4, num_subcarriers=12, seed=3)
    for _ in range(2):  # the second time nothing is loaded any more
        session = wa.Session(scene, wa.loss.random(0.2), seed=3)
        for line in talk[:-1]:
            session.say(line)
        entered: collections.Counter[str] = collections.Counter()

        def enter(frame: FrameType, event: str, _: Any, seen: collections.Counter[str] = entered) -> None:
            name = frame.f_globals.get("__name__", "")
            if event == "call" and str(name).startswith(HALF):
                seen[name] += 1

        sys.setprofile(enter)
        try:
            turn = session.say(talk[-1])
        finally:
            sys.setprofile(None)
    return list(entered), turn.stage


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("lines", nargs="*", help="a talk, its last line is walked")
    parser.add_argument("--list", action="store_true", help="list the modules")
    arguments = parser.parse_args()
    for talk in [arguments.lines] if arguments.lines else TALKS:
        modules, stage = walked(talk)
        folders = collections.Counter(name.removeprefix("wirelessagent.").rsplit(".", 1)[0] for name in modules)
        told = ", ".join(f"{folder} {count}" for folder, count in sorted(folders.items()))
        print(f"{len(modules):3} modules ({told}): {talk[-1]} [{stage}]")
        if arguments.list:
            print("\n".join(f"      {name.removeprefix('wirelessagent.')}" for name in modules))


if __name__ == "__main__":
    main()
