"""An intent of TMF921 as the sentence that asks for the same, so that it becomes the same turn."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from wirelessagent import plugins
from wirelessagent.agent.turn import restated
from wirelessagent.language.intent import Constraint
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.request import Request
from wirelessagent.model.errors import InputError
from wirelessagent.standards.tmf921_request import request_of

_ORDERED = "Please set this now: "
"""What makes a restatement an order beyond doubt."""


def sentence_of(intent: Mapping[str, Any], user_names: Sequence[str]) -> str:
    """The sentence for a cell with these users; what it is understood to mean is what the intent says.

    Raises:
        InputError: something in the intent cannot be asked for, which the message names.
    """
    objective, constraints = request_of(intent, user_names)
    plugins.plugin("objective", objective)
    text = _ORDERED + restated(Request(objective=objective, constraints=constraints))
    wanted = Request(objective=objective, constraints=constraints)
    read = OfflineRecogniser().recognise(text)
    if read.objective != objective:
        raise InputError(f"this cannot be asked for exactly by an intent: {text} Give figures of at most four digits")
    for name in {**wanted.constraints, **read.constraints}:
        if not _same(wanted.constraints.get(name), read.constraints.get(name)):
            raise InputError(
                f"{name}: this cannot be asked for exactly by an intent, with {wanted.constraints.get(name)!r}: give "
                "figures of at most four digits, and users by their names"
            )
    return text


def _same(one: Constraint | None, other: Constraint | None) -> bool:
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(_same(one[user], other[user]) for user in one)
    if isinstance(one, int | float) and isinstance(other, int | float):
        return math.isclose(one, other, rel_tol=1e-9)
    return one == other
