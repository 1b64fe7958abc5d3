"""A user's account in words."""

from __future__ import annotations

import numpy as np

from wirelessagent.model.units import human, percent
from wirelessagent.telling.facts.accounts import PROMISE_BPS, Account, Loss, account, newcomer, share
from wirelessagent.telling.parts import Teller, place
from wirelessagent.telling.reasons import reason_in_words
from wirelessagent.telling.step_effects import Steps

_TIE_DB = 0.05
_KNOWN_DB = 0.1
_STEP_BPS = 100e3
_FACTOR = 1.0005


class Accounts(Teller):
    """What users have, and why."""

    def why(self, user: int) -> str:
        """What a user, from 0, has and why, in a paragraph."""
        found = account(self.case, user)
        losses = self._loss(found.losses[0]) if found.losses else []
        return self.joined([self._head(found), *self._served(found), *losses, self._promise(found)])

    def share(self, user: int) -> str:
        """What a user has, in a few sentences."""
        found = share(self.case, user)
        return self.joined([self._head(found), *self._served(found)])

    def newcomer(self) -> str:
        """What one more user would bring: the one of those left out with whom the value is best."""
        found = newcomer(self.case)
        return self.say("account.all_served", users=self.case.num_users) if found is None else self._head(found)

    def _head(self, found: Account) -> str:
        case, total = self.case, self.case.decision.total_power_w
        said = self.say(
            f"account.{found.standing}", name=self.name(found.user), rate=self._rate(found),
            power=human(found.power_w, "W"), share=percent(found.power_w / total if total > 0 else 0.0),
            count=found.subcarriers, total=case.decision.owner.size,
            reason=reason_in_words(case.decision, self.language),
            places=case.form.start.size - 1, users=int(np.count_nonzero(case.form.weight > 0)),
        )  # fmt: skip
        return said if found.included is None else self.joined([said, self._included(found)])

    def _included(self, found: Account) -> str:
        included = found.included
        assert included is not None
        if not included.is_usable:
            return self.say("account.included_none", reason=reason_in_words(included, self.language))
        rate = human(float(included.rate_bps[found.user]), "bit/s")
        power = human(float(included.power_w[included.owner == found.user].sum()), "W")
        value, before = human(included.value, included.unit), self.worth(self.case.decision.value)
        return self.say("account.included", rate=rate, power=power, figure=self.figure, value=value, before=before)

    def _rate(self, found: Account) -> str:
        """What a user gets, as what it must get where it is no more than that."""
        rate = human(found.rate_bps, "bit/s")
        due = found.promised_bps > 0 and _exactly(found)
        return self.say(f"account.exactly_{self.case.problem.firmness}", rate=rate) if due else rate

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
            price = found.price_per_bps * _STEP_BPS
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
        said: list[str] = [
            self.say(key, behind=behind, place=place(loss.first, loss.last, self.language), winner=winner)
        ]
        if key != "account.behind":
            return said
        if np.isnan(loss.chance):
            return [*said, self.say("account.gain_measured")]
        if loss.repaired and max(abs(loss.low_db), abs(loss.high_db)) < _KNOWN_DB:
            return [*said, self.say("account.gain_close")]
        kind = "account.gain_repaired" if loss.repaired else "account.gain_noisy"
        chance = percent(loss.chance) if loss.chance > 0 else "< 0.1 %"
        return [*said, self.say(kind, low=loss.low_db, high=loss.high_db, chance=chance)]

    def _promise(self, found: Account) -> str:
        """What a small promise would give a user who has nothing, and cost."""
        step, rate = found.promise, human(PROMISE_BPS, "bit/s")
        if step is None:
            return ""
        if not step.after.is_usable:
            return self.say("account.promise_none", rate=rate, reason=reason_in_words(step.after, self.language))
        count = int(((step.after.owner == found.user) & (step.after.power_w > 0)).sum())
        total, change = step.after.owner.size, self.by(Steps).change(step)
        return self.say("account.promise", rate=rate, count=count, total=total, change=change)


def _exactly(found: Account) -> bool:
    return not found.rate_bps > found.promised_bps * _FACTOR
