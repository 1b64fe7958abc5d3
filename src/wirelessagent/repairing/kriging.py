"""Kriging: the best linear estimate of each gain, under correlations that the observation itself weighs."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.errors import InputError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.fading_posterior import FadingPosterior
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core import fit
from wirelessagent.repairing.core.error_correlation import ErrorRoots
from wirelessagent.repairing.core.hypotheses import hypotheses
from wirelessagent.repairing.core.levels import user_levels
from wirelessagent.repairing.repairer import Repairer

FEW = 8
"""Observed entries below which a user's level is in doubt."""


@dataclass(frozen=True, kw_only=True)
class Kriging(Repairer):
    """Best linear estimate of the gain over frequency, and over users where they are correlated.

    The gain is estimated itself, not its logarithm, which for Rayleigh fading is the best that can be done within
    noise. How far gains are correlated is not assumed but weighed: delay spreads of all sizes and three kinds of
    power-delay profile (:mod:`wirelessagent.repairing.core.hypotheses`) are compared by the likelihood of what was
    observed (:mod:`wirelessagent.repairing.core.evidence_kernel`), users are pooled
    (:mod:`wirelessagent.repairing.core.pooling_kernel`), and the likely ones averaged
    (:mod:`wirelessagent.repairing.core.kriging_kernel`). Measurement noise is the observation's, or weighed as well.
    Variances are those of partly known fading coefficients, multiplied by what the observed entries, each left out and
    estimated, say they should be; where weak entries get lost more often, that an entry is missing says that it is weak
    (:mod:`wirelessagent.repairing.core.weak_losses_kernel`). The posterior is
    :class:`wirelessagent.model.fading_posterior.FadingPosterior`.
    """

    name: ClassVar[str] = "kriging"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        slot = fit.relative(observation)
        learnt = fit.learn(slot, hypotheses(observation))
        found = fit.estimate(slot, learnt, tested=True)
        factor, surprise = fit.factors(slot, learnt, found)
        if slot.level.size > 1:
            fit.with_partners(slot, learnt, surprise, found)
        return completed(observation, slot, learnt, found, factor)

    def hold(self, observation: ChannelObservation) -> HeldKriging:
        """A repairer that holds what this slot says of delay spreads, noise and variances for later slots.

        It repairs several times faster. Take it anew when users have moved on; users and subcarriers must stay.
        """
        slot = fit.relative(observation)
        learnt = fit.learn(slot, hypotheses(observation))
        factor, _ = fit.factors(slot, learnt, fit.estimate(slot, learnt, tested=True))
        return HeldKriging(learnt=learnt, factor=factor)


@dataclass(frozen=True, kw_only=True)
class HeldKriging(Repairer):
    """Kriging with parameters held; see :meth:`Kriging.hold`."""

    name: ClassVar[str] = "kriging"
    learnt: fit.Learnt = field(repr=False)
    factor: FloatArray = field(repr=False)

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        wanted = len(self.factor), len(self.learnt.candidates.place)
        if observation.current.shape != wanted:
            raise InputError(
                f"parameters are held for {wanted[0]} users and {wanted[1]} subcarriers; got "
                f"{observation.num_users} and {observation.num_subcarriers}: take them anew by Kriging().hold()"
            )
        slot = fit.relative(observation)
        found = fit.estimate(slot, self.learnt, tested=False)
        return completed(observation, slot, self.learnt, found, self.factor)


def completed(
    observation: ChannelObservation, slot: fit.Relative, learnt: fit.Learnt, found: FloatArray, factor: FloatArray
) -> ChannelEstimate:
    """The estimate for what :func:`.fit.estimate` found, with its posterior; users unseen now get their level."""
    from wirelessagent.repairing.core import completing_kernel, weak_losses_kernel

    unseen = np.ones((slot.level.size, 3))
    if slot.seen.min() < FEW:
        levels = user_levels(observation)
        unseen = np.stack([levels.level, levels.variance, levels.doubt], axis=1)
    gain, variance, mean, mean_variance = (np.empty(slot.gain.shape) for _ in range(4))
    smoothed = np.empty(slot.gain.shape, dtype=np.bool_)
    completing_kernel.complete(
        observation.current, observation.current_noise_variance, slot.known, slot.level, found, factor,
        fit.unstated(slot, learnt), unseen, FEW, slot.seen, gain, variance, mean, mean_variance, smoothed,
    )  # fmt: skip
    missing = observation.missing
    weak_losses_kernel.allow_for_absence(mean, mean_variance, slot.level, missing)
    np.copyto(gain, mean, where=missing)
    np.copyto(variance, mean_variance, where=missing)
    measured = observation.measured
    return ChannelEstimate(
        gain=gain,
        gain_variance=variance,
        repaired=~measured[-1],
        unobserved_users=np.asarray(~measured.any(axis=(0, 2))),
        user_names=observation.user_names,
        method="kriging",
        joint_posterior=FadingPosterior(mean, mean_variance, ErrorRoots(slot, learnt, smoothed)),
    )
