"""The contract of objectives: a concave utility of rates, its exact conjugate, and a value that people can read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple, cast

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.objective import Objective
from wirelessagent.testing.contract import TOLERANCE, ValueContract, as_returned, skip

_DRAWS = 60
_USERS = 3


class _Case(NamedTuple):
    """A question to the conjugate: prices and limits per user."""

    price: FloatArray
    min_rate: FloatArray
    max_rate: FloatArray


class ObjectiveContract(ValueContract):
    """Inherit this and set ``objective``; ``typical_rate_bps`` is the rate around which it is tried.

    >>> from wirelessagent.deciding.objectives.max_rate import MaxRate
    >>> class TestMaxRate(ObjectiveContract):
    ...     objective = MaxRate()
    >>> TestMaxRate().failures()
    {}
    """

    objective: Objective
    typical_rate_bps: float = 1e6

    def subject(self) -> Objective:
        return self.objective

    def test_phrases_are_words_by_language(self) -> None:
        phrases: object = as_returned(self.objective.phrases)
        assert isinstance(phrases, Mapping), f"phrases must come from wirelessagent.phrases(); got {phrases!r}"
        for language, words in cast("Mapping[object, object]", phrases).items():
            assert isinstance(language, str), f"a language is a code such as 'en'; got {language!r}"
            assert isinstance(words, tuple), f"the phrases in {language!r} must be a list; got {words!r}"
            for word in cast("tuple[object, ...]", words):
                assert isinstance(word, str), f"a phrase is text; got {word!r}"
                assert word.strip() == word != "", f"a phrase has no blanks around it and is not empty; got {word!r}"

    def test_direction_is_known(self) -> None:
        direction: str = self.objective.direction
        assert direction in ("max", "min"), f"direction must be 'max' or 'min'; got {direction!r}"

    def test_utility_is_concave(self) -> None:
        rng = np.random.default_rng(1)
        for _ in range(_DRAWS):
            one, other, share = self._rates(rng), self._rates(rng), rng.uniform(0.05, 0.95)
            ends = share * self._utility(one), (1 - share) * self._utility(other)
            between = self._utility(share * one + (1 - share) * other)
            slack = TOLERANCE * (abs(ends[0]) + abs(ends[1]) + abs(between))
            assert between >= sum(ends) - slack, (
                f"utility is not concave: between {one} and {other} it is {between}, below the chord's {sum(ends)}"
            )

    def test_utility_does_not_fall_with_rate(self) -> None:
        rng = np.random.default_rng(2)
        for _ in range(_DRAWS):
            rate = self._rates(rng)
            more = rate * rng.uniform(1, 3, _USERS)
            before, after = self._utility(rate), self._utility(more)
            assert after >= before - TOLERANCE * abs(before), (
                f"utility falls from {before} to {after} when the rates rise from {rate} to {more}"
            )

    def test_conjugate_rates_are_within_the_limits(self) -> None:
        for case in self._cases(seed=3):
            _, rate = self._conjugate(case)
            assert np.shape(rate) == (_USERS,), f"conjugate must return a rate per user; got shape {np.shape(rate)}"
            low, high = case.min_rate * (1 - TOLERANCE), case.max_rate * (1 + TOLERANCE)
            assert np.all((rate >= low) & (rate <= high)), (
                f"conjugate returned the rates {rate}, outside [{case.min_rate}, {case.max_rate}]"
            )

    def test_conjugate_is_reached_by_its_rates(self) -> None:
        for case in self._cases(seed=4):
            value, rate = self._conjugate(case)
            utility, payment = self._utility(rate), _payment(case.price, rate)
            slack = TOLERANCE * (abs(utility) + payment)
            assert abs(value - (utility - payment)) <= slack, (
                f"conjugate says {value} but at its rates {rate} utility − payment is {utility - payment}"
            )

    def test_conjugate_is_never_beaten(self) -> None:
        rng = np.random.default_rng(5)
        for case in self._cases(seed=5):
            value, _ = self._conjugate(case)
            self._try_to_beat(value, case, rng)

    def test_conjugate_holds_without_a_highest_rate(self) -> None:
        rng = np.random.default_rng(6)
        for case in self._cases(seed=6):
            endless = case._replace(max_rate=np.full(_USERS, np.inf))
            value, rate = self._conjugate(endless)
            assert not np.isnan(value), f"conjugate is NaN at the prices {case.price} without a highest rate"
            assert not np.isnan(rate).any(), f"conjugate returned the rates {rate} without a highest rate"
            self._try_to_beat(value, endless._replace(max_rate=np.maximum(case.max_rate, 1e3 * case.min_rate)), rng)

    def test_conjugate_does_not_rise_with_price(self) -> None:
        rng = np.random.default_rng(7)
        for case in self._cases(seed=7):
            cheap = case._replace(price=case.price * rng.integers(0, 2, _USERS))  # nothing to pay for some users
            more, less = self._conjugate(cheap)[0], self._conjugate(case)[0]
            slack = TOLERANCE * (abs(more) + abs(less))
            assert less <= more + slack, (
                f"conjugate rises from {more} to {less} when the prices rise from {cheap.price} to {case.price}"
            )

    def test_conjugate_is_convex_in_price(self) -> None:
        rng = np.random.default_rng(8)
        for case in self._cases(seed=8):
            share, dear = rng.uniform(0.05, 0.95), case._replace(price=case.price * 1e6)
            between = case._replace(price=share * case.price + (1 - share) * dear.price)
            ends = share * self._conjugate(case)[0], (1 - share) * self._conjugate(dear)[0]
            value = self._conjugate(between)[0]
            assert value <= sum(ends) + TOLERANCE * (abs(ends[0]) + abs(ends[1]) + abs(value)), (
                f"conjugate is not convex: between the prices {case.price} and {dear.price} it is {value}, "
                f"above the chord's {sum(ends)}"
            )

    def test_leaves_its_arguments_alone(self) -> None:
        for case in self._cases(seed=9):
            given = _Case(*(array.copy() for array in case))
            self.objective.conjugate(*given)
            self.objective.utility(given.max_rate)
            for name, before, after in zip(case._fields, case, given, strict=True):
                assert np.array_equal(before, after), f"{name} was changed from {before} to {after}"

    def test_value_is_a_number(self) -> None:
        rng, cell = np.random.default_rng(10), Cell()
        for _ in range(_DRAWS):
            rate, power_w = self._rates(rng), rng.uniform(0, cell.max_power_w)
            value: object = as_returned(self.objective.value(rate, power_w, cell))
            assert isinstance(value, float), f"value must be a float; got {type(value).__name__}"
            assert np.isfinite(value), f"value is {value} for the rates {rate}"

    def test_value_favours_rate_and_not_power(self) -> None:
        rng = np.random.default_rng(11)
        for _ in range(_DRAWS):
            rate, power_w = self._rates(rng), rng.uniform(0.1, 10)
            before = self._signed_value(rate, power_w)
            slack = TOLERANCE * abs(before)
            assert not self._signed_value(rate * 2, power_w) < before - slack, (
                f"twice the rates {rate} make the value worse: is the direction right?"
            )
            assert not self._signed_value(rate, power_w * 2) > before + slack, (
                f"twice the power of {power_w} W makes the value better: is the direction right?"
            )

    def _signed_value(self, rate: FloatArray, power_w: float) -> float:
        """The value, negated where less is better."""
        value: object = as_returned(self.objective.value(rate, power_w, Cell()))
        if not isinstance(value, float):
            skip("the value is not a number")
        return -value if self.objective.direction == "min" else value

    def _try_to_beat(self, value: float, case: _Case, rng: np.random.Generator) -> None:
        """Random rates, and every corner that rates within the limits have."""
        position = rng.uniform(0, 1, (_DRAWS, _USERS)) ** rng.choice([0.2, 1.0, 5.0], (_DRAWS, 1))
        corners = np.array(np.meshgrid(*[[0.0, 1.0]] * _USERS)).reshape(_USERS, -1).T
        for rate in case.min_rate + np.vstack([position, corners]) * (case.max_rate - case.min_rate):
            utility, payment = self._utility(rate), _payment(case.price, rate)
            slack = TOLERANCE * (abs(utility) + payment + abs(value)) if np.isfinite(value) else 0.0
            assert utility - payment <= value + slack, (
                f"conjugate says {value} at the prices {case.price}, but the rates {rate} give {utility - payment}"
            )

    def _utility(self, rate: FloatArray) -> float:
        return float(self.objective.utility(rate.copy()))

    def _conjugate(self, case: _Case) -> tuple[float, FloatArray]:
        value, rate = self.objective.conjugate(*(array.copy() for array in case))
        return float(value), np.asarray(rate, dtype=np.float64)

    def _rates(self, rng: np.random.Generator) -> FloatArray:
        return self.typical_rate_bps * 10.0 ** rng.uniform(-2, 2, _USERS)

    def _cases(self, seed: int) -> Iterator[_Case]:
        """Prices around the marginal utility of the typical rate, limits around that rate, some of them equal."""
        rng = np.random.default_rng(seed)
        typical = np.full(_USERS, self.typical_rate_bps)
        marginal = (self._utility(typical * 1.001) - self._utility(typical)) / (1e-3 * self.typical_rate_bps * _USERS)
        for _ in range(_DRAWS):
            low, high = self._rates(rng) / 10, self._rates(rng)
            low = np.where(rng.uniform(size=_USERS) < 0.2, high, np.minimum(low, high))
            price = (marginal if marginal > 0 else 1 / self.typical_rate_bps) * 10.0 ** rng.uniform(-2, 2, _USERS)
            yield _Case(price=price, min_rate=low, max_rate=high)


def _payment(price: FloatArray, rate: FloatArray) -> float:
    return float(np.where(price > 0, price * rate, 0.0).sum())
