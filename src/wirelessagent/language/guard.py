"""The guard behind every recogniser: what is not clearly asked for now is asked about, and never done.

A sentence may name an act without asking for it: it refuses, reports, quotes, remembers, plans, supposes, jests, tells
a wish of somebody else's, speaks of another system, or of a user whom the cell does not have. The words that say so
are closed classes, as data by language (``moods/<language>.toml``). A word of such a class that the act accounts for
says nothing: "no more than 10 W" is a limit, "without user 3" leaves one out, "from now on" is now. Any other word
whose reach (its clause, its sentence or the whole text) touches the act makes a question of it, with the act for a
plain yes. What an ordinary word may hide ("my users complain", a name in small letters) is not seen here.
"""

from __future__ import annotations

import dataclasses
import functools
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wirelessagent.language.clauses import clause_end, clause_start
from wirelessagent.language.followups import dropped_in
from wirelessagent.language.intent import Intent
from wirelessagent.language.linear_model import shipped_model
from wirelessagent.language.replies import Voice
from wirelessagent.language.sentence import Sentence, labels_of, own_words
from wirelessagent.language.text import languages_of, normalise
from wirelessagent.language.word_tables import table

if TYPE_CHECKING:
    from wirelessagent.language.recogniser import Context

LANGUAGES = ("en", "zh", "es", "fr", "de")
MOODS = (
    "negation", "refusal", "report", "quotation", "past", "time", "condition", "irony", "others", "elsewhere",
)  # fmt: skip
"""The classes whose words make a question of an act."""
CHANGING = ("undo", "reset")
"""Commands that change something; to apply a plan has a closed grammar of its own (``conversation.assent``)."""
READ_IN_A_TALK = "conversation"
"""Who reads what a line is because of its conversation."""

_OF_AIMS = (("direct", "up", "down", "fair", "fairly", "balance"), ("rate", "power", "efficiency", "worst"))
"""Concepts by whose words an aim is placed that no phrase names, the surer ones first."""

_READ = ("negation", "refusal", "past", "time", "condition")
"""Moods whose words may be a part of a limit or of an aim that was read."""

_STORIES = ("report", "others")
"""Moods of what may only lead up to a wish that follows in words of its own."""

_NAMES_SHOWN = 12

Span = tuple[int, int]

_QUOTED = re.compile(
    r"\"[^\"]+\"|“[^”]+[”\"]|„[^“”]+[“”]|«[^»]+»|‹[^›]+›|「[^」]+」|『[^』]+』|《[^》]+》|(?<!\w)'[^']+'(?!\w)"
)
_LETTER = r"[0-9A-Za-zÀ-ɏ]"
_DASH = re.compile(r"\s[-–—]+\s|:\s")
_SENTENCE_END = re.compile(r"[!?;\n。；…]|\.(?!\d)")


@dataclass(frozen=True, kw_only=True)
class Doubt:
    """A word of a mood that nothing accounts for, where it stands."""

    mood: str
    reach: str
    start: int
    end: int


def guarded(text: str, context: Context | None, intent: Intent) -> Intent:
    """The intent, or a question back about it where its sentence does not clearly ask for it now."""
    if intent.acts and intent.recogniser == READ_IN_A_TALK:  # each word of its line is known
        return intent
    acts = intent.kind == "allocate" or (intent.kind == "command" and intent.topic in CHANGING)
    if not acts and not (intent.kind == "clarify" and intent.pending):
        return intent
    plain = normalise(text)
    voice = Voice(intent.language, labels_of(own_words(), intent.language))
    name = stranger(plain, context)
    if name is not None:
        users = ", ".join(context.user_names[:_NAMES_SHOWN]) if context is not None else ""
        key = "unknown_name" if users else "unknown_name_alone"
        return _asking(intent, voice.say(key, text=text[slice(*name)], users=users))
    doubt = doubted(text, context, intent, _moods_of(intent)) if acts else None
    if doubt is None:
        return intent
    guess = intent.reply.rstrip(" .。")
    reply = voice.say("mood", text=text[doubt.start : doubt.end].strip(), guess=guess[:1].lower() + guess[1:])
    return dataclasses.replace(_asking(intent, reply), guess=intent)


def _moods_of(intent: Intent) -> Sequence[str]:
    """The moods that nothing but the guard has looked for: patterns of whole lines read their own denials."""
    whole = intent.recogniser == READ_IN_A_TALK
    if intent.kind == "command":  # "no, as it was before" undoes
        return () if whole else [mood for mood in MOODS if mood not in ("negation", "past")]
    return [mood for mood in MOODS if mood not in ("negation", "refusal")] if whole else MOODS


