"""Lines that are a part of a sentence: "and 3 too", "make it 9", "the others 400k", "20 % more for user 4".

Such a line takes what it does not say from the last act of its conversation. Every word of it is a figure, a user, or
in a class of ``fragment_words/<language>.toml``; with one word that is not, it is no such line, and left to who reads
sentences. So nothing is done that a word of the line may not have meant.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
import re
from collections.abc import Mapping, Sequence
from typing import cast

from wirelessagent.language.acts import (
    Act,
    Aim,
    Drop,
    Everybody,
    LeaveOut,
    Limit,
    Named,
    Others,
    Scale,
    Serve,
    Suppose,
    Undo,
    Whom,
)  # fmt: skip
from wirelessagent.language.conversation.line import NAME, Line, begins, is_all
from wirelessagent.language.conversation.relative import read_relative
from wirelessagent.language.conversation.tokens import NOUNS, UNITS, Token, Words, speaks_of_one, tokens_of, words_of
from wirelessagent.language.guard import tells_no_mere_fact
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, Constraint, Intent
from wirelessagent.language.intent_acts import acts_of, stated
from wirelessagent.language.mentions import mentions
from wirelessagent.language.moods import is_ordered
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.language.text import languages_of, normalise
from wirelessagent.model.units import human

_COUNTS = ("weights", "resource_block_group_size")
"""Limits without a unit."""

_FIGURE = re.compile(r"^[-+\d.,\s]+")
_LONGEST = 120
_SHORT = 40
_MOST_STEPS = 20
_FIRST_NUMBER = re.compile(r"\s*(\d{1,3})\s+(?=[^\W\d_]{2,}\s)")
_BUT = re.compile(r"(?:\s(?=(?:but|and)\s)|(?=但|而))(.+)$")
_LAST_CLAUSE = re.compile(r"[,，;；.。!！]\s*([^,，;；.。!！]+)[.。!！\s]*$")
_FAR = 20.0
"""How many times a figure may change where its unit is left out."""


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
    found = [fragment.intent() for fragment in words_of(line, _Fragment)]
    if order is not None:
        found += [fragment.intent() for fragment in words_of(order, _Fragment) if fragment.spoken_of is not None]
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
    acts = story.figures or is_ordered(story.text) or any(True for _ in words_of(story, Words))
    if len(users) != 1 or acts or story.is_asked or tells_no_mere_fact(story.text):
        return None
    return Line.of(clause[1], dataclasses.replace(line.context, spoken_of=users))


def read_wondered(line: Line) -> Intent | None:
    """The what-if of a change by what holds, of a line that asks whether it is possible; None for any other."""
    found = (read_relative(words, wonders=True) for words in words_of(line, Words))
    return next((intent for intent in found if intent is not None), None)


def referred(line: Line, intent: Intent) -> Intent:
    """A request whose figure leaves out what it is of as the line or the last act has it.

    A figure for everybody is for whom the line refers to: "the rest", "both", "her" behind a line about user 2. A power
    that no noun calls the cell's is of the kind of the last one: "go to 250 mW" behind a limit of each subcarrier.
    """
    context = line.context
    if intent.kind != "allocate" or context.objective is None or intent.recogniser == NAME:
        return intent
    supposed = acts_of(context.guess) if context.guess is not None else ()
    wondered = (act for one in context.acts if isinstance(one, Suppose) for act in one.acts)
    last = [act for act in (*context.acts, *wondered, *supposed) if isinstance(act, Limit | Scale | LeaveOut)]
    intent = _of_last_kind(line, intent, [act for act in last if isinstance(act, Limit)])
    kinds = [kind for kind in FIGURES_OF_USERS if isinstance(intent.constraints.get(kind), float)]
    if not kinds:
        return intent
    plain = normalise(line.text)
    roles = {each.role for each in mentions(plain, context.user_names)} - {"pronoun"}
    named = {act.whom for act in last if isinstance(act.whom, Named)}
    if len(context.spoken_of) == 1:
        named = {Named(context.spoken_of)}
    whom: Whom | None = Others() if roles == {"others"} else None
    held = context.constraints.get(kinds[0])
    if not roles and speaks_of_one(plain, "both") and isinstance(held, Mapping) and len(held.keys() - {EVERYBODY}) == 2:
        whom = Named(tuple(user for user in held if user != EVERYBODY))
    elif not roles and len(named) == 1 and (speaks_of_one(plain) or (line.is_read and speaks_of_one(plain, "it"))):
        whom = named.pop()
    if whom is None:
        of_named = {act.kind for act in last if isinstance(act, Limit | Scale) and act.whom in named}
        leans = bool(of_named & {*kinds}) and not any(speaks_of_one(plain, noun) for noun in ("rate", "promise"))
        if roles or not (speaks_of_one(plain, "one") or leans):
            return intent
        return line.ask("whose_figure", text=intent.evidence[kinds[0]], users=line.voice.users(context.user_names))
    acts = [dataclasses.replace(act, whom=whom) if isinstance(act, Limit) and act.kind in kinds else act
            for act in acts_of(intent)]  # fmt: skip
    return dataclasses.replace(intent, acts=tuple(acts))


def _of_last_kind(line: Line, intent: Intent, last: Sequence[Limit]) -> Intent:
    """A limit of the power as one of the kind that was stated last, where no noun says that it is the cell's."""
    kinds, plain = {act.kind for act in last}, normalise(line.text)
    aims = any(isinstance(act, Aim) and act.words for act in line.context.acts)
    leans = speaks_of_one(plain, "correct") or not aims
    name = kinds.pop() if len(kinds) == 1 and leans and line.context.awaits != "clarification" else ""
    stated = "max_power_w" in intent.constraints and name in UNITS["power"] and name not in intent.constraints
    if not stated or any(speaks_of_one(plain, noun) for noun in ("power", "limit")):
        return intent
    constraints = {name if each == "max_power_w" else each: value for each, value in intent.constraints.items()}
    evidence = {name if each == "max_power_w" else each: words for each, words in intent.evidence.items()}
    return dataclasses.replace(
        intent, constraints=constraints, evidence=evidence, reply=line.voice.amended(constraints, intent.dropped)
    )


