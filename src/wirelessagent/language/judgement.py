"""What a sentence wants, judged by the lexicon and by the linear model together.

The thresholds say how sure the model has to be before anything is carried out: least where the lexicon finds the same
wish, most where it finds another one or hears a refusal. A question back costs a sentence, a wrong action a cell.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from wirelessagent.language import forms
from wirelessagent.language.intent import IntentKind
from wirelessagent.language.linear_model import shipped_model
from wirelessagent.language.sentence import BUILT_IN, Sentence
from wirelessagent.language.vocabulary import MASK

_AGREED, _ALONE, _AGAINST, _AGAINST_RATE = 0.1, 0.45, 0.9, 0.55
_DOUBTED = {"contradiction": 0.8, "negated": 0.75, "opposite": 0.95, "weak": 0.5, "none": _ALONE}
_FOR_THE_SLOWEST = 0.8  # "make the slowest …" sounds like a wish for slowness
_SURE_BESIDE_A_WISH = 0.9
_SOMETHING_INSTEAD = 0.55  # "never mind fairness, …"
_SURE_OF_NO_WISH, _SURE_WITHOUT_FORM, _QUESTION_BY_FORM = 0.5, 0.8, 0.3
_OWN_PHRASE_ASKED = 0.8
_FAMILIAR, _FOREIGN = 0.25, 0.05
_FRAGMENT, _SURE_OF_A_FRAGMENT = 4, 0.7
_KINDS: tuple[IntentKind, ...] = ("allocate", "question", "command", "clarify", "out_of_scope")
_WHAT_IF = "question.what_if"
_KIND_OF: dict[str, IntentKind] = {kind: kind for kind in _KINDS}
_ABOUT_THE_CELL = {
    "rate", "stream", "power", "battery", "efficiency", "performance", "domain", "direct", "fair", "fairly", "same",
    "worst", "command", "unsupported", "share",
}  # fmt: skip


_SMALL_WORDS = (
    "and now also with at least most for everyone everybody each every user users all per the a of in to make that it "
    "use please but then only just ok so we i want need needs gets get have has must should give no more than less up "
    "max min 个 每 人 用 户 大 家 至 少 最 多 不 超 过 功 率 速 现 在 再 改 为 给 要 和 都 的 了 吧 是 有 以 内 总 发 "
    "射 上 限 条 件"
)
_LIMITING = frozenset(_SMALL_WORDS.split())


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """The kind of a sentence and what it is about.

    Attributes:
        kind: the likeliest kind; "allocate" only where ``acts``.
        topic: of a question, a command or what to clarify; "" otherwise.
        objective: the likeliest objective, whatever the kind; its share is ``likeliest``.
        certainty: 0 to 1, of what was decided.
        acts: whether lexicon and model allow to act on the objective.
        objective_clear: whether the operator named an objective by its own phrase.
    """

    kind: IntentKind
    topic: str
    objective: str
    likeliest: float
    certainty: float
    acts: bool
    objective_clear: bool = False


@dataclass(frozen=True, kw_only=True)
class _Shares:
    """What the model says: by label, by kind, and the likeliest topic of each kind."""

    labels: Mapping[str, float]
    kinds: Mapping[IntentKind, float]
    topics: Mapping[IntentKind, str]
    familiar: bool


def judge(sentence: Sentence, registered: set[str]) -> Judgement:
    """What the sentence wants, among the registered objectives."""
    goal, shares = sentence.goal, _shares(sentence)
    objective = max(BUILT_IN, key=lambda name: shares.labels[name])
    if goal.objective in BUILT_IN and goal.verdict == "clear":
        near = 2 * shares.labels[goal.objective] >= shares.labels[objective]
        objective = goal.objective if near else objective
    share = shares.labels[objective]
    command = forms.plain_command(sentence.plain)
    if command:
        return Judgement(kind="command", topic=command, objective=objective, likeliest=share, certainty=1.0, acts=False)
    own_phrase = goal.verdict == "clear" and goal.objective not in BUILT_IN
    if own_phrase and shares.kinds["question"] + shares.kinds["command"] < _OWN_PHRASE_ASKED:
        return Judgement(
            kind="allocate", topic="", objective=goal.objective, likeliest=1.0, certainty=goal.confidence,
            acts=goal.objective in registered, objective_clear=True,
        )  # fmt: skip
    kind = _kind(sentence, shares, objective)
    acts = kind == "allocate"
    topic = "" if acts else shares.topics[kind]
    if topic == "what_if" and sentence.reading.steps and shares.labels["question.step"] > shares.labels[_WHAT_IF] / 2:
        topic = "step"
    agreed = goal.confidence if goal.verdict == "clear" and goal.objective == objective else 0.0
    sure = agreed or share
    if not acts:
        sure = max(shares.kinds[kind], 1.0 - shares.kinds["allocate"] if kind in ("question", "out_of_scope") else 0.0)
    return Judgement(
        kind=kind, topic=topic, objective=objective, likeliest=share,
        certainty=round(min(1.0, sure), 4), acts=acts,
    )  # fmt: skip


def _shares(sentence: Sentence) -> _Shares:
    text, concepts = sentence.for_model()
    model = shipped_model()
    labels = model.probabilities(text, concepts)
    kinds: dict[IntentKind, float] = dict.fromkeys(_KINDS, 0.0)
    best: dict[IntentKind, tuple[float, str]] = dict.fromkeys(_KINDS, (-1.0, ""))
    for label, share in labels.items():
        head, _, topic = label.partition(".")
        kind = _KIND_OF.get(head, "allocate")
        kinds[kind] += share
        best[kind] = max(best[kind], (share, topic))
    familiar = sentence.goal.verdict == "clear" or model.familiarity(text) >= _FAMILIAR
    return _Shares(
        labels=labels, kinds=kinds, topics={kind: topic for kind, (_, topic) in best.items()}, familiar=familiar
    )


def _kind(sentence: Sentence, shares: _Shares, objective: str) -> IntentKind:
    """The likeliest kind, by the model and by the sentence's form; "allocate" only where that may be acted on."""
    kinds, goal, plain = shares.kinds, sentence.goal, sentence.plain
    likeliest = max(_KINDS, key=lambda name: kinds[name])
    if likeliest == "command" and sentence.reading.back:
        likeliest = "clarify"  # "bring user 3 back" changes a request, it undoes none
    elif likeliest == "command" and kinds["command"] < _SURE_OF_NO_WISH:
        others: list[IntentKind] = [name for name in _KINDS if name != "command"]
        likeliest = max(others, key=lambda name: kinds[name])
    asked = forms.is_asked(plain) or (forms.begins_like_a_question(plain) and shares.labels[objective] < _AGAINST)
    if likeliest in ("allocate", "clarify") and asked:
        likeliest = "question"
    if likeliest == "clarify" and kinds["question"] >= _QUESTION_BY_FORM and forms.is_built_like_a_question(plain):
        likeliest = "question"
    if likeliest == "question":
        likeliest = _question(sentence, shares, objective)
    if likeliest != "out_of_scope" and forms.is_no_wish(sentence.text):
        return "clarify"
    if likeliest in ("allocate", "clarify"):
        if shares.familiar and shares.labels[objective] >= _needed(sentence, objective):
            return "allocate"
        foreign = kinds["out_of_scope"] > _FOREIGN and shares.labels[objective] < _ALONE
        return "out_of_scope" if foreign and _is_of_another_trade(sentence) else "clarify"
    sure_of_none = _SURE_BESIDE_A_WISH if likeliest == "out_of_scope" and goal.verdict == "clear" else _SURE_OF_NO_WISH
    unsure = kinds[likeliest] < sure_of_none and goal.verdict != "none" and not asked
    strange = not shares.familiar and kinds["out_of_scope"] < _ALONE
    return "clarify" if unsure or strange else likeliest


