"""The repaired channel: every entry filled, each with how sure we are of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, float_array, frozen
from wirelessagent.model.errors import InputError
from wirelessagent.model.observation import ChannelObservation, check_gain
from wirelessagent.model.posterior import GammaPosterior, Posterior


@dataclass(frozen=True, kw_only=True)
class ChannelEstimate:
    """A complete power-gain matrix for the current slot.

    Attributes:
        gain: estimated linear power gain, shape (user, subcarrier); observed entries are bit-identical to the
            observation.
        gain_variance: variance of the true gain around ``gain``; of observed entries, their measurement noise.
        repaired: True where the entry was not measured: it was missing, or the estimate of an earlier repair.
        unobserved_users: True for users with no measurement at all, whose level is a guess, shape (user,).
        user_names: one name per user.
        method: name of the repairer; "none" where nothing was missing, "earlier repair" where it was filled before.
        joint_posterior: the joint distribution of the true gains where the repairer knows it.
        kernels: whether machine code ran alone or some kernels were interpreted; "" where a repairer was asked by
            itself. The last bits of figures depend on it.
    """

    gain: FloatArray
    gain_variance: FloatArray
    repaired: BoolArray
    unobserved_users: BoolArray
    user_names: tuple[str, ...]
    method: str
    joint_posterior: Posterior | None = field(default=None, repr=False)
    kernels: Literal["", "compiled", "interpreted"] = field(default="", compare=False)

    def __post_init__(self) -> None:
        gain = float_array("gain", self.gain)
        variance = float_array("gain_variance", self.gain_variance)
        if gain.ndim != 2 or variance.shape != gain.shape or self.repaired.shape != gain.shape:
            raise InputError(
                "gain, gain_variance and repaired must share one (user, subcarrier) shape; "
                f"got {gain.shape}, {variance.shape} and {self.repaired.shape}"
            )
        check_gain(gain)
        if np.isnan(gain).any() or not np.all(variance >= 0):
            raise InputError("an estimate must be complete, with variances of zero or more")
        object.__setattr__(self, "gain", gain)
        object.__setattr__(self, "gain_variance", variance)
        object.__setattr__(self, "repaired", frozen(self.repaired))
        object.__setattr__(self, "unobserved_users", frozen(self.unobserved_users))

    @classmethod
    def completing(
        cls,
        observation: ChannelObservation,
        *,
        gain: FloatArray,
        gain_variance: FloatArray,
        method: str,
        joint_posterior: Posterior | None = None,
    ) -> ChannelEstimate:
        """The observation's current slot with its holes filled from ``gain``, shape (user, subcarrier).

        Observed entries are taken from the observation, whatever ``gain`` says of them; so are those that an earlier
        repair has estimated, which count as repaired.
        """
        missing, measured = observation.missing, observation.measured
        return cls(
            gain=np.where(missing, gain, observation.current),
            gain_variance=np.where(missing, gain_variance, observation.current_noise_variance),
            repaired=~measured[-1],
            unobserved_users=np.asarray(~measured.any(axis=(0, 2))),
            user_names=observation.user_names,
            method=method,
            joint_posterior=joint_posterior,
        )

    def computed(self, kernels: Literal["compiled", "interpreted"]) -> ChannelEstimate:
        """The same estimate, which tells how it was computed."""
        found = object.__new__(type(self))
        found.__dict__.update(self.__dict__, kernels=kernels)
        return found

    @property
    def posterior(self) -> Posterior:
        """The distribution of the true gains: the joint one, or independent gamma entries where none is known."""
        return self.joint_posterior or GammaPosterior(self.gain, self.gain_variance)

    @property
    def num_users(self) -> int:
        return self.gain.shape[0]

    @property
    def num_subcarriers(self) -> int:
        return self.gain.shape[1]
