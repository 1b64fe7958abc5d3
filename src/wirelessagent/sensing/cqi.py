"""What a real cell is told: a 4-bit channel quality indicator (CQI) per sub-band, not a gain per subcarrier.

A user reports the highest index of TS 38.214, table 5.2.2.1-2 whose spectral efficiency it could receive in a sub-band,
here by log2(1 + SNR/Γ) on average over the sub-band, with reference signals of a known power on every subcarrier. So an
index stands for an interval of gains. Within it a gain is expected log-uniform:

    E[g] = (b − a)/ln(b/a),    Var[g] = (b² − a²)/(2 ln(b/a)) − E[g]²,

and below the first threshold b uniform, b/2 and b²/12. Above the last threshold it may be ``HEADROOM`` times as large.
The report is taken for the gain in the sub-band's middle; all other subcarriers are missing, for a repairer to fill.

Departures: one layer, no interference, no ageing of the report, an SNR gap instead of a block error rate of 10 %.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray, positive, whole
from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.scene import Scene
from wirelessagent.model.units import from_db, human
from wirelessagent.sensing.rayleigh import Rayleigh

EFFICIENCY = np.array(
    [
        0.1523, 0.2344, 0.3770, 0.6016, 0.8770, 1.1758, 1.4766, 1.9141,
        2.4063, 2.7305, 3.3223, 3.9023, 4.5234, 5.1152, 5.5547,
    ]
)  # fmt: skip
"""Spectral efficiency in bit/s/Hz of indices 1 to 15; TS 38.214, table 5.2.2.1-2. Index 0 is out of range."""
HEADROOM = 10.0
"""A user at the last index may have a gain as many times above its threshold. Where many are, lower the power of the
reference signals: such reports say little, and what is made of them errs on the low side."""


@dataclass(frozen=True, kw_only=True)
class Cqi(Rayleigh):
    """The simulated cell of ``rayleigh``, sensed by 4-bit sub-band reports (TS 38.214, table 5.2.2.1-2).

    Attributes:
        subband_size: subcarriers of a sub-band; TS 38.214, table 5.2.1.4-2 has 4 to 32 resource blocks.
        reference_power_w: power of the reference signals on each subcarrier; the cell's budget, evenly spread, if not
            set.
        report_gap_db: SNR gap Γ of the modulation and coding that the reports assume.
    """

    name = "cqi"

    subband_size: int = 4
    reference_power_w: float | None = None
    report_gap_db: float = 3.0

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "subband_size", whole("subband_size", self.subband_size))
        if self.reference_power_w is not None:
            object.__setattr__(self, "reference_power_w", positive("reference_power_w", self.reference_power_w))
        object.__setattr__(self, "report_gap_db", positive("report_gap_db", self.report_gap_db, zero=True))

    def observe(self, cell: Cell, *, seed: int = 0) -> Scene:
        scene = super().observe(cell, seed=seed)
        assert scene.truth is not None
        power_w = self.reference_power_w or cell.max_power_w / self.num_subcarriers
        index = reports(scene.sensed.gain, self._snr_per_gain(cell, power_w), self.subband_size)
        told = as_gains(index, self._snr_per_gain(cell, power_w), self.subband_size, self.num_subcarriers)
        sensed = dataclasses.replace(scene.sensed, gain=told[0], noise_variance=told[1])
        bounds = f"{np.mean(index == 0):.0%} below the first index, {np.mean(index == EFFICIENCY.size):.0%} at the last"
        facts = dict(scene.facts) | {
            "reports": f"CQI of {index.shape[-1]} sub-bands of {self.subband_size} subcarriers, {bounds}; reference "
            f"signals of {human(power_w, 'W')} each"
        }
        return dataclasses.replace(scene, sensed=sensed, facts=facts)

    def _snr_per_gain(self, cell: Cell, power_w: float) -> float:
        return power_w / cell.noise_power_w / float(from_db(self.report_gap_db))


def reports(gain: FloatArray, snr_per_gain: float, subband_size: int) -> IntArray:
    """The CQI of each sub-band, shape (…, sub-band), for gains (…, subcarrier); ``snr_per_gain`` includes the gap."""
    starts = _starts(gain.shape[-1], subband_size)
    sizes = np.diff(np.append(starts, gain.shape[-1]))
    efficiency: FloatArray = np.add.reduceat(np.log2(1.0 + snr_per_gain * gain), starts, axis=-1) / sizes
    return np.searchsorted(EFFICIENCY, efficiency, side="right")


def as_gains(
    cqi: IntArray, snr_per_gain: float, subband_size: int, num_subcarriers: int
) -> tuple[FloatArray, FloatArray]:
    """Gains and variances, shape (…, subcarrier), that reports (…, sub-band) stand for; NaN but in the middles.

    Raises:
        InputError: a report that is no CQI, or another number of them than there are sub-bands.
    """
    starts = _starts(num_subcarriers, subband_size)
    if cqi.shape[-1] != starts.size:
        raise InputError(
            f"{num_subcarriers} subcarriers are {starts.size} sub-bands of {subband_size}; got {cqi.shape[-1]} reports"
        )
    if cqi.size and (cqi.min() < 0 or cqi.max() > EFFICIENCY.size):
        wrong = cqi[(cqi < 0) | (cqi > EFFICIENCY.size)][0]
        raise InputError(f"a CQI is between 0 and {EFFICIENCY.size}; got {wrong}")
    threshold = (2.0**EFFICIENCY - 1.0) / snr_per_gain
    low, high = threshold, np.append(threshold[1:], HEADROOM * threshold[-1])
    ratio = np.log(high / low)
    mean = np.append(threshold[0] / 2.0, (high - low) / ratio)
    square = np.append(threshold[0] ** 2 / 3.0, (high**2 - low**2) / (2.0 * ratio))
    middle = np.minimum(starts + subband_size // 2, num_subcarriers - 1)
    gain = np.full((*cqi.shape[:-1], num_subcarriers), np.nan)
    variance = gain.copy()
    gain[..., middle] = mean[cqi]
    variance[..., middle] = (square - mean**2)[cqi]
    return gain, variance


def observation_of_reports(
    cqi: IntArray,
    cell: Cell,
    *,
    subband_size: int,
    num_subcarriers: int,
    reference_power_w: float,
    report_gap_db: float,
) -> ChannelObservation:
    """What a base station knows that got these reports, shape (user, sub-band) or (slot, user, sub-band)."""
    snr_per_gain = reference_power_w / cell.noise_power_w / float(from_db(report_gap_db))
    gain, variance = as_gains(np.asarray(cqi), snr_per_gain, subband_size, num_subcarriers)
    return ChannelObservation(gain=gain, noise_variance=variance)


def _starts(num_subcarriers: int, subband_size: int) -> IntArray:
    """The first subcarrier of each sub-band."""
    return subband_size * np.arange(-(-num_subcarriers // subband_size), dtype=np.int64)
