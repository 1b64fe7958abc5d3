"""Sub-band reports: indices by the standard's table, gains by hand, and what repair makes of them."""

from __future__ import annotations

import numpy as np
import pytest

from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError
from wirelessagent.repairing.kriging import Kriging
from wirelessagent.repairing.user_mean import UserMean
from wirelessagent.sensing.cqi import EFFICIENCY, Cqi, as_gains, observation_of_reports, reports


def test_an_index_is_the_highest_that_can_be_received() -> None:
    snr = np.repeat(2.0 ** (EFFICIENCY + 1e-9) - 1.0, 4)
    np.testing.assert_array_equal(reports(snr, 1.0, 4), np.arange(1, 16))
    np.testing.assert_array_equal(reports(0.999 * snr, 1.0, 4), np.arange(15))
    assert reports(np.array([0.0, 0.0]), 1.0, 4).tolist() == [0]


def test_a_sub_band_counts_by_its_mean_efficiency_and_the_last_may_be_short() -> None:
    gain = np.array([2.0**2 - 1, 2.0**4 - 1, 2.0**3 - 1])  # 2, 4 and 3 bit/s/Hz
    assert reports(gain, 1.0, 2).tolist() == [10, 10]


def test_gains_are_those_of_the_interval_and_only_in_the_middles() -> None:
    gain, variance = as_gains(np.array([[0, 7]]), 10.0, 4, 8)
    first = (2.0 ** EFFICIENCY[0] - 1) / 10
    low, high = (2.0 ** EFFICIENCY[6] - 1) / 10, (2.0 ** EFFICIENCY[7] - 1) / 10
    drawn = np.exp(np.random.default_rng(0).uniform(np.log(low), np.log(high), 400_000))
    assert gain[0, 2] == pytest.approx(first / 2)
    assert variance[0, 2] == pytest.approx(first**2 / 12)
    assert gain[0, 6] == pytest.approx(drawn.mean(), rel=1e-3)
    assert variance[0, 6] == pytest.approx(drawn.var(), rel=1e-2)
    assert np.flatnonzero(~np.isnan(gain[0])).tolist() == [2, 6]


@pytest.mark.parametrize(("cqi", "told"), [([[3, 16]], "between 0 and 15; got 16"), ([[3]], "got 1 reports")])
def test_wrong_reports_are_named(cqi: list[list[int]], told: str) -> None:
    with pytest.raises(InputError, match=told):
        as_gains(np.array(cqi), 1.0, 4, 8)


def test_repair_fills_what_reports_leave_open_better_than_their_mean() -> None:
    source = Cqi(
        num_users=8, num_subcarriers=40, rms_delay_spread_s=100e-9, reference_power_w=0.1, inner_radius_m=100.0,
        outer_radius_m=200.0, shadowing_std_db=0.0,
    )  # fmt: skip
    errors = np.zeros(2)
    held = []
    for seed in range(30):
        scene = source.observe(Cell(), seed=seed)
        assert scene.truth is not None
        level = scene.truth.mean(axis=1, keepdims=True)
        for i, repairer in enumerate((Kriging(), UserMean())):
            estimate = repairer.repair(scene.sensed)
            errors[i] += np.sum(((estimate.gain - scene.truth) / level)[estimate.repaired] ** 2)
            if i == 0:
                low, high = estimate.posterior.quantile(0.05), estimate.posterior.quantile(0.95)
                held.append(((scene.truth >= low) & (scene.truth <= high))[estimate.repaired])
    assert np.sqrt(errors[0] / errors[1]) < 0.75
    assert 0.8 < np.mean(np.concatenate(held)) < 0.99


def test_reports_of_a_real_cell_become_an_observation() -> None:
    cqi = np.array([[3, 9], [15, 0]])
    seen = observation_of_reports(
        cqi, Cell(), subband_size=4, num_subcarriers=8, reference_power_w=0.5, report_gap_db=3.0
    )
    assert seen.gain.shape == (2, 8)
    again = reports(np.nan_to_num(np.repeat(seen.gain[:, [2, 6]], 4, axis=1)), 0.5 / Cell().noise_power_w / 10**0.3, 4)
    np.testing.assert_array_equal(again, cqi)
