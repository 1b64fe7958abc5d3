"""The decision that holds beside what other figures, aims, methods and repairers make of its request."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import cast

from wirelessagent import plugins
from wirelessagent.agent import answers
from wirelessagent.agent.dialogue import Request, applied
from wirelessagent.agent.figures import side_by_side
from wirelessagent.agent.noting import notes
from wirelessagent.agent.refusing import RefusedError
from wirelessagent.agent.restating import goal_words
from wirelessagent.agent.site import Site
from wirelessagent.agent.state import Reply
from wirelessagent.agent.turn import Run
from wirelessagent.language.acts import Act, Aim
from wirelessagent.language.acts import stated as said
from wirelessagent.language.intent import EVERYBODY, Constraint, Intent
from wirelessagent.model.units import human, reliability
from wirelessagent.telling.catalogue import called, joined, message
from wirelessagent.telling.parts import outcome_in_words
from wirelessagent.telling.reasons import reason_in_words

Column = tuple[str, Run]


def alternatives(request: Request, intent: Intent) -> list[tuple[str, Request]]:
    """Other requests that a comparison names by their figures or aims, and what to call them."""
    details, language = intent.details, intent.language
    limits = [value for key, value in sorted(details.items()) if key.startswith("either_")]
    stated = [value for value in limits if isinstance(value, Mapping)]
    aims = [aim for aim in str(details.get("aims", "")).split() if aim in plugins.names("objective")]
    return [
        *((_figures(one), _with(request, *said(one))) for one in stated),
        *((goal_words(aim, language), _with(request, Aim(objective=aim))) for aim in aims),
    ]


def _with(request: Request, *acts: Act) -> Request:
    changed, _ = applied(request, acts)
    assert changed is not None
    return changed


def beside(site: Site, run: Run, intent: Intent, others: Sequence[tuple[str, Request]], *, noted: bool) -> Reply:
    """Requests solved beside each other; one alone stands beside the one that holds."""
    language = intent.language
    columns = [(name, site.foreseen(site.plan(intent, request))) for name, request in others]
    if len(columns) == 1:
        columns.insert(0, (message(language, "compared.now"), site.foreseen(run)))
    assumed = dict.fromkeys(note for _, one in columns for note in notes(one, noted=noted, before=run.notes))
    text = joined(language, [*assumed, *lines(columns, language), message(language, "plan.nothing_changed")])
    return Reply(text=text, tables=(side_by_side(columns, language),))


def with_tools(site: Site, run: Run, request: Request, intent: Intent, names: Sequence[str]) -> Reply:
    """The decision that holds beside those of other methods, or on what other repairers make of the channel."""
    language = intent.language
    columns, refusals = [(run.decision.method, site.foreseen(run))], list[str]()
    for name in names:
        if name == run.decision.method and len(names) > 1:
            continue  # it has its column already
        if name in plugins.names("method"):
            tools, sight = site.with_tools(method=name), None
        elif name in plugins.names("repairer"):
            tools = dataclasses.replace(site.tools_of(request), repairer=name, repairer_options={})
            sight = site.sight_by(tools, language)
        else:
            known = {f"{kind}s": ", ".join(plugins.names(kind)) for kind in ("method", "repairer")}
            return Reply(text=message(language, "ask_back.not_installed", name=name, **known), stage="asked")
        try:
            columns.append((name, site.foreseen(site.plan(intent, request, sight=sight, tools=tools))))
        except RefusedError as refusal:
            refusals.append(refusal.why)
    listed = message(language, "text.comma").join(called(language, name) for name in names)
    told_lines = lines(columns, language) if len(columns) > 1 else []
    text = "\n".join([joined(language, [message(language, "compared.by", names=listed), *told_lines]), *refusals])
    return Reply(text=text, tables=(side_by_side(columns, language),) if len(columns) > 1 else ())


def lines(columns: Sequence[Column], language: str) -> list[str]:
    """What each of the runs comes to, one sentence each."""
    return [
        message(language, "compared.outcome", name=_capital(called(language, name)), outcome=_outcome(run, language))
        for name, run in columns
    ]


def _capital(name: str) -> str:
    return name[:1].upper() + name[1:]


def _outcome(run: Run, language: str) -> str:
    if run.decision.is_usable:
        return outcome_in_words(answers.case_of(run), run.decision, language)
    return message(language, f"status.{run.decision.status}") + message(
        language, "compared.because", reason=reason_in_words(run.decision, language)
    )


def _figures(limits: Mapping[str, Constraint]) -> str:
    """The figures of limits as a label, as in "95 %"."""
    return " ".join(_figure(name, value) for name, value in limits.items())


def _figure(name: str, value: Constraint) -> str:
    if isinstance(value, Mapping):
        return " ".join(_figure(name, figure) for user, figure in value.items() if user != EVERYBODY or len(value) == 1)
    if name == "outage_probability":
        return reliability(cast(float, value))
    return human(cast(float, value), "bit/s" if name.endswith("bps") else "W")
