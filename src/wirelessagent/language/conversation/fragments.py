"""Lines that are a part of a sentence: "and 3 too", "make it 9", "the others 400k", "20 % more for user 4".

Such a line takes what it does not say from the last act of its conversation. Every word of it is a figure, a user, or
in a class of ``fragment_words/<language>.toml``; with one word that is not, it is no such line, and left to who reads
sentences. So nothing is done that a word of the line may not have meant. What kinds of lines there are stands in
:data:`_FORMS`: of each, the classes of which it has a word, and those of which it may have one beside.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Mapping, Sequence
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
from wirelessagent.language.conversation.corrections import denies, moved
from wirelessagent.language.conversation.figure_in_place import figures_of, read_figure
from wirelessagent.language.conversation.limits_off import dropped, restored
from wirelessagent.language.conversation.line import Line, begins, is_all
from wirelessagent.language.conversation.relative import read_relative, read_repeated
from wirelessagent.language.conversation.tokens import NOUNS, Words, speaks_of_one, tokens_of, words_of
from wirelessagent.language.conversation.who_is_served import all_served, both_served, left_out, of_whom, served
from wirelessagent.language.guard import tells_no_mere_fact
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, Intent
from wirelessagent.language.moods import is_ordered
from wirelessagent.language.text import languages_of, normalise

_LONGEST = 120
_SHORT = 40
_MOST_STEPS = 20
_FIRST_NUMBER = re.compile(r"\s*(\d{1,3})\s+(?=[^\W\d_]{2,}\s)")
_NUMBER = re.compile(r"(?<![A-Za-z\d.])\d++(?:\.\d+)?+(?![A-Za-z])")  # "7", and no "4K"
_BUT = re.compile(r"(?:\s(?=(?:but|and)\s)|(?=但|而))(.+)$")
_LAST_CLAUSE = re.compile(r"(?:[,;.!](?!\d)|[，；。！])\s*((?:[^,，;；.。!！]|[,.](?=\d))+)[.。!！\s]*$")


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
    if _takes_back(line):
        return line.command("undo", steps=1.0)
    line = _without_a_description(_without_what_stays(line))
    order = _order_about_one(line)
    found = [_read(words) for words in words_of(line)]
    if order is not None:
        found += [_read(words) for words in words_of(order) if words.spoken_of is not None]
    figure = _behind_a_story(line)
    if figure is not None:
        found += [read_figure(words) or read_relative(words) for words in words_of(figure)]
    return next((intent for intent in found if intent is not None), None)


def _read(words: Words) -> Intent | None:
    """What the first form means that a line has and that means something."""
    forms = _FORMS
    if words.line.is_asked:
        forms = tuple(form for form in _FORMS if form.asked)
    elif denies(words.tokens) or words.denies_users:
        forms = _FORMS[:1]
    found = (form.read(words) for form in forms if form.fits(words))
    return next((intent for intent in found if intent is not None), None)


def read_wondered(line: Line) -> Intent | None:
    """The what-if of a change by what holds, of a line that asks whether it is possible; None for any other."""
    found = (read_relative(words, wonders=True) for words in words_of(line))
    return next((intent for intent in found if intent is not None), None)


def _order_about_one(line: Line) -> Line | None:
    """What is ordered of one user behind a clause that only tells of that user: "user 7 has paid, let him back in"."""
    clause = _LAST_CLAUSE.search(line.text)
    if clause is None or line.is_asked:
        return None
    story = Line.of(line.text[: clause.start()], line.context)
    first = _FIRST_NUMBER.match(story.text)
    numbered = first is not None and int(first[1]) in range(1, len(line.context.user_names) + 1)
    users = story.users or ((first[1],) if first is not None and numbered else ())
    acts = story.figures or is_ordered(story.text) or any(True for _ in words_of(story))
    if len(users) != 1 or acts or story.is_asked or tells_no_mere_fact(story.text):
        return None
    return Line.of(clause[1], dataclasses.replace(line.context, spoken_of=users))


def _behind_a_story(line: Line) -> Line | None:
    """What is said last behind a clause that only tells of nobody, or of what holds: "ouch. 95 will do"."""
    clause = _LAST_CLAUSE.search(line.text)
    if clause is None or line.is_asked:
        return None
    story = Line.of(line.text[: clause.start()], line.context)
    held = {figure for limit in line.context.constraints.values() for figure in figures_of(limit)}
    known = {f"{figure * scale:g}" for figure in held for scale in (1.0, 1e3, 1e-3, 1e-6)}
    new = {figure.value for figure in story.figures} - held or set(_NUMBER.findall(story.text)) - known
    acts = is_ordered(story.text) or any(True for _ in words_of(story))
    if story.users or acts or new or story.is_asked or tells_no_mere_fact(story.text):
        return None
    return None if story.sentence.goal.objective else Line.of(clause[1], line.context)


def _without_what_stays(line: Line) -> Line:
    """The line without a last clause that only says what stays: "…, but keep the promise to user 3"."""
    clause = _LAST_CLAUSE.search(line.text) or _BUT.search(line.text)
    stays = clause is not None and is_all("kept", Line.of(clause[1], line.context).shape.rstrip(".!。 "))
    return Line.of(line.text[: clause.start()], line.context) if clause is not None and stays else line


def _without_a_description(line: Line) -> Line:
    """The line without what it says about its user beside what it wants: "oops, the hospital is user 8, not 3"."""
    match = begins("described", line.shape)
    if match is None or not line.users:
        return line
    words = match["words"]
    place = line.text.lower().find(words)
    return line if place < 0 else Line.of(line.text[:place] + line.text[place + len(words) :], line.context)


def _takes_back(line: Line) -> bool:
    """Whether the last clause of a short line is an undo and nothing else: "call's over, undo that"."""
    clause = _LAST_CLAUSE.search(line.text)
    if clause is None or len(line.text) > _SHORT or line.is_asked:
        return False
    last = Line.of(clause[1], line.context)
    read = ((tokens_of(last, language), language) for language in languages_of(line.text))
    return any(_is_undo(Words(last, tokens, language), "again") for tokens, language in read if tokens)


def _is_undo(words: Words, *further: str) -> bool:
    """Whether a line takes the last change back and says nothing else: "undo that", "undo the raise"."""
    changes = "make more less factor rate limit promise power weight" if words.has("make", "more", "less") else ""
    return words.has("undo") and words.only("undo", "it", *further, *changes.split())


def _steps_undone(words: Words) -> Intent | None:
    """ "undo the last two changes"; a bare command is a sentence of its own where recognisers read it."""
    counts = [figure.value for figure in words.figures] + [token.factor for token in words.tokens if token.factor]
    if words.is_read or len(counts) != 1 or counts[0] not in range(1, _MOST_STEPS):
        return None
    return words.line.command("undo", steps=float(counts[0]))


def _undone(words: Words) -> Intent | None:
    """ "nah, undo that", "undo the raise"."""
    further = ("correct", "lead", "again", "too", "remove", *(NOUNS if words.has("remove") else ()))
    says_more = words.has("make", "more", "less", "correct", "too") or not words.is_read  # else a command is known
    return words.line.command("undo", steps=1.0) if says_more and _is_undo(words, *further) else None


def _as_another(words: Words) -> Intent | None:
    """ "user 8 the same as user 3", "user 5 like the others": the one figure of a user, or that of all, for another."""
    if words.has("others", "every"):
        own = [kind for kind in FIGURES_OF_USERS if words.users and isinstance(held := words.held.get(kind), Mapping)
               and EVERYBODY in held and set(words.users) <= held.keys()]  # fmt: skip
        return words.acts([Drop(kind=kind, whom=Named(words.users), own=True) for kind in own]) if own else None
    named = [token.users for token in words.tokens if token.users]
    named += [words.counted()] if len(named) == 1 and words.counted() else []
    if len(named) == 1 and len(named[0]) == 2:  # "用户5和用户2一样", one list of two
        named = [(user,) for user in named[0]]
    if len(named) != 2 or len(named[1]) != 1:
        return None
    figures = [(kind, value[named[1][0]]) for kind in FIGURES_OF_USERS
               if isinstance(value := words.held.get(kind), Mapping) and named[1][0] in value]  # fmt: skip
    acts = [Limit(kind=kind, value=value, whom=Named(named[0])) for kind, value in figures]
    return words.acts(acts) if len(acts) == 1 else None


def _again(words: Words) -> Intent | None:
    """ "once more" behind an undo."""
    return words.line.command("undo", steps=1.0) if words.last(Undo) else None


def _taken_up(words: Words) -> Intent | None:
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


_OF_USERS = "users bare lead again pronoun one"
_GONE = "it users bare every others both pronoun one own again lead correct more by"
_NOUNS = " ".join(NOUNS)
_FORMS = (
    Form("correct", "users bare lead it revise whose", moved),
    Form("undo", "bare factor change_noun lead again", _steps_undone),
    Form("undo", "correct it lead again make more less factor rate limit promise power weight too remove", _undone),
    Form("too|equal", "users bare lead weight rate promise again others every make it", _as_another),
    Form("again", "lead", _again),
    Form("again", "lead it take", read_repeated),
    Form("take", "it", _taken_up),
    Form("as_it_was", f"before after users lead correct make undo told leave first {_NOUNS}", _as_it_was),
    Form("equal weight", "every make again lead", _weighed_equally),
    Form("remove|too", f"{_GONE} {_NOUNS} figure", dropped),
    Form("restore", f"it correct lead take make again {_NOUNS}", restored),
    Form("every serve", "again lead take make correct bare it", all_served),
    Form("others serve", "again lead too make bare", all_served),
    Form("both serve", "again lead every", both_served),
    Form("serve", f"too take make it correct {_OF_USERS}", served),
    Form("leave", f"too take make {_OF_USERS}", left_out),
    Form("too|lead", f"it correct promise rate {_OF_USERS}", _same_of_others),
    Form("", "", read_relative, asked=True),
    Form("limit power", "make", _asks_what_changes, asked=True),
    Form(f"vague more|less {_NOUNS.replace(' ', '|')}", "make lead it correct take users every", _asks_what_changes),
    Form("", "", read_figure, asked=True),
    Form("correct ratio|factor", "lead by to less more", _corrected),
)
"""The kinds of lines, the closest first; a line that denies what it says may only be of the first."""
