"""The contract of repairers: every hole filled with honest uncertainty, nothing observed touched, no memory."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from wirelessagent.model.errors import InputError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.repairing.repairer import Repairer
from wirelessagent.testing.channels import observations
from wirelessagent.testing.contract import ValueContract, as_returned, skip


def _patterns() -> dict[str, ChannelObservation]:
    """The patterns of holes, and reports that are all below what a report can express."""
    dark = np.zeros((3, 6))
    dark[:, 1::3] = np.nan
    one = np.array([1e-9, 3e-9, 2e-9])[:, np.newaxis] * np.ones((3, 6))
    one[0] = 0.0
    one[:, 2::3] = np.nan
    return observations() | {
        "all observed are zero": ChannelObservation(gain=dark),
        "a user whose observed are all zero": ChannelObservation(gain=one),
    }


class RepairerContract(ValueContract):
    """Inherit this and set ``repairer``.

    It is tried on every pattern of holes in ``testing.channels``, and on reports of nothing but zeros.
    """

    repairer: Repairer

    def subject(self) -> Repairer:
        return self.repairer

    def test_completes_every_pattern(self) -> None:
        for pattern, observation in _patterns().items():
            try:
                estimate: object = as_returned(self.repairer.repair(observation))
            except Exception as error:  # whatever it raises, the pattern must be named
                raise AssertionError(f"with {pattern} it raised {type(error).__name__}: {error}") from error
            assert isinstance(estimate, ChannelEstimate), (
                f"repair must return a ChannelEstimate; got {type(estimate).__name__} with {pattern}"
            )
            assert estimate.gain.shape == observation.current.shape, (
                f"with {pattern} the estimate has shape {estimate.gain.shape}, not {observation.current.shape}"
            )

    def test_observed_entries_are_bit_identical(self) -> None:
        for pattern, observation, estimate in self._estimates():
            seen = ~observation.missing
            assert estimate.gain[seen].tobytes() == observation.current[seen].tobytes(), (
                f"with {pattern} observed gains were changed: ChannelEstimate.completing() keeps them"
            )

    def test_observed_entries_keep_their_measurement_noise(self) -> None:
        for pattern, observation, estimate in self._estimates():
            seen = ~observation.missing
            assert np.array_equal(estimate.gain_variance[seen], observation.current_noise_variance[seen]), (
                f"with {pattern} the variance of observed gains is not their measurement noise"
            )

    def test_repaired_entries_are_marked(self) -> None:
        for pattern, observation, estimate in self._estimates():
            assert np.array_equal(estimate.repaired, observation.missing), (
                f"with {pattern} the mask of repaired entries is not the mask of missing ones"
            )

    def test_repaired_entries_are_uncertain(self) -> None:
        for pattern, observation, estimate in self._estimates():
            guessed = observation.missing
            certain = int(np.count_nonzero(estimate.gain_variance[guessed] == 0))
            assert not certain, (
                f"with {pattern} {certain} repaired gains have a variance of zero: a guess is not a fact"
            )

    def test_users_never_observed_are_flagged(self) -> None:
        for pattern, observation, estimate in self._estimates():
            blind = np.isnan(observation.slots).all(axis=(0, 2))
            assert np.array_equal(estimate.unobserved_users, blind), (
                f"with {pattern} the users flagged as never observed are {np.flatnonzero(estimate.unobserved_users)}, "
                f"not {np.flatnonzero(blind)}"
            )

    def test_names_are_kept(self) -> None:
        for pattern, observation, estimate in self._estimates():
            assert estimate.user_names == observation.user_names, f"with {pattern} the users' names were lost"
            assert estimate.method == self.repairer.name, (
                f"the estimate says it is by {estimate.method!r}, not by {self.repairer.name!r}"
            )

    def test_posterior_fits_the_estimate(self) -> None:
        for pattern, _, estimate in self._estimates():
            posterior, shape = estimate.posterior, estimate.gain.shape
            low, high = posterior.quantile(0.1), posterior.quantile(0.9)
            samples = posterior.samples(3, seed=1)
            nats = posterior.expected_log1p(np.full(shape, 1e12))
            assert low.shape == high.shape == nats.shape == shape, f"with {pattern} the posterior has another shape"
            assert samples.shape == (3, *shape), f"with {pattern} samples(3) has shape {samples.shape}"
            assert np.all(low <= high), f"with {pattern} the 10 % quantile lies above the 90 % quantile"
            assert np.all(samples >= 0), f"with {pattern} the posterior draws negative gains"
            assert np.all(low >= 0), f"with {pattern} the posterior has negative quantiles"

    def test_nothing_observed_is_refused_or_flagged(self) -> None:
        observation = ChannelObservation(gain=np.full((3, 4), np.nan))
        try:
            estimate = self.repairer.repair(observation)
        except InputError:
            return
        assert estimate.unobserved_users.all(), "nothing was observed, yet users are not flagged"

    def test_leaves_the_observation_alone(self) -> None:
        for pattern, observation in _patterns().items():
            array = observation.gain
            before = array.tobytes()
            self._repair(observation)
            assert observation.gain is array, f"with {pattern} the observation got another gain matrix"
            assert array.tobytes() == before, f"with {pattern} the observation was written to"

    def test_has_no_memory_and_does_not_draw(self) -> None:
        first = {pattern: self._repair(case) for pattern, case in _patterns().items()}
        for pattern, case in reversed(_patterns().items()):
            again, before = self._repair(case), first[pattern]
            if again is not None and before is not None:
                assert again.gain.tobytes() == before.gain.tobytes(), (
                    f"with {pattern} a second call gave other gains: a repairer keeps no state and draws nothing"
                )

    def _repair(self, observation: ChannelObservation) -> ChannelEstimate | None:
        """The estimate, or None where there is none, which is another check's finding."""
        try:
            estimate: object = as_returned(self.repairer.repair(observation))
        except Exception:  # noqa: BLE001  # test_completes_every_pattern reports it
            return None
        if isinstance(estimate, ChannelEstimate) and estimate.gain.shape == observation.current.shape:
            return estimate
        return None

    def _estimates(self) -> Iterator[tuple[str, ChannelObservation, ChannelEstimate]]:
        found = 0
        for pattern, observation in _patterns().items():
            estimate = self._repair(observation)
            if estimate is not None:
                found += 1
                yield pattern, observation, estimate
        if not found:
            skip("no pattern was completed")
