"""What a file of talks makes of the request: lines that change it wrongly, and lines that are missed or asked back.

Run with ``python benchmarks/bars_talks.py FILE.jsonl [--quiet]``. A talk is a line of JSON: ``{"lines": [{"text": …,
"request": {"objective": …, "constraints": {…}}}]}``, where ``request`` is what holds behind the line, null where
nothing was asked for yet, and ``"asks": true`` says that asking back is right. A figure may be "radiated*0.5": that
share of the power of the last decision. A talk is judged up to its first failure. With ``--quiet`` no sentence is
printed, so that a set can be used again.
"""

from __future__ import annotations

import argparse
import collections
import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from wirelessagent.agent.session import Session
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS
from wirelessagent.operations.chat import ChatRequest

_SAME = 1e-3
_USERS = 8


def plain(value: Any, radiated_w: float) -> Any:
    """A constraint in one form: figures by user, a figure, or a set of users."""
    if isinstance(value, str):
        return radiated_w * float(value.partition("*")[2])
    if isinstance(value, Mapping):
        by_user = {str(user).removeprefix("user "): float(figure) for user, figure in value.items()}
        return by_user[EVERYBODY] if list(by_user) == [EVERYBODY] else by_user
    if isinstance(value, list | tuple):
        return {str(user).removeprefix("user ") for user in value}
    return float(value)


def is_same(one: Any, other: Any) -> bool:
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(is_same(one[user], other[user]) for user in one)
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=_SAME)
    return one == other


def by_user(constraints: Mapping[str, Any], radiated_w: float) -> dict[str, Any]:
    """Constraints with a figure for each user who is served: however they are written, they are the same request."""
    found = {name: plain(value, radiated_w) for name, value in constraints.items()}
    everybody = {str(number) for number in range(1, _USERS + 1)}
    served = found.pop("users", everybody) - found.pop("leave_out", set())
    for name in FIGURES_OF_USERS:
        figures = found.pop(name, {})
        own = figures if isinstance(figures, dict) else {EVERYBODY: figures}
        none = 1.0 if name == "weights" else 0.0
        each = {user: own.get(user, own.get(EVERYBODY, none)) for user in served}
        found[name] = {user: figure for user, figure in each.items() if figure != none}
    return {**found, "served": served}


def holds(session: Session, expected: Mapping[str, Any] | None, radiated_w: float) -> bool:
    request = session.request
    if expected is None or request is None:
        return expected is None and request is None
    wanted, found = (by_user(each, radiated_w) for each in (expected["constraints"], request.constraints))
    same = wanted.keys() == found.keys() and all(is_same(wanted[name], found[name]) for name in wanted)
    return same and expected["objective"] in (None, request.objective)


def judged(talk: Mapping[str, Any], tell: Any) -> list[str]:
    """``right``, ``wrong`` or ``missed`` for each line up to the first failure."""
    session = ChatRequest(no_store=True).session(lambda event: None)
    found: list[str] = []
    kept_w: dict[str, float] = {}  # what was radiated where a share was asked for, which later lines only keep
    for line in talk["lines"]:
        decided = session.state.run
        radiated_w = 0.0 if decided is None else decided.decision.total_power_w
        before = session.request
        turn = session.say(line["text"])
        shares = {
            figure for figure in (line["request"] or {}).get("constraints", {}).values() if isinstance(figure, str)
        }
        kept_w = {figure: watts for figure, watts in kept_w.items() if figure in shares}
        if any(holds(session, line["request"], watts) for watts in (radiated_w, *kept_w.values())):
            kept_w |= dict.fromkeys(shares - kept_w.keys(), radiated_w)
            found.append("right")
            continue
        found.append("missed" if session.request == before else "wrong")
        now = session.request
        tell(f"\n{found[-1].upper()} " + " / ".join(each["text"] for each in talk["lines"][: len(found)]))
        tell(f"   wanted {line['request']}")
        tell(f"   got    {None if now is None else (now.objective, dict(now.constraints))} [{turn.stage}]")
        tell(f"   said   {turn.reply[:300]!r}")
        break
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--quiet", action="store_true", help="print counts only")
    asked = parser.parse_args()
    tell = (lambda _: None) if asked.quiet else print
    talks = [json.loads(line) for line in asked.file.read_text(encoding="utf-8").splitlines() if line.strip()]
    found = collections.Counter(one for talk in talks for one in judged(talk, tell))
    lines = found.total()
    shares = ", ".join(f"{name} {found[name]} ({found[name] / lines:.1%})" for name in ("right", "wrong", "missed"))
    print(f"{len(talks)} talks, {lines} lines judged: {shares}")


if __name__ == "__main__":
    main()
