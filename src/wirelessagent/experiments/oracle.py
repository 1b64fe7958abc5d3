"""The oracle: linear estimation by somebody who knows the true mean, covariance and noise of a simulated channel.

For gains g with means m, covariance C and measurements y = g + e the best linear estimate of the current slot is
m + C_gy C_yy^-1 (y − m). Of Rayleigh fading with the correlation ρ of the coefficients, gains relative to their means
are correlated by |ρ|², here

    |ρ|² = ρ_u² · J0(2π f_d Δt)² / (1 + (2πΔfτ)²)

for the users' correlation ρ_u (1 for a user with itself), the largest Doppler shift f_d and the rms delay spread τ; see
:mod:`wirelessagent.sensing.fading`. A receiver that sees each coefficient at the signal-to-noise ratio γ reports the
conditional mean of the gain (:func:`wirelessagent.sensing.rayleigh.measured`), which has the variance s² with
s = γ/(1 + γ), and whose covariances are s² |ρ|² with a true gain and s⁴ |ρ|² with another report.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.fading_posterior import FadingPosterior
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.repairer import Repairer

_JITTER = 1e-12
"""Added to the variances, so that exact measurements of a flat channel can be solved for."""
_SMALLEST = 1e-9
"""Least variance and gain relative to the mean; the linear estimate may fall below zero, which no gain does."""


@dataclass(frozen=True, kw_only=True)
class Oracle(Repairer):
    """Best linear estimate of the gain under its true mean, covariance and noise.

    Attributes:
        mean_gain: ensemble mean of each user's gain, shape (user,).
        rms_delay_spread_s: each user's, shape (user,).
        snr: of the measured coefficients; infinite for exact measurements.
        doppler_hz: largest Doppler shift.
        user_correlation: of any two users' coefficients.
    """

    name = "oracle"

    mean_gain: FloatArray = field(repr=False)
    rms_delay_spread_s: FloatArray = field(repr=False)
    snr: float = np.inf
    doppler_hz: float = 0.0
    user_correlation: float = 0.0

    def repair(self, observation: ChannelObservation, *, at_s: float | None = None) -> ChannelEstimate:
        frequency = observation.subcarrier_frequencies_hz
        assert frequency is not None
        times = np.zeros(1) if observation.slot_times_s is None else observation.slot_times_s
        relative = observation.slots / self.mean_gain[:, np.newaxis]
        users = np.arange(observation.num_users)
        together = [users] if self.user_correlation > 0 else np.split(users, users.size)
        gain, variance = np.empty(observation.current.shape), np.empty(observation.current.shape)
        for group in together:
            correlation = self._correlation(group, frequency, times)
            gain[group], variance[group] = _estimated(relative[:, group], correlation, 1.0 / (1.0 + 1.0 / self.snr))
        gain = self.mean_gain[:, np.newaxis] * np.maximum(gain, _SMALLEST)
        variance = np.square(self.mean_gain)[:, np.newaxis] * np.maximum(variance, _SMALLEST**2)
        return ChannelEstimate.completing(
            observation,
            gain=gain,
            gain_variance=variance,
            method=self.name,
            joint_posterior=FadingPosterior(gain, variance),
        )

    def _correlation(self, users: IntArray, frequency: FloatArray, times: FloatArray) -> FloatArray:
        """|ρ|² of all entries of some users, shape (slot · user · subcarrier, same)."""
        from scipy.special import j0

        over_time = j0(2.0 * np.pi * self.doppler_hz * np.subtract.outer(times, times)) ** 2
        over_users = np.where(np.eye(users.size, dtype=bool), 1.0, self.user_correlation**2)
        spread = self.rms_delay_spread_s[users][0]  # users that are correlated have one delay spread
        over_frequency = 1.0 / (1.0 + np.square(2.0 * np.pi * spread * np.subtract.outer(frequency, frequency)))
        size = times.size * users.size * frequency.size
        return np.einsum("ab,cd,ef->acebdf", over_time, over_users, over_frequency).reshape(size, size)


def _estimated(relative: FloatArray, correlation: FloatArray, s: float) -> tuple[FloatArray, FloatArray]:
    """Estimate and error variance of the last slot, (user, subcarrier) each, from gains (slot, user, subcarrier).

    Of the entries that are observed too, as if their own report were one of many.
    """
    shape = relative.shape[1:]
    flat = relative.ravel()
    seen = np.flatnonzero(~np.isnan(flat))
    if not seen.size:
        return np.ones(shape), np.ones(shape)
    wanted = slice(flat.size - shape[0] * shape[1], None)
    reports = s**4 * correlation[np.ix_(seen, seen)]
    reports[np.diag_indices(seen.size)] = s**2 + _JITTER
    across = s**2 * correlation[wanted][:, seen]
    weights = np.linalg.solve(reports, across.T).T
    estimate = 1.0 + weights @ (flat[seen] - 1.0)
    error = 1.0 - np.sum(weights * across, axis=1)
    return estimate.reshape(shape), error.reshape(shape)
