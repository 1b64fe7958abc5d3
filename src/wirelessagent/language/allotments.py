"""Who gets which rate, weight or service: figures by user, and the users of a request."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass

from wirelessagent.language.clauses import clause_end, clause_start, cuts_between
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import EVERYBODY, Constraint
from wirelessagent.language.judged import Judged
from wirelessagent.language.mentions import Mention, Role
from wirelessagent.language.numerals import Number
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.standings import (
    Standing,
    UserRole,
    exception_of,
    is_something_of,
    promised_nothing,
    role_of,
)
from wirelessagent.language.surroundings import CORRECTION

_SURE_OF_A_ROLE, _SURE_OF_NO_ROLE, _SURE_OF_AN_OWNER = 0.55, 0.5, 0.45
_AT_ODDS = 0.15
_SAID = 0.4
_NEAR = 30

_SERVED = deferred(r"(?i)\b(?:serv(?:e|es|ing)|sirv\w*|atiend\w*|bedien\w*)\b|服务")
_COMPARED = deferred(
    r"(?i)\s*(?:(?:is|be|must|should|may|gets?|goes|go|no|not|never|stays?)\s+)*(?:(?:faster|slower|more|less|better|higher|lower)\s+"
    r"than|above|below|over|under|ahead\s+of|behind)\s+|\s*(?:也|都|要|得)?(?:不|别|不能|不得|不许)?(?:能|得|要)?(?:超过|高于|低于|"
    r"快于|慢于|大于|小于|多于|少于|快过|比)\s*"
)
_LEADING = deferred(r"(?i)\s*(?:以外|之外|除外|外|aside|excepted|ausgenommen)?\s*")
_INSERTED = deferred(r"\s*[,(\uff0c][^,;()\uff0c]{0,24}")
_COLLECTIVE = ("everybody", "others")
_AT_ONCE = deferred(  # what may stand between an exception that leads and what all get
    r"(?i)\s*(?:(?:please|give|grant|guarantee|promise|ensure|keep|let|hold|with|and|there|is|a|must|should|da|dales|"
    r"garantiza|donne|donnez|garantis|gib|gebt|garantiere)\s+)*(?:给|让|保证|确保|保障|保|请|都|要|得|满足)*\s*"
)


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
    end: int


class Allotments:
    """What the users of a sentence are given, and which of them it concerns at all."""

    def __init__(self, text: str, plain: str, judged: Judged) -> None:
        self._text, self._plain, self._judged, self._found = text, plain, judged, judged.mentions
        self._rates: dict[str, dict[str, _Given]] = {"min_rate_bps": {}, "max_rate_bps": {}}
        self._lists: dict[str, dict[str, str]] = {"users": {}, "leave_out": {}, "back": {}}
        self._used: set[Mention] = set()
        self._unsure: list[Mention] = []
        self._excepted: dict[Mention, Standing] = {}
        self.exact: set[str] = set()
        self._of_others = False
        named = [mention for mention in self._found if mention.role == "named"]
        pairs = [pair for pair in itertools.pairwise(named) if _COMPARED.fullmatch(plain, pair[0].end, pair[1].start)]
        self._compared = {mention for pair in pairs for mention in pair}
        self.spans: list[tuple[int, int]] = []
        self._roles: dict[Mention, UserRole] = {}
        for mention in self._found:
            if mention.role in ("named", "pronoun"):
                self._assign(mention)
        self._one_each = dict(self._one_for_each())
        self._weights: dict[str, tuple[float, tuple[int, int]]] = {}
        for number in judged.weights:
            self._weigh(number)

    def _assign(self, mention: Mention) -> None:
        if mention in self._compared:  # "3号不超过2号"
            self._unsure.append(mention)
            return
        standing = exception_of(self._plain, mention.start, mention.end) if mention.role == "named" else ""
        if self._is_settled(mention, standing):
            return
        role, start, end = role_of(self._plain, mention.start, mention.end)
        users = mention.users
        if mention.role == "pronoun":
            users = self._meant_by(mention).users
        if standing in ("leaves", "alone"):
            role = "leave_out" if standing == "leaves" else "users"
        elif role != "back":
            likeliest = self._likeliest(mention)
            if standing == "excepted" and likeliest == "users" != role:
                likeliest = "leave_out"  # "everyone but 4 and 5"
            role, start, end = (role, start, end) if likeliest == role else (likeliest, mention.start, mention.end)
        if role == "none" or not users:
            return
        self._roles[mention] = role
        self._used.add(mention)
        self._used.update([self._meant_by(mention).mention or mention] if mention.role == "pronoun" else [])
        self.spans.append((start, end))
        for user in self._corrected_users(mention, role):
            self._lists[role].pop(user, None)
        for user in users:
            self._lists[role][user] = self._text[start:end].strip()

    def _corrected_users(self, mention: Mention, role: UserRole) -> tuple[str, ...]:
        """Those named just before whom somebody replaces: "leave user 5 out, no, user 6"."""
        last = max((m for m in self._found if m.end <= mention.start), key=lambda m: m.end, default=None)
        if last is None or self._roles.get(last) != role or mention.start - last.end > _NEAR:
            return ()
        corrected = CORRECTION.search(self._plain, last.end, mention.start)
        return last.users if corrected is not None else ()

    def _is_settled(self, mention: Mention, standing: Standing) -> bool:
        """Whether somebody is an exception: kept, who needs nothing, or excepted from a rate, of which more is said."""
        if standing == "kept":
            for user in mention.users:
                self._lists["leave_out"].pop(user, None)
            self._used.add(mention)
            self.spans.append((mention.start, mention.end))
            return True
        rated = any(figure.kind == "rate" for figure in self._judged.figures)
        if (rated and standing in ("exempt", "uncapped")) or (
            standing == "excepted" and self._is_excepted_from_a_rate(mention)
        ):
            self._unsure.append(mention)
            self._excepted[mention] = standing
            return True
        return False

    def _is_excepted_from_a_rate(self, mention: Mention) -> bool:
        """Whether an exception is one from a rate beside it, which may stand before: "1 Mbit/s each, not user 3".

        With a rate on either side it has one of its own: "1 Mbit/s each but users 2 and 3 should have 3".
        """
        rates = [figure for figure in self._judged.figures if figure.kind == "rate"]
        first = clause_start(self._plain, mention.start)
        if _SERVED.search(self._plain, first, mention.start):
            return False  # "serve everyone but user 3": an exception from service
        of_all = any(m.role in _COLLECTIVE and first <= m.start < mention.start for m in self._found)
        before = [cuts_between(self._plain, f.end, mention.start) for f in rates if f.end <= mention.start]
        after = [f for f in rates if f.start >= mention.end and not cuts_between(self._plain, mention.end, f.start)]
        stated = 0 in before or (1 in before and not of_all)
        return stated != (bool(after) or self._leads_to_a_rate(mention))

    def _leads_to_a_rate(self, mention: Mention) -> bool:
        """Whether the clause after an exception says at once what all get: "except for user 3, each gets 1 Mbit/s"."""
        cut = clause_end(self._plain, mention.end)
        if cut == len(self._plain) or not _LEADING.fullmatch(self._plain, mention.end, cut):
            return False
        first, end = cut + 1, clause_end(self._plain, cut + 1)
        rates = [f for f in self._judged.figures if f.kind == "rate" and first <= f.start < end]
        of_all = [m.start for m in self._found if m.role in _COLLECTIVE and first <= m.start < end]
        begins = min([f.phrase_start for f in rates] + of_all, default=end)
        inserted = any(  # "everyone, except user 3, gets"
            _INSERTED.fullmatch(self._plain, m.end, mention.start) for m in self._found if m.role in _COLLECTIVE
        )
        return bool(rates) and (inserted or _AT_ONCE.fullmatch(self._plain, first, begins) is not None)

    def _exempt_from_that_of_the_others(self) -> None:
        """Whoever has a cap alone where "the others" have a floor has none."""
        floors, caps = self._rates["min_rate_bps"], self._rates["max_rate_bps"]
        if self._of_others and EVERYBODY in floors and EVERYBODY not in caps:
            for user in set(caps) - set(floors):
                floors[user] = _Given(value=0.0, text=caps[user].text, end=caps[user].end)

    def _exempt(self) -> None:
        """Whoever is excepted has a floor of zero where all others have one, and nothing else may be meant."""
        floors, caps = self._rates["min_rate_bps"], self._rates["max_rate_bps"]
        for mention, standing in self._excepted.items():
            clear = EVERYBODY in floors and (standing == "exempt" or not (caps or standing == "uncapped"))
            if not clear or any(
                user in rates for user in mention.users for rates in (floors, *([caps] if caps else []))
            ):
                continue
            self._used.add(mention)
            self._unsure.remove(mention)
            self.spans += filter(None, [promised_nothing(self._plain, mention.start, mention.end)])
            text = self._text[mention.start : mention.end]
            for user in mention.users:
                floors[user] = _Given(value=0.0, text=text, end=mention.end)

    def _likeliest(self, mention: Mention) -> UserRole:
        """What the model says of somebody named; without certainty nobody is left out or served alone."""
        chances = self._judged.user(mention)
        roles: tuple[UserRole, ...] = ("leave_out", "users")
        role = max(roles, key=lambda each: chances[each])
        said = self._judged.said_of(mention)[role] > _SAID
        if said and chances[role] > _SURE_OF_A_ROLE and not is_something_of(self._plain, mention.end):
            return role
        if chances["none"] < _SURE_OF_NO_ROLE and mention.role == "named":
            self._unsure.append(mention)
        return "none"

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
            span = (number.start, number.end)
            self._used.update([target.mention] if target.mention is not None else [])
            self.spans.append(span)
            for user in target.keys:
                self._weights.setdefault(user, (float(number.value), span))

    @property
    def back(self) -> tuple[str, ...]:
        return tuple(self._lists["back"])

    @property
    def named(self) -> tuple[str, ...]:
        users = [user for mention in self._found if mention.role == "named" for user in mention.users]
        return tuple(dict.fromkeys(users))

    def give(self, name: str, target: Target, figure: Quantity, corrects: re.Pattern[str]) -> str | None:
        """Note a rate for its users; the words of an earlier one that contradicts it, or None."""
        if figure.comparator == "exactly":
            self.exact.add(name)
        if target.mention is not None:
            self._used.add(target.mention)
            if target.role == "named":
                self.spans.append((target.mention.start, target.mention.end))
        self._of_others = self._of_others or (name == "min_rate_bps" and target.role == "others")
        for key in target.keys:
            earlier = self._rates[name].get(key)
            if earlier is not None and earlier.value != figure.value and not self._corrected(corrects, earlier, figure):
                return earlier.text
            self._rates[name][key] = _Given(value=figure.value, text=figure.text, end=figure.end)
        return None

    def _corrected(self, corrects: re.Pattern[str], earlier: _Given, figure: Quantity) -> bool:
        return corrects.search(self._plain, earlier.end, figure.start) is not None

    def take_users(self) -> Iterator[tuple[int, int]]:
        """The named users of whom nothing was said, or nothing certain, as spans."""
        self._exempt()
        self._exempt_from_that_of_the_others()
        spoken_of = {user for mention in self._used for user in mention.users} | set(self._weights)
        for mention in self._found:
            if mention.role != "named":
                continue
            self.spans.append((mention.start, mention.end))
            unsure = mention in self._unsure and not self._said_elsewhere(mention)
            if unsure or not spoken_of.issuperset(mention.users) or self._is_at_odds(mention):
                yield mention.start, mention.end

    def _is_at_odds(self, mention: Mention) -> bool:
        """Whether somebody has a rate elsewhere and gets nothing here: "user 3 needs 1 Mbit/s but drop user 3"."""
        rated = {user for given in self._rates.values() for user, each in given.items() if each.value > 0}
        dropped = self._judged.said_of(mention)["leave_out"] > _AT_ODDS
        corrected = CORRECTION.search(self._plain, mention.end) is not None
        return dropped and not corrected and mention not in self._used and rated.issuperset(mention.users)

    def _said_elsewhere(self, mention: Mention) -> bool:
        """Whether everybody of a mention is settled by another, or by a weight."""
        others = {user for other in self._used if other != mention for user in other.users}
        return others.union(self._weights).issuperset(mention.users)

    def values(self) -> dict[str, Constraint]:
        values: dict[str, Constraint] = {}
        for name, given in self._rates.items():
            figures = {user: each.value for user, each in given.items()}
            if set(figures) == {EVERYBODY}:
                values[name] = figures[EVERYBODY]
            elif figures:
                values[name] = self._of_all_served(figures)
        weights = {user: value for user, (value, _) in self._weights.items()}
        if weights.get(EVERYBODY) == 1 or set(weights) == {EVERYBODY}:
            del weights[EVERYBODY]  # "all others 1" is what they count anyway
        if weights:
            values["weights"] = weights
        for name in ("users", "leave_out"):
            if self._lists[name]:
                values[name] = tuple(self._lists[name])
        return values

    def _of_all_served(self, figures: dict[str, float]) -> Constraint:
        """Rates by user; one figure where it is that of everybody who is served."""
        same = len(set(figures.values())) == 1 and set(figures) == set(self._lists["users"])
        return next(iter(figures.values())) if same else figures

    def evidence(self) -> dict[str, str]:
        words = {
            name: " … ".join(dict.fromkeys(each.text for each in given.values())) for name, given in self._rates.items()
        }
        words |= {name: " … ".join(dict.fromkeys(self._lists[name].values())) for name in ("users", "leave_out")}
        words["weights"] = " … ".join(
            dict.fromkeys(self._text[start:end] for _, (start, end) in self._weights.values())
        )
        return {name: text for name, text in words.items() if text}

    def crossed(self) -> Iterator[tuple[str, str, str]]:
        """Figures that cannot hold together, with the key of the question to ask."""
        low, high = self._rates["min_rate_bps"], self._rates["max_rate_bps"]
        for user in {*low, *high}:
            least, most = low.get(user, low.get(EVERYBODY)), high.get(user, high.get(EVERYBODY))
            if least is not None and most is not None and least.value > most.value:
                yield least.text, most.text, "rates_crossed"
        both = [user for user in self._lists["users"] if user in self._lists["leave_out"]]
        if both:
            yield self._lists["users"][both[0]], self._lists["leave_out"][both[0]], "conflict"
