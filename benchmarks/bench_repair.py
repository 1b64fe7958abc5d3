"""Time of repair on one matrix with 20 % of its entries missing: ``pytest benchmarks/bench_repair.py``.

All registered repairers run on channels that are first-order autoregressive over frequency (0.95 from one subcarrier
to the next), with levels 30 dB apart. The default one runs on the channels of the bars as well, at 30 dB SNR: with
everything estimated, with its parameters held, and without being told of the noise; beside scikit-learn's
``KNNImputer``, where that is installed, which estimates neither variances nor anything else (the table shows ratios).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from channels import FIRST_SEED, RMS_DELAY_SPREAD_S

import wirelessagent as wa
from wirelessagent import chain, plugins
from wirelessagent.experiments.sklearn_adapter import has_sklearn, knn_filled
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.kriging import Kriging

SHAPES = [(8, 20), (64, 273)]
SEED = 1
"""Of the entries that are lost."""


def observation(num_users: int, num_subcarriers: int) -> ChannelObservation:
    rng = np.random.default_rng(SEED)
    shape = (num_users, num_subcarriers)
    channel = rng.normal(size=shape) + 1j * rng.normal(size=shape)
    for n in range(1, num_subcarriers):
        channel[:, n] = 0.95 * channel[:, n - 1] + np.sqrt(1 - 0.95**2) * channel[:, n]
    gain = np.abs(channel) ** 2 * 10.0 ** rng.uniform(-13, -10, (num_users, 1))
    return ChannelObservation(gain=np.where(rng.random(shape) < 0.2, np.nan, gain))


def measured(num_users: int, num_subcarriers: int, *, noise_stated: bool) -> ChannelObservation:
    """A channel of the bars with its losses."""
    scene = wa.simulate(
        "rayleigh",
        seed=FIRST_SEED,
        num_users=num_users,
        num_subcarriers=num_subcarriers,
        rms_delay_spread_s=RMS_DELAY_SPREAD_S,
        snr_db=30.0,
    )
    seen = scene.sensed
    lost = np.random.default_rng(SEED).random(seen.gain.shape) < 0.2
    assert seen.noise_variance is not None
    return ChannelObservation(
        gain=np.where(lost, np.nan, seen.gain),
        noise_variance=np.where(lost, np.nan, seen.noise_variance) if noise_stated else None,
        subcarrier_frequencies_hz=seen.subcarrier_frequencies_hz,
    )


def estimated(stated: ChannelObservation, unstated: ChannelObservation) -> Callable[[], object]:
    return lambda: Kriging().repair(stated)


def held(stated: ChannelObservation, unstated: ChannelObservation) -> Callable[[], object]:
    repairer = Kriging().hold(stated)
    return lambda: repairer.repair(stated)


def noise_unknown(stated: ChannelObservation, unstated: ChannelObservation) -> Callable[[], object]:
    return lambda: Kriging().repair(unstated)


def knn(stated: ChannelObservation, unstated: ChannelObservation) -> Callable[[], object]:
    if not has_sklearn():
        pytest.skip("scikit-learn is not installed")
    relative = (stated.gain / np.nanmean(stated.gain, axis=1, keepdims=True)).T
    return lambda: knn_filled(relative, num_neighbours=5)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: f"{shape[0]}x{shape[1]}")
@pytest.mark.parametrize("name", plugins.names("repairer"))
def test_repair(benchmark: Any, name: str, shape: tuple[int, int]) -> None:
    seen = observation(*shape)
    benchmark.group = f"repair {shape[0]}x{shape[1]}"
    chain.repair(seen, name)
    estimate = benchmark(chain.repair, seen, name)
    assert estimate.repaired.any()


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: f"{shape[0]}x{shape[1]}")
@pytest.mark.parametrize("contender", [estimated, held, noise_unknown, knn], ids=lambda made: made.__name__)
def test_kriging_beside_knn(
    benchmark: Any, contender: Callable[..., Callable[[], object]], shape: tuple[int, int]
) -> None:
    call = contender(measured(*shape, noise_stated=True), measured(*shape, noise_stated=False))
    benchmark.group = f"kriging and KNNImputer {shape[0]}x{shape[1]}"
    call()
    assert benchmark(call) is not None
