"""How the service asks its ledger: without holding the server up."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from wirelessagent.service.problems import NotFoundError, UnusableError
from wirelessagent.store.ledger import Item, Ledger

Found = TypeVar("Found")


async def kept(do: Callable[..., Found], *args: Any, **kwargs: Any) -> Found:
    """What the ledger says."""
    return await asyncio.to_thread(do, *args, **kwargs)


async def item_of(ledger: Ledger, kind: str, id: Any) -> Item:
    """The item that a caller names.

    Raises:
        NotFoundError: there is none.
    """
    if not isinstance(id, str):
        raise UnusableError(f"the id of {kind} is a text; got {id!r}")
    item = await kept(ledger.find, kind, id)
    if item is None:
        raise NotFoundError(f"there is no {kind} {id!r}")
    return item


def shown(data: Mapping[str, Any], *without: str) -> dict[str, Any]:
    """An item's data as callers see it."""
    return {name: value for name, value in data.items() if name not in without}
