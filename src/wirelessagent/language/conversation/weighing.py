"""What a line of a talk means: what its reader hears, or what the model of talks finds likelier.

What is likely enough is done, or worked out as a what-if; what is only likeliest is asked about. The model is
log-linear: it weighs no change at all, each change (:mod:`.changes`), and those that go together, by their signs
(:mod:`.signs`); trained by :mod:`wirelessagent.language.training.talks`.
"""

from __future__ import annotations

import dataclasses
import functools
import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from wirelessagent.language.acts import Act, Aim, Drop, LeaveOut, Limit, Named, Scale, Serve, Suppose, Undo
from wirelessagent.language.comparators import speaks_of
from wirelessagent.language.conversation.anchors import Anchor, Anchored
from wirelessagent.language.conversation.answers import speaks_of_applying
from wirelessagent.language.conversation.line import NAME, Line, is_all
from wirelessagent.language.conversation.possible import OUT, Change, Effect, Possible, users_of
from wirelessagent.language.conversation.signs import Read, Signs, block_places, place_of
from wirelessagent.language.guard import asking_whether, guarded, stranger
from wirelessagent.language.intent import Intent
from wirelessagent.language.moods import (
    asks_without_a_mark,
    classes_in,
    is_denied,
    is_supposed,
    lifted_in,
    may_be_lifted,
    named_in,
)
from wirelessagent.language.offline import NAME as OFFLINE
from wirelessagent.language.request import changed, constraints_of
from wirelessagent.language.sentence import BUILT_IN
from wirelessagent.language.text import Phrases, Span, overlaps
from wirelessagent.language.word_tables import any_word, either

TALKS_FILE = Path(__file__).parent.parent / "talks.npz"
BLOCK, OWN = 1.0, 0.25
"""What a sign counts: one of all the words beside what is done (over the root of how many they are), and one alone."""

_IN_PAIRS, _IN_THREES = 10, 6

Said: TypeAlias = tuple[bool, Effect]
"""Whether something is only supposed, and what it comes to."""
NOTHING: Said = (False, frozenset())


@dataclass(frozen=True, kw_only=True)
class Meaning:
    """What a line may mean: no change, one, or several together, as places among those that are possible.

    Such changes may be ``supposed``; the last place says so.
    """

    places: tuple[int, ...]
    effect: Effect
    supposed: bool = False

    @property
    def said(self) -> Said:
        return self.supposed, self.effect


@dataclass(frozen=True, kw_only=True)
class TalkModel:
    """Weights of signs, as int8 with their ``scale``, and of what changes are together."""

    weights: npt.NDArray[np.int8]
    scale: float
    together: npt.NDArray[np.float32]

    @classmethod
    def load(cls, path: Path) -> TalkModel:
        with np.load(path) as arrays:
            return cls(weights=arrays["weights"], scale=float(arrays["scale"]), together=arrays["together"])

    def save(self, path: Path) -> None:
        np.savez_compressed(path, weights=self.weights, scale=self.scale, together=self.together)

    def scores(self, signs: Signs, changes: Sequence[Change]) -> npt.NDArray[np.float64]:
        """How strongly the signs speak for each change."""
        blocks: dict[str, float] = {}
        found = np.zeros(len(changes))
        for place, change in enumerate(changes):
            for name, words in signs.blocks(change):
                if name not in blocks:
                    total = self.weights[block_places(name, words)].sum(dtype=np.int64)
                    blocks[name] = BLOCK * float(total) / max(len(words), 1) ** 0.5
                found[place] += blocks[name]
            own = [place_of(sign) for sign in signs.own(change)]
            found[place] += OWN * float(self.weights[own].sum(dtype=np.int64))
        return found * self.scale


@dataclass(frozen=True, kw_only=True)
class Weighed:
    """What a line means likeliest.

    Attributes:
        acts: what it does or supposes; nothing where it changes nothing.
        said: what that comes to.
        shares: how likely each is.
        used: the figures and users of the line that it is about.
    """

    acts: tuple[Act, ...]
    said: Said
    shares: dict[Said, float]
    used: frozenset[Anchor]

    @property
    def share(self) -> float:
        """How likely it is."""
        return self.shares[self.said]


