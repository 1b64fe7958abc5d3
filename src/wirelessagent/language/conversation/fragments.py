"""Lines that are a part of a sentence: "and 3 too", "make it 9", "the others 400k", "20 % more for user 4".

Such a line takes what it does not say from the last act of its conversation. Every word of it is a figure, a user, or
in a class of ``fragment_words/<language>.toml``; with one word that is not, it is no such line, and left to who reads
sentences. So nothing is done that a word of the line may not have meant. What kinds of lines there are stands in
:data:`_FORMS`: of each, the classes of which it has a word, and those of which it may have one beside.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from wirelessagent.language.acts import (
    Act,
    Aim,
    Drop,
    LeaveOut,
    Limit,
    Named,
    Scale,
    Serve,
    Undo,
)  # fmt: skip
from wirelessagent.language.conversation.corrections import denies, moved, swapped
from wirelessagent.language.conversation.figure_in_place import figures_of, read_figure
from wirelessagent.language.conversation.limits_off import dropped, restored
from wirelessagent.language.conversation.line import Line, is_all
from wirelessagent.language.conversation.relative import read_of_another, read_relative, read_repeated
from wirelessagent.language.conversation.tokens import (
    NOUNS,
    NUMBER,
    Token,
    Words,
    numbered,
    speaks_of_one,
    words_of,
)
from wirelessagent.language.conversation.who_is_served import all_served, left_out, of_whom, served
from wirelessagent.language.guard import tells_no_mere_fact
from wirelessagent.language.intent import Intent
from wirelessagent.language.judgement import judge
from wirelessagent.language.moods import is_ordered
from wirelessagent.language.text import normalise

_LONGEST = 120
_MOST_STEPS = 20
_STOP = re.compile(r"\s*(?:[,;.!:](?!\d)|(?<!\d),|[，；。！：])\s*")
_AND = re.compile(rf"{_STOP.pattern}|\s+(?=(?:and|but|und|aber|y|pero|et|mais)\s)|(?=但|而)")
_ENDS = " .!。！"


@dataclass(frozen=True)
class Form:
    """A kind of line.

    Attributes:
        needs: classes of which such a line has a word, or of one of several ("too|equal").
        may: classes of which it may have words beside these; "" for a form whose reader judges all words.
        read: what it means; None where it is no such line after all.
        asked: whether it may be a question.
    """

    needs: str
    may: str
    read: Callable[[Words], Intent | None]
    asked: bool = False

    def fits(self, words: Words) -> bool:
        needs = [need.split("|") for need in self.needs.split()]
        own = (each for need in needs for each in need)
        return all(words.has(*need) for need in needs) and (not needs or words.only(*own, *self.may.split()))


def read_fragment(line: Line) -> Intent | None:
    """What a line does that leans on the last act; None for any other line."""
    context = line.context
    whose = context.pending_users and context.pending_users != context.spoken_of  # "what of user 5?", "leave him out"
    whose = whose or (context.pending_users and not speaks_of_one(normalise(line.text)))
    open_ = context.pending or context.pending_objective or whose or context.offered or context.guess
    if context.objective is None or (context.awaits == "clarification" and open_) or len(line.text) > _LONGEST:
        return None
    found = (_read_told(story, rest) for story, rest in _told(_without_what_stays(line)))
    return next((intent for intent in found if intent is not None), None)


def _read(words: Words) -> Intent | None:
    """What the first form means that a line has and that means something."""
    forms = _FORMS
    if words.line.is_asked:
        forms = tuple(form for form in _FORMS if form.asked)
    elif words.is_unsure or denies(words.tokens) or words.denies_users:
        forms = _FORMS[:1]
    found = (form.read(words) for form in forms if form.fits(words))
    return next((intent for intent in found if intent is not None), None)


def _told(line: Line) -> Iterator[tuple[Line, Line]]:
    """What a line only tells, and what it says behind that: nothing and all of it, or its last clauses.

    A correction ahead is of what is said last: "sorry, I was half asleep, user 5".
    """
    yield Line.of("", line.context), line
    stops = [] if line.is_asked else list(_STOP.finditer(line.text.rstrip(_ENDS)))
    head = line.text[: stops[0].end()] if stops else ""
    heads = (words.only("correct", "lead") for words in words_of(Line.of(head, line.context)))
    head = head if any(heads) else ""
    for stop in stops:
        story = Line.of(line.text[len(head) : stop.start()], line.context)
        if stop.start() >= len(head) and (users := _only_told(story)) is not None:
            context = dataclasses.replace(line.context, spoken_of=users or line.context.spoken_of)
            yield dataclasses.replace(story, users=users), Line.of(head + line.text[stop.end() :], context)


def _only_told(story: Line) -> tuple[str, ...] | None:
    """The users of whom a clause only tells, and asks for nothing: "user 7 has paid"; None for any other clause."""
    context, counted, users = story.context, NUMBER.findall(story.text), story.users or numbered(story)
    does = any(_read(words) for words in words_of(story))
    if is_ordered(story.text) or does or tells_no_mere_fact(story.text):
        return None
    held = {figure for limit in context.constraints.values() for figure in figures_of(limit)}
    known = {f"{figure * scale:g}" for figure in held for scale in (1.0, 1e3, 1e-3, 1e-6)}
    new = {figure.value for figure in story.figures} - held or {*counted} - known - {*users, *context.spoken_of}
    judged = judge(story.sentence, {*story.voice.labels})
    aims = (judged.acts or judged.objective_clear) and not speaks_of_one(story.text, "too_much")
    return None if story.is_asked or new or aims else users


def _read_told(story: Line, rest: Line) -> Intent | None:
    """What a line does behind what it tells: "user 7 has paid, let him back in", "power's too high, halve it"."""
    each = _clause_by_clause(rest)
    if each is not None:
        return each
    for words in words_of(rest, lenient=not (story.text or rest.is_asked)):
        if story.text:
            words.is_told = True
            if words.has("it"):
                words.tokens += [Token(frozenset({noun, "skip"})) for noun in NOUNS if speaks_of_one(story.text, noun)]
            if story.users and words.spoken_of is None:
                likened = words.has("than", "equal", "too") and not words.figures
                if likened and (words.users or words.has("others")):  # "6 has paid, too, so like user 2"
                    words.tokens = [Token(frozenset({"users"}), users=story.users), *words.tokens]
                    words.users = (*story.users, *words.users)
                elif words.users or words.has("others", "every", "both", "power", "certainty"):
                    continue
                words.about = story.users
                if {figure.kind for figure in words.figures} == {"rate"}:
                    words.users = story.users
                elif not likened and not words.has("leave", "serve"):
                    continue
        intent = _read(words)
        if intent is not None and not (story.text and intent.kind == "clarify"):
            return intent
    return None


def _clause_by_clause(line: Line) -> Intent | None:
    """What a line does that says several things, each of its clauses one of them: "4 in, 1 out"."""
    clauses = [Line.of(each, line.context) for each in _AND.split(line.text.rstrip(_ENDS)) if each.strip()]
    acts = list[Act]()
    for clause in clauses if len(clauses) > 1 and not line.is_asked else ():
        context = dataclasses.replace(line.context, acts=tuple(acts) or line.context.acts)
        found = list[tuple[Words, Intent | None]]()
        for words in words_of(dataclasses.replace(clause, context=context)):
            whom = getattr(acts[-1], "whom", None) if acts else None
            words.about = whom.users if isinstance(whom, Named) else ()
            rates = bool(words.figures) and {figure.kind for figure in words.figures} == {"rate"}
            if rates and not words.users and not words.has("others", "every", "each"):
                words.users = words.about
            found.append((words, _read(words)))
        done = [each for words, each in found if each and each.acts and not words.has("correct", "instead")
                and not (words.figures and words.only("bare", "it", "whose"))]  # "le 1, un quart de moins"  # fmt: skip
        if not done:
            return None
        acts += done[0].acts
    return line.changed_by(acts) if acts else None


def read_wondered(line: Line) -> Intent | None:
    """The what-if of a change by what holds, of a line that asks whether it is possible; None for any other."""
    found = (read_relative(words, wonders=True) for words in words_of(line))
    return next((intent for intent in found if intent is not None), None)


def _without_what_stays(line: Line) -> Line:
    """The line without a last clause that only says what stays: "…, but keep the promise to user 3"."""
    stops = list(_AND.finditer(line.text.rstrip(_ENDS)))
    stays = stops and is_all("kept", Line.of(line.text[stops[-1].end() :], line.context).shape.rstrip(_ENDS))
    return Line.of(line.text[: stops[-1].start()], line.context) if stays else line


def _is_undo(words: Words, *further: str) -> bool:
    """Whether a line takes the last change back and says nothing else: "undo that", "undo the raise"."""
    changes = "make more less factor rate limit promise power weight" if words.has("make", "more", "less") else ""
    return words.has("undo") and words.only("undo", "it", *further, *changes.split())


def _steps_undone(words: Words) -> Intent | None:
    """ "undo the last two changes"; a bare command is a sentence of its own where recognisers read it."""
    counts = [figure.value for figure in words.figures] + [token.factor for token in words.tokens if token.factor]
    counts += [2.0] if words.has("both") else []
    if (words.is_read and not words.has("both")) or len(counts) != 1 or counts[0] not in range(1, _MOST_STEPS):
        return None
    return words.line.command("undo", steps=float(counts[0]))


def _undone(words: Words) -> Intent | None:
    """ "nah, undo that", "undo the raise"."""
    further = ("correct", "lead", "again", "too", "remove", *(NOUNS if words.has("remove") else ()))
    says_more = words.is_told or words.has("make", "more", "less", "correct", "too") or not words.is_read
    return words.line.command("undo", steps=1.0) if says_more and _is_undo(words, *further) else None


def _again(words: Words) -> Intent | None:
    """ "once more" behind an undo."""
    return words.line.command("undo", steps=1.0) if words.last(Undo) else None


def taken_up(words: Words) -> Intent | None:
    """ "do that" behind a what-if: what was supposed is asked for."""
    context = words.line.context
    if context.supposed_objective is None:
        return None
    return words.line.allocate(context.supposed_objective, context.supposed, amends=False)


def _as_it_was(words: Words) -> Intent | None:
    """ "back to how it was before the power limit": to the turn before the last one that set or dropped it."""
    before, after = words.has("before"), words.has("after")
    kinds, earlier = words.named_kinds(), list(enumerate(words.line.context.earlier, start=1))
    if words.has("first") and not before and not kinds and not words.users:
        turns = [turn for turn, acts in earlier if any(isinstance(act, Aim | Limit | LeaveOut | Serve) for act in acts)]
        return words.line.command("undo", turn=float(turns[0])) if turns else None
    if before is after or not (kinds or words.users):
        return None
    turns = [turn for turn, acts in earlier if any(_is_about(act, kinds, words.users) for act in acts)]
    turn = turns[-1] - before if turns else 0
    return words.line.command("undo", turn=float(turn)) if turn > 0 else None


def _is_about(act: Act, kinds: Sequence[str], users: Sequence[str]) -> bool:
    """Whether an act changes one of these limits, or something of these users."""
    if kinds and not (isinstance(act, Limit | Scale | Drop) and act.kind in kinds):
        return False
    whom = getattr(act, "whom", None)
    return not users or (isinstance(whom, Named) and set(users) <= set(whom.users))


def _weighed_equally(words: Words) -> Intent | None:
    """ "all weights equal"."""
    return words.acts([Drop(kind="weights")]) if "weights" in words.held else None


def _same_of_others(words: Words) -> Intent | None:
    """ "and 3 too": users of whom the same is said as of the last ones."""
    users, stated = of_whom(words), {act.kind for act in words.last(Limit)}
    nouns = ("promise", "rate") if stated & {*words.named_kinds()} else ()
    if not users or not words.only("too", "lead", "it", "correct", *nouns, *_OF_USERS.split()):
        return None
    listed = bool(words.last(LeaveOut, Serve)) and not words.has("correct")  # whom a number names, then
    if not words.has("too", "whose") and not words.users and not listed:
        return None
    again = [dataclasses.replace(act, whom=Named(users)) for act in words.last(Limit, Drop, LeaveOut, Scale, Serve)
             if isinstance(act.whom, Named) and not (isinstance(act, Drop) and act.kind in stated)]  # fmt: skip
    again = [dataclasses.replace(act, alone=False) if isinstance(act, Serve) else act for act in again]
    return words.acts(again) if len(set(again)) == 1 else None


def _asks_what_changes(words: Words) -> Intent:
    """ "limit the power", without the figure."""
    return words.line.ask("what_changes")


def _corrected(words: Words) -> Intent | None:
    """ "No, a third", where no share was said before."""
    return None if "outage_probability" in words.line.context.stated else words.line.ask("what_changes")


_MOVED = "users bare lead it revise whose"
_ANOTHER = "users bare lead weight rate promise again others every make it"
_OF_USERS = "users bare lead again pronoun one"
_GONE = "it equal users bare every others both pronoun one own again lead correct more by"
_NOUNS = " ".join(NOUNS)
_FORMS = (
    Form("correct", f"{_MOVED} leave remove serve at_most factor weight figure make rate promise too", moved),
    Form("undo", "bare factor change_noun lead again both it", _steps_undone),
    Form("undo", "correct it lead again make more less factor rate limit promise power weight too remove", _undone),
    Form(
        "too|equal|factor|ratio|than",
        f"{_ANOTHER} more less both pronoun one than grant possessed limit",
        read_of_another,
    ),
    Form("swap", f"{_ANOTHER} correct both pronoun take own", swapped),
    Form("again", "lead too it", _again),
    Form("again", "lead it take", read_repeated),
    Form("take", "it", taken_up),
    Form("as_it_was", f"before after users lead correct make undo told leave first {_NOUNS}", _as_it_was),
    Form("equal weight", "every make again lead", _weighed_equally),
    Form("remove|too|lead", f"{_GONE} take {_NOUNS} figure", dropped),
    Form("restore", f"it correct lead take make again {_NOUNS}", restored),
    Form("every serve", "again lead take make correct bare it", all_served),
    Form("others serve", "again lead too make bare", all_served),
    Form("serve", f"too take make it correct {_OF_USERS}", served),
    Form("leave", f"too take make correct {_OF_USERS}", left_out),
    Form("too|lead", f"it correct promise rate {_OF_USERS}", _same_of_others),
    Form("", "", read_relative, asked=True),
    Form("limit power", "make", _asks_what_changes, asked=True),
    Form(f"vague more|less {_NOUNS.replace(' ', '|')}", "make lead it correct take users every", _asks_what_changes),
    Form("", "", read_figure, asked=True),
    Form("correct ratio|factor", "lead by to less more", _corrected),
)
"""The kinds of lines, the closest first; a line that denies what it says may only be of the first."""
