"""Lines that say who is served: "user 7 back in", "take 7 off the list", "serve everybody again"."""

from __future__ import annotations

from wirelessagent.language.acts import Everybody, LeaveOut, Limit, Named, Scale, Serve
from wirelessagent.language.conversation.tokens import UNITS, Words
from wirelessagent.language.intent import Intent


def all_served(words: Words) -> Intent | None:
    """ "serve everybody again", "let the other five in": nobody is left out any more."""
    served, out = words.listed("users"), words.listed("leave_out")
    missing = len(words.line.context.user_names) - len(served) if served else len(out)
    counted = [figure.value for figure in words.figures]
    some, names = missing or (served and words.has("every")), len(words.line.context.user_names)
    if not some and words.has("every"):
        return words.line.ask("all_served")
    return words.acts([Serve(whom=Everybody())]) if some and counted in ([], [missing], [names]) else None


def of_whom(words: Words) -> tuple[str, ...]:
    """The users of a line that says no figure: by name, by number, or the one who was spoken of."""
    if words.users:
        return () if words.figures else words.users
    return words.counted() or (words.spoken_of.users if words.spoken_of else words.about)


def served(words: Words) -> Intent | None:
    """ "user 7 back in", and "he is back", who is the one who was left out."""
    users, alone, out = of_whom(words), words.listed("users"), words.listed("leave_out")
    if not users and words.has("pronoun", "one", "it") and not words.figures:
        if len(out) > 1:
            return words.line.ask("who_is_back", users=words.line.voice.users(out))
        users = out
    if words.has("at_most") or words.has_another("leave", "serve"):  # "serve only user 2"
        return None
    served = set(users) <= {*alone} if alone else not set(users) & {*out}
    if users and served and words.users:
        return words.line.ask("served_already", users=words.line.voice.users(users))
    return words.acts([Serve(whom=Named(users))]) if users and not served else None


def left_out(words: Words) -> Intent | None:
    """ "take 7 off the list"."""
    users, lists = of_whom(words), words.last(LeaveOut, Serve)
    if words.figures and words.has("step") and {act.kind for act in words.last(Limit, Scale)} & {*UNITS["power"]}:
        return None  # "enlève 2" behind a power
    leans = bool(lists) or not words.is_read or words.spoken_of is not None
    leans = leans and not words.has_another("serve", "leave")
    return words.acts([LeaveOut(whom=Named(users))]) if users and leans else None
