"""Objectives that :class:`ObjectiveContract` must reject."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.objective import Objective
from wirelessagent.model.phrases import phrases
from wirelessagent.testing.kinked import KinkedLogarithm

Conjugate = tuple[FloatArray, FloatArray]

_DEAR = 1e3
"""A price per utility, far above what a rate is worth."""


@dataclass(frozen=True, kw_only=True)
class SumRate(Objective):
    """Σ r, sound: the broken ones below differ from it in one thing each."""

    name = "sum_rate"
    unit = "bit/s"
    phrases = phrases(en=["as much as possible"])
    caught_by = ""

    def utility(self, rate: FloatArray) -> FloatArray:
        return rate

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        rate = np.where(price < 1, max_rate, min_rate)
        return (1 - price) * rate, rate


class NotDecorated(SumRate):
    """Its field never becomes an option, because the class is not a dataclass of its own."""

    caught_by = "test_is_a_frozen_dataclass"
    weight: float = 1.0


@dataclass(frozen=True, kw_only=True)
class BadlyNamed(SumRate):
    """A name that no command line can take."""

    name = "Sum Rate"
    caught_by = "test_has_a_name"


@dataclass(frozen=True, kw_only=True)
class WithoutSummary(SumRate):
    caught_by = "test_has_a_summary"


@dataclass(frozen=True, kw_only=True)
class WithoutDefault(SumRate):
    """Needs something that cannot be written on a command line."""

    caught_by = "test_can_be_made_from_its_options"
    table: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class HoldsALambda(SumRate):
    """Cannot travel to another process."""

    caught_by = "test_survives_pickling"
    worth: Callable[[float], float] = lambda rate: rate


@dataclass(frozen=True, kw_only=True)
class HoldsAList(SumRate):
    """Cannot be a key."""

    caught_by = "test_is_a_value"
    levels: list[float] = field(default_factory=list[float])


@dataclass(frozen=True, kw_only=True)
class PhrasesAsText(SumRate):
    """One string is a phrase per letter."""

    phrases = cast("Any", {"en": "as much as possible"})
    caught_by = "test_phrases_are_words_by_language"


@dataclass(frozen=True, kw_only=True)
class UnknownDirection(SumRate):
    """Neither max nor min."""

    direction = cast("Any", "up")
    caught_by = "test_direction_measure_and_joining_are_known"


@dataclass(frozen=True, kw_only=True)
class UnknownMeasure(SumRate):
    """Made of something that no solver knows."""

    measure = cast("Any", "delay")
    caught_by = "test_direction_measure_and_joining_are_known"


@dataclass(frozen=True, kw_only=True)
class UnknownJoining(SumRate):
    """Joins the users in a way that no solver knows."""

    joined = cast("Any", "median")
    caught_by = "test_direction_measure_and_joining_are_known"


@dataclass(frozen=True, kw_only=True)
class SumsTheUsers(SumRate):
    """One utility for all, where each user's is asked for."""

    caught_by = "test_utility_is_elementwise"

    def utility(self, rate: FloatArray) -> FloatArray:
        return rate.sum()


@dataclass(frozen=True, kw_only=True)
class KnowsOneRowOfRates(SumRate):
    """A batch gets the utilities of its first row."""

    caught_by = "test_utility_is_elementwise"

    def utility(self, rate: FloatArray) -> FloatArray:
        return np.broadcast_to(rate[(0,) * (rate.ndim - 1)], rate.shape)


@dataclass(frozen=True, kw_only=True)
class CountsOnTheOthers(SumRate):
    """A user is better off when the next one is; nobody would see it in one user's rates."""

    caught_by = "test_utility_is_elementwise"

    def utility(self, rate: FloatArray) -> FloatArray:
        return rate if rate.ndim == 1 else rate + 0.1 * np.roll(rate, 1, axis=-1)


@dataclass(frozen=True, kw_only=True)
class SumsTheSurplus(SumRate):
    """One figure for all, where each user's is asked for."""

    caught_by = "test_conjugate_is_elementwise"

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        surplus, rate = SumRate.conjugate(self, price, min_rate, max_rate)
        return surplus.sum(), rate