def _asking(intent: Intent, reply: str) -> Intent:
    return Intent(
        kind="clarify", objective=None, constraints={}, language=intent.language, confidence=intent.confidence,
        evidence={}, reply=reply, recogniser=intent.recogniser,
    )  # fmt: skip


def doubted(text: str, context: Context | None, intent: Intent, moods: Sequence[str] = MOODS) -> Doubt | None:
    """The first word of a mood that reaches the act of an intent and that nothing accounts for."""
    plain = normalise(text)
    sentence: Sentence | None = None
    for language in languages_of(text):
        hits = [
            Doubt(mood=mood, reach=reach, start=start, end=end)
            for mood in moods
            for reach, words in table_of(language)[mood].items()
            for start, end in _places(words, plain)
        ]
        if "quotation" in moods:
            marks = (match.span() for match in _QUOTED.finditer(plain))
            hits += [Doubt(mood="quotation", reach="inside", start=start, end=end) for start, end in marks]
        if hits:
            names, limit = (context.user_names, context.max_power_w) if context is not None else ((), 20.0)
            sentence = sentence or Sentence(plain, own_words(), names=names, max_power_w=limit)
            known = _Known(sentence, dropped_in(plain, context)[1], intent, language)
            reached = (hit for hit in hits if not known.accounts_for(hit) and known.is_reached(hit))
            first = min(reached, key=lambda hit: hit.start, default=None)
            if first is not None:
                return first
    return None


class _Known:
    """What the reader made of a sentence: where the act stands, and the words that it accounts for."""

    def __init__(self, sentence: Sentence, dropped: Sequence[Span], intent: Intent, language: str) -> None:
        table, self._language = table_of(language), language
        self._plain = plain = _DASH.sub(lambda cut: ",".ljust(len(cut[0])), sentence.plain)
        self._figures = sentence.reading.masked
        self._own = list(_places(table["own"]["words"], plain))
        self._read = [*self._figures, *sentence.reading.counted, *sentence.goal.spans, *dropped]
        self._act, self._placed = list(_evident(plain, intent.evidence)), True
        left_out = intent.evidence.get("leave_out")
        self._left_out = [] if left_out is None else list(_evident(plain, {"leave_out": left_out}))
        aims = {"objective": intent.evidence.get("objective", "")}
        self._aims = [span for span in _evident(plain, aims) if span != (0, len(plain))]
        if (0, len(plain)) in self._act:
            meant = [
                [(item.start, item.end) for item in sentence.found if item.term.concept in concepts]
                for concepts in _OF_AIMS
            ]
            placed = [span for span in self._act if span != (0, len(plain))]
            self._act, self._placed = [*placed, *(meant[0] or meant[1])] or self._act, bool(placed)
        so = max((place for place, _ in _places(table["so"]["words"], plain) if self._begins(place)), default=0)
        self._behind_so = [(max(first, so), last) for first, last in self._act if last > so] or [(so, len(plain))]

    def accounts_for(self, hit: Doubt) -> bool:
        """Whether a word is a part of what was read, or denies an order or service: "mustn't exceed 10 W"."""
        spans = [*self._own, *self._read] if hit.mood in _READ else self._own
        if any(start <= hit.start and hit.end <= end for start, end in spans):
            return True
        if hit.mood != "negation":
            return False
        start, end = self._clause(hit)
        if any(first < end and start < last for first, last in self._left_out):
            return True
        figure = any(start <= first < end for first, _ in self._figures)
        return figure and any(_places(table_of(self._language)["order"]["words"], self._plain[start:end]))

    def is_reached(self, hit: Doubt) -> bool:
        """Whether the act stands where a word reaches: a negation ahead of itself, a quotation into its marks."""
        if hit.reach == "text":
            return True
        start, end = (hit.start, hit.end) if hit.reach == "inside" else self._clause(hit)
        if hit.reach in ("ahead", "sentence"):
            first, end = self._sentence(hit)
            start = start if hit.reach == "ahead" else first
        if hit.mood in _STORIES and hit.reach == "clause" and self._goes_on(end):
            end = self._sentence(hit)[1]  # "he told me, that …"
        act = self._behind_so if hit.reach == "clause" else self._act
        if hit.mood in _STORIES and any(first >= end for first, _ in self._aims):
            act = [span for span in act if span not in self._aims]  # "my users complain about speed, raise it"
        if hit.mood == "negation":
            turned = next(_places(table_of(self._language)["contrast"]["words"], self._plain[hit.end : end]), None)
            end = end if turned is None else hit.end + turned[0]
            last_word = not any(sign.isalpha() for sign in self._plain[hit.end : end])
            if last_word and not self._plain[start : hit.start].strip() and not self._plain[end:].strip(" .!。"):
                return True  # "max rate? no"
            start = start if last_word else hit.end
            act = act if self._placed or self._is_one_clause else []
        return any(first < end and start < last for first, last in act)

    def _goes_on(self, end: int) -> bool:
        """Whether the clause behind a place begins with a word that makes it the object of the one before."""
        start = re.compile(r"[,\uff0c]?\s*").match(self._plain, end)
        words = table_of(self._language)["that"]["words"]
        return start is not None and any(first == 0 for first, _ in _places(words, self._plain[start.end() :]))

    def _begins(self, place: int) -> bool:
        """Whether a clause begins at a place."""
        return not any(sign.isalnum() for sign in self._plain[clause_start(self._plain, place) : place])

    @property
    def _is_one_clause(self) -> bool:
        return clause_end(self._plain, 0) >= len(self._plain.rstrip(" .!?。"))

    def _clause(self, hit: Doubt) -> Span:
        return clause_start(self._plain, hit.start), clause_end(self._plain, hit.end)

    def _sentence(self, hit: Doubt) -> Span:
        ends = [match.end() for match in _SENTENCE_END.finditer(self._plain)]
        start = max((end for end in ends if end <= hit.start), default=0)
        return start, min((end for end in ends if end > hit.start), default=len(self._plain))