def meanings(
    changes: Sequence[Change], scores: Sequence[float] | npt.NDArray[np.float32] | npt.NDArray[np.float64]
) -> list[Meaning]:
    """No change, each one, those that score best together, and all this as suppositions, which the last one marks."""
    mark = len(changes) - 1
    found = [Meaning(places=(place,), effect=changes[place].effect) for place in range(mark)]
    best = dict[Effect, int]()
    for place in sorted(range(mark), key=lambda place: -scores[place]):
        if changes[place].effect and not any(isinstance(act, Undo) for act in changes[place].acts):
            best.setdefault(changes[place].effect, place)
    likely = list(best.values())[:_IN_PAIRS]
    pairs = {pair for pair in itertools.combinations(likely, 2) if _go_together(changes[pair[0]], changes[pair[1]])}
    threes = [three for three in itertools.combinations(likely[:_IN_THREES], 3)
              if {*itertools.combinations(three, 2)} <= pairs]  # fmt: skip
    for places in (*sorted(pairs), *threes):
        effect = frozenset(item for place in places for item in changes[place].effect)
        found.append(Meaning(places=places, effect=effect))
    supposed = [Meaning(places=(*each.places, mark), effect=each.effect, supposed=True) for each in found
                if not any(isinstance(act, Undo) for place in each.places for act in changes[place].acts)]  # fmt: skip
    return [Meaning(places=(), effect=frozenset()), *found, *supposed]


def _go_together(one: Change, other: Change) -> bool:
    """Whether two changes are of different figures, and of different things that hold."""
    apart = not {key for key, _ in one.effect} & {key for key, _ in other.effect}
    return apart and (one.figure is None or one.figure is not other.figure)


def weigh(signs: Signs, model: TalkModel | None = None) -> Weighed:
    """What a line means likeliest, by the model of this release or another one."""
    model, changes = model or shipped_talk_model(), signs.changes()
    scores, together = model.scores(signs, changes), signs.together
    lifted = lifted_in(signs.anchored.plain)
    lifts = [{act.kind for act in change.acts if isinstance(act, Drop)} for change in changes]
    found = [
        (each, [changes[place] for place in each.places])
        for each in meanings(changes, scores)
        if not lifted or all(may_be_lifted(kind, lifted) for place in each.places for kind in lifts[place])
    ]
    total = np.array([
        sum(scores[place] for place in each.places) + model.together[together.signs(parts, each.effect)].sum()
        for each, parts in found
    ])  # fmt: skip
    likely = np.exp(total - total.max())
    likely /= likely.sum()
    shares = dict[Said, float]()
    for (each, _), share in zip(found, likely.tolist(), strict=True):
        shares[each.said] = shares.get(each.said, 0.0) + share
    said = max(shares, key=lambda each: shares[each])
    ways = [(parts, share) for (each, parts), share in zip(found, likely, strict=True) if said[1] and each.said == said]
    plainest = sorted(ways, key=lambda way: signs.plainness(*way), reverse=True)
    in_order = (signs.in_order(parts) for parts, _ in plainest)
    parts = next((way for way in in_order if way is not None), None) if said[1] else []
    if parts is None:  # one undoes what the other does
        said, parts = NOTHING, list[Change]()
    acts = tuple(act for change in parts for act in change.acts)
    used = set[Anchor | None]()
    for change in parts:  # all that the line names, where it is what its readers make of the whole line
        whole = change.form in ("read", "guessed")
        used.update(signs.anchored.anchors if whole else (change.figure, change.model, *change.users))
    return Weighed(acts=acts, said=said, shares=shares, used=frozenset(each for each in used if each is not None))


@functools.cache
def shipped_talk_model() -> TalkModel:
    """The model of this release."""
    return TalkModel.load(TALKS_FILE)


SURE, SURER, SUREST, AGREED, LIKELY = 0.6, 0.9, 0.97, 0.5, 0.3
"""From where on a line does what it likeliest means, from where on if that is another aim or hardly an order, from
where on what asks for a meaning supposes something, from where on if its reader hears it too and nothing is taken from
anybody, and from where on it is asked whether it does."""

HEARD, NAMED = 0.06, 0.1
"""How likely what a line's reader hears has to be to be asked about, and, a request with its aim, to be done."""
UNLIKELY = 0.25
"""How likely a frame is one of an order, below which a line has to be surer."""
FRAMED, ORDERED = 6, 0.7
"""From how many words on a line has a frame that is judged like that of a sentence, and how likely an order that line
has to be whose meaning is as sure as can be."""