@dataclass(frozen=True, kw_only=True)
class KnowsOneRowOfPrices(SumRate):
    """A batch is answered at its first row's prices."""

    caught_by = "test_conjugate_is_elementwise"

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        return SumRate.conjugate(self, price[(0,) * (price.ndim - 1)], min_rate, max_rate)


@dataclass(frozen=True, kw_only=True)
class Convex(SumRate):
    """r²: the more, the more it wants, and no price balances it."""

    caught_by = "test_utility_is_concave"

    def utility(self, rate: FloatArray) -> FloatArray:
        return np.square(rate)

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        ends = min_rate * (min_rate - price), max_rate * (max_rate - price)
        return np.maximum(*ends), np.where(ends[1] > ends[0], max_rate, min_rate)


@dataclass(frozen=True, kw_only=True)
class Falling(SumRate):
    """−r: less is better, to the users of an objective that saves power."""

    measure = "power"
    direction = "min"
    caught_by = "test_utility_does_not_fall_with_rate"

    def utility(self, rate: FloatArray) -> FloatArray:
        return -rate

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        rate = np.broadcast_to(min_rate, np.broadcast_shapes(price.shape, min_rate.shape, max_rate.shape))
        return -(1 + price) * rate, rate


@dataclass(frozen=True, kw_only=True)
class IgnoresLimits(SumRate):
    """The maximum over other limits than it was given."""

    caught_by = "test_conjugate_rates_are_within_the_limits"

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        return SumRate.conjugate(self, price, min_rate / 2, max_rate * 2)


@dataclass(frozen=True, kw_only=True)
class OverstatesConjugate(SumRate):
    """One thousandth above what its rates reach."""

    caught_by = "test_conjugate_is_reached_by_its_rates"

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        rate = np.where(price < 1, max_rate, min_rate)
        return (np.where(price < 1, 1.001, 0.999) * (1 - price) * rate), rate


@dataclass(frozen=True, kw_only=True)
class StopsAtTheLowestRate(SumRate):
    """A true figure of the wrong rates, as a local optimum would be."""

    caught_by = "test_conjugate_is_never_beaten"

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        if np.isinf(max_rate).any():
            return SumRate.conjugate(self, price, min_rate, max_rate)
        rate = np.where(price < 0, max_rate, min_rate)
        return (1 - price) * rate, rate


@dataclass(frozen=True, kw_only=True)
class LostWithoutAHighestRate(SumRate):
    """Infinity minus infinity."""

    caught_by = "test_conjugate_holds_without_a_highest_rate"

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        rate = np.where(price < 1, max_rate, min_rate)
        with np.errstate(invalid="ignore"):
            return rate - price * rate, rate


@dataclass(frozen=True, kw_only=True)
class MissesACorner(SumRate):
    """ln r with a corner where two tangents meet, so close to the logarithm that its conjugate was left as it was."""

    corner = KinkedLogarithm(knots=(7e5, 7.8e5))
    caught_by = "test_no_corner_is_missed"

    def utility(self, rate: FloatArray) -> FloatArray:
        return self.corner.utility(rate)

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        with np.errstate(divide="ignore"):
            rate = np.clip(1 / price, min_rate, max_rate)
        return self.utility(rate) - np.where(price > 0, price * rate, 0), rate


@dataclass(frozen=True, kw_only=True)
class StraightAsFarAsItWasTried(SumRate):
    """Saturates at 500 Mbit/s, which its conjugate has never heard of."""

    caught_by = "test_no_corner_is_missed"

    def utility(self, rate: FloatArray) -> FloatArray:
        return np.minimum(rate, 5e8)


@dataclass(frozen=True, kw_only=True)
class DeclaresItselfStraight(SumRate):
    """Says that it is the rate, and flattens out where nobody looks; its conjugate is right."""

    caught_by = "test_declared_power_law_is_its_utility"

    def utility(self, rate: FloatArray) -> FloatArray:
        return np.minimum(rate, 5e8)

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        rate = np.where(price < 1, np.clip(5e8, min_rate, max_rate), min_rate)
        return np.minimum(rate, 5e8) - price * rate, rate

    def power_law(self) -> float:
        return 0.0


