"""What would be otherwise: prices at the margin and what holds a decision back, finite steps, and what can be met."""

from __future__ import annotations

import functools

import numpy as np

from wirelessagent.model.units import human, percent, reliability
from wirelessagent.telling.catalogue import Said, Table, lines_of
from wirelessagent.telling.facts import nearest, steps
from wirelessagent.telling.parts import BEYOND_W, Teller, outcome_in_words

STEP_BPS = 100e3
"""How much more of a promised rate has its price told."""
_WORTH_TELLING = 1e-3


class Prices(Teller):
    """What more of each limit would be worth."""

    @functools.cached_property
    def _slopes(self) -> steps.MarginalPrices:
        return steps.marginal_prices(self.case)

    @property
    def _dearest(self) -> tuple[int, str]:
        """Whose promise costs most, and what 100 kbit/s more of it would cost; empty where none costs anything."""
        cost = np.nan_to_num(np.abs(np.where(self.case.promised_bps > 0, self._slopes.rate, 0.0)))
        user = int(cost.argmax())
        return user, self.worth(float(cost[user]) * STEP_BPS) if cost[user] > 0 else ""

    def told(self) -> str:
        """The prices of power and of the dearest promise."""
        (user, price), dearest, of_power = self._dearest, "", self.case.objective.measure == "power"
        if of_power or np.isnan(self._slopes.power):
            power = self.say("price.power_least" if of_power else "price.power_unknown")
        else:
            power = self._held_by_power("price.power", "price.power_idle")
        if price:
            told = {"user": self.name(user), "figure": self.figure, "price": price}
            direction = self.say("step.up" if self._slopes.rate[user] > 0 else "step.down")
            dearest = self.say("price.dearest", direction=direction, **told)
        elif self.case.promised_bps.any():
            dearest = self.say("price.free")
        sloped = not of_power and self._slopes.power > 0
        return self.joined(power, dearest, self.say("price.slopes") if sloped else "")

    def _held_by_power(self, key: str, idle: str) -> str:
        """What a watt more would be worth, or that it would be worth nothing, or that is not known."""
        price = self._slopes.power
        if price > 0 and self.case.spends_all:
            return self.say(key, figure=self.figure, price=self.worth(price), budget=self.budget)
        return self.say(idle, spent=self.spent, budget=self.budget)

    def table(self) -> tuple[Table, ...]:
        """What 100 kbit/s more would cost for each user with a promise; no table where nobody has one."""
        rows = list[tuple[str, ...]]()
        promised, gets = self.case.promised_bps, self.case.decision.rate_bps
        for user in np.flatnonzero(promised > 0).tolist():
            rates = (human(float(rate[user]), "bit/s") for rate in (promised, gets))
            rows.append((self.name(user), *rates, self.worth(float(self._slopes.rate[user]) * STEP_BPS)))
        columns = tuple(self.say(key) for key in ("label.user", "price.promised", "price.gets", "price.price"))
        return (Table(title=self.say("price.promises"), columns=columns, rows=tuple(rows)),) if rows else ()

    def limits(self) -> str:
        """What holds the value back, each with what it would be worth to have more of it."""
        (user, price), promise = self._dearest, ""
        if price:
            name = self.case.estimate.user_names[user]
            promise = self.say("hindrance.promise", name=name, figure=self.figure, price=price)
        of_power = self.case.objective.measure == "power"
        power = "" if of_power else self._held_by_power("hindrance.power", "hindrance.power_free")
        return self.joined(self._caps(), power, promise, self._most_power()) or self.say("hindrance.nothing")

    def _caps(self) -> str:
        """Who has all that it may have, and what the value would be if it might have more, solved anew."""
        (users, free), value = steps.without_ceilings(self.case), self.case.decision.value
        if free is None:
            return ""
        told = {"names": self.names(users), "figure": self.figure, "value": self.worth(value)}
        if free.is_usable and abs(free.value - value) > _WORTH_TELLING * abs(value):
            return self.say("hindrance.caps", **told, free=self.worth(free.value))
        return self.say("hindrance.caps_idle", **told)

    def _most_power(self) -> str:
        """Who takes most of the power, where several take some."""
        spent = self.case.spent_w
        if np.count_nonzero(spent) < 2:
            return ""
        user = int(spent.argmax())
        power, share = human(float(spent[user]), "W"), percent(float(spent[user] / spent.sum()))
        rate = human(float(self.case.rate_bps[user]), "bit/s")
        return self.say("hindrance.most_power", name=self.name(user), power=power, share=share, rate=rate)


