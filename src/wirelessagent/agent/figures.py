"""Decisions and runs in one line and in tables, in the operator's language."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from wirelessagent.agent.turn import Run
from wirelessagent.agent.words import say
from wirelessagent.explain.report import Report, cannot_be_served, name_of_figure
from wirelessagent.explain.table import Table
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.units import human, percent, reliability

_CHINESE: Mapping[str, str] = {
    "Users": "用户",
    "user": "用户",
    "subcarriers": "子载波",
    "of them repaired": "其中修复的",
    "power": "功率",
    "predicted rate": "预测速率",
    "achieved rate": "实际速率",
    "promised at {}": "以 {} 承诺",
    "{} ({} short)": "{}（少 {}）",
    "figure": "指标",
    "predicted": "预测",
    "achieved": "实际",
    "at least": "至少",
    "at most": "至多",
    "Predicted on the estimate": "在估计信道上预测",
    "Predicted on the estimate, achieved on the true channel": "估计信道上的预测与真实信道上的实际",
    "What it would take": "需要什么",
    "power that the promised rates need": "承诺速率所需功率",
    "largest common scaling of the promised rates": "承诺速率的最大共同倍数",
    "Sum rate": "总速率",
    "Goodput": "有效吞吐量",
    "Radiated power": "发射功率",
    "Energy efficiency": "能效",
    "Spectral efficiency": "频谱效率",
    "Jain's fairness index": "Jain 公平指数",
    "Side by side": "并列比较",
    "objective": "目标",
    "status": "状态",
    "value": "目标值",
    "bound": "界",
    "gap": "差距",
    "power needed": "所需功率",
    "lowest rate": "最低速率",
    "users served": "服务的用户",
    "promises missed": "未兑现的承诺",
    "turn": "轮次",
    "said": "内容",
    "came to": "结果",
}


def worded(language: str, label: str, *figures: object) -> str:
    """A label of a table in the operator's language, with its figures filled in."""
    return (_CHINESE.get(label, label) if language == "zh" else label).format(*figures)


def certificate_line(decision: Decision, language: str = "en") -> str:
    """Status, value, bound and gap in one line."""
    status, method = say(language, decision.status), decision.method
    if not decision.is_usable:
        return say(language, "certificate_unusable", status=status, reason=decision.reason, method=method)
    value = human(decision.value, decision.unit)
    if np.isnan(decision.gap):
        return say(language, "certificate_no_bound", status=status, value=value, method=method)
    outage = decision.problem.outage_probability
    line = say(
        language, "certificate" if outage is None else "certificate_outage", status=status, value=value, method=method,
        bound=human(decision.bound, decision.unit), gap=percent(decision.gap), sure=reliability(outage or 0.0),
    )  # fmt: skip
    left_out = cannot_be_served(decision)
    return say(language, "certificate_note", line=line, note=left_out) if left_out else line


def decision_tables(report: Report, estimate: ChannelEstimate, language: str = "en") -> list[Table]:
    """What people want to see of a decision: users and figures, or what it would take where it cannot be done."""
    if report.decision.is_usable:
        return [user_table(report, estimate, language), report_table(report, language)]
    return [figures_of_infeasibility(report.decision, language)]


def figures_of_infeasibility(decision: Decision, language: str = "en") -> Table:
    """What the request would need and what could be had, each from both sides."""
    rows: list[tuple[str, str, str]] = []
    if decision.needed_power_w is not None:
        need, label = decision.needed_power_w, worded(language, "power that the promised rates need")
        rows.append((label, human(need.at_least, "W"), human(need.at_most, "W")))
    if decision.rate_scaling is not None:
        scale, label = decision.rate_scaling, worded(language, "largest common scaling of the promised rates")
        rows.append((label, f"{scale.at_least:.3g}", f"{scale.at_most:.3g}"))
    return _table(language, "What it would take", ("figure", "at least", "at most"), rows)


