"""Lines that correct whom the last one was about: "no, user 5", "I mean user 6, not 3", "for 3"."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import cast

from wirelessagent.language.acts import Act, Drop, Everybody, LeaveOut, Limit, Named, Scale, Serve
from wirelessagent.language.conversation.figure_in_place import value_of
from wirelessagent.language.conversation.tokens import Token, Words, own_users
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, Intent


def denies(tokens: Sequence[Token]) -> bool:
    """Whether a word that corrects what was said before stands where it denies what this line says."""
    said = [place for place, token in enumerate(tokens) if not token.classes & {"correct", "skip", "lead"}]
    behind = tokens[said[0] :] if said else ()
    return any("correct" in token.classes and not token.classes & {"skip", "lead", "meant"} for token in behind)


def moved(words: Words) -> Intent | None:
    """ "no, user 5", "I mean user 6, not 3", "for 3": what was said last of one user, of another."""
    words.users = words.users or _meant(words)
    if not words.users or (words.is_unsure and not (words.denied and _of_named(words))):
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
    if isinstance(act, Serve) and act.alone and not denies(words.tokens):  # "no, 1 and 3" behind "only 1 and 2"
        return words.acts([dataclasses.replace(act, whom=Named(words.users))])
    users = tuple(user for user in words.users if user not in old)
    given: set[float | None] = {token.factor for token in words.tokens if token.factor}
    if isinstance(act, Limit):
        given = (given | {value_of(figure, act.kind, act) for figure in words.figures}) - {act.value}
    if given and not words.counted():  # "not 3, 5 counts double" says again what it moves
        return None
    denied = words.denied | ({*words.users} - {*users})
    if words.has("at_most") and not users and not isinstance(act, Limit):  # "only 8" behind "1 and 8"
        users, denied = words.users, {*old} - {*words.users}
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
    """What was said last of named users, of those who are denied where any are; the same of several is said once."""
    first = next((act.words for act in words.last(Limit)), "")
    for acts in (words.line.context.acts, *words.line.context.earlier[::-1]):
        said: dict[Limit | LeaveOut | Serve, tuple[str, ...]] = {}
        for act in acts:
            if isinstance(act, Limit | LeaveOut | Serve) and isinstance(act.whom, Named):
                same = dataclasses.replace(act, whom=Everybody(), words="")
                said[same] = (*said.get(same, ()), *act.whom.users)
        about = [(dataclasses.replace(act, words=first), users) for act, users in said.items()
                 if not words.denied or words.denied & {*users}]  # fmt: skip
        if about or not words.denied:
            return about
    return []


def _meant(words: Words) -> tuple[str, ...]:
    """A user by the number alone, where it is one's by the words or can be no figure: "for 3", "4, not 3"."""
    users, last = words.counted(), _of_named(words)
    if not users or len(last) != 1:
        return ()
    ((act, named),) = last
    instead = bool(words.denied & {*named})
    if isinstance(act, Serve | LeaveOut):
        return users if instead or not words.denied else ()
    if len(users) != 1:
        return ()
    is_figure = value_of(words.figures[0], act.kind, act) is not None
    return users if instead or words.has("whose") or not is_figure else ()


def _for_all_moved(words: Words) -> Intent | None:
    """What was said last for everybody, for these users alone; where nothing was, what is meant is asked."""
    last = [act for act in words.last(Limit) if act.kind in FIGURES_OF_USERS and isinstance(act.whom, Everybody)]
    if words.replaced or words.is_unsure:
        return None
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


def swapped(words: Words) -> Intent | None:
    """ "The other way round": two users, with figures of their own, have each other's."""
    last = [act for act in words.last(Limit, Scale) if act.kind in FIGURES_OF_USERS]
    for kind in words.named_kinds() or [act.kind for act in last] or FIGURES_OF_USERS:
        held, named = words.held.get(kind), [act.whom.users for act in last if isinstance(act.whom, Named)]
        users = words.users or tuple(dict.fromkeys(user for users in named for user in users))
        users = own_users(held) if len(users) != 2 and not words.users else users
        if len(users) == 2 and isinstance(held, Mapping) and {*users} <= held.keys():
            each = zip(users, users[::-1], strict=True)
            return words.acts([Limit(kind=kind, value=held[other], whom=Named((user,))) for user, other in each])
    return None
