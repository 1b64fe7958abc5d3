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
from typing import cast

from wirelessagent.language.acts import (
    Act,
    Aim,
    Drop,
    Everybody,
    LeaveOut,
    Limit,
    Named,
    Scale,
    Serve,
    Undo,
)  # fmt: skip
from wirelessagent.language.conversation.figure_in_place import figures_of, read_figure, value_of
from wirelessagent.language.conversation.line import Line, begins, is_all
from wirelessagent.language.conversation.relative import read_relative, read_repeated
from wirelessagent.language.conversation.tokens import NOUNS, UNITS, Token, Words, speaks_of_one, tokens_of, words_of
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
    words, forms = _corrected_at_once(words), _FORMS
    if words.line.is_asked:
        forms = tuple(form for form in _FORMS if form.asked)
    elif _denies(words.tokens):
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


def _corrected_at_once(words: Words) -> Words:
    """A line with what stands behind a correction in the place of what it corrects: "a bit less... no, a third"."""
    tokens = list(enumerate(words.tokens))
    place = next((at for at, each in tokens[::-1] if "correct" in each.classes and "instead" not in each.classes), 0)
    ahead, behind = words.tokens[:place], words.tokens[place + 1 :]
    users, figures = any(token.users for token in behind), any(token.figure or token.factor for token in behind)
    gone = {*(("users",) if users else ()), *(("figure", "bare", "ratio", "factor", "vague") if figures else ())}
    kept = [token for token in ahead if not token.classes & gone]
    said = any(token.classes - {"skip", "correct", "lead"} for token in ahead)
    return Words(words.line, [*kept, *behind], words.language) if said and len(kept) < len(ahead) else words


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


def _denies(tokens: Sequence[Token]) -> bool:
    """Whether a word that corrects what was said before stands where it denies what this line says."""
    said = [place for place, token in enumerate(tokens) if not token.classes & {"correct", "skip", "lead"}]
    behind = tokens[said[0] :] if said else ()
    return any("correct" in token.classes and not token.classes & {"skip", "lead"} for token in behind)


def _moved(words: Words) -> Intent | None:
    """ "no, user 5", "I mean user 6, not 3", "for 3": what was said last of one user, of another."""
    words.users = words.users or _meant(words)
    if not words.users:
        return None
    if words.taken_off:
        return _taken_off_another(words)
    last = _of_named(words)
    if not last and len(words.last(Scale)) == 1:
        return _scaled_another(words, words.last(Scale)[0])
    if not last:
        return _for_all_moved(words)
    if len(last) != 1:
        return None
    ((act, old),) = last
    if isinstance(act, Serve) and act.alone and not _denies(words.tokens):  # "no, 1 and 3" behind "only 1 and 2"
        return words.acts([dataclasses.replace(act, whom=Named(words.users))])
    users = tuple(user for user in words.users if user not in old)
    figures = [*words.figures, *([words.replaced] if words.replaced is not None else [])]
    denied = {*(f"{figure.value:g}" for figure in figures), *words.users} - {*users}
    if not users or not denied <= {*old}:
        return None
    gone = Named(tuple(user for user in old if user in denied or not denied))
    back: Act = LeaveOut(whom=gone) if isinstance(act, Serve) else Serve(whom=gone)
    if isinstance(act, Limit):
        back = Drop(kind=act.kind, whom=gone, own=True)
    return words.acts([back, dataclasses.replace(act, whom=Named(users))])


def _scaled_another(words: Words, act: Scale) -> Intent | None:
    """ "no, I meant user 7" behind "user 8 needs double"."""
    if not isinstance(act.whom, Named) or set(act.whom.users) & set(words.users) or words.figures:
        return None
    held = words.held.get(act.kind)
    if not isinstance(held, Mapping):
        return None
    back: Act = Drop(kind=act.kind, whom=act.whom, own=True)
    if EVERYBODY not in held:
        if not set(words.users) <= held.keys():
            return None
        back = dataclasses.replace(act, factor=1 / act.factor)
    return words.acts([back, dataclasses.replace(act, whom=Named(words.users))])


