"""The offline recogniser: no network, no language model. It acts only when it is sure, and asks otherwise.

Figures and users come from the parsers alone (``quantities``, ``constraints``). What the sentence wants is judged
twice: by a lexicon with rules (``goals``: precise, but blind to what it does not list) and by a small network
(``sentence_model``: seldom at a loss, never quite certain). Where both agree little certainty is needed, where only the
model speaks much; where they disagree the operator is asked. There is one default: a rate for each user under a power
limit, with no wish, means the highest total rate with both. Any registered objective is understood by its name, its
aliases and its own phrases. A question back costs a sentence, a wrong action a cell.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

from wirelessagent.language import moods
from wirelessagent.language.goals import Goal
from wirelessagent.language.intent import COMMANDS, EVERYBODY, Constraint, Intent, IntentKind
from wirelessagent.language.moods import dropped_in
from wirelessagent.language.numerals import MOST_FIGURES, too_many_figures
from wirelessagent.language.quantities import amount_of_another_time
from wirelessagent.language.recogniser import Context, Recogniser
from wirelessagent.language.replies import Answer, Voice
from wirelessagent.language.request import merged, serving
from wirelessagent.language.sentence import BUILT_IN, Sentence, labels_of, own_words, read_once
from wirelessagent.language.stated import unread
from wirelessagent.language.text import normalise
from wirelessagent.language.topics import about, details_of
from wirelessagent.language.vocabulary import MASK, OwnWords, language_in_a_talk
from wirelessagent.language.word_tables import deferred, either, words_of

_AGREED, _ENOUGH, _AGAINST = 0.4, 0.7, 0.9
"""How likely an aim has to be for acting on it: one that the lexicon's rules find, too; none; or another."""

_OWN_PHRASE_ASKED = 0.8
_OTHER_KINDS = ("question", "command", "clarify", "out_of_scope")
_NAMED, _CLEAR = 0.02, 0.6
"""How likely an aim is, at least, that a question speaks of, and its share among all that it may speak of."""

_LIMITS = "clarify.limits"


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """The kind of a sentence and what it is about.

    Attributes:
        kind: the likeliest kind; "allocate" only where the objective is likely enough to act on it.
        topic: of a question, a command or what to clarify; "" otherwise.
        objective: the likeliest objective, whatever the kind; its share is ``likeliest``.
        limits: how likely the sentence only sets limits and names no objective.
        certainty: 0 to 1, of what was decided.
        spoken_of: the objective that a question speaks of; None where it speaks of limits or of nothing.
    """

    kind: IntentKind
    topic: str = ""
    objective: str
    likeliest: float
    limits: float
    certainty: float = 1.0
    spoken_of: str | None = None

    @property
    def acts(self) -> bool:
        return self.kind == "allocate"


def judge(sentence: Sentence) -> Judgement:
    """What the sentence wants."""
    goal, labels = sentence.goal, sentence.chances.kinds
    kinds = _by_kind(labels)
    objective = max(BUILT_IN, key=lambda name: labels[name])
    share, limits = labels[objective], labels[_LIMITS]
    command = moods.plain_command(sentence.plain)
    if command:
        return Judgement(kind="command", topic=command, objective=objective, likeliest=share, limits=limits)
    own_phrase = goal.verdict == "clear" and (goal.objective not in BUILT_IN or _is_all_said(sentence))
    if own_phrase and kinds["question"][0] + kinds["command"][0] < _OWN_PHRASE_ASKED:
        return Judgement(
            kind="allocate", objective=goal.objective, likeliest=1.0, limits=0.0, certainty=goal.confidence
        )
    left = (unit for unit in sentence.wishing(sentence.units) if unit.word != MASK)
    if sentence.reading.values and next(left, None) is None:  # no word is left for an aim
        return Judgement(kind="clarify", objective=objective, likeliest=0.0, limits=1.0)
    kind, spoken_of = _kind(sentence, kinds, objective, share), _spoken_of(goal, labels)
    told = kind == "clarify" and sentence.worded and sentence.chances.is_told
    if told and spoken_of is not None and spoken_of in labels:
        kind, objective = "allocate", spoken_of  # "tomorrow, save power": the guard asks whether it is ordered now
        share = labels[objective]
    acts = kind == "allocate"
    topic = "" if acts else kinds[kind][1]
    if topic == "step" and "rate" not in sentence.concepts and {q.kind for q in sentence.quantities} == {"ratio"}:
        topic = "what_if"  # "what would 10 % less power cost?": no step of power or rate is named
    agreed = goal.confidence if goal.verdict == "clear" and goal.objective == objective else 0.0
    sure = max(agreed, share) if acts else kinds[kind][0]
    return Judgement(
        kind=kind, topic=topic, objective=objective, likeliest=share, limits=limits,
        certainty=round(min(1.0, sure), 4), spoken_of=spoken_of,
    )  # fmt: skip


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
    if moods.is_a_program(sentence.text):
        return "out_of_scope"
    words = [unit.word for unit in sentence.units]
    sign = len(words) == 1 and len(words[0]) == 1 and words[0] != MASK  # a letter, a Chinese character
    if sign or not sentence.worded:
        return "clarify"
    if kinds[other][0] >= share:
        back = other == "command" and sentence.reading.back  # "bring user 3 back" changes a request, it undoes none
        return "clarify" if back or kinds[other][0] < _AGREED else cast("IntentKind", other)
    goal = sentence.goal
    enough = _ENOUGH if goal.verdict != "clear" else _AGREED if goal.objective == objective else _AGAINST
    return "allocate" if share >= enough else "clarify"


