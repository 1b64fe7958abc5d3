"""What a question or a command is about: its user, its figures, what to compare with.

Methods and repairers go by the names that operators say: "equal power", "the paper's method", "等功率".
"""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping

from wirelessagent import plugins
from wirelessagent.language.intent import Detail
from wirelessagent.language.moods import places
from wirelessagent.language.numerals import chinese_value
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.sentence import Sentence
from wirelessagent.language.word_tables import deferred, either, words_of
from wirelessagent.telling.catalogue import called, languages

_NUMBER = deferred(
    rf"(?i)(?:{'|'.join(map(re.escape, words_of('figures', 'asked', 'turns')))})\s*"
    r"(?P<n>[0-9]+|[一二三四五六七八九十]+)|\bhistory\s+(?:show\s+)?(?P<m>[0-9]+)"
)
_FORMATS = (("tmf921", deferred(r"(?i)tmf\s*-?921")), ("ts28312", deferred(r"(?i)28\.?312|3gpp")))
_WITH = deferred(
    r"(?i)\bcompare\s+(?:(?:it|this|that)\s+)?(?:with|to|against)\s+([a-z][\w.-]*)[\s.!?]*$|"
    r"[和与跟同]\s*([A-Za-z][\w.-]*)\s*(?:作|做|进行)?(?:个|一)?(?:比较|对比|相比|比)"
)
_AS = deferred(
    r"(?i)\b(?:export|save|write|download)\s+(?:(?:it|this|that|everything|the\s+\w+)\s+)?(?:as|to|into)\s+"
    r"(?:an?\s+)?([a-z][\w.-]*)[\s.!?]*$|"
    r"(?:导出|保存)(?:为|成|到)\s*([A-Za-z][\w.-]*)\s*$"
)
_MORE = deferred(rf"(?i)(?:{either('figures', 'asked', 'more')})\s+")
_FEWER, _EACH, _MORE_USERS, _HALF_MISSING, _GONE, _NO_TOOL, _NO_FORMAT = (
    deferred(f"(?i){either('figures', 'asked', name)}")
    for name in ("fewer", "each", "more_users", "half_missing", "gone", "no_tool", "no_format")
)


def about(topic: str, sentence: Sentence) -> tuple[str, dict[str, Detail]]:
    """What a question is about that was taken for one of this topic, and its details: who is first is about users."""
    first = topic in ("other", "prices") and _speaks_of("who", sentence.plain) and bool(ranked(sentence.plain))
    topic = "users" if first else topic
    return topic, details_of(topic, sentence)


def details_of(topic: str, sentence: Sentence) -> dict[str, Detail]:
    """The figures and names of a question or command of this topic."""
    named = sentence.reading.named
    user: dict[str, Detail] = {"user": named[0]} if named else {}
    if topic in ("why_user", "users", "prices"):
        return user if user or topic != "users" else ranked(sentence.plain)
    if topic == "what_if":
        return _what_if(sentence)
    if topic == "step":
        steps = _step(sentence)
        return {**steps, **(user if "rate_bps" in steps else {})}
    if topic == "compare":
        unknown = _named_in(_WITH, _NO_TOOL, sentence.plain)
        return {"with": " ".join(tools_named(sentence.plain, "method", "repairer")) or unknown or "last"}
    if topic == "history":
        match = _NUMBER.search(sentence.plain)
        number = 0.0 if match is None else number_of(match["n"] or match["m"])
        return {"number": number} if number else {}
    if topic == "export":
        known = next((name for name, pattern in _FORMATS if pattern.search(sentence.plain)), "")
        return {"format": known or _named_in(_AS, _NO_FORMAT, sentence.plain) or "ts28312"}
    return {}


def number_of(word: str) -> float:
    """The number that digits or a Chinese numeral stand for; 0 where it stands for none.

    >>> number_of("12"), number_of("十二")
    (12.0, 12.0)
    """
    return float(word) if word.isdecimal() else float(chinese_value(word) or 0)


def ranked(plain: str) -> dict[str, Detail]:
    """Whether it is about who has the "least" or the "most" of rate, power or subcarriers; empty where it is not.

    >>> ranked("who is slowest right now?"), ranked("谁的功率最大?"), ranked("what does everyone get?")
    ({'rank': 'least', 'of': 'rate'}, {'rank': 'most', 'of': 'power'}, {})
    """
    rank = next((rank for rank in ("least", "most") if _speaks_of(rank, plain)), "")
    of = next((of for of in ("subcarriers", "power") if _speaks_of(of, plain)), "rate")
    return {"rank": rank, "of": of} if rank and not _speaks_of("should", plain) else {}