def _evident(plain: str, evidence: Mapping[str, str]) -> Iterator[Span]:
    """Where the words stand that an act came from; all of the sentence where that is not known."""
    found = False
    for name, words in evidence.items():
        for part in words.split(" … ") if name != "not_used" else ():
            place = plain.find(normalise(part))
            if place >= 0 and part:
                found = True
                yield place, place + len(part)
    if not found:
        yield 0, len(plain)


def stranger(plain: str, context: Context | None) -> Span | None:
    """The name of somebody who is no user of the cell, where one is to be served, promised or left out.

    >>> start, end = stranger("at least 1 Mbit/s for Brenda", None)
    >>> "at least 1 Mbit/s for Brenda"[start:end]
    'Brenda'
    """
    own = re.findall(r"\w+", " ".join(context.user_names).casefold()) if context is not None else []
    for match in (match for language in languages_of(plain) for match in _names(language).finditer(plain)):
        form = match.lastgroup or ""
        name = match[form].casefold()
        if name not in own and (form == "titled" or not shipped_model().familiarity(name)):
            return match.span() if form == "titled" else match.span(form)
    return None


def table_of(language: str) -> Mapping[str, Mapping[str, Sequence[str]]]:
    """The classes of a language: words by class and by how far they reach."""
    return table("moods", language)


def _places(words: Sequence[str], plain: str) -> Iterator[Span]:
    """Where any of these words stand, the longest where several begin; "*" is any ending, "#" a number.

    Only words of which a part is in the text are made patterns: a language has hundreds.
    """
    small, end = plain.lower(), 0
    found = [match.span() for word in words if _stem(word) in small for match in _pattern(word).finditer(plain)]
    for span in sorted(found, key=lambda span: (span[0], -span[1])):
        if span[0] >= end:
            end = span[1]
            yield span


@functools.cache
def _stem(word: str) -> str:
    """The longest part of a word that is always written so."""
    return max(re.split(r"[*# ]+", word.lower()), key=len)


@functools.cache
def _pattern(word: str) -> re.Pattern[str]:
    return re.compile(_written(word), re.IGNORECASE)


def _written(word: str) -> str:
    body = re.escape(word).replace(r"\ ", r"\s+").replace(r"\*", r"\w*").replace(r"\#", r"\s?\d+\s?")
    if "\u3400" <= word[-1] <= "\u9fff" or "\u3400" <= word[0] <= "\u9fff":
        return body
    return (rf"(?<!{_LETTER})" if word[0].isalnum() else "") + body + (rf"(?!{_LETTER})" if word[-1].isalnum() else "")


@functools.cache
def _names(language: str) -> re.Pattern[str]:
    """Names: behind a title, or written large beside a word that somebody is named by."""
    data = table_of(language)["names"]
    listed = {key: "|".join(sorted(map(re.escape, words), key=len, reverse=True)) for key, words in data.items()}
    if language == "zh":
        familiar = f"(?:{listed['nicknames']})(?:{listed['surnames']}|{listed['given']})"
        titled = f"(?:{listed['surnames']})(?:{listed['titles']})"
        return re.compile(f"(?P<titled>(?<![最缩减变大太过较很]){familiar}|{titled})")
    large = rf"(?!(?i:{listed['titles']})\b)[A-ZÀ-Þ][a-zß-ÿ]+"
    return re.compile(
        rf"\b(?i:{listed['titles']})\b\.?\s+(?P<titled>{large})|\b(?i:{listed['before']})\s+(?P<behind>{large})|"
        rf"(?:^|[,;.:!?]\s)\s*(?P<ahead>{large})\s+(?i:{listed['after']})\b"
    )