_DENYING, _WITH_UNITS = ("negation", "refusal"), ("rate", "power", "ratio", "factor")
_LEAVING = Phrases(f"{either('figures', 'users', 'leaving')}|{either('figures', 'users', 'free')}")
_NEITHER = Phrases(either("figures", "users", "neither"))
_LIFTING = Phrases(any_word("figures", "lifted", "go", "gone", "alone").replace("*", r"\w*").lower())
_CERTAIN = frozenset({"impossible", "not_understood", "another_figure", "one_of", "some_users", "power_per_user"})
"""What a reader asks about figures and users by their words, whatever the talk is about."""
_DENIED = frozenset({"negated", "refused"})
"""What a reader asks about who hears that something is not to be."""


def weighed(line: Line, intent: Intent) -> tuple[Intent, bool]:
    """What a line means behind a request, by its reader and by the weights, and whether it surely does.

    What nobody is sure of is asked about, with the likeliest meaning for a plain yes.
    """
    context = line.context
    if context.objective is None or _stands(line, intent):
        return intent, False
    possible = Possible(line.anchored, context)
    read = Read.of(intent, possible)
    later = read.acts and not read.effect and changed(possible.figures, read.acts) != possible.figures
    found = weigh(Signs(line, possible, read, line.voice.language))
    if later:  # it shows only where somebody is served, such as a promise to a user who is left out
        acts = () if read.supposes or line.is_asked else _serving(possible, read, found)
        return (intent_of(line, possible, acts), True) if acts else (intent, False)
    heard: Said = (read.supposes and bool(read.effect), read.effect or frozenset())
    if any(isinstance(getattr(act, "whom", None), Named) for act in found.acts) and stranger(line.text, context):
        return intent, False  # who is that?
    share, acts = found.shares.get(heard, 0.0), bool(read.effect) and not read.supposes
    request = intent.guess or intent
    names_its_aim = request.kind == "allocate" and "objective" in request.evidence
    if not found.acts and names_its_aim and acts and share >= NAMED:
        return intent, False
    denials = _denials(line, read_so=found.said == heard)
    denied = _denies(possible.line, found, denials)
    keeps = _keeps(line, read, found, denied=denied)
    if not found.acts or keeps or _uses_what_is_denied(possible.line, found, denials):
        doubted = asking_whether(intent, line.voice) if share > HEARD else line.answer.ask("what_changes", 1.0)
        return (doubted if acts else intent), False
    either = sum(found.shares.get((supposed, found.said[1]), 0.0) for supposed in (False, True))
    if found.said[0] or (line.is_asked and found.share < SURE < either):  # nothing is done
        asked = not intent.details if intent.kind == "question" else line.is_asked
        sure = either > (SUREST if intent.topic == "concept" else LIKELY if asked else SURE)
        supposed = dataclasses.replace(line.answer.question("what_if"), acts=(Suppose(acts=found.acts),))
        return (supposed if sure else intent), sure
    unsaid, less = not acts and _takes_unsaid(line, found), acts and _is_less(possible.line, read, found)
    forgets = _may_be_of_another(possible) or _forgets_the_others(possible.line, found)
    if (unsaid and intent.kind == "clarify") or (less and not forgets and _names_what_goes(possible.line, read)):
        return intent, False
    if unsaid or less or forgets:
        return asking_whether(intent_of(line, possible, found.acts), line.voice), False
    takes = _takes_away(read.acts)
    undoes = intent.kind == "command" and found.said == heard
    if share >= (NAMED if names_its_aim or undoes else SURER if denied else SURE if takes else AGREED):
        return intent, found.said == heard and share >= SURE
    meant = intent_of(line, possible, found.acts)
    aims = any(isinstance(act, Aim) and act.objective != context.objective for act in found.acts)
    short = len(possible.line.words) < FRAMED
    negated = intent.asks in _DENIED and bool(denials)
    answers = intent.kind == "clarify" and context.awaits == "clarification"  # or turns to something else
    hardly = aims or line.sentence.chances.order < UNLIKELY or negated or denied or answers
    # whether another aim is ordered, the guard knows better
    doubts = aims and intent.guess is not None and not line.sentence.chances.is_order
    if found.share >= (SURER if hardly else SURE) and not doubts:
        surely = found.share >= SURER and line.sentence.chances.orders(ORDERED)
        judged = dataclasses.replace(meant, recogniser=OFFLINE)
        done = meant if short or surely else guarded(line.text, context, judged)
        return done, done.kind != "clarify"
    only_if = is_supposed(possible.line.plain) and not line.sentence.chances.is_order
    unsure = bool(read.effect) or (intent.kind == "clarify" and found.share > LIKELY and not (negated or only_if))
    return (asking_whether(meant, line.voice) if unsure else intent), False


