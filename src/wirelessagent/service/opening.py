"""Opening what a server owns, at the place of an audit store."""

from __future__ import annotations

from pathlib import Path

import platformdirs

from wirelessagent.service.access import Access
from wirelessagent.service.limits import Limits
from wirelessagent.service.names import PublicNames
from wirelessagent.service.service import Service
from wirelessagent.service.workers import Workers
from wirelessagent.settings import PseudonymSettings
from wirelessagent.store.ledger import Ledger
from wirelessagent.store.place import file_of, url_of


def open_service(store: str | None, limits: Limits, *, workers: int = 1, pseudonym_key: str = "") -> Service:
    """A service on the store at a place, as the settings say if not given.

    Raises:
        InputError: it is no such place.
        StoreError: it cannot be opened or made, or is something else.
    """
    place = url_of(store)
    file = file_of(place)
    cache = platformdirs.user_cache_path("wirelessagent")
    ledger = Ledger.open(store)
    environment = {
        "WIRELESSAGENT_STORE": "yes",
        "WIRELESSAGENT_STORE_URL": place.render_as_string(hide_password=False) if file is None else str(file),
    }
    if pseudonym_key:
        environment["WIRELESSAGENT_PSEUDONYM_KEY"] = pseudonym_key
    ours = [platformdirs.user_data_path("wirelessagent") if file is None else Path(file).parent, cache]
    names = PublicNames({ledger.place: "this server"}, ours)
    return Service(
        ledger,
        cache / "observations",
        Workers(workers, time_limit_s=limits.work_s, environment=environment, names=names),
        limits,
        pseudonyms=bool(pseudonym_key or PseudonymSettings.read().pseudonym_key),
    )


def open_access(store: str | None) -> Access:
    """The tokens at that place."""
    return Access(Ledger.open(store))