def _question(sentence: Sentence, shares: _Shares, objective: str) -> IntentKind:
    """What a likely question is after all: a request put politely, no question by its form, or nothing of ours."""
    goal, plain = sentence.goal, sentence.plain
    if goal.verdict == "clear" and goal.objective == objective and forms.is_polite(plain):
        return "allocate"
    if forms.asks_you(plain) and shares.topics["question"] == "other" and not sentence.reading.named:
        return "clarify"  # "could you change the settings a bit?"
    if shares.kinds["question"] < _SURE_WITHOUT_FORM and not forms.may_be_a_question(plain):
        return "clarify"
    foreign = shares.kinds["out_of_scope"] > _FOREIGN and not _is_of_the_cell(sentence, shares.topics["question"])
    return "out_of_scope" if foreign else "question"


def _says_more_than_limits(sentence: Sentence) -> bool:
    """Whether any word beside figures, users and the small words between them could be a wish."""
    words = {unit.word for unit in sentence.units if unit.word != MASK}
    return not sentence.reading.values or bool(words - _LIMITING)


def _is_of_the_cell(sentence: Sentence, topic: str) -> bool:
    """Whether a question speaks of anything that this program knows; other languages are taken at their word."""
    reading = sentence.reading
    known = sentence.concepts & _ABOUT_THE_CELL
    if known or reading.values or reading.named or reading.steps or sentence.quantities:
        return True
    if "off_topic" in sentence.concepts:
        return False
    return topic not in ("other", "concept") or sentence.language not in ("en", "zh") or len(sentence.units) < 4


def _is_of_another_trade(sentence: Sentence) -> bool:
    """Whether a longer sentence in Spanish, French or German has no word, figure or user of ours in it."""
    reading = sentence.reading
    ours = sentence.concepts or reading.values or reading.named or reading.doubts
    long = sentence.language in ("es", "fr", "de") and len(sentence.units) >= _FRAGMENT
    return long and not ours and not forms.speaks_of_the_trade(sentence.plain)


def _needed(sentence: Sentence, objective: str) -> float:
    """How likely the objective has to be for acting on it."""
    goal = sentence.goal
    if goal.verdict == "none" and forms.is_a_refusal(sentence.plain):
        return math.inf
    if goal.verdict == "clear":
        if goal.objective == objective:
            return 0.0 if forms.is_polite(sentence.plain) else _AGREED
        return _AGAINST_RATE if goal.objective == "max_rate" else _AGAINST  # every wish may speak of rates
    if goal.verdict == "weak" and len(sentence.units) < 2:
        return math.inf  # "speed" alone is no wish
    if goal.verdict == "none" and not _says_more_than_limits(sentence):
        return math.inf
    if goal.verdict in ("none", "weak") and len(sentence.units) < _FRAGMENT:
        return _SURE_OF_A_FRAGMENT
    if goal.verdict == "weak" and goal.objective == "max_rate" != objective:
        return _ALONE
    if goal.verdict == "opposite" and "less_efficiency" in goal.options and objective == "max_energy_efficiency":
        return math.inf
    if goal.verdict == "negated" and objective not in goal.options and len(sentence.units) > _FRAGMENT:
        return _SOMETHING_INSTEAD
    if goal.verdict == "contradiction" and goal.options == ("max_rate",) and objective != "max_rate":
        return _SURE_OF_A_FRAGMENT
    if goal.verdict == "opposite" and objective == "max_min_rate":
        return _FOR_THE_SLOWEST
    return _DOUBTED[goal.verdict]