def _speaks_of(name: str, plain: str) -> bool:
    return any(places(words_of("figures", "ranks", name), plain))


def _named_in(pattern: re.Pattern[str], common: re.Pattern[str], plain: str) -> str:
    """The name that a sentence ends with, where it is no common word; else empty."""
    match = pattern.search(plain)
    name = "" if match is None else next(group for group in match.groups() if group).strip()
    return "" if common.fullmatch(name) else name


def _what_if(sentence: Sentence) -> dict[str, Detail]:
    reading, details = sentence.reading, dict[str, Detail]()
    share = reading.missing
    if share is None and _HALF_MISSING.search(sentence.plain):
        share = 0.5
    if share is not None and 0 <= share < 1:
        details["missing_share"] = share
    values = dict(reading.values)
    if reading.named and not values and not reading.back and share is None and _GONE.search(sentence.plain):
        values["leave_out"] = reading.named  # "what if user 3 were gone?"
    if values:
        details["constraints"] = values
    if sentence.goal.verdict == "clear":
        details["objective"] = sentence.goal.objective
    return details


def _step(sentence: Sentence) -> Mapping[str, Detail]:
    """How much more is asked about: power, rate or users; a watt where nothing is said. Less is below zero."""
    if _MORE_USERS.search(sentence.plain):
        return {"users": 1.0}
    plain, steps = _MORE.sub("", sentence.plain), dict[str, Detail](sentence.reading.steps)
    said = parse_quantities(plain)  # "5 more watts"
    for kind, name in (("power", "power_w"), ("rate", "rate_bps")):
        figure = next((figure.value for figure in said if figure.kind == kind and figure.value > 0), None)
        if figure is not None and not steps:
            steps[name] = figure
    share = next((figure.value for figure in said if figure.kind == "ratio"), None)
    if share is not None and "rate" in sentence.concepts:
        steps = {"rate_share": share}
    if not steps:  # a limit that is named
        power, rate = (sentence.reading.values.get(name) for name in ("max_power_w", "min_rate_bps"))
        rate = next(iter(rate.values())) if isinstance(rate, Mapping) else rate
        stated = {"power_w": power, "rate_bps": rate}.items()
        steps = next(({name: value} for name, value in stated if isinstance(value, float)), {"power_w": 1.0})
    if "rate_bps" in steps and _EACH.search(plain):
        steps["each"] = 1.0
    sign = -1.0 if _FEWER.search(plain) and said else 1.0
    return {name: sign * value if isinstance(value, float) else value for name, value in steps.items()}


def tools_named(text: str, *kinds: plugins.Kind) -> tuple[str, ...]:
    """The installed plug-ins of these kinds that are named, in their order.

    >>> tools_named("compare with equal power and the paper's method", "method")
    ('equal_power', 'paper')
    """
    spoken, pattern = _spoken(tuple(name for kind in kinds for name in plugins.names(kind)))
    return tuple(dict.fromkeys(spoken[match[0]] for match in pattern.finditer(_as_said(text))))


def with_tool(text: str, kind: plugins.Kind) -> tuple[str, str]:
    """The words with "%" for the only plug-in that they name, and its name; "" where they name none or several.

    >>> with_tool("use the paper's method", "method")
    ("use the %'s method", 'paper')
    """
    spoken, pattern = _spoken(tuple(plugins.names(kind)))
    plain = _as_said(text)
    found = list(pattern.finditer(plain))
    if len(found) != 1:
        return text, ""
    return f"{plain[: found[0].start()]}%{plain[found[0].end() :]}", spoken[found[0][0]]


def _as_said(text: str) -> str:
    return re.sub(r"[-_\s]+", " ", text.lower().replace("’", "'"))


@functools.cache
def _spoken(names: tuple[str, ...]) -> tuple[Mapping[str, str], re.Pattern[str]]:
    """The plug-in that each name, as it is said or told in any language, means, and a pattern for all of them."""
    spoken = {said: name for name in names for said in (_as_said(name), *words_of("talk_forms", "tools", name))}
    plain = _any_of(spoken)
    told = {_as_said(called(language, name)): name for language in sorted(languages()) for name in names}
    for said, name in told.items():  # as the agent itself says them, where nothing in it says so already
        if {spoken[match[0]] for match in plain.finditer(said)} != {name}:
            spoken = {**spoken, said: name}
    return spoken, _any_of(spoken)


def _any_of(spoken: Mapping[str, str]) -> re.Pattern[str]:
    longest_first = sorted(spoken, key=len, reverse=True)
    pattern = "|".join(rf"\b{re.escape(said)}(?![a-z])" if said.isascii() else said for said in longest_first)
    return deferred(pattern or r"(?!)")
