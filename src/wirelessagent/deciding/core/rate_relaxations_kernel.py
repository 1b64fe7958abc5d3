"""The least power for promised rates with all users as one, and for each as if alone; see :mod:`.rate_relaxations`."""

from __future__ import annotations

import numpy as np

from wirelessagent.deciding.core.least_power_kernel import fill_rate
from wirelessagent.kernels import kernel
from wirelessagent.model.arrays import FloatArray


@kernel
def relaxed_power(
    snr_per_w: FloatArray,
    log_snr: FloatArray,
    ceiling: FloatArray,
    nats: FloatArray,
    power_w: FloatArray,
    log_price: FloatArray,
) -> None:
    """Write the power and ln dP/dR of each relaxation, shape (1 + user,): all users as one, then each alone.

    The power is infinite where the subcarriers cannot carry the rate, or no number holds it; the price where they are
    full or too few.

    Args:
        snr_per_w, log_snr, ceiling: a, ln a and the most nats, shape (user, subcarrier), C-contiguous.
        nats: promised rates, shape (user,), all positive.
    """  # fmt: skip
    users, subcarriers = snr_per_w.shape
    usable = np.empty(subcarriers, dtype=np.int64)
    floor = np.empty(subcarriers)
    cap = np.empty(subcarriers)
    best = np.zeros((3, subcarriers))
    for k in range(users):
        for n in range(subcarriers):
            if snr_per_w[k, n] > best[0, n]:
                best[0, n] = snr_per_w[k, n]
                best[1, n] = log_snr[k, n]
            best[2, n] = max(best[2, n], ceiling[k, n])
    for i in range(users + 1):
        snr = best[0] if i == 0 else snr_per_w[i - 1]
        log = best[1] if i == 0 else log_snr[i - 1]
        most = best[2] if i == 0 else ceiling[i - 1]
        size = 0
        top = -np.inf
        for n in range(subcarriers):
            if snr[n] > 0.0:
                usable[size] = n
                size += 1
                top = max(top, log[n])
        level, power_w[i] = fill_rate(snr, log, most, usable, size, nats.sum() if i == 0 else nats[i - 1], floor, cap)
        log_price[i] = level - top if level > 0.0 else np.inf  # the level is 0 where the subcarriers are too few
