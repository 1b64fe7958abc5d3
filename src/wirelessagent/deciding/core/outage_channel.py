"""An uncertain channel as channels that are known: what may be counted on, and what may be hoped for.

A user whose gains are uncertain is decided for as if each gain were its quantile at one probability q, the user's own:
q = ε is right for a user that rests on one uncertain entry, and too careful for one that rests on several, which hardly
fail together. What q is right is worked out from joint draws (:mod:`.outage_rates`), so that quantiles are wanted for
all q between: they are worked out at a few and interpolated.

For a bound there is the *hoped-for* channel. Let X = Σ r(p g) be a user's true rate and R what it is promised with
P(X < R) ≤ ε, so that the event A = {X ≥ R} has P(A) ≥ 1 − ε. As X ≥ R on A,

    R ≤ E[X | A] = Σ E[r(p g) | A] ≤ Σ E[r(p g) | g ≥ its ε-quantile] ≤ Σ r(p g⁺),   g⁺ = E[g | g ≥ its ε-quantile]:

no event of that probability gives a gain more than the event that it is high, and r is concave. So whatever may be
promised on the uncertain channel is carried, by the same allocation, on the known channel g⁺, however the gains hang
together; what cannot be done on g⁺ cannot be promised, and no promise is worth more than the optimum there.
"""

from __future__ import annotations

import dataclasses
import itertools
from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.estimate import ChannelEstimate

_LEVELS = 13
_BELOW = 4.0
"""The smallest q is ε over this: the sum of a few quantiles may fail a little more often than each."""
_HIGHEST = 0.6
"""The largest q, unless ε is larger: the average over many entries is worth about a median one each."""
_NODES = (1 / 64, 1 / 16, 1 / 4, 1 / 2, 3 / 4, 1.0)
"""In units of ε. A quantile rises with its probability, so that its values at the left ends sum to less than its
integral; what lies before the first node is left out."""


@dataclass(frozen=True, kw_only=True, eq=False)
class UncertainChannel:
    """Quantiles of an estimated channel.

    Attributes:
        estimate: the estimated channel.
        outage: ε.
        level: the probabilities q, rising, shape (level,).
        gain: the quantiles, shape (level, user, subcarrier); those of certain entries are the estimate's own gains.
        uncertain: True where the gain is not known for certain, shape (user, subcarrier).
    """

    estimate: ChannelEstimate
    outage: float
    level: FloatArray
    gain: FloatArray
    uncertain: BoolArray

    @classmethod
    def of(cls, estimate: ChannelEstimate, outage: float) -> UncertainChannel:
        """The quantiles of ``estimate`` for promises that fail with the probability ``outage`` at most."""
        from scipy.special import ndtr, ndtri

        highest = max(_HIGHEST, 1.0 - (1.0 - outage) / _BELOW)
        first, own, last = (float(ndtri(q)) for q in (outage / _BELOW, outage, highest))
        below = min(max(round((_LEVELS - 1) * (own - first) / (last - first)), 1), _LEVELS - 2)
        rising = np.linspace(first, own, below + 1), np.linspace(own, last, _LEVELS - below)[1:]
        level: FloatArray = ndtr(np.concatenate(rising))
        level[below] = outage
        uncertain = estimate.gain_variance > 0
        quantiles = np.stack([estimate.posterior.quantile(float(q)) for q in level])
        gain = np.where(uncertain, np.maximum.accumulate(np.maximum(quantiles, 0.0)), estimate.gain)
        return cls(estimate=estimate, outage=outage, level=level, gain=gain, uncertain=uncertain)

    @property
    def careful(self) -> float:
        """The place of q = ε among the levels."""
        return float(np.searchsorted(self.level, self.outage))

    def place_of(self, probability: float) -> float:
        """The place of a q among the levels; those between two levels are interpolated linearly."""
        return float(np.interp(probability, self.level, np.arange(self.level.size)))

    def at(self, place: FloatArray) -> ChannelEstimate:
        """The channel to count on where each user's q has the ``place`` (user,), as if it were certain."""
        low = np.clip(place.astype(np.int64), 0, self.level.size - 2)
        share = (place - low)[:, np.newaxis]
        users = np.arange(place.size)
        gain = (1.0 - share) * self.gain[low, users] + share * self.gain[low + 1, users]
        return self._known(np.where(self.uncertain, gain, self.estimate.gain))

    def of_entries(self, user: int, subcarriers: IntArray) -> FloatArray:
        """The quantiles of a few of a user's entries, shape (level, entry)."""
        return self.gain[:, user, subcarriers]

    def hoped_for(self) -> ChannelEstimate:
        """The channel g⁺, rounded up; see the module's docstring."""
        nodes = self.outage * np.array(_NODES)
        below = sum(
            (right - left) * self.estimate.posterior.quantile(float(left)) for left, right in itertools.pairwise(nodes)
        )
        mean = self.estimate.posterior.mean
        gain = (mean - np.maximum(below, 0.0)) / (1.0 - self.outage)
        return self._known(np.where(self.uncertain, np.maximum(gain, mean), self.estimate.gain))

    def _known(self, gain: FloatArray) -> ChannelEstimate:
        certain = np.zeros(gain.shape)
        return dataclasses.replace(self.estimate, gain=gain, gain_variance=certain, joint_posterior=None)
