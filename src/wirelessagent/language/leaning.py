"""Numbers that lean on the unit of another: lists, corrections, and what the next user gets.

"600 and 900 kbit/s", "10 W, sorry, 12", "user 1 gets 2 Mbit/s, user 2 one and a half", "2 megas por usuario y 3 para el
5". A number leans only where the words around it have the same form as those of a figure; a count or a name never does.
"""

from __future__ import annotations

import bisect
import dataclasses
import re
from collections.abc import Sequence

from wirelessagent.language.deferred import deferred
from wirelessagent.language.readings import Reading
from wirelessagent.language.text import USER_NOUN
from wirelessagent.language.units import Unit, unit_at

_ENDS = deferred(
    r"(?i)\s*(?:$|[,;:!?)\uff0c。\uff1b、]|\.(?![0-9])|(?:and|y|et|und|but|pero|mais|aber|then|now|please|each|at\s+least|"
    r"at\s+most|cada\s+uno|chacun|je|max|min)\b)"
)
_OTHERS = (
    r"(?:(?:every|any)(?:one|body)(?:\s+else)?|all\s+(?:the\s+)?others?|(?:the\s+|all\s+)?others?|the\s+rest|each|"
    r"(?:a\s+)?(?:tod[oa]s\s+)?(?:los|las)\s+dem[aá]s|el\s+resto|los\s+otros|cada\s+uno|"
    r"(?:aux?\s+|les\s+|tous\s+les\s+)?autres|le\s+reste|chacun|"
    r"(?:(?:die|den|alle[n]?|allen)\s+)?(?:anderen|andern|übrigen|restlichen)|(?:der|den|dem)\s+rest|jede[rnm]?)"
)
_USER = (
    rf"(?:{USER_NOUN}\s*(?:[0-9]{{1,2}}|[a-zß-ÿ]+)(?:\s*(?:,|and|y|et|und|&)\s*(?:{USER_NOUN}\s*)?[0-9]{{1,2}})*|"
    r"\b(?:al|el|le|der|den|dem)\s+[0-9]{1,2})"
)
_LINK = (
    r"(?:\s|:|=|\b(?:is|are|at|gets?|should|must|have|has|needs?|wants?|takes?|with|on|only|even|just|to|con|recibe[n]?|"
    r"tiene[n]?|necesita[n]?|que|avec|à|a|aura|obtient|reçoit|mit|auf|bei|bekommt|kriegt|kriegen|bekommen|braucht|"
    r"brauchen|reichen|reicht|wenigstens|mindestens|höchstens|sogar|nur|al\s+menos|au\s+moins|at\s+least|at\s+most)\b)"
)
_SUBJECT_BEFORE = deferred(rf"(?i)(?:\b{_USER}|\b{_OTHERS},?){_LINK}*(?:\s+|\bd')$")
_SUBJECT_AFTER = deferred(
    rf"(?i)\s+(?:promis(?:ed)?\s+)?(?:(?:for|to|para|pour|für|an)\s+(?:el\s+|la\s+|l'|den\s+|die\s+|dem\s+|the\s+)?|"
    rf"à\s+l'|à\s+|al?\s+)(?:{USER_NOUN}\s*[0-9]{{1,2}}|{_OTHERS}\b|[0-9]{{1,2}}\b|all\b|each\b)"
)
_JOINED_ON = deferred(r"(?i)(?:[,;:(]|\b(?:and|y|et|und|but|pero|mais|aber))\s*$")
_PRONOUN = deferred(r"(?i)\b(?:others?|every|each|any|the|this|that|which|no|some|only|last|\w+st)\s+$")
_OF_MANY = deferred(  # "the other five", "UE 1 à 3": a count of users, or the last of them
    rf"(?i)(?:\b(?:others?|otros|dem[aá]s|autres|anderen|andern|übrigen|restlichen)|\b{USER_NOUN}\s*[0-9]{{1,2}}\s+"
    r"(?:à|a|to|bis|hasta))\s+$"
)
_POWER_BEFORE = deferred(
    r"(?i)\b(?:electronics|circuit(?:s|ry)?|hardware|baseband|transmitter|elektronik|schaltung|sender|electrónica|"
    r"circuitos?|transmisor|électronique|circuits|émetteur)\s+(?:alone\s+)?(?:takes?|eats?|uses?|burns?|draws?|needs?|"
    r"can\s+do|gets?|at|frisst|braucht|verbraucht|nimmt|darf|come[n]?|consume[n]?|gasta[n]?|prend|consomme|mange)\s+$"
)
_MARKER = deferred(
    r"(?i)\b(?:no|nope|wait|hang\s+on|hold\s+on|sorry|i\s+mean|i\s+meant|make\s+(?:that|it)|scratch\s+that|correction|"
    r"oops|rather|actually|better|pardon|non|plutôt|nein|entschuldigung|lieber|besser|perd[oó]n|mejor|digo|disculpa|"
    r"ich\s+meine|je\s+veux\s+dire|quiero\s+decir|typo)\b|不对|不是|应该是|改成|改为|说错|哦不|错了|口误|更正"
)
_AFTER_MARKER = deferred(  # what may stand between the last comma of a correction and its number
    rf"(?i)(?:[\s…-]|{_MARKER.pattern.removeprefix('(?i)')}|\b(?:ach|oh|uh|er|at\s+most|at\s+least|under|below|max|only|just|it|that|to|of|"
    r"better|then|plutôt|con|mit|avec|under|höchstens|mindestens|como\s+mucho|au\s+plus|es\s+sind|eher)\b|[是成到呃嗯])*$"
)
_JOINS = deferred(
    r"(?i)\s*(?:and|or|y|o|et|ou|und|oder|beziehungsweise|bzw\.?|respectively|和|、)"
    r"(?:\s*(?:at\s+most|up\s+to|höchstens|maximal|como\s+mucho|como\s+máximo|au\s+plus|max|最多|至多))?\s*$"
)
_COMMA = deferred(r"\s*[,、]\s*$")
_NAMED_BEFORE = deferred(
    rf"(?i)(?:\b{USER_NOUN}|\b(?:al|el|le|der|den|dem|the|slots?|day|no\.?))\s*(?:[0-9]+\s*,\s*)*$"
)
_DECLARED = deferred(r"(?i)\b(?:in|en)\s+")
_SENTENCE_END = deferred(r"[!?。]|\.(?=\s|$)")


