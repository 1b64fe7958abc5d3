"""What kriging learns from a slot, and what it makes of it: hypotheses weighed, gains estimated, variances tested."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, IntArray
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.core.hypotheses import Hypotheses


@dataclass(frozen=True, kw_only=True)
class Relative:
    """A slot in units of the users' levels; see :mod:`.relative_kernel`. ``states_noise``: the observation does."""

    gain: FloatArray
    known: BoolArray
    noise: FloatArray
    level: FloatArray
    noise_share: FloatArray
    seen: IntArray
    states_noise: bool


@dataclass(frozen=True, kw_only=True)
class Learnt:
    """Parameters of a slot, which may be held for the next.

    Attributes:
        candidates: the hypotheses.
        chance: how likely each is, shape (user, hypothesis).
        forms: what each says of the user's level, shape (user, 5, hypothesis).
    """

    candidates: Hypotheses
    chance: FloatArray
    forms: FloatArray


def relative(observation: ChannelObservation) -> Relative:
    """The current slot of an observation."""
    from wirelessagent.repairing.core import relative_kernel

    gain = observation.current
    users = observation.num_users
    unknown = observation.noise_variance is None
    result = Relative(
        gain=np.empty(gain.shape),
        known=np.empty(gain.shape, dtype=np.bool_),
        noise=np.empty(gain.shape),
        level=np.empty(users),
        noise_share=np.empty(users),
        seen=np.empty(users, dtype=np.int64),
        states_noise=not unknown,
    )
    noise = np.full(gain.shape, np.nan) if unknown else observation.current_noise_variance
    relative_kernel.relate(
        gain, noise, result.gain, result.known, result.noise, result.level, result.noise_share, result.seen
    )
    return result


def learn(slot: Relative, candidates: Hypotheses) -> Learnt:
    """The weights of the hypotheses."""
    from wirelessagent.repairing.core import evidence_kernel, pooling_kernel

    forms = np.empty((slot.level.size, 5, candidates.noise.size))
    log_likelihood = evidence_kernel.weigh_users(
        slot.gain, slot.known, candidates.place, candidates.table, candidates.noise, slot.noise_share, forms
    )
    chance = pooling_kernel.pooled_weights(
        log_likelihood, candidates.families, candidates.log_step, candidates.log_prior
    )
    return Learnt(candidates=candidates, chance=chance, forms=forms)


def given(slot: Relative, candidates: Hypotheses, table: FloatArray, noise_share: FloatArray) -> Learnt:
    """Parameters that are known: one correlation for each user, ``table`` (user, distance), and its η (user,)."""
    from wirelessagent.repairing.core import evidence_kernel

    users = slot.level.size
    own = dataclasses.replace(candidates, table=np.ascontiguousarray(table.T), noise=noise_share, families=1)
    forms = np.empty((users, 5, users))
    evidence_kernel.weigh_users(slot.gain, slot.known, own.place, own.table, own.noise, slot.noise_share, forms)
    return Learnt(candidates=own, chance=np.eye(users), forms=forms)


def estimate(slot: Relative, learnt: Learnt, *, tested: bool) -> FloatArray:
    """Mean, variance from fading and other variance of the missing entries, shape (user, subcarrier, 3).

    If ``tested``, of observed ones as well, from the others (on long bands of a part of them); 0 elsewhere.
    """
    from wirelessagent.repairing.core import kriging_kernel

    candidates = learnt.candidates
    found = np.zeros((*slot.gain.shape, 3))
    kriging_kernel.krige(
        slot.gain, slot.known, slot.noise, candidates.place, candidates.table, candidates.noise, slot.noise_share,
        learnt.forms, learnt.chance, tested, found,
    )  # fmt: skip
    return found


def unstated(slot: Relative, learnt: Learnt) -> FloatArray:
    """Variance in units of the level squared that an entry has to itself and that nobody says is noise, shape (user,).

    What is not said to be measurement noise counts as the gain's own: the estimate is of what would be measured.
    """
    if slot.states_noise:
        return np.zeros(slot.level.size)
    return np.asarray((learnt.chance * learnt.candidates.noise).sum(axis=1))


def factors(slot: Relative, learnt: Learnt, found: FloatArray) -> tuple[FloatArray, FloatArray]:
    """By what the variances from fading are multiplied for each user, shape (user,), and the surprises that say so.

    Surprises are errors in standard deviations, shape (user, subcarrier), 0 where nothing was tested.
    """
    from wirelessagent.repairing.core import completing_kernel

    factor, surprise = np.empty(slot.level.shape), np.empty(slot.gain.shape)
    completing_kernel.test_variances(slot.gain, slot.known, slot.noise, unstated(slot, learnt), found, factor, surprise)
    return factor, surprise


def mean_hypothesis(slot: Relative, learnt: Learnt) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Each user's correlation at each distance (user, distance), η and level (user,), averaged over the hypotheses."""
    candidates = learnt.candidates
    noise = np.where(np.isnan(candidates.noise), slot.noise_share[:, np.newaxis], candidates.noise)
    return (
        np.ascontiguousarray(learnt.chance @ candidates.table.T),
        (learnt.chance * noise).sum(axis=1),
        (learnt.chance * learnt.forms[:, 4]).sum(axis=1),
    )


def with_partners(slot: Relative, learnt: Learnt, surprise: FloatArray, found: FloatArray) -> None:
    """Overwrite the estimates of users whose surprises prove a correlation with others'."""
    from wirelessagent.repairing.core import partners_kernel, users

    correlation = users.correlation_beyond_chance(surprise, surprise != 0.0)
    if not correlation.any():
        return
    table, noise, level = mean_hypothesis(slot, learnt)
    shared = (learnt.chance / (1.0 + learnt.forms[:, 0])).sum(axis=1)
    offset = (learnt.chance * learnt.forms[:, 1] / (1.0 + learnt.forms[:, 0])).sum(axis=1)
    partners_kernel.krige_with_partners(
        slot.gain, slot.known, slot.seen, slot.noise, learnt.candidates.place, table, noise, level, offset, shared,
        correlation, found,
    )  # fmt: skip
