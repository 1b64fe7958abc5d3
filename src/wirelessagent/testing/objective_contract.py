"""The contract of objectives: a concave utility of a rate, its exact conjugate, and a value that people can read.

Utility and conjugate are elementwise, so that each check speaks of one user at a time.
"""

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
_ROWS = 2
_FINE, _DECADES = 1000, 3.0
"""Rates per user between which no corner is missed, and how far they reach on both sides of the typical one."""
_HALVINGS, _WIDENINGS, _WIDER = 80, 20, 1e3
"""Steps of a search for a price: to halve a bracket, and to widen it by this factor first."""


class _Case(NamedTuple):
    """A question to the conjugate: prices and limits, one per user, or (row, user)."""

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
        for name in ("phrases", "figure_name"):
            phrases: object = as_returned(getattr(self.objective, name))
            assert isinstance(phrases, Mapping), f"{name} must come from wirelessagent.phrases(); got {phrases!r}"
            for language, words in cast("Mapping[object, object]", phrases).items():
                assert isinstance(language, str), f"a language is a code such as 'en'; got {language!r}"
                assert isinstance(words, tuple), f"the {name} in {language!r} must be a list; got {words!r}"
                for word in cast("tuple[object, ...]", words):
                    assert isinstance(word, str), f"{name} must be text; got {word!r}"
                    assert word.strip() == word != "", f"{name} has no blanks around it and is not empty; got {word!r}"

    def test_direction_measure_and_joining_are_known(self) -> None:
        known = {"direction": ("max", "min"), "measure": ("utility", "power", "efficiency"), "joined": ("sum", "min")}
        for name, values in known.items():
            value: object = getattr(self.objective, name)
            assert value in values, f"{name} must be one of {', '.join(values)}; got {value!r}"
        reason = self.objective.unsolvable()
        assert not reason, reason

    def test_utility_is_elementwise(self) -> None:
        rates = self._rates(np.random.default_rng(12), (_ROWS, _USERS))
        together = _array(self.objective.utility(rates.copy()))
        assert together.shape == rates.shape, (
            f"utility must return a value for each rate: for rates {rates.shape} it returned {together.shape}"
        )
        for row, utility in zip(rates, together, strict=True):
            alone = _array(self.objective.utility(row.copy()))
            assert _equal(utility, alone), f"the utility of {row} is {alone} alone, but {utility} in a batch"
        for user in range(_USERS):
            other = rates.copy()
            other[:, user] *= 2
            others = np.arange(_USERS) != user
            changed = _array(self.objective.utility(other))
            assert _equal(changed[:, others], together[:, others]), "a user's utility depends on another's rate"

    def test_utility_is_concave(self) -> None:
        rng = np.random.default_rng(1)
        for _ in range(_DRAWS):
            one, other, share = self._rates(rng), self._rates(rng), rng.uniform(0.05, 0.95)
            ends = share * self._utility(one), (1 - share) * self._utility(other)
            between = self._utility(share * one + (1 - share) * other)
            slack = TOLERANCE * (abs(ends[0]) + abs(ends[1]) + abs(between))
            assert np.all(between >= sum(ends) - slack), (
                f"utility is not concave: between {one} and {other} it is {between}, below the chord's {sum(ends)}"
            )

    def test_utility_does_not_fall_with_rate(self) -> None:
        rng = np.random.default_rng(2)
        for _ in range(_DRAWS):
            rate = self._rates(rng)
            more = rate * rng.uniform(1, 3, _USERS)
            before, after = self._utility(rate), self._utility(more)
            assert np.all(after >= before - TOLERANCE * abs(before)), (
                f"utility falls from {before} to {after} when the rates rise from {rate} to {more}"
            )

    def test_conjugate_is_elementwise(self) -> None:
        """Prices, limits or all of them may have leading axes, as for many cells or many prices at once."""
        first, other = list(self._cases(seed=13))[:_ROWS]
        stacked = _Case(*(np.stack(arrays) for arrays in zip(first, other, strict=True)))
        one_limit, one_price = other._replace(price=first.price), first._replace(price=other.price)
        batches = {
            "prices and limits": (stacked, (first, other)),
            "prices": (first._replace(price=stacked.price), (first, one_price)),
            "limits": (stacked._replace(price=first.price), (first, one_limit)),
        }
        for what, (batch, rows) in batches.items():
            found = self.objective.conjugate(*(array.copy() for array in batch))
            alone = [self.objective.conjugate(*(array.copy() for array in row)) for row in rows]
            for place, name in enumerate(("values", "rates")):
                array = _array(found[place])
                assert array.shape == (_ROWS, _USERS), (
                    f"for a batch {(_ROWS, _USERS)} of {what} conjugate returned {name} of shape {array.shape}"
                )
                one_by_one = np.stack([_array(answer[place]) for answer in alone])
                assert _equal(array, one_by_one), (
                    f"for a batch of {what} the {name} are {array}, but row by row {one_by_one}"
                )

    def test_conjugate_rates_are_within_the_limits(self) -> None:
        for case in self._cases(seed=3):
            rate = self._conjugate(case)[1]
            low, high = case.min_rate * (1 - TOLERANCE), case.max_rate * (1 + TOLERANCE)
            assert np.all((rate >= low) & (rate <= high)), (
                f"conjugate returned the rates {rate}, outside [{case.min_rate}, {case.max_rate}]"
            )

    def test_conjugate_is_reached_by_its_rates(self) -> None:
        for case in self._cases(seed=4):
            value, rate = self._conjugate(case)
            utility, payment = self._utility(rate), _payment(case.price, rate)
            slack = TOLERANCE * (abs(utility) + payment)
            assert np.all(abs(value - (utility - payment)) <= slack), (
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
            assert not np.isnan(value).any(), f"conjugate is NaN at the prices {case.price} without a highest rate"
            assert not np.isnan(rate).any(), f"conjugate returned the rates {rate} without a highest rate"
            self._try_to_beat(value, endless._replace(max_rate=np.maximum(case.max_rate, 1e3 * case.min_rate)), rng)

    def test_no_corner_is_missed(self) -> None:
        """u(r) is the least of u*(p) + p r over the prices p, so that no corner of either is missing in the other.

        The prices at which the conjugate's rates pass each of many rates are searched for: where they jump over one,
        the search ends at the jump, and the straight line that the conjugate means there must be the utility's.
        """
        self._skip_if_others_say_more("test_utility_", "test_conjugate_")
        rate = self._fine_rates()
        utility, (price, allowed) = _array(self.objective.utility(rate.copy())), self._least_allowed(rate)
        slack = TOLERANCE * (abs(utility) + _payment(price, rate))
        wrong = np.unravel_index(np.argmax(abs(utility - allowed) - slack), rate.shape)
        much = "too small" if utility[wrong] > allowed[wrong] else "too large"
        assert np.all(abs(utility - allowed) <= slack), (
            f"conjugate is {much}: at the price {price[wrong]:.6g} it means that the rate {rate[wrong]:.6g} is worth "
            f"{allowed[wrong]:.12g}, but its utility is {utility[wrong]:.12g}. Does one of them miss a corner?"
        )

    def test_declared_power_law_is_its_utility(self) -> None:
        law: object = as_returned(self.objective.power_law())
        if law is None:
            skip("it declares none, and its bounds rest on the conjugate")
        assert isinstance(law, float), f"power_law must return a float or None; got {law!r}"
        rate = self._fine_rates()
        utility = _array(self.objective.utility(rate.copy()))
        declared = np.log(rate) if law == 1.0 else rate ** (1.0 - law) / (1.0 - law)
        wrong = np.unravel_index(np.argmax(abs(utility - declared) / abs(declared)), rate.shape)
        assert _equal(utility, declared), (
            f"power_law declares {law:g}, so the rate {rate[wrong]:.6g} is worth {declared[wrong]:.12g}; its utility "
            f"is {utility[wrong]:.12g}. Leave power_law out unless it is r^(1 − α)/(1 − α) or ln r everywhere"
        )

    def test_conjugate_does_not_rise_with_price(self) -> None:
        rng = np.random.default_rng(7)
        for case in self._cases(seed=7):
            cheap = case._replace(price=case.price * rng.integers(0, 2, _USERS))  # nothing to pay for some users
            more, less = self._conjugate(cheap)[0], self._conjugate(case)[0]
            slack = TOLERANCE * (abs(more) + abs(less))
            assert np.all(less <= more + slack), (
                f"conjugate rises from {more} to {less} when the prices rise from {cheap.price} to {case.price}"
            )

    def test_conjugate_is_convex_in_price(self) -> None:
        rng = np.random.default_rng(8)
        for case in self._cases(seed=8):
            share, dear = rng.uniform(0.05, 0.95), case._replace(price=case.price * 1e6)
            between = case._replace(price=share * case.price + (1 - share) * dear.price)
            ends = share * self._conjugate(case)[0], (1 - share) * self._conjugate(dear)[0]
            value = self._conjugate(between)[0]
            assert np.all(value <= sum(ends) + TOLERANCE * (abs(ends[0]) + abs(ends[1]) + abs(value))), (
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

    def test_figure_rises_with_utility(self) -> None:
        rng = np.random.default_rng(14)
        for _ in range(_DRAWS):
            utilities = np.unique(self._utility(self._rates(rng)))
            weight = rng.uniform(0.5, 3)
            figures: list[object] = [as_returned(self.objective.figure(float(u), weight)) for u in utilities]
            for figure in figures:
                assert isinstance(figure, float), f"figure must be a float; got {type(figure).__name__}"
            assert np.all(np.diff(np.array(figures)) > 0), (
                f"figure must rise with the utility: of {utilities}, for users of weight {weight}, it is {figures}"
            )

    def test_value_follows_from_utilities_and_weights(self) -> None:
        """As :meth:`Objective.value` says, whoever counts: someone of weight 0 changes nothing, even with no rate."""
        rng, cell, goal = np.random.default_rng(10), Cell.nr(), self.objective
        for weight in (np.ones(_USERS), np.array([0.5, 0.0, 2.0])):
            for _ in range(_DRAWS):
                rate, power_w = self._rates(rng), rng.uniform(0.1, cell.max_power_w)
                counts = weight > 0
                share = rate / np.where(counts, weight, 1.0)
                joint = np.min(self._utility(share)[counts])
                if goal.joined != "min":
                    joint = np.sum(weight * self._utility(rate))
                drawn = power_w / cell.amplifier_efficiency + cell.circuit_power_w
                figure = goal.figure(float(joint), float(weight.sum()))
                wanted = {"power": power_w, "efficiency": figure / drawn}.get(goal.measure, figure)
                assert np.isfinite(wanted), f"the value is {wanted} for the rates {rate}"
                for others in (rate, np.where(counts, rate, 0.0)):
                    value: object = as_returned(goal.value(others, power_w, cell, weight))
                    assert isinstance(value, float), f"value must be a float; got {type(value).__name__}"
                    assert abs(value - wanted) <= TOLERANCE * abs(wanted), (
                        f"for the rates {others}, weighed by {weight}, value is {value}; "
                        f"its utilities and figure make it {wanted}"
                    )

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
        self._utility(rate)  # the value rests on it
        value = self.objective.value(rate, power_w, Cell())
        return -value if self.objective.direction == "min" else value

    def _try_to_beat(self, value: FloatArray, case: _Case, rng: np.random.Generator) -> None:
        """Random rates, and both ends."""
        position = rng.uniform(0, 1, (_DRAWS, _USERS)) ** rng.choice([0.2, 1.0, 5.0], (_DRAWS, 1))
        ends = np.repeat([[0.0], [1.0]], _USERS, axis=1)
        for rate in case.min_rate + np.vstack([position, ends]) * (case.max_rate - case.min_rate):
            utility, payment = self._utility(rate), _payment(case.price, rate)
            slack = TOLERANCE * (abs(utility) + payment + np.where(np.isfinite(value), abs(value), 0.0))
            assert np.all(utility - payment <= value + slack), (
                f"conjugate says {value} at the prices {case.price}, but the rates {rate} give {utility - payment}"
            )

    def _fine_rates(self) -> FloatArray:
        """Rates (row, user) that lie close to each other, over more decades than the other checks try."""
        position = np.arange(_FINE)[:, np.newaxis] + np.random.default_rng(15).uniform(size=(_FINE, _USERS))
        return self.typical_rate_bps * 10.0 ** (_DECADES * (2.0 * position / _FINE - 1.0))

    def _least_allowed(self, rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """For each rate (row, user) how much u*(p) + p r is at least, and the price p of that; tried at all prices."""
        price = self._prices_of(rate)
        low, high = np.full(price.shape, rate.min() / 10), np.full(price.shape, rate.max() * 10)
        value = _array(self.objective.conjugate(price.copy(), low, high)[0])
        allowed = value[:, np.newaxis] + price[:, np.newaxis] * rate
        least = allowed.argmin(axis=0)
        return np.take_along_axis(price, least, axis=0), allowed.min(axis=0)

    def _prices_of(self, rate: FloatArray) -> FloatArray:
        """Next to those at which the conjugate's rates pass each rate (row, user), and 0; shape (price, user)."""
        low, high = np.full(rate.shape, rate.min() / 10), np.full(rate.shape, rate.max() * 10)

        def bought(price: FloatArray) -> FloatArray:
            return _array(self.objective.conjugate(price.copy(), low.copy(), high.copy())[1])

        cheap = dear = np.full(rate.shape, next(self._cases(seed=16)).price.max())
        for _ in range(_WIDENINGS):
            cheap = np.where(bought(cheap) < rate, cheap / _WIDER, cheap)
            dear = np.where(bought(dear) > rate, dear * _WIDER, dear)
        for _ in range(_HALVINGS):
            middle = np.sqrt(cheap) * np.sqrt(dear)
            more = bought(middle) > rate
            cheap, dear = np.where(more, middle, cheap), np.where(more, dear, middle)
        return np.vstack([np.zeros(rate.shape[1:]), cheap, dear])

    def _skip_if_others_say_more(self, *checks: str) -> None:
        """Leave a check out where one of the others, by how its name begins, already says what is wrong."""
        for name in self.checks():
            if name.startswith(checks):
                try:
                    getattr(self, name)()
                except AssertionError:
                    skip(f"{name} says what is wrong")

    def _utility(self, rate: FloatArray) -> FloatArray:
        """Of rates (user,); another check reports it where that is not what utility returns."""
        utility = _array(self.objective.utility(rate.copy()))
        if utility.shape != rate.shape:
            skip("utility is not elementwise")
        return utility

    def _conjugate(self, case: _Case) -> tuple[FloatArray, FloatArray]:
        """Value and rate for prices and limits (user,); likewise."""
        value, rate = self.objective.conjugate(*(array.copy() for array in case))
        if np.shape(value) != (_USERS,) or np.shape(rate) != (_USERS,):
            skip("conjugate is not elementwise")
        return _array(value), _array(rate)

    def _rates(self, rng: np.random.Generator, shape: tuple[int, ...] = (_USERS,)) -> FloatArray:
        return self.typical_rate_bps * 10.0 ** rng.uniform(-2, 2, shape)

    def _cases(self, seed: int) -> Iterator[_Case]:
        """Prices around the marginal utility of the typical rate, limits around that rate, some of them equal."""
        rng = np.random.default_rng(seed)
        typical = np.full(_USERS, self.typical_rate_bps)
        marginal = (self._utility(typical * 1.001) - self._utility(typical)) / (1e-3 * typical)
        for _ in range(_DRAWS):
            low, high = self._rates(rng) / 10, self._rates(rng)
            low = np.where(rng.uniform(size=_USERS) < 0.2, high, np.minimum(low, high))
            price = np.where(marginal > 0, marginal, 1 / typical) * 10.0 ** rng.uniform(-2, 2, _USERS)
            yield _Case(price=price, min_rate=low, max_rate=high)


def _array(answer: object) -> FloatArray:
    return np.asarray(answer, dtype=np.float64)


def _equal(one: FloatArray, other: FloatArray) -> bool:
    """Whether two arrays are the same but for rounding."""
    return one.shape == other.shape and np.allclose(one, other, rtol=TOLERANCE, atol=0)


def _payment(price: FloatArray, rate: FloatArray) -> FloatArray:
    return np.where(price > 0, price * rate, 0.0)
