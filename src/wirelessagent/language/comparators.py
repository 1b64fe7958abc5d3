"""Whether a figure is a floor, a ceiling or exact: the words before or after it.

Comparatives turn round under a negation ("nobody below 1 Mbit/s" is a floor); "at least" does not.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal, TypeAlias

from wirelessagent.language.text import CLAUSE_END

Comparator: TypeAlias = Literal["at_least", "at_most", "exactly"]


def _listed(words: str) -> list[str]:
    """Words one after the other, phrases with underscores for spaces."""
    return [word.replace("_", " ") for word in words.split()]


# Comparatives, which a negation turns round.
_ABOVE = _listed(
    "more_than greater_than higher_than over above beyond exceed exceeds exceeding going_over "
    "more_than_a superior_a más_de plus_de mehr_als über 超过 大于 高于 多于 超出 >"
)
_BELOW = _listed(
    "less_than lower_than fewer_than smaller_than slower_than under below beneath menos_de por_debajo_de moins_de "
    "weniger_als unter "
    "低于 小于 少于 掉到 掉下 <"
)
_AT_LEAST = _listed(
    "at_least at_the_very_least no_less_than not_less_than no_lower_than no_slower_than no_fewer_than minimum min rmin "
    "floor guarantee guaranteed or_better al_menos por_lo_menos como_mínimo como_minimo mínimo minimo no_menos_de "
    "au_moins au_minimum pas_moins_de mindestens wenigstens nicht_weniger_als 至少 最少 起码 不低于 不少于 不小于 "
    "不得低于 不能低于 最低 最小 保底 保 下限 ≥ >= =>"
)
_AT_MOST = _listed(
    "at_most no_more_than not_more_than no_higher_than no_greater_than up_to within maximum max pmax limit limited_to "
    "limit_of cap capped_at cap_of ceiling budget budget_of topped_at not_to_exceed como_mucho como_máximo "
    "como_maximo máximo maximo no_más_de no_mas_de hasta tope límite limite au_plus au_maximum pas_plus_de jusqu'à "
    "plafonnée_à plafonné_à plafond höchstens maximal nicht_mehr_als bis_zu obergrenze begrenzt_auf "
    "不超过 不得超过 不能超过 不许超过 别超过 不要超过 最多 至多 顶多 不高于 不大于 不多于 最高 最大 上限 限制在 "
    "控制在 限定在 以内 封顶 ≤ <= =<"
)
_EXACTLY = _listed("exactly precisely 恰好 正好 刚好 等于")

_AFTER: dict[str, Comparator] = {
    **dict.fromkeys(
        _listed(
            "or_more or_higher or_above or_better or_faster and_up and_above minimum min at_least at_minimum floor "
            "and_better or_over al_menos como_mínimo como_minimo o_más mínimo au_moins au_minimum ou_plus "
            "mindestens oder_mehr "
            "以上 或更多 或以上 起 打底 保底 起步"
        ),
        "at_least",
    ),
    **dict.fromkeys(
        _listed(
            "or_less or_lower or_below or_under maximum max at_most tops limit budget cap ceiling upper_limit "
            "at_the_most "
            "o_menos como_mucho como_máximo como_maximo máximo maximo de_tope au_plus au_maximum maximal höchstens "
            "oder_weniger ou_moins de_límite "
            "以内 之内 以下 或以下 或更少 封顶 为限 上限 顶天"
        ),
        "at_most",
    ),
    "exactly": "exactly",
}

_POWER_NOUNS = _listed("power budget consumption watts? wattage energy 功率 功耗 能耗 发射功率 总功率 预算")
_RATE_NOUNS = _listed(
    "rates? speeds? throughput bitrate bandwidth goodput download upload 速率 速度 网速 吞吐量 带宽 码率"
)
_FILLERS = _listed(
    "of is are to at be by a an the about around roughly set total overall sum transmit tx radiated transmission rf "
    "data bit use using used get gets getting each every user everyone everybody with go going it more limit limited "
    "circuit static fixed outage reliability probability : = one person subscriber customer rate_of phones phone "
    "ue ues uses "
    "people must still let promise keep hold have deliver de la el un una del los le les du des une der die das "
    "dem den "
    "von bei mit con avec por para à auf für pro jeder jeden chacun cada usuario utilisateur nutzer puissance potencia "
    "leistung sendeleistung débit rate velocidad "
    "为 是 在 到 用 约 大约 发射 总 的 每 个 人 用户 每人 给 设 成 调 控制 卡 定 放 跑 跑到 达 得 拿到 拿 分到 "
    "数据 传输 传 消耗 使用 要 达到 有 给 保证 中断 概率 可靠性"
)

_LATIN = re.compile(r"[A-Za-z]")


def _any_of(words: list[str]) -> str:
    """An alternation, longest first, in which spaces match any run and Latin words end at their borders."""
    parts: list[str] = []
    for word in sorted(words, key=len, reverse=True):
        body = word if word.endswith("s?") else re.escape(word).replace(r"\ ", r"\s+")
        border = r"(?<![A-Za-z_])", r"(?![A-Za-z])"
        parts.append(f"{border[0]}{body}{border[1]}" if _LATIN.search(word) else body)
    return "(?:" + "|".join(parts) + ")"


_GAP = re.compile(rf"(?i)(?:\s|{_any_of([*_FILLERS, *_POWER_NOUNS, *_RATE_NOUNS])}){{0,16}}$")
_CAP = r"\b(?:cap|limit|restrict|throttle)(?:s|ped|ed|ting|ping)?\s+(?:[a-z0-9]+\s+){0,5}(?:at|to)\b"  # "cap users at"
_BEFORE = re.compile(
    rf"(?i)(?P<at_least>{_any_of(_AT_LEAST)})|(?P<at_most>{_CAP}|{_any_of(_AT_MOST)})|(?P<exactly>{_any_of(_EXACTLY)})"
    rf"|(?P<above>{_any_of(_ABOVE)})|(?P<below>{_any_of(_BELOW)})"
)
_NEGATION = re.compile(
    r"(?i)\b(?:no|not|never|nobody|none|nothing|without|cannot|can't|don't|dont|do not|does not|"
    r"doesn't|mustn't|must not|shouldn't|should not|won't|avoid|nowhere|neither)\b|[不别勿没无]"
)
_AFTER_RE = re.compile(rf"(?i)[\s-]*(?P<word>{_any_of(list(_AFTER))})(?!\s*(?:of\s+|is\s+)?[0-9])")
_LOOSE = re.compile(r"(?i)(?:max|min)(?:imum)?\b")  # "maximum rate at 1 Mbit/s minimum" wishes first and bounds after
_POWER_RE = re.compile("(?i)" + _any_of(_POWER_NOUNS))
_RATE_RE = re.compile("(?i)" + _any_of(_RATE_NOUNS))
_CLAUSE = re.compile(CLAUSE_END)


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """A comparator and the span of words from it to the figure's other side."""

    comparator: Comparator | None
    start: int
    end: int