def named_alone(line: Line) -> tuple[str, ...]:
    """The users that a line names and nothing else: "excuse me, I meant user 2"."""
    for language in languages_of(line.text):
        tokens = tokens_of(line, language) or ()
        if tokens and all(token.classes & {"users", "correct", "skip", "lead", "it"} for token in tokens):
            return tuple(user for token in tokens for user in token.users)
    return ()


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
    for language in languages_of(line.text):
        tokens = tokens_of(last, language)
        if tokens and _is_undo(Words(last, tokens, language), "again"):
            return True
    return False


def _is_undo(words: Words, *further: str) -> bool:
    """Whether a line takes the last change back and says nothing else: "undo that", "undo the raise"."""
    changes = ("make", "more", "less", "factor", "rate", "limit", "promise", "power", "weight")
    names = any(words.has(name) for name in changes[:3])
    bare = not (words.figures or words.users)
    return bare and words.has("undo") and words.only("undo", "it", *further, *(changes if names else ()))


def _denies(tokens: Sequence[Token]) -> bool:
    """Whether a word that corrects what was said before stands where it denies what this line says."""
    said = [place for place, token in enumerate(tokens) if not token.classes & {"correct", "skip", "lead"}]
    behind = tokens[said[0] :] if said else ()
    return any("correct" in token.classes and not token.classes & {"skip", "lead"} for token in behind)