def _serving(possible: Possible, read: Read, found: Weighed) -> tuple[Act, ...]:
    """What a line's reader hears of users who are not served, if it likely serves them, too: "add 4, with weight 2"."""
    users = tuple(user for user in users_of(read.acts) if user in possible.out)
    back = {((OUT, user), None) for user in users}
    share = sum(share for (supposed, effect), share in found.shares.items() if back <= effect and not supposed)
    return (Serve(whom=Named(users)), *read.acts) if users and share >= SURE else ()


def _may_be_of_another(possible: Possible) -> bool:
    """Whether a line scales what it does not name, behind one that said several: "double it"."""
    line, said = possible.line, {limit.kind for limit in possible.last} & {*possible.held}
    scales = bool(line.figures) and all(figure.kind == "factor" for figure in line.figures)
    names = any(anchor.kind in ("users", "others", "everybody") for anchor in line.anchors)
    return scales and len(said) > 1 and not (names or speaks_of(line.plain) or named_in(line.plain))


def _forgets_the_others(line: Anchored, found: Weighed) -> bool:
    """Whether a line names the others, and a figure that it is taken for is none of theirs: "plus 1 W for the rest"."""
    others = {anchor for anchor in line.anchors if anchor.kind == "others"}
    return bool(others) and others.isdisjoint(found.used) and any(isinstance(act, Limit | Scale) for act in found.acts)


def _takes_unsaid(line: Line, found: Weighed) -> bool:
    """Whether a line is taken for one that only takes from users whom it names, with no word that says so.

    "User 3 may have more" drops no floor; behind a line that took something, "and user 1" does.
    """
    plain, named = line.sentence.plain, {user for anchor in line.anchored.anchors for user in anchor.whom}
    said = _takes_away(line.context.acts) or _LEAVING.search(plain) or _LIFTING.search(plain)
    taken = [
        (kind == OUT) == bool(value) and user in named and kind != "weights" for (kind, user), value in found.said[1]
    ]
    return not said and all(taken)


def _is_less(line: Anchored, read: Read, found: Weighed) -> bool:
    """Whether a line is taken for a part of what its reader hears, and somebody or a limit that it names forgotten."""
    named, lifted = {anchor for anchor in line.anchors if anchor.kind == "users"}, lifted_in(line.plain)
    gone, said = ({act.kind for act in acts if isinstance(act, Drop)} for acts in (read.acts, found.acts))
    return found.said[1] < (read.effect or frozenset()) and not (named <= found.used and gone & {*lifted} <= said)


def _names_what_goes(line: Anchored, read: Read) -> bool:
    """Whether a line names each limit that its reader hears it drop."""
    return {act.kind for act in read.acts if isinstance(act, Drop)} <= {*lifted_in(line.plain)}


def _takes_away(acts: Iterable[Act]) -> bool:
    """Whether acts take a limit, a promise or service from somebody, or the last change back."""
    return any(isinstance(act, Drop | LeaveOut | Undo) for act in acts)


def _keeps(line: Line, read: Read, found: Weighed, *, denied: bool) -> bool:
    """Whether a line that is taken for one that takes something away says that it stays.

    "User 2's minimum stays", "don't drop it", "don't cut user 5 off".
    """
    instead = any(isinstance(act, Serve) for act in found.acts)  # "not user 2 but user 3"
    loses_service = any(isinstance(act, LeaveOut) for act in found.acts) and not instead
    loses_service &= not read.effect or not line.sentence.chances.is_order  # "don't serve user 5" is clear
    promised = any(isinstance(act, Limit) and act.kind == "min_rate_bps" for act in found.acts)
    if promised and not read.effect and _NEITHER.search(line.anchored.plain):  # "user 3 neither"
        return True
    stays = is_all("kept", line.said) or is_denied(line.sentence.plain) or (denied and loses_service)
    return bool(stays) and _takes_away(found.acts)


def _denies(anchored: Anchored, found: Weighed, denials: Sequence[Span]) -> bool:
    """Whether a line says "not" of all that it names, or a figure that nothing is done with.

    "Don't halve it", "lift it by 2 W" as no limit at all.
    """
    spaced = [start > 0 or anchored.plain[end : end + 1].isspace() for start, end in denials]  # no "no, 8"
    bounds = any(anchor.is_bounded for anchor in anchored.anchors)  # "never more than 5 W"
    named = {anchor for anchor in anchored.anchors if anchor.kind != "pronoun"}
    corrects = bounds or not named <= found.used  # "not 7, 8"
    figures = {anchor for anchor in named if anchor.kind in _WITH_UNITS}
    idle = not figures <= found.used
    return idle or (any(spaced) and not corrects)