def with_units(plain: str, found: Sequence[Reading]) -> list[Reading]:
    """The readings of a normalised text, with units for the numbers that lean on another's."""
    leaning = list(found)
    for place in range(len(leaning) - 2, -1, -1):
        if _shares_next(plain, leaning, place):
            leaning[place] = _with(leaning[place], leaning[place + 1].unit)
    if all(reading.unit is not None for reading in leaning):
        return leaning
    declared = _declared(plain)
    stops = [0, *(stop.end() for stop in _SENTENCE_END.finditer(plain))]
    for place, reading in enumerate(leaning):
        if reading.unit is None and reading.number.value is not None and reading.end == reading.number.end:
            leaning[place] = _with(reading, _unit_for(plain, leaning, place, declared, stops))
    return leaning


def _with(reading: Reading, unit: Unit | None) -> Reading:
    if unit is None:
        return reading
    return dataclasses.replace(reading, unit=dataclasses.replace(unit, end=reading.end))


def _shares_next(plain: str, found: Sequence[Reading], place: int) -> bool:
    """Whether a number shares the unit of the next one in a list: "2, 4 and 6 Mbit/s"."""
    one, other = found[place], found[place + 1]
    if one.unit is not None or other.unit is None or one.number.value is None or one.end != one.number.end:
        return False
    if other.unit.kind == "ratio" or _NAMED_BEFORE.search(plain, max(0, one.start - 24), one.start):
        return False
    if re.search(r"(?i)(?:between|entre|zwischen)\s*$", plain[max(0, one.start - 12) : one.start]):
        return False  # a range, which is read elsewhere
    gap = plain[one.end : other.start]
    listed = other.end == other.number.end and _COMMA.match(gap) is not None
    return listed or _JOINS.match(gap) is not None or _is_third(plain, found, place)


def _is_third(plain: str, found: Sequence[Reading], place: int) -> bool:
    """Whether commas alone join three numbers, of which the last has a unit: "1, 2, 3 Mbit/s"."""
    if place == 0:
        return False
    first, one, other = found[place - 1 : place + 2]
    bare = first.unit is None and first.number.value is not None and first.end == first.number.end
    gaps = (plain[first.end : one.start], plain[one.end : other.start])
    return bare and all(_COMMA.match(gap) is not None for gap in gaps)


def _unit_for(
    plain: str, found: Sequence[Reading], place: int, declared: Sequence[tuple[int, Unit]], stops: Sequence[int]
) -> Unit | None:
    reading = found[place]
    last = found[place - 1] if place else None
    if last is not None and last.unit is not None and _corrects(plain, last, reading):
        return last.unit
    before = plain[max(0, reading.start - 60) : reading.start]
    since = stops[bisect.bisect_right(stops, reading.start) - 1]
    if _POWER_BEFORE.search(before) and _ENDS.match(plain, reading.end):
        return _nearest(found[:place], "power", since)
    leads = _SUBJECT_BEFORE.search(before) and _ENDS.match(plain, reading.end)
    follows = _JOINED_ON.search(before) and _SUBJECT_AFTER.match(plain, reading.end)
    if not leads and not follows:
        return None
    value = reading.number.value
    if leads and value is not None and 1 < value <= 20 and value == int(value) and _OF_MANY.search(before):
        return None
    if value == 1 and _PRONOUN.search(before):
        return None  # "every other one"
    if re.search(rf"(?i)\b{USER_NOUN}\s*$", before):
        return None
    ahead = [unit for end, unit in declared if since <= end <= reading.start]
    return _nearest(found[:place], "rate", since) or (ahead[-1] if ahead else None)


def _corrects(plain: str, last: Reading, reading: Reading) -> bool:
    """Whether a number stands in the place of the figure before it: "10 W, sorry, 12"."""
    gap = plain[last.end : reading.start]
    if len(gap) > 60 or _MARKER.search(gap) is None or not _ENDS.match(plain, reading.end):
        return False
    return _AFTER_MARKER.match(re.split(r"[,;\uff0c…]|\.{3}", gap)[-1]) is not None


def _nearest(found: Sequence[Reading], kind: str, since: int) -> Unit | None:
    """The unit of the nearest figure of a kind before, in the same sentence."""
    for each in reversed(found):
        if each.start < since:
            return None
        if each.unit is not None and each.unit.kind == kind:
            return each.unit
    return None


def _declared(plain: str) -> list[tuple[int, Unit]]:
    """The rates' unit where it is said before them: "en megas: 6 para el usuario 2"."""
    units = ((match.end(), unit_at(plain, match.end())) for match in _DECLARED.finditer(plain))
    return [(end, unit) for end, unit in units if unit is not None and unit.kind == "rate"]
