"""Lines that take a limit off, for all or for some, or put it back: "lift the cap on user 2", "put it back"."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

from wirelessagent.language.acts import Act, Drop, Everybody, Limit, Named, Scale
from wirelessagent.language.conversation.line import is_all
from wirelessagent.language.conversation.tokens import NOUNS, UNITS, Words
from wirelessagent.language.followups import numbers_of
from wirelessagent.language.intent import EVERYBODY, FIGURES_OF_USERS, Intent
from wirelessagent.language.quantities import Quantity


def dropped(words: Words) -> Intent | None:
    """ "remove the cap again", and "his too" behind another one that went."""
    users = words.counted() if words.figures else ()
    gone = words.has("remove") or (bool(words.last(Drop)) and not words.last(Limit, Scale))
    if words.has("remove") and words.users and [figure.kind for figure in words.figures] == ["rate"]:
        return _no_more_promised(words, words.figures[0])
    if (words.figures and not users) or not gone:
        return None
    whom = Named(users) if users else words.whom()
    own = [name for name, value in words.held.items() if isinstance(value, Mapping) and isinstance(whom, Named)
           and set(whom.users) <= value.keys()]  # fmt: skip
    kinds = [kind for kind in words.named_kinds() if kind in words.held]
    if words.named_kinds() and not kinds and words.users:
        return words.line.ask("no_limit_of_its_own", users=words.line.voice.users(words.users))
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
    if len(kinds) != 1 or (isinstance(whom, Named) and kinds[0] not in (*own, *FIGURES_OF_USERS)):
        return None
    if isinstance(whom, Named) and not (kinds == own and words.has("own")):
        return _taken_off(words, kinds[0], whom.users)
    held = words.held.get(kinds[0])
    common = isinstance(whom, Named) and isinstance(held, Mapping) and EVERYBODY in held
    return words.acts([Drop(kind=kinds[0], whom=whom or Everybody(), own=common)])


def _no_more_promised(words: Words, figure: Quantity) -> Intent:
    """ "user 2 doesn't need 1 Mbit/s any more": asked about where that is not what holds for these users."""
    theirs = {kind: figures for kind in words.named_kinds() or UNITS["rate"]
              if (figures := _figures_of(words, kind, words.users))}  # fmt: skip
    of_users = words.line.voice.users(words.users)
    for kind, figures in theirs.items():
        held = words.held.get(kind)
        if set(figures.values()) == {figure.value}:
            own = isinstance(held, Mapping) and held.get(EVERYBODY, figure.value) != figure.value
            whom = Named(words.users)
            return words.acts([Drop(kind=kind, whom=whom, own=True)]) if own else _taken_off(words, kind, words.users)
    if not theirs:
        return words.line.ask("no_limit_of_its_own", users=of_users)
    kind, figures = next(iter(theirs.items()))
    stays = words.line.voice.constraints({kind: figures})
    return words.line.ask("not_promised", text=figure.text, users=of_users, constraints=stays)


def _taken_off(words: Words, kind: str, users: tuple[str, ...]) -> Intent:
    """A limit taken off some users; a ceiling of all is written out for the others, as there is none for nobody."""
    gone = _figures_of(words, kind, users)
    if not gone:
        return words.line.ask("no_limit_of_its_own", users=words.line.voice.users(users))
    acts: list[Act] = [Drop(kind=kind, whom=Named(users))]
    held = words.held[kind]
    if kind == "max_rate_bps" and (isinstance(held, float) or EVERYBODY in cast("Mapping[str, float]", held)):
        names = words.line.context.user_names
        free = numbers_of(users, names)
        others = [_reference(name, place) for place, name in enumerate(names, start=1) if place not in free]
        rest = _figures_of(words, kind, tuple(others))
        acts = [Drop(kind=kind), *(Limit(kind=kind, value=value, whom=Named((user,))) for user, value in rest.items())]
    return words.acts(acts, {"taken_off": {kind: gone}})


def _figures_of(words: Words, kind: str, users: tuple[str, ...]) -> dict[str, float]:
    """What holds for each of these users who has such a limit, of its own or as everybody."""
    held = words.held.get(kind, {})
    figures = {user: held.get(user, held.get(EVERYBODY, 0.0)) if isinstance(held, Mapping) else held for user in users}
    return {user: figure for user, figure in figures.items() if isinstance(figure, float) and figure > 0}


def _reference(name: str, place: int) -> str:
    return str(place) if name.lower() == f"user {place}" else name


def restored(words: Words) -> Intent | None:
    """ "put the cap back": the limit that was taken off last."""
    gone, named = {act.kind for act in words.last(Drop)}, words.named_kinds()
    back = gone & {*named} if words.has(*NOUNS) else gone
    return words.line.command("undo", steps=1.0) if back and not words.last(Limit) else None


def exempted(words: Words) -> Intent | None:
    """ "Not for seven, he's fine without": the limit that was said last, taken off these users."""
    users, kinds = words.users, {act.kind for act in words.last(Limit, Scale)}
    shared = any(token.factor for token in words.tokens)
    if not users or words.figures or shared or len(kinds) != 1 or not kinds <= {*UNITS["rate"]}:
        return None
    return _taken_off(words, kinds.pop(), users)