class Steps(Teller):
    """What more of something would change, or less."""

    def more_power(self, step_w: float) -> str:
        """What more power would change; less where it is below zero."""
        step = steps.power_step(self.case, step_w)
        if step is None:
            return self.say("step.no_power", step=human(-step_w, "W"), before=self.budget)
        return self.told(step)

    def more_rate(self, step_bps: float, user: int | None) -> str:
        """What more rate of a user, from 0, or of each user would change."""
        return self.told(steps.rate_step(self.case, step_bps, user))

    def more_in_all(self, step_bps: float | None, share: float | None) -> str:
        """What more rate takes where nobody says whose: of the value where that is one, else of promises and in all."""

        def step_of(whole: float) -> float:
            return (step_bps or 0.0) if share is None else share * whole

        case, decision, promised = self.case, self.case.decision, float(self.case.promised_bps.max())
        if steps.has_reach(case):
            return self._more(decision.value, step_of(decision.value), case.problem.budget_w(case.cell))
        said, total = list[str](), float(decision.rate_bps.sum()) if decision.is_usable else 0.0
        if promised > 0 or not decision.is_usable:
            said.append(self.more_rate(step_of(promised), None))
        if total > 0:
            in_all = Steps(steps.for_the_total(case), self.language)
            said.append(in_all._more(total, step_of(total), decision.total_power_w))
        return self.joined(*said)

    def told(self, step: steps.Step) -> str:
        """What a step changes, and what power would keep the value, in a paragraph."""
        if not (step.before.is_usable and step.after.is_usable):
            said = [self._unmet(step)]
        else:
            kept, budget_w = steps.kept_by(self.case, step), self.case.problem.budget_w(self.case.cell)
            keeping = "" if kept is None else self._reached(kept, "step.kept", before_w=budget_w)
            said = [self._changed(step), keeping, self._bound(step)]
        return self.joined(*said, self._limit(step.limit_w) if step.after.is_usable else "")

    def _limit(self, limit_w: float) -> str:
        """That a power is beyond the cell's limit; empty where it is not."""
        return "" if np.isnan(limit_w) else self.say("step.limit", limit=human(limit_w, "W"))

    def change(self, step: steps.Step) -> str:
        """How the value changes, as in "raise the total rate by 1 Mbit/s (3 %), to 34 Mbit/s"."""
        before, unit = step.before.value, step.before.unit
        value, size = human(step.value_after, unit), human(abs(step.change), unit)
        if step.changes_nothing:
            return self.say("step.keep", figure=self.figure, value=value)
        share = self.say("step.share", share=percent(abs(step.change / before))) if before else ""
        key = "step.raise" if step.change > 0 else "step.lower"
        return self.say(key, figure=self.figure, size=size, share=share, value=value)

    def _changed(self, step: steps.Step) -> str:
        if not step.of_power:
            return self.say("step.rate", who=self._who(step), level=_level(step), change=self.change(step))
        if step.changes_nothing and not self.case.spends_all:
            key = "step.power_least" if self.case.objective.measure == "power" else "step.power_idle"
            return self.say(key, level=_level(step), before=self.budget, spent=self.spent)
        return self.say("step.power", level=_level(step), before=self.budget, change=self.change(step))

    def _more(self, now: float, step: float, spent_w: float) -> str:
        """What power it takes that a value is larger by ``step``, or what a smaller one saves."""
        more = self.say("step.rate_more" if step > 0 else "step.rate_less", step=self.worth(abs(step)))
        if not now + step > 0:
            return self.say("step.nothing_left", step=more, figure=self.figure, before=self.worth(now))
        return self._reached(steps.reach(self.case, now + step), "step.reached", before_w=spent_w, step=more)

    def _reached(self, found: steps.Reach, key: str, *, before_w: float, step: str = "") -> str:
        told = {"figure": self.figure, "target": self.worth(found.target), "step": step}
        if np.isnan(found.power_w):
            return self.say("step.out_of_reach", **told, power=human(found.tried_w, "W"))
        more = found.power_w - before_w
        way, size = self.say("step.more" if more >= 0 else "step.less"), human(abs(more), "W")
        power, share = human(found.power_w, "W"), percent(abs(more) / before_w)
        said = self.say(key, **told, power=power, before=human(before_w, "W"), size=size, share=share, way=way)
        return self.joined(said, self._limit(found.limit_w))

    def _unmet(self, step: steps.Step) -> str:
        who = self._who(step)
        told = self.say("step.of_power" if step.of_power else "step.of_rate", level=_level(step), who=who)
        if not step.before.is_usable and step.after.is_usable:
            return self.say("step.now_met", step=told, outcome=outcome_in_words(step.after, self.language))
        key = "step.no_longer" if step.before.is_usable else "step.still_not"
        return self.say(key, step=told, reason=self.why(step.after))

    def _bound(self, step: steps.Step) -> str:
        """What no allocation could do better, where the decision after the step is not proven optimal."""
        sign = -1.0 if self.case.falls else 1.0
        most = sign * step.most_change
        if step.after.status == "optimal" or sign * step.change < 0 or not np.isfinite(most) or most <= 0:
            return ""
        direction = self.say("step.down" if self.case.falls else "step.up")
        return self.say("step.bound", direction=direction, size=human(most, step.before.unit))

    def _who(self, step: steps.Step) -> str:
        if step.user is not None:
            return self.name(step.user)
        spread = np.ptp(self.case.promised_bps[self.case.served]) > 0
        return self.say("step.everybody_more" if spread else "step.everybody", step=human(step.step, "bit/s"))


