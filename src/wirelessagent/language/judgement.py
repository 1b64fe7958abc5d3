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


def judge(sentence: Sentence, registered: set[str]) -> Judgement:
    """What the sentence wants, among the registered objectives."""
    goal, labels = sentence.goal, sentence.chances.kinds
    kinds = _by_kind(labels)
    objective = max(BUILT_IN, key=lambda name: labels[name])
    share, limits = labels[objective], labels[_LIMITS]
    command = forms.plain_command(sentence.plain)
    if command:
        return Judgement(
            kind="command", topic=command, objective=objective, likeliest=share, limits=limits, certainty=1.0,
            acts=False,
        )  # fmt: skip
    own_phrase = goal.verdict == "clear" and (goal.objective not in BUILT_IN or _is_all_said(sentence))
    if own_phrase and kinds["question"][0] + kinds["command"][0] < _OWN_PHRASE_ASKED:
        return Judgement(
            kind="allocate", topic="", objective=goal.objective, likeliest=1.0, limits=0.0, certainty=goal.confidence,
            acts=goal.objective in registered, objective_clear=True,
        )  # fmt: skip
    kind, spoken_of = _kind(sentence, kinds, objective, share), _spoken_of(goal, labels)
    told = kind == "clarify" and sentence.worded and sentence.chances.is_told
    if told and spoken_of is not None and spoken_of in labels:
        kind, objective = "allocate", spoken_of  # "tomorrow, save power": the guard asks whether it is ordered now
        share = labels[objective]
    acts = kind == "allocate"
    topic = "" if acts else kinds[kind][1]
    if topic == "what_if" and sentence.reading.steps and labels["question.step"] > labels[_WHAT_IF] / 2:
        topic = "step"
    if topic == "step" and _is_of_no_step(sentence):
        topic = "what_if"
    agreed = goal.confidence if goal.verdict == "clear" and goal.objective == objective else 0.0
    sure = max(agreed, share) if acts else kinds[kind][0]
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


def _by_kind(labels: Mapping[str, float]) -> dict[str, tuple[float, str]]:
    """How likely each other kind is, and its likeliest topic."""
    found = dict[str, tuple[float, str]]()
    for kind in _OTHER_KINDS:
        topics = {label.partition(".")[2]: share for label, share in labels.items() if label.partition(".")[0] == kind}
        found[kind] = sum(topics.values()), max(topics, key=lambda topic: topics[topic])
    return found


def _kind(sentence: Sentence, kinds: Mapping[str, tuple[float, str]], objective: str, share: float) -> IntentKind:
    """The likeliest kind; "allocate" only where the objective, which has this share, may be acted on."""
    other = max(_OTHER_KINDS, key=lambda kind: kinds[kind][0])
    if forms.is_a_program(sentence.text):
        return "out_of_scope"
    sign = len(sentence.units) == 1 and len(sentence.units[0].word) == 1  # a letter, a Chinese character
    if sign or not sentence.worded:
        return "clarify"
    if kinds[other][0] >= share:
        back = other == "command" and sentence.reading.back  # "bring user 3 back" changes a request, it undoes none
        return "clarify" if back or kinds[other][0] < _AGREED else cast("IntentKind", other)
    goal = sentence.goal
    enough = _ENOUGH if goal.verdict != "clear" else _AGREED if goal.objective == objective else _AGAINST
    return "allocate" if share >= enough else "clarify"
