"""Conversions between linear SI quantities and the logarithmic ones that people write.

Inside the library everything is linear SI; a logarithmic quantity carries its unit in its name.
"""

from __future__ import annotations

import numpy as np

from wirelessagent.model.arrays import FloatArray


def db(ratio: FloatArray | float, *, floor_db: float = -np.inf) -> FloatArray:
    """10 log10 of a power ratio; zero becomes ``floor_db``.

    >>> float(db(100.0))
    20.0
    """
    with np.errstate(divide="ignore"):
        return np.maximum(10.0 * np.log10(ratio), floor_db)


def from_db(value_db: FloatArray | float) -> FloatArray:
    """The power ratio of a value in dB.

    >>> float(from_db(30.0))
    1000.0
    """
    return np.power(10.0, np.asarray(value_db, dtype=np.float64) / 10.0)


def dbm_to_w(value_dbm: float) -> float:
    """Watts of a power in dBm: 30 dBm is 1 W.

    >>> dbm_to_w(43.0103)  # doctest: +ELLIPSIS
    20.00...
    """
    return float(10.0 ** ((value_dbm - 30.0) / 10.0))


_NOUGHT = 1e-9
"""Shares up to this are rounding: constraints are kept that well, and a gap of no more is none."""

_LEAST_SHARE = 1e-5
"""Shares below this are told as less than it."""

_ALL_BUT_CERTAIN = 0.999

_PREFIXES = ((1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))


def prefixed(largest: float, unit: str) -> tuple[float, str]:
    """What to divide figures up to ``largest`` by for an axis, a power of 1000, and the unit with its SI prefix.

    >>> prefixed(2.5e7, "bit/s"), prefixed(0.02, "W"), prefixed(0.0, "W")
    ((1000000.0, 'Mbit/s'), (0.001, 'mW'), (1.0, 'W'))
    """
    return next(((scale, prefix + unit) for scale, prefix in _PREFIXES if largest >= scale), (1.0, unit))


def reliability(outage_probability: float) -> str:
    """The probability that a promise is kept, with all its digits: the nines are what counts.

    >>> reliability(0.05), reliability(1e-5)
    ('95 %', '99.999 %')
    """
    return f"{100.0 - 100.0 * outage_probability:.10g} %"


def probability(share: float) -> str:
    """A probability in percent; beyond 99.9 % nobody counts, and nothing is certain.

    >>> probability(0.953), probability(0.99999), probability(1e-5)
    ('95.3 %', '> 99.9 %', '< 0.1 %')
    """
    if share > _ALL_BUT_CERTAIN:
        return f"> {100 * _ALL_BUT_CERTAIN:.3g} %"
    return f"{100 * share:.3g} %" if share >= 1 - _ALL_BUT_CERTAIN else f"< {100 * (1 - _ALL_BUT_CERTAIN):.1g} %"


def percent(share: float) -> str:
    """A share in percent, with as many digits as people read; 0 where it is rounding.

    >>> percent(0.1234), percent(130.0), percent(2e-3), percent(3e-7), percent(7e-14)
    ('12 %', '13,000 %', '0.2 %', '< 0.001 %', '0 %')
    """
    if not np.isfinite(share):
        return "–"
    if abs(share) <= _NOUGHT:
        return "0 %"
    if abs(share) < _LEAST_SHARE:
        return f"< {100 * _LEAST_SHARE:.1g} %"
    return f"{100 * share:,.0f} %" if abs(share) >= 0.1 else f"{100 * share:.2g} %"


def human(value: float, unit: str) -> str:
    """A figure as people read it: three significant digits and an SI prefix.

    A ratio (no unit, or one per hertz) takes no prefix, nor does a figure beyond them all.

    >>> human(1.234e7, "bit/s"), human(1e12, "bit/s"), human(0.0421, "W"), human(0, "W"), human(0.25, "bit/s/Hz")
    ('12.3 Mbit/s', '1 Tbit/s', '42.1 mW', '0 W', '0.25 bit/s/Hz')
    """
    if np.isnan(value):
        return "–"
    if value == 0:
        return f"0 {unit}".strip()  # no -0
    if np.isinf(value) or abs(value) >= 1e15 or not unit or unit.endswith("/Hz"):
        return f"{value:.3g} {unit}".strip()
    for scale, prefix in _PREFIXES:
        if abs(value) >= scale * 0.9995:
            return f"{value / scale:.3g} {prefix}{unit}"
    return f"{value:.3g} {unit}"
