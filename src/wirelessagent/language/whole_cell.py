"""What a sentence says of the whole cell, without a figure of its own: blocks, shares of the power, counts of users.

Counts describe the channel where all users are meant ("for our 8 users"); a part of the users, and a half of something,
raise a doubt.
"""

from __future__ import annotations

from collections.abc import Sequence

from wirelessagent.language.deferred import deferred
from wirelessagent.language.mentions import BY_PLACE, PLACED
from wirelessagent.language.number_words import cardinals
from wirelessagent.language.numerals import numbers
from wirelessagent.language.stated import Notes
from wirelessagent.language.text import Phrases, Span, clause_end, clause_start, is_within, overlaps
from wirelessagent.language.word_tables import either

_CARRIER = (
    r"(?:sub-?carriers?|tones?|carriers?|rbs?|resource blocks?|subportadoras?|sous-porteuses?|"
    r"(?:unter|sub)träger[ns]?)"
)
_CHANGE_BEFORE = deferred(rf"(?i)(?:{either('figures', 'one', 'changed_by')})\s*(?:about|around|roughly)?\s*$")
_CHANGE_BEHIND = deferred(rf"(?i)\s*(?:{either('figures', 'one', 'changed_behind')})(?!\w)")
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
_POWER_NOUNS = "power|potencia|puissance|leistung|sendeleistung"
_POWER = rf"(?:maximalleistung|{_POWER_NOUNS}|budget|watts|wattage|presupuesto)\b(?:\s+(?:budget|limit))?"
_MOST = (
    r"(?:(?:max|máx)\w*\.?|limitée?|limitada|begrenzt|limited|at|to|of|auf|à|a|al|is|=|<=|≤|:|at most|up to)?\s*"
    r"(?:(?:max|to|auf|à|a|al|au|at)\.?\s*)?"
)
_FULL = (
    r"(?:\s+|of|de|d'|the|our|its|full|max|maximum|total|available|allowed|transmit|tx|la|el|del|notre|nuestra|der|die|"
    r"unserer|vollen|maximalen)*"
)
_SHARES = {
    **dict.fromkeys(("half", "mitad", "moitié", "halbe", "halber", "halben", "hälfte", "一半"), 1 / 2),
    **dict.fromkeys(("third", "tercio", "tiers", "drittel", "三分之一"), 1 / 3),
    **dict.fromkeys(("two thirds", "dos tercios", "deux tiers", "zwei drittel", "zwei dritteln", "三分之二"), 2 / 3),
    **dict.fromkeys(("quarter", "cuarto", "quart", "viertel", "四分之一"), 1 / 4),
    **dict.fromkeys(
        ("three quarters", "tres cuartos", "trois quarts", "drei viertel", "drei vierteln", "dreiviertel"), 3 / 4
    ),
    **{f"{letter}成": place / 10 for place, letter in enumerate("一二三四五六七八九", start=1)},
}
_SHARE_WORDS = "|".join(sorted(_SHARES, key=len, reverse=True))
_SHARE = Phrases(
    r"(?<!save )(?<!by )(?<!saving )(?<!cut )"
    rf"(?:\b(?:(?:a|one|un|ein|einem) (?![hm])|la (?=m))?(?P<word>{_SHARE_WORDS})\b|"
    r"(?<![\w.,])(?P<percent>[0-9]{1,3}(?:[.,][0-9]+)?)\s*(?:%|percent|per cent|prozent|por ciento|pour cent))"
    rf"{_FULL}\s*{_POWER}|(?:用|以|只用|最多用|不超过)?(?:(?P<zh_word>{_SHARE_WORDS})|"
    r"(?<![0-9.,])(?P<zh_percent>[0-9]{1,3}(?:[.,][0-9]+)?)%|百分之(?P<hundredths>[0-9]{1,3}))的?(?:发射|總|总)?(?:功率|预算)(?!放大)"
    rf"|功率(?:只用|最多用|用|不超过|最多|压到|降到)?(?:到)?(?P<of_word>{_SHARE_WORDS})(?!五)"
    rf"|\b(?:p_?max|(?:max\w*\.?\s+)?(?:{_POWER_NOUNS}))\s*{_MOST}(?P<of_percent>[0-9]{{1,3}}(?:[.,][0-9]+)?)\s*%"
    r"|功率(?:只用|最多用|用|不超过|最多|压到|降到|限制在|限制到|上限为?)(?P<zh_of_percent>[0-9]{1,3}(?:[.,][0-9]+)?)%",
    marks="half mitad moitié halbe hälfte third tercio tiers drittel quart cuarto viertel % percent per_cent prozent "
    "por_ciento pour_cent 一半 百分之 分之 成",
)
_IN = {"pairs": 2, "twos": 2, "threes": 3, "fours": 4, "sixes": 6}
_SIZE = r"[0-9]{1,3}|[a-zäéöûü]{3,8}"
_GROUP = (
    r"(?:(?:bloques|blocs) de (?:recursos|ressources)|"
    r"groups?|blocks?|bundles?|chunks?|clusters?|packs?|p?rbs?|rbgs?|grupos|bloques|groupes?|blocs|paquets|paquetes)"
)
_BLOCK = r"(?:p?rbg?|group|block|bundle|grupo|bloque|groupe|bloc|gruppe|(?:ressourcen)?block)"
_PER = r"(?:per|in (?:a|each|every)|to a|each|por|par|pro|je|bilden einen)"
_DIGITS, _ZH_DIGITS = "[0-9]{1,3}", "[0-9]{1,3}|[二两三四五六八十]{1,2}"
_TIED = r"(?:一组|为一组|一块|为一块|捆绑|绑定|分组|一个组|成组|(?:组成|构成)一个?(?:资源)?[块组])"
_BLOCKS = Phrases(
    rf"(?:\b{_GROUP}\s+(?:of|de|with)\s+(?:size\s+|tamaño\s+|taille\s+)?(?P<of>{_SIZE})\b"
    rf"(?:\s+(?:adjacent\s+|neighbouring\s+)?{_CARRIER}(?!\w))?"
    rf"|\b(?:gruppen|(?:ressourcen)?blöcken?|rbs?)\s+(?:von|zu|à|aus|mit)\s+(?:je\s+)?(?P<zu>{_SIZE})\b"
    rf"(?:\s+{_CARRIER}(?!\w))?"
    rf"|\b(?P<per>{_SIZE})\s+(?:adjacent\s+|neighbouring\s+)?{_CARRIER}\s+{_PER}\s+{_BLOCK}\b"
    rf"|\b(?P<dashed>{_DIGITS})-{_CARRIER}\s+{_GROUP}\b"
    rf"|\b(?:resource[- ]block[- ]group|{_BLOCK})[\s-]?(?:size|大小|größe)"
    rf"\s*(?:of|=|:|is|为|是|von)?\s*(?P<size>{_DIGITS})"
    rf"|\b(?:tamaño|taille)\s+(?:de|du|del)\s+{_BLOCK}\s*(?:de|=|:)?\s*(?P<de>{_DIGITS})"
    rf"|\b(?:p?rb\s*=|rbg\s*[=:]?)\s*(?P<equals>{_DIGITS})\b"
    rf"|\bgroup(?:ed|ing)?\s+(?:the\s+)?{_CARRIER}\s+(?:by|in)\s+(?P<grouped>{_DIGITS})\b"
    rf"|{_CARRIER}(?:\s+\w+){{0,3}}\s+(?:in|par)\s+(?P<in>{'|'.join(_IN)}|deux|trois|quatre|six|huit|{_DIGITS})\b"
    rf"|{_CARRIER}(?:\s+\w+){{0,2}}\s+(?P<by>[a-z]{{3,6}}) by (?P=by)\b"
    r"|\b(?P<fold>zweier|dreier|vierer|fünfer|sechser|achter|zehner|zwölfer)(?:gruppen|blöcken?|päckchen)\b"
    rf"|(?:每|按)?(?P<zh>{_ZH_DIGITS})个?(?:子载波|资源块){_TIED}"
    rf"|(?:子载波|资源块)(?:按|以|每)?(?P<apart>{_ZH_DIGITS})个?(?:为|分)?(?:一|成)?[组块](?:来?分(?:配)?)?"
    rf"|(?:资源块|块|rb)大小(?:为|是|=)?(?P<big>{_DIGITS})|每个?(?:资源)?(?:块|rb)\s?(?P<each>{_DIGITS})个子载波)",
    marks="group block bundle chunk cluster pack rb 子载波 块 grup bloq bloc paq blöck päck pair carrier porteus",
)
_BLOCK_WORDS = _IN | {f"{word}er": size for word, size in cardinals(2, 12, ("de",)).items()}


