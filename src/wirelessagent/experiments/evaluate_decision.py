"""What repair is worth to decisions: what is reached on the true channel, as a share of perfect knowledge.

Every strategy decides on the same observations and is judged on the same true channels:

- ``goodput``: the rates committed by a max-rate decision, counted where the true channel carries them. What is lost
  has three parts: ``choice``, since other users and powers would have been better; ``not_carried``, the true rates of
  users whose commitment was too high; and the rest, caution: what the others could have been sent beyond it;
- ``proportional_fairness`` and ``max_min_rate``: the geometric mean and the smallest of the users' true rates;
- ``min_power``: how many users miss the rate that they were promised with an accepted outage probability, among all and
  among those whose allocation rests on a repaired entry, and the power spent.

Beside the repairers stands ``avoid_repaired``, which gives nobody an entry that was not observed: it keeps every
promise where observations are exact, at the price of fewer choices.
"""

from __future__ import annotations

import dataclasses
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

import numpy as np

from wirelessagent import chain
from wirelessagent.experiments.draws import Seeds, run_draws
from wirelessagent.experiments.evaluate_decision_pictures import promises_canvas, regret_canvas
from wirelessagent.experiments.evaluated_channels import Drawn, EvaluatedChannel
from wirelessagent.experiments.evaluated_methods import BASELINE, ORACLE, repaired
from wirelessagent.experiments.evaluation import Evaluated, Evaluation
from wirelessagent.experiments.experiment import Progress
from wirelessagent.experiments.intervals import resampled_sums, with_interval
from wirelessagent.experiments.table import Table, Value, table_of
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.metrics import LinkMetrics, kept, link_metrics
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.problem import Problem
from wirelessagent.pictures.canvas import Canvas
from wirelessagent.sensing.loss import parse as parse_loss

PERFECT = "perfect"
AVOID = "avoid_repaired"

OBJECTIVES = ("goodput", "proportional_fairness", "max_min_rate")
"""What is reached is a share of what perfect knowledge reaches."""

_REACHED = slice(0, 3)
_USERS, _MISSED, _RESTING, _MISSED_RESTING, _POWER, _PERFECT_POWER, _POSED, _REFUSED = range(3, 11)
_SUM_RATE, _NOT_CARRIED, _MISSING = range(11, 14)
"""Places of the sums of a draw."""

FIGURES = (
    *(f"{name}_share" for name in OBJECTIVES), "missed_share", "missed_of_resting_share", "resting_share",
    "power_ratio", "refused_share", "choice_share", "not_carried_share",
)  # fmt: skip