@dataclass(frozen=True, kw_only=True)
class EfficiencyOfTheSmallest(SumRate):
    """The lowest rate per joule, for which no bound is known."""

    measure = "efficiency"
    joined = "min"
    caught_by = "test_direction_measure_and_joining_are_known"


@dataclass(frozen=True, kw_only=True)
class ForgetsWhatIsFree(SumRate):
    """A guard against a division by a price of zero that drops the user."""

    caught_by = "test_conjugate_does_not_rise_with_price"

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        rate = np.where(price < 1, max_rate, min_rate)
        return np.where(price > 0, (1 - price) * rate, -1e12), rate


@dataclass(frozen=True, kw_only=True)
class MispricesTheDear(SumRate):
    """A shortcut at high prices that charges too much."""

    caught_by = "test_conjugate_is_convex_in_price"

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        rate = np.where(price < 1, max_rate, min_rate)
        charge = np.minimum(price, _DEAR) + 1.5 * np.maximum(price - _DEAR, 0)
        return ((1 - charge) * rate), rate


@dataclass(frozen=True, kw_only=True)
class WritesToItsArguments(SumRate):
    """Saves an array and spoils the caller's."""

    caught_by = "test_leaves_its_arguments_alone"

    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> Conjugate:
        surplus, rate = SumRate.conjugate(self, price, min_rate, max_rate)
        if rate.shape == max_rate.shape:
            max_rate[:] = rate
        return surplus, rate


@dataclass(frozen=True, kw_only=True)
class FlatFigure(SumRate):
    """Shows the same whatever was reached."""

    caught_by = "test_figure_rises_with_utility"

    def figure(self, utility: float, weight: float) -> float:
        del utility, weight
        return 1.0


@dataclass(frozen=True, kw_only=True)
class FigureInAnArray(SumRate):
    """An array where one number is wanted."""

    caught_by = "test_figure_rises_with_utility"

    def figure(self, utility: float, weight: float) -> float:
        del weight
        return cast("Any", np.asarray(utility))


@dataclass(frozen=True, kw_only=True)
class WeighsAllAlike(SumRate):
    """A value of its own making, which forgets the weights."""

    caught_by = "test_value_follows_from_utilities_and_weights"

    def value(  # pyright: ignore[reportIncompatibleMethodOverride]  # final: that is what is wrong with it
        self, rate: FloatArray, power_w: float, cell: Cell, weight: FloatArray | None = None
    ) -> float:
        return float(rate.sum())


@dataclass(frozen=True, kw_only=True)
class WrongDirection(SumRate):
    """Says that less is better, and means more."""

    direction = "min"
    caught_by = "test_value_favours_rate_and_not_power"


BROKEN: tuple[SumRate, ...] = (
    NotDecorated(),
    BadlyNamed(),
    WithoutSummary(),
    WithoutDefault(table=(1.0,)),
    HoldsALambda(),
    HoldsAList(),
    PhrasesAsText(),
    UnknownDirection(),
    UnknownMeasure(),
    UnknownJoining(),
    SumsTheUsers(),
    KnowsOneRowOfRates(),
    CountsOnTheOthers(),
    SumsTheSurplus(),
    KnowsOneRowOfPrices(),
    Convex(),
    Falling(),
    IgnoresLimits(),
    OverstatesConjugate(),
    StopsAtTheLowestRate(),
    LostWithoutAHighestRate(),
    MissesACorner(),
    StraightAsFarAsItWasTried(),
    DeclaresItselfStraight(),
    EfficiencyOfTheSmallest(),
    ForgetsWhatIsFree(),
    MispricesTheDear(),
    WritesToItsArguments(),
    FlatFigure(),
    FigureInAnArray(),
    WeighsAllAlike(),
    WrongDirection(),
)
