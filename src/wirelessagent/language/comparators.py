"""Whether a figure is a floor, a ceiling or exact: the words before or after it.

Comparatives turn round under a negation ("nobody below 1 Mbit/s" is a floor); "at least" does not.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal, TypeAlias

from wirelessagent.language.deferred import deferred
from wirelessagent.language.phrases import Phrases
from wirelessagent.language.spelling import one_edit
from wirelessagent.language.text import CLAUSE_END, USER_NOUN

Comparator: TypeAlias = Literal["at_least", "at_most", "exactly"]


def _listed(words: str) -> list[str]:
    """Words one after the other, phrases with underscores for spaces."""
    return [word.replace("_", " ") for word in words.split()]


# Comparatives, which a negation turns round.
_ABOVE = _listed(
    "more_than greater_than higher_than faster_than over above beyond past exceed exceeds exceeded exceeding "
    "going_over go_over "
    "superior_a más_de mas_de más_que pasar_de pasen_de pase_de pasa_de pasando_de por_encima_de encima_de "
    "superar supere superen supera superando exceder exceda rebasar rebase sobrepasar sobrepase plus_de plus_que "
    "dépasser dépasse dépassent dépassant excéder excède au-dessus_de au_dessus_de au-delà_de au_delà_de supérieur_à "
    "mehr_als über oberhalb_von hinaus_über schneller_als höher_als 超过 大于 高于 多于 超出 高过 快过 快于 突破 "
    "(?<=[不别莫勿])超 >"
)
_BELOW = _listed(
    "less_than lower_than fewer_than smaller_than slower_than under below beneath menos_de menos_que por_debajo_de "
    "debajo_de bajar_de baje_de bajen_de baja_de bajando_de inferior_a moins_de moins_que en_dessous_de au-dessous_de "
    "sous descendre_à inférieur_à inférieure_à weniger_als unter unterhalb_von langsamer_als geringer_als "
    "低于 小于 少于 掉到 掉下 掉破 跌到 跌破 低过 慢于 降到 <"
)
_AT_LEAST = _listed(
    "at_least at_the_very_least no_less_than not_less_than no_lower_than no_slower_than no_fewer_than minimum "
    r"(?<!max[-\s])(?<![A-Za-z])min(?![A-Za-z]) "
    "rmin "
    "floor guarantee guaranteed or_better gbr al_menos por_lo_menos como_mínimo como_minimo mínimo minimo no_menos_de "
    "un_mínimo_de suelo_de piso_de au_moins au_minimum pas_moins_de minimum_de plancher mindestens wenigstens "
    "mindestrate nicht_weniger_als untergrenze 至少 最少 起码 刚好够 底限 门限 不低于 不少于 不小于 "
    "不得低于 不能低于 最低 最小 保底 保 下限 ≥ >= =>"
)
_AT_MOST = _listed(
    "at_most no_more_than not_more_than no_higher_than no_greater_than up_to within maximum max pmax limit limits "
    "limited_to limit_of cap capped_at cap_of ceiling ceiling_of lid lid_of roof_of budget budget_of topped_at "
    "not_to_exceed mbr ambr como_mucho como_máximo como_maximo máximo maximo un_máximo_de no_más_de no_mas_de hasta "
    "tope tope_de techo techo_de límite limite au_plus au_maximum pas_plus_de jusqu'à maximum_de plafond plafond_de "
    "höchstens hoechstens maximal nicht_mehr_als bis_zu obergrenze deckel höchstgrenze leistungsgrenze höchstrate "
    "maximalrate 不超过 不得超过 不能超过 不许超过 别超过 不要超过 最多 至多 顶多 不高于 不大于 不多于 最高 最大 "
    "上限 限制在 控制在 限定在 以内 封顶 封到 封在 压在 卡在 "
    "卡到 (?<![门底极无有期权下上时受])限(?:速|制|流)?(?:到|在|为)? "
    "(?:封(?![顶闭城])) rmax ≤ <= =<"
)
_EXACTLY = _listed("exactly precisely exactamente justo exactement exakt genau 恰好 正好 刚好 等于")

_AFTER: dict[str, Comparator] = {
    **dict.fromkeys(
        _listed(
            "or_more or_higher or_above or_better or_faster and_up and_above minimum min at_least at_minimum floor "
            "and_better or_over al_menos como_mínimo como_minimo por_lo_menos o_más mínimo de_mínimo au_moins "
            "au_minimum ou_plus minimum_garanti mindestens oder_mehr nicht_unterschreiten "
            "以上 或更多 或以上 起 打底 保底 起步 兜底"
        ),
        "at_least",
    ),
    **dict.fromkeys(
        _listed(
            "or_less or_lower or_below or_under maximum max at_most tops limit budget cap ceiling upper_limit "
            "at_the_most at_the_very_most top "
            "o_menos como_mucho como_máximo como_maximo máximo maximo de_máximo de_tope de_techo a_lo_sumo au_plus "
            "au_maximum maximum de_plafond de_limite maxi maximal höchstens oder_weniger ou_moins de_límite "
            "gedeckelt begrenzt beschränkt gekappt ist_schluss gedrosselt limitiert abgeregelt deckeln begrenzen "
            "beschränken kappen drosseln limitieren abregeln nicht_überschreiten nicht_übersteigen obergrenze "
            "以内 之内 以下 或以下 或更少 封顶 为限 上限 顶天 为止 打住 到顶 顶格"
        ),
        "at_most",
    ),
    "exactly": "exactly",
}

_POWER_NOUNS = _listed("power budget consumption watt watts wattage energy 功率 功耗 能耗 发射功率 总功率 预算")
_RATE_NOUNS = _listed(
    "rate rates speed speeds throughput bitrate bandwidth goodput download upload 速率 速度 网速 吞吐量 带宽 码率"
)
_FILLERS = _listed(
    "of is are to at be by a an the about around roughly set total overall sum transmit tx radiated transmission rf "
    "data bit use using used get gets getting each every user everyone everybody with go going it more limit limited "
    "circuit static fixed outage reliability probability : = one person subscriber customer phones phone "
    "ue ues uses "
    "people must still let promise keep hold have deliver de la el un una del los le les du des une der die das "
    "dem den "
    "von bei mit con avec por para à auf für pro je jeder jeden jedem jede alle allen kopf person teilnehmer kunde "
    "nie wird soll darf sind ist einzelne einzelner irgendein "
    "chacun chaque cada usuario persona uno personne abonné client utilisateur nutzer puissance potencia en lo las se "
    "que est sont soit debe debit leistung sendeleistung débit velocidad vitesse tasa caudal ganze lediglich "
    "为 是 在 到 用 约 大约 发射 总 的 每 个 人 用户 每人 给 设 成 调 控制 卡 定 放 跑 跑到 达 得 拿到 拿 分到 "
    "各 均 统一 至 也 就 都 过 能 只 只能 "
    "数据 传输 传 消耗 使用 要 达到 有 给 保证 中断 概率 可靠性"
)

_LATIN = deferred(r"[A-Za-z]")


def _any_of(words: list[str]) -> str:
    """An alternation, longest first, in which spaces match any run and Latin words end at their borders.

    The borders stand once around all Latin words: a pattern that repeats them for each word compiles ten times slower.
    """
    latin: list[str] = []
    others: list[str] = []
    for word in sorted(words, key=len, reverse=True):
        body = word if word.startswith("(?") else re.escape(word).replace(r"\ ", r"\s+")
        (latin if _LATIN.search(word) else others).append(body)
    bordered = rf"(?<![A-Za-z_])(?:{'|'.join(latin)})(?![A-Za-zÀ-ÿ])"
    return "(?:" + "|".join([bordered, *others]) + ")"


_WORD = deferred(r"[A-Za-zÀ-ÿ]++")
_BETWEEN = frozenset([*_FILLERS, *_POWER_NOUNS, *_RATE_NOUNS])  # what may stand between a comparator and its figure
_SIGNS = "|".join(sorted((word for word in _BETWEEN if not _WORD.match(word)), key=len, reverse=True))
_GAP = deferred(rf"(?:\s|{_WORD.pattern}|{_SIGNS}){{0,16}}$")
_WORDS = rf"(?:(?!(?:and|y|et|und)\s+(?!{USER_NOUN}|[0-9]))[\w'’#-]+\s+){{0,6}}?"
_CAP = (  # "cap users at", "limite l'utilisateur 5 à", "limitado a", "auf … begrenzt" stands behind
    rf"\b(?:rate-)?(?:cap|limit|restrict|throttl|clamp|polic|chok|stop|held\s+down|cut\s+off)(?:s|e|es|p?ed|t?ing|ping|ing)?\s+{_WORDS}"
    rf"(?:at|to)\b|\b(?:l[ií]mit|c[aá]p|top|restring|fren|techo|tope)\w*\s+{_WORDS}(?:a|en)\b"
    rf"|\b(?:limit|plafonn|brid|restrei|cap)\w*\s+{_WORDS}à(?!\w)"
    rf"|\b(?:begrenz|beschränk|deckel|deckl|kapp|drossel|drossl|limitier)\w*\s+{_WORDS}(?:auf|bei)\b"
)
_BEFORE = Phrases(
    rf"(?P<at_least>{_any_of(_AT_LEAST)})|(?P<at_most>{_CAP}|{_any_of(_AT_MOST)})|(?P<exactly>{_any_of(_EXACTLY)})"
    rf"|(?P<above>{_any_of(_ABOVE)})|(?P<below>{_any_of(_BELOW)})"
)
_NEGATION = deferred(
    r"(?i)\b(?:no|not|never|nobody|none|nothing|without|cannot|can't|cant|don't|dont|do not|does not|"
    r"doesn't|doesnt|mustn't|must not|shouldn't|should not|won't|avoid|nowhere|neither|forbid\w*|"
    r"nadie|ning[uú]n[oa]?|nunca|jamás|sin|ni|tampoco|prohibid[oa]|evita\w*|"
    r"personne|aucune?|ne|n(?=')|jamais|sans|pas|rien|interdi\w+|évite\w*|"
    r"nicht|nichts|kein\w*|niemand\w*|nie|niemals|ohne|verboten)\b|[不别勿没无莫禁]"
)
_NOBODY = ("nobody", "without", "cannot", "nadie", "personne", "niemand")
_DENIED_AFTER = deferred(  # "mehr als 24 Watt gibt's nicht", "below 1 Mbit/s nobody may fall"
    r"(?i)^(?:(?!\b(?:and|und|y|et|aber|but|sonst)\b)[\w\s'’-])*?\b(?:nicht(?! (?:mehr|weniger|über|unter)\b)|kein\w*|"
    r"niemand\w*|nie|niemals|nobody|no\s+one|never|nadie|ninguno?|nunca|personne|aucune?|jamais|forbidden|prohibido|"
    r"interdit|verboten|schluss)\b"
)
_AFTER_RE = deferred(
    rf"(?i)[\s-]*(?:(?:auch|das|ist|sind|je|pro|nutzer|kopf|die|jeden|für|each|everyone|person|de|en|per|user|the|at)\s+){{0,5}}"
    rf"(?P<word>{_any_of(list(_AFTER))})(?!\s*(?:of\s+|is\s+)?[0-9])"
)
_LAST_WORD = deferred(  # "10 W, no more", "10 kbit/s, no less and no more"
    r"(?i),?\s*(?:(?P<exactly>no\s+(?:less\s+and\s+no\s+more|more\s+and\s+no\s+less)|not\s+more\s+not\s+less|"
    r"ni\s+m[aá]s\s+ni\s+menos|ni\s+plus\s+ni\s+moins|nicht\s+mehr\s+und\s+nicht\s+weniger|不多不少)|"
    r"(?P<at_most>tops|at\s+(?:the\s+)?(?:very\s+)?most|(?:and\s+)?(?:no|not\s+a\s+watt|not\s+one)\s+more|"
    r"y?\s*(?:no|nada|ni\s+uno)\s+m[aá]s|(?:et\s+)?pas\s+(?:un\s+de\s+)?plus|(?:und\s+)?nicht\s+mehr|"
    r"不能再多|不能再高|不许再多)|(?P<at_least>(?:and\s+)?(?:no|not)\s+less|y?\s*no\s+menos|(?:et\s+)?pas\s+moins|"
    r"(?:und\s+)?nicht\s+weniger|不能少|不能再少))(?=\s*(?:$|[.,;:!?)\uff0c。\uff1b、]))"
)
_LOOSE = deferred(r"(?i)(?:max|min)(?:imum)?\b")  # "maximum rate at 1 Mbit/s minimum" wishes first and bounds after
_POWER_RE = deferred("(?i)" + _any_of(_POWER_NOUNS))
_RATE_RE = deferred("(?i)" + _any_of(_RATE_NOUNS))
_WISH_WITH = deferred("(?i)" + _any_of(_RATE_NOUNS) + r"\s+(?:with|con|avec|mit|bei)\b")
_CLAUSE = deferred(CLAUSE_END)


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """A comparator and the span of words from it to the figure's other side."""

    comparator: Comparator | None
    start: int
    end: int