NAME = "offline"
_MAX_CHARACTERS = 2000
_DEFAULT_CONFIDENCE = 0.75
_OF_A_RESULT = ("other", "users", "step", "prices", "certificate")
"""Questions that are about a decision, or, before there is one, about what could be."""

_FAIR_OBJECTIVES = ("proportional_fairness", "max_min_rate")
_UNFAIR_OBJECTIVES = ("max_rate", "min_power", "max_energy_efficiency")
_FAIR_WORDS = {"fair", "same", "fairly"}
_ASKED = deferred(r"[?\uff1f]\s*$")
_NOT = f"{either('moods', 'negation', 'clause')}|{either('figures', 'bounds', 'forbids')}"
_STARVES = either("figures", "starving", "goes_without")
_NOBODY_STARVES = deferred(
    rf"(?i)(?:{_NOT})[^,;.!?]{{0,40}}?(?:{_STARVES})|{either('figures', 'starving', 'cared_for')}"
)
CHANGING = ("apply", "confirm", "undo", "reset")
_SURE_OF_A_COMMAND = 0.6
_CUES = {  # a command that changes something has a part of one of these words in it
    topic: deferred(f"(?i){'|'.join(words_of('talk_forms', 'cues', topic))}") for topic in ("reset", "undo", "apply")
}


class OfflineRecogniser(Recogniser):
    """Recognises intents in English and Chinese, and plain ones in Spanish, French and German."""

    name = NAME

    def read(self, text: str, context: Context | None = None) -> Intent:
        """What the operator may mean, as it is read; never raises, whatever the text."""
        own, context = own_words(), context or Context()
        language = language_in_a_talk(text[:_MAX_CHARACTERS], context.language)
        voice = Voice(language, labels_of(own, language))
        if len(text) > _MAX_CHARACTERS:
            return Answer(voice, NAME).ask("too_long")
        if too_many_figures(normalise(text)):
            return Answer(voice, NAME).ask("too_many_figures", most=str(MOST_FIGURES))
        return _Understanding(text, own, voice, context).intent()


def recognise(text: str, context: Context | None = None) -> Intent:
    """What the operator means, by the offline recogniser.

    >>> intent = recognise("Save power for sensors, 200 kbit/s each")
    >>> intent.objective, dict(intent.constraints)
    ('min_power', {'min_rate_bps': 200000.0})
    """
    return OfflineRecogniser().recognise(text, context)


