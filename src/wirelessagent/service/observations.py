"""Observations: files with gains that callers sent or had made. They lie in the store, so that each server has them.

A worker reads a file by its path, so what it works on is copied into a folder of this machine first.
"""

from __future__ import annotations

import asyncio
import os
import secrets
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeAlias

from wirelessagent.model.atomic import write_atomically
from wirelessagent.service.jobs import Tell
from wirelessagent.service.kept import item_of, kept, shown
from wirelessagent.service.limits import Limits
from wirelessagent.service.problems import ConflictError, NotFoundError, TooMuchError, UnusableError
from wirelessagent.service.workers import Workers
from wirelessagent.store.ledger import Ledger

Json: TypeAlias = dict[str, Any]

SUFFIXES = frozenset({".csv", ".txt", ".json", ".npz", ".npy", ".mat", ".h5", ".hdf5", ".nc"})
"""How the names of files with gains end."""

_UNUSED_S = 86_400.0
"""After this time without use a copy goes; it is made again when it is needed."""


class Observations:
    """The observations in a ledger.

    Args:
        folder: where workers find copies of them.
        understood_only: keep what was understood of a file, and not the file, which has names that nobody is to keep.
    """

    def __init__(
        self, ledger: Ledger, folder: Path, workers: Workers, limits: Limits, *, understood_only: bool = False
    ) -> None:
        self._understood_only = understood_only
        self._ledger, self._folder, self._workers, self._limits = ledger, folder, workers, limits

    async def add(self, name: str, content: bytes, options: Mapping[str, str], tell: Tell) -> Json:
        """Keep a file with gains, and what was understood of it."""
        suffix = Path(name).suffix.lower()
        if suffix not in SUFFIXES:
            raise UnusableError(f"{name!r}: a file with gains ends in one of {', '.join(sorted(SUFFIXES))}")
        if len(await kept(self._ledger.all, "observation")) >= self._limits.observations:
            raise TooMuchError(f"{self._limits.observations} observations are kept already: remove one first")
        id, read_as = secrets.token_hex(8), dict(options)
        path = sent = self._folder / f"{id}{suffix}"
        if self._understood_only:
            path = self._folder / f"{id}.npz"
            sent = path.with_name(f"{id}-sent{suffix}")
        await asyncio.to_thread(_write, sent, content)
        try:
            seen = await self._workers.do(
                "inspect", tell, options={"source_options": read_as}, channel=str(sent),
                out=None if path == sent else str(path),
            )  # fmt: skip
            self._check_size(seen)
            kept_as = read_as if path == sent else {}
            return await self._keep(path, {"name": Path(name).name[:200], "options": kept_as, **seen})
        except BaseException:
            path.unlink(missing_ok=True)
            raise
        finally:
            if path != sent:
                sent.unlink(missing_ok=True)

    async def derive(self, name: str, form: Mapping[str, Any], tell: Tell) -> Json:
        """Run an operation that writes gains (simulate, repair), and keep them as an observation.

        Nobody has to remove these: where there are too many, the oldest that no cell works on go.
        """
        given = dict(form)
        channel = await self.file(given.pop("observation", None))
        await self._make_room()
        path = self._folder / f"{secrets.token_hex(8)}.npz"
        await asyncio.to_thread(_make, self._folder)
        try:
            done = await self._workers.do("operation", tell, name=name, form=given, channel=channel, out=str(path))
            seen = await self._workers.do("inspect", tell, options={}, channel=str(path))
            made = await self._keep(path, {"name": f"{name}.npz", "options": {}, "derived": True, **seen})
        except BaseException:
            path.unlink(missing_ok=True)
            raise
        done["record"]["out"] = None  # where the server keeps what is nobody else's business
        done["blocks"] = [block for block in done["blocks"] if path.name not in str(block)]
        return {"observation": made, **done}

    async def one(self, id: str) -> Json:
        """What was understood of a file."""
        return {"id": id, **_told((await item_of(self._ledger, "observation", id)).data)}

    async def read_as(self, id: str) -> Json:
        """The options by which a file is read."""
        return (await item_of(self._ledger, "observation", id)).data["options"]

    async def drop(self, id: str) -> None:
        """Remove a file; turns keep what they saw of it."""
        item = await item_of(self._ledger, "observation", id)
        users = [cell.data["name"] for cell in await kept(self._ledger.all, "cell")
                 if cell.data.get("observation") == id]  # fmt: skip
        if users:
            raise ConflictError(f"the cell {users[0]!r} works on this observation: remove the cell first")
        await kept(self._ledger.drop, "observation", id)
        await kept(self._ledger.drop_blob, id)
        (self._folder / item.data["file"]).unlink(missing_ok=True)

    async def file(self, id: str | None) -> str | None:
        """Where a worker finds a file on this machine; None for none."""
        if id is None:
            return None
        path = self._folder / (await item_of(self._ledger, "observation", id)).data["file"]
        try:
            os.utime(path)
        except FileNotFoundError:
            content = await kept(self._ledger.blob, id)
            if content is None:
                raise NotFoundError(f"the file of the observation {id!r} is gone: send it again") from None
            await asyncio.to_thread(_write, path, content)
        return str(path)

    async def _keep(self, path: Path, data: Json) -> Json:
        """Have a file that lies here in the store."""
        id = path.stem
        await kept(self._ledger.put_blob, id, await asyncio.to_thread(path.read_bytes))
        await kept(self._ledger.put, "observation", id, {**data, "file": path.name}, seen=0)
        return {"id": id, **_told(data)}

    def _check_size(self, seen: Mapping[str, Any]) -> None:
        users, subcarriers = seen["num_users"], seen["num_subcarriers"]
        if users * subcarriers > self._limits.gains:
            most = self._limits.gains
            raise UnusableError(f"at most {most} gains are taken; got {users} users on {subcarriers} subcarriers")

    async def _make_room(self) -> None:
        there = await kept(self._ledger.all, "observation")
        used = {cell.data.get("observation") for cell in await kept(self._ledger.all, "cell")}
        old = sorted(
            (item for item in there if item.data.get("derived") and item.id not in used),
            key=lambda item: item.changed_utc,
        )
        for item in old[: max(len(there) - self._limits.observations + 1, 0)]:
            await self.drop(item.id)
        if len(there) - len(old) >= self._limits.observations:
            raise TooMuchError(f"{self._limits.observations} observations are kept already: remove one first")


def _told(data: Mapping[str, Any]) -> Json:
    return shown(data, "options", "file", "derived")


def _make(folder: Path) -> None:
    """The folder, without the copies that nobody used for long."""
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    for path in folder.iterdir():
        if path.stat().st_mtime < time.time() - _UNUSED_S:
            path.unlink(missing_ok=True)


def _write(path: Path, content: bytes) -> None:
    _make(path.parent)
    write_atomically(path, lambda stream: stream.write(content))
