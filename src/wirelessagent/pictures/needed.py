"""What a request that cannot be met would take, in words for a picture."""

from __future__ import annotations

import math
from collections.abc import Iterable

from wirelessagent.model.decision import Bracket, Decision
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import message


def needed_lines(decisions: Iterable[Decision], language: str = "en") -> list[str]:
    """The power that the promised rates need and the part of them that can be had: the tightest that any decision on
    one problem knows, and nothing where none knows.
    """
    found = list(decisions)
    power = _tightest(decision.needed_power_w for decision in found)
    scaling = _tightest(decision.rate_scaling for decision in found)
    lines: list[str] = []
    if math.isfinite(power.at_least):
        key = "needed.between" if math.isfinite(power.at_most) else "needed.at_least"
        lines.append(message(language, key, least=human(power.at_least, "W"), most=human(power.at_most, "W")))
    if math.isfinite(scaling.at_most):
        lines.append(message(language, "needed.scaling", least=scaling.at_least, most=scaling.at_most))
    return lines


def _tightest(brackets: Iterable[Bracket | None]) -> Bracket:
    known = [bracket for bracket in brackets if bracket is not None]
    low = [bracket.at_least for bracket in known if not math.isnan(bracket.at_least)]
    high = [bracket.at_most for bracket in known if not math.isnan(bracket.at_most)]
    return Bracket(at_least=max(low, default=math.nan), at_most=min(high, default=math.nan))
