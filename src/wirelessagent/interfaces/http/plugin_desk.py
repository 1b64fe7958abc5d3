"""What each operation of the plug-in does with a service."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from wirelessagent.interfaces.http import plugin_forms as forms
from wirelessagent.operations.paragraphs import plain_text
from wirelessagent.service.access import Caller
from wirelessagent.service.assistant import Assistant, told
from wirelessagent.service.jobs import Tell
from wirelessagent.service.service import Service

Json: TypeAlias = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Desk:
    """A service, its caller, and who is told of stages."""

    service: Service
    caller: Caller
    tell: Tell

    async def sense(self, form: forms.SenseForm) -> Json:
        asked = {
            "source_options": {"num_users": form.users, "num_subcarriers": form.subcarriers},
            "loss": [f"random:{form.lost_share}"] if form.lost_share else [],
            "seed": form.seed,
        }
        return _observation(await self.service.observations.derive("simulate", asked, self.tell))

    async def repair(self, form: forms.RepairForm) -> Json:
        return _observation(
            await self.service.observations.derive("repair", form.model_dump(exclude_none=True), self.tell)
        )

    async def max_rate(self, form: forms.SolveForm) -> Json:
        return await self._solved("max_rate", form)

    async def min_power(self, form: forms.SolveForm) -> Json:
        return await self._solved("min_power", form)

    async def max_energy_efficiency(self, form: forms.SolveForm) -> Json:
        return await self._solved("max_energy_efficiency", form)

    async def _solved(self, objective: str, form: forms.SolveForm) -> Json:
        asked = {"objective": objective, **form.model_dump(exclude_none=True)}
        done = await self.service.operate("solve", asked, self.tell)
        return {**_decision(done["record"]), "summary": plain_text(done["blocks"])}

    async def ask(self, form: forms.AskForm) -> Json:
        done = await self.service.operate("ask", form.model_dump(exclude_none=True), self.tell)
        decision = done["record"]["decision"]
        return {**({} if decision is None else _decision(decision)), "summary": plain_text(done["blocks"])}

    async def explain(self, form: forms.ExplainForm) -> Json:
        return _turn(await self._assistant.say(form.cell, form.question, self.caller, self.tell))

    async def propose(self, form: forms.ProposeForm) -> Json:
        return _turn(await self._assistant.say(form.cell, form.text, self.caller, self.tell))

    async def apply(self, form: forms.ApplyForm) -> Json:
        return _turn(await self._assistant.decide("yes", form.plan, self.caller, self.tell))

    async def history(self, form: forms.HistoryForm) -> Json:
        lines = (await self._assistant.history(form.last, None, self.tell))["turns"]
        same = ("number", "at_utc", "stage", "status", "value", "unit", "by")
        return {"turns": [{"said": line["text"], **{name: line[name] for name in same}} for line in lines]}

    async def cells(self, form: forms.CellsForm) -> Json:
        del form
        return {"cells": [_cell(cell) for cell in await self.service.cells()]}

    async def move_cell(self, form: forms.MoveForm) -> Json:
        return {"cell": _cell(await self._assistant.move(form.cell, form.observation, self.tell))}

    @property
    def _assistant(self) -> Assistant:
        return Assistant(self.service)


def _cell(cell: Json) -> Json:
    return {
        "id": cell["id"], "name": cell["name"], "users": len(cell["user_names"]),
        "subcarriers": cell["num_subcarriers"], "max_power_w": cell["max_power_w"],
        "base_station": cell["base_station"] or "none",
    }  # fmt: skip


def _observation(done: Json) -> Json:
    seen = done["observation"]
    return {
        "observation": seen["id"], "users": seen["num_users"], "subcarriers": seen["num_subcarriers"],
        "missing": seen["missing"], "summary": plain_text(done["blocks"]),
    }  # fmt: skip


def _decision(record: Mapping[str, Any]) -> Json:
    """A decision user by user."""
    users: list[Json] = []
    for user, (name, rate) in enumerate(zip(record["user_names"], record["rate_bps"], strict=True)):
        owned = [n for n, owner in enumerate(record["owner"]) if owner == user]
        power_w = sum(record["power_w"][n] for n in owned)
        users.append({"user": name, "subcarriers": owned, "power_w": power_w, "rate_bps": rate})
    gap = record["gap"]
    return {
        **{name: record[name] for name in ("status", "value", "bound", "unit", "total_power_w")},
        "gap_percent": None if gap is None else 100.0 * gap,
        "allocation": users if record["status"] in ("optimal", "feasible") else None,
    }


def _turn(done: Json) -> Json:
    plan: Json = done["plan"] or {}
    return {
        "cell": done["cell"], "stage": done["turn"]["stage"], "said": told(done), "plan": plan.get("id"),
        "plan_until_utc": plan.get("until_utc"),
    }  # fmt: skip
