"""What a sentence states: its constraints, the words that each came from, and what is in doubt.

What it says of the whole cell in words is read here: blocks ("in pairs"), shares of the power ("half"), how many users.
Counts describe the channel where all users are meant ("for our 8 users"); a part of the users, and a half of something,
raise a doubt.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Constraint
from wirelessagent.language.leftovers import POWER_NOUNS
from wirelessagent.language.mentions import BY_PLACE, PLACED
from wirelessagent.language.number_words import cardinals, german_value, plain_word
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.text import Phrases, Span, clause_end, clause_start, is_chinese, is_within, overlaps
from wirelessagent.language.word_tables import either, languages_with, table

_CARRIER = (
    r"(?:sub-?carriers?|tones?|carriers?|rbs?|resource blocks?|subportadoras?|sous-porteuses?|"
    r"(?:unter|sub)träger[ns]?)"
)
_CHANGED_BY = deferred(rf"(?i)(?:{either('figures', 'one', 'changed_by')})\s*(?:about|around|roughly)?\s*$")
_CHANGED_BEHIND = deferred(rf"(?i)\s*(?:{either('figures', 'one', 'changed_behind')})(?!\w)")
_ALL = deferred(r"(?i)\b(?:all|all of|all the|every one of)\s*(?:the\s+|our\s+|these\s+)?$|(?:所有|全部)的?\s*$")
_DESCRIBED_BEFORE = deferred(rf"(?i)(?:^|{either('figures', 'users', 'ahead_of_all')})\s*$")
_DESCRIBED_AFTER = deferred(rf"(?i)\s*(?:$|(?:{either('figures', 'users', 'behind_all')}))")
_COUNT = rf"(?:[0-9]+|{'|'.join(cardinals(2, 10))})"
COUNTED_USERS = deferred(
    rf"(?i)(?<![\w.,/^*-]){_COUNT} (?:of them|of the users|"
    r"(?:waiting |idle |busy |active )?users|ues|subscribers|devices|sensors|terminals|subcarriers|channels|usuarios|"
    r"abonados|clientes|utilisateurs|abonnés|nutzern?|teilnehmern?|kunden)\b|[0-9两二三四五六七八九十]+\s*个(?:用户|"
    r"设备|传感器|子载波)"
)
_CARRIERS = deferred(rf"(?i){_CARRIER}|channels|子载波")
_SOME_USERS, _ONE_OF = (Phrases(either("figures", "users", name, **PLACED)) for name in ("some", "one_of"))
_OF_OURS = r"(?:\w+\s+){0,3}?(?:power|watts?|wattage|rates?|speeds?|throughput|bandwidth|budget|limit)\b"
_HALVED = Phrases(either("figures", "one", "halved", ours=_OF_OURS), marks="half halve third quarter 减半 一半 翻倍")
_OTHERS_HALVED = Phrases(
    r"(?:其余|其他|别人|剩下|剩余|旁人|另外)[^,\uff0c。0-9]{0,5}(?:一半|减半|翻倍|双倍|加倍)",
    marks="一半 减半 翻倍 双倍 加倍",
)
_POWER = rf"(?:maximalleistung|{POWER_NOUNS}|budget|watts|wattage|presupuesto)\b(?:\s+(?:budget|limit))?"
_MOST = (
    r"(?:(?:max|máx)\w*\.?|limitée?|limitada|begrenzt|limited|at|to|of|auf|à|a|al|is|=|<=|≤|:|at most|up to)?\s*"
    r"(?:(?:max|to|auf|à|a|al|au|at)\.?\s*)?"
)
_FULL = (
    r"(?:\s++|of|de|d'|the|our|its|full|max|maximum|total|available|allowed|transmit|tx|la|el|del|notre|nuestra|der|die|"
    r"unserer|vollen|maximalen)*+"
)
_SHARED = (
    deferred(
        rf"(?i)(?:\b(?:p_?max|(?:max\w*\.?\s+)?(?:{POWER_NOUNS}))\s*{_MOST}|功率(?:用|压|降|限制|上限)?[到在为是]?)$"
    ),
    deferred(rf"(?i){_FULL}\s*{_POWER}|的?(?:发射|总)?(?:功率|预算)(?!放大)"),
)
_TOGETHER: dict[str, int] = {
    word: size
    for language in languages_with("figures")
    for word, size in table("figures", language).get("together", {}).items()
}
_TOGETHER_WORDS = "|".join(word if is_chinese(word) else rf"\b{word}\b" for word in _TOGETHER)
_BLOCKS = Phrases(
    rf"(?P<ahead>{_TOGETHER_WORDS})(?=\s*(?:(?:of|de|von|的)\s*)?(?:{_CARRIER}|子载波))|"
    rf"(?:{_CARRIER}|子载波)(?:\s+\w+){{0,3}}?\s*(?P<behind>{_TOGETHER_WORDS})"
    r"|\b(?P<fold>[a-zäöüß]{3,})er-?(?:gruppen?|blöcken?|blöcke|päckchen|packs?|bündeln?)\b",
    marks=" ".join({word.split()[-1] for word in _TOGETHER} | {"gruppe", "blöck", "päck", "pack", "bündel"}),
)
_GROUP = (  # nouns and verbs that say of a number beside them that it is the size of a group
    rf"(?:{_CARRIER}|(?:resource[- ])?(?:group|block|bundle|chunk|cluster|pack|rb)(?:s|ed|ing)?|rbgs?|p?rbs?|size|"
    r"bloques?|blocs?|grupos?|groupes?|paquet(?:e?s)?|recursos|ressources|tamaño|taille|"
    r"(?:ressourcen)?(?:blöcken?|block)(?:größe)?|gruppen?(?:größe)?)"
)
_JOINT = r"(?:of|with|in|into|by|per|an?|each|the|adjacent|neighbouring|de|du|von|zu|à|aus|mit|je|pro|por|par|en)"
_GROUPED = (
    deferred(
        rf"(?i)\b(?:in\s+)?{_GROUP}\b(?:[\s:=-]+(?:{_GROUP}|{_JOINT})\b)*[\s:=-]*$|(?:[每按以]|资源块|子载波|块|大小|[为是=])+$"
    ),
    deferred(
        rf"(?i)(?:[\s-]+(?:{_JOINT}[\s-]+)*{_GROUP}\b)+|个?(?:子载波|资源块)?(?:[为成]?一[组块个]|捆绑|绑定|分组|[组构]成一个|"
        r"资源块|块|组)*"
    ),
)


@dataclass(frozen=True, kw_only=True)
class Doubt:
    """A question that must be asked before acting: the key of its sentence, and what it names."""

    key: str
    names: Mapping[str, str] = field(default_factory=dict[str, str])


@dataclass(kw_only=True)
class Reading:
    """The constraints of a sentence, the words that each came from, and what is in doubt, as they are being read.

    Attributes:
        text: the sentence as it stands; ``plain`` is the same normalised.
        masked: the spans that are used up, so that their words do not count as wishes again.
        not_used: figures that describe the channel rather than ask for something.
        counted: the spans of numbers that only count or describe.
        exact: the constraints of the whole cell that are to be met exactly.
        missing: a share of the channel that is said to be missing.
        steps: amounts to add, by detail name.
        back: users to be taken in again.
        named: everybody who is named.
        strangers: spans of names that no user has.
        marks: the spans of figures and users, each with what it was read as, "+" behind it for several users.
        spoken_for: spans whose figures are used up before any figure is looked at.
    """

    text: str
    plain: str
    quantities: Sequence[Quantity]
    values: dict[str, Constraint] = field(default_factory=dict[str, Constraint])
    evidence: dict[str, str] = field(default_factory=dict[str, str])
    doubts: list[Doubt] = field(default_factory=list[Doubt])
    not_used: list[str] = field(default_factory=list[str])
    masked: list[Span] = field(default_factory=list[Span])
    counted: list[Span] = field(default_factory=list[Span])
    exact: set[str] = field(default_factory=set[str])
    missing: float | None = None
    steps: dict[str, float] = field(default_factory=dict[str, float])
    back: tuple[str, ...] = ()
    named: tuple[str, ...] = ()
    strangers: Sequence[Span] = ()
    marks: list[tuple[int, int, str]] = field(default_factory=list[tuple[int, int, str]])
    spoken_for: list[Span] = field(default_factory=list[Span])

    def doubt(self, key: str, **names: str) -> None:
        """Note a question."""
        self.doubts.append(Doubt(key=key, names=names))

    def put(self, name: str, value: float, span: Span) -> None:
        """Take a value of a constraint; two different ones are a doubt."""
        words = self.text[slice(*span)]
        if self.values.get(name, value) != value:
            self.doubt("conflict", one=self.evidence[name], other=words)
        else:
            self.values[name], self.evidence[name] = value, words

    def take(self, name: str, value: float, figure: Quantity) -> None:
        """Take the value of a figure."""
        self.put(name, value, (figure.start, figure.end))
        if figure.comparator == "exactly":
            self.exact.add(name)

    def take_share(self, figure: Quantity, max_power_w: float) -> None:
        """Take a share of the power, with the words beside that say so."""
        span = self._with_words_beside((figure.phrase_start, figure.phrase_end), _SHARED)
        self.masked.append(span)
        self.spoken_for.append(span)
        self.take("max_power_w", figure.value * max_power_w, figure)

    def changes_by(self, figure: Quantity) -> bool:
        """Whether something is to become more or less by a share: "half the power less"."""
        start, end = self._with_words_beside((figure.phrase_start, figure.phrase_end), _SHARED)
        itself = "减" in figure.text  # 减半
        return itself or bool(_CHANGED_BY.search(self.plain, 0, start) or _CHANGED_BEHIND.match(self.plain, end))

    def _with_words_beside(self, span: Span, words: tuple[re.Pattern[str], re.Pattern[str]]) -> Span:
        """A span with such words right ahead of it, and right behind."""
        ahead, behind = words[0].search(self.plain, 0, span[0]), words[1].match(self.plain, span[1])
        return ahead.start() if ahead else span[0], behind.end() if behind else span[1]

    def take_group(self, size: float, span: Span) -> None:
        """Take how many subcarriers go together, with the words beside that say so."""
        span = self._with_words_beside(span, _GROUPED)
        self.spoken_for.append(span)
        self.masked.append(span)
        if size < 1 or not size.is_integer():
            self.doubt("impossible", text=self.text[slice(*span)].strip())
        else:
            self.put("resource_block_group_size", size, span)


def take_blocks(reading: Reading) -> None:
    """How many subcarriers go together, where the number is a part of a word: "in pairs", "Viererblöcke"."""
    match = _BLOCKS.search(reading.plain)
    word = next(filter(None, match.groups())).lower() if match is not None else ""
    size = _TOGETHER.get(word) or german_value(plain_word(word, "de"))
    if match is not None and size:
        reading.take_group(float(size), match.span())


def take_counts(reading: Reading, recounted: Sequence[Span], allotted: Sequence[Span]) -> None:
    """How many users there are is the channel's affair; to pick some of them without naming them is a doubt.

    ``recounted`` are counts of users who are named, ``allotted`` spans that speak of named users.
    """
    taken = [*((figure.start, figure.end) for figure in reading.quantities), *reading.spoken_for, *allotted]
    for match in COUNTED_USERS.finditer(reading.plain):
        described = any(match.start() <= start < match.end() for start, _ in recounted)
        if described or any(start <= match.start() < end for start, end in taken):
            continue
        words = reading.text[slice(*match.span())]
        reading.counted.append(match.span())
        if _describes_all(*_clause_around(reading, *match.span())):
            reading.not_used.append(words)
        else:
            reading.doubt("not_understood" if _CARRIERS.search(words) else "some_users", text=words)


def doubt_parts(reading: Reading, allotted: Sequence[Span]) -> None:
    """Some of the users, half of something, nobody at all: each a question."""
    settled = [*reading.spoken_for, *allotted, *reading.counted]
    asked = {_SOME_USERS: "some_users", BY_PLACE: "some_users", _ONE_OF: "one_of", _HALVED: "change",
             _OTHERS_HALVED: "change"}  # fmt: skip
    for pattern, key in asked.items():
        match = pattern.search(reading.plain)
        if match is None or (pattern is _HALVED and overlaps(match.span(), settled)):
            continue
        if pattern is not _ONE_OF and any(is_within(match.span(), span) for span in allotted):
            continue  # "odd-numbered users"
        reading.doubt(key, text=reading.text[slice(*match.span())])


def _clause_around(reading: Reading, start: int, end: int) -> tuple[str, str]:
    """What stands before and after a span within its clause, figures being borders too."""
    plain = reading.plain
    from_ = max([0, *(figure.phrase_end for figure in reading.quantities if figure.phrase_end <= start)])
    to = min([len(plain), *(figure.phrase_start for figure in reading.quantities if figure.phrase_start >= end)])
    return plain[clause_start(plain, start, from_) : start], plain[end : clause_end(plain, end, to)]


def _describes_all(before: str, after: str) -> bool:
    """Whether a count of users tells how many there are, rather than picking some: "for 3 users" picks."""
    if _ALL.search(before):
        return True
    return _DESCRIBED_BEFORE.search(before) is not None and _DESCRIBED_AFTER.match(after) is not None
