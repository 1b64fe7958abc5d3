"""Predicted beside achieved: what a decision promised, what the true channel gave, and what not knowing it cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from wirelessagent.model.decision import Decision
from wirelessagent.model.metrics import LinkMetrics
from wirelessagent.model.objective import Objective
from wirelessagent.model.outcome import Outcome
from wirelessagent.model.shown import Picture, Shown, Summary
from wirelessagent.model.units import human, reliability
from wirelessagent.telling.catalogue import message
from wirelessagent.telling.facts.performance import (
    among_served,
    predicted_metrics,
    ungrouped_bound,
    with_perfect_knowledge,
)
from wirelessagent.telling.parts import name_of_figure

_FIGURES = (
    ("sum_rate_bps", "bit/s"),
    ("goodput_bps", "bit/s"),
    ("power_w", "W"),
    ("energy_efficiency_bit_per_j", "bit/J"),
    ("spectral_efficiency_bps_per_hz", "bit/s/Hz"),
    ("jain_index", ""),
)


@dataclass(frozen=True, kw_only=True, repr=False)
class Report(Shown):
    """A decision's metrics on the estimated channel and, where the truth is known, on the true one.

    Attributes:
        decision: what was decided.
        predicted: what is expected: the mean rates under the estimate's posterior, and of the committed ones what is
            expected to arrive. Where nothing is uncertain these are the decision's rates.
        achieved: metrics on the true channel; None where it is not known.
        missed_users: numbers of the users whose true rate fell short of the commitment, counted from 0.
        perfect: what would have been decided, and achieved, with every gain known; None where the truth is not known,
            or was.
        ungrouped_bound: what nothing does better than where subcarriers are assigned one by one; NaN where they are.
    """

    decision: Decision
    predicted: LinkMetrics
    achieved: LinkMetrics | None
    missed_users: tuple[int, ...]
    perfect: Decision | None = None
    ungrouped_bound: float = np.nan

    @property
    def regret(self) -> float:
        """What not knowing cost, as a share of the objective's value with perfect knowledge; NaN where that is unknown.

        Of a maximum it is the share that the achieved value lies below it, of the least power the share above it. It is
        negative where power was saved at the price of promises. Commitments that the channel did not carry are not in
        it, since the value counts true rates; see :attr:`goodput_regret`.
        """
        if self.perfect is None or self.achieved is None or not self.perfect.value:
            return np.nan
        ratio = self._value(self.achieved) / self.perfect.value
        return ratio - 1.0 if _objective(self.decision).direction == "min" else 1.0 - ratio

    @property
    def goodput_regret(self) -> float:
        """The share by which what arrives of the committed rates lies below the sum rate with perfect knowledge."""
        if self.perfect is None or self.achieved is None or not self.perfect.rate_bps.any():
            return np.nan
        return 1.0 - self.achieved.goodput_bps / float(self.perfect.rate_bps.sum())

    def figures(self, language: str = "en") -> list[tuple[str, ...]]:
        """(figure, predicted, achieved) as text, "–" where the truth is not known; the objective's own figure first.

        Where perfect knowledge would have decided otherwise, what it would have achieved comes last.
        """
        known = [self.predicted, self.achieved, *([] if self.perfect is None else [predicted_metrics(self.perfect)])]
        rows = [
            (
                message(language, f"label.{name}"),
                *("–" if one is None else human(getattr(one, name), unit) for one in known),
            )
            for name, unit in _FIGURES
        ]
        rows = [*self._decided(language), *self._promises(language), *rows]
        if not name_of_figure(self.decision, language):
            return rows
        unit = self.decision.unit
        values = ("–" if one is None else human(self._value(one), unit) for one in known)
        return [(self._own_label(language), *values), *rows]

    def _own_label(self, language: str) -> str:
        """What the objective's own figure is called in a table."""
        measure = _objective(self.decision).measure
        plain = {"power": "power_w", "efficiency": "energy_efficiency_bit_per_j"}.get(measure, "sum_rate_bps")
        name = name_of_figure(self.decision, language) or message(language, f"label.{plain}")
        return name[:1].upper() + name[1:] if name.isascii() else name  # a capital α reads as an A

    def _decided(self, language: str) -> list[tuple[str, ...]]:
        """The value that the decision was made for, where what is expected of the true channel shows another one."""
        decision, promised = self.decision, self.decision.expected_rate_bps.size > 0
        value = human(decision.value, decision.unit)
        told_by_promises = promised and not name_of_figure(decision, language) and decision.unit == "bit/s"
        if not decision.is_usable or told_by_promises or value == human(self._value(self.predicted), decision.unit):
            return []
        key = "label.at_promised" if promised else "label.as_decided"
        perfect = () if self.perfect is None else (human(self.perfect.value, self.perfect.unit),)
        return [(message(language, key, figure=self._own_label(language)), value, "–", *perfect)]

    def _promises(self, language: str) -> list[tuple[str, ...]]:
        """What is promised with which probability, beside how many promises were kept; nothing without an outage."""
        decision = self.decision
        if decision.problem.outage_probability is None:
            return []
        served = decision.rate_bps > 0
        count = int(served.sum())
        kept = message(language, "label.kept_of", kept=count - len(self.missed_users), served=count)
        label = message(language, "label.promised_at_head", sure=reliability(decision.problem.outage_probability))
        perfect = () if self.perfect is None else (human(float(self.perfect.rate_bps.sum()), "bit/s"),)
        return [
            (label, human(float(decision.rate_bps.sum()), "bit/s"), "–" if self.achieved is None else kept, *perfect)
        ]

    def _value(self, metrics: LinkMetrics) -> float:
        """The objective's value for these rates and power."""
        decision = self.decision
        weight = decision.problem.weights_of(decision.rate_bps.size)
        return _objective(decision).value(metrics.user_rate_bps, metrics.power_w, decision.cell, weight)

    _derived: ClassVar[tuple[str, ...]] = ("regret", "goodput_regret")

    @property
    def _head(self) -> tuple[str, ...]:
        return ("", "predicted", "achieved", *([] if self.perfect is None else ["all gains known"]))

    def summary(self) -> Summary:
        title = f"Report: {self._missed() or f'a decision that is {self.decision.status}'}"
        return Summary(title=title, header=self._head, rows=tuple(self.figures()))

    def picture(self) -> Picture:
        parts = {"decision": self.decision, "achieved": self.achieved, "missed_users": self.missed_users}
        return Picture(kind="rates", parts=parts)

    def columns(self) -> Mapping[str, Any]:
        """One row for each user; no rate achieved where that is not known."""
        decision, users = self.decision, np.arange(self.decision.rate_bps.size)
        known = self.achieved is not None
        return {
            "user": list(decision.user_names),
            "min_rate_bps": decision.problem.min_rates_bps(users.size),
            "predicted_bps": self.predicted.user_rate_bps,
            "committed_bps": decision.committed_bps,
            **({"achieved_bps": self.achieved.user_rate_bps} if self.achieved is not None else {}),
            **({"missed": np.isin(users, self.missed_users)} if known else {}),
        }

    def _missed(self) -> str:
        """How many users missed their rates; empty where that is not known."""
        if self.achieved is None:
            return ""
        served = int(np.count_nonzero(self.decision.committed_bps > 0))
        firmness = self.decision.problem.firmness
        rate = "the rate asked for" if firmness == "asked" else f"their {firmness} rate"
        return f"{len(self.missed_users)} of {served} served users missed {rate}"

    def __str__(self) -> str:
        rows = (self._head, *self.figures())
        lines = [f"{label:22}" + "".join(f" {one:>16}" for one in rest) for label, *rest in rows]
        return "\n".join([*lines, *filter(None, [self._missed()])])


def report(decision: Decision, outcome: Outcome | None = None) -> Report:
    """The report of a decision and, if it was applied, of what the base station read back.

    Where the base station knows the true channel and the decision did not, the report also has what the method, with
    its default options, would have decided with every gain known.
    """
    return Report(
        decision=decision,
        predicted=predicted_metrics(decision),
        achieved=None if outcome is None else among_served(outcome.achieved, decision),
        missed_users=() if outcome is None else tuple(int(user) for user in np.flatnonzero(outcome.missed)),
        perfect=None if outcome is None else with_perfect_knowledge(decision, outcome),
        ungrouped_bound=ungrouped_bound(decision),
    )


def _objective(decision: Decision) -> Objective:
    objective = decision.problem.objective
    assert isinstance(objective, Objective)
    return objective
