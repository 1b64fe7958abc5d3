"""A number or a user that the next words take back: "at least 1, no, 2 Mbit/s", "for user 3, sorry, user 5".

What is taken back is blanked before anybody reads the sentence; everything else stays where it stands. A figure whose
own unit is said is left to the model of roles, which sees what it was.
"""

from __future__ import annotations

import re

from wirelessagent.language.deferred import deferred
from wirelessagent.language.mentions import ARTICLES, JOINT_WORDS, NOUN, WORD_NUMBER, ZH_NOUN
from wirelessagent.language.text import NUMBERED_USERS, normalise
from wirelessagent.language.units import unit_at
from wirelessagent.language.word_tables import either

_DIGIT = "一二两三四五六七八九十"
_NUMBER = rf"(?:(?<![A-Za-z0-9.,])[0-9]+(?:[.,][0-9]+)?|\b{WORD_NUMBER}\b|(?<![{_DIGIT}])[{_DIGIT}]{{1,3}}+)"
_NOUN = rf"(?:{NOUN}|{ZH_NOUN})"
_FOR = rf"(?:{either('figures', 'users', 'given_to')}|{ARTICLES})"
_BREAK = r"\s*+(?:[,;\uff0c；、]|[-–—…]++|\.{2,3}+)\s*+"
_CORRECTS, _MEANS = (either("figures", "one", name) for name in ("corrects", "means"))
_JOINT = rf"(?:{JOINT_WORDS}|\b(?:to|thru|through|bis|hasta|al?|à)\b|[~/&+、到至和与]|(?<=[0-9])[-–](?=[0-9]))"
_NEAR = 60
_TAKEN_BACK = deferred(
    rf"(?i)(?P<noun>{_NOUN}\s*+)?(?P<wrong>{_NUMBER}(?:\s*+(?P<hao>号))?)"
    rf"(?:(?:{_BREAK}|\s++)(?:(?:{_CORRECTS}){_BREAK})*+(?P<means>{_MEANS})(?:{_BREAK}|\s*+)"
    rf"|{_BREAK}(?:(?:{_CORRECTS})(?:{_BREAK}|\s++(?={_CORRECTS})))++)"
    rf"(?=(?P<again>(?:[^\W\d]+\s+){{0,2}}?)(?:{_FOR}\s*+)*(?P<other>{_NOUN}\s*+)?(?P<right>{_NUMBER})(?:\s*+(?P<other_hao>号))?)"
)
_OF_USERS = deferred(rf"(?i)(?:{_FOR}|{NUMBERED_USERS.removesuffix('$')})\s*$")
_LIST_AHEAD = deferred(rf"(?i){_NUMBER}\s*号?\s*(?:,\s*)?(?:{_JOINT}|,)\s*(?:{_FOR}\s*)?(?:{_NOUN}\s*)?$")
_LIST_BEHIND = deferred(rf"(?i)\s*号?\s*{_JOINT}\s*(?:{_FOR}\s*)?(?:{_NOUN}\s*)?{_NUMBER}")


def without_corrected(text: str) -> str:
    """The sentence without what it takes back, all else at its place.

    >>> " ".join(without_corrected("user 6 at least 1, no, 2 Mbit/s").split())
    'user 6 at least 2 Mbit/s'
    >>> " ".join(without_corrected("for user 3 - sorry, I mean user 5 - 1 Mbit/s").split())
    'for user 5 - 1 Mbit/s'
    """
    for match in _TAKEN_BACK.finditer(normalise(text)):
        if _is_taken_back(match):
            start = match.start("noun" if match["noun"] and match["other"] else "wrong")
            text = text[:start] + " " * (match.end() - start) + text[match.end() :]
    return text


def _is_taken_back(match: re.Match[str]) -> bool:
    """Whether a user is corrected by a user, or a figure by a figure, with no words between but those ahead of both.

    What of a list is taken back, nobody knows: "users 1 and 2, no, 3".
    """
    said, ahead = match.string, match.string[max(0, match.start() - _NEAR) : match.start()]
    again, same = match["again"].casefold().rstrip(), match["wrong"].strip(" 号") == match["right"]
    lists = _LIST_AHEAD.search(ahead) or _LIST_BEHIND.match(said, match.end("right"))
    if same or lists or not ahead.casefold().rstrip().endswith(again):  # "drop 7, no, 7 stays"
        return False
    user = bool(match["noun"] or match["hao"] or _OF_USERS.search(ahead))
    other = bool(match["other"] or match["other_hao"])
    if unit_at(said, match.end("right")) is not None:
        return not user
    return other or match["means"] is None if user else not other  # "weight for user 3: make it 2"