def _uses_what_is_denied(anchored: Anchored, found: Weighed, denials: Sequence[Span]) -> bool:
    """Whether a figure is used right behind a word that denies it: "never 5 W"."""
    figures = [anchor for anchor in found.used if anchor.kind in _WITH_UNITS]
    return any(anchored.plain[end : figure.start].isspace() for _, end in denials for figure in figures)


def _denials(line: Line, *, read_so: bool) -> list[Span]:
    """Where a line denies something.

    Where it means what was read of it, a word that is a part of what it orders denies nothing: "without user 5".
    """
    masked = line.sentence.reading.masked if read_so else ()
    denied = (span for name, span in classes_in(line.anchored.plain) if name.partition(":")[0] in _DENYING)
    return [span for span in denied if not overlaps(span, masked)]


def _stands(line: Line, intent: Intent) -> bool:
    """Whether what is read of a line is not weighed.

    That is a line of closed words, a command, what names a method, a question of a certain thing, what a language model
    read, an answer to a question that holds something, a figure that can't be or that no limit holds or that its
    reader doubts beside an aim, and words on applying a plan that waits ("apply it at 6 pm").
    """
    context, another = line.context, intent.recogniser not in (OFFLINE, NAME)
    about_the_plan = context.awaits == "confirmation" and speaks_of_applying(line.text)
    if another or about_the_plan or "method" in intent.details:
        return True
    if intent.kind == "question":
        missing = "missing_share" in intent.details and not speaks_of(line.sentence.plain)
        certain = missing or intent.topic not in ("other", "what_if", "concept", "capabilities")
        certain &= (
            intent.topic != "step" or line.is_asked or asks_without_a_mark(line.sentence.plain)
        )  # "one watt more"
        return intent.recogniser == NAME or certain
    if intent.kind == "clarify":
        question = context.question
        answers = context.awaits == "clarification" and question.guess is None
        answers &= bool(question.pending or (question.users and not line.figures))
        aims = max(line.sentence.chances.kinds[aim] for aim in BUILT_IN) > AGREED
        of_its_own = aims and bool(line.figures) and intent.asks not in ("", "change")  # "lower the power by 5 W"
        certain = intent.asks in _CERTAIN or of_its_own
        return answers or (certain and not _is_taken_off(line))
    answers_nothing = intent.topic in ("confirm", "reject") and context.awaits == "nothing"
    commands = intent.kind == "command" and intent.topic != "undo" and not answers_nothing and intent.confidence > SURE
    return intent.recogniser == NAME or commands


def _is_taken_off(line: Line) -> bool:
    """Whether a figure is to go from what holds: "power minus 4 W", but not "at most -4 W" or "up by minus 4 W"."""
    below = [figure for figure in line.sentence.quantities if figure.value < 0]
    bare = all(figure.comparator is None and not figure.text.startswith("-") for figure in below)
    return bool(below) and bare and "up" not in line.sentence.concepts


def intent_of(line: Line, possible: Possible, acts: tuple[Act, ...]) -> Intent:
    """The intent of what is meant, with what it changes in words."""
    if len(acts) == 1 and isinstance(acts[0], Undo):
        return line.answer.command("undo", steps=float(acts[0].steps or 1))
    before, after = possible.figures, changed(possible.figures, acts)
    kinds = {kind for kind, _ in after}
    stated = constraints_of({key: figure for key, figure in after.items() if before.get(key) != figure})
    gone = dict.fromkeys(kind for kind, _ in before if kind not in kinds)
    lost = constraints_of({key: figure for key, figure in before.items() if key not in after and key[0] in kinds})
    aims = [act.objective for act in acts if isinstance(act, Aim)]
    said = constraints_of(changed({}, [act for act in acts if isinstance(act, Limit | LeaveOut)]))
    dropped = tuple(act.kind for act in acts if isinstance(act, Drop))
    reply = line.voice.changed([line.voice.label(aim) for aim in aims], stated, tuple(gone), lost)
    aim = aims[-1] if aims else str(possible.context.objective)
    return line.allocate(aim, said, amends=True, reply=reply, dropped=dropped, acts=acts)