def comparison(text: str, start: int, end: int, *, kind: str, after: int) -> Comparison:
    """How the figure at [start, end) of a normalised text is bounded; words before ``after`` are another's."""
    found = _before(text, start, end, kind=kind, after=after)
    behind = _AFTER_RE.match(text, end)
    own = behind is None or not _LOOSE.match(text, found[1]) if found is not None else False
    if found is not None and own:
        return Comparison(comparator=found[0], start=found[1], end=end)
    last = _LAST_WORD.match(text, end)
    if last is not None and behind is None:
        word = "exactly" if last["exactly"] else "at_most" if last["at_most"] else "at_least"
        return Comparison(comparator=word, start=start, end=last.end())
    if behind is not None and _takes(kind, text[behind.end() : behind.end() + 12]):
        return Comparison(comparator=_AFTER[" ".join(behind["word"].lower().split())], start=start, end=behind.end())
    return Comparison(comparator=None, start=start, end=end)


def _takes(kind: str, rest: str) -> bool:
    """Whether "max" after a figure is its own, and not the beginning of "max rate"."""
    nouns = _RATE_RE if kind == "power" else _POWER_RE
    return nouns.match(rest.lstrip()) is None


def _before(text: str, start: int, end: int, *, kind: str, after: int) -> tuple[Comparator, int] | None:
    window_start = max(after, start - 80)
    cuts = [match.end() for match in _CLAUSE.finditer(text, window_start, start) if match.group() != ":"]
    clause_start = cuts[-1] if cuts else window_start
    matches = list(_BEFORE.finditer(text, clause_start, start))
    for match in reversed(matches):
        gap = text[match.end() : start]
        if not _is_filler(gap) or _foreign_noun(gap, kind):
            continue
        word = match.lastgroup
        if word in ("above", "below"):
            negated = _is_denied(text, max(clause_start, match.start() - 60), match.start(), end)
            return ("at_most" if (word == "above") == negated else "at_least"), match.start()
        if word == "at_least" or word == "at_most" or word == "exactly":
            return word, match.start()
    return None


def _is_filler(gap: str) -> bool:
    return _GAP.match(gap) is not None and all(word.lower() in _BETWEEN for word in _WORD.findall(gap))


def _is_denied(text: str, from_: int, start: int, end: int) -> bool:
    """Whether a comparative is turned round, by what stands before it or, as verbs do in German, behind the figure."""
    if _NEGATION.search(text, from_, start) is not None or _is_misspelt_nobody(text[from_:start]):
        return True
    clause = _CLAUSE.search(text, end)
    return _DENIED_AFTER.match(text[end : clause.start() if clause else len(text)]) is not None


def _is_misspelt_nobody(words: str) -> bool:
    return any(one_edit(word, nobody) for word in _WORD.findall(words.lower()) for nobody in _NOBODY)


def _foreign_noun(gap: str, kind: str) -> bool:
    """ "min power 1 Mbit/s", "max rate with 1 Mbit/s each": the word is of a wish, not of the rate that follows."""
    if kind == "rate":
        return _POWER_RE.search(gap) is not None or _WISH_WITH.search(gap) is not None
    return kind == "power" and _RATE_RE.search(gap) is not None
