"""What each number without a unit is: a user, a figure by the unit of another, a weight, or a mere description.

The model says how likely each is (``figure_roles``). Here it is decided, by thresholds and by what a number in its
place can be at all: a bounded number is no user, a scaled one no weight.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from wirelessagent.language.deferred import deferred
from wirelessagent.language.figure_roles import SCALED, View, answers
from wirelessagent.language.leftovers import FOREIGN_UNIT, idioms, may_be_a_limit
from wirelessagent.language.looks import BORROWING, Look
from wirelessagent.language.mentions import JOINT, LISTED
from wirelessagent.language.numerals import Number
from wirelessagent.language.whole_cell import COUNTED_USERS

_ONE_OF_A_LIST = 0.3
_MOST_WEIGHT = 10**6
ITEMS = deferred(rf"{LISTED.pattern}|\s*[:/]\s*")  # "weights 2:1:1"
_WEIGHTS = deferred(  # what follows are weights, whatever else they may look like
    r"(?i)(?:\b(?:weights?|weigh(?:s|ing|ed)?|pesos?|poids|gewichten?)(?:\s+(?:of|are|is|being|de|von|sind))?|权重(?:分别|依次|各)?[是为]?)\s*[:=]?\s*$"
)
_MOST_BARE_USERS = 100  # who is called by a number alone has a small one
_SURE_OF_A_USER, _SURE_OF_A_WEIGHT, _SURE_OF_NOTHING = 0.7, 0.6, 0.6
_SURE_OF_A_FIGURE = 0.6
_SURE_OF_ONE = 0.5
_LIKELY = 0.4
PERHAPS = 0.2


class NumberRoles:
    """The numbers of a sentence, looked at once, and what each is.

    Attributes:
        view: the sentence as the model sees it.
        chances: how likely each number has each role.
        users: the numbers that are users.
        borrowing: those that are figures by the unit of another, each with its role.
    """

    def __init__(self, look: Look, view: View) -> None:
        self._first, self.view = look, view
        self.chances: Mapping[Number, Mapping[str, float]] = {
            number: answers("number", self.view.number(number, look.bound(number)))
            for number in (*look.loose, *look.ones)
        }
        self._weighing = _weighing_lists(look.plain, look, self.chances)
        self._plausible = self._may_be_no_limits()
        chances = {number: self.chances[number]["user"] for number in self._plausible}
        self.users = _users(look.plain, self._plausible, chances)
        self.borrowing = _borrowing(look, self.chances, [*self.users, *self._weighing])

    def _may_be_no_limits(self) -> list[Number]:
        """The numbers that may be users or descriptions, by what stands beside them."""
        plain, look = self._first.plain, self._first
        bounded = [
            (q.start, q.end) for q in look.quantities if q.kind in ("bare", "other") and q.comparator is not None
        ]
        bounded += [(figure.start - 1, figure.end) for figure in look.figures]  # "2 9 watts"
        able = [number for number in look.loose if number not in self._weighing]
        return [number for number in able if not _is_a_limit(plain, number, bounded)]

    def doubtful(self, look: Look) -> list[tuple[int, int]]:
        """The spans of words such as "one" that may be figures and may be nothing; ``look`` is the second."""
        figures = {figure.start for figure in look.figures}
        able = [number for number in self._first.ones if number.start not in figures]
        chances = self.chances
        return [(n.start, n.end) for n in able if chances[n]["rate"] + chances[n]["power"] > PERHAPS]

    def weights(self, look: Look) -> list[Number]:
        """The numbers and words that say how much somebody counts."""
        return [
            number
            for number in look.loose
            if number in self._weighing or _weighs(look.plain, number, self.chances[number])
        ]

    def recounted(self, look: Look) -> list[tuple[int, int]]:
        """The spans of numbers that only count the users of a mention again ("users 2 and 5, those two")."""
        together = {len(mention.users) for mention in look.mentions if len(mention.users) > 1}
        return [(n.start, n.end) for n in self._plausible if n in look.loose and n.value in together]

    def harmless(self, look: Look) -> list[tuple[int, int]]:
        """The spans of numbers that describe and limit nothing, such as a time of day."""
        named = {user for mention in look.mentions for user in mention.users}
        others = [number for number in self._plausible if number in look.loose]
        return [
            *idioms(look.plain),
            *self.recounted(look),
            *((mention.start, mention.end) for mention in look.mentions if mention.role != "named"),
            *((n.start, n.end) for n in others if _says_nothing(n, self.chances[n], named)),
        ]


def _borrowing(look: Look, roles: Mapping[Number, Mapping[str, float]], users: Sequence[Number]) -> dict[Number, str]:
    """The numbers that are figures by the unit of another, each with its role."""
    found: dict[Number, str] = {}
    for number, chances in roles.items():
        role = max(BORROWING, key=lambda each: chances[each])
        if number not in users and _is_a_figure(look, number, chances, role):
            found[number] = role
    return found


def _is_a_figure(look: Look, number: Number, chances: Mapping[str, float], role: str) -> bool:
    """Whether a number that most likely has ``role`` may be read as a figure."""
    if role == "multiple":
        return chances[role] > _SURE_OF_A_FIGURE
    sure = sum(chances[each] for each in BORROWING if BORROWING[each] == BORROWING[role] and each != "multiple")
    if number in look.ones:
        return sure > _SURE_OF_ONE
    if SCALED.match(look.plain, number.end):
        return role == "rate" and sure > _LIKELY
    return sure > (_LIKELY if BORROWING[role] == "ratio" else _SURE_OF_A_FIGURE)


def _says_nothing(number: Number, chances: Mapping[str, float], named: set[str]) -> bool:
    """Whether a number describes, weighs nothing ("the others 1"), or is somebody named before."""
    again = number.value is not None and number.value == int(number.value) and str(int(number.value)) in named
    return chances["harmless"] + (number.value == 1) * chances["weight"] + again * chances["user"] > _SURE_OF_NOTHING


def _weighs(plain: str, number: Number, chances: Mapping[str, float]) -> bool:
    """Whether a number says how much somebody counts."""
    able = number.value is not None and 0 <= number.value < _MOST_WEIGHT and SCALED.match(plain, number.end) is None
    return able and chances["weight"] > _SURE_OF_A_WEIGHT


def _weighing_lists(plain: str, look: Look, roles: Mapping[Number, Mapping[str, float]]) -> list[Number]:
    """The numbers of lists as long as a list of users, of which one surely says how much somebody counts."""
    lengths = {len(mention.users) for mention in look.mentions}
    lists: list[list[Number]] = []
    for number in look.loose:
        able = number.value is not None and 0 <= number.value < _MOST_WEIGHT and number.form != "times"
        if lists and lists[-1] and able and ITEMS.fullmatch(plain, lists[-1][-1].end, number.start):
            lists[-1].append(number)
        else:
            lists.append([number] if able else [])
    sure = [each for each in lists if len(each) > 1 and len(each) in lengths]
    return [
        number
        for each in sure
        if _WEIGHTS.search(plain, 0, each[0].start) or any(_weighs(plain, n, roles[n]) for n in each)
        for number in each
    ]


def _users(plain: str, numbers: Sequence[Number], chances: Mapping[Number, float]) -> list[Number]:
    """The numbers that are users: surely, or likelier than not beside one that surely is ("2, 5 and 7")."""
    able = [n for n in numbers if n.value is not None and 0 <= n.value == int(n.value) < _MOST_BARE_USERS]
    able = [n for n in able if COUNTED_USERS.match(plain, n.start) is None and FOREIGN_UNIT.match(plain, n.end) is None]
    lists: list[list[Number]] = []
    for number in able:
        if lists and JOINT.fullmatch(plain, lists[-1][-1].end, number.start):
            lists[-1].append(number)
        else:
            lists.append([number])
    lists = [each for each in lists if _WEIGHTS.search(plain, 0, each[0].start) is None]
    sure = [each for each in lists if max(chances[number] for number in each) > _SURE_OF_A_USER]
    return [number for each in sure for number in each if chances[number] > _ONE_OF_A_LIST]


def _is_a_limit(plain: str, number: Number, bounded: Sequence[tuple[int, int]]) -> bool:
    """Whether a number can be no mere description: it is bounded, scaled ("2M"), a part of one, or has a unit."""
    within = any(start <= number.end and number.start < end for start, end in bounded)
    part = number.value is not None and 0 < number.value < 1
    return within or part or may_be_a_limit(plain, number)