def _of_named(words: Words) -> list[tuple[Limit | LeaveOut | Serve, tuple[str, ...]]]:
    """What was said last of named users, with them; the same of several is said once."""
    said: dict[Limit | LeaveOut | Serve, tuple[str, ...]] = {}
    for act in cast("list[Limit | LeaveOut | Serve]", words.last(Limit, LeaveOut, Serve)):
        if isinstance(act.whom, Named):
            same = dataclasses.replace(act, whom=Everybody(), words="")
            said[same] = (*said.get(same, ()), *act.whom.users)
    first = next((act.words for act in words.last(Limit)), "")
    return [(dataclasses.replace(act, words=first), users) for act, users in said.items()]


def _meant(words: Words) -> tuple[str, ...]:
    """A user by the number alone, where it is one's by the words or can be no figure: "for 3", "4, not 3"."""
    users, last = words.counted(), _of_named(words)
    if not users or len(last) != 1:
        return ()
    ((act, named),) = last
    if isinstance(act, Serve | LeaveOut):
        return users
    if len(users) != 1:
        return ()
    instead = words.replaced is not None and f"{words.replaced.value:g}" in named
    is_figure = value_of(words.figures[0], act.kind, act) is not None
    return users if instead or words.has("whose") or not is_figure else ()


def _for_all_moved(words: Words) -> Intent:
    """What was said last for everybody, for these users alone; where nothing was, what is meant is asked."""
    last = [act for act in words.last(Limit) if act.kind in FIGURES_OF_USERS and isinstance(act.whom, Everybody)]
    if len(last) != 1 or words.figures:
        return words.line.ask("what_of_user", users=words.line.voice.users(words.users))
    return words.acts([Drop(kind=last[0].kind), dataclasses.replace(last[0], whom=Named(words.users))])


def _taken_off_another(words: Words) -> Intent | None:
    """ "Sorry, user 3": the limit of another user goes, in the place of the one that was taken off."""
    kind, stated = next(iter(words.taken_off.items()))
    held = cast("Mapping[str, float]", words.held.get(kind, {}))
    gone = {user: held[user] for user in words.users if user in held}
    back = [Limit(kind=kind, value=value, whom=Named((user,))) for user, value in stated.items()]
    off = Drop(kind=kind, whom=Named(tuple(gone)))
    return words.acts([*back, off], {"taken_off": {kind: gone}}) if len(gone) == len(words.users) else None


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


def _dropped(words: Words) -> Intent | None:
    """ "remove the cap again", "and his too" behind another one that went."""
    users = words.counted() if words.figures else ()
    gone = words.has("remove") or (bool(words.last(Drop)) and not words.last(Limit, Scale))
    if (words.figures and not users) or not gone:
        return None
    whom = Named(users) if users else words.whom()
    own = [name for name, value in words.held.items() if isinstance(value, Mapping) and isinstance(whom, Named)
           and set(whom.users) <= value.keys()]  # fmt: skip
    kinds = [kind for kind in words.named_kinds() if kind in words.held]
    if words.has("own") and whom is not None and not words.has(*NOUNS):  # "cancel user 5's"
        kinds = own
    if users and not words.has("leave", *NOUNS):  # "6不用了"
        kinds = own
    raised = words.has("more") and (bool(words.line.context.share_of) or not words.has("again"))  # "lift it"
    said_it = words.has("it") and whom is None and not words.has(*NOUNS)
    if said_it and not raised and not is_all("cancel", words.line.said):  # "lift it again" behind a limit
        last = words.last(Limit)
        kinds, whom = [act.kind for act in last], last[0].whom if len(last) == 1 else None
    if len(kinds) > 1:
        kinds = [act.kind for act in words.last(Limit) if act.kind in kinds][-1:]
    if len(kinds) != 1 or (isinstance(whom, Named) and kinds[0] not in own and kinds[0] != "min_rate_bps"):
        return None
    held = words.held.get(kinds[0])
    common = kinds == own and words.has("own") and isinstance(held, Mapping) and EVERYBODY in held
    return words.acts([Drop(kind=kinds[0], whom=whom or Everybody(), own=common)])


