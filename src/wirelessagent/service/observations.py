"""Observations: files with gains that callers sent or had made. They lie in the store, so that each server has them.

A worker reads a file by its path, so what it works on is copied into a folder of this machine first.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import secrets
import time
from collections.abc import Awaitable, Callable, Mapping
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from wirelessagent.model.atomic import write_atomically
from wirelessagent.service.jobs import Tell
from wirelessagent.service.kept import item_of, kept, shown
from wirelessagent.service.limits import Limits
from wirelessagent.service.problems import ConflictError, NotFoundError, TooMuchError, UnusableError
from wirelessagent.service.workers import Workers
from wirelessagent.store.ledger import Ledger

Json: TypeAlias = dict[str, Any]
Made = TypeVar("Made")

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

        async def write(path: Path) -> None:
            await asyncio.to_thread(_write, path, content)

        made, _ = await self._made(Path(name).name[:200], suffix, options, write, tell)
        return made

    async def derive(self, name: str, form: Mapping[str, Any], tell: Tell) -> Json:
        """Run an operation that writes gains (simulate, repair), and keep them; nobody has to remove these."""
        given, shown = dict(form), f"{name}.npz"
        channel = await self.channel(given.pop("observation", None))

        async def run(path: Path) -> Json:
            called = {**channel["called"], str(path): shown}
            return await self._workers.do(
                "operation", tell, name=name, form=given, out=str(path), channel=channel["channel"], called=called
            )

        made, done = await self._made(shown, ".npz", {}, run, tell, derived=True)
        return {"observation": made, **done}

    async def _made(
        self, name: str, suffix: str, options: Mapping[str, str], make: Callable[[Path], Awaitable[Made]], tell: Tell,
        **more: Any,
    ) -> tuple[Json, Made]:  # fmt: skip
        """Keep the file that something makes, if it can be used, and what was understood of it.

        Where there are too many, the oldest go that were derived and that no cell works on.
        """
        await self._make_room()
        read_as, id = dict(options), secrets.token_hex(8)
        sent = self._folder / f"{id}-sent{suffix}"
        path = self._folder / (f"{id}.npz" if self._understood_only else f"{id}{suffix}")
        await asyncio.to_thread(_make, self._folder)
        try:
            done = await make(sent)
            seen = await self._workers.do(
                "inspect", tell, options={"source_options": read_as}, channel=str(sent), called={str(sent): name},
                out=str(path) if self._understood_only else None,
            )  # fmt: skip
            self._check_size(seen)
            if self._understood_only:
                read_as = {}
            else:
                sent.replace(path)
            return await self._keep(path, {"name": name, "options": read_as, **more, **seen}), done
        except BaseException:
            path.unlink(missing_ok=True)
            raise
        finally:
            sent.unlink(missing_ok=True)

    async def one(self, id: str) -> Json:
        """What was understood of a file."""
        return {"id": id, **_told((await item_of(self._ledger, "observation", id)).data)}

    async def read_as(self, id: str) -> Json:
        """The options by which a file is read."""
        return (await item_of(self._ledger, "observation", id)).data["options"]

    async def drop(self, id: str) -> None:
        """Remove a file; turns keep what they saw of it.

        Raises:
            ConflictError: a cell works on it, also one that was made meanwhile.
        """
        item = await item_of(self._ledger, "observation", id)
        await self._check_unused(id)
        await kept(self._ledger.drop, "observation", id)
        try:
            await self._check_unused(id)
        except ConflictError:
            await kept(self._ledger.put, "observation", id, item.data)
            raise
        await kept(self._ledger.drop_blob, id)
        (self._folder / item.data["file"]).unlink(missing_ok=True)

    async def _check_unused(self, id: str) -> None:
        for cell in await kept(self._ledger.all, "cell"):
            if cell.data.get("observation") == id:
                raise ConflictError(
                    f"the cell {cell.data['name']!r} works on this observation: remove the cell first, or have it work "
                    "on another"
                )

    async def channel(self, id: str | None) -> Json:
        """What a worker is told of a file: where it lies on this machine, and what people call it; None for none."""
        if id is None:
            return {"channel": None, "called": {}}
        data = (await item_of(self._ledger, "observation", id)).data
        path = self._folder / data["file"]
        try:
            os.utime(path)
        except FileNotFoundError:
            content = await kept(self._ledger.blob, id)
            if content is None:
                raise NotFoundError(f"the file of the observation {id!r} is gone: send it again") from None
            await asyncio.to_thread(_write, path, content)
        return {"channel": str(path), "called": {str(path): data["name"]}}

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
        with contextlib.suppress(FileNotFoundError):  # another request was done with it meanwhile
            if path.stat().st_mtime < time.time() - _UNUSED_S:
                path.unlink()


def _write(path: Path, content: bytes) -> None:
    _make(path.parent)
    write_atomically(path, lambda stream: stream.write(content))
