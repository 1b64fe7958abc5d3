"""Whom the figures of a sentence are for, who is served, left out, excepted or goes without, and what is at odds.

What somebody is there for a small model judges from the words beside (``judged``); whoever it is not sure of is asked
about, and so are two figures of one thing, unless the words between take the first back.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

from wirelessagent.language.as_meant import taking_back
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, LISTS_OF_USERS, RATES
from wirelessagent.language.judged import BOUNDED, Judged
from wirelessagent.language.mentions import (
    ANY_NOUN,
    ARTICLES,
    EXCEPTED,
    GIVEN_TO,
    JOINT_WORDS,
    NOBODY,
    Mention,
    Role,
)
from wirelessagent.language.moods import lifted_in, may_be_lifted
from wirelessagent.language.number_roles import GIVEN_ON, everybody_named
from wirelessagent.language.numerals import Number, numbers
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.stated import Doubt, Multiple, Reading
from wirelessagent.language.text import AND, Beside, Phrases, Span, clause_end, clause_start
from wirelessagent.language.word_tables import any_word, deferred, either

_SURE_OF_A_ROLE, _SURE_OF_SILENCE, _SURE_OF_AN_OWNER = 0.55, 0.9, 0.45
_SAID = 0.4
_ADDS = Phrases(either("figures", "users", "adds"))
_LEAVING = Phrases(either("figures", "users", "leaving"))
_GETS = deferred(
    rf"(?i)(?:[\s,:=]|\b(?:is|ist|est|es)\b|{either('figures', 'users', 'takes')}|"
    rf"{either('figures', 'bounds', 'rate')}|{any_word('figures', 'users', 'gets')}|{ARTICLES}|[的是就则要应该])*"
)
_MAY = deferred(r"(?i)(?:\s|\b(?:ne|no|nicht|not|pas|darf|may|must|should|doit|peut|debe|puede|soll)\b)*")
_ALIKE = either("figures", "users", "alike")
_ONLY_JOINS = deferred(
    rf"(?i)(?:[\s,;:.、\uff0c\uff1b。和与]|{JOINT_WORDS}|{GIVEN_TO}|{ANY_NOUN}|\b(?:but|then|alors|dann|pero)\b)*"
)
_GIVEN_ALIKE = Beside(
    deferred(rf"(?i)(?:{_ALIKE})\s*(?:{either('figures', 'users', 'given_to')})\s*(?:(?:{ARTICLES})\s*)?$"),
    deferred(
        rf"(?i)\s*号?\s*(?:(?:{either('figures', 'users', 'takes')})\s*)?(?:{_ALIKE})"
        rf"(?=\s*(?:$|[,.;:!?)\uff0c。；、]|(?:{AND})\b))"
    ),
)
_UNLIMITED = deferred(rf"(?i){either('figures', 'users', 'free')}")
_ASIDE = deferred(r"\s*[,(\uff0c][^,;.()\uff0c；。]*")
_KEPT = Beside(
    deferred(rf"(?i)(?:{either('figures', 'users', 'keeps')})\s*(?:{GIVEN_TO}\s*)*$"),
    deferred(rf"(?i)\s*号?\s*(?:{either('figures', 'users', 'stays')})"),
)
_OUT_ALONE = deferred(rf"(?i)\s*号?[\s,:\uff0c]*(?:{either('figures', 'users', 'out_alone')})\s*")
_SPARED = deferred(rf"(?i)(?:{either('figures', 'users', 'spares')})\s*(?:{GIVEN_TO}\s*)*$")
_AND = deferred(rf"(?i)\b(?:{AND}|but|pero|mais)\b")
_SILENT = ("kept", "stale")
"""Roles of somebody who is only spoken of."""
_UNSETTLED = ("exempt", "unclear")
"""Roles of somebody who has to be settled elsewhere."""


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
    end: int = 0


class Allotments:
    """What the users of a sentence are given, and which of them it concerns at all."""

    def __init__(self, reading: Reading, judged: Judged) -> None:
        self._reading, self._judged, self._found = reading, judged, judged.mentions
        self._text, self._plain = reading.text, reading.plain
        named = [user for mention in self._found if mention.role == "named" for user in mention.users]
        reading.named = tuple(dict.fromkeys(named))
        self._given: dict[str, dict[str, _Given]] = {name: {} for name in FIGURES_OF_USERS}
        self._lists: dict[str, dict[str, str]] = {"users": {}, "leave_out": {}, "back": {}}
        self._used: set[Mention] = set()
        self._conflicts: list[Doubt] = []
        self._of_others: set[str] = set()
        self.spans: list[tuple[int, int]] = []
        self._roles: dict[Mention, str] = {}
        self._likely: dict[Mention, str] = {}
        self._lifted: dict[Mention, frozenset[str]] = {}
        self._multiplied = dict(self._whose_multiples())
        for mention in self._found:
            role = self._assign(mention) if mention.role in ("named", "pronoun") else mention.role
            reading.marks.append((mention.start, mention.end, role + "+" * (len(mention.users) > 1)))
        self._one_each = dict(self._one_for_each())
        for number in judged.numbers.weights:
            self._weigh(number)
            reading.marks.append((number.start, number.end, "weight"))

    def _whose_multiples(self) -> Iterator[tuple[Mention, Multiple]]:
        """Whoever gets so many times what another user gets stands ahead."""
        for multiple in self._reading.multiples:
            ahead = [each for each in self._found if each.end <= multiple.start]
            between = self._plain[ahead[-1].end : multiple.said.start] if ahead else "?"
            bounded = multiple.said.comparator is not None and _MAY.fullmatch(between)
            if bounded or _GETS.fullmatch(between):  # not "user 3 pays twice as much as user 2", "user 3 never …"
                yield ahead[-1], multiple

    def _assign(self, mention: Mention) -> str:
        """Note what somebody is there for, which is given back."""
        role, meant = self._likeliest(mention), self._target(mention)
        if self._too(mention):  # "le 6 non plus"
            before = [each for each in self._found if each.end <= mention.start]
            role = self._roles.get(before[-1], "given") if before else "given"
        if role == "given" or not meant.users:
            return role
        self._roles[mention] = role
        if role == "exempt":  # words that only say to whom nothing is promised: "user 7 has no least rate"
            self.spans.append(self._own_words(mention))
        if role in _UNSETTLED:
            return role
        if role == "stale":
            self._reading.takes_back(mention.end, len(self._plain))
        self._used |= {mention, meant.mention or mention}
        start, end = self._judged.view.telling(mention, role)
        self.spans.append((start, end))
        if role == "leave_out":
            self._take_back_the_last(mention)
        if role not in _SILENT:
            self._lists[role] |= dict.fromkeys(meant.users, self._text[start:end])
        return role

    def _take_back_the_last(self, mention: Mention) -> None:
        """Serve those after all in whose place the next are left out: "leave out 7, no, sorry, leave out 6"."""
        before = [each for each, its in self._roles.items() if its == "leave_out" and each.end <= mention.start]
        for start, end in taking_back(self._plain) if before else ():
            beside = self._plain[end : mention.start], self._plain[mention.end : clause_end(self._plain, mention.end)]
            instead = not any(map(_ADDS.search, beside))
            if instead and before[-1].end <= start and end <= mention.start:
                self._reading.masked.append((start, end))
                for user in before[-1].users:
                    self._lists["leave_out"].pop(user, None)

    def _exempt(self) -> None:
        """Take from whoever is excepted what others have: all that they go without, else the one limit of everybody.

        Where everybody has a floor, theirs is zero. Whoever has a cap alone where "the others" have a floor has none
        either. Where limits are of named users alone, there is none to take from whoever is excepted.
        """
        floors, caps = (self._given[name] for name in RATES)
        for mention in [each for each, role in self._roles.items() if role == "exempt"]:
            lifts = self._lifted.get(mention, frozenset())
            meant = [name for name in RATES if self._given[name] and (not lifts or may_be_lifted(name, lifts))]
            of_all = [name for name in meant if EVERYBODY in self._given[name]]
            own = any(user in self._given[name] for name in of_all or meant for user in mention.users)
            alone = any({*self._given[name]} <= {*mention.users} for name in of_all or meant)
            others = [user for user in self._judged.users_of_the_cell if user not in mention.users]
            known = "max_rate_bps" not in of_all or others  # a ceiling of the others is one of each of them
            if alone or not (known and (meant if lifts else len(of_all) == 1 and not own)):  # what does not hold
                continue
            self._used.add(mention)
            self._roles[mention] = "given"
            for name in meant if lifts else of_all:
                for user in mention.users:
                    self._given[name].pop(user, None)
            if "min_rate_bps" in of_all:
                text = self._text[mention.start : mention.end]
                floors.update({user: _Given(value=0.0, text=text) for user in mention.users})
            if "max_rate_bps" in of_all:
                common = caps.pop(EVERYBODY)
                caps.update({user: common for user in others if user not in caps})
        if EVERYBODY not in floors or EVERYBODY in caps:
            return
        if "min_rate_bps" in self._of_others:
            for user in [user for user in caps if user not in floors]:
                floors[user] = _Given(value=0.0, text=caps[user].text)

    def _give_multiples(self) -> None:
        """So many times the one rate of somebody else; without one, nobody knows what is meant."""
        known = list[Multiple]()
        for mention, multiple in self._multiplied.items():
            of = [name for name in RATES if multiple.user in self._given[name]]
            if len(of) != 1:
                continue
            known.append(multiple)
            value = self._given[of[0]][multiple.user].value * multiple.times
            own = _Given(value=value, text=self._text[multiple.start : multiple.end])
            name = BOUNDED.get(multiple.said.comparator or "", of[0])
            for user in mention.users:
                first = self._given[name].setdefault(user, own)
                if first.value != value:
                    self._conflicts.append(Doubt(key="conflict", names={"one": first.text, "other": own.text}))
            self._used.add(mention)
        for multiple in self._reading.multiples:
            if multiple not in known:
                self._reading.doubt("calculated", text=self._text[multiple.start : multiple.end])

    def _give_alike(self) -> None:
        """The figures of whoever was named before for whom, or for the others, the same is said.

        "user 5 the same", "lo mismo al 4", "the others too".
        """
        for before, mention in itertools.pairwise(everybody_named(self._found)):
            said = _GIVEN_ALIKE.ahead.search(self._plain, before.end, mention.start) or self._too(mention)
            ahead, whose = before.users or (EVERYBODY,), mention.users or (EVERYBODY,)
            own = any(user in given for given in self._given.values() for user in whose)
            if said is None or own or mention in self._used:
                continue
            for given in self._given.values():
                figures = {given[user].value if user in given else None for user in ahead}
                if len(figures) == 1 and None not in figures:
                    given.update(dict.fromkeys(whose, given[ahead[0]]))
                    self._used.add(mention)
                    self._roles[mention] = "given"
            self.spans.append(said.span())

    def _too(self, mention: Mention) -> re.Match[str] | None:
        """The words that the same is said of somebody as of whoever stands ahead, with nothing but a joint between."""
        plain, said = self._plain, _GIVEN_ALIKE.behind.match(self._plain, mention.end)
        if said is None:
            return None
        ends = [number.end for number in numbers(plain)] + [figure.phrase_end for figure in self._judged.figures]
        ends += [each.end for each in self._found]
        last = max((end for end in ends if end <= mention.start), default=0)
        return said if _ONLY_JOINS.fullmatch(plain, last, mention.start) else None

    def _write_out_the_others(self) -> None:
        """A ceiling of the others becomes one of each of them, where users are named who have none."""
        caps = self._given["max_rate_bps"]
        free = [user for user in self._reading.named if user not in caps]
        others = [user for user in self._judged.users_of_the_cell if user not in (*free, *caps)]
        if "max_rate_bps" in self._of_others and EVERYBODY in caps and free and others:
            caps.update(dict.fromkeys(others, caps.pop(EVERYBODY)))

    def _likeliest(self, mention: Mention) -> str:
        """What somebody is there for; without certainty it is unclear."""
        if mention in self._multiplied:
            return "given"
        chances, said = self._judged.user(mention), self._judged.said_of(mention)
        lifted, clause = self._goes_without(mention), self._plain[slice(*self._clause_of(mention))]
        if lifted is None and self._is_out_of_all(mention) and (lifted_in(clause) or _UNLIMITED.search(clause)):
            return "unclear"  # "no limit on anyone except user 3", "lift the least rate of all but user 3"
        rated = self._has_figures(*self._clause_of(mention), kind="rate")
        again = any(each is not mention and {*each.users} == {*mention.users} for each in self._found)
        if said["exempt"] > _SURE_OF_A_ROLE or lifted is not None or (again and rated and self._is_out_of_all(mention)):
            self._lifted[mention] = lifted or frozenset()
            return "exempt"  # whatever rate stands beside it is that of all others
        role = self._likely[mention] = max(chances, key=lambda each: chances[each])
        if role == "users" and self._others_have_a_figure(mention):
            return "unclear"  # who are served then, too
        if role == "users" and self._is_out_of_others(mention):
            return "leave_out"
        if role in ("leave_out", "unclear", "kept") and self._stays(mention):
            others = [each for each in self._found if each.role == "others" and each.start >= mention.end]
            return "users" if others and _LEAVING.search(self._plain, others[0].end) else "kept"  # "keep 1, rest out"
        sure = _SURE_OF_SILENCE if role in _SILENT else _SURE_OF_A_ROLE  # nobody is to be dropped unheard
        unsaid = role == "leave_out" and _LEAVING.search(self._plain) is None  # "user 3 has priority"
        if role == "given" or (role != "unclear" and chances[role] > sure and said[role] > _SAID and not unsaid):
            return role
        if _OUT_ALONE.fullmatch(self._plain, mention.end, self._own_words(mention)[1]):
            return "leave_out"
        if mention.role != "named":
            return "given"
        return "exempt" if rated and self._is_out_of_all(mention) else "unclear"

    def _stays(self, mention: Mention) -> bool:
        """Whether somebody goes on to be served: "user 5 stays, user 6 out", "don't leave user 8 out"."""
        if _SPARED.search(self._plain, 0, mention.start):
            return True
        start, end = self._own_words(mention)
        ahead, behind = (
            _KEPT.ahead.search(self._plain, start, mention.start),
            _KEPT.behind.match(self._plain, mention.end),
        )
        if ahead is None and behind is None:
            return False
        last = mention.end if behind is None else behind.end()
        and_ = _AND.search(self._plain, last, end)  # "keep user 5 and drop user 6"
        return _LEAVING.search(self._plain, last, and_.start() if and_ else end) is None

    def _is_out_of_all(self, mention: Mention) -> bool:
        """Whether somebody is excepted from everybody, in one clause."""
        start, end = self._clause_of(mention)
        among = (each for each in self._found if each.role == "everybody" and start <= each.start < end)
        everybody = any(NOBODY.search(self._plain[each.start : each.end]) is None for each in among)
        return everybody and EXCEPTED.search(self._plain, start, mention.start) is not None

    def _is_out_of_others(self, mention: Mention) -> bool:
        """Whether somebody is excepted from others who are served: "除了6号，其他都服务", not "nobody but user 6"."""
        start, _ = self._clause_of(mention)
        others = (each for each in self._found if each.role in ("others", "everybody") and each.start >= mention.end)
        served = any(not NOBODY.search(self._plain[each.start : each.end]) for each in others)
        excepted = EXCEPTED.search(self._plain, start, mention.start) is not None
        return excepted and served and _LEAVING.search(self._plain, mention.end) is None

    def _goes_without(self, mention: Mention) -> frozenset[str] | None:
        """The limits that are lifted where all that is said of somebody lifts them; none of them where that is unsaid.

        "user 6 no guarantee", "all but user 1, who is uncapped": nothing else is wished of them, in their own words.
        """
        start, end = self._own_words(mention)
        for figure in self._judged.figures:  # "user 3 has no cap so limit it to …", "2 Mbit/s for user 2, no cap"
            if figure.start == end or GIVEN_ON.fullmatch(self._plain, figure.phrase_end, mention.start):
                return None
        lifted = frozenset(lifted_in(self._plain[start:end]))
        if lifted:
            return lifted
        same = (each for each in self._found if {*each.users} == {*mention.users})
        excepted = any(EXCEPTED.search(self._plain, 0, each.start) for each in same)
        return frozenset() if excepted and _UNLIMITED.search(self._plain[mention.end : end]) else None

    def _own_words(self, mention: Mention) -> Span:
        """Where words stand that are of somebody alone: between the figures and users beside, or behind a comma."""
        others = [each for each in self._found if each is not mention and each.role != "pronoun"]
        others = [each for each in others if not NOBODY.search(self._plain[each.start : each.end])]  # "keine Garantie"
        spans = [(each.start, each.end) for each in (*self._judged.figures, *others)]
        start = max([clause_start(self._plain, mention.start), *(end for _, end in spans if end <= mention.start)])
        ends = [first for first, _ in spans if first >= mention.end]
        last = clause_end(self._plain, mention.end)
        aside = _ASIDE.match(self._plain, last) if not self._plain[mention.end : last].strip() else None
        aside = None if aside and any(last <= first < aside.end() for first in ends) else aside
        return start, min([aside.end() if aside else last, *ends])

    def _others_have_a_figure(self, mention: Mention) -> bool:
        """Whether the others have a figure in their clause: "serve only users 1 and 2, the others at 1 Mbit/s".

        They are no others than of those who are served where one of these is named again: "only 1, 2 and 3; 3 gets
        2 Mbit/s, the other two 1 Mbit/s".
        """
        again = any({*each.users} < {*mention.users} for each in self._found if each.users)
        others = (each for each in self._found if each.role == "others")
        return not again and any(self._has_figures(*self._clause_of(each)) for each in others)

    def _clause_of(self, mention: Mention) -> Span:
        return clause_start(self._plain, mention.start), clause_end(self._plain, mention.end)

    def _has_figures(self, start: int, end: int, kind: str = "") -> bool:
        return any(start <= figure.start < end and kind in ("", figure.kind) for figure in self._judged.figures)

    def _one_for_each(self) -> Iterator[tuple[int, Target]]:
        """The figures of lists as long as a list of users, one for each: "users 1 and 4 get 2 and 3 Mbit/s"."""
        for starts in self._judged.lists:
            able = [each for each in self._found if len(each.users) == len(starts)]
            chances = [self._judged.owners(start, able) for start in starts]
            best = max(able, key=lambda mention: sum(each[mention] for each in chances), default=None)
            if best is not None:
                for start, user in zip(starts, best.users, strict=True):
                    yield start, Target(role="named", users=(user,), mention=best)

    def target_of(self, start: int) -> Target:
        """Whom the figure at ``start`` is for, which are none of those who are left out."""
        if start in self._one_each:
            return self._one_each[start]
        candidates = [each for each in self._found if self._roles.get(each) not in ("leave_out", "exempt")]
        chances = self._judged.owners(start, candidates)
        target = self._target(max(chances, key=lambda mention: chances[mention]))
        same = sum(chance for mention, chance in chances.items() if set(self._target(mention).keys) == set(target.keys))
        return replace(target, sure=same > _SURE_OF_AN_OWNER)

    def _target(self, mention: Mention | None) -> Target:
        if mention is not None and mention.role == "pronoun":
            named = [other for other in self._found if other.role == "named" and other.end <= mention.start]
            mention = named[-1] if named else None
        if mention is None:
            return Target(role="everybody")
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

    def give(self, name: str, target: Target, figure: Quantity) -> str | None:
        """Note a rate for its users; the words of an earlier one that contradicts it, or None."""
        if target.mention is not None:
            self._used.add(target.mention)
            if target.role == "named":
                self.spans.append((target.mention.start, target.mention.end))
        if target.role == "others":
            self._of_others.add(name)
        cell = {*self._judged.users_of_the_cell}
        for key in (EVERYBODY,) if cell and cell <= {*target.users} else target.keys:  # "users 1 to 8 …"
            earlier = self._given[name].get(key)
            takes_back = earlier is not None and self._reading.takes_back(earlier.end, figure.start)
            if earlier is not None and earlier.value != figure.value and not takes_back:
                return earlier.text
            self._given[name][key] = _Given(value=figure.value, text=figure.text, end=figure.end)
        return None

    def take_users(self) -> Iterator[tuple[int, int]]:
        """The named users of whom nothing was said, or nothing certain, as spans."""
        self._give_multiples()
        self._give_alike()
        self._exempt()
        self._write_out_the_others()
        spoken_of = {user for mention in self._used for user in mention.users} | set(self._given["weights"])
        for mention in self._found:
            if mention.role != "named":
                continue
            self.spans.append((mention.start, mention.end))
            others = {user for other in self._used if other != mention for user in other.users}
            elsewhere = others.union(self._given["weights"]).issuperset(mention.users)
            unsure = self._roles.get(mention) in _UNSETTLED and not elsewhere
            if unsure or not spoken_of.issuperset(mention.users) or self._is_at_odds(mention):
                yield mention.start, mention.end

    def _is_at_odds(self, mention: Mention) -> bool:
        """Whether somebody has a rate elsewhere and is left out here: "user 3 needs 1 Mbit/s but drop user 3".

        The same where they are served alone elsewhere, and here left out by all likelihood.
        """
        rated = {user for name in RATES for user, each in self._given[name].items() if each.value > 0}
        if self._roles.get(mention) == "leave_out" and not rated.isdisjoint(mention.users):
            return True
        return self._likely.get(mention) == "leave_out" and not self._lists["users"].keys().isdisjoint(mention.users)

    def settle(self) -> None:
        """Note what users are given, the words that say so, and what cannot hold together."""
        reading, served = self._reading, self._lists["users"].keys()
        for name, given in self._given.items():
            figures = {user: each.value for user, each in given.items()}
            if name == "weights" and figures.get(EVERYBODY) == 1:
                del figures[EVERYBODY]  # "all others 1" is what they count anyway
            same_for_all = name != "weights" and len(set(figures.values())) == 1 and figures.keys() == served
            if same_for_all or set(figures) == {EVERYBODY}:
                reading.values[name] = next(iter(figures.values()))
            elif figures:
                reading.values[name] = figures
        reading.values |= {name: tuple(self._lists[name]) for name in LISTS_OF_USERS if self._lists[name]}
        words = {name: [each.text for each in self._given[name].values()] for name in RATES}
        words |= {name: list(self._lists[name].values()) for name in LISTS_OF_USERS}
        words["weights"] = [each.text for each in self._given["weights"].values()]
        reading.evidence |= {name: " … ".join(dict.fromkeys(texts)) for name, texts in words.items() if texts}
        reading.doubts += self._crossed()
        reading.masked += self.spans
        reading.back = tuple(self._lists["back"])

    def _crossed(self) -> Iterator[Doubt]:
        """The questions that figures raise which cannot hold together."""
        yield from self._conflicts
        low, high = (self._given[name] for name in RATES)
        for user in low | high:
            least, most = low.get(user, low.get(EVERYBODY)), high.get(user, high.get(EVERYBODY))
            if least is not None and most is not None and least.value > most.value:
                yield Doubt(key="rates_crossed", names={"low": least.text, "high": most.text})
        both = [user for user in self._lists["users"] if user in self._lists["leave_out"]]
        if both:
            one, other = (self._lists[name][both[0]] for name in ("users", "leave_out"))
            yield Doubt(key="conflict", names={"one": one, "other": other})
