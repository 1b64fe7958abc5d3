"""Who gets which rate, weight or service: figures by user, and the users of a request."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, LISTS_OF_USERS, Constraint
from wirelessagent.language.judged import Judged
from wirelessagent.language.mentions import Mention, Role
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.stated import Doubt
from wirelessagent.language.text import Phrases, clause_end, clause_start
from wirelessagent.language.word_tables import either

_SURE_OF_A_ROLE, _SURE_OF_SILENCE, _SURE_OF_NO_ROLE, _SURE_OF_AN_OWNER = 0.55, 0.9, 0.5, 0.45
_SAID = 0.4
_RATES = ("min_rate_bps", "max_rate_bps")
_LEAVING = Phrases(either("figures", "users", "leaving"))
_SILENT = ("kept", "stale")
"""Roles of somebody who is only spoken of."""


@dataclass(frozen=True, kw_only=True)
class Target:
    """Whom a figure is for; ``sure`` unless it may as well be for somebody else."""

    role: Role
    users: tuple[str, ...] = ()
    mention: Mention | None = None
    sure: bool = True

    @property
    def keys(self) -> tuple[str, ...]:
        return self.users or (EVERYBODY,)


@dataclass(kw_only=True)
class _Given:
    value: float
    text: str


class Allotments:
    """What the users of a sentence are given, and which of them it concerns at all."""

    def __init__(self, text: str, plain: str, judged: Judged) -> None:
        self._text, self._plain, self._judged, self._found = text, plain, judged, judged.mentions
        self._given: dict[str, dict[str, _Given]] = {name: {} for name in FIGURES_OF_USERS}
        self._lists: dict[str, dict[str, str]] = {"users": {}, "leave_out": {}, "back": {}}
        self._used: set[Mention] = set()
        self._conflicts: list[Doubt] = []
        self._unsure: list[Mention] = []
        self._excepted: list[Mention] = []
        self._of_others: set[str] = set()
        self.spans: list[tuple[int, int]] = []
        self.marks: list[tuple[int, int, str]] = []
        self._roles: dict[Mention, str] = {}
        self._likely: dict[Mention, str] = {}
        for mention in self._found:
            role = self._assign(mention) if mention.role in ("named", "pronoun") else mention.role
            self.marks.append((mention.start, mention.end, role + "+" * (len(mention.users) > 1)))
        self._one_each = dict(self._one_for_each())
        for number in judged.weights:
            self._weigh(number)
            self.marks.append((number.start, number.end, "weight"))

    def _assign(self, mention: Mention) -> str:
        """Note what somebody is there for, which is given back."""
        role = self._likeliest(mention)
        users = self._meant_by(mention).users if mention.role == "pronoun" else mention.users
        if role == "given" or not users:
            return role
        if role in ("exempt", "unclear"):
            self._unsure.append(mention)
            if role == "exempt":
                self._excepted.append(mention)
                self._mask_a_clause(mention)
            return role
        self._used.add(mention)
        self._used.update([self._meant_by(mention).mention or mention] if mention.role == "pronoun" else [])
        start, end = self._judged.telling(mention, role)
        self.spans.append((start, end))
        if role not in _SILENT:
            self._roles[mention] = role
            for user in users:
                self._lists[role][user] = self._text[start:end]
        return role

    def _mask_a_clause(self, mention: Mention) -> None:
        """A clause that only says to whom nothing is promised wishes nothing: "user 7 has no least rate"."""
        start, end = clause_start(self._plain, mention.start), clause_end(self._plain, mention.end)
        if not any(start <= figure.start < end for figure in self._judged.figures):
            self.spans.append((start, end))

    def _exempt(self) -> None:
        """A floor of zero for whoever is excepted where all others have one, and nothing else may be meant.

        Whoever has a cap alone where "the others" have a floor has none either.
        """
        floors, caps = (self._given[name] for name in _RATES)
        if EVERYBODY not in floors or EVERYBODY in caps:
            return
        for mention in self._excepted:
            if not any(user in floors for user in mention.users):
                self._used.add(mention)
                self._unsure.remove(mention)
                text = self._text[mention.start : mention.end]
                floors.update({user: _Given(value=0.0, text=text) for user in mention.users})
        if "min_rate_bps" in self._of_others:
            for user in [user for user in caps if user not in floors]:
                floors[user] = _Given(value=0.0, text=caps[user].text)

    def _write_out_the_others(self) -> None:
        """A ceiling of the others becomes one of each of them, where users are named who have none."""
        caps = self._given["max_rate_bps"]
        free = [user for user in self.named if user not in caps]
        others = [user for user in self._judged.users_of_the_cell if user not in (*free, *caps)]
        if "max_rate_bps" in self._of_others and EVERYBODY in caps and free and others:
            own = {user: given for user, given in caps.items() if user != EVERYBODY}
            self._given["max_rate_bps"] = dict.fromkeys(others, caps[EVERYBODY]) | own

    def _likeliest(self, mention: Mention) -> str:
        """What somebody is there for; without certainty it is unclear."""
        chances, said = self._judged.user(mention), self._judged.said_of(mention)
        if said["exempt"] > _SURE_OF_A_ROLE:  # whatever rate stands beside it is that of all others
            return "exempt"
        role = self._likely[mention] = max(chances, key=lambda each: chances[each])
        sure = _SURE_OF_SILENCE if role in _SILENT else _SURE_OF_A_ROLE  # nobody is to be dropped unheard
        unsaid = role == "leave_out" and _LEAVING.search(self._plain) is None  # "user 3 has priority"
        if role == "given" or (chances[role] > sure and said[role] > _SAID and not unsaid):
            return role
        return "unclear" if mention.role == "named" and chances["given"] < _SURE_OF_NO_ROLE else "given"

    def _meant_by(self, pronoun: Mention) -> Target:
        named = [other for other in self._found if other.role == "named" and other.end <= pronoun.start]
        return Target(role="named", users=named[-1].users, mention=named[-1]) if named else Target(role="everybody")

    def _one_for_each(self) -> Iterator[tuple[int, Target]]:
        """The figures of lists as long as a list of users, one for each: "users 1 and 4 get 2 and 3 Mbit/s"."""
        for starts in self._judged.lists:
            able = [m for m in self._found if len(m.users) == len(starts) and self._roles.get(m) != "leave_out"]
            chances = [self._judged.owners(start, able) for start in starts]
            best = max(able, key=lambda mention: sum(each[mention] for each in chances), default=None)
            if best is not None:
                for start, user in zip(starts, best.users, strict=True):
                    yield start, Target(role="named", users=(user,), mention=best)

    def target_of(self, start: int) -> Target:
        """Whom the figure at ``start`` is for, which are none of those who are left out."""
        if start in self._one_each:
            return self._one_each[start]
        candidates = [
            mention
            for mention in self._found
            if self._roles.get(mention, "none") != "leave_out" and mention not in self._excepted
        ]
        chances = self._judged.owners(start, candidates)
        target = self._target(max(chances, key=lambda mention: chances[mention]))
        same = [chance for mention, chance in chances.items() if self._are_the_same(self._target(mention), target)]
        sure = sum(same) > _SURE_OF_AN_OWNER
        return Target(role=target.role, users=target.users, mention=target.mention, sure=sure)

    def _are_the_same(self, one: Target, other: Target) -> bool:
        """Whether two targets are the same users; everybody are those who are served alone."""
        served = set(self._lists["users"])
        return set(one.keys) == set(other.keys) or {*one.keys, *other.keys} == {EVERYBODY, *served}

    def _target(self, mention: Mention | None) -> Target:
        if mention is None:
            return Target(role="everybody")
        if mention.role == "pronoun":
            return self._meant_by(mention)
        return Target(role=mention.role, users=mention.users, mention=mention)

    def _weigh(self, number: Number) -> None:
        target = self.target_of(number.start)
        if target.sure and target.role in ("named", "others") and number.value is not None:
            self._used.update([target.mention] if target.mention is not None else [])
            self.spans.append((number.start, number.end))
            given = _Given(value=float(number.value), text=self._text[number.start : number.end])
            for user in target.keys:
                first = self._given["weights"].setdefault(user, given)
                if first.value != given.value:
                    self._conflicts.append(Doubt(key="conflict", names={"one": first.text, "other": given.text}))

    @property
    def back(self) -> tuple[str, ...]:
        return tuple(self._lists["back"])

    @property
    def named(self) -> tuple[str, ...]:
        users = [user for mention in self._found if mention.role == "named" for user in mention.users]
        return tuple(dict.fromkeys(users))

    def give(self, name: str, target: Target, figure: Quantity) -> str | None:
        """Note a rate for its users; the words of an earlier one that contradicts it, or None."""
        if target.mention is not None:
            self._used.add(target.mention)
            if target.role == "named":
                self.spans.append((target.mention.start, target.mention.end))
        if target.role == "others":
            self._of_others.add(name)
        for key in target.keys:
            earlier = self._given[name].get(key)
            if earlier is not None and earlier.value != figure.value:
                return earlier.text
            self._given[name][key] = _Given(value=figure.value, text=figure.text)
        return None

    def take_users(self) -> Iterator[tuple[int, int]]:
        """The named users of whom nothing was said, or nothing certain, as spans."""
        self._exempt()
        self._write_out_the_others()
        spoken_of = {user for mention in self._used for user in mention.users} | set(self._given["weights"])
        for mention in self._found:
            if mention.role != "named":
                continue
            self.spans.append((mention.start, mention.end))
            unsure = mention in self._unsure and not self._said_elsewhere(mention)
            if unsure or not spoken_of.issuperset(mention.users) or self._is_at_odds(mention):
                yield mention.start, mention.end

    def _is_at_odds(self, mention: Mention) -> bool:
        """Whether somebody has a rate elsewhere and is left out here: "user 3 needs 1 Mbit/s but drop user 3".

        The same where they are served alone elsewhere, and here left out by all likelihood.
        """
        rated = {user for name in _RATES for user, each in self._given[name].items() if each.value > 0}
        if self._roles.get(mention) == "leave_out" and not rated.isdisjoint(mention.users):
            return True
        return self._likely.get(mention) == "leave_out" and not self._lists["users"].keys().isdisjoint(mention.users)

    def _said_elsewhere(self, mention: Mention) -> bool:
        """Whether everybody of a mention is settled by another, or by a weight."""
        others = {user for other in self._used if other != mention for user in other.users}
        return others.union(self._given["weights"]).issuperset(mention.users)

    def values(self) -> dict[str, Constraint]:
        values: dict[str, Constraint] = {}
        for name, given in self._given.items():
            figures = {user: each.value for user, each in given.items()}
            if name == "weights" and (figures.get(EVERYBODY) == 1 or set(figures) == {EVERYBODY}):
                del figures[EVERYBODY]  # "all others 1" is what they count anyway
            if set(figures) == {EVERYBODY}:
                values[name] = figures[EVERYBODY]
            elif figures:
                values[name] = figures if name == "weights" else self._of_all_served(figures)
        return values | {name: tuple(self._lists[name]) for name in LISTS_OF_USERS if self._lists[name]}

    def _of_all_served(self, figures: dict[str, float]) -> Constraint:
        """Rates by user; one figure where it is that of everybody who is served."""
        same = len(set(figures.values())) == 1 and set(figures) == set(self._lists["users"])
        return next(iter(figures.values())) if same else figures

    def evidence(self) -> dict[str, str]:
        words = {name: [each.text for each in self._given[name].values()] for name in _RATES}
        words |= {name: list(self._lists[name].values()) for name in LISTS_OF_USERS}
        words["weights"] = [each.text for each in self._given["weights"].values()]
        return {name: " … ".join(dict.fromkeys(texts)) for name, texts in words.items() if texts}

    def crossed(self) -> Iterator[Doubt]:
        """The questions that figures raise which cannot hold together."""
        yield from self._conflicts
        low, high = (self._given[name] for name in _RATES)
        for user in low | high:
            least, most = low.get(user, low.get(EVERYBODY)), high.get(user, high.get(EVERYBODY))
            if least is not None and most is not None and least.value > most.value:
                yield Doubt(key="rates_crossed", names={"low": least.text, "high": most.text})
        both = [user for user in self._lists["users"] if user in self._lists["leave_out"]]
        if both:
            one, other = (self._lists[name][both[0]] for name in ("users", "leave_out"))
            yield Doubt(key="conflict", names={"one": one, "other": other})