def comparison(text: str, start: int, end: int, *, kind: str, after: int) -> Comparison:
    """How the figure at [start, end) of a normalised text is bounded; words before ``after`` are another's."""
    found = _before(text, start, kind=kind, after=after)
    behind = _AFTER_RE.match(text, end)
    own = behind is None or not _LOOSE.match(text, found[1]) if found is not None else False
    if found is not None and own:
        return Comparison(comparator=found[0], start=found[1], end=end)
    if behind is not None and _takes(kind, text[behind.end() : behind.end() + 12]):
        return Comparison(comparator=_AFTER[" ".join(behind["word"].lower().split())], start=start, end=behind.end())
    return Comparison(comparator=None, start=start, end=end)


def _takes(kind: str, rest: str) -> bool:
    """Whether "max" after a figure is its own, and not the beginning of "max rate"."""
    nouns = _RATE_RE if kind == "power" else _POWER_RE
    return nouns.match(rest.lstrip()) is None


def _before(text: str, start: int, *, kind: str, after: int) -> tuple[Comparator, int] | None:
    window_start = max(after, start - 80)
    cuts = [match.end() for match in _CLAUSE.finditer(text, window_start, start) if match.group() != ":"]
    clause_start = cuts[-1] if cuts else window_start
    matches = list(_BEFORE.finditer(text, clause_start, start))
    for match in reversed(matches):
        gap = text[match.end() : start]
        if not _GAP.match(gap) or _foreign_noun(gap, kind):
            continue
        word = match.lastgroup
        if word in ("above", "below"):
            negated = _NEGATION.search(text, max(clause_start, match.start() - 40), match.start()) is not None
            return ("at_most" if (word == "above") == negated else "at_least"), match.start()
        if word == "at_least" or word == "at_most" or word == "exactly":
            return word, match.start()
    return None


def _foreign_noun(gap: str, kind: str) -> bool:
    """ "min power 1 Mbit/s": the word bounds the power, not the rate that follows."""
    if kind == "rate":
        return _POWER_RE.search(gap) is not None
    return kind == "power" and _RATE_RE.search(gap) is not None
