"""Turns go to the audit store, and where they cannot, that is told and costs nothing else."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from wirelessagent.model.errors import WirelessAgentError
from wirelessagent.operations.fields import Advanced, Local
from wirelessagent.operations.operation import Request
from wirelessagent.operations.pseudonyms import hidden_text

if TYPE_CHECKING:
    from wirelessagent.agent.session import Session
    from wirelessagent.agent.turn import Turn
    from wirelessagent.store.store import Store

_log = logging.getLogger("wirelessagent.store")


class StoreOptions(Request):
    """Which audit store."""

    store: Annotated[str | None, Advanced(), Local()] = Field(
        None,
        description="audit store, an SQLite file or a SQLAlchemy URL; that of WIRELESSAGENT_STORE_URL, or a file in "
        "the user's data folder, if not given",
    )


class RecordingOptions(StoreOptions):
    """Whether turns are recorded, and where."""

    no_store: Annotated[bool, Advanced(), Local()] = Field(
        False, description="record nothing; WIRELESSAGENT_STORE=no does so for good"
    )

    def said(self, session: Session, text: str, *, by: str = "") -> tuple[Turn, int | None]:
        """The turn of a line, recorded; so is one that was broken off after the base station was told."""
        turns = len(session.turns)
        try:
            turn = session.say(hidden_text(text, session.user_names), by=by)
        except BaseException:
            for broken_off in session.turns[turns:]:
                self.remember(broken_off)
            raise
        return turn, self.remember(turn)

    def remember(self, turn: Turn) -> int | None:
        """The turn's number in the store; None where it was not to be recorded, or could not be."""
        try:
            return self.recorded(turn)
        except WirelessAgentError as error:
            _log.warning("this turn is not recorded: %s", error)
            return None

    def recorded(self, turn: Turn) -> int | None:
        """The turn's number in the store; None where it was not to be recorded.

        Raises:
            WirelessAgentError: it could not be.
        """
        from wirelessagent.settings import Settings

        if self.no_store or not Settings.read().store:
            return None
        with opened(self, create=True) as store:
            return store.append(turn)


def opened(options: StoreOptions, *, create: bool = False, archive: Path | None = None) -> Store:
    """The store that the options name, with an export of what was sealed; SQLAlchemy is loaded only here."""
    from wirelessagent.store.store import Store

    return Store.open(options.store, create=create, archive=archive)


def place_of(options: StoreOptions) -> str:
    """Where that store is or would be, as people name it."""
    from wirelessagent.store.place import shown, url_of

    return shown(url_of(options.store))
