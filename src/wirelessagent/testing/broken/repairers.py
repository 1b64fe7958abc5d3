"""Repairers that :class:`RepairerContract` must reject."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.errors import InputError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.posterior import GammaPosterior
from wirelessagent.repairing.repairer import Repairer


@dataclass(frozen=True, kw_only=True)
class MeanFill(Repairer):
    """Every hole gets the mean of all, sound: the broken ones below differ from it in one thing each."""

    name = "mean_fill"
    caught_by = ""

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        del at_s
        level = _mean(observation.slots)
        shape = observation.current.shape
        return ChannelEstimate.completing(
            observation,
            gain=np.full(shape, level),
            gain_variance=np.full(shape, level**2),
            method=self.name,
        )


def _mean(gain: FloatArray) -> float:
    seen = gain[~np.isnan(gain)]
    return float(seen.mean()) if np.any(seen > 0) else 1e-12


class NotDecorated(MeanFill):
    """Its field never becomes an option, because the class is not a dataclass of its own."""

    caught_by = "test_is_a_frozen_dataclass"
    weight: float = 1.0


@dataclass(frozen=True, kw_only=True)
class BadlyNamed(MeanFill):
    """A name that no command line can take."""

    name = "Mean fill"
    caught_by = "test_has_a_name"


@dataclass(frozen=True, kw_only=True)
class WithoutSummary(MeanFill):
    caught_by = "test_has_a_summary"


@dataclass(frozen=True, kw_only=True)
class WithoutDefault(MeanFill):
    """Needs something that cannot be written on a command line."""

    caught_by = "test_can_be_made_from_its_options"
    weights: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class HoldsALambda(MeanFill):
    """Cannot travel to another process."""

    caught_by = "test_survives_pickling"
    distance: Callable[[float], float] = lambda away: away


@dataclass(frozen=True, kw_only=True)
class HoldsAList(MeanFill):
    """Cannot be a key."""

    caught_by = "test_is_a_value"
    weights: list[float] = field(default_factory=list[float])


@dataclass(frozen=True, kw_only=True)
class FillsFromTheLeftOnly(MeanFill):
    """Leaves a hole where nothing stands to the left."""

    caught_by = "test_completes_every_pattern"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        left = np.roll(observation.current, 1, axis=1)
        if np.isnan(left[observation.missing]).any():
            raise InputError("no neighbour to take the mean of")
        return MeanFill.repair(self, observation)


@dataclass(frozen=True, kw_only=True)
class KnowsNoHistory(MeanFill):
    """Expects a matrix."""

    caught_by = "test_completes_every_pattern"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        num_users, _ = observation.gain.shape
        assert num_users
        return MeanFill.repair(self, observation)


@dataclass(frozen=True, kw_only=True)
class AnswersWithHistory(MeanFill):
    """Completes all slots instead of the current one."""

    caught_by = "test_completes_every_pattern"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        estimate = MeanFill.repair(self, observation)
        if observation.num_slots == 1:
            return estimate
        rows = np.repeat(estimate.gain, observation.num_slots, axis=0)
        return dataclasses.replace(
            estimate, gain=rows, gain_variance=rows**2, repaired=np.zeros(rows.shape, dtype=bool)
        )


@dataclass(frozen=True, kw_only=True)
class ReturnsAMatrix(MeanFill):
    """Gains without an estimate around them."""

    caught_by = "test_completes_every_pattern"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        if observation.missing.all():
            return MeanFill.repair(self, observation)
        return cast("Any", np.nan_to_num(observation.current))


@dataclass(frozen=True, kw_only=True)
class SmoothsWhatWasObserved(MeanFill):
    """Rounding on the way through another unit: almost the observed gains."""

    caught_by = "test_observed_entries_are_bit_identical"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        estimate = MeanFill.repair(self, observation)
        return dataclasses.replace(estimate, gain=np.square(np.sqrt(estimate.gain)))


@dataclass(frozen=True, kw_only=True)
class ForgetsMeasurementNoise(MeanFill):
    """Takes what was measured for certain."""

    caught_by = "test_observed_entries_keep_their_measurement_noise"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        estimate = MeanFill.repair(self, observation)
        return dataclasses.replace(estimate, gain_variance=np.where(estimate.repaired, estimate.gain_variance, 0.0))


@dataclass(frozen=True, kw_only=True)
class MarksNothing(MeanFill):
    """Passes guesses off as observations."""

    caught_by = "test_repaired_entries_are_marked"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        estimate = MeanFill.repair(self, observation)
        return dataclasses.replace(estimate, repaired=np.zeros_like(estimate.repaired))


@dataclass(frozen=True, kw_only=True)
class IsCertain(MeanFill):
    """A guess without a doubt."""

    caught_by = "test_repaired_entries_are_uncertain"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        estimate = MeanFill.repair(self, observation)
        return dataclasses.replace(estimate, gain_variance=np.where(estimate.repaired, 0.0, estimate.gain_variance))


@dataclass(frozen=True, kw_only=True)
class TakesZeroForCertain(MeanFill):
    """A spread in proportion to the user's mean: none where all that was reported lies below the detection floor."""

    caught_by = "test_repaired_entries_are_uncertain"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        estimate = MeanFill.repair(self, observation)
        seen = ~observation.missing
        dark = seen.any(axis=1) & (np.where(seen, observation.current, 0.0) == 0).all(axis=1)
        certain = estimate.repaired & dark[:, np.newaxis]
        return dataclasses.replace(estimate, gain_variance=np.where(certain, 0.0, estimate.gain_variance))


