"""What a program that speaks for somebody does with a service: an agent over MCP, a low-code platform by its plug-in.

It names cells, and plans by the one-time ids that proposals gave; conversations are the cells' own, so that people see
in the console what was said for them. A line never applies anything.
"""

from __future__ import annotations

from typing import Any, TypeAlias

from wirelessagent.operations.hosted_answers import Press
from wirelessagent.operations.paragraphs import plain_text
from wirelessagent.service.access import Caller
from wirelessagent.service.jobs import Tell
from wirelessagent.service.problems import NotFoundError, UnusableError
from wirelessagent.service.service import Service

Json: TypeAlias = dict[str, Any]


class Assistant:
    """A service, for such programs."""

    def __init__(self, service: Service) -> None:
        self._service = service

    async def cell(self, id: str | None) -> Json:
        """The cell that is meant: the only one where none is named.

        Raises:
            UnusableError: none is named, and there is not just one.
            NotFoundError: there is no such cell.
        """
        if id:
            return await self._service.cell(id)
        found = await self._service.cells()
        if len(found) == 1:
            return found[0]
        known = ", ".join(f"{cell['id']} ({cell['name']!r})" for cell in found) or "none yet"
        raise UnusableError(f"cell: say which one; there are {known}")

    async def conversation(self, cell: str | None) -> Json:
        """The conversation of a cell, with its turns and the plan that waits."""
        return await self._service.session((await self.cell(cell))["session"])

    async def say(self, cell: str | None, text: str, caller: Caller, tell: Tell) -> Json:
        """The turn of a line in a cell's conversation, and the plan that waits now."""
        meant = await self.cell(cell)
        turn = await self._service.say(meant["session"], text, caller, tell)
        return await self._with_plan(meant["id"], turn)

    async def decide(self, what: Press, plan: str, caller: Caller, tell: Tell) -> Json:
        """The turn of applying or dropping the plan of this one-time id."""
        meant = await self._service.cell(await self._service.cell_of_plan(plan))
        turn = await self._service.press(meant["session"], what, caller, tell, plan=plan)
        return await self._with_plan(meant["id"], turn)

    async def undo(self, cell: str | None, caller: Caller, tell: Tell) -> Json:
        """The turn of taking back the last change; going back to another allocation waits for its own yes."""
        meant = await self.cell(cell)
        turn = await self._service.press(meant["session"], "undo", caller, tell)
        return await self._with_plan(meant["id"], turn)

    async def move(self, cell: str | None, observation: str, tell: Tell) -> Json:
        """The cell, on another observation and with a new conversation."""
        return await self._service.move_cell((await self.cell(cell))["id"], observation, tell)

    async def turn(self, session: str, number: int) -> Json:
        """A turn of before, with the plan that waits now.

        Raises:
            NotFoundError: there is no such turn.
        """
        held = await self._service.session(session)
        for turn in held["turns"]:
            if turn["number"] == number:
                return {"cell": held["cell"], "turn": turn, "plan": held["plan"]}
        raise NotFoundError(f"there is no turn {number} in this conversation")

    async def last_decided(self, cell: str | None) -> Json:
        """The turn of a cell whose allocation is in effect, else the last that decided something, if any."""
        held = await self.conversation(cell)
        decided = [turn for turn in held["turns"] if turn["decision"] is not None]
        for turn in decided:
            if turn["number"] == held["in_effect"]:
                return {"cell": held["cell"], "in_effect": True, "turn": turn}
        return {"cell": held["cell"], "in_effect": False, "turn": decided[-1] if decided else None}

    async def history(self, last: int, session: str | None, tell: Tell) -> Json:
        """What was said, decided and done, the latest turns."""
        form: Json = {"last": last, **({"session": session} if session else {})}
        return (await self._service.operate("history", form, tell))["record"]

    async def _with_plan(self, cell: str, turn: Json) -> Json:
        return {"cell": cell, "turn": turn, "plan": await self._service.plan(cell)}


def told(answer: Json) -> str:
    """A turn and the plan that waits, for who reads text: the three lines, tables where something was asked."""
    turn, plan = answer["turn"], answer["plan"]
    lines = [line for line in (turn["lines"][part] for part in ("decided", "changed", "needs")) if line]
    shown: list[Json] = turn["tables"] if turn["stage"] in ("answered", "asked") else []
    said = plain_text([lines, *shown])
    if plan is None or plan["turn"] != turn["number"]:
        return said
    return (
        f"{said}\n\nNothing was applied. The plan {plan['id']} waits until {plan['until_utc']}: show the operator what "
        "changes, and apply it only after their yes."
    )
