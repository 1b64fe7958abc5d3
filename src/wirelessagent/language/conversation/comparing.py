"""Comparisons of figures or aims: "compare 95 % and 99 %", "which is better, 5 W or 10 W?", "和比例公平比较".

Each is an alternative to the request that holds, under the details "either_1", "either_2" and so on as constraints, or
as names under "aims".
"""

from __future__ import annotations

import dataclasses

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Constraint, Detail, Intent
from wirelessagent.language.named_tools import tools_named
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.language.sentence import Sentence, own_words

_COMPARES = deferred(
    r"\b(?:compar(?:e|ed|ing|ison)|versus|vs\.?|differences?\s+between|side\s+by\s+side|(?:which|what)(?:'s|\s+is)\s+better)\b|"
    r"比较|对比|相比|比一比|比一下|区别|差别|差异|差多少|哪个[更比较]?好"
)
_BETTER = deferred(r"\bbetter\b|好")
_OF_OTHERS = deferred(r"\b(?:missing|lost|loss|gone|unknown|turns?)\b|缺|丢|轮")
_POWER = deferred(r"\b(?:power|budget)\b|功率")
_CAP = deferred(r"\b(?:at\s+most|max(?:imum)?|cap(?:ped)?)\b|上限|不超过|最高")
_MOST = 4


def read_comparison(line: Line) -> Intent | None:
    """The comparison of figures or aims that a line asks for; None for any other line."""
    if line.context.objective is None or not _COMPARES.search(line.shape) or _OF_OTHERS.search(line.shape):
        return None
    figures = _figures(line.text)
    if figures:
        return _of_figures(line, figures)
    found = Sentence(line.text, own_words()).found
    aims = dict.fromkeys(each.term.objective for each in found if each.term.objective)
    if aims:
        return line.command("compare", aims=" ".join(aims)) if len(aims) <= _MOST else None
    tools = tools_named(line.text, "method", "repairer") if _BETTER.search(line.shape) else ()
    return line.command("compare", **{"with": " ".join(tools)}) if tools else None


def _figures(text: str) -> list[Quantity]:
    """Powers, rates and shares; a bare number beside a share is one in percent too: "95, 99 and 99.9 %"."""
    said = parse_quantities(text)
    shared = any(figure.kind == "ratio" for figure in said)
    return [
        dataclasses.replace(figure, kind="ratio", value=figure.value / 100) if figure.kind == "bare" else figure
        for figure in said
        if figure.kind in ("power", "rate", "ratio") or (shared and figure.kind == "bare")
    ]


def _of_figures(line: Line, figures: list[Quantity]) -> Intent | None:
    kinds = {figure.kind for figure in figures}
    if len(kinds) > 1 or len(figures) > _MOST or any(figure.doubtful or figure.value <= 0 for figure in figures):
        return None
    limits = [_limit(line, figure) for figure in figures]
    details: dict[str, Detail] = {f"either_{place}": limit for place, limit in enumerate(limits, start=1) if limit}
    return line.command("compare", **details) if len(details) == len(figures) else None


def _limit(line: Line, figure: Quantity) -> dict[str, Constraint]:
    """The limit that a figure is: a probability of 50 % or more is that of keeping a promise. Empty for none."""
    if figure.kind == "power":
        return {"max_power_w": figure.value}
    if figure.kind == "rate":
        rate: Constraint = dict.fromkeys(line.users, figure.value) if line.users else figure.value
        return {"max_rate_bps" if _CAP.search(line.shape) else "min_rate_bps": rate}
    if _POWER.search(line.shape):
        held = line.context.constraints.get("max_power_w")
        limit = line.context.max_power_w
        return {"max_power_w": figure.value * (min(held, limit) if isinstance(held, float) else limit)}
    outage = 1.0 - figure.value if figure.value >= 0.5 else figure.value
    return {"outage_probability": round(outage, 12)} if 0 < outage < 1 else {}
