"""Learned covariance: kriging with a correlation over frequency that earlier slots have shown."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import ClassVar

from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core import fit, learned
from wirelessagent.repairing.core.history import history, over_frequency
from wirelessagent.repairing.kriging import Kriging, completed
from wirelessagent.repairing.repairer import Repairer

SLOTS = 64
"""Reports of each user looked at, the last ones."""


@dataclass(frozen=True, kw_only=True)
class LearnedCovariance(Repairer):
    """Kriging of the current slot with the correlation over frequency that earlier slots have shown.

    Takes over where the power-delay profile is of none of the kinds that kriging knows: discrete paths, rays, a
    measured channel. Slots must be new channels (fast users, or slots far apart), else there is nothing to learn from
    and this is kriging. What is learned is blended with kriging's model by the likelihood of slots held out.
    """

    name: ClassVar[str] = "learned_covariance"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        seen = history(observation)
        now = fit.relative(observation)
        if seen is None or observation.num_slots == 1 or not now.seen.any():
            return dataclasses.replace(Kriging().repair(observation), method=self.name)
        over = over_frequency(seen, observation, most=SLOTS)
        better = learned.refined(over, seen)
        if better is over:
            return dataclasses.replace(Kriging().repair(observation), method=self.name)
        learnt = fit.given(now, better.candidates, better.table, better.noise_share)
        found = fit.estimate(now, learnt, tested=True)
        factor, surprise = fit.factors(now, learnt, found)
        if now.level.size > 1:
            fit.with_partners(now, learnt, surprise, found)
        return dataclasses.replace(completed(observation, now, learnt, found, factor), method=self.name)
