"""What a running server owns: cells, their conversations, the plans that wait, observations, jobs and workers.

A cell has one conversation at a time, one turn of it at a time, and at most one plan that waits. A plan is taken by
compare-and-set in the store, so that it is applied once, whoever presses and whatever server they reach; it goes stale
when anything was applied at its cell meanwhile, and with time. Which turn goes on is in the store, too: where its
server or its worker ends while a plan is applied, whoever comes next tells that as what it is.
"""

from __future__ import annotations

import asyncio
import contextlib
import secrets
from collections.abc import AsyncGenerator, Callable, Coroutine, Mapping, Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from wirelessagent.operations.catalogue import OPERATIONS
from wirelessagent.operations.hosted_answers import Press
from wirelessagent.service.access import Access, Caller
from wirelessagent.service.demonstration import recorded_demonstration
from wirelessagent.service.jobs import Job, Jobs, Tell
from wirelessagent.service.kept import item_of, kept, shown
from wirelessagent.service.leases import Lease, Leases
from wirelessagent.service.limits import Limits
from wirelessagent.service.metrics import Metrics
from wirelessagent.service.observations import Observations
from wirelessagent.service.problems import (
    ConflictError,
    NotFoundError,
    ProblemError,
    TooMuchError,
    UnusableError,
)
from wirelessagent.service.workers import Workers
from wirelessagent.store.ledger import ChangedError, Item, Ledger

Json: TypeAlias = dict[str, Any]
Found = TypeVar("Found")

_LONGEST_TEXT = 4000
_CLOSING_S = 30.0
"""Time for presses to come to their end when the server does."""


