"""What a running server owns: cells, their conversations, the plans that wait, observations, jobs and workers.

A cell has one conversation at a time and at most one plan that waits. A plan is taken by compare-and-set in the store,
so that it is applied once, whoever presses and whatever server they reach; it goes stale when anything was applied at
its cell meanwhile, and with time.
"""

from __future__ import annotations

import asyncio
import secrets
import weakref
from collections.abc import Callable, Coroutine, Mapping
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, Literal, TypeAlias, TypeVar

from wirelessagent.operations.catalogue import OPERATIONS
from wirelessagent.service.access import Access, Caller
from wirelessagent.service.demonstration import recorded_demonstration
from wirelessagent.service.jobs import Job, Jobs, Tell
from wirelessagent.service.limits import Limits
from wirelessagent.service.metrics import Metrics
from wirelessagent.service.problems import ConflictError, NotFoundError, ProblemError, TooMuchError, UnusableError
from wirelessagent.service.workers import Workers
from wirelessagent.store.ledger import ChangedError, Item, Ledger

Json: TypeAlias = dict[str, Any]
Press: TypeAlias = Literal["yes", "no", "undo"]
Found = TypeVar("Found")

SUFFIXES = frozenset({".csv", ".txt", ".json", ".npz", ".npy", ".mat", ".h5", ".hdf5", ".nc"})
"""How the names of files with gains end."""

_LONGEST_TEXT = 4000
_TAKE_UP_S = 3.0
"""Time for each turn of a conversation that has to be taken up."""


