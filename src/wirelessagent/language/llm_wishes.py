"""Whether a sentence may be taken for the request or the command that an LLM takes it for.

An LLM may understand more than the rules do, an indirect wish above all. But what acts has to be defensible by the
sentence itself: no request comes from what the rules clearly read as a question, as something else, as refused or
turned round; and the words that the LLM quotes hold one that the lexicon, the base words or the objective's own phrases
tie to the objective. The rules' own reading needs neither.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from wirelessagent.language import forms
from wirelessagent.language.base_words import based
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Intent
from wirelessagent.language.linear_model import shipped_model
from wirelessagent.language.llm_reasons import Objection
from wirelessagent.language.sentence import Sentence
from wirelessagent.language.text import normalise, unaccented
from wirelessagent.language.vocabulary import OwnWords, units_of

_A_QUESTION, _SOMETHING_ELSE, _REFUSED = 0.5, 0.8, 0.5
_ENDS_WITH_NO = deferred(r"(?i)[,.?!;:\uff0c。]\s*(?:no|not|nope|never|不|不要|不是|不行|不用)[\s.!。]*$")

# Concepts of the lexicon and base words that speak of an objective.
_TIES: Mapping[str, tuple[str, str]] = {
    "max_rate": (
        "rate stream performance",
        "throughput rate fast megabit kilobit video boost push squeeze slow send download upload speed",
    ),
    "min_power": (
        "power battery",
        "power save battery energy electricity green quiet radiate transmit consume consumption watt joule",
    ),
    "max_energy_efficiency": (
        "efficiency balance paired both",
        "efficient efficiency joule energy power battery electricity balance",
    ),
    "proportional_fairness": ("fair fairly share same balance", "fair unfair share equal proportional logarithm"),
    "max_min_rate": (
        "worst fair fairly same",
        "slow weak last edge far bad starve least fair unfair equal lift raise help behind",
    ),
}  # fmt: skip
_COMMANDS: Mapping[str, tuple[str, str]] = {
    "undo": ("undo", "undo cancel"),
    "reset": ("", "restart delete reset clear forget"),
}
_SMALL = (
    "a all an and are as at be by do each for from in is it me more most my no not of on or our that the then this to "
    "us user users we with you your"
)


class Wishes:
    """What one sentence may be taken for."""

    def __init__(self, sentence: Sentence, offline: Intent, own: Sequence[OwnWords]) -> None:
        self._sentence, self._offline, self._own = sentence, offline, own
        self._kinds: dict[str, float] = {}
        text, concepts, language = sentence.for_model()
        labels = shipped_model().probabilities(text, concepts, language)
        for label, share in labels.items():
            kind = label.partition(".")[0]
            self._kinds[kind] = self._kinds.get(kind, 0.0) + share
        self._negated = labels.get("clarify.negated", 0.0)

    def request(self, objective: str, quote: str, *, changes: bool) -> None:
        """Objects to an objective that nobody can have asked for in these words.

        Args:
            objective: what the LLM takes the sentence to ask for.
            quote: the operator's words for it.
            changes: whether it only changes the limits of the current request, whose objective needs no words.
        """
        if self._offline.kind == "allocate" and self._offline.objective == objective:
            return
        self._asked_for()
        goal = self._sentence.goal
        refused = self._negated >= _REFUSED or (goal.verdict == "negated" and objective in goal.options)
        if refused or goal.verdict == "opposite":
            raise Objection("refused_wish", "the sentence refuses that, or wants the opposite: use clarify")
        if goal.verdict == "clear" and goal.objective != objective and not changes:
            raise Objection("not_tied", f"the sentence speaks of {goal.objective}: say so too, or use clarify")
        if not changes and objective not in goal.options and not self._speaks_of(objective, quote):
            raise Objection(
                "not_tied", f"objective_words hold no word for {objective}: quote the words for it, or use clarify"
            )

    def command(self, topic: str) -> None:
        """Objects to an undo or a reset that nobody said."""
        if (self._offline.kind, self._offline.topic) == ("command", topic):
            return
        self._asked_for()
        concepts, words = (set(each.split()) for each in _COMMANDS[topic])
        plain = self._sentence.plain
        if "not" in self._sentence.concepts or not (
            concepts & self._sentence.concepts or words & set(_words(plain, self._sentence.language))
        ):
            raise Objection("go_ahead", f"the operator did not plainly say {topic}: use clarify")

    def _asked_for(self) -> None:
        """Objects where the rules clearly see a question, something else, or a no."""
        if self._offline.kind == "question" and self._kinds["question"] >= _A_QUESTION:
            raise Objection("not_asked", "the sentence is a question: kind question, or clarify")
        other = self._offline.kind == "out_of_scope" and self._kinds["out_of_scope"] >= _SOMETHING_ELSE
        if other or forms.is_a_program(self._sentence.text):
            raise Objection("not_asked", "the sentence asks for nothing of the cell: kind out_of_scope, or clarify")
        if _ENDS_WITH_NO.search(self._sentence.plain):
            raise Objection("refused_wish", "the sentence ends with a no: use clarify")

    def _speaks_of(self, objective: str, quote: str) -> bool:
        """Whether a quotation holds a whole word for an objective."""
        place = normalise(self._sentence.plain).casefold().find(" ".join(normalise(quote).split()).casefold())
        inside = [item for item in self._sentence.found if place <= item.start and item.end <= place + len(quote)]
        concepts, known = (set(each.split()) for each in _TIES.get(objective, ("", "")))
        if any(item.term.objective == objective or item.term.concept in concepts for item in inside):
            return True
        said = set(_words(quote, self._sentence.language))
        return bool(said & known or said & set(self._own_words(objective)))

    def _own_words(self, objective: str) -> Iterator[str]:
        """The words that an objective brings with it, the smallest left out."""
        for own in self._own:
            if own.objective == objective:
                for phrase in (*own.names, *(phrase for _, phrases in own.phrases for phrase in phrases)):
                    words = (unit.word for unit in units_of(normalise(phrase.replace("_", " "))))
                    yield from (word for word in words if len(word) > 1 and word not in _SMALL.split())


def _words(text: str, language: str) -> Iterator[str]:
    """The words of a text, and their base words."""
    tokens = [unit.word for unit in units_of(normalise(text))]
    yield from (word for word in tokens if len(word) > 1)
    yield from based([unaccented(word) for word in tokens], language)