def take_blocks(notes: Notes) -> None:
    """How many subcarriers go together: "in groups of 4"."""
    match = _BLOCKS.search(notes.plain)
    if match is None or match.lastgroup is None:
        return
    word, place = match[match.lastgroup], match.start(match.lastgroup)
    said = next((number.value for number in numbers(notes.plain) if number.start == place), None)
    size = int(_BLOCK_WORDS.get(word) or said or 0)
    if size < 1 and word.isalpha():
        return  # "groups of users"
    notes.spoken_for.append(match.span())
    notes.masked.append(match.span())
    if size < 1:
        notes.doubt("impossible", text=notes.text[slice(*match.span())])
    else:
        notes.put("resource_block_group_size", float(size), match.span())


def take_share(notes: Notes, max_power_w: float) -> None:
    """A share of the power, of the cell's limit: "with half the power"."""
    match = _SHARE.search(notes.plain)
    before = notes.plain[: match.start()] if match is not None else ""
    if match is None or _CHANGE_BEFORE.search(before):
        return
    if any(each.start < match.start() < each.end for each in notes.quantities):  # "two and a half watts"
        return
    group = match.lastgroup or ""
    share = _SHARES[match[group]] if group.endswith("word") else float(match[group].replace(",", ".")) / 100
    notes.spoken_for.append(match.span())
    notes.masked.append(match.span())
    if _CHANGE_BEHIND.match(notes.plain, match.end()):  # "power 10 % lower"
        notes.doubt("change", text=notes.text[slice(*match.span())])
    elif 0 < share <= 1:
        notes.put("max_power_w", share * max_power_w, match.span())
    else:
        notes.doubt("impossible", text=notes.text[slice(*match.span())])


