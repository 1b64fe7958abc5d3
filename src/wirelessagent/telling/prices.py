"""Prices in words: of power and of promises, and what holds a decision back."""

from __future__ import annotations

import functools

import numpy as np

from wirelessagent.model.units import human, percent
from wirelessagent.telling.facts.marginal_prices import MarginalPrices, marginal_prices
from wirelessagent.telling.facts.steps import without_ceilings
from wirelessagent.telling.parts import Teller
from wirelessagent.telling.told import Table

_STEP_BPS = 100e3
_WORTH_TELLING = 1e-3


class Prices(Teller):
    """What more of each limit would be worth."""

    @functools.cached_property
    def _slopes(self) -> MarginalPrices:
        return marginal_prices(self.case)

    @property
    def _of_power(self) -> str:
        """What a watt more would be worth; empty where it would be worth nothing, or that is not known."""
        price = self._slopes.power
        return self.worth(price) if price > 0 and self.case.spends_all else ""

    @property
    def _dearest(self) -> tuple[int, str]:
        """Whose promise costs most, and what 100 kbit/s more of it would cost; empty where none costs anything."""
        cost = np.nan_to_num(np.abs(np.where(self.case.promised_bps > 0, self._slopes.rate, 0.0)))
        user = int(cost.argmax())
        return user, self.worth(float(cost[user]) * _STEP_BPS) if cost[user] > 0 else ""

    def told(self) -> str:
        """The prices of power and of the dearest promise."""
        (user, price), dearest = self._dearest, ""
        if price:
            direction = self.say("step.up" if self._slopes.rate[user] > 0 else "step.down")
            name = self.name(user)
            dearest = self.say("price.dearest", user=name, direction=direction, figure=self.figure, price=price)
        elif self.case.promised_bps.any():
            dearest = self.say("price.free")
        sloped = self.case.objective.measure != "power" and self._slopes.power > 0
        return self.joined([self._power_told(), dearest, self.say("price.slopes") if sloped else ""])

    def _power_told(self) -> str:
        if self.case.objective.measure == "power":
            return self.say("price.power_least")
        if np.isnan(self._slopes.power):
            return self.say("price.power_unknown")
        if self._of_power:
            return self.say("price.power", figure=self.figure, price=self._of_power, budget=self.budget)
        return self.say("price.power_idle", spent=self.spent, budget=self.budget)

    def table(self) -> tuple[Table, ...]:
        """What 100 kbit/s more would cost for each user with a promise; no table where nobody has one."""
        case, price = self.case, self._slopes.rate
        rows = tuple(
            (
                self.name(user),
                human(float(case.promised_bps[user]), "bit/s"),
                human(float(case.decision.rate_bps[user]), "bit/s"),
                self.worth(float(price[user]) * _STEP_BPS),
            )
            for user in np.flatnonzero(case.promised_bps > 0).tolist()
        )
        columns = tuple(self.say(key) for key in ("label.user", "price.promised", "price.gets", "price.price"))
        return (Table(title=self.say("price.promises"), columns=columns, rows=rows),) if rows else ()

    def limits(self) -> str:
        """What holds the value back, each with what it would be worth to have more of it."""
        (user, price), promise = self._dearest, ""
        if price:
            name = self.case.estimate.user_names[user]
            promise = self.say("hindrance.promise", name=name, figure=self.figure, price=price)
        held = self.joined([self._caps(), self._power_held(), promise, self._most_power()])
        return held or self.say("hindrance.nothing")

    def _caps(self) -> str:
        """Who has all that it may have, and what the value would be if it might have more, solved anew."""
        (users, free), value = without_ceilings(self.case), self.case.decision.value
        if free is None:
            return ""
        told = {"names": self.names(users), "figure": self.figure, "value": self.worth(value)}
        if free.is_usable and abs(free.value - value) > _WORTH_TELLING * abs(value):
            return self.say("hindrance.caps", **told, free=self.worth(free.value))
        return self.say("hindrance.caps_idle", **told)

    def _power_held(self) -> str:
        if self.case.objective.measure == "power":
            return ""
        if self._of_power:
            return self.say("hindrance.power", budget=self.budget, figure=self.figure, price=self._of_power)
        return self.say("hindrance.power_free", budget=self.budget, spent=self.spent)

    def _most_power(self) -> str:
        """Who takes most of the power, where several take some."""
        spent = self.case.spent_w
        if np.count_nonzero(spent) < 2:
            return ""
        user = int(spent.argmax())
        power, share = human(float(spent[user]), "W"), percent(float(spent[user] / spent.sum()))
        rate = human(float(self.case.rate_bps[user]), "bit/s")
        return self.say("hindrance.most_power", name=self.name(user), power=power, share=share, rate=rate)
