"""One picture of a decision's prices: the water levels, who bids most for a subcarrier, and what the prices prove."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from wirelessagent.deciding.core.dual_bounds import bound_of
from wirelessagent.deciding.core.normal_form import NormalForm
from wirelessagent.deciding.core.priced_worth import priced_worth_w
from wirelessagent.deciding.core.program import MOST_EFFICIENCY, MOST_UTILITY, Program
from wirelessagent.deciding.methods.dual import Dual
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.decision import Decision, Prices
from wirelessagent.model.errors import InputError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.units import prefixed
from wirelessagent.pictures.canvas import PALETTE, Canvas, Panel, can_show, check_suffix

_FLOOR = "#DEDEDE"
_FARTHEST, _NEAREST = 0.5, 0.03
"""How far the price of power is varied, in its logarithm: the wider the gap, the further, for the gap to be seen."""
_MOST_USERS = len(PALETTE)


def draw_prices(*, estimate: ChannelEstimate, decision: Decision, path: Path) -> None:
    """Write the picture of a decision's prices, :func:`prices_canvas`, to ``path``: PNG, SVG or PDF.

    Raises:
        InputError: no prices, nothing allocated, too many users, an unknown suffix, or a path that cannot be written.
        MissingDependencyError: matplotlib is not installed.
    """
    path = Path(path)
    check_suffix(path)
    prices_canvas(estimate=estimate, decision=decision).save(path)


def prices_canvas(*, estimate: ChannelEstimate, decision: Decision) -> Canvas:
    """The picture of a decision's prices, in three panels; subcarriers are counted from 1.

    The inverse gain 1/a of each subcarrier to its owner with the power on top of it, up to the owner's water level, and
    the price λ of the owner's rate; what each subcarrier is worth to each user at the prices, t, with its owner marked;
    and the bound that other prices of power would have proven, beside the value.

    Args:
        estimate: the channel that was decided on.
        decision: of a method that searches prices; at most 8 users.

    Raises:
        InputError: the decision has no prices or allocates nothing, or its users are too many to tell apart.
        MissingDependencyError: matplotlib is not installed.
    """
    if decision.prices is None or not decision.is_usable:
        raise InputError(
            f"the decision of method {decision.method!r} is {decision.status} and "
            f"{'has no prices' if decision.prices is None else 'allocates nothing'}: "
            "give one that does, such as of method dual for a problem with promised rates"
        )
    if estimate.num_users > _MOST_USERS:
        raise InputError(f"prices are drawn for at most {_MOST_USERS} users; got {estimate.num_users}")
    form = NormalForm.of(Dual(), estimate, decision.problem, decision.cell)
    with np.errstate(over="ignore"):
        price = np.exp(decision.prices.log_rate)
    canvas = Canvas(width_in=9.0, height_in=8.0, rows=3, heights=(3.2, 2.6, 1.9))
    _draw_levels(canvas.panels[0], form, decision, price)
    _draw_worths(canvas.panels[1], form, decision, price)
    _draw_bounds(canvas.panels[2], form, decision, decision.prices)
    return canvas


def bids_w(form: NormalForm, price: FloatArray) -> FloatArray:
    """What each group is worth to each user, shape (user, group), in W; NaN where a user can use none of it."""
    usable = np.logical_or.reduceat(form.snr_per_w > 0, form.start[:-1], axis=1)
    return np.where(usable, priced_worth_w(form, form.snr_per_w, price), np.nan)


def _names(decision: Decision) -> list[str]:
    return [name if can_show(name) else f"user {k + 1}" for k, name in enumerate(decision.user_names)]


def _draw_levels(panel: Panel, form: NormalForm, decision: Decision, price: FloatArray) -> None:
    """Floors, water and prices; on the logarithmic scale the depth of the water is the rate in nats."""
    with np.errstate(divide="ignore"):
        inverse = 1.0 / form.snr_per_w
    owner = decision.owner
    served = np.flatnonzero(owner >= 0)
    floor = np.where(owner >= 0, inverse[owner, np.arange(owner.size)], inverse.min(axis=0))
    shown = np.isfinite(floor)
    top = float(max((floor + decision.power_w)[served].max(), price[owner[served]].max()))
    bottom = float(floor[shown].min()) / 3.0
    x = np.arange(1, owner.size + 1)
    panel.scales(y="log")
    panel.columns(x[shown], np.full(int(shown.sum()), bottom), floor[shown], colour=_FLOOR, label="floor 1/a")
    for user, name in enumerate(_names(decision)):
        own = np.flatnonzero((owner == user) & (decision.power_w > 0))
        panel.columns(x[own], floor[own], floor[own] + decision.power_w[own], colour=PALETTE[user], label=name)
    panel.segments(x[served] - 0.45, x[served] + 0.45, price[owner[served]], label="price λ of the owner's rate")
    panel.limits(x=(0.3, owner.size + 0.7), y=(bottom, 6.0 * top))
    panel.describe(
        "Water: power on the owner's 1/a; on this scale its depth is the rate", "Subcarrier", "1/a and power on it (W)"
    )
    panel.legend(columns=2 + form.weight.size, place="upper center")


def _draw_worths(panel: Panel, form: NormalForm, decision: Decision, price: FloatArray) -> None:
    """What the users would bid for each group, and who has it."""
    worth = bids_w(form, price)
    centre = 0.5 * (form.start[:-1] + form.start[1:] - 1) + 1.0
    owner = np.maximum.reduceat(decision.owner, form.start[:-1])
    scale, unit = prefixed(float(np.nanmax(worth)), "W")
    for user in range(form.weight.size):
        panel.path(centre, worth[user] / scale, colour=PALETTE[user])
        own = owner == user
        if own.any():
            panel.marks(centre[own], worth[user, own] / scale, size_pt=7, shape="o", colour=PALETTE[user], label=None)
    panel.grid()
    panel.limits(x=(0.3, decision.owner.size + 0.7))
    what = "subcarrier" if form.start.size - 1 == decision.owner.size else "group of subcarriers"
    panel.describe(f"Bids: what each {what} is worth to each user; dots mark owners", "Subcarrier", f"Worth t ({unit})")


def _draw_bounds(panel: Panel, form: NormalForm, decision: Decision, prices: Prices) -> None:
    """The bound along the price of power, with the users' prices w as they are, and what it leaves open."""
    nats = decision.rate_bps / form.bps_per_nat
    programs = [
        Program.of(form),
        Program.of(form, nats),
    ]  # the search ended with one of them, which tells the unit of μ
    program = min(
        programs, key=lambda one: abs(bound_of(form, one, prices.log_rate, prices.log_power) - decision.bound)
    )
    moving = program.goal in (MOST_UTILITY, MOST_EFFICIENCY)
    reach = min(max(4.0 * math.sqrt(decision.gap), _NEAREST), _FARTHEST)
    steps: FloatArray = np.linspace(-reach, reach, 81)
    bounds = np.array(
        [bound_of(form, program, prices.log_rate - step, prices.log_power + step * moving) for step in steps.tolist()]
    )
    scale, unit = prefixed(max(abs(decision.bound), abs(decision.value)), decision.unit)
    side = "above" if form.objective.direction == "max" else "below"
    ends = decision.value / scale, decision.bound / scale
    panel.path(np.exp(steps), bounds / scale, colour="black", label="bound by other prices of power")
    panel.band(min(ends), max(ends), label="the optimum lies in here")
    panel.level(ends[0], label="value of the decision", colour=PALETTE[1])
    panel.limits(x=(float(np.exp(-reach)), float(np.exp(reach))))
    panel.grid()
    panel.describe(
        f"Proof: no allocation is {side} the curve; the gap is {100 * decision.gap:.2g} %",
        "Price of power, 1 for the one found",
        f"Value ({unit})",
    )
    panel.legend()