def take_counts(notes: Notes, recounted: Sequence[Span], allotted: Sequence[Span]) -> None:
    """How many users there are is the channel's affair; to pick some of them without naming them is a doubt.

    ``recounted`` are counts of users who are named, ``allotted`` spans that speak of named users.
    """
    taken = [*((figure.start, figure.end) for figure in notes.quantities), *notes.spoken_for, *allotted]
    for match in COUNTED_USERS.finditer(notes.plain):
        described = any(match.start() <= start < match.end() for start, _ in recounted)
        if described or any(start <= match.start() < end for start, end in taken):
            continue
        words = notes.text[slice(*match.span())]
        notes.counted.append(match.span())
        if _describes_all(*_clause_around(notes, *match.span())):
            notes.not_used.append(words)
        else:
            notes.doubt("not_understood" if _CARRIERS.search(words) else "some_users", text=words)


def doubt_parts(notes: Notes, allotted: Sequence[Span]) -> None:
    """Some of the users, half of something, nobody at all: each a question."""
    settled = [*notes.spoken_for, *allotted, *notes.counted]
    asked = {_SOME_USERS: "some_users", BY_PLACE: "some_users", _ONE_OF: "one_of", _HALVED: "change",
             _OTHERS_HALVED: "change"}  # fmt: skip
    for pattern, key in asked.items():
        match = pattern.search(notes.plain)
        if match is None or (pattern is _HALVED and overlaps(match.span(), settled)):
            continue
        if pattern is not _ONE_OF and any(is_within(match.span(), span) for span in allotted):
            continue  # "odd-numbered users"
        notes.doubt(key, text=notes.text[slice(*match.span())])


def _clause_around(notes: Notes, start: int, end: int) -> tuple[str, str]:
    """What stands before and after a span within its clause, figures being borders too."""
    plain = notes.plain
    from_ = max([0, *(figure.phrase_end for figure in notes.quantities if figure.phrase_end <= start)])
    to = min([len(plain), *(figure.phrase_start for figure in notes.quantities if figure.phrase_start >= end)])
    return plain[clause_start(plain, start, from_) : start], plain[end : clause_end(plain, end, to)]


def _describes_all(before: str, after: str) -> bool:
    """Whether a count of users tells how many there are, rather than picking some: "for 3 users" picks."""
    if _ALL.search(before):
        return True
    return _DESCRIBED_BEFORE.search(before) is not None and _DESCRIBED_AFTER.match(after) is not None