class _Understanding:
    """One sentence within a conversation, and what it amounts to."""

    def __init__(self, text: str, own: tuple[OwnWords, ...], voice: Voice, context: Context) -> None:
        self._text, self._voice, self._answer, self._context = text, voice, Answer(voice, NAME), context
        self._sentence = read_once(text, own, context)
        self._reading, self._goal = self._sentence.reading, self._sentence.goal
        self._dropped, dropped_spans = dropped_in(self._sentence.plain, context)
        named = [(item.start, item.end) for item in self._sentence.found if item.term.concept != "domain"]
        self._unread = amount_of_another_time(self._sentence.plain) or unread(
            self._sentence.plain, [*self._reading.masked, *self._reading.counted, *named, *dropped_spans]
        )
        self._judged: Judgement = judge(self._sentence)
        self._fair = [name for name in _FAIR_OBJECTIVES if name in voice.labels]

    def intent(self) -> Intent:
        if not self._sentence.units:
            return self._answer.ask("empty", confidence=1.0)
        return self._follow_up() or self._not_a_request() or self._unfulfillable() or self._request()

    def _follow_up(self) -> Intent | None:
        """A change of the current request that names no wish of its own: "now with 10 W", "leave user 3 out"."""
        context, reading, judged = self._context, self._reading, self._judged
        changes = bool(reading.values or self._dropped or reading.back)
        if context.objective is None or not changes:
            return None
        asked = _ASKED.search(moods.without_a_tag(self._text)) is not None
        no_request = judged.kind in ("question", "command", "out_of_scope")
        if asked or (no_request and judged.topic not in (*CHANGING, "reject")):
            return None
        other = self._goal.verdict == "clear" and self._goal.objective != context.objective
        wished = judged.likeliest > judged.limits
        if (judged.acts and wished) or other or self._goal.verdict == "contradiction":
            return None  # "fair, at most 5 W": a wish that is not sure is no mere limit
        if wished and judged.objective != context.objective:
            return self._whether(judged.objective)
        doubt = self._unfulfillable()
        if doubt is not None:
            return doubt
        out = reading.values.get("leave_out")
        if self._dropped and isinstance(out, tuple):  # "sin tasa mínima para el usuario 3", who has none
            return self._answer.ask("no_limit_of_its_own", 0.8, users=self._voice.users(out))
        values, dropped = self._changes(is_answer=context.awaits == "clarification")
        if not values and not dropped:
            return None
        reply = self._voice.amended(values, dropped)
        request = self._answer.allocate(context.objective, values, reading.evidence, reply, 0.85)
        return dataclasses.replace(request, amends=True, dropped=dropped)

    def _changes(self, *, is_answer: bool) -> tuple[dict[str, Constraint], tuple[str, ...]]:
        """The constraints to state and those to drop; an answer to a question has what was read before it, too."""
        served, dropped = serving(self._reading.back, self._context.constraints, self._context.user_names)
        values = {**self._reading.values, **served}
        values = merged(self._context.question.pending, values) if is_answer else values
        return values, tuple(dict.fromkeys((*self._dropped, *dropped)))

    def _whether(self, objective: str) -> Intent:
        """Whether an aim was meant beside what was read."""
        goal, others = self._voice.label(objective), self._voice.choices(without=objective)
        return self._answer.ask("weak", 0.6, self._reading.values, objective, goal=goal, choices=others)

    def _not_a_request(self) -> Intent | None:
        """Commands, questions, and what has nothing to do with a cell."""
        judged, topic = self._judged, self._judged.topic
        if judged.kind == "question":
            aim = judged.spoken_of if self._context.objective is None else None
            if aim is not None and topic in _OF_A_RESULT:
                topic = "what_if"  # "how fast can the slowest user be?"
            topic, details = about(topic, self._sentence)
            if aim is not None and topic == "what_if":
                details.setdefault("objective", aim)
            return self._answer.question(topic, judged.certainty, **details)
        if judged.kind == "command":
            if self._is_unsure(topic):
                said = self._voice.say(f"command.{topic}")
                return self._answer.ask("unsure_command", judged.certainty, offered=topic, text=said)
            assert topic in COMMANDS
            return self._answer.command(topic, judged.certainty, **details_of(topic, self._sentence))
        if judged.kind == "out_of_scope":
            if "unsupported" in self._sentence.concepts:
                text = self._words_for("unsupported")
                return self._answer.out_of_scope("unsupported", judged.certainty, text=text)
            key = "hello" if "greeting" in self._sentence.concepts else "out_of_scope"
            return self._answer.out_of_scope(key, judged.certainty)
        return None

    def _is_unsure(self, topic: str) -> bool:
        """Whether a command that changes something may have been meant, and has to be asked for: "hmm" undoes none."""
        cue = _CUES.get(topic)
        said = cue is None or cue.search(self._sentence.plain) is not None
        return topic in CHANGING and not (said and self._judged.certainty >= _SURE_OF_A_COMMAND)

    def _unfulfillable(self) -> Intent | None:
        """The first figure or user that can't be used as said, put as a question."""
        pending = self._reading.values
        if self._reading.doubts:
            doubt = self._reading.doubts[0]
            return self._answer.ask(doubt.key, 0.8, pending, **doubt.names)
        if self._unread is not None:
            return self._answer.ask("unread", 0.8, pending, text=self._text[slice(*self._unread)].strip())
        if "max_power_w" in self._reading.exact and self._judged.objective == "min_power":
            return self._answer.ask("exact_power", 0.8, pending, text=self._reading.evidence["max_power_w"])
        return None

    def _request(self) -> Intent:
        goal, judged, default = self._goal, self._judged, self._default()
        if default is not None:
            return default
        likely = judged.acts or judged.topic == "rivals"  # "the most for all in all, but nobody goes without"
        wished = judged.objective if likely else goal.objective if goal.verdict == "clear" else ""
        if wished in self._voice.labels and self._lets_somebody_starve(wished):
            names = {"goal": self._voice.label(wished), "both": self._voice.both(self._fair, "or")}
            return self._answer.ask("starving", 0.8, self._reading.values, **names)
        agreed = goal.verdict == "clear" and goal.objective == judged.objective
        vague = not agreed and "fairly" in self._sentence.concepts  # "make it fairly fast", "a fairly good speed"
        if judged.acts and judged.objective in self._voice.labels and not vague:
            spans = sorted(goal.spans) if goal.options[:1] == (judged.objective,) else ()
            words = " … ".join(self._text[start:end] for start, end in spans) or self._text
            return self._allocate(judged.objective, words, judged.certainty)
        return self._question_back()

    def _lets_somebody_starve(self, objective: str) -> bool:
        """Whether a wish that nobody goes without would be dropped: no least rate for all, no fair objective.

        "max rate, but don't starve anyone" is one, "everyone is starving" none.
        """
        floors = self._reading.values.get("min_rate_bps")
        floor = floors.get(EVERYBODY, 0.0) if isinstance(floors, Mapping) else floors
        unfair = objective in _UNFAIR_OBJECTIVES and not floor
        return unfair and _NOBODY_STARVES.search(self._sentence.plain) is not None

    def _question_back(self) -> Intent:
        """What to ask where no wish is sure."""
        goal, concepts = self._goal, self._sentence.concepts
        pending: Mapping[str, Constraint] = {} if self._sentence.chances.is_told else self._reading.values
        offered = [name for name in goal.options if name in self._voice.labels or goal.verdict == "opposite"]
        if concepts & _FAIR_WORDS and len(self._fair) > 1 and goal.verdict != "contradiction":
            return self._answer.ask("fairness", 0.8, pending, both=self._voice.both(self._fair, "or"))
        if goal.verdict == "contradiction" and len(offered) > 1:
            key = "contradiction" if set(offered) == {"max_rate", "min_power"} else "rivals"
            return self._answer.ask(key, pending=pending, both=self._voice.both(offered))
        if goal.verdict == "negated" or self._judged.topic == "negated":
            return self._answer.ask("negated", pending=pending)
        if goal.verdict == "opposite":
            names = [name for name in offered if name not in self._voice.labels]
            return self._answer.ask("opposite", pending=pending, goal=self._voice.both(names))
        unclear = next((concept for concept in ("unsupported", "strange") if concept in concepts), None)
        if unclear is not None:
            return self._answer.ask("strange", 0.8, pending, text=self._words_for(unclear))
        return self._limits_alone(pending) or self._unclear(pending)

    def _allocate(self, objective: str, words: str, confidence: float) -> Intent:
        context, reading = self._context, self._reading
        evidence = {"objective": words} if words else {}
        evidence |= reading.evidence
        if reading.not_used:
            evidence["not_used"] = " … ".join(reading.not_used)
        holds = context.objective is not None
        whole = bool(words and reading.values)  # a request of its own answers no earlier question
        values, dropped = self._changes(is_answer=context.awaits == "clarification" and not (whole and holds))
        changed = self._dropped or not reading.values or moods.keeps_the_limits(self._text)
        amends = holds and bool(changed)
        reply = self._voice.restated(objective, values, reading.not_used)
        request = self._answer.allocate(objective, values, evidence, reply, confidence)
        return dataclasses.replace(request, amends=amends, dropped=dropped if amends else ())

    def _default(self) -> Intent | None:
        """A promised rate under a power limit has one sensible reading, where nothing else is likely to be wished."""
        values, goal, judged = self._reading.values, self._goal, self._judged
        if judged.likeliest > judged.limits and judged.objective != "max_rate":
            return None
        free = goal.verdict in ("none", "weak") and goal.objective in ("", "max_rate")
        bounded = self._sentence.worded or any(figure.comparator for figure in self._sentence.quantities)
        if {"min_rate_bps", "max_power_w"} <= set(values) and free and bounded and "max_rate" in self._voice.labels:
            return self._allocate("max_rate", "", _DEFAULT_CONFIDENCE)
        return None

    def _limits_alone(self, values: Mapping[str, Constraint]) -> Intent | None:
        """Limits without a wish, and changes of a request that there is not."""
        if values and self._goal.verdict in ("none", "weak"):
            key = "rate_only" if "min_rate_bps" in values else "limits_only"
            return self._answer.ask(key, 0.5, values, constraints=self._voice.constraints(values))
        if self._dropped or self._reading.back:
            key = "nothing_yet" if self._context.objective is None else "so_already"
            return self._answer.ask(key, 0.5, text=f"“{self._text.strip()}”")
        return None

    def _unclear(self, values: Mapping[str, Constraint]) -> Intent:
        found = self._goal.verdict in ("weak", "clear")
        guess = self._goal.objective if found else self._judged.objective
        if guess in self._voice.labels and (found or self._judged.likeliest > 0.4):
            return self._whether(guess)
        return self._answer.ask("greeting" if "greeting" in self._sentence.concepts else "unclear", 0.5, values)

    def _words_for(self, concept: str) -> str:
        item = next(item for item in self._sentence.found if item.term.concept == concept)
        return self._text[item.start : item.end]
