"""The guard behind every recogniser: what is not clearly asked for now is asked about, and never done.

A sentence may name an act without asking for it: it refuses, reports, quotes, remembers, plans, supposes, jests, tells
a wish of somebody else's, speaks of another system, or of a user whom the cell does not have. Whether it orders
something is judged by two readers, whose scores count alike: the network reads all its words (:mod:`.sentence_model`),
a logistic regression its frame, all that stands around the wish (:mod:`.order_model`). Where an order is unlikely, the
agent asks, with the words that speak against it and with the act for a plain yes. It asks as well where an order hardly
says what was read of it, which the network judges, too.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from wirelessagent.language.intent import Intent
from wirelessagent.language.moods import lifted_in
from wirelessagent.language.order_model import shipped_order_model
from wirelessagent.language.replies import Voice
from wirelessagent.language.request import users_in
from wirelessagent.language.sentence import labels_of, own_words, read_once
from wirelessagent.language.text import Span, replaced
from wirelessagent.language.vocabulary import languages_of
from wirelessagent.language.word_tables import table

if TYPE_CHECKING:
    from wirelessagent.language.recogniser import Context

CHANGING = ("undo", "reset")
"""Commands that change something; to apply a plan has a closed grammar of its own (``conversation.assent``)."""
READ_IN_A_TALK = "conversation"
"""Who reads what a line is because of its conversation."""

_NAMES_SHOWN = 12
_FEWEST_WORDS = 3
"""And signs, of a sentence that can be judged."""
_CLAUSE, _FAITHFUL = 0.4, 0.2
"""How likely an order what begins with a clause has to be by itself, and how likely it is read as it is meant."""


def guarded(text: str, context: Context | None, intent: Intent) -> Intent:
    """The intent, or a question back about it where its sentence does not clearly ask for it now."""
    if intent.recogniser == READ_IN_A_TALK and (intent.acts or intent.kind == "command"):  # each word is known
        return intent
    acts = intent.kind == "allocate" or (intent.kind == "command" and intent.topic in CHANGING)
    if not acts and not (intent.kind == "clarify" and intent.pending):
        return intent
    voice = Voice(intent.language, labels_of(own_words(), intent.language))
    name, users = stranger(text, context), ", ".join(context.user_names[:_NAMES_SHOWN]) if context is not None else ""
    waits = acts and users and name in users_in(intent.constraints)  # the session asks who that is, and goes on
    if name and not waits:
        return _asking(intent, voice.say("unknown_name" if users else "unknown_name_alone", text=name, users=users))
    if not acts:
        return intent
    doubt = doubted(text, context, intent)
    if doubt is None:
        return asking_whether(intent, voice) if not waits and is_bent(text, context, intent) else intent
    words = text[slice(*doubt)].strip()
    return asking_whether(intent, voice, words if any(map(str.isalnum, words)) else "")


def asking_whether(intent: Intent, voice: Voice, doubt: str | None = None) -> Intent:
    """The question whether an intent is meant, or ordered now, with the words that speak against that."""
    guess = intent.reply.rstrip(" .。")
    key = "do_you_mean" if doubt is None else "mood" if doubt else "no_order"
    reply = voice.say(key, text=doubt or "", guess=guess[:1].lower() + guess[1:])
    return _asking(intent, reply, guess=intent)


def doubted(text: str, context: Context | None, intent: Intent) -> Span | None:
    """The words that speak against an order, empty where no few of them do; None where it is likely one.

    From each clause with a figure or a user on it must not be too unlikely, too: "…, no way user 3 gets 2 Mbit/s".
    Of what only the talk gives a meaning ("yes") the words alone say nothing, nor do hardly any words; what only lifts
    limits is known.
    """
    if intent.recogniser == READ_IN_A_TALK:
        return None
    sentence = read_once(text, own_words(), context)
    if len(sentence.frame.tokens) < _FEWEST_WORDS or _only_lifts(sentence.plain):
        return None
    turn = next(sentence.turns_unread(), None)
    if turn is not None:
        return turn
    if not sentence.chances.is_order:
        return shipped_order_model().against(sentence.frame) or (0, 0)
    return next((span for span, said in sentence.clauses() if said.chances.order < _CLAUSE), None)


def _only_lifts(plain: str) -> bool:
    """Whether a text has no words but those that lift limits."""
    lifting = sorted(lifted_in(plain).values())
    return not any(map(str.isalnum, replaced(plain, ((start, end, "") for start, end in lifting))))


def is_bent(text: str, context: Context | None, intent: Intent) -> bool:
    """Whether a sentence is likely to mean something else than its figures and users were read as.

    What a language model makes of it may be something else than that; where nothing was read, there is nothing to ask
    about, and behind a request what a line may mean is weighed (:mod:`.conversation.weighing`).
    """
    weighed = context is not None and context.objective is not None
    if weighed or intent.kind != "allocate" or not intent.constraints:
        return False
    sentence = read_once(text, own_words(), context)
    judged = len(sentence.frame.tokens) >= _FEWEST_WORDS and intent.constraints == sentence.reading.values
    return judged and sentence.fidelity < _FAITHFUL


def _asking(intent: Intent, reply: str, guess: Intent | None = None) -> Intent:
    return Intent(
        kind="clarify", objective=None, constraints={}, language=intent.language, confidence=intent.confidence,
        evidence={}, reply=reply, recogniser=intent.recogniser, guess=guess,
    )  # fmt: skip


def stranger(text: str, context: Context | None) -> str:
    """The name of somebody who is no user of the cell, where one is to be served, promised or left out; "" for none.

    >>> stranger("at least 1 Mbit/s for Brenda", None)
    'Brenda'
    """
    own = re.findall(r"\w+", " ".join(context.user_names).casefold()) if context is not None else []
    own += [word for language in languages_of(text) for share in table("figures", language)["shares"]
            for word in share.split()]  # "vier Fünftel"  # fmt: skip
    found = (text[slice(*span)] for span in read_once(text, own_words(), context).reading.strangers)
    return next((name for name in found if name.casefold() not in own), "")
