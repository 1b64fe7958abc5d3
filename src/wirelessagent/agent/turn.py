"""One turn of a conversation: what was said, what was understood, what was done, and what was replied.

What is asked for, and what changed of it and of the allocation, are told with figures and units to be checked.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

import numpy as np

from wirelessagent.language.acts import Act, AskWhy, AskWhyNot, Press
from wirelessagent.language.intent import Intent, acts_of
from wirelessagent.language.replies import aimed, figure_in_words, limits_in_words
from wirelessagent.language.request import Diff, Request, constraints_of
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import WirelessAgentError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.legible import legible
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.scene import Scene
from wirelessagent.model.shown import Picture, Shown, Summary
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import Table, called, capital, joined, lines_of, message
from wirelessagent.telling.explanation import certificate_line, explain, summary_line
from wirelessagent.telling.facts.case import Case, in_use
from wirelessagent.telling.parts import goal_words
from wirelessagent.telling.report import Report, decision_tables, report

Stage: TypeAlias = Literal["answered", "asked", "planned", "applied", "reverted", "undone", "nothing"]
"""What a turn came to: answered (a question; nothing was to be applied), asked (a question back), planned (a decision
that waits to be applied), applied, reverted (applied, found worse than promised and taken back), undone, or nothing
(what was wanted is so already, or cannot be done)."""


@dataclass(frozen=True, kw_only=True)
class Tools:
    """Plug-ins by name, and their options; None leaves the choice to the chain."""

    repairer: str | None = None
    repairer_options: Mapping[str, Any] = field(default_factory=dict[str, Any])
    method: str | None = None
    method_options: Mapping[str, Any] = field(default_factory=dict[str, Any])
    base_station: str | None = None
    base_station_options: Mapping[str, Any] = field(default_factory=dict[str, Any])


@dataclass(frozen=True, kw_only=True, repr=False)
class Run(Shown):
    """One run of the chain: every stage's result, the notes made on the way and the explanation.

    Attributes:
        intent: what was understood.
        scene: the scene, with the cell that the intent states.
        observation: what was seen of the channel.
        estimate: what was made of it.
        decision: who gets what; the problem that it solves is ``decision.problem``.
        outcome: what the base station did, read back; None where nothing was applied.
        report: predicted beside achieved.
        notes: what was assumed on the way.
        explanation: the decision in words.
        tools: the plug-ins that made it.
    """

    intent: Intent
    scene: Scene
    observation: ChannelObservation
    estimate: ChannelEstimate
    decision: Decision
    outcome: Outcome | None
    report: Report
    notes: tuple[str, ...]
    explanation: tuple[str, ...]
    tools: Tools

    @property
    def case(self) -> Case:
        """The decision with what it was made from, to be asked what would be otherwise."""
        method, options = self.tools.method, self.tools.method_options
        return Case(decision=self.decision, estimate=self.estimate, method=method, options=options)

    @property
    def promised_bps(self) -> FloatArray:
        """What each user was promised, as it was read back where it was."""
        return self.decision.rate_bps if self.outcome is None else self.outcome.promised_bps

    def tables(self, language: str) -> tuple[Table, ...]:
        """What people want to see of the decision."""
        return tuple(decision_tables(self.report, self.estimate, language))

    def is_of(self, other: Run) -> bool:
        """Whether two runs are of one decision, applied or not."""
        return self.decision is other.decision

    def with_outcome(self, outcome: Outcome | None) -> Run:
        """The run after the base station did something, with its report and its explanation."""
        made = report(self.decision, outcome)
        explained = explain(self.estimate, made, language=self.intent.language)
        return dataclasses.replace(self, outcome=outcome, report=made, explanation=tuple(explained))

    def __str__(self) -> str:
        line = certificate_line(self.decision, self.intent.language)
        return legible("\n".join([line, *self.notes, *self.explanation, str(self.report)]))

    def summary(self) -> Summary:
        seen, lost = self.observation, int(self.observation.missing.sum())
        sensed = f"{seen.num_users} users × {seen.num_subcarriers} subcarriers, {lost} of {seen.missing.size} missing"
        applied = "not applied" if self.outcome is None else f"by the base station {self.outcome.base_station}"
        rows = [("sensed", sensed), ("repaired by", self.estimate.method), ("applied", applied)]
        rows += [("because", line) for line in self.explanation[:1]]
        language = self.intent.language
        for label, predicted, achieved, *_ in self.report.figures(language)[:4]:
            rows.append((label, f"{predicted} predicted{'' if achieved == '–' else f'; achieved: {achieved}'}"))
        return Summary(title=f"Run: {summary_line(self.decision, language)}", rows=tuple(rows))

    def picture(self) -> Picture:
        names = ("observation", "estimate", "decision", "outcome")
        return Picture(kind="chain", parts={name: getattr(self, name) for name in names})

    def columns(self) -> Mapping[str, Any]:
        """One row for each user: its report."""
        return self.report.columns()


def restated(request: Request, language: str = "en") -> str:
    """What is asked for, in one sentence.

    >>> restated(Request(objective="max_rate", constraints={"max_power_w": 10.0, "leave_out": ("3",)}))
    'The highest total rate: at most 10 W of radiated power, without user 3.'
    """
    goal, limits = goal_words(request.objective, language), limits_in_words(request.constraints, language)
    if request.method is not None:
        by = message(language, "request.by_method", method=called(language, request.method))
        limits = message(language, "text.between").join(part for part in (limits, by) if part)
    return aimed("request.whole", goal, limits, language)


def changes_in_words(diff: Diff, language: str) -> str:
    """What was changed of a request that held; empty for a first request.

    >>> from wirelessagent.language.request import difference
    >>> old, new = (Request(objective="max_rate", constraints={"max_power_w": watts}) for watts in (10.0, 5.0))
    >>> changes_in_words(difference(old, new), "en")
    'Now: at most 5 W of radiated power (before: 10 W).'
    """
    then_aim, now_aim = diff.objective
    if then_aim is None:
        return ""
    said = list[str]()
    if now_aim is not None and then_aim != now_aim:
        then, now = goal_words(then_aim, language), goal_words(now_aim, language)
        said.append(message(language, "changed.aim", then=then, now=now))
    groups: dict[tuple[str, float | None, float], list[str]] = {}
    for one in diff.changes:
        if one.after is not None:
            groups.setdefault((one.kind, one.before, one.after), []).append(one.user)
    for (kind, before, after), users in groups.items():
        now = limits_in_words(constraints_of({(kind, user): after for user in users}), language)
        then = "" if before is None else figure_in_words(kind, before)
        said.append(message(language, "changed.instead", now=now, then=then) if then else now)
    told = message(language, "changed.changed", changes=message(language, "text.list").join(said)) if said else ""
    gone = limits_in_words(diff.gone, language)
    return joined(language, [told, message(language, "request.no_longer", limits=gone) if diff.gone else ""])


@dataclass(frozen=True, kw_only=True)
class Shift:
    """What became of an allocation that held, with another decision.

    Attributes:
        subcarriers, total: how many of them serve another user, or nobody any more.
        sum_rate_bps, power_w: before and after.
        rate_bps: of each user whose rate is another, before and after.
    """

    subcarriers: int
    total: int
    sum_rate_bps: tuple[float, float]
    power_w: tuple[float, float]
    rate_bps: Mapping[str, tuple[float, float]]

    def in_words(self, language: str) -> str:
        """The same in a sentence; empty where nothing of it shows."""
        said: list[str] = []
        for name, pair, unit in (("sum_rate", self.sum_rate_bps, "bit/s"), ("power", self.power_w, "W")):
            before, now = (human(value, unit) for value in pair)
            said += [message(language, f"changed.{name}", before=before, now=now)] if before != now else []
        if self.subcarriers:
            said.append(message(language, "changed.subcarriers", moved=self.subcarriers, total=self.total))
        listed = message(language, "text.list").join(said)
        return message(language, "changed.allocation", changes=capital(listed)) if said else ""


def shift_between(before: Decision | None, after: Decision | None) -> Shift | None:
    """What becomes of an allocation; None where there is none before or after, or not of the same cell."""
    if before is None or after is None or before is after or not (before.is_usable and after.is_usable):
        return None
    if before.owner.shape != after.owner.shape or before.user_names != after.user_names:
        return None
    owners = [in_use(one) for one in (before, after)]
    pairs = zip(before.user_names, before.rate_bps.tolist(), after.rate_bps.tolist(), strict=True)
    return Shift(
        subcarriers=int(np.count_nonzero(owners[0] != owners[1])), total=owners[0].size,
        sum_rate_bps=(float(before.rate_bps.sum()), float(after.rate_bps.sum())),
        power_w=(before.total_power_w, after.total_power_w),
        rate_bps={name: (then, now) for name, then, now in pairs if then != now},
    )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Lines:
    """What a turn says, in three lines for people; one that has nothing to say is empty.

    Attributes:
        decided: what was decided and how sure that is, or the answer.
        changed: what that changed.
        needs: what it needs from the operator.
    """

    decided: str = ""
    changed: str = ""
    needs: str = ""

    def __str__(self) -> str:
        return lines_of((self.decided, self.changed, self.needs))

    def ending_with(self, note: str, language: str) -> Lines:
        """The same with a note at the end of the last line that says something."""
        last = next((name for name in ("needs", "changed", "decided") if getattr(self, name)), "decided")
        return dataclasses.replace(self, **{last: joined(language, [getattr(self, last), note])})


@dataclass(frozen=True, kw_only=True, repr=False)
class Done:
    """What came of a line, beside what is said.

    Attributes:
        stage: see :data:`Stage`.
        run: the run of the chain that the reply speaks of; a what-if's own, which nothing was applied of.
        tables: figures that belong to the reply.
        restored: what the base station read back after the last good allocation was put back; None where none was.
        error: what the reply tells of, where something could not be done.
        faulty: whether what is in effect now is not as it was decided or promised, with nothing to go back to.
    """

    stage: Stage = "answered"
    run: Run | None = None
    tables: tuple[Table, ...] = ()
    restored: Outcome | None = None
    error: WirelessAgentError | None = None
    faulty: bool = False


@dataclass(frozen=True, kw_only=True, repr=False)
class Turn(Done, Shown):
    """What came of one line of a conversation.

    Attributes:
        number: of the turn in its session, from 1.
        session: the session's identifier.
        text: what the operator said.
        intent: what was understood.
        lines: what the agent said, in the operator's language.
        at_utc: when it was done, ISO 8601.
        version: of this package.
        seed: of every draw.
        recogniser: which recogniser understood it.
        diff: what the turn changed of what is asked for.
        shift: what it changed of the allocation that held; None where it decided nothing, or nothing held.
        by: the operator's name, where several are known.
        pressed: the button that the text stands for; None where the line was said.
    """

    number: int
    session: str
    text: str
    intent: Intent
    lines: Lines
    at_utc: str
    version: str
    seed: int
    recogniser: str
    diff: Diff = field(default_factory=Diff)
    shift: Shift | None = None
    by: str = ""
    pressed: Press | None = None

    @property
    def reply(self) -> str:
        """The lines of which something is said."""
        return str(self.lines)

    @property
    def acts(self) -> tuple[Act, ...]:
        """What the line does to the conversation."""
        return acts_of(self.intent)

    def summary(self) -> Summary:
        reply = [("reply", line) for line in self.reply.split("\n") if line.strip()]
        tables = [("tables", ", ".join(table.title for table in self.tables))] if self.tables else []
        return Summary(title=f"Turn {self.number}: {self.stage}", rows=(("said", self.text), *reply, *tables))

    def picture(self) -> Picture | None:
        return None if self.run is None else self.run.picture()

    def columns(self) -> Mapping[str, Any]:
        """One row."""
        decision = None if self.run is None else self.run.decision
        figures = ("status", "value", "bound", "gap", "total_power_w")
        said = {"number": self.number, "stage": self.stage, "text": self.text, "reply": self.reply}
        decided = {name: None if decision is None else getattr(decision, name) for name in figures}
        return {name: [value] for name, value in {**said, **decided}.items()}


def unmet(turns: Sequence[Turn]) -> Run | None:
    """What the line before asked for or supposed, where that can't be met; questions why lie between."""
    why = (AskWhyNot, AskWhy)
    last = next((turn for turn in reversed(turns) if not any(isinstance(act, why) for act in turn.acts)), None)
    run = None if last is None else last.run
    return None if run is None or run.decision.is_usable else run