def _restored(words: Words) -> Intent | None:
    """ "put the cap back": the limit that was taken off last."""
    gone, named = {act.kind for act in words.last(Drop)}, words.named_kinds()
    back = gone & {*named} if words.has(*NOUNS) else gone
    return words.line.command("undo", steps=1.0) if back and not words.last(Limit) else None


def _all_served(words: Words) -> Intent | None:
    """ "serve everybody again", "let the other five in": nobody is left out any more."""
    served, out = words.listed("users"), words.listed("leave_out")
    missing = len(words.line.context.user_names) - len(served) if served else len(out)
    counted = [figure.value for figure in words.figures]
    some, names = missing or (served and words.has("every")), len(words.line.context.user_names)
    return words.acts([Serve(whom=Everybody())]) if some and counted in ([], [missing], [names]) else None


def _both_served(words: Words) -> Intent | None:
    """ "both back in": the two who are left out."""
    out = words.listed("leave_out")
    return words.acts([Serve(whom=Named(out))]) if len(out) == 2 else None


def _of_whom(words: Words) -> tuple[str, ...]:
    """The users of a line that says no figure: by name, by number, or the one who was spoken of."""
    if words.users:
        return () if words.figures else words.users
    return words.counted() or (words.spoken_of.users if words.spoken_of else ())


def _served(words: Words) -> Intent | None:
    """ "user 7 back in"."""
    users, alone = _of_whom(words), words.listed("users")
    served = set(users) <= {*alone} if alone else not set(users) & {*words.listed("leave_out")}
    return words.acts([Serve(whom=Named(users))]) if users and not served else None


def _left_out(words: Words) -> Intent | None:
    """ "take 7 off the list"."""
    users, lists = _of_whom(words), words.last(LeaveOut, Serve)
    if words.figures and words.has("step") and {act.kind for act in words.last(Limit, Scale)} & {*UNITS["power"]}:
        return None  # "enlève 2" behind a power
    leans = bool(lists) or not words.is_read or words.spoken_of is not None
    return words.acts([LeaveOut(whom=Named(users))]) if users and leans else None


def _same_of_others(words: Words) -> Intent | None:
    """ "and 3 too": users of whom the same is said as of the last ones."""
    users, stated = _of_whom(words), {act.kind for act in words.last(Limit)}
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
    Form("correct", "users bare lead it revise whose", _moved),
    Form("undo", "bare factor change_noun lead again", _steps_undone),
    Form("undo", "correct it lead again make more less factor rate limit promise power weight too remove", _undone),
    Form("too|equal", "users bare lead weight rate promise again others every make it", _as_another),
    Form("again", "lead", _again),
    Form("again", "lead it take", read_repeated),
    Form("take", "it", _taken_up),
    Form("as_it_was", f"before after users lead correct make undo told leave first {_NOUNS}", _as_it_was),
    Form("equal weight", "every make again lead", _weighed_equally),
    Form("remove|too", f"{_GONE} {_NOUNS}", _dropped),
    Form("restore", f"it correct lead take make again {_NOUNS}", _restored),
    Form("every serve", "again lead take make correct bare it", _all_served),
    Form("others serve", "again lead too make bare", _all_served),
    Form("both serve", "again lead every", _both_served),
    Form("serve", f"too take make {_OF_USERS}", _served),
    Form("leave", f"too take make {_OF_USERS}", _left_out),
    Form("too|lead", f"it correct promise rate {_OF_USERS}", _same_of_others),
    Form("", "", read_relative, asked=True),
    Form("limit power", "make", _asks_what_changes, asked=True),
    Form(f"vague more|less {_NOUNS.replace(' ', '|')}", "make lead it correct take users every", _asks_what_changes),
    Form("", "", read_figure, asked=True),
    Form("correct ratio|factor", "lead by to less more", _corrected),
)
"""The kinds of lines, the closest first; a line that denies what it says may only be of the first."""
