"""The cell: its physics, its limits and its link.

The defaults are the paper's (section IV.A). The link fields are neutral by default, so that rates are Shannon's,
eq. (1); :meth:`Cell.nr` gives values like those of a 5G NR carrier.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.model.arrays import LARGEST, positive, within
from wirelessagent.model.errors import InputError
from wirelessagent.model.shown import Plain
from wirelessagent.model.units import from_db

_LARGEST_GAP_DB = 300.0
"""Far beyond any link, and still a ratio that can be multiplied."""
_LEAST_EFFICIENCY = 1e-6
"""Far below any amplifier, and what it draws is still a number."""


@dataclass(frozen=True, kw_only=True, repr=False)
class Cell(Plain):
    """A downlink OFDMA cell.

    Attributes:
        subcarrier_bandwidth_hz: bandwidth of one subcarrier (or resource block), B in eq. (1). The paper prints B
            as the total bandwidth; it is the total divided by N.
        noise_psd_w_per_hz: noise power spectral density N0.
        max_power_w: radiated power budget of the base station, P_max.
        circuit_power_w: power drawn whatever is radiated, P_c.
        snr_gap_db: distance Γ of the modulation and coding from Shannon's limit.
        max_spectral_efficiency_bps_per_hz: rate per hertz of the best modulation and coding; None for no limit.
        overhead: share of the resource elements that carries no data (control, reference signals), in [0, 1).
        amplifier_efficiency: radiated over drawn power, ξ in (0, 1]; enters energy efficiency only.
    """

    subcarrier_bandwidth_hz: float = 180e3
    noise_psd_w_per_hz: float = 1e-17
    max_power_w: float = 20.0
    circuit_power_w: float = 5.0
    snr_gap_db: float = 0.0
    max_spectral_efficiency_bps_per_hz: float | None = None
    overhead: float = 0.0
    amplifier_efficiency: float = 1.0

    def __post_init__(self) -> None:
        for name in ("subcarrier_bandwidth_hz", "noise_psd_w_per_hz", "max_power_w"):
            object.__setattr__(self, name, positive(name, getattr(self, name)))
        object.__setattr__(self, "circuit_power_w", positive("circuit_power_w", self.circuit_power_w, zero=True))
        object.__setattr__(self, "snr_gap_db", within("snr_gap_db", self.snr_gap_db, 0, _LARGEST_GAP_DB))
        if self.max_spectral_efficiency_bps_per_hz is not None:
            positive("max_spectral_efficiency_bps_per_hz", self.max_spectral_efficiency_bps_per_hz)
        object.__setattr__(self, "overhead", within("overhead", self.overhead, 0, 1, below=True))
        efficiency = within("amplifier_efficiency", self.amplifier_efficiency, _LEAST_EFFICIENCY, 1)
        object.__setattr__(self, "amplifier_efficiency", efficiency)
        if self.noise_power_w < 1 / LARGEST:
            raise InputError(
                f"noise_psd_w_per_hz = {self.noise_psd_w_per_hz!r} on subcarriers of {self.subcarrier_bandwidth_hz!r} "
                "Hz is no noise at all: give it in W/Hz (-174 dBm/Hz are 4e-21)"
            )

    @classmethod
    def nr(cls, *, max_power_w: float = 20.0, circuit_power_w: float = 5.0) -> Cell:
        """A carrier of 30 kHz subcarriers with a practical link.

        Resource blocks of 360 kHz (TS 38.211, 4.4.4.1), a highest spectral efficiency of 7.4063 bit/s/Hz
        (TS 38.214, table 5.1.3.1-2, MCS 27: 256QAM at rate 948/1024), 14 % overhead (TS 38.306, 4.1.2, FR1
        downlink), a 9 dB noise figure over −174 dBm/Hz, and a coding gap of 2 dB, which is our own choice.
        """
        return cls(
            subcarrier_bandwidth_hz=360e3,
            noise_psd_w_per_hz=float(from_db(-174.0 - 30.0 + 9.0)),
            max_power_w=max_power_w,
            circuit_power_w=circuit_power_w,
            snr_gap_db=2.0,
            max_spectral_efficiency_bps_per_hz=7.4063,
            overhead=0.14,
            amplifier_efficiency=0.3,
        )

    @property
    def noise_power_w(self) -> float:
        """Noise power in one subcarrier, N0·B, in W."""
        return self.noise_psd_w_per_hz * self.subcarrier_bandwidth_hz

    @property
    def data_bandwidth_hz(self) -> float:
        """The bandwidth of one subcarrier that carries data, B·(1 − overhead), in Hz."""
        return self.subcarrier_bandwidth_hz * (1.0 - self.overhead)

    @property
    def snr_gap(self) -> float:
        """The coding gap Γ as a ratio."""
        return 10.0 ** (self.snr_gap_db / 10.0)

    @property
    def max_spectral_efficiency(self) -> float:
        """The spectral-efficiency cap in bit/s/Hz, infinite where there is none."""
        cap = self.max_spectral_efficiency_bps_per_hz
        return np.inf if cap is None else float(cap)
