"""Who gets which rate, weight or service: figures by user, and the users of a request."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from wirelessagent.language.intent import EVERYBODY, Constraint
from wirelessagent.language.mentions import Mention, Role
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.roles import UserRole, role_of

_TO_THEM = re.compile(
    r"(?i)\s*(?:at\s+(?:least|most|minimum)|minimum|min|max|each|apiece|in the (?:downlink|uplink))?\s*"
    r"(?:for|to|per|at|on|/|para|pour|à|für|an|给|留给|分给)\s*(?:the\s+|el\s+|la\s+|l'|los\s+|les\s+|den\s+|"
    r"die\s+)?(?:user\s+of\s+)?$"
)
_EACH_OF = re.compile(
    r"(?i)\s*(?:each|apiece)?\s*(?:for|to)\s+(?:each|every one|all|both)\s+(?:of\s+)?(?:the\s+)?$|\s*(?:each\s+)?$"
)
_WEIGHTY = re.compile(
    r"(?i)\b(?:weigh\w*|counts?|counted|counting|importan\w*|priorit\w*|worth|matters?|double|twice|triple|peso|"
    r"pesa|cuenta|cuente|vale|poids|compte\w*|pèse|"
    r"gewicht\w*|zähl\w*|wieg\w*)\b|权重|加权|权值|优先级|重要|算作|算两|算三|顶两|顶三|当两|翻倍|加倍|双倍"
)
_TIMES = re.compile(
    r"(?i)\b(?P<two>twice|double[ds]?|doubly|el doble|doble|le double|doppelt\w*|compte(?:r)? pour deux)\b|"
    r"\b(?P<three>three ?times|triple[ds]?|thrice|"
    r"threefold|el triple|trois fois|dreifach|tres veces|dreimal|compte(?:r)? pour trois)\b|\b(?P<four>four ?times|"
    r"fourfold|quadruple|cuatro veces|quatre fois|vierfach)\b|"
    r"\b(?P<five>five ?times|fivefold|fünffach|cinco veces|cinq fois)\b|\b(?P<ten>ten ?times|tenfold|zehnfach|"
    r"diez veces|dix fois)\b|\b(?P<half>half|halb|la mitad|la moitié|mitad)\b|"
    r"(?<![\w.])(?P<n>[0-9]+(?:\.[0-9]+)?)\s*(?:times|x\b|-fold|veces|fois|mal|倍)|(?P<zh2>翻倍|加倍|双倍|[两二]倍|"
    r"[两二]份|顶[两二]个|当[两二]个|算[两二]个|翻一番)|"
    r"(?P<zh3>三倍|三份|顶三个|当三个)|(?P<zh4>四倍)|(?P<zh5>五倍)|(?P<zh10>十倍)|(?P<zhhalf>减半|一半|半份)"
)
_FACTORS = {
    "two": 2.0, "three": 3.0, "four": 4.0, "five": 5.0, "ten": 10.0, "half": 0.5, "zh2": 2.0, "zh3": 3.0, "zh4": 4.0,
    "zh5": 5.0, "zh10": 10.0, "zhhalf": 0.5,
}  # fmt: skip
_BARE = re.compile(
    r"(?<![A-Za-z0-9_.,-])[0-9]+(?:\.[0-9]+)?(?![\w%]|[.,][0-9]|\s*(?:W|mW|kW|dBm|dBW|[kMG]?bit|[kMG]bps|%|瓦|兆|"
    r"users?\b|个))|(?:(?<=权重)|(?<=权重[为是给取设])|(?<=权重设[为成])|(?<=权重调[到为成])|"
    r"(?<=权重改[为成]))[一二两三四五六七八九十]"
)
_FOR = re.compile(
    r"(?i)\s*(?:as\s+(?:much|weight)\s+)?(?:for|to|on|of|für|pour|para|给|an)\s+(?:the\s+)?$|\s*给\s*$|\s*:\s*$"
)
_ZH_DIGITS = {letter: float(place) for place, letter in enumerate("零一二三四五六七八九十")} | {"两": 2.0}


@dataclass(frozen=True, kw_only=True)
class Target:
    """Whom a figure is for."""

    role: Role
    users: tuple[str, ...] = ()
    mention: Mention | None = None

    @property
    def keys(self) -> tuple[str, ...]:
        return self.users or (EVERYBODY,)


def target_of(
    plain: str, found: Sequence[Mention], quantities: Sequence[Quantity], index: int, roles: Mapping[Mention, UserRole]
) -> Target:
    """Whom the rate ``quantities[index]`` is for: whoever stands right behind it, else nearest before it.

    Those who are left out, and words of other figures, are nobody's target.
    """
    figure = quantities[index]
    lower = max((other.phrase_end for other in quantities[:index] if other.kind in ("rate", "power")), default=0)
    upper = min((other.phrase_start for other in quantities[index + 1 :]), default=len(plain))
    end = max(figure.end, figure.phrase_end)
    free = [mention for mention in found if roles.get(mention, "none") != "leave_out"]
    for mention in free:
        gap = plain[end : mention.start]
        to_all = mention.role == "everybody" and _EACH_OF.match(gap)
        if end <= mention.start < upper and (to_all or _TO_THEM.match(gap)):
            if to_all:
                behind = next(
                    (m for m in free if m.start >= mention.end and _EACH_OF.match(plain[mention.end : m.start] or " ")),
                    None,
                )
                before = _before(plain, free, found, lower, figure)
                chosen = behind if behind is not None and behind.start < upper else before
                if chosen is not None and chosen.role in ("named", "others") and roles.get(chosen, "none") == "none":
                    return _target(chosen, found)  # "users 1 and 4 get 2 Mbit/s each"
            return _target(mention, found)
    return _target(_before(plain, free, found, lower, figure), found)


def _before(
    plain: str, free: Sequence[Mention], found: Sequence[Mention], lower: int, figure: Quantity
) -> Mention | None:
    """The nearest mention before a figure that is not the one behind the figure before."""
    between = [mention for mention in free if lower <= mention.start and mention.end <= figure.start]
    first = between[0] if between else None
    if (
        first is not None
        and lower
        and _TO_THEM.match(plain[lower : first.start])
        and ("," not in plain[lower : first.start])
    ):
        between = between[1:]  # "2 Mbit/s for user 3 and 1 Mbit/s for all"
    return between[-1] if between else None


def _target(mention: Mention | None, found: Sequence[Mention]) -> Target:
    if mention is None:
        return Target(role="everybody")
    if mention.role == "pronoun":
        named = [other for other in found if other.role == "named" and other.end <= mention.start]
        return Target(role="named", users=named[-1].users, mention=named[-1]) if named else Target(role="everybody")
    return Target(role=mention.role, users=mention.users, mention=mention)


@dataclass(kw_only=True)
class _Given:
    value: float
    text: str
    end: int


class Allotments:
    """What the users of a sentence are given, and which of them it concerns at all."""

    def __init__(self, text: str, plain: str, found: Sequence[Mention], quantities: Sequence[Quantity]) -> None:
        self._text, self._plain, self._found, self._quantities = text, plain, found, quantities
        self._rates: dict[str, dict[str, _Given]] = {"min_rate_bps": {}, "max_rate_bps": {}}
        self._lists: dict[str, dict[str, str]] = {"users": {}, "leave_out": {}, "back": {}}
        self._used: set[Mention] = set()
        self.exact: set[str] = set()
        self.spans: list[tuple[int, int]] = []
        self.roles: dict[Mention, UserRole] = {}
        for mention in found:
            if mention.role in ("named", "pronoun"):
                self._assign(mention)
        self._weights = dict(self._read_weights())
        self._weight_spans = [span for _, span in self._weights.values()]

    def _assign(self, mention: Mention) -> None:
        role, start, end = role_of(self._plain, mention.start, mention.end)
        users = mention.users
        if mention.role == "pronoun":
            named = [other for other in self._found if other.role == "named" and other.end <= mention.start]
            users = named[-1].users if named and role in ("leave_out", "users") else ()
            if users:
                self._used.add(named[-1])
        if role == "none" or not users:
            return
        self.roles[mention] = role
        self._used.add(mention)
        self.spans.append((start, end))
        for user in users:
            self._lists[role][user] = self._text[start:end].strip()

    @property
    def back(self) -> tuple[str, ...]:
        return tuple(self._lists["back"])

    @property
    def named(self) -> tuple[str, ...]:
        users = [user for mention in self._found if mention.role == "named" for user in mention.users]
        return tuple(dict.fromkeys(users))

    def is_weight(self, figure: Quantity) -> bool:
        return figure.kind == "bare" and any(start <= figure.start < end for start, end in self._weight_spans)

    def give(self, name: str, target: Target, figure: Quantity, corrects: re.Pattern[str]) -> str | None:
        """Note a rate for its users; the words of an earlier one that contradicts it, or None."""
        if figure.comparator == "exactly":
            self.exact.add(name)
        if target.mention is not None:
            self._used.add(target.mention)
            if target.role == "named":
                self.spans.append((target.mention.start, target.mention.end))
        for key in target.keys:
            earlier = self._rates[name].get(key)
            if earlier is not None and earlier.value != figure.value and not self._corrected(corrects, earlier, figure):
                return earlier.text
            self._rates[name][key] = _Given(value=figure.value, text=figure.text, end=figure.end)
        return None

    def _corrected(self, corrects: re.Pattern[str], earlier: _Given, figure: Quantity) -> bool:
        return corrects.search(self._plain, earlier.end, figure.start) is not None

    def take_users(self) -> Iterator[tuple[int, int]]:
        """The named users whom nothing was said of, as spans."""
        weighed = set(self._weights)
        for mention in self._found:
            if mention.role != "named":
                continue
            self.spans.append((mention.start, mention.end))
            if mention not in self._used and not weighed.issuperset(mention.users):
                yield mention.start, mention.end

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

    def _read_weights(self) -> Iterator[tuple[str, tuple[float, tuple[int, int]]]]:
        if not _WEIGHTY.search(self._plain):
            return
        open_ = [m for m in self._found if m.role in ("named", "others") and m not in self._used]
        figures = [(value, start, end) for value, start, end in self._factors() if not self._in_quantity(start, end)]
        taken: set[Mention] = set()
        for value, start, end in figures:
            behind = [
                m for m in open_ if m.start >= end and _FOR.match(self._plain[end : m.start] or "x") and m not in taken
            ]
            before = [m for m in open_ if m.end <= start and m not in taken]
            pronoun_free = behind[:1] or before[-1:] or [m for m in open_ if m.start >= end and m not in taken][:1]
            for mention in pronoun_free:
                taken.add(mention)
                self._used.add(mention)
                self.spans.append((start, end))
                for user in mention.users or (EVERYBODY,):
                    yield user, (value, (start, end))

    def _factors(self) -> Iterator[tuple[float, int, int]]:
        ends: list[tuple[float, int, int]] = []
        for match in _TIMES.finditer(self._plain):
            group = match.lastgroup or ""
            ends.append((float(match["n"]) if group == "n" else _FACTORS[group], match.start(), match.end()))
        mentioned = [(mention.start, mention.end) for mention in self._found if mention.role == "named"]
        for match in _BARE.finditer(self._plain):
            inside = any(start <= match.start() < end for start, end in [*mentioned, *((s, e) for _, s, e in ends)])
            if not inside:
                word = match.group()
                ends.append((_ZH_DIGITS.get(word) or float(word), match.start(), match.end()))
        yield from sorted(ends, key=lambda entry: entry[1])

    def _in_quantity(self, start: int, end: int) -> bool:
        return any(figure.kind != "bare" and figure.start < end and start < figure.end for figure in self._quantities)
