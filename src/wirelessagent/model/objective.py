"""What to optimise. An objective says *what*; a method says *how*.

Each user's rate has a utility, and the users' utilities are joined: summed, or the smallest of them. For given prices
of the rates the users decouple, so an objective enters a solver through its concave conjugate alone: the most that
utility minus payment can be, and the rate that reaches it (Boyd and Vandenberghe, Convex Optimization, 3.3 and 5.1.6).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Literal, final

import numpy as np

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError
from wirelessagent.model.keywords import KnownKeywords
from wirelessagent.model.metrics import energy_efficiency_bit_per_j
from wirelessagent.model.phrases import Phrases, phrases


@dataclass(frozen=True, kw_only=True)
class Objective(KnownKeywords, ABC):
    """A goal for the allocation. Subclass as a frozen keyword-only dataclass; its fields become options everywhere.

    Attributes:
        name: the registered name, equal to the entry point's.
        aliases: other names, such as the paper's P1.
        unit: the unit of :meth:`value`, as in "bit/s".
        direction: whether a larger or a smaller value is better.
        phrases: what an operator may say to mean it, by language.
        figure_name: what its value is called, as in "the users' lowest rate", by language; none where the unit tells.
        default_method: the method used when none is named.
        measure: what the value is made of: the users' joint utility, the radiated power, or the joint utility per
            joule drawn.
        joined: how the users' utilities join. A user's weight multiplies its utility in a sum; where the smallest
            counts it is the user's share, so that weight 2 stands for twice the rate.
    """

    name: ClassVar[str]
    aliases: ClassVar[tuple[str, ...]] = ()
    unit: ClassVar[str] = ""
    direction: ClassVar[Literal["max", "min"]] = "max"
    figure_name: ClassVar[Phrases] = phrases()
    phrases: ClassVar[Phrases] = phrases()
    default_method: ClassVar[str] = "dual"
    measure: ClassVar[Literal["utility", "power", "efficiency"]] = "utility"
    joined: ClassVar[Literal["sum", "min"]] = "sum"

    @abstractmethod
    def utility(self, rate: FloatArray) -> FloatArray:
        """u(r): what each rate (…, user) in bit/s is worth to its user, elementwise, same shape.

        Concave and non-decreasing; −inf is allowed at 0.
        """

    @abstractmethod
    def conjugate(self, price: FloatArray, min_rate: FloatArray, max_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """max over r in [min_rate, max_rate] of u(r) − price · r, and a rate that reaches it, elementwise.

        All arrays are (…, user), broadcast together; rates in bit/s, max_rate may be infinite, prices are zero or
        more. Where the maximum is not bounded the value is inf.
        """

    def power_law(self) -> float | None:
        """α where u(r) is r^(1 − α)/(1 − α), or ln r for α = 1, at every rate; None where it is anything else.

        A declaration: 0 is the rate itself, 1 its logarithm (Mo and Walrand, 2000). Closed forms and the exact search
        are for utilities that declare one, and rest on it; every other bound rests on the conjugate. Nothing finds out
        what a utility is by asking for some of its values.
        """
        return None

    def figure(self, utility: float, weight: float) -> float:
        """The figure shown for a joint utility of users of total ``weight``, in ``unit``: increasing in the utility.

        The utility itself unless it says otherwise; where utilities are logarithms, the mean rate that they stand for.
        """
        del weight
        return utility

    @property
    @final
    def is_built_in(self) -> bool:
        """Whether it comes with this package, not from a plug-in of somebody else's."""
        return type(self).__module__.split(".")[0] == __name__.split(".")[0]

    @final
    def unsolvable(self) -> str:
        """Why no bound is known for an objective that is made like this one, empty where there is one.

        An efficiency divides the sum of the utilities themselves: its bound knows no other figure.
        """
        if self.measure != "efficiency" or (self.joined == "sum" and type(self).figure is Objective.figure):
            return ""
        return f"{self.name!r} is an efficiency, so joined must be 'sum' and figure be left as it is"

    @final
    def value(self, rate: FloatArray, power_w: float, cell: Cell, weight: FloatArray | None = None) -> float:
        """What the allocation is worth, in ``unit``.

        By ``measure``, with U = Σ ω_k u(r_k), or min over ω_k > 0 of u(r_k/ω_k) where the smallest counts:

            power        P
            utility      figure(U, Σ ω)
            efficiency   figure(U, Σ ω) / (P/ξ + P_c)

        Args:
            rate: each user's rate (user,) in bit/s.
            power_w: radiated power P.
            cell: for its amplifier efficiency ξ and circuit power P_c.
            weight: ω (user,), 0 for users who count for nothing, whatever they get; None weighs all alike.

        Raises:
            InputError: nobody has a weight above 0.
        """
        return float(self.values(rate, np.array(power_w), cell, weight))

    @final
    def values(self, rate: FloatArray, power_w: FloatArray, cell: Cell, weight: FloatArray | None = None) -> FloatArray:
        """:meth:`value` of many allocations, shape (…), for rates (…, user), powers (…) and one weight (user,)."""
        if self.measure == "power":
            return power_w
        counted: FloatArray = np.ones(rate.shape[-1:]) if weight is None else weight
        counts = counted > 0
        if not counts.any():
            raise InputError(f"nobody's rate counts with the weights {counted}: give a user one above 0")
        omega = counted[counts]
        if self.joined == "min":
            joint = self.utility(rate / np.where(counts, counted, 1.0))[..., counts].min(axis=-1)
        else:
            joint = (omega * self.utility(rate)[..., counts]).sum(axis=-1)
        figure = self.figures(joint, float(omega.sum()))
        if self.measure != "efficiency":
            return figure
        pairs = zip(figure.flat, power_w.flat, strict=True)
        efficiency = [energy_efficiency_bit_per_j(float(worth), float(power), cell) for worth, power in pairs]
        return np.array(efficiency).reshape(figure.shape)

    @final
    def figures(self, utility: FloatArray, weight: float) -> FloatArray:
        """:meth:`figure` of many joint utilities, same shape."""
        if type(self).figure is Objective.figure:
            return np.asarray(utility)
        return np.array([self.figure(float(joint), weight) for joint in np.ravel(utility)]).reshape(np.shape(utility))
