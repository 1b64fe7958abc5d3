"""The repaired channel: every entry filled, each with how sure we are of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, float_array, names, switches
from wirelessagent.model.errors import InputError
from wirelessagent.model.gain_views import Matrix, entries, level
from wirelessagent.model.observation import ChannelObservation, check_gain, check_variance
from wirelessagent.model.posterior import GammaPosterior, Posterior
from wirelessagent.model.shown import Picture, Shown, Summary, few
from wirelessagent.model.units import percent


@dataclass(frozen=True, kw_only=True, repr=False)
class ChannelEstimate(Shown):
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
        if gain.ndim != 2 or variance.shape != gain.shape:
            raise InputError(
                f"gain and gain_variance must share one (user, subcarrier) shape; got {gain.shape} and {variance.shape}"
            )
        check_gain(gain)
        if np.isnan(gain).any():
            raise InputError(f"an estimate must be complete; {np.isnan(gain).sum()} of {gain.size} gains are NaN")
        check_variance("gain_variance", variance, np.ones(gain.shape, dtype=bool))
        object.__setattr__(self, "gain", gain)
        object.__setattr__(self, "gain_variance", variance)
        object.__setattr__(self, "repaired", switches("repaired", self.repaired, gain.shape))
        unobserved = switches("unobserved_users", self.unobserved_users, gain.shape[:1])
        object.__setattr__(self, "unobserved_users", unobserved)
        object.__setattr__(self, "user_names", names("user_names", self.user_names, gain.shape[0]))

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

    def summary(self) -> Summary:
        count, size = int(self.repaired.sum()), self.repaired.size
        made = f"{count} of {size} gains repaired by {self.method}" if count else "nothing was missing"
        rows = [("mean gain", level(self.gain)), ("users", few(self.user_names))]
        spread = self._relative_std[self.repaired]
        if spread.size and not np.isnan(spread).all():
            rows.append(("how sure", f"± {percent(float(np.nanmedian(spread)))} of a repaired gain (median)"))
        if self.unobserved_users.any():
            unseen = (name for name, flag in zip(self.user_names, self.unobserved_users, strict=True) if flag)
            rows.append(("never observed", f"{few(unseen)}: a guess"))
        title = f"ChannelEstimate: {self.num_users} users × {self.num_subcarriers} subcarriers, {made}"
        return Summary(title=title, rows=tuple(rows))

    def picture(self) -> Picture:
        made = f"Repaired by {self.method}" if self.repaired.any() else "Nothing was missing"
        gain = Matrix(title=made, values=self.gain, marked=self.repaired)
        spread = Matrix(title="How sure", values=self._relative_std, colour_label="Standard deviation / gain")
        return Picture(kind="matrices", parts={"user_names": self.user_names, "matrices": (gain, spread)})

    def columns(self) -> Mapping[str, Any]:
        """One row for each entry."""
        names = ("gain", "gain_variance", "repaired")
        return {**entries(self.user_names, self.gain), **{name: getattr(self, name).ravel() for name in names}}

    @property
    def _relative_std(self) -> FloatArray:
        """The standard deviation of each gain over the gain, shape (user, subcarrier), NaN where that is zero."""
        none = np.full(self.gain.shape, np.nan)
        return np.divide(np.sqrt(self.gain_variance), self.gain, where=self.gain > 0, out=none)

    @property
    def num_users(self) -> int:
        return self.gain.shape[0]

    @property
    def num_subcarriers(self) -> int:
        return self.gain.shape[1]
