"""The allocation of a recorded turn as a file that another program or a person can use."""

from __future__ import annotations

import tempfile
from pathlib import Path

from wirelessagent.acting.file import FileBaseStation
from wirelessagent.model.errors import InputError
from wirelessagent.operations.outputs import draw_run
from wirelessagent.operations.recording import StoreOptions, opened
from wirelessagent.store.content import estimate_of, observation_of
from wirelessagent.store.rebuilt import decision_of, outcome_of

MEDIA_TYPES = {
    "json": "application/json",
    "csv": "text/csv; charset=utf-8",
    "npz": "application/octet-stream",
    "png": "image/png",
    "svg": "image/svg+xml",
}
"""The formats, each with its media type."""


def allocation_file(number: int, format: str) -> tuple[str, bytes]:
    """The media type and the content.

    Raises:
        InputError: there is no such format, or the turn decided nothing.
        StoreError: the turn or its channel was changed since it was recorded.
    """
    if format not in MEDIA_TYPES:
        raise InputError(f"format: known are {', '.join(MEDIA_TYPES)}; got {format!r}")
    with opened(StoreOptions(store=None)) as store:
        turn = store.turn(number).whole()
        if turn.estimate is None or turn.observation is None:
            raise InputError(f"turn {number} decided nothing ({turn.stage}), so there is no allocation")
        estimate, seen = (estimate_of(store.content(turn.estimate)), observation_of(store.content(turn.observation)))
    decision, outcome = decision_of(turn, estimate.user_names), outcome_of(turn)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"allocation.{format}"
        if format in ("png", "svg"):
            draw_run(path, seen, estimate, decision, outcome)
        else:
            FileBaseStation(path=path).apply(decision)
        return MEDIA_TYPES[format], path.read_bytes()
