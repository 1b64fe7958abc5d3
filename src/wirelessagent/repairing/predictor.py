"""The predictor: gains of a slot from the whole history, when the current one has holes, is late or is missing."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.fading_posterior import FadingPosterior
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core import bins, fit, learned
from wirelessagent.repairing.core.doppler import Doppler, doppler
from wirelessagent.repairing.core.error_correlation import ErrorRoots
from wirelessagent.repairing.core.history import History, OverFrequency, history, over_frequency
from wirelessagent.repairing.core.levels import SMALLEST_VARIANCE, user_levels
from wirelessagent.repairing.kriging import FEW, Kriging
from wirelessagent.repairing.learned_covariance import LearnedCovariance
from wirelessagent.repairing.repairer import Repairer

KEPT, ENOUGH = 6, 0.97
"""Most Doppler hypotheses kept for a user, and the probability at which they are enough."""
TAIL = 1.2
"""By how much variances from fading exceed the likeliest ones, as in kriging for a dozen entries that say something."""


@dataclass(frozen=True, kw_only=True)
class Predictor(Repairer):
    """Best linear estimate of the gain over frequency and time, for a slot with holes, a late or a missing one.

    The correlation over frequency is weighed as in kriging, that over time by how Doppler shifts of all sizes explain
    the last slots (:mod:`wirelessagent.repairing.core.doppler`). Shifts are averaged over by their probability: where
    the channel moves too fast to be followed, the estimate is the user's mean. With one slot alone it is kriging; where
    each slot is a new channel, :class:`wirelessagent.repairing.learned_covariance.LearnedCovariance` of the current.
    ``at_s`` asks for another time than the last slot's.
    """

    name: ClassVar[str] = "predictor"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        seen = history(observation)
        if seen is None or (observation.num_slots == 1 and at_s is None):
            return dataclasses.replace(Kriging().repair(observation), method=self.name)
        if at_s is None and is_new(seen, observation):
            return dataclasses.replace(LearnedCovariance().repair(observation), method=self.name)
        over = over_frequency(seen, observation)
        over = learned.refined(over, seen) if learned.is_new_each_slot(over) else over
        found = estimated(seen, over, doppler(observation), steps(observation, at_s))
        level = seen.level[:, np.newaxis]
        slot, learnt = fit.relative(observation), known_parameters(over)
        own = fit.unstated(slot, learnt)[:, np.newaxis]
        gain, variance = level * found[..., 0], level * (level * (TAIL * found[..., 1] + found[..., 2] + own))
        unseen = seen.seen == 0
        if unseen.any():
            levels = user_levels(observation)
            gain[unseen], variance[unseen] = levels.level[unseen, np.newaxis], levels.variance[unseen, np.newaxis]
        variance = np.maximum(variance, SMALLEST_VARIANCE)
        if at_s is None:
            missing = observation.missing
            gain = np.where(missing, gain, observation.current)
            variance = np.where(missing, variance, observation.current_noise_variance)
        return ChannelEstimate(
            gain=gain,
            gain_variance=variance,
            repaired=np.ones(gain.shape, dtype=bool) if at_s is not None else ~observation.measured[-1],
            unobserved_users=np.asarray(~observation.measured.any(axis=(0, 2))),
            user_names=observation.user_names,
            method=self.name,
            joint_posterior=FadingPosterior(gain, variance, errors(slot, learnt, late=at_s is not None)),
        )


def is_new(seen: History, observation: ChannelObservation) -> bool:
    """Whether the current slot was observed of all users and has nothing to do with the one before."""
    last = observation.num_slots - 1
    if seen.place.size < 2 or seen.place[-1] != last or not (~np.isnan(seen.gain[-1])).sum(axis=1).min() > FEW:
        return False
    both = ~np.isnan(seen.gain[-2:]).any(axis=0)
    now, before = np.where(both, seen.gain[-2:] - 1.0, 0.0)
    return float((now * before).sum()) <= learned.NEW * float(np.sqrt((now**2).sum() * (before**2).sum()))


def steps(observation: ChannelObservation, at_s: float | None) -> float:
    """The time asked for, in steps after the last slot; where slots have no times they are a second apart."""
    if at_s is None:
        return 0.0
    times = observation.slot_times_s
    if times is None or times.size == 1:
        return at_s - (observation.num_slots - 1.0 if times is None else float(times[-1]))
    return (at_s - float(times[-1])) / float(np.diff(times).min())


def known_parameters(over: OverFrequency) -> fit.Learnt:
    """What the last slots say of the correlation over frequency and the noise, as one hypothesis for each user."""
    users = over.noise_share.size
    own = dataclasses.replace(over.candidates, table=over.table.T, noise=over.noise_share, families=1)
    return fit.Learnt(candidates=own, chance=np.eye(users), forms=np.zeros((users, 5, users)))


def errors(slot: fit.Relative, learnt: fit.Learnt, *, late: bool) -> ErrorRoots:
    """How the errors hang together over frequency: as gains do that the current slot leaves open, if it is that one.

    With the same history for all subcarriers this is exact, since the covariance is a product over time and frequency.
    """
    known = slot.known & (not late)
    return ErrorRoots(dataclasses.replace(slot, known=known), learnt, np.zeros_like(known))


def estimated(seen: History, over: OverFrequency, candidates: Doppler, at: float) -> FloatArray:
    """Mean, variance from fading and other variance of all gains ``at`` a time, shape (user, subcarrier, 3).

    Each user's from its own reports, whenever they came; of users without any nothing is said.
    """
    from wirelessagent.repairing.core import space_time_kernel

    now = dataclasses.replace(candidates, time=candidates.time[seen.place])
    chance, level = weighed(over, now)
    _, users, subcarriers = seen.gain.shape
    found = np.zeros((users, subcarriers, 3))
    for k, reported in enumerate(seen.reported):
        if not reported.any():
            continue
        order = np.argsort(-chance[k])
        kept = order[: min(KEPT, 1 + int(np.searchsorted(np.cumsum(chance[k][order]), ENOUGH)))]
        own = bins.binned(seen.gain[reported, k], seen.noise[reported, k], now.time[reported], now, kept, at)
        space_time_kernel.estimate_user(
            own.mean, own.noise, own.count, own.reports, over.candidates.place, over.table[k],
            float(over.noise_share[k]), float(seen.grown[k]), own.between, own.towards, level[k, kept],
            chance[k, kept] / chance[k, kept].sum(), found[k],
        )  # fmt: skip
    return found


def weighed(over: OverFrequency, now: Doppler) -> tuple[FloatArray, FloatArray]:
    """How likely each Doppler hypothesis is for each user, and the level it says, shape (user, hypothesis).

    What a user reported is evidence, nothing else; users who reported in the same slots are worked out together.
    """
    from wirelessagent.repairing.core import evidence_kernel, pooling_kernel

    users, slots, _ = over.filled.shape
    time, place = now.time[-slots:], over.candidates.place[: bins.BLOCK]
    alike = over.table[:, np.abs(place[:, np.newaxis] - place)]
    likelihood, level = np.zeros((users, now.shift.size)), np.ones((users, now.shift.size))
    patterns, pattern_of = np.unique(over.told, axis=0, return_inverse=True)
    for p, told in enumerate(patterns):
        if told.any():
            who = np.flatnonzero(pattern_of == p)
            filled = over.filled[np.ix_(who, told)][..., : bins.BLOCK]
            between = np.moveaxis(now.correlation(np.abs(time[told][:, np.newaxis] - time[told])), -1, 0)
            likelihood[who], level[who] = bins.log_evidence(filled, over.noise_share[who], alike[who], between)
    chance = pooling_kernel.pooled_weights(
        evidence_kernel.SHARE * likelihood, now.families, now.log_step, now.log_prior
    )
    return chance, level