class Service:
    """A server's possessions.

    Args:
        ledger: what is kept.
        folder: where observations are kept.
        workers: what works.
        limits: what is allowed.
    """

    def __init__(self, ledger: Ledger, folder: Path, workers: Workers, limits: Limits) -> None:
        self.ledger, self.limits, self.workers, self._folder = ledger, limits, workers, folder
        self.access, self.jobs, self.metrics = Access(ledger), Jobs(), Metrics()
        self._going = set[asyncio.Task[Any]]()
        self._locks: weakref.WeakValueDictionary[str, asyncio.Lock] = weakref.WeakValueDictionary()

    async def close(self) -> None:
        """End the workers and let go of the store."""
        await self.workers.close()
        self.ledger.close()

    def job(self, caller: Caller, work: Callable[[Tell], Any]) -> Job:
        """Work that begins now.

        Raises:
            TooMuchError: too much goes on already.
        """
        if self.jobs.running >= self.limits.running_jobs:
            raise TooMuchError(f"{self.limits.running_jobs} jobs go on already; try again in a while", Retry_After="5")
        return self.jobs.start(caller.name, work)

    # Cells.

    async def cells(self) -> list[Json]:
        """All cells, for people to choose among."""
        return [_cell(item) for item in await self._kept(self.ledger.all, "cell")]

    async def cell(self, id: str) -> Json:
        """One cell."""
        return _cell(await self._item("cell", id))

    async def make_cell(self, name: str, options: Mapping[str, Any], tell: Tell) -> Json:
        """A new cell, with a conversation that was not begun; ``csi`` among its options is an observation's id."""
        if len(await self._kept(self.ledger.all, "cell")) >= self.limits.cells:
            raise TooMuchError(f"there are {self.limits.cells} cells already: remove one first")
        given = dict(options)
        observation = given.pop("csi", None)
        if observation is not None:
            read_as = (await self._item("observation", observation)).data["options"]
            if not isinstance(given.get("source_options", {}), dict):
                raise UnusableError(f"source_options: an object with options; got {given['source_options']!r}")
            given["source_options"] = {**read_as, **given.get("source_options", {})}
        kept: Json = {"name": name, "options": given, "observation": observation, "effect": 0, "demonstration": False}
        facts = await self.workers.do("facts", tell, options=given, channel=await self._channel_file(observation))
        kept |= facts
        id = secrets.token_hex(6)
        kept["session"] = await self._new_session(id)
        await self._kept(self.ledger.put, "cell", id, kept, seen=0)
        return await self.cell(id)

    async def drop_cell(self, id: str) -> None:
        """Remove a cell; its turns stay in the history."""
        await self._item("cell", id)
        await self._kept(self.ledger.drop, "plan", id)
        await self._kept(self.ledger.drop, "cell", id)

    async def demonstrate(self) -> None:
        """Have a demonstration cell with a conversation as it was recorded, where there is no cell yet."""
        if await self._kept(self.ledger.all, "cell"):
            return
        recorded = recorded_demonstration()
        session = secrets.token_hex(6)
        now = _now()
        await self._kept(self.ledger.put, "channel", session, {"channel": recorded["channel"]})
        for turn in recorded["turns"]:
            kept = {**turn, "session": session, "stored": None}
            await self._kept(self.ledger.put, "turn", _turn_id(session, turn["number"]), kept)
        held = {**recorded["session"], "cell": "demonstration", "created_utc": now}
        await self._kept(self.ledger.put, "session", session, held)
        cell = {**recorded["cell"], "session": session, "effect": 0, "demonstration": True}
        await self._kept(self.ledger.put, "cell", "demonstration", cell)
        await self._keep_plan(await self._item("cell", "demonstration"), session, recorded["last"])

    # Observations.

    async def observe(self, name: str, content: bytes, options: Mapping[str, str], tell: Tell) -> Json:
        """Keep a file with gains, and what was understood of it."""
        suffix = Path(name).suffix.lower()
        if suffix not in SUFFIXES:
            raise UnusableError(f"{name!r}: a file with gains ends in one of {', '.join(sorted(SUFFIXES))}")
        if len(await self._kept(self.ledger.all, "observation")) >= self.limits.observations:
            raise TooMuchError(f"{self.limits.observations} observations are kept already: remove one first")
        id = secrets.token_hex(8)
        path = self._folder / f"{id}{suffix}"
        await asyncio.to_thread(_write, path, content)
        try:
            seen = await self.workers.do("inspect", tell, options={"source_options": dict(options)}, channel=str(path))
            self._check_size(seen)
        except BaseException as error:
            path.unlink(missing_ok=True)
            if isinstance(error, ProblemError):  # speaks of the file by the name that its sender knows
                error.detail = error.detail.replace(str(path), Path(name).name)
            raise
        kept = {"name": Path(name).name[:200], "options": dict(options), "file": path.name, **seen}
        await self._kept(self.ledger.put, "observation", id, kept, seen=0)
        return {"id": id, **_shown(kept, "options", "file")}

    async def derive(self, name: str, form: Mapping[str, Any], tell: Tell) -> Json:
        """Run an operation that writes gains (simulate, repair), and keep them as an observation.

        Nobody has to remove these: where there are too many, the oldest that no cell works on go.
        """
        given = dict(form)
        channel = await self._channel_file(given.pop("observation", None))
        await self._make_room()
        id = secrets.token_hex(8)
        path = self._folder / f"{id}.npz"
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        try:
            done = await self.workers.do("operation", tell, name=name, form=given, channel=channel, out=str(path))
            seen = await self.workers.do("inspect", tell, options={}, channel=str(path))
        except BaseException:
            path.unlink(missing_ok=True)
            raise
        kept: Json = {"name": f"{name}.npz", "options": {}, "file": path.name, "derived": True, **seen}
        await self._kept(self.ledger.put, "observation", id, kept, seen=0)
        return {"observation": {"id": id, **_shown(kept, "options", "file", "derived")}, **done}

    def _check_size(self, seen: Mapping[str, Any]) -> None:
        users, subcarriers = seen["num_users"], seen["num_subcarriers"]
        if users * subcarriers > self.limits.gains:
            most = self.limits.gains
            raise UnusableError(f"at most {most} gains are taken; got {users} users on {subcarriers} subcarriers")

    async def _make_room(self) -> None:
        kept = await self._kept(self.ledger.all, "observation")
        used = {cell.data.get("observation") for cell in await self._kept(self.ledger.all, "cell")}
        old = sorted(
            (item for item in kept if item.data.get("derived") and item.id not in used),
            key=lambda item: item.changed_utc,
        )
        for item in old[: max(len(kept) - self.limits.observations + 1, 0)]:
            await self.drop_observation(item.id)
        if len(kept) - len(old) >= self.limits.observations:
            raise TooMuchError(f"{self.limits.observations} observations are kept already: remove one first")

    async def observation(self, id: str) -> Json:
        """What was understood of a file."""
        item = await self._item("observation", id)
        return {"id": id, **_shown(item.data, "options", "file", "derived")}

    async def drop_observation(self, id: str) -> None:
        """Remove a file; turns keep what they saw of it."""
        item = await self._item("observation", id)
        users = [cell.data["name"] for cell in await self._kept(self.ledger.all, "cell")
                 if cell.data.get("observation") == id]  # fmt: skip
        if users:
            raise ConflictError(f"the cell {users[0]!r} works on this observation: remove the cell first")
        await self._kept(self.ledger.drop, "observation", id)
        (self._folder / item.data["file"]).unlink(missing_ok=True)

    # Conversations.

    async def open_session(self, cell: str) -> Json:
        """A new conversation for a cell, in the place of the one that it has; a plan that waited is dropped."""
        async with self._lock(cell):
            item = await self._item("cell", cell)
            id = await self._new_session(cell)
            await self._kept(self.ledger.drop, "plan", cell)
            await self._changed("cell", item, session=id)
        return await self.session(id)

    async def session(self, id: str) -> Json:
        """A conversation with its turns and the plan that waits."""
        held = (await self._item("session", id)).data
        turns = [dict(item.data) for item in await self._kept(self.ledger.all, "turn", start=f"{id}/")]
        plan = await self._kept(self.ledger.find, "plan", held["cell"])
        waits = plan is not None and plan.data["session"] == id
        names = ("cell", "created_utc", "language", "in_effect")
        return {
            "id": id,
            **{name: held[name] for name in names},
            "awaits": "confirmation" if waits else held["awaits"],
            "turns": turns,
            "plan": _shown(plan.data, "session", "effect") if waits and plan is not None else None,
        }

    async def channel(self, id: str) -> Json | None:
        """What is known of the channel that a conversation is about."""
        await self._item("session", id)
        item = await self._kept(self.ledger.find, "channel", id)
        return None if item is None else item.data["channel"]

    async def trade_off(self, session: str, number: int, tell: Tell) -> Json:
        """The curve that the decision of a turn lies on."""
        async with await self._lock_of(session):
            item = await self._item("session", session)
            cell = await self._item("cell", item.data["cell"])
            return await self._hosted(item, cell, tell, "trade_off", number=number)

    async def say(self, session: str, text: str, caller: Caller, tell: Tell) -> Json:
        """The turn of a line."""
        if not text.strip():
            raise UnusableError("nothing was said: give what the cell should do in 'text'")
        if len(text) > _LONGEST_TEXT:
            raise UnusableError(f"a line has at most {_LONGEST_TEXT} characters; got {len(text)}")
        async with await self._lock_of(session):
            return await self._turn(session, caller, tell, "say", text=text)

    async def press(self, session: str, what: Press, caller: Caller, tell: Tell, *, plan: str | None = None) -> Json:
        """The turn of a button; applying and dropping are for the plan that the caller has seen.

        What is pressed is carried through, also where its caller goes away: nothing is applied by halves.
        """

        async def through() -> Json:
            async with await self._lock_of(session):
                if what != "undo":
                    await self._take(session, what, plan)
                return await self._turn(session, caller, tell, "press", button=what)

        return await self._through(through())

    async def _through(self, work: Coroutine[Any, Any, Found]) -> Found:
        """What comes of work that goes on where whoever waits for it is cancelled."""
        task = asyncio.create_task(work)
        self._going.add(task)
        task.add_done_callback(self._going.discard)
        return await asyncio.shield(task)

    async def plan(self, cell: str) -> Json | None:
        """The plan that waits for a cell."""
        item = await self._kept(self.ledger.find, "plan", cell)
        return None if item is None else _shown(item.data, "session", "effect")

    async def cell_of_plan(self, plan: str) -> str:
        """The cell that a plan waits for.

        Raises:
            ConflictError: it does not wait.
        """
        for item in await self._kept(self.ledger.all, "plan"):
            if item.data["id"] == plan:
                return item.id
        raise ConflictError("this plan does not wait any more: look at what holds now")

    async def _take(self, session: str, what: Press, plan: str | None) -> None:
        """Take the plan that waits, so that nobody else can.

        Raises:
            ConflictError: it is another one, was taken already, or is stale.
        """
        held = (await self._item("session", session)).data
        cell = await self._item("cell", held["cell"])
        self._check_current(cell, session)
        item = await self._kept(self.ledger.find, "plan", cell.id)
        if item is None or item.data["session"] != session or item.data["id"] != plan:
            raise ConflictError("this plan does not wait any more: look at what holds now")
        if what == "yes" and item.data["effect"] != cell.data["effect"]:
            raise ConflictError("something else was applied since this plan was made: ask for it again")
        if what == "yes" and datetime.fromisoformat(item.data["until_utc"]) < datetime.now(UTC):
            raise ConflictError("this plan has waited for too long, and the channel changes: ask for it again")
        if not await self._kept(self.ledger.drop, "plan", cell.id, seen=item.version):
            raise ConflictError("somebody else was faster: look at what holds now")
        if what == "yes":
            await self._changed("cell", cell, effect=cell.data["effect"] + 1)

    async def _turn(self, session: str, caller: Caller, tell: Tell, do: str, **told: Any) -> Json:
        item = await self._item("session", session)
        cell = await self._item("cell", item.data["cell"])
        self._check_current(cell, session)
        done = await self._hosted(item, cell, tell, do, by=caller.name, **told)
        await self._through(self._settle(item, cell, done))
        if done["stale"]:
            raise ConflictError("the conversation had gone on: look at what holds now")
        last = done["turns"][-1]
        self.metrics.turned(last["record"])
        return {**last["record"], "by": last["by"], "language": last["language"]}

    async def _hosted(self, item: Item, cell: Item, tell: Tell, do: str, **told: Any) -> Json:
        """What the worker of a conversation does in it, which it takes up first where it has to."""
        held = item.data
        return await self.workers.do(
            do, tell, of=item.id, session=item.id, turns=held["turns"], recalled=held["recalled"],
            options=cell.data["options"], channel=await self._channel_file(cell.data["observation"]),
            extra_s=_TAKE_UP_S * held["turns"], **told,
        )  # fmt: skip

    @staticmethod
    def _check_current(cell: Item, session: str) -> None:
        if cell.data["session"] != session:
            raise ConflictError(f"the cell {cell.data['name']!r} has a newer conversation: go on in that one")

    async def _settle(self, item: Item, cell: Item, done: Mapping[str, Any]) -> None:
        """Keep what became of a conversation."""
        session, held = item.id, {**item.data, "turns": done["number"]}
        for turn in done["turns"]:
            view = {**turn["record"], "by": turn["by"], "language": turn["language"]}
            await self._kept(self.ledger.put, "turn", _turn_id(session, view["number"]), view)
        await self._kept(self.ledger.put, "channel", session, {"channel": done["channel"]})
        if done["turns"]:
            last = done["turns"][-1]
            held |= {"in_effect": last["in_effect"], "language": last["language"]}
            held["awaits"] = "nothing" if last["waits"] else last["record"]["awaits"]
        await self._changed("session", item, **held)
        if done["turns"]:
            await self._keep_plan(cell, session, done["turns"][-1])

    async def _keep_plan(self, cell: Item, session: str, turn: Mapping[str, Any]) -> None:
        """Have the plan wait that a turn has made or left waiting; none where none waits."""
        if not turn["waits"]:
            await self._kept(self.ledger.drop, "plan", cell.id)
            return
        there = await self._kept(self.ledger.find, "plan", cell.id)
        if turn["record"]["stage"] != "planned" and there is not None and there.data["session"] == session:
            return
        effect = (await self._item("cell", cell.id)).data["effect"]
        until = datetime.now(UTC) + timedelta(seconds=self.limits.plan_s)
        plan = {
            "id": secrets.token_urlsafe(9), "session": session, "turn": turn["record"]["number"], "by": turn["by"],
            "made_utc": _now(), "until_utc": until.isoformat(timespec="seconds"), "effect": effect,
        }  # fmt: skip
        await self._kept(self.ledger.put, "plan", cell.id, plan)

    async def _new_session(self, cell: str) -> str:
        id = secrets.token_hex(6)
        kept: Json = {"cell": cell, "created_utc": _now(), "language": "en", "in_effect": None, "awaits": "nothing"}
        await self._kept(self.ledger.put, "session", id, {**kept, "turns": 0, "recalled": []}, seen=0)
        return id

    # Operations.

    async def operate(self, name: str, form: Mapping[str, Any], tell: Tell) -> Json:
        """Run an operation; ``observation`` in its form is the id of the channel to work on.

        Where ``picture`` in its form is true, the answer holds its picture as SVG, if it has one that can be drawn.
        """
        if name not in OPERATIONS:
            raise NotFoundError(f"there is no operation {name!r}: known are {', '.join(OPERATIONS)}")
        given = dict(form)
        channel = await self._channel_file(given.pop("observation", None))
        drawn = bool(given.pop("picture", False))
        return await self.workers.do("operation", tell, name=name, form=given, channel=channel, picture=drawn)

    async def forms(self) -> Json:
        """What each operation can be asked, as JSON Schema."""
        return await self.workers.do("forms", _silent)

    async def allocation(self, number: int, format: str) -> Json:
        """The allocation of a recorded turn as a file, in base 64 with its media type."""
        return await self.workers.do("allocation", _silent, number=number, format=format)

    # What is kept.

    async def _channel_file(self, observation: str | None) -> str | None:
        if observation is None:
            return None
        item = await self._item("observation", observation)
        return str(self._folder / item.data["file"])

    async def _item(self, kind: str, id: Any) -> Item:
        if not isinstance(id, str):
            raise UnusableError(f"the id of {kind} is a text; got {id!r}")
        item = await self._kept(self.ledger.find, kind, id)
        if item is None:
            raise NotFoundError(f"there is no {kind} {id!r}")
        return item

    async def _changed(self, kind: str, item: Item, **changes: Any) -> None:
        try:
            await self._kept(self.ledger.put, kind, item.id, {**item.data, **changes}, seen=item.version)
        except ChangedError as error:
            raise ConflictError(f"{error}: look at what holds now") from error

    @staticmethod
    async def _kept(do: Callable[..., Found], *args: Any, **kwargs: Any) -> Found:
        """What the ledger says, without holding the server up."""
        return await asyncio.to_thread(do, *args, **kwargs)

    async def _lock_of(self, session: str) -> asyncio.Lock:
        """The lock of the cell that a conversation is about."""
        return self._lock((await self._item("session", session)).data["cell"])

    def _lock(self, cell: str) -> asyncio.Lock:
        return self._locks.setdefault(cell, asyncio.Lock())


def _cell(item: Item) -> Json:
    understands = item.data["options"].get("recogniser", "offline")
    return {"id": item.id, "recogniser": understands, **_shown(item.data, "options", "effect")}


def _shown(data: Mapping[str, Any], *without: str) -> Json:
    return {name: value for name, value in data.items() if name not in without}


def _turn_id(session: str, number: int) -> str:
    return f"{session}/{number:08d}"


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def _silent(event: Json) -> None:
    del event


def _write(path: Path, content: bytes) -> None:
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    with path.open("xb") as stream:
        path.chmod(0o600)
        stream.write(content)