COLUMNS = (
    "channel", "loss", "method", *(f"{name}{end}" for name in FIGURES for end in ("", "_low", "_high")),
    "missing_share",
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class EvaluateDecision(Evaluation):
    """Repairers compared by the decisions that are made on them.

    Attributes:
        channels: to decide on.
        losses: patterns in the words of :func:`wirelessagent.sensing.loss.parse`.
        methods: repairers, of :func:`wirelessagent.experiments.evaluated_methods.all_methods`.
        min_rate_bps: the rate promised to each user at the least power.
        outage_probability: accepted for that promise; where not set, the rate is promised on the estimate as it stands.
        max_power_w: the power budget; the cell's where not set.
    """

    name = "evaluate_decision"
    summary = "What decisions on repaired channels reach on the true one, and which promises they keep"

    channels: tuple[EvaluatedChannel, ...]
    losses: tuple[str, ...]
    methods: tuple[str, ...]
    min_rate_bps: float = 0.5e6
    outage_probability: float | None = None
    max_power_w: float | None = None

    def run(
        self, *, draws: int, seed: int, progress: Progress | None = None, executor: Executor | None = None
    ) -> Evaluated:
        for problem in self._problems():
            chain.check_solvable(problem)
        cases = [(channel, loss) for channel in self.channels for loss in self.losses]
        rows: list[tuple[Value, ...]] = []
        for number, (channel, loss) in enumerate(cases):

            def told(done: int, total: int, number: int = number) -> None:
                if progress is not None:
                    progress(number * total + done, len(cases) * total)

            methods = tuple(name for name in self.methods if name != ORACLE or channel.has_oracle)
            strategies = (PERFECT, *methods, AVOID)
            draw = DecisionDraw(channel, loss, strategies, self._problems())
            sums = run_draws(draw, draws=draws, seed=seed, progress=told, executor=executor)
            rows += _rows((channel.name, loss), strategies, sums, seed)
        table = table_of(COLUMNS, rows)
        return Evaluated(tables={self.name: table}, findings=_findings(table), draws=draws, seed=seed)

    def _problems(self) -> tuple[Problem, ...]:
        """One for each of ``OBJECTIVES``, then that of the promises."""
        names = ("max_rate", "proportional_fairness", "max_min_rate")
        free = [Problem(name, max_power_w=self.max_power_w) for name in names]
        promise = Problem(
            "min_power",
            min_rate_bps=self.min_rate_bps,
            max_power_w=self.max_power_w,
            outage_probability=self.outage_probability,
        )
        return (*free, promise)

    def pictures(self, result: Evaluated) -> dict[str, Canvas]:
        captions = dict.fromkeys(channel.caption() for channel in self.channels)
        note = f"{'; '.join(captions)}; {result.draws} draw{'s' * (result.draws != 1)} each"
        promise = f"{self.min_rate_bps / 1e6:g} Mbit/s promised to each user"
        return {
            "regret": regret_canvas(result.table, OBJECTIVES, note),
            "promises": promises_canvas(result.table, self.outage_probability, f"{promise}; {note}"),
        }

    def configuration(self) -> dict[str, Any]:
        return {
            "channels": {channel.name: channel.caption() for channel in self.channels},
            "losses": list(self.losses),
            "methods": list(self.methods),
            "min_rate_bps": self.min_rate_bps,
            "outage_probability": self.outage_probability,
            "max_power_w": self.max_power_w,
        }


@dataclass(frozen=True)
class DecisionDraw:
    """One draw: figures of each strategy, shape (strategy, sum), in the order of the places above."""

    channel: EvaluatedChannel
    loss: str
    strategies: tuple[str, ...]
    problems: tuple[Problem, ...]

    def __call__(self, seeds: Seeds) -> FloatArray:
        drawn = self.channel.drawn(seeds.channel)
        observation = drawn.scene.observe(parse_loss(self.loss), seed=seeds.loss)
        sums = np.zeros((len(self.strategies), _MISSING + 1))
        perfect = chain.perfect(drawn.scene)
        promised = chain.decide(perfect, self.problems[-1], drawn.scene.cell)
        for row, strategy in zip(sums, self.strategies, strict=True):
            estimate = perfect if strategy == PERFECT else _estimate(strategy, drawn, observation)
            forbidden = observation.missing if strategy == AVOID else None
            problems = [problem if forbidden is None else _without(problem, forbidden) for problem in self.problems]
            *free, promise = (chain.decide(estimate, problem, drawn.scene.cell) for problem in problems)
            row[_REACHED] = [_reached(at, decision, drawn) for at, decision in enumerate(free)]
            row[_SUM_RATE], row[_NOT_CARRIED] = _rates(free[0], drawn)
            row[_MISSING] = observation.missing.mean()
            if promised.is_usable:
                _count_promise(row, promise, promised, estimate, drawn)
        return sums


def _estimate(strategy: str, drawn: Drawn, observation: ChannelObservation) -> ChannelEstimate:
    return repaired(BASELINE if strategy == AVOID else strategy, drawn, observation)[0]


def _without(problem: Problem, forbidden: np.ndarray[Any, np.dtype[np.bool_]]) -> Problem:
    """The problem without the entries that are forbidden."""
    return dataclasses.replace(problem, forbidden=forbidden)


def _achieved(decision: Decision, drawn: Drawn) -> LinkMetrics:
    return link_metrics(
        drawn.truth, decision.owner, decision.power_w, drawn.scene.cell, committed_bps=decision.committed_bps
    )


def _rates(decision: Decision, drawn: Drawn) -> tuple[float, float]:
    """The true sum rate of a decision, and what of it users have whose commitment was too high, in bit/s."""
    if not decision.is_usable:
        return 0.0, 0.0
    rate = _achieved(decision, drawn).user_rate_bps
    return float(rate.sum()), float(rate[~kept(rate, decision.committed_bps)].sum())


def _reached(objective: int, decision: Decision, drawn: Drawn) -> float:
    """What a decision for one of ``OBJECTIVES`` comes to on the true channel, in bit/s; 0 where there is none."""
    if not decision.is_usable:
        return 0.0
    achieved = _achieved(decision, drawn)
    rates = achieved.user_rate_bps
    if objective == 0:
        return achieved.goodput_bps
    if objective == 1:
        return float(np.exp(np.mean(np.log(rates)))) if rates.min() > 0 else 0.0
    return float(rates.min())


def _count_promise(
    row: FloatArray, promise: Decision, perfect: Decision, estimate: ChannelEstimate, drawn: Drawn
) -> None:
    """Count who misses the promised rate, and what power is spent; draws that nobody can serve do not count."""
    row[_POSED] = 1.0
    if not promise.is_usable:
        row[_REFUSED] = 1.0
        return
    users = np.arange(estimate.num_users)
    missed = ~kept(_achieved(promise, drawn).user_rate_bps, promise.rate_bps)
    used = (promise.owner == users[:, np.newaxis]) & (promise.power_w > 0)
    resting = (used & estimate.repaired).any(axis=1)
    row[_USERS], row[_MISSED] = users.size, missed.sum()
    row[_RESTING], row[_MISSED_RESTING] = resting.sum(), (missed & resting).sum()
    row[_POWER], row[_PERFECT_POWER] = promise.total_power_w, perfect.total_power_w


def _rows(case: tuple[str, str], strategies: tuple[str, ...], sums: FloatArray, seed: int) -> list[tuple[Value, ...]]:
    """The rows of one channel and loss, from the figures of all draws (draw, strategy, sum)."""
    total = np.moveaxis(resampled_sums(sums, seed=seed), -1, 0)
    reached = total[_REACHED]
    perfect = strategies.index(PERFECT)
    with np.errstate(divide="ignore", invalid="ignore"):
        figures = [
            *(reached / reached[:, :, [perfect]]),
            total[_MISSED] / total[_USERS],
            total[_MISSED_RESTING] / total[_RESTING],
            total[_RESTING] / total[_USERS],
            total[_POWER] / total[_PERFECT_POWER],
            total[_REFUSED] / total[_POSED],
            1.0 - total[_SUM_RATE] / total[_SUM_RATE][:, [perfect]],
            total[_NOT_CARRIED] / total[_SUM_RATE][:, [perfect]],
        ]
    bounded = np.stack([with_interval(figure) for figure in figures], axis=1)
    missing = sums[:, 0, _MISSING].mean()
    return [(*case, name, *bounded[j].ravel().tolist(), float(missing)) for j, name in enumerate(strategies)]


def _findings(table: Table) -> dict[str, Any]:
    """The best repairer of each figure by case, and its share of perfect knowledge."""
    found: dict[str, Any] = {}
    for channel in table.values("channel"):
        for loss in table.where(channel=channel).values("loss"):
            case = table.where(channel=channel, loss=loss)
            own = [str(name) for name in case.values("method") if name not in (PERFECT, AVOID, ORACLE)]
            for name in OBJECTIVES if own else ():
                shares = {one: float(case.where(method=one).numbers(f"{name}_share")[0]) for one in own}
                best = max(own, key=lambda one: shares[one])
                share = None if np.isnan(shares[best]) else shares[best]
                found.setdefault(f"{channel}, {loss}", {})[name] = {"best": best, "share_of_perfect": share}
    return found
