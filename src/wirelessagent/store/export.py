"""The store as JSON lines, for other tools and for keeping elsewhere.

A line is a turn with all its columns, or a content with its arrays, which comes before the first turn that speaks of
it. Both carry their hash and all that it is made of. Of a content that was sealed, its seal stands there.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from wirelessagent.model.errors import SealedError

if TYPE_CHECKING:
    from wirelessagent.store.store import Store


def exported(store: Store, session: str | None = None, told: set[str] | None = None) -> Iterator[dict[str, Any]]:
    """Every line, of all sessions or of one, as plain data; contents are left out that were ``told`` before."""
    told = set[str]() if told is None else told
    for turn in store.turns(session):
        for content in (turn.observation, turn.estimate):
            if content is not None and content not in told:
                told.add(content)
                try:
                    yield {"kind": "content", "hash": content, "arrays": store.content(content).exported()}
                except SealedError:
                    yield {"kind": "seal", **(store.seal(content) or {})}
        yield {"kind": "turn", **turn.held()}
