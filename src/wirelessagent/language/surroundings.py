"""What stands beside a figure and changes its meaning: arithmetic, something else's power, a part of the users."""

from __future__ import annotations

import functools
from collections.abc import Sequence

from wirelessagent.language import figure_words, lexicon
from wirelessagent.language.clauses import clause_end, clause_start
from wirelessagent.language.deferred import deferred
from wirelessagent.language.quantities import Quantity

_OPERATOR = r"\^*×·⋅∙÷+±√∛"
_CALCULATED_BEFORE = deferred(
    rf"(?i)(?:[{_OPERATOR}]|(?<![wW])/|(?<![a-z])x|\b(?:twice|thrice|double|triple|quadruple|times|half|thirds?|"
    rf"quarters?|"
    r"tenths?|fraction|part|(?<!at )most|some|all but|portion|share|multiple|(?<!au )plus|minus|square|root|sqrt|sum)"
    r"(?:\s+(?:of|the|an?))*"
    r"|[倍半加减乘除]之?[一二三]?[的以上去]?|分之[一二三]的?|(?<![\w.,])[0-9][0-9.,]*\s+(?:out\s+)?of\s+(?:the|our)(?:\s+\w+)?)\s*$"
)
_CALCULATED_AFTER = deferred(
    rf"(?i)\s*(?:[{_OPERATOR}]|/\s*[0-9]|x\s*[0-9]|[加减乘除]|(?:times|squared|cubed|divided|multiplied|plus|minus|"
    r"doubled|halved|tripled)\b|的?(?:[一二两三四五十]?倍|一半|[二三四五十]分之))"
)

# Words beside a power which say that it isn't the cell's to radiate.
_SPARED = deferred(
    r"(?i)\b(?:unused|reserved?|reserves|(?<!can )(?<!could )spare|aside|headroom|leave|leaves|leaving|left|"
    r"remaining|remains|"
    r"untouched|lost|"
    r"lose|losing|behind|free|wasted?|wasting|margin)\b|[留剩余]|备用|闲置"
)
_HELD = deferred(r"(?i)\b(?:keep|keeping|hold|hold back|retain|lose|losing|steal|donate)\s+(?:the\s+|about\s+)?$")
_DRAWN = deferred(
    r"(?i)(?P<by>[a-z]+)\s+(?:uses?|draws?|consumes?|takes?|needs?|burns?|emits?|radiates?|has|swallows?|eats?|"
    r"gobbles?|guzzles?|sucks?)\s+(?:about\s+|around\s+)?$"
)
_DETERMINED = deferred(  # "a 100 W bulb", against "thirty watts permit"
    r"(?i)\b(?:an?|the|another|his|her|their|my|this|that|some|every|each|one|un|una|une|ein|eine|einen|einer)\s+$"
)
_OURS = (
    "it we they you i that which to can may cell cells network system station transmitter amplifier not dont and or "
    "then please should must"
)
_STOP_WORDS = (
    "a all allowed altogether and apiece are as at available be because before but by cap ceiling combined each "
    "either every everyone everybody everything for from go get give if in is it its just less limit make no nobody of "
    "on only or our output overall per please radio rf shall should since so sum thanks that the their them then there "
    "these this though to together tops total today tonight totally transmit transmitted transmission transmitter tx "
    "until us use used using we when where which while who whole will with within without you your allowance "
    "apply available below above beyond under over not now ok okay again anyway instead keep keeping let lets thats "
    "subject promise promised everywhere"
)
_FIRST_WORD = deferred(r"\s*-?\s*([A-Za-z']+)")