class _Fragment(Words):
    """A line that leans on the acts before it."""

    def intent(self) -> Intent | None:
        if self.line.is_asked:
            return read_relative(self) or self._stated()
        readers = (
            self._moved, self._undone, self._as_another, self._again, self._taken_up, self._as_it_was, self._dropped,
            self._served, self._scaled, self._stated, self._corrected,
        )  # fmt: skip
        readers = readers[: 1 if _denies(self.tokens) else None]
        return next((found for read in readers if (found := read()) is not None), None)

    def _undone(self) -> Intent | None:
        """ "nah, undo that"; a bare command is a sentence of its own where recognisers read it."""
        if (
            self.has("undo")
            and not self.is_read
            and self.only("undo", "bare", "factor", "change_noun", "lead", "again")
        ):
            counts = [figure.value for figure in self.figures] + [token.factor for token in self.tokens if token.factor]
            if len(counts) == 1 and counts[0] in range(1, _MOST_STEPS):
                return self.line.command("undo", steps=float(counts[0]))
        changes = any(self.has(name) for name in ("more", "less", "make"))  # "undo the raise"
        if (changes or self.has("correct") or not self.is_read) and _is_undo(self, "correct", "lead", "again"):
            return self.line.command("undo", steps=1.0)
        return None

    def _moved(self) -> Intent | None:
        """ "no, user 5", "I mean user 6, not 3", "for 3": what was said last of one user, of another."""
        if not self.has("correct") or not self.only("users", "bare", "correct", "lead", "it", "revise", "whose"):
            return None
        if not self.users:
            self.users = self._meant()
        if not self.users:
            return None
        if self.taken_off:
            return self._taken_off_another()
        last = self._of_named()
        if not last and len(self.last(Scale)) == 1:
            return self._scaled_another(self.last(Scale)[0])
        if not last:
            return self._for_all_moved()
        if len(last) != 1:
            return None
        ((act, old),) = last
        users = tuple(user for user in self.users if user not in old)
        figures = [*self.figures, *([self.replaced] if self.replaced is not None else [])]
        denied = {*(f"{figure.value:g}" for figure in figures), *self.users} - {*users}
        if not users or not denied <= {*old}:
            return None
        gone = Named(tuple(user for user in old if user in denied or not denied))
        back: Act = LeaveOut(whom=gone) if isinstance(act, Serve) else Serve(whom=gone)
        if isinstance(act, Limit):
            back = Drop(kind=act.kind, whom=gone, own=True)
        return self.acts([back, dataclasses.replace(act, whom=Named(users))])

    def _scaled_another(self, act: Scale) -> Intent | None:
        """ "no, I meant user 7" behind "user 8 needs double"."""
        if not isinstance(act.whom, Named) or set(act.whom.users) & set(self.users) or self.figures:
            return None
        held = self.held.get(act.kind)
        common = isinstance(held, Mapping) and EVERYBODY in held
        back = (
            Drop(kind=act.kind, whom=act.whom, own=True) if common else dataclasses.replace(act, factor=1 / act.factor)
        )
        if not common and not (isinstance(held, Mapping) and set(self.users) <= held.keys()):
            return None
        return self.acts([back, dataclasses.replace(act, whom=Named(self.users))])

    def _of_named(self) -> list[tuple[Limit | LeaveOut | Serve, tuple[str, ...]]]:
        """What was said last of named users, with them; the same of several is said once."""
        said: dict[Limit | LeaveOut | Serve, tuple[str, ...]] = {}
        for act in cast("list[Limit | LeaveOut | Serve]", self.last(Limit, LeaveOut, Serve)):
            if isinstance(act.whom, Named):
                same = dataclasses.replace(act, whom=Everybody(), words="")
                said[same] = (*said.get(same, ()), *act.whom.users)
        words = next((act.words for act in self.last(Limit)), "")
        return [(dataclasses.replace(act, words=words), users) for act, users in said.items()]

    def _meant(self) -> tuple[str, ...]:
        """A user by the number alone, where it is one's by the words or can be no figure: "for 3", "4, not 3"."""
        users, last = self._counted(), self._of_named()
        if len(users) != 1 or len(last) != 1:
            return ()
        ((act, named),) = last
        instead = self.replaced is not None and f"{self.replaced.value:g}" in named
        is_figure = isinstance(act, Limit) and _value(self.figures[0], act.kind, act) is not None
        return users if instead or self.has("whose") or not is_figure else ()

    def _for_all_moved(self) -> Intent:
        """What was said last for everybody, for these users alone; where nothing was, what is meant is asked."""
        last = [act for act in self.last(Limit) if act.kind in FIGURES_OF_USERS and isinstance(act.whom, Everybody)]
        if len(last) != 1 or self.figures:
            return self.line.ask("what_of_user", users=self.line.voice.users(self.users))
        return self.acts([Drop(kind=last[0].kind), dataclasses.replace(last[0], whom=Named(self.users))])

    @property
    def taken_off(self) -> Mapping[str, Mapping[str, float]]:
        """The figures of users that the last change took off."""
        return {
            kind: stated
            for kind, stated in self.line.context.stated.items()
            if isinstance(stated, Mapping) and EVERYBODY not in stated
            and isinstance(held := self.held.get(kind, {}), Mapping) and not stated.keys() & held.keys()
        }  # fmt: skip

    def _taken_off_another(self) -> Intent | None:
        """ "Sorry, user 3": the limit of another user goes, in the place of the one that was taken off."""
        kind, stated = next(iter(self.taken_off.items()))
        held = cast("Mapping[str, float]", self.held.get(kind, {}))
        gone = {user: held[user] for user in self.users if user in held}
        back = [Limit(kind=kind, value=value, whom=Named((user,))) for user, value in stated.items()]
        off = Drop(kind=kind, whom=Named(tuple(gone)))
        return self.acts([*back, off], {"taken_off": {kind: gone}}) if len(gone) == len(self.users) else None

    def _as_it_was(self) -> Intent | None:
        """ "back to how it was before the power limit": to the turn before the last one that set or dropped it."""
        before, after = self.has("before"), self.has("after")
        said = ("as_it_was", "before", "after", "users", "lead", "correct", "make", "undo", "told", "leave", "first")
        if not self.has("as_it_was") or before is after or self.figures or not self.only(*said, *NOUNS):
            return None
        kinds = self.named_kinds()
        if self.has("first") and after and not kinds and not self.users:
            turns = [place for place, acts in enumerate(self.line.context.earlier, start=1) if any(map(_changes, acts))]
            return self.line.command("undo", turn=float(turns[0])) if turns else None
        if not kinds and not self.users:
            return None
        turns = [place for place, acts in enumerate(self.line.context.earlier, start=1)
                 if any(self._is_about(act, kinds) for act in acts)]  # fmt: skip
        turn = turns[-1] - before if turns else 0
        return self.line.command("undo", turn=float(turn)) if turn > 0 else None

    def _is_about(self, act: Act, kinds: Sequence[str]) -> bool:
        """Whether an act changes one of these limits, or something of the users of the line."""
        if isinstance(act, Limit | Scale | Drop) and kinds and act.kind not in kinds:
            return False
        if kinds and not isinstance(act, Limit | Scale | Drop):
            return False
        whom = getattr(act, "whom", None)
        return not self.users or (isinstance(whom, Named) and set(self.users) <= set(whom.users))

    def _again(self) -> Intent | None:
        """ "once more" behind an undo."""
        if self.has("again") and self.only("again", "lead") and self.last(Undo):
            return self.line.command("undo", steps=1.0)
        return None

    def _taken_up(self) -> Intent | None:
        """ "do that" behind a what-if: what was supposed is asked for."""
        context = self.line.context
        if context.supposed_objective is None or self.figures or not self.has("take") or not self.only("take", "it"):
            return None
        return self.line.allocate(context.supposed_objective, context.supposed, amends=False)

    def _dropped(self) -> Intent | None:
        """ "remove the cap again", "all weights equal"."""
        whom = self.whom()
        if self.has("equal") and self.has("weight") and self.only("equal", "weight", "every", "make", "again", "lead"):
            return self.acts([Drop(kind="weights")]) if "weights" in self.held else None
        said = (
            "remove",
            "users",
            "bare",
            "every",
            "others",
            "both",
            "pronoun",
            "one",
            "too",
            "again",
            "lead",
            "correct",
            "more",
            "by",
            *NOUNS,
        )
        users = self._counted() if self.figures else ()
        gone = self.has("remove") or (self.has("too") and bool(self.last(Drop)) and not self.last(Limit, Scale))
        if (self.figures and not users) or not gone or not self.only(*said):
            return None
        whom = Named(users) if users else whom
        own = [name for name, value in self.held.items() if isinstance(value, Mapping) and isinstance(whom, Named)
               and set(whom.users) <= value.keys()]  # fmt: skip
        kinds = [kind for kind in self.named_kinds() if kind in self.held]
        if self.has("own") and whom is not None and not any(self.has(name) for name in NOUNS):  # "cancel user 5's"
            kinds = own
        if len(kinds) > 1:
            kinds = [act.kind for act in self.last(Limit) if act.kind in kinds][-1:]
        if len(kinds) != 1 or (isinstance(whom, Named) and kinds[0] not in own and kinds[0] != "min_rate_bps"):
            return None
        held = self.held.get(kinds[0])
        common = kinds == own and self.has("own") and isinstance(held, Mapping) and EVERYBODY in held
        return self.acts([Drop(kind=kinds[0], whom=whom or Everybody(), own=common)])

    def _served(self) -> Intent | None:
        """ "take 7 off the list", "user 7 back in", and users of whom the same is said as of the last ones."""
        users = self.users or self._counted() or (self.spoken_of.users if self.spoken_of else ())
        if self.has("every") and self.has("serve") and self.only("every", "serve", "again", "lead", "take", "make"):
            return self.acts([Serve(whom=Everybody())]) if {"users", "leave_out"} & self.held.keys() else None
        if (
            self.has("others")
            and self.has("serve")
            and self.only("others", "serve", "again", "lead", "too", "make", "bare")
        ):
            return self._others_served()
        out = self.held.get("leave_out", ())
        if self.has("both") and self.has("serve") and self.only("both", "serve", "again", "lead", "every"):
            return (
                self.acts([Serve(whom=Named(cast("tuple[str, ...]", out)))])
                if len(cast("tuple[str, ...]", out)) == 2
                else None
            )
        if not users or (self.figures and self.users):
            return None
        whom, lists = Named(users), [*self.last(LeaveOut), *self.last(Serve)]
        said = ("users", "bare", "lead", "again", "pronoun", "one")
        if self.has("serve") and self.only("serve", "too", "take", "make", *said) and not self._serves(users):
            return self.acts([Serve(whom=whom)])
        leans = bool(lists) or not self.is_read or self.spoken_of is not None
        if self.has("leave") and self.only("leave", "too", "take", "make", *said) and leans:
            return self.acts([LeaveOut(whom=whom)])
        nouns = ("promise", "rate") if {act.kind for act in self.last(Limit)} & {*self.named_kinds()} else ()
        if not (self.has("too") or self.has("lead")) or not self.only("too", "it", "correct", *nouns, *said):
            return None
        if not (self.has("too") or self.has("whose") or self.users):
            return None
        moved = {act.kind for act in self.last(Limit)}
        again = [dataclasses.replace(act, whom=whom) for act in self.last(Limit, Drop, LeaveOut, Scale, Serve)
                 if isinstance(act.whom, Named) and not (isinstance(act, Drop) and act.kind in moved)]  # fmt: skip
        again = [dataclasses.replace(act, alone=False) if isinstance(act, Serve) else act for act in again]
        return self.acts(again) if len(set(again)) == 1 else None

    def _others_served(self) -> Intent | None:
        """ "let the other five in": everybody is served again, where so many are not."""
        served, out = (cast("tuple[str, ...]", self.held.get(name, ())) for name in ("users", "leave_out"))
        missing = len(self.line.context.user_names) - len(served) if served else len(out)
        counted = [figure.value for figure in self.figures]
        return self.acts([Serve(whom=Everybody())]) if missing and counted in ([], [missing]) else None

    def _as_another(self) -> Intent | None:
        """ "user 8 the same as user 3": the one figure of a user, for another one too."""
        said = ("users", "bare", "too", "lead", "equal", "weight", "rate", "promise", "again")
        if not (self.has("too") or self.has("equal")) or not self.only(*said):
            return None
        named = [token.users for token in self.tokens if token.users]
        named += [self._counted()] if len(named) == 1 and self._counted() else []
        if len(named) != 2 or len(named[1]) != 1:
            return None
        figures = [(kind, value[named[1][0]]) for kind in FIGURES_OF_USERS
                   if isinstance(value := self.held.get(kind), Mapping) and named[1][0] in value]  # fmt: skip
        acts = [Limit(kind=kind, value=value, whom=Named(named[0])) for kind, value in figures]
        return self.acts(acts) if len(acts) == 1 else None

    def _serves(self, users: tuple[str, ...]) -> bool:
        served, out = self.held.get("users"), self.held.get("leave_out")
        listed = cast("tuple[str, ...]", served if served is not None else ())
        return (served is None and not set(users) & set(cast("tuple[str, ...]", out or ()))) or set(users) <= {*listed}

    def _scaled(self) -> Intent | None:
        return read_relative(self)

    def _corrected(self) -> Intent | None:
        """ "No, a third", where no share was said before."""
        shares = any(token.classes & {"ratio", "factor"} for token in self.tokens)
        if (
            not shares
            or not self.has("correct")
            or not self.only("correct", "ratio", "factor", "lead", "by", "to", "less", "more")
        ):
            return None
        return None if "outage_probability" in self.line.context.stated else self.line.ask("what_changes")

    def _stated(self) -> Intent | None:
        """ "make it 9", "the others 400k", "and with 8?", "take the 8"."""
        said = (
            "users", "every", "others", "pronoun", "one", "it", "lead", "make", "correct", "suppose", "take", "figure",
            "ratio", "bare", "with", "grant", "too", "by", "to", "revise", "both", "at_most", *NOUNS,
        )  # fmt: skip
        if not self.figures and self.has("limit") and self.has("power") and self.only("limit", "power", "make"):
            return self.line.ask("what_changes")
        if len(self.figures) != 1 or not self.only(
            *said,
            *(("been",) if self.has("suppose") else ()),
            *(("more", "less") if self.has("to") or self._says_anew() else ()),
        ):
            return None
        figure = self.figures[0]
        supposed = [act for one in self.last(Suppose) for act in one.acts if isinstance(act, Limit)]
        before = supposed or [*self.last(Limit), *map(self._as_held, self.last(Scale))]
        if self.has("correct") and self.taken_off:
            before = [act for act in stated(self.taken_off) if isinstance(act, Limit)]
        kinds = self._kinds_of(figure, before)
        if len(kinds) != 1:
            return None
        kind = kinds[0]
        models = [act for act in before if act.kind == kind]
        model = models[-1] if models else self._as_named(kind, figure)
        if self.has("others") or self.has("every") or self.users:
            model = next((act for act in models if isinstance(act.whom, Named) is bool(self.users)), model)
        several = len({act.whom for act in models}) > 1
        said_whose = self.users or self.spoken_of or any(self.has(name) for name in ("others", "every", "both"))
        several = several and not said_whose
        if several and model is not None and self.has("correct"):
            users = [user for act in models if isinstance(act.whom, Named) for user in act.whom.users]
            return self.line.ask("whose_figure", text=figure.text, users=self.line.voice.users(users))
        of_share = bool(self.line.context.share_of) and figure.kind == "bare"
        if several or (self.has("correct") and (of_share or (model is None and self.last(Drop)))):
            return None
        raised = self.has("more") or self.has("make")  # "bump her up to 600 kbit/s" sets no cap
        caps = any("at_most" in token.classes and not (raised and "to" in token.classes) for token in self.tokens)
        if caps and kind not in ("max_rate_bps", *UNITS["power"]):
            return None
        leaning = ["correct", "take", "others", "both", "at_most", "subcarrier", "group", "pronoun", "one"]
        leaning += ["make", "lead", "with", "suppose", "grant"] if figure.kind == "bare" or supposed else []
        leaning += ["revise"] if model is not None and isinstance(model.whom, Named) else []
        if len(self.named_kinds()) == 1:
            leaning += ["make", "promise"] if self.users else ["make"]
        alone = (
            model is not None
            and self.line.context.awaits == "nothing"
            and all(token.figure or token.classes & {"skip"} for token in self.tokens)
        )
        leans = alone or any(self.has(name) for name in leaning)
        leans = leans or (self.has("limit") and figure.kind == "power")
        leans = leans and not (self.has("by") and self.has("make"))
        value = _value(figure, kind, model)
        whom = self.whom() or (model.whom if model is not None else Everybody())
        if self.has("both"):
            held = self.held.get(kind)
            own = tuple(user for user in held if user != EVERYBODY) if isinstance(held, Mapping) else ()
            if len(own) != 2:
                return None
            whom = Named(own)
        led = any(self.has(name) for name in ("lead", "correct", "with", "make", "at_most", "grant"))
        pairs = itertools.pairwise(self.tokens)
        led = led or any(token.figure and "promise" in behind.classes for token, behind in pairs)  # "1 Mbit/s promised"
        if value is None or not leans or (self.users and not led):
            return None
        if kind not in FIGURES_OF_USERS:
            if self.users or self.has("others"):
                return None
            whom = Everybody()
        named = isinstance(whom, Named)
        if (
            self.has("instead")
            or (self.has("one") and not named)
            or (self.has("pronoun") and self.has("each") and named)
        ):
            return None
        if self.replaced is not None and _value(self.replaced, kind, model) not in _figures(self.held.get(kind)):
            return None
        wondered = self.line.is_asked or self.has("suppose")
        if (wondered or supposed) and not (self.has("take") or self.has("make") or self.has("correct")):
            return self._wondered(kind, value, whom) if self.has("suppose") or supposed else None
        return self.acts([Limit(kind=kind, value=value, whom=whom, words=_words(figure, kind, model))])

    def _as_named(self, kind: str, figure: Quantity) -> Limit | None:
        """The limit that holds and that a noun names, in the place of which a figure without a unit stands."""
        held = self.held.get(kind)
        named = figure.kind == "bare" and kind in self.named_kinds() and isinstance(held, float)
        return Limit(kind=kind, value=held) if named and isinstance(held, float) else None

    def _says_anew(self) -> bool:
        """Whether a figure is what something is to be, and not by how much: "a bit more for everyone, say 350"."""
        pairs = itertools.pairwise(self.tokens)
        return any(
            behind.figure is not None and "make" in token.classes and not token.classes & {"more", "less"}
            for token, behind in pairs
        )

    def _as_held(self, act: Scale) -> Limit:
        """A figure that was scaled, as it holds."""
        held = self.held.get(act.kind)
        users = act.whom.users if isinstance(act.whom, Named) else (EVERYBODY,)
        value = held.get(users[0], held.get(EVERYBODY, 1.0)) if isinstance(held, Mapping) else held
        return Limit(kind=act.kind, value=value if isinstance(value, float) else 1.0, whom=act.whom)

    def _kinds_of(self, figure: Quantity, before: Sequence[Limit]) -> list[str]:
        """The limits that a figure may be, the closest first by what was said last."""
        fitting = UNITS.get(figure.kind, ())
        named = self.named_kinds()
        possible = [kind for kind in named if not fitting or kind in fitting] if named else list(fitting)
        whose = FIGURES_OF_USERS if self.users and figure.kind == "bare" else [act.kind for act in before]
        last = [act.kind for act in before if (not (named or fitting) or act.kind in possible) and act.kind in whose][
            -1:
        ]
        if not named and any(self.has(name) for name in NOUNS):
            return []
        if figure.kind == "bare" and not named:
            return last
        held = [kind for kind in possible if kind in self.held]
        if last or len(held) == 1:
            return last or held
        return possible[:1] if figure.kind == "rate" or (named and len(possible) == 1) else []

    def _wondered(self, kind: str, value: float, whom: Whom) -> Intent | None:
        if isinstance(whom, Others):
            return None
        users = dict.fromkeys(whom.users, value) if isinstance(whom, Named) else value
        return self.line.question("what_if", constraints={kind: users})

    def _counted(self) -> tuple[str, ...]:
        """Users named by their number alone: "and 3 too"."""
        found = [token.figure for token in self.tokens if "bare" in token.classes and token.figure is not None]
        names = {str(number) for number in range(1, len(self.line.context.user_names) + 1)}
        users = tuple(f"{figure.value:g}" for figure in found)
        if not users or len(found) != len(self.figures) or not set(users) <= names:
            return ()
        named = any(isinstance(act.whom, Named) for act in self.last(Limit, Drop, LeaveOut, Serve, Scale))
        return users if named or self.has("leave") or self.has("serve") else ()


