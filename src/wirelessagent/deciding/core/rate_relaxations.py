"""What promised rates need at the very least, by water-filling alone: bounds that no search can spoil.

Two relaxations of P2 have one user only, whose least power for a rate, and largest rate within a budget, are exact:

- all users as one, who has the best gain of them on every subcarrier and carries the sum of their rates. In the dual
  that is one price for all users;
- each user alone, as if the others had no promise. In the dual their prices are 0.

Both are found in logarithms of the level, so that a power beyond the range of numbers is infinite and nothing worse.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.model.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Relaxations:
    """The relaxations of promised rates; entry 0 is all users as one, entry 1 + k the k-th user alone.

    Attributes:
        needed_w: least power, shape (1 + user,); infinite where no power does, or no number holds it.
        log_price: ln dP/dR in W per nat, same shape; infinite where the subcarriers are full.
    """

    needed_w: FloatArray
    log_price: FloatArray


def relaxations(snr_per_w: FloatArray, log_snr: FloatArray, ceiling: FloatArray, nats: FloatArray) -> Relaxations:
    """The least power for ``nats`` (user,), all positive, by each relaxation.

    ``snr_per_w`` is a, shape (user, subcarrier), in 1/W; ``log_snr`` is ln a, and ``ceiling`` the most nats there, 0
    where a is 0.
    """
    from wirelessagent.deciding.core.rate_relaxations_kernel import relaxed_power

    needed, log_price = np.empty((2, nats.size + 1))
    relaxed_power(snr_per_w, log_snr, ceiling, nats, needed, log_price)
    return Relaxations(needed_w=needed, log_price=log_price)


def largest_scaling(form: NormalForm, snr_per_w: FloatArray, nats: FloatArray) -> float:
    """A common factor on ``nats`` that the budget does not exceed by any relaxation: the largest rate over the promise.

    Shapes and units as in :func:`relaxations`.
    """
    from wirelessagent.deciding.core.water_filling_kernel import max_rate

    rows, total = np.vstack([snr_per_w.max(axis=0), snr_per_w]), np.append(nats.sum(), nats)
    budget = np.full(total.size, form.budget_w)
    power_w = max_rate(rows[:, np.newaxis], form.cap_w, form.max_snr, budget)[1]
    carried = np.minimum(np.log1p(power_w * rows), form.max_nats).sum(axis=1)
    return float(np.min(carried / total))