_ALL = deferred(r"(?i)\b(?:all|all of|all the|every one of)\s*(?:the\s+|our\s+|these\s+)?$|(?:所有|全部)的?\s*$")
_DESCRIBED_BEFORE = deferred(
    r"(?i)(?:^|\b(?:the|our|these|those|my|with|have|has|of|are|serve|serving|and|among|between|total|per|over|"
    r"across|into)|[有共])\s*$"
)
_DESCRIBED_AFTER = deferred(
    r"(?i)\s*(?:$|(?:in|on|and|at|within|under|with|each|per|over|connected|total|online|active|now|max|min|maximum|"
    r"minimum|or|share|sharing)\b|[每都共同])"
)
_TOO_MUCH = deferred(
    r"(?i)[\s,]*(?:(?:each|apiece|per user|for (?:each|every|all)\w*|(?:for )?users? [0-9]+|cada uno|chacun|"
    r"für jeden)\s+)?"
    r"(?:(?:(?:is|are|was|were|seems?|looks?|sounds?|feels?|would be|es|son|c'est|est|sont|ist|sind|wäre[n]?)\s+)?"
    r"(?:way|far|much|a bit|a little|simply|just|still|rather|bien|mucho|viel)?\s*"
    r"(?:too (?:much|many|little|few|low|high|slow|fast|weak)|not (?:enough|sufficient|good enough)|insufficient|"
    r"excessive|"
    r"demasiado|muy poco|trop(?: peu)?|zu (?:viel|wenig|hoch|niedrig|langsam))\b|"
    r"(?:is|are|was|were)n't (?:enough|sufficient)\b|(?:will not|won't|would not|wouldn't) (?:do|suffice|be enough)\b|"
    r"(?:no|ne) (?:basta|alcanza|suffi)\w*|(?:reich(?:t|en)|genüg(?:t|en)) nicht\b)|"
    r"\s*(?:实在|有点|还是|都|也|还)*(?:太[多少高低大小慢快]|不够|过[多高低大少]|偏[多高低少])"
)
_UNWANTED = deferred(
    r"(?i)(?:\b(?:do|does|did)(?:n't| not) (?:want|need|require|have)|\bno longer (?:want|need|require)|"
    r"\b(?:no quiero|no necesit\w+)|\b(?:je ne veux pas|ne veux pas(?: de)?)|"
    r"\b(?:will|wollen|brauche[nt]?|möchten?) keine)\s*"
    r"(?:(?:the|a|an|any|all|that|those|them all|everyone|everybody|each|to have|on)\s+)*$|"
    r"(?:不想要|不需要|不再要求|不再需要|不再要|(?<!要)不要(?!超|低|少|高|大))(?:每人|每个用户|每户|大家|都|有|给|的)*\s*$"
)


def beside(plain: str, quantities: Sequence[Quantity], index: int) -> tuple[str, str]:
    """What stands before and after a figure within its clause, other figures being borders too."""
    figure = quantities[index]
    start = quantities[index - 1].end if index else 0
    end = quantities[index + 1].phrase_start if index + 1 < len(quantities) else len(plain)
    return plain[clause_start(plain, figure.start, start) : figure.start], plain[
        figure.end : clause_end(plain, figure.end, end)
    ]


def signs(figure: Quantity, before: str, after: str) -> list[str]:
    """What the words beside a power say of it by themselves; nothing of other figures."""
    if figure.kind != "power":
        return []
    ahead = figure_words.CIRCUIT.search(before)
    if ahead is not None and figure_words.RADIATED.search(before, ahead.end()):
        ahead = None
    found = {
        "circuit ahead": ahead is not None,
        "circuit behind": figure_words.CIRCUIT.search(after) is not None,
        "radiated": figure_words.RADIATED.search(before + after) is not None,
        "not ours": not is_cells_power(before, after),
    }
    return [name for name, holds in found.items() if holds] or ["nothing"]


def is_calculated(before: str, after: str) -> bool:
    """Whether a figure is a part of a calculation, which nobody has carried out: "half of 10 W", "2*5 W"."""
    return _CALCULATED_BEFORE.search(before) is not None or _CALCULATED_AFTER.match(after) is not None


def is_refused(before: str, after: str) -> bool:
    """Whether a figure is called wrong or is not wanted: "5 W is too much", 我不要每人1兆."""
    return _TOO_MUCH.match(after) is not None or _UNWANTED.search(before) is not None


def is_cells_power(before: str, after: str) -> bool:
    """Whether a power may be what the cell radiates, rather than a reserve ("leave 10 W unused") or a bulb's."""
    if _SPARED.search(before) or _SPARED.search(after) or _HELD.search(before):
        return False
    drawn = _DRAWN.search(before)
    if drawn is not None and drawn["by"].lower() not in _OURS.split():
        return False
    word = _FIRST_WORD.match(after)
    if word is None or _DETERMINED.search(before) is None:
        return True
    return word[1].lower().replace("'", "") in _known_words()


def describes_all(before: str, after: str) -> bool:
    """Whether a count of users tells how many there are, rather than picking some: "for 3 users" picks."""
    if _ALL.search(before):
        return True
    return _DESCRIBED_BEFORE.search(before) is not None and _DESCRIBED_AFTER.match(after) is not None


@functools.cache
def _known_words() -> frozenset[str]:
    listings = [*lexicon.CONCEPTS.values(), *lexicon.DIRECT.values()]
    words = set(_STOP_WORDS.split())
    words |= {word for listing in listings for phrase in listing.split() for word in phrase.split("_")}
    return frozenset(words)