def _changes(act: Act) -> bool:
    return isinstance(act, Aim | Limit | LeaveOut | Serve)


def _figures(held: Constraint | None) -> tuple[float, ...]:
    """All figures of a limit that holds."""
    if isinstance(held, Mapping):
        return tuple(held.values())
    return (held,) if isinstance(held, float) else ()


def _value(figure: Quantity, kind: str, model: Limit | None) -> float | None:
    """A figure in SI units; one without a unit has that of the figure in whose place it is."""
    value, bare = figure.value, figure.kind == "bare" and kind not in _COUNTS
    if bare:
        unit = None if model is None else _unit(model)
        found = parse_quantities(f"{figure.value:g} {unit}" if unit else "")
        value = found[0].value if found and found[0].kind != "bare" else math.nan
    if kind == "outage_probability":
        value = round(1 - value if value > 0.5 else value, 12)
    if bare and (model is None or not model.value / _FAR < value < model.value * _FAR):  # another unit may be meant
        return None
    return value if 0 < value < (1 if kind == "outage_probability" else math.inf) else None


def _unit(model: Limit) -> str:
    """The unit in which a limit was said, or in which it is shown."""
    for one in parse_quantities(model.words):
        if one.kind in UNITS and one.text[:1].isdigit() and (one.value == model.value or one.kind == "ratio"):
            return _FIGURE.sub("", one.text).strip() or "W"
    if model.kind == "outage_probability":
        return "%"
    return _FIGURE.sub("", human(model.value, "W" if model.kind.endswith("_w") else "bit/s")).strip()


def _words(figure: Quantity, kind: str, model: Limit | None) -> str:
    if figure.kind != "bare" or model is None or kind in _COUNTS:
        return figure.text
    return f"{figure.value:g} {_unit(model)}"
