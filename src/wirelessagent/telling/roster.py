"""Who has what, and why: the least and the most, subcarriers and the channel there, and the account of a user."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.arrays import FloatArray, IntArray
from wirelessagent.model.units import db, human, percent
from wirelessagent.telling.catalogue import called, lines_of
from wirelessagent.telling.facts.accounts import PROMISE_BPS, Account, Loss, account, newcomer, share
from wirelessagent.telling.facts.case import BAND, in_use
from wirelessagent.telling.margins import STEP_BPS, Steps
from wirelessagent.telling.parts import Teller

_SAME = 1e-3
"""A share of a figure that does not show in it."""
_SHOWN_DB, _TIE_DB = 0.1, 0.05
"""What shows in one decimal, and a margin that does not."""
_FACTOR = 1.0005


class Roster(Teller):
    """Users, their subcarriers and their gains; what there is nothing to say of is empty."""

    def overview(self) -> str:
        """How many users are served, and who gets the least and the most."""
        count = int(np.count_nonzero(self.case.decision.rate_bps > 0))
        ranks = dict.fromkeys(self._edge(rank, "rate")[0] for rank in ("least", "most"))
        return self.joined(self.say("roster.served", served=count, users=self.case.num_users), *ranks)

    def rank(self, rank: str, of: str) -> str:
        """Who of those served gets the "least" or the "most" of "rate", "power" or "subcarriers", and who is next."""
        said, others = self._edge(rank, of)
        return self.joined(said, self._next(others, of))

    def _edge(self, rank: str, of: str) -> tuple[str, IntArray]:
        """Who gets the least or the most, and the others in their order, where they get any and not all the same."""
        users, size = np.flatnonzero(self.case.served), self._sizes(of)
        order = users[np.argsort(size[users] if rank == "least" else -size[users], kind="stable")]
        nobody, some = users[size[users] <= 0], order[size[order] > 0]
        if rank == "least" and nobody.size:
            nothing = self.say("roster.nothing", names=self.names(nobody.tolist()), gets=self._gets(nobody))
            return nothing, some
        first, what, figure = _alike(order, size), self.say(f"roster.of_{of}"), _size(float(size[order[0]]), of)
        if first.size == users.size > 1:
            return self.say("roster.all_same", count=users.size, what=what, size=figure), some[:0]
        told = {"names": self.names(first.tolist()), "gets": self._gets(first), "size": figure, "what": what}
        return self.say(f"roster.{rank}", **told, further=self._further(first, of)), some[~np.isin(some, first)]

    def _next(self, order: IntArray, of: str) -> str:
        """Who comes next, at the head of ``order``."""
        if not order.size:
            return ""
        size = self._sizes(of)
        following = _alike(order, size)
        verb = self.say("roster.is_one" if following.size == 1 else "roster.is_several")
        names, figure = self.names(following.tolist()), _size(float(size[order[0]]), of)
        return self.say("roster.next", is_=verb, names=names, size=figure)

    def _gets(self, users: IntArray) -> str:
        return self.say("roster.one" if users.size == 1 else "roster.several")

    def _further(self, users: IntArray, of: str) -> str:
        """What else a user has; nothing more of several."""
        if users.size > 1:
            return self.say("roster.further_of_each")
        user, case = int(users[0]), self.case
        rate, power = human(float(case.rate_bps[user]), "bit/s"), human(float(case.spent_w[user]), "W")
        total, count = case.decision.owner.size, int(self._sizes("subcarriers")[user])
        return self.say(f"roster.further_{of}", total=total, rate=rate, power=power, count=count)

    def _sizes(self, of: str) -> FloatArray:
        """What each user has, in bit/s, W or subcarriers, shape (user,)."""
        case = self.case
        if of == "subcarriers":
            return np.array([np.count_nonzero(case.own(user)) for user in range(case.num_users)], dtype=np.float64)
        return case.rate_bps if of == "rate" else case.spent_w

    def subcarriers(self, user: int | None) -> str:
        """The subcarriers of a user, or of everybody."""
        total, free = self.case.decision.owner.size, np.flatnonzero(self.case.decision.power_w <= 0)
        own = [np.flatnonzero(self.case.own(each)) for each in range(self.case.num_users)]
        if user is not None:
            key, places = "roster.has" if own[user].size else "roster.has_none", self._places(own[user])
            return self.say(key, name=self.name(user), count=own[user].size, total=total, places=places)
        told = ((self.name(each), self._places(some), some.size) for each, some in enumerate(own) if some.size)
        rows = [self.say("roster.row", name=name, places=places, count=count) for name, places, count in told]
        unused = self.say("roster.unused", places=self._places(free), count=free.size) if free.size else ""
        return lines_of([self.say("roster.all", total=total), *rows, unused])

    def _places(self, subcarriers: IntArray) -> str:
        """Subcarriers counted from 1, neighbours together: "1–3, 7"."""
        runs = np.split(subcarriers + 1, np.flatnonzero(np.diff(subcarriers) > 1) + 1)
        ends = [(run[0], run[-1]) for run in runs if run.size]
        said = [str(one) if one == end else self.say("roster.range", first=one, last=end) for one, end in ends]
        return self.say("text.comma").join(said)

    def owner(self, place: int) -> str:
        """Who has a subcarrier, counted from 1."""
        decision = self.case.decision
        if not 1 <= place <= decision.owner.size:
            return self.say("roster.no_such", place=place, total=decision.owner.size)
        if place - 1 not in self.case.used:
            return self.say("roster.no_owner", place=place)
        power, name = human(float(decision.power_w[place - 1]), "W"), self.name(int(decision.owner[place - 1]))
        return self.say("roster.owner", place=place, name=name, power=power)

    def gain(self, user: int | None, place: int | None) -> str:
        """The gain of a user, else of the owner, on the subcarrier ``place`` (from 1), or of a user over all."""
        decision, estimate = self.case.decision, self.case.estimate
        if place is None:
            assert user is not None
            return self._over_all(user)
        if not 1 <= place <= estimate.num_subcarriers:
            return self.say("roster.no_such", place=place, total=estimate.num_subcarriers)
        if user is None:
            user = int(decision.owner[place - 1]) if decision.is_usable else -1
            user = user if user >= 0 else int(estimate.gain[:, place - 1].argmax())
        name, at, gain = self.name(user), (user, place - 1), float(estimate.gain[user, place - 1])
        if gain <= 0:
            return self.say("gain.none_at", name=name, place=place)
        low, high = (float(db(estimate.posterior.quantile(each)[at], floor_db=-200)) for each in BAND)
        key = "gain.repaired" if estimate.repaired[at] else "gain.noisy"
        key = key if estimate.gain_variance[at] > 0 else "gain.measured"
        key = key if high - low >= _SHOWN_DB else f"{key}_close"
        how = self.say(key, low=low, high=high, method=called(self.language, estimate.method))
        return self.joined(self.say("gain.at", name=name, place=place, gain=float(db(gain)), how=how), self._owner(*at))

    def _owner(self, user: int, subcarrier: int) -> str:
        """Who has the subcarrier, counted from 0, with which SNR there."""
        decision, gain = self.case.decision, self.case.estimate.gain
        if not decision.is_usable:
            return ""
        if subcarrier not in self.case.used:
            return self.say("gain.idle", snr=self._snr_db(gain[user, subcarrier], 1.0))
        owner, power = int(decision.owner[subcarrier]), float(decision.power_w[subcarrier])
        snr = self._snr_db(gain[owner, subcarrier], power)
        return self.say("gain.carries", owner=self.name(owner), snr=snr, power=human(power, "W"))

    def _over_all(self, user: int) -> str:
        estimate, decision, gain = self.case.estimate, self.case.decision, self.case.estimate.gain[user]
        if not gain.max() > 0:
            return self.say("gain.nothing", name=self.name(user))
        low, high, mean = (float(db(each)) for each in (gain[gain > 0].min(), gain.max(), gain.mean()))
        missing, own, snr_said = int(estimate.repaired[user].sum()), np.flatnonzero(self.case.own(user)), ""
        told = {"low": low, "high": high, "mean": mean, "missing": missing, "total": gain.size}
        if decision.is_usable and own.size:
            snr = [self._snr_db(gain[each], float(decision.power_w[each])) for each in own]
            power, key = human(float(decision.power_w[own].sum()), "W"), "gain.snr_one" if own.size == 1 else "gain.snr"
            snr_said = self.say(key, low=min(snr), high=max(snr), count=own.size, power=power)
        elif decision.is_usable:
            snr_said = self.say("gain.snr_none", best=self._snr_db(gain.max(), 1.0))
        return self.joined(self.say("gain.over_all", name=self.name(user), **told), snr_said)

    def _snr_db(self, gain: float, power_w: float) -> float:
        """p g/(N0 B) in dB, before the coding gap."""
        return float(db(power_w * gain / self.case.cell.noise_power_w, floor_db=-200))


def _alike(order: IntArray, size: FloatArray) -> IntArray:
    """The users at the head of ``order`` who have the same, by their numbers."""
    head = float(size[order[0]])
    return np.sort(order[np.abs(size[order] - head) <= _SAME * head])


def _size(value: float, of: str) -> str:
    return f"{value:.0f}" if of == "subcarriers" else human(float(value), "W" if of == "power" else "bit/s")


class Accounts(Teller):
    """What users have, and why."""

    def told(self, user: int) -> str:
        """What a user, from 0, has and why, in a paragraph."""
        found = account(self.case, user)
        losses = self._loss(found.losses[0]) if found.losses else []
        return self.joined(self._head(found), *self._served(found), *losses, self._promise(found))

    def share(self, user: int) -> str:
        """What a user has, in a few sentences."""
        found = share(self.case, user)
        return self.joined(self._head(found), *self._served(found))

    def newcomer(self) -> str:
        """What one more user would bring: the one of those left out with whom the value is best."""
        found = newcomer(self.case)
        return self.say("account.all_served", users=self.case.num_users) if found is None else self._head(found)

    def _head(self, found: Account) -> str:
        case, total = self.case, self.case.decision.total_power_w
        rate, due = human(found.rate_bps, "bit/s"), found.promised_bps > 0 and _exactly(found)
        rate = self.say(f"account.exactly_{case.problem.firmness}", rate=rate) if due else rate
        said = self.say(
            f"account.{found.standing}", name=self.name(found.user), rate=rate,
            power=human(found.power_w, "W"), share=percent(found.power_w / total if total > 0 else 0.0),
            count=found.subcarriers, total=case.decision.owner.size, reason=self.why(case.decision),
            places=case.form.start.size - 1, users=int(np.count_nonzero(case.form.weight > 0)),
        )  # fmt: skip
        return self.joined(said, self._included(found))

    def _included(self, found: Account) -> str:
        """What a user who is left out would get and bring; empty of any other."""
        included = found.included
        if included is None:
            return ""
        if not included.is_usable:
            return self.say("account.included_none", reason=self.why(included))
        rate = human(float(included.rate_bps[found.user]), "bit/s")
        power = human(float(included.power_w[included.owner == found.user].sum()), "W")
        value, before = human(included.value, included.unit), self.worth(self.case.decision.value)
        return self.say("account.included", rate=rate, power=power, figure=self.figure, value=value, before=before)

    def _served(self, found: Account) -> list[str]:
        """How sure a user's rate is, what it was promised, and on what it rests; nothing of who has none."""
        if found.standing != "served":
            return []
        said: list[str] = []
        forecast, user = self.case.decision.forecast, found.user
        if forecast is not None and forecast.high_bps[user] > forecast.low_bps[user] * _FACTOR:
            low, high = (human(float(one[user]), "bit/s") for one in (forecast.low_bps, forecast.high_bps))
            said += [self.say("account.band", low=low, high=high)] if low != high else []
        if found.promised_bps > 0:
            price = found.price_per_bps * STEP_BPS
            key = "account.beyond" if not price > 0 else "account.binds" if _exactly(found) else "account.above"
            promised = human(found.promised_bps, "bit/s")
            due = self.say(f"account.due_{self.case.problem.firmness}", promised=promised)
            said.append(self.say(key, due=due, price=self.worth(price)))
        key = "account.resting" if found.resting else "account.resting_none" if found.repaired else "account.measured"
        rest = {"repaired": found.repaired, "entries": found.entries, "resting": found.resting}
        return [*said, self.say(key, **rest, count=found.subcarriers)]

    def _loss(self, loss: Loss) -> list[str]:
        """Where a user lost, by how much, and how sure that is."""
        behind, winner = abs(loss.behind_db), self.name(loss.winner)
        key = "account.tie" if behind < _TIE_DB else "account.behind" if loss.behind_db > 0 else "account.more"
        said = self.say(key, behind=behind, place=self.place(loss.first, loss.last), winner=winner)
        if key != "account.behind":
            return [said]
        if np.isnan(loss.chance):
            return [said, self.say("account.gain_measured")]
        if loss.repaired and max(abs(loss.low_db), abs(loss.high_db)) < _SHOWN_DB:
            return [said, self.say("account.gain_close")]
        kind = "account.gain_repaired" if loss.repaired else "account.gain_noisy"
        chance = percent(loss.chance) if loss.chance > 0 else "< 0.1 %"
        return [said, self.say(kind, low=loss.low_db, high=loss.high_db, chance=chance)]

    def _promise(self, found: Account) -> str:
        """What a small promise would give a user who has nothing, and cost."""
        step, rate = found.promise, human(PROMISE_BPS, "bit/s")
        if step is None:
            return ""
        if not step.after.is_usable:
            return self.say("account.promise_none", rate=rate, reason=self.why(step.after))
        count = int(np.count_nonzero(in_use(step.after) == found.user))
        total, change = step.after.owner.size, self.by(Steps).change(step)
        return self.say("account.promise", rate=rate, count=count, total=total, change=change)


def _exactly(found: Account) -> bool:
    return not found.rate_bps > found.promised_bps * _FACTOR