def report_table(report: Report, language: str = "en") -> Table:
    """Figures of merit, predicted beside achieved."""
    rows = [(worded(language, label), *figures) for label, *figures in report.figures()]
    if report.achieved is None:
        rows = [row[:2] for row, given in zip(rows, report.figures(), strict=True) if given[0] != "Goodput"]
        return _table(language, "Predicted on the estimate", ("figure", "predicted"), rows)
    title = "Predicted on the estimate, achieved on the true channel"
    return _table(language, title, ("figure", "predicted", "achieved"), rows)


def user_table(report: Report, estimate: ChannelEstimate | None = None, language: str = "en") -> Table:
    """Each user's subcarriers, power and rate."""
    decision = report.decision
    judged = decision.problem.outage_probability is not None and decision.expected_rate_bps.size > 0
    rows: list[tuple[str, ...]] = []
    for user, name in enumerate(decision.user_names):
        own = decision.owner == user
        row = [name, str(int(own.sum()))]
        if estimate is not None:
            row.append(str(int((own & estimate.repaired[user]).sum())))
        row.append(human(float(decision.power_w[own].sum()), "W"))
        row.append(human(decision.rate_bps[user], "bit/s"))
        if judged:
            row.append(human(decision.expected_rate_bps[user], "bit/s"))
        if report.achieved is not None:
            achieved = human(report.achieved.user_rate_bps[user], "bit/s")
            short = percent(_shortfall(report, user)) if user in report.missed_users else ""
            row.append(worded(language, "{} ({} short)", achieved, short) if short else achieved)
        rows.append(tuple(row))
    columns = ["user", "subcarriers", *([] if estimate is None else ["of them repaired"]), "power"]
    if judged:
        columns.append(worded(language, "promised at {}", reliability(decision.problem.outage_probability or 0.0)))
    columns += ["predicted rate", *([] if report.achieved is None else ["achieved rate"])]
    return _table(language, "Users", columns, rows)


def _shortfall(report: Report, user: int) -> float:
    """By how much a user's true rate falls short of the promised one, as a share."""
    assert report.achieved is not None
    return float(1 - report.achieved.user_rate_bps[user] / report.decision.rate_bps[user])


def side_by_side(runs: Sequence[tuple[str, Run]], language: str = "en") -> Table:
    """Runs beside each other: what each is worth, takes and keeps."""
    columns = [worded(language, label) for label in ("figure",)] + [name for name, _ in runs]
    cells = [_cells(run, language) for _, run in runs]
    rows = [(worded(language, label), *(cell[label] for cell in cells)) for label in cells[0]]
    return Table(title=worded(language, "Side by side"), columns=tuple(columns), rows=tuple(rows))


def _cells(run: Run, language: str) -> dict[str, str]:
    """The figures of one run by their labels; "–" for what there is not."""
    decision, objective = run.decision, run.decision.problem.objective
    assert not isinstance(objective, str)
    usable, need = decision.is_usable, decision.needed_power_w
    figure = name_of_figure(decision, language)
    served = decision.problem.serves(decision.rate_bps.size)
    value = f"{human(decision.value, decision.unit)}{f' ({figure})' if figure else ''}"
    missed = "–" if run.outcome is None or run.outcome.achieved is None else str(int(run.outcome.missed.sum()))
    return {
        "objective": objective.name,
        "status": say(language, decision.status),
        "value": value if usable else "–",
        "bound": human(decision.bound, decision.unit),
        "gap": percent(decision.gap),
        "power": human(decision.total_power_w, "W") if usable else "–",
        "power needed": "–" if need is None else human(need.at_least, "W"),
        "Sum rate": human(float(decision.rate_bps.sum()), "bit/s") if usable else "–",
        "lowest rate": human(float(decision.rate_bps[served].min()), "bit/s") if usable else "–",
        "users served": str(int(np.count_nonzero(decision.rate_bps > 0))) if usable else "–",
        "promises missed": missed,
    }


def _table(language: str, title: str, columns: Sequence[str], rows: Sequence[tuple[str, ...]]) -> Table:
    names = tuple(worded(language, column) for column in columns)
    return Table(title=worded(language, title), columns=names, rows=tuple(rows))
