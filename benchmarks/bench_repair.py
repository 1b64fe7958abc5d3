"""Time of each registered repairer on one matrix with 20 % of its entries missing: ``pytest benchmarks``.

Channels are first-order autoregressive over frequency (0.95 from one subcarrier to the next), with levels 30 dB apart.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from wirelessagent import chain, plugins
from wirelessagent.model.observation import ChannelObservation


def observation(num_users: int, num_subcarriers: int) -> ChannelObservation:
    rng = np.random.default_rng(1)
    shape = (num_users, num_subcarriers)
    channel = rng.normal(size=shape) + 1j * rng.normal(size=shape)
    for n in range(1, num_subcarriers):
        channel[:, n] = 0.95 * channel[:, n - 1] + np.sqrt(1 - 0.95**2) * channel[:, n]
    gain = np.abs(channel) ** 2 * 10.0 ** rng.uniform(-13, -10, (num_users, 1))
    return ChannelObservation(gain=np.where(rng.random(shape) < 0.2, np.nan, gain))


@pytest.mark.parametrize("shape", [(8, 20), (64, 273)], ids=lambda shape: f"{shape[0]}x{shape[1]}")
@pytest.mark.parametrize("name", plugins.names("repairer"))
def test_repair(benchmark: Any, name: str, shape: tuple[int, int]) -> None:
    seen = observation(*shape)
    benchmark.group = f"repair {shape[0]}x{shape[1]}"
    chain.repair(seen, name)
    estimate = benchmark(chain.repair, seen, name)
    assert estimate.repaired.any()
