"""The rates that an allocation may promise on an uncertain channel: quantiles of what it carries, from joint draws.

A user's true rate is X = Σ r(p_n g_n) over the entries that it rests on. What may be promised is its ε-quantile. It is
exact where at most one of the entries is uncertain, since X then rises with that one gain. Else it is taken from joint
draws of the uncertain entries: of n independent draws the j-th smallest, j = ⌊ε (n + 1)⌋, is undershot by a further
one with the probability j/(n + 1) ≤ ε, whatever the distribution; draws that are spread evenly do it with a third of
the error or half of it, which at ε = 5 % is some 0.1–0.2 %. For outage probabilities so small that j would be 0, each
of m uncertain entries is taken at its own ε/m-quantile: that all are reached fails with ε at most.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.outage_channel import UncertainChannel
from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.metrics import kept
from wirelessagent.model.rates import normalised_gain

_FEWEST_DRAWS, _MOST_DRAWS = 4000, 200_000
_DRAWS_BELOW = 50
"""Draws wanted below the quantile."""
_TOGETHER = 16
"""Subcarriers whose SNRs are multiplied before a logarithm is taken; each is below 1e18 or so."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Held:
    """What one user owns: entries that are certain, and draws of those that are not.

    Attributes:
        user: the user.
        subcarriers: those owned, shape (entry,).
        levels: quantiles of the entries as SNR per watt at each q, shape (level, entry), in 1/W.
        uncertain: which of the entries are uncertain, as indices, shape (uncertain,).
        draws: joint draws of those as SNR per watt, shape (sample, uncertain); one row of what is sure to be
            undershot seldom enough where there is no need to draw.
        rank: which of the draws, from the smallest rate, says what may be promised, counted from 0.
        max_nats: the most that a subcarrier carries.
    """

    user: int
    subcarriers: IntArray
    levels: FloatArray
    uncertain: IntArray
    draws: FloatArray
    rank: int
    max_nats: float

    def promised_nats(self, power_w: FloatArray) -> float:
        """The rate that may be promised with ``power_w`` (entry,)."""
        fixed = self.certain_nats(power_w)
        if not self.uncertain.size:
            return fixed
        drawn = self.nats_drawn(power_w[self.uncertain])
        return fixed + float(drawn[0] if drawn.size == 1 else np.partition(drawn, self.rank)[self.rank])

    def certain_nats(self, power_w: FloatArray) -> float:
        """The rate of the entries that are certain."""
        sure = np.ones(self.subcarriers.size, dtype=bool)
        sure[self.uncertain] = False
        return float(np.minimum(np.log1p(power_w[sure] * self.levels[0, sure]), self.max_nats).sum())

    def place(self, power_w: FloatArray, nats: float) -> float:
        """The place of the q whose quantiles carry ``nats`` with ``power_w`` (entry,)."""
        carried: FloatArray = np.minimum(np.log1p(power_w * self.levels), self.max_nats).sum(axis=1)
        return float(np.interp(nats, carried, np.arange(carried.size)))

    def counted_on(self, place: float) -> FloatArray:
        """The SNR per watt of the entries where q has this place, shape (entry,)."""
        low = min(int(place), len(self.levels) - 2)
        return (1.0 - (place - low)) * self.levels[low] + (place - low) * self.levels[low + 1]

    def nats_drawn(self, power_w: FloatArray) -> FloatArray:
        """Rates of the uncertain entries in each draw, shape (sample,); products first, as a logarithm takes long."""
        most = math.exp(min(self.max_nats, 40.0))
        total = np.zeros(len(self.draws))
        for first in range(0, power_w.size, _TOGETHER):
            some = slice(first, first + _TOGETHER)
            total += np.log(np.minimum(1.0 + self.draws[:, some] * power_w[some], most).prod(axis=1))
        return total


@dataclass(frozen=True, kw_only=True, eq=False)
class Rates:
    """What may be promised on an uncertain channel, set by set; draws of a set are made once."""

    form: NormalForm
    channel: UncertainChannel
    seed: int = 0
    _held: dict[tuple[int, bytes], Held] = field(default_factory=dict[tuple[int, bytes], Held])

    def held(self, user: int, subcarriers: IntArray) -> Held:
        """What ``user`` has in ``subcarriers`` (entry,)."""
        key = user, subcarriers.tobytes()
        if key not in self._held:
            self._held[key] = self._made(user, subcarriers)
        return self._held[key]

    def owned(self, owner: IntArray) -> list[Held]:
        """What each user has that owns anything."""
        return [self.held(user, np.flatnonzero(owner == user)) for user in np.unique(owner[owner >= 0]).tolist()]

    def _made(self, user: int, subcarriers: IntArray) -> Held:
        channel = self.channel
        uncertain = np.flatnonzero(channel.uncertain[user, subcarriers])
        rank, draws = 0, channel.gain[:1, user, subcarriers[uncertain]]
        if uncertain.size == 1:
            draws = channel.gain[int(channel.careful), user, subcarriers[uncertain]][np.newaxis]
        elif uncertain.size:
            number = num_draws(channel.outage)
            rank = math.floor(channel.outage * (number + 1)) - 1
            posterior, places = channel.estimate.posterior, subcarriers[uncertain]
            if rank >= 0:
                draws = posterior.samples_of(user, places, number, seed=self.seed)
            else:
                rank, draws = 0, posterior.quantile(channel.outage / uncertain.size)[user, places][np.newaxis]
        cell = self.form.cell
        return Held(
            user=user,
            subcarriers=subcarriers,
            levels=normalised_gain(channel.of_entries(user, subcarriers), cell),
            uncertain=uncertain,
            draws=normalised_gain(draws, cell),
            rank=rank,
            max_nats=self.form.max_nats,
        )


def judge_afresh(
    rates: Rates, owner: IntArray, power_w: FloatArray, promised_bps: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Each user's mean rate in bit/s and the share of draws in which it misses its promise, both of shape (user,).

    The draws are others than those that the promises were made on, which flatter them.
    """
    form, channel = rates.form, rates.channel
    expected, missed = np.zeros(promised_bps.size), np.zeros(promised_bps.size)
    for held in rates.owned(np.where(power_w > 0, owner, -1)):
        user, own, uncertain = held.user, held.subcarriers, held.uncertain
        places, number = own[uncertain], num_draws(channel.outage)
        drawn = np.zeros(1)
        if uncertain.size:
            draws = channel.estimate.posterior.samples_of(user, places, number, seed=rates.seed + 1)
            afresh = dataclasses.replace(held, draws=normalised_gain(draws, form.cell))
            drawn = afresh.nats_drawn(power_w[places])
        rate = (held.certain_nats(power_w[own]) + drawn) * form.bps_per_nat
        expected[user] = rate.mean()
        missed[user] = np.mean(~kept(rate, promised_bps[user]))
    return expected, missed


def num_draws(outage: float) -> int:
    """So many that some lie below the quantile.

    >>> num_draws(0.05), num_draws(0.001)
    (4000, 50000)
    """
    return int(min(max(_FEWEST_DRAWS, math.ceil(_DRAWS_BELOW / outage)), _MOST_DRAWS))
