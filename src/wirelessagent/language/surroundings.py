"""What beside a figure changes its meaning: arithmetic, a correction, another figure, something else's power."""

from __future__ import annotations

import functools
from collections.abc import Sequence

from wirelessagent.language import lexicon
from wirelessagent.language.clauses import clause_end, clause_start
from wirelessagent.language.deferred import deferred
from wirelessagent.language.mentions import Mention
from wirelessagent.language.quantities import Quantity
from wirelessagent.language.word_tables import words_of

CIRCUIT = deferred(
    r"(?ia)\b(?:circuits?|circuitry|static|fixed|idle|overhead|baseline(?= (?:power|consumption|draw|load|"
    r"energy))|stand-?by|quiescent|electronics|hardware|"
    r"cooling|constant)\b"
    r"(?:\s+(?:power|energy|consumption|draw|load)\b)*|(?<![A-Za-z])p[_ ]?c(?:ircuit)?(?![A-Za-z])|\b(?:fij[oa]s?|"
    r"circuitos?|(?<!on )(?<!je )fixe(?!\s+(?:à|un|une|le|la|[0-9]))|statique|schaltung\w*|"
    r"fest\w{0,2}|grundlast|grundverbrauch|ruheverbrauch|elektronik)\b|(?:\b(?:cabinet|rack|baseband|bbu|boards?|"
    r"equipment|shelter|fans?|rectifier)\b)|\b(?:regardless of (?:the )?(?:traffic|load)|no matter the load|"
    r"even (?:when |while )?idle|by itself|on its own|at zero load|without any traffic)\b|(?:机柜|基带|主设备|空载|"
    r"风扇|电路|静态|固定|基础|设备自身|待机|硬件|板子|整机|器件|本底)"
    r"(?:功率|功耗|能耗|消耗|耗电|损耗)?"
)
_RADIATED = deferred(
    r"(?i)\b(?:transmit|transmission|transmitted|tx|radiated|output|p_?max|sendeleistung|strahl\w*|"
    r"puissance d'émission|"
    r"potencia (?:de transmisión|radiada))\b|发射|辐射"
)
CORRECTION = deferred(
    r"(?ia)\b(?:no|nope|wait|sorry|i mean|i meant|make (?:that|it)|scratch that|rather|correction|oops|actually|"
    r"better|pardon|er|"
    r"non|nein|perdón|pardon|mejor|plutôt|lieber|besser|doch|digo|ich meine|je veux dire|quiero decir|strike that|"
    r"let's say)\b|"
    r"[,\uff0c。]\s*不\s*[,\uff0c]|不对|不是|应该是|改成|改为|算了|错了|说错|还是|哦不|不不|口误|更正|纠正"
)
PER_USER = deferred(
    r"(?i)\s*(?:each\b|apiece\b|(?:per|a|for (?:each|every)|por|par|pro|je)\s+"
    rf"(?:{'|'.join(words_of('figures', 'users', 'each'))}|subcarrier|channel|carrier|antenna|tone)|/\s*(?:user|ue)|每)"
)
TOTAL_AFTER = deferred(
    r"(?i)\s*(?:of\s+)?(?:in\s+total|total|altogether|overall|combined|in\s+sum|"
    r"(?:to\s+be\s+)?(?:split|shared|divided|distributed))\b"
)
CHANGE_BEFORE = deferred(
    r"(?i)(?:\b(?:by|save|saves|saving|cut|another|extra|additional|reduce|(?<!au )plus|increase)\s*(?:about|"
    r"around|roughly)?|"
    r"(?:减少|降低|节省|省下?|增加|提高|再加|(?<![最至])多给|下降|提升|升高|(?<=[功速]率)[降减升增加])了?)\s*$"
)
CHANGE_AFTER = deferred(r"(?i)\s*(?:(?:of\s+)?(?:more|less|lower|higher|faster|extra)\b)")
CARRIER = (
    r"(?:sub-?carriers?|tones?|carriers?|rbs?|resource blocks?|subportadoras?|sous-porteuses?|(?:unter|sub)träger[ns]?)"
)
_ONE_OF = (
    r"(?:each|every|any|no|an?|one|the|single|individual|cada|una|ninguna|sola|chaque|une|aucune|seule|jede[mnr]?|"
    r"eine[mnr]?|keine?[mnr]?|einzelne[mnr]?)"
)
SUBCARRIER = deferred(
    r"(?i)\s*(?:of\s+power\s+)?(?:/|(?:per|por|par|pro|je|on|for|in|at|into|over|en|sur|auf)(?!\w)|(?=each|any))"
    rf"[\s-]*(?:{_ONE_OF}\s+)*{CARRIER}(?!\w)"
)
SUBCARRIER_BEFORE = deferred(
    rf"(?i)(?:(?<!\w)(?:{_ONE_OF}|per|por|par|pro|je)[\s-]+(?:{_ONE_OF}\s+)*{CARRIER}(?!\w)|"
    r"(?:每个?|单个?|任一|任何|各)子载波)[^,;.，。]{0,40}$"
)

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

_RANGE_GAP = 8
_NEAR = 30


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
    ahead = CIRCUIT.search(before)
    if ahead is not None and _RADIATED.search(before, ahead.end()):
        ahead = None
    found = {
        "circuit ahead": ahead is not None,
        "circuit behind": CIRCUIT.search(after) is not None,
        "radiated": _RADIATED.search(before + after) is not None,
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


class Neighbours:
    """The figures of a normalised sentence, by their place among them."""

    def __init__(self, plain: str, figures: Sequence[Quantity], mentions: Sequence[Mention]) -> None:
        self._plain, self.figures, self._mentions = plain, figures, mentions

    def beside(self, index: int) -> tuple[str, str]:
        """What stands before and after a figure within its clause, other figures being borders too."""
        return beside(self._plain, self.figures, index)

    def is_replaced(self, index: int) -> bool:
        """Whether a rate is corrected by the next figure, nobody being named between: "1 Mbit/s, sorry, 2 each"."""
        if {each.kind for each in self.figures[index : index + 2]} != {"rate"} or index + 1 == len(self.figures):
            return False
        figure, other = self.figures[index], self.figures[index + 1]
        named = any(m.role == "named" and figure.end <= m.start < other.start for m in self._mentions)
        gap = self._plain[figure.end : other.start]
        return not named and len(gap) < _NEAR and CORRECTION.search(gap) is not None

    def ends_a_range(self, index: int) -> bool:
        """Whether a figure is the upper end of a range, and so for whomever the lower one is."""
        if not 0 < index < len(self.figures):
            return False
        lower, figure = self.figures[index - 1], self.figures[index]
        near = figure.start - lower.end <= _RANGE_GAP and lower.kind == figure.kind
        parted = any(lower.end <= mention.start < figure.start for mention in self._mentions)
        return near and not parted and (lower.comparator, figure.comparator) == ("at_least", "at_most")

    def is_of_a_subcarrier(self, index: int) -> bool:
        """Whether a power is that of a single subcarrier."""
        before, after = self.beside(index)
        return bool(SUBCARRIER.match(after) or SUBCARRIER_BEFORE.search(before))


def is_change(before: str, after: str) -> bool:
    """Whether the figure is an amount to save or to add, not a limit."""
    return CHANGE_BEFORE.search(before) is not None or CHANGE_AFTER.match(after) is not None