@dataclass(frozen=True, kw_only=True)
class FlagsByTheCurrentSlot(MeanFill):
    """Calls a user unobserved whose history is known."""

    caught_by = "test_users_never_observed_are_flagged"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        estimate = MeanFill.repair(self, observation)
        return dataclasses.replace(estimate, unobserved_users=np.asarray(observation.missing.all(axis=1)))


@dataclass(frozen=True, kw_only=True)
class RenamesUsers(MeanFill):
    """Numbers where the operator gave names."""

    caught_by = "test_names_are_kept"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        estimate = MeanFill.repair(self, observation)
        return dataclasses.replace(estimate, user_names=tuple(str(k) for k in range(estimate.num_users)))


class _UpsideDown(GammaPosterior):
    """Takes the probability of being above for that of being below."""

    def quantile(self, probability: float) -> FloatArray:
        return GammaPosterior.quantile(self, 1 - probability)


@dataclass(frozen=True, kw_only=True)
class PosteriorUpsideDown(MeanFill):
    """The gain that is exceeded with a probability, where the opposite is meant."""

    caught_by = "test_posterior_fits_the_estimate"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        estimate = MeanFill.repair(self, observation)
        return dataclasses.replace(estimate, joint_posterior=_UpsideDown(estimate.gain, estimate.gain_variance))


@dataclass(frozen=True, kw_only=True)
class InventsUsers(MeanFill):
    """Makes a level up where nothing was observed at all, and says nothing."""

    caught_by = "test_nothing_observed_is_refused_or_flagged"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        estimate = MeanFill.repair(self, observation)
        if np.isnan(observation.slots).all():
            return dataclasses.replace(estimate, unobserved_users=np.zeros(estimate.num_users, dtype=bool))
        return estimate


@dataclass(frozen=True, kw_only=True)
class WritesToTheObservation(MeanFill):
    """Fills the holes where they are."""

    caught_by = "test_leaves_the_observation_alone"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        estimate = MeanFill.repair(self, observation)
        if observation.num_slots > 1:  # the history, whose holes no figure of the estimate shows
            observation.gain.flags.writeable = True
            observation.slots[0][np.isnan(observation.slots[0])] = 0.0
        return estimate


_MEMORY: list[float] = []


@dataclass(frozen=True, kw_only=True)
class Remembers(MeanFill):
    """Every level that it ever met goes into the next estimate."""

    caught_by = "test_has_no_memory_and_does_not_draw"

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        estimate = MeanFill.repair(self, observation)
        _MEMORY.append(float(estimate.gain.mean()))
        gain = np.where(estimate.repaired, np.mean(_MEMORY), estimate.gain)
        return dataclasses.replace(estimate, gain=gain)


BROKEN: tuple[MeanFill, ...] = (
    NotDecorated(),
    BadlyNamed(),
    WithoutSummary(),
    WithoutDefault(weights=(1.0,)),
    HoldsALambda(),
    HoldsAList(),
    FillsFromTheLeftOnly(),
    KnowsNoHistory(),
    AnswersWithHistory(),
    ReturnsAMatrix(),
    SmoothsWhatWasObserved(),
    ForgetsMeasurementNoise(),
    MarksNothing(),
    IsCertain(),
    TakesZeroForCertain(),
    FlagsByTheCurrentSlot(),
    RenamesUsers(),
    PosteriorUpsideDown(),
    InventsUsers(),
    WritesToTheObservation(),
    Remembers(),
)
