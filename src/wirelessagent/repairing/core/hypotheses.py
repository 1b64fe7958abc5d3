"""What the gain's correlation over frequency may be: a dictionary of power-delay profiles, weighed by evidence.

A scattered channel with power-delay profile P(t) has the complex correlation ρ(Δf) = ∫ P(t) e^(−j2πΔft) dt, and its
power gain |h|² the correlation |ρ|². Three kinds of profile span what is met, with x = 2πΔfτ and τ the rms delay
spread:

- exponential, |ρ|² = 1/(1 + x²): the usual model, rough over frequency since it starts with a step;
- a gamma profile of order 4, |ρ|² = 1/(1 + x²/4)⁴: power that rises and falls, smooth over frequency;
- two exponentials, |ρ|² = |w/(1 + jxs) + (1 − w)/(1 + jxs′)|²: near scatterers with most of the power and far ones,
  which leave a correlation over distances where the others have none.

Delay spreads lie on a grid from what bends the whole band by a hair to what makes neighbouring subcarriers independent.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.observation import ChannelObservation

DELAYS = 20
"""Delay spreads on the grid."""
FLATTEST, ROUGHEST = 0.03 / (2.0 * np.pi), 0.9
"""The smallest delay spread times the band, and the largest times the smallest spacing."""
ORDER = 4.0
"""Order of the gamma profile."""
NEAR_POWER, NEAR_SPREAD = 0.8, 0.3
"""Share w of the power that comes from near, and s, its mean delay in units of τ."""
UNKNOWN_NOISE = (1e-8, 2e-4, 2e-3, 2e-2, 2e-1)
"""Variances of the measurement error, in units of the level squared, where the observation does not say."""
LONGEST_RASTER = 1 << 14
"""Steps of the raster of frequencies."""
NOMINAL_DELAY_SPREAD_S = 100e-9
"""Rms delay spread expected before anything is seen: the nominal one of 3GPP TR 38.901, table 7.7.3-1."""
NOMINAL_FACTOR = 10.0
"""Standard deviation of what is expected, as a factor."""
NOMINAL_SPACING_HZ = 180e3
"""Subcarrier spacing where no frequencies are known: a resource block of twelve times 15 kHz."""


@dataclass(frozen=True, kw_only=True)
class Hypotheses:
    """Correlations of the gain over frequency, ``families`` × ``DELAYS`` of them.

    Attributes:
        place: of each subcarrier on a raster of frequencies, shape (subcarrier,).
        table: |ρ|² at each distance on the raster, shape (distance, hypothesis).
        noise: variance of the measurement error in units of the level squared, shape (hypothesis,); NaN where it is
            the observation's to say.
        families: how many kinds there are; hypotheses of one kind follow each other.
        log_step: ln of the ratio of neighbouring delay spreads.
        log_prior: what is expected of the users' delay spread, ln of a density, shape (delay,).
    """

    place: IntArray
    table: FloatArray
    noise: FloatArray
    families: int
    log_step: float
    log_prior: FloatArray


def hypotheses(observation: ChannelObservation) -> Hypotheses:
    """Those for the frequencies of an observation, equidistant where they are unknown."""
    frequencies = observation.subcarrier_frequencies_hz
    known_noise = observation.noise_variance is not None
    if frequencies is None:
        indices = np.arange(observation.num_subcarriers, dtype=np.float64)
        return _at_frequencies((indices * NOMINAL_SPACING_HZ).tobytes(), known_noise)
    return _at_frequencies(frequencies.tobytes(), known_noise)


@functools.lru_cache(maxsize=8)
def _at_frequencies(frequencies: bytes, known_noise: bool) -> Hypotheses:
    frequencies_hz = np.frombuffer(frequencies)
    places = raster(frequencies_hz)
    width_hz = float(frequencies_hz[-1] - frequencies_hz[0])
    return _on_raster(places, width_hz / places[-1] if places[-1] else NOMINAL_SPACING_HZ, known_noise)


def raster(frequencies_hz: FloatArray) -> tuple[int, ...]:
    """The places of increasing frequencies on the coarsest raster that holds them.

    Without a common step, or with too many of them, the places are rounded to a sixteenth of the smallest spacing, or
    to what ``LONGEST_RASTER`` allows.

    >>> raster(np.array([1e6, 3e6, 4e6]))
    (0, 2, 3)
    """
    if frequencies_hz.size == 1:
        return (0,)
    distance = frequencies_hz - frequencies_hz[0]
    spacing = float(np.diff(distance).min())
    for parts in (1, 2, 3, 4, 16):
        step = spacing / parts
        places = distance / step
        if np.abs(places - np.rint(places)).max() < 1e-3:
            break
    step = max(step, float(distance[-1]) / LONGEST_RASTER)
    return tuple(int(place) for place in np.rint(distance / step))


def _on_raster(place: tuple[int, ...], step_hz: float, known_noise: bool) -> Hypotheses:
    places = np.array(place)
    width = int(places[-1])
    distance = np.arange(width + 1, dtype=np.float64)
    smallest = max(int(np.diff(places).min()), 1) if width else 1  # close ones may share a place
    delays = np.geomspace(FLATTEST / max(width, 1), ROUGHEST / smallest, DELAYS)
    x = 2.0 * np.pi * np.multiply.outer(distance, delays)
    kinds = [
        (correlation, noise)
        for noise in ((np.nan,) if known_noise else UNKNOWN_NOISE)
        for correlation in (1.0 / (1.0 + x**2), (1.0 + x**2 / ORDER) ** -ORDER, _near_and_far(x))
    ]
    return Hypotheses(
        place=places,
        table=np.ascontiguousarray(np.concatenate([table for table, _ in kinds], axis=1)),
        noise=np.repeat([noise for _, noise in kinds], DELAYS),
        families=len(kinds),
        log_step=float(np.log(delays[1] / delays[0])),
        log_prior=-0.5 * (np.log(delays / step_hz / NOMINAL_DELAY_SPREAD_S) / np.log(NOMINAL_FACTOR)) ** 2,
    )


def _near_and_far(x: FloatArray) -> FloatArray:
    """|ρ|² of two exponentials whose common rms delay spread is 1."""
    w, s = NEAR_POWER, NEAR_SPREAD
    a, b, c = 1.0 - w**2, w * s * (1.0 - w), w * s**2 * (2.0 - w) - 1.0
    far = (b + np.sqrt(b**2 - a * c)) / a  # of 2(ws² + (1 − w)s′²) − (ws + (1 − w)s′)² = 1
    return np.abs(w / (1.0 + 1j * x * s) + (1.0 - w) / (1.0 + 1j * x * far)) ** 2