class Service:
    """A server's possessions.

    Args:
        ledger: what is kept.
        folder: where workers find observations.
        workers: what works.
        limits: what is allowed.
        pseudonyms: whether users are known by pseudonyms alone.
    """

    def __init__(
        self, ledger: Ledger, folder: Path, workers: Workers, limits: Limits, *, pseudonyms: bool = False
    ) -> None:
        self.ledger, self.limits, self.workers = ledger, limits, workers
        self.observations = Observations(ledger, folder, workers, limits, understood_only=pseudonyms)
        self.access, self.jobs, self.metrics = Access(ledger), Jobs(ledger, limits.running_jobs), Metrics()
        self._going = set[asyncio.Task[Any]]()
        self._leases = Leases(ledger, limits.work_s)

    async def close(self) -> None:
        """Let presses come to their end, end the workers and let go of the store."""
        if self._going:
            await asyncio.wait(self._going, timeout=_CLOSING_S)
        await self.workers.close()
        self.ledger.close()

    def job(self, caller: Caller, work: Callable[[Tell], Any]) -> Job:
        """Work that begins now.

        Raises:
            TooMuchError: too much goes on already.
        """
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
        kept: Json = {"name": name, "observation": given.pop("csi", None), "options": given}
        kept |= {"effect": 0, "demonstration": False}
        kept |= await self.workers.do("facts", tell, **await self._site(kept))
        id = secrets.token_hex(6)
        kept["session"] = await self._new_session(id)
        await self._kept(self.ledger.put, "cell", id, kept, seen=0)
        try:
            await self._site(kept)  # whoever removed the observation meanwhile had not seen that it is used
        except NotFoundError:
            await self.drop_cell(id)
            raise
        return await self.cell(id)

    async def move_cell(self, id: str, observation: str | None, tell: Tell) -> Json:
        """Have a cell work on another observation, None for its own source; with a new conversation."""
        async with self._alone(id, anew=True):
            item = await self._item("cell", id)
            data: Json = {**item.data, "observation": observation}
            data |= await self.workers.do("facts", tell, **await self._site(data))
            await self._kept(self.ledger.drop, "plan", id)
            await self._changed("cell", item, **{**data, "session": await self._new_session(id)})
            try:
                await self._site(data)  # whoever removed the observation meanwhile had not seen that it is used
            except NotFoundError:
                await self._changed("cell", await self._item("cell", id), **item.data)
                raise
        return await self.cell(id)

    async def _site(self, cell: Mapping[str, Any]) -> Json:
        """What a worker is told of a cell: its options with those by which its file is read, and the file.

        Raises:
            NotFoundError: the cell works on an observation that is not there.
        """
        options, observation = cell["options"], cell["observation"]
        if observation is None:
            return {"options": options, "channel": None}
        own, read_as = options.get("source_options", {}), await self.observations.read_as(observation)
        if not isinstance(own, dict):
            raise UnusableError(f"source_options: an object with options; got {own!r}")
        site = await self.observations.channel(observation)
        return {**site, "options": {**options, "source_options": {**read_as, **own}}}

    async def drop_cell(self, id: str) -> None:
        """Remove a cell; its turns stay in the history."""
        async with self._leases.of(id) as lease:
            await self._item("cell", id)
            for kind in ("plan", "cell"):
                await self._kept(self.ledger.drop, kind, id)
            await lease.keep(None)

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
        await self._keep_plan(await self._item("cell", "demonstration"), session, [recorded["last"]])

    # Conversations.

    async def open_session(self, cell: str) -> Json:
        """A new conversation for a cell, in the place of the one that it has; a plan that waited is dropped."""
        async with self._alone(cell, anew=True):
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
        told = await self._leases.telling(held["cell"])
        return {
            "id": id,
            **{name: held[name] for name in ("cell", "created_utc", "language")},
            "in_effect": held["in_effect"] if told is None or told["session"] != id else None,
            "awaits": "confirmation" if waits else held["awaits"],
            "turns": turns,
            "plan": shown(plan.data, "session", "effect") if waits and plan is not None else None,
        }

    async def channel(self, id: str) -> Json | None:
        """What is known of the channel that a conversation is about."""
        await self._item("session", id)
        item = await self._kept(self.ledger.find, "channel", id)
        return None if item is None else item.data["channel"]

    async def trade_off(self, session: str, number: int, tell: Tell) -> Json:
        """The curve that the decision of a turn lies on."""
        async with self._alone(await self._cell_of(session)):
            item = await self._item("session", session)
            cell = await self._item("cell", item.data["cell"])
            return await self._hosted(item, cell, tell, "trade_off", number=number)

    async def say(self, session: str, text: str, caller: Caller, tell: Tell) -> Json:
        """The turn of a line."""
        if not text.strip():
            raise UnusableError("nothing was said: give what the cell should do in 'text'")
        if "\x00" in text:
            raise UnusableError("a line holds no NUL character, as no store can keep one: leave it out")
        if len(text) > _LONGEST_TEXT:
            raise UnusableError(f"a line has at most {_LONGEST_TEXT} characters; got {len(text)}")
        async with self._alone(await self._cell_of(session)):
            return await self._turn(session, caller.name, tell, "say", text=text)

    async def intend(self, cell: str, intent: Mapping[str, Any], caller: Caller, tell: Tell) -> Json:
        """The turn of an intent of TMF921: the first of a new conversation, since an intent says all that is wanted."""
        users = (await self._item("cell", cell)).data["user_names"]
        text = await self.workers.do("intended", tell, intent=intent, user_names=users)
        session = await self.open_session(cell)
        return await self.say(session["id"], text, caller, tell)

    async def press(self, session: str, what: Press, caller: Caller, tell: Tell, *, plan: str | None = None) -> Json:
        """The turn of a button; applying and dropping are for the plan that the caller has seen.

        What is pressed is carried through, also where its caller goes away: nothing is applied by halves. Where it
        breaks off all the same, its turn tells that.
        """

        async def through() -> Json:
            cell = await self._cell_of(session)
            async with self._alone(cell) as lease:
                if what != "undo":
                    await self._take(session, what, plan)
                if what != "yes":
                    return await self._turn(session, caller.name, tell, "press", button=what)
                turns = (await self._item("session", session)).data["turns"]
                await lease.keep({"session": session, "turns": turns, "by": caller.name})
                try:
                    done = await self._turn(session, caller.name, tell, "press", button=what)
                except ProblemError as problem:
                    if problem.status < 500:  # from a worker that goes on: the base station was told nothing
                        await lease.keep(None)
                        raise
                    done = await self._turn(session, caller.name, tell, "broke_off", button=what)
                await lease.keep(None)
                return done

        return await self._through(through())

    @contextlib.asynccontextmanager
    async def _alone(self, cell: str, *, anew: bool = False) -> AsyncGenerator[Lease]:
        """A cell of which nobody else has a turn; one that broke off while the base station was told is told first.

        Where a conversation begins ``anew`` since the one before cannot go on, that one cannot tell it either.
        """
        async with self._leases.of(cell) as lease:
            if lease.telling is not None:
                told = lease.telling
                with contextlib.suppress(*((ProblemError,) if anew else ())):
                    if (await self._item("session", told["session"])).data["turns"] == told["turns"]:
                        await self._turn(told["session"], told["by"], _silent, "broke_off", button="yes")
                await lease.keep(None)
            yield lease

    async def _through(self, work: Coroutine[Any, Any, Found]) -> Found:
        """What comes of work that cannot be cancelled: who tries to is told what came of it, not that it was."""
        task = asyncio.create_task(work)
        self._going.add(task)
        task.add_done_callback(self._going.discard)
        while True:
            try:
                return await asyncio.shield(task)
            except asyncio.CancelledError:
                if task.cancelled():
                    raise

    async def plan(self, cell: str) -> Json | None:
        """The plan that waits for a cell."""
        item = await self._kept(self.ledger.find, "plan", cell)
        return None if item is None else shown(item.data, "session", "effect")

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

    async def _turn(self, session: str, by: str, tell: Tell, do: str, **told: Any) -> Json:
        item = await self._item("session", session)
        cell = await self._item("cell", item.data["cell"])
        self._check_current(cell, session)
        done = await self._hosted(item, cell, tell, do, by=by, **told)
        await self._through(self._settle(item, cell, done))
        if done["stale"]:
            raise ConflictError("the conversation had gone on: look at what holds now")
        last = done["turns"][-1]
        self.metrics.turned(last["record"])
        return {**last["record"], "by": last["by"], "language": last["language"]}

    async def _hosted(self, item: Item, cell: Item, tell: Tell, do: str, **told: Any) -> Json:
        """What the worker of a conversation does in it, which it takes up first where it has to."""
        try:
            site = await self._site(cell.data)
        except NotFoundError as error:
            raise ConflictError(
                f"{error.detail}, which the cell {cell.data['name']!r} works on: put another one in its place, or null "
                f"for a simulated channel, at /v1/cells/{cell.id}/observation; a new conversation begins then"
            ) from error
        held = item.data
        return await self.workers.do(
            do, tell, of=item.id, session=item.id, turns=held["turns"], recalled=held["recalled"], **site, **told
        )

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
            await self._keep_plan(cell, session, done["turns"])

    async def _keep_plan(self, cell: Item, session: str, turns: Sequence[Mapping[str, Any]]) -> None:
        """Have the plan wait that the last of some turns has made or left waiting; none where none waits."""
        turn = turns[-1]
        if not turn["waits"]:
            await self._kept(self.ledger.drop, "plan", cell.id)
            return
        there = await self._kept(self.ledger.find, "plan", cell.id)
        planned = any(one["record"]["stage"] == "planned" for one in turns)
        if not planned and there is not None and there.data["session"] == session:
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
        channel = await self.observations.channel(given.pop("observation", None))
        drawn = bool(given.pop("picture", False))
        return await self.workers.do("operation", tell, name=name, form=given, picture=drawn, **channel)

    async def forms(self) -> Json:
        """What each operation can be asked, as JSON Schema."""
        return await self.workers.do("forms", _silent)

    async def allocation(self, number: int, format: str) -> Json:
        """The allocation of a recorded turn as a file, in base 64 with its media type."""
        return await self.workers.do("allocation", _silent, number=number, format=format)

    # What is kept.

    async def _item(self, kind: str, id: Any) -> Item:
        return await item_of(self.ledger, kind, id)

    async def _changed(self, kind: str, item: Item, **changes: Any) -> None:
        try:
            await self._kept(self.ledger.put, kind, item.id, {**item.data, **changes}, seen=item.version)
        except ChangedError as error:
            raise ConflictError(f"{error}: look at what holds now") from error

    _kept = staticmethod(kept)

    async def _cell_of(self, session: str) -> str:
        """The cell that a conversation is about."""
        return (await self._item("session", session)).data["cell"]


def _cell(item: Item) -> Json:
    understands = item.data["options"].get("recogniser", "offline")
    return {"id": item.id, "recogniser": understands, **shown(item.data, "options", "effect")}


def _turn_id(session: str, number: int) -> str:
    return f"{session}/{number:08d}"


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def _silent(event: Json) -> None:
    del event