def _level(step: steps.Step) -> str:
    return human(step.level, "W" if step.of_power else "bit/s")


class Remedies(Teller):
    """What can be met, of what was asked for or instead of it."""

    def none_needed(self) -> str:
        """What to say where the request can be met."""
        return self.say("remedy.feasible", figure=self.figure, value=self.worth(self.case.decision.value))

    def told(self, found: nearest.Nearest) -> Said:
        """Why a request cannot be met, what it would need, and what can be met instead, a line each."""
        case, more = self.case, found.more_power
        proven = "remedy.proven" if case.decision.status == "infeasible" else "remedy.open"
        ways = [self.say("remedy.way", number=number, way=self._way(way)) for number, way in enumerate(found.ways, 1)]
        ways += [self._way(one) for one in found.without_limits if one not in found.ways]
        beyond = ""
        if more is not None and not more.within_limit and more.power_w <= BEYOND_W:
            limit = human(case.cell.max_power_w, "W")
            beyond = self.say("remedy.beyond", power=human(more.power_w, "W"), limit=limit)
        instead = self.say("remedy.ways") if ways else "" if beyond else self.say("remedy.none")
        head = self.joined(self.say(proven, reason=self.why(case.decision)), instead)
        return lines_of([head, *ways, beyond])

    def _way(self, way: nearest.Way) -> Said:
        """What can be met instead."""
        if isinstance(way, nearest.MorePower):
            return self.say("remedy.power", power=human(way.power_w, "W"))
        outcome, problem = outcome_in_words(way.decision, self.language), self.case.problem
        if isinstance(way, nearest.LowerRates):
            return self._rates(way, outcome)
        if isinstance(way, nearest.WithoutLimit):
            sure = reliability(problem.outage_probability or 0.0)
            return self.say(f"remedy.{way.limit}", outcome=outcome, size=problem.resource_block_group_size, sure=sure)
        kept = [int(user) for user in np.flatnonzero(self.case.served) if user not in way.left_out]
        few = len(kept) < len(way.left_out)
        names = self.names(kept if few else way.left_out)
        fewest = self.say("remedy.fewest") if way.is_fewest and len(way.left_out) > 1 else ""
        return self.say("remedy.only" if few else "remedy.without", names=names, outcome=outcome, fewest=fewest)

    def _rates(self, lower: nearest.LowerRates, outcome: str) -> Said:
        promised, known, most = self.case.promised_bps[self.case.served], np.isfinite(lower.at_most), ""
        if np.ptp(promised) > 0:
            most = self.say("remedy.most_factor", factor=lower.at_most) if known else ""
            return self.say("remedy.factor", factor=lower.factor, outcome=outcome, most=most)
        asked = float(promised[0])
        if known:
            most = self.say("remedy.most", rate=human(asked * lower.at_most, "bit/s"))
        rate = human(asked * lower.factor, "bit/s")
        return self.say("remedy.same", rate=rate, asked=human(asked, "bit/s"), outcome=outcome, most=most)
