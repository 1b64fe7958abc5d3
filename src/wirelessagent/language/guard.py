"""The guard behind every recogniser: what is not clearly asked for now is asked about, and never done.

A sentence may name an act without asking for it: it refuses, reports, quotes, remembers, plans, supposes, jests, tells
a wish of somebody else's, speaks of another system, or of a user whom the cell does not have. The words that say so
are closed classes, as data by language (``moods/<language>.toml``). A word of such a class that the act accounts for
says nothing: "no more than 10 W" is a limit, "without user 3" leaves one out, "from now on" is now. Any other word
whose reach (its clause, its sentence or the whole text) touches the act makes a question of it, with the act for a
plain yes. Beside them the model judges the sentence as a whole: it asks where no listed word stands and an order is
unlikely all the same, and passes over some classes where a sentence is surely one.
"""

from __future__ import annotations

import dataclasses
import functools
import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from wirelessagent.language.features import word_hashes
from wirelessagent.language.followups import dropped_in
from wirelessagent.language.intent import Intent
from wirelessagent.language.linear_model import shipped_model
from wirelessagent.language.moods import Span, places, standing, table_of
from wirelessagent.language.reach import Doubt, Reach
from wirelessagent.language.replies import Voice
from wirelessagent.language.sentence import labels_of, own_words, read_once
from wirelessagent.language.text import USER_NOUN, languages_of, normalise

if TYPE_CHECKING:
    from wirelessagent.language.recogniser import Context

MOODS = (
    "negation", "refusal", "report", "quotation", "past", "time", "condition", "irony", "others", "elsewhere",
)  # fmt: skip
"""The classes whose words make a question of an act."""
_PASSED_OVER = ("refusal", "condition", "irony", "others")
"""The classes that say nothing in a sentence that is surely an order; what denies, tells of what was said or done,
quotes, or names another system or a time to come is asked about all the same."""
CHANGING = ("undo", "reset")
"""Commands that change something; to apply a plan has a closed grammar of its own (``conversation.assent``)."""
READ_IN_A_TALK = "conversation"
"""Who reads what a line is because of its conversation."""

_NAMES_SHOWN = 12
_UNLIKELY, _SURELY = 0.2, 0.9
"""Below the one a sentence without a word of a mood is asked about, from the other on some classes are passed over; by
sentences that were kept from the training."""

_FEWEST_WORDS = 3
"""Of a sentence that the model can judge."""

_QUOTED = re.compile(
    r"\"[^\"]+\"|“[^”]+[”\"]|„[^“”]+[“”]|«[^»]+»|‹[^›]+›|「[^」]+」|『[^』]+』|《[^》]+》|(?<!\w)'[^']+'(?!\w)"
)
_IS_A_USER = re.compile(  # "Uncle Bob is on user 8", "Brenda (user 3)"
    rf"(?i)[\s,(]*(?:(?:is|uses|on|at|ist|an|est|sur|es|está|en)\s+)*(?:{USER_NOUN}\s*\d|[是在用的]*(?:用户\s*\d|\d+\s*号))"
)


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
    if not acts:
        return intent
    sure, moods = _sure(text, context, intent), _moods_of(intent)
    if sure >= _SURELY:
        moods = [mood for mood in moods if mood not in _PASSED_OVER]
    doubt = doubted(text, context, intent, moods)
    if doubt is None and (
        sure >= _UNLIKELY or any(any(_hits(plain, language, MOODS)) for language in languages_of(text))
    ):
        return intent
    guess = intent.reply.rstrip(" .。")
    guess = guess[:1].lower() + guess[1:]
    said = "" if doubt is None else text[doubt.start : doubt.end].strip()
    reply = voice.say("mood", text=said, guess=guess) if said else voice.say("no_order", guess=guess)
    return dataclasses.replace(_asking(intent, reply), guess=intent)


def _sure(text: str, context: Context | None, intent: Intent) -> float:
    """How sure the model is that a sentence orders something now; as sure as needed where it has no say.

    A command says by itself that it does; of what only the talk gives a meaning ("yes") the words alone say nothing,
    nor do hardly any words.
    """
    if intent.kind == "command" or intent.recogniser == READ_IN_A_TALK:
        return _UNLIKELY
    words, concepts, language = read_once(text, own_words(), context).for_model(moods=True)
    if len(word_hashes(words)) < _FEWEST_WORDS:
        return _UNLIKELY
    return shipped_model().is_order(words, concepts, language)


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
    for language in languages_of(text):
        hits = list(_hits(plain, language, moods))
        told = (
            "others" in moods
            and intent.kind == "allocate"
            and any(places(table_of(language)["subject"]["finite"], plain))
        )
        if hits or told:
            known = Reach(read_once(text, own_words(), context), dropped_in(plain, context)[1], intent, language)
            reached = (hit for hit in hits if not known.accounts_for(hit) and known.touches(hit))
            first = min(reached, key=lambda hit: hit.start, default=None)
            first = first or (known.foreign_subject() if told else None)
            if first is not None:
                return first
    return None


def _hits(plain: str, language: str, moods: Sequence[str]) -> Iterator[Doubt]:
    """The words of these classes of a language in a text, and what stands between marks."""
    for mood, reach, (start, end) in standing(plain, language, moods):
        yield Doubt(mood=mood, reach=reach, start=start, end=end)
    if "quotation" in moods:
        for match in _QUOTED.finditer(plain):
            yield Doubt(mood="quotation", reach="inside", start=match.start(), end=match.end())


def tells_no_mere_fact(text: str) -> bool:
    """Whether a clause that is no order has a word of a mood in it, but of what was or what is denied.

    >>> tells_no_mere_fact("user 7 has paid"), tells_no_mere_fact("once user 7 has paid")
    (False, True)
    """
    plain = normalise(text)
    moods = [mood for mood in MOODS if mood not in ("negation", "past", "elsewhere")]
    return any(True for language in languages_of(text) for _ in standing(plain, language, moods))


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
        if name in own or _IS_A_USER.match(plain, match.end(form)):
            continue
        whole = form in ("titled", "lettered")
        if whole or not shipped_model().familiarity(name):
            return match.span() if whole else match.span(form)
    return None


@functools.cache
def _names(language: str) -> re.Pattern[str]:
    """Names: behind a title, or written large beside a word that somebody is named by."""
    data = table_of(language)["names"]
    listed = {key: "|".join(sorted(map(re.escape, words), key=len, reverse=True)) for key, words in data.items()}
    if language == "zh":
        familiar = f"(?:{listed['nicknames']})(?:{listed['surnames']}|{listed['given']})"
        titled = f"(?:{listed['surnames']})(?:{listed['titles']})"
        return re.compile(rf"(?P<titled>(?<![最缩减变大太过较很]){familiar}|{titled}|用户\s*[A-Z](?![A-Za-z0-9]))")
    large = rf"(?!(?i:{listed['titles']})\b)[A-ZÀ-Þ][a-zß-ÿ]+"
    return re.compile(
        rf"\b(?i:{listed['titles']})\b\.?\s+(?P<titled>{large})|\b(?i:{listed['before']})\s+(?P<behind>{large})|"
        rf"(?:^|[,;.:!?]\s)\s*(?P<ahead>{large})\s+(?i:{listed['after']})\b|(?i:\b{USER_NOUN})\s+(?P<lettered>[A-Z])(?!\w)"
    )
