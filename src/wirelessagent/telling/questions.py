"""Questions about a decision by their topic, each answered by what is computed for it."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

from wirelessagent.telling.catalogue import joined
from wirelessagent.telling.certificates import certificate_answer, uncertainty_answer
from wirelessagent.telling.facts.accounts import account, newcomer
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.contests import contested
from wirelessagent.telling.facts.marginal_prices import marginal_prices
from wirelessagent.telling.facts.nearest import nearest
from wirelessagent.telling.facts.reach import for_the_total, has_reach, kept_by, reach
from wirelessagent.telling.facts.steps import Step, power_step, rate_step
from wirelessagent.telling.prices import contested_table, prices_answer, prices_table
from wirelessagent.telling.remedies import feasible_answer, nearest_answer
from wirelessagent.telling.report import Report
from wirelessagent.telling.step_effects import no_power_answer, reach_answer, step_answer
from wirelessagent.telling.tables import user_table
from wirelessagent.telling.text_table import Table
from wirelessagent.telling.user_account import newcomer_answer, share_answer, user_answer

Answer = tuple[str, tuple[Table, ...]]


def answered(
    case: Case, report: Report, topic: str, language: str, *, user: int | None = None, figures: Mapping[str, float]
) -> Answer | None:
    """The answer to a question and its tables; None where the topic is none of these.

    Args:
        case: the decision asked about.
        report: of the decision.
        topic: why_user, why_infeasible, certificate, uncertainty, step, prices or users.
        language: the operator's.
        user: whom it is about, from 0.
        figures: power_w, rate_bps, rate_share or users of a step: how much more, or how many; "each" where the rate is
            every user's.
    """
    usable = case.decision.is_usable
    if topic == "why_user" and user is not None:
        return user_answer(case, account(case, user), language), ()
    if topic == "step" and "users" not in figures:
        return _step(case, language, user, figures), ()
    if topic == "why_infeasible" or not usable:
        if usable:
            return feasible_answer(case, language), ()
        return nearest_answer(case, nearest(case), language), ()
    if topic == "step":
        return newcomer_answer(case, newcomer(case), language), ()
    users = user_table(report, case.estimate, language)
    if topic in ("users", "prices") and user is not None:
        row = dataclasses.replace(users, rows=(users.rows[user],))
        return share_answer(case, user, language), (row,)
    if topic == "certificate":
        return certificate_answer(case, language), ()
    if topic == "uncertainty":
        return uncertainty_answer(case, language), (users,)
    if topic == "prices":
        prices = marginal_prices(case)
        tables = prices_table(case, prices, language), _contests(case, language)
        return prices_answer(case, prices, language), _known(*tables)
    if topic == "users":
        return "", _known(users, _contests(case, language))
    return None


def _step(case: Case, language: str, user: int | None, figures: Mapping[str, float]) -> str:
    if "rate_share" in figures or ("rate_bps" in figures and user is None and "each" not in figures):
        return _more_rate(case, language, figures)
    if "rate_bps" in figures:
        return _stepped(case, rate_step(case, figures["rate_bps"], user), language)
    step_w = figures.get("power_w", 1.0)
    step = power_step(case, step_w)
    return no_power_answer(case, step_w, language) if step is None else _stepped(case, step, language)


def _stepped(case: Case, step: Step, language: str) -> str:
    usable = step.before.is_usable and step.after.is_usable
    return step_answer(case, step, kept_by(case, step) if usable else None, language)


def _more_rate(case: Case, language: str, figures: Mapping[str, float]) -> str:
    """What more rate takes where nobody says whose: of the value where that is one, else of the promises and in all."""
    now, promised = case.decision.value, float(case.promised_bps.max())
    usable, share = case.decision.is_usable, figures.get("rate_share")
    if has_reach(case):
        step = figures["rate_bps"] if share is None else share * now
        return _reached(case, now, step, case.problem.budget_w(case.cell), language)
    total = float(case.decision.rate_bps.sum()) if usable else 0.0
    each = figures["rate_bps"] if share is None else share * promised
    said = [_stepped(case, rate_step(case, each), language)] if promised > 0 or not usable else []
    if total > 0:
        step = figures["rate_bps"] if share is None else share * total
        said.append(_reached(for_the_total(case), total, step, case.decision.total_power_w, language))
    return joined(language, said)


def _reached(case: Case, now: float, step: float, spent_w: float, language: str) -> str:
    found = reach(case, now + step) if now + step > 0 else None
    return reach_answer(case, found, now, step, spent_w, language)


def _contests(case: Case, language: str) -> Table | None:
    return contested_table(case, contested(case), language)


def _known(*tables: Table | None) -> tuple[Table, ...]:
    return tuple(table for table in tables if table is not None)
