"""What a sentence wants, as the network judges it, with the lexicon's finding among what it sees.

Something is carried out only where it is likely enough. A question back costs a sentence, a wrong action a cell.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

from wirelessagent.language import forms
from wirelessagent.language.goals import Goal
from wirelessagent.language.intent import IntentKind
from wirelessagent.language.sentence import BUILT_IN, Sentence

_AGREED, _ENOUGH, _AGAINST = 0.4, 0.7, 0.9
"""How likely an aim has to be for acting on it: one that the lexicon's rules find, too; none; or another."""

_OWN_PHRASE_ASKED = 0.8
_OTHER_KINDS = ("question", "command", "clarify", "out_of_scope")
_NAMED, _CLEAR = 0.02, 0.6
"""How likely an aim is, at least, that a question speaks of, and its share among all that it may speak of."""

_WHAT_IF, _LIMITS = "question.what_if", "clarify.limits"


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """The kind of a sentence and what it is about.

    Attributes:
        kind: the likeliest kind; "allocate" only where ``acts``.
        topic: of a question, a command or what to clarify; "" otherwise.
        objective: the likeliest objective, whatever the kind; its share is ``likeliest``.
        limits: how likely the sentence only sets limits and names no objective.
        certainty: 0 to 1, of what was decided.
        acts: whether the objective is likely enough to act on it.
        objective_clear: whether the operator named an objective by its own phrase.
        spoken_of: the objective that a question speaks of; None where it speaks of limits or of nothing.
    """

    kind: IntentKind
    topic: str
    objective: str
    likeliest: float
    limits: float
    certainty: float
    acts: bool
    objective_clear: bool = False
    spoken_of: str | None = None


@dataclass(frozen=True, kw_only=True)
class _Shares:
    """What the model says: by label, by kind, and the likeliest topic of each kind."""

    labels: Mapping[str, float]
    kinds: Mapping[str, float]
    topics: Mapping[str, str]


def judge(sentence: Sentence, registered: set[str]) -> Judgement:
    """What the sentence wants, among the registered objectives."""
    goal, shares = sentence.goal, _shares(sentence)
    objective = max(BUILT_IN, key=lambda name: shares.labels[name])
    share, limits = shares.labels[objective], shares.labels[_LIMITS]
    command = forms.plain_command(sentence.plain)
    if command:
        return Judgement(
            kind="command", topic=command, objective=objective, likeliest=share, limits=limits, certainty=1.0,
            acts=False,
        )  # fmt: skip
    own_phrase = goal.verdict == "clear" and (goal.objective not in BUILT_IN or _is_all_said(sentence))
    if own_phrase and shares.kinds["question"] + shares.kinds["command"] < _OWN_PHRASE_ASKED:
        return Judgement(
            kind="allocate", topic="", objective=goal.objective, likeliest=1.0, limits=0.0, certainty=goal.confidence,
            acts=goal.objective in registered, objective_clear=True,
        )  # fmt: skip
    kind, spoken_of = _kind(sentence, shares, objective), _spoken_of(goal, shares.labels)
    told = kind == "clarify" and sentence.worded and sentence.chances.is_told
    if told and spoken_of is not None and spoken_of in shares.labels:
        kind, objective = "allocate", spoken_of  # "tomorrow, save power": the guard asks whether it is ordered now
        share = shares.labels[objective]
    acts = kind == "allocate"
    topic = "" if acts else shares.topics[kind]
    if topic == "what_if" and sentence.reading.steps and shares.labels["question.step"] > shares.labels[_WHAT_IF] / 2:
        topic = "step"
    if topic == "step" and _is_of_no_step(sentence):
        topic = "what_if"
    agreed = goal.confidence if goal.verdict == "clear" and goal.objective == objective else 0.0
    sure = max(agreed, share) if acts else shares.kinds[kind]
    return Judgement(
        kind=kind, topic=topic, objective=objective, likeliest=share, limits=limits,
        certainty=round(min(1.0, sure), 4), acts=acts, spoken_of=spoken_of,
    )  # fmt: skip


def _is_of_no_step(sentence: Sentence) -> bool:
    """Whether no step of power or rate is named: "what would 10 % less power cost?", "what would less delay bring?"."""
    share_alone = "rate" not in sentence.concepts and {q.kind for q in sentence.quantities} == {"ratio"}
    return share_alone or "unsupported" in sentence.concepts


def _spoken_of(goal: Goal, labels: Mapping[str, float]) -> str | None:
    """The objective that a sentence speaks of, whatever its kind; None where it speaks of limits or of nothing."""
    if goal.verdict == "clear":
        return goal.objective
    named = {name: labels[name] for name in (*BUILT_IN, _LIMITS)}
    likeliest = max(named, key=lambda name: named[name])
    clear = likeliest != _LIMITS and named[likeliest] > max(_NAMED, _CLEAR * sum(named.values()))
    return likeliest if clear else None


def _is_all_said(sentence: Sentence) -> bool:
    """Whether a sentence is nothing but the words for its wish: "max rate", "P1"."""
    (start, end), *others = sentence.goal.spans
    return not others and sentence.plain[start:end] == sentence.plain.strip(" .!。\uff01")


def _shares(sentence: Sentence) -> _Shares:
    labels = sentence.chances.kinds
    kinds: dict[str, float] = dict.fromkeys(_OTHER_KINDS, 0.0)
    best: dict[str, tuple[float, str]] = dict.fromkeys(_OTHER_KINDS, (-1.0, ""))
    for label, share in labels.items():
        kind, _, topic = label.partition(".")
        if kind in kinds:
            kinds[kind] += share
            best[kind] = max(best[kind], (share, topic))
    return _Shares(labels=labels, kinds=kinds, topics={kind: topic for kind, (_, topic) in best.items()})


def _kind(sentence: Sentence, shares: _Shares, objective: str) -> IntentKind:
    """The likeliest kind; "allocate" only where that may be acted on."""
    other = max(_OTHER_KINDS, key=lambda kind: shares.kinds[kind])
    if forms.is_a_program(sentence.text):
        return "out_of_scope"
    sign = len(sentence.units) == 1 and len(sentence.units[0].word) == 1  # a letter, a Chinese character
    if sign or not sentence.worded:
        return "clarify"
    if shares.kinds[other] >= shares.labels[objective]:
        back = other == "command" and sentence.reading.back  # "bring user 3 back" changes a request, it undoes none
        return "clarify" if back or shares.kinds[other] < _AGREED else cast("IntentKind", other)
    goal = sentence.goal
    enough = _ENOUGH if goal.verdict != "clear" else _AGREED if goal.objective == objective else _AGAINST
    return "allocate" if shares.labels[objective] >= enough else "clarify"
