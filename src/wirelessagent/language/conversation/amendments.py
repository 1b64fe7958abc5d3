"""Lines that change what was said before: "make that user 3", "no, I meant 2 Mbit/s", "user 2 needs no limit any more".

What "that" refers to is what the last request stated. Users whose own figure goes are written out, as the request has
no figure for "nothing": 1 Mbit/s for everybody but user 2 is 1 Mbit/s for each of the others.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

from wirelessagent.language import forms
from wirelessagent.language.conversation.assent import is_assent
from wirelessagent.language.conversation.line import NAME, Line, group, has, is_all
from wirelessagent.language.followups import joined, merged, numbers_of, taken_in
from wirelessagent.language.intent import COMMANDS, EVERYBODY, FIGURES_OF_USERS, LISTS_OF_USERS, Constraint, Intent

_PREFIXES = {"k": 1e3, "m": 1e6, "g": 1e9}
_PLAUSIBLE = 100
"""How many times more or less a corrected figure may be for its unit to be clear."""
_RATES = ("min_rate_bps", "max_rate_bps")


def read_amendment(line: Line) -> Intent | None:
    """What a line changes of the request that holds or of a question that is open; None for any other line."""
    if line.context.awaits == "clarification":
        answer = _agreed(line) or _answered(line)
        if answer is not None:
            return answer
    if line.context.objective is None:
        return None
    readers = (_freed, _returned, _taken_in, _same_for, _other_user)
    if line.context.awaits != "clarification":  # what was stated last is of a line before the one that was asked about
        readers = (*readers, _other_figure, _other_number)
    for read in readers:
        intent = read(line)
        if intent is not None:
            return intent
    return None


def _agreed(line: Line) -> Intent | None:
    """A yes to "did you mean …?"."""
    context = line.context
    if context.guess is not None:
        return context.guess if is_assent(line.text) else None
    if context.offered is None or forms.plain_command(line.shape) != "confirm":
        return None
    if context.offered in COMMANDS:
        return line.command(context.offered)
    return line.allocate(context.offered, context.pending, amends=context.objective is not None)


def _answered(line: Line) -> Intent | None:
    """Bare figures after a question: they are for the users, and of the aim, that the question was about."""
    context = line.context
    objective = context.pending_objective or context.objective
    asked_about = context.pending_users or _users_with_rates(context.pending)
    if not (asked_about or context.pending_objective) or line.users:
        return None
    if not is_all("only_figures", line.wish) or any(figure.doubtful or figure.value <= 0 for figure in line.figures):
        return None
    values: dict[str, Constraint] = {}
    for figure in line.figures:
        rate = "max_rate_bps" if figure.comparator == "at_most" else "min_rate_bps"
        name = rate if figure.kind == "rate" else "max_power_w"
        if name in values:
            return None
        users = asked_about if figure.kind == "rate" else ()
        values[name] = dict.fromkeys(users, figure.value) if users else figure.value
    values = merged(context.pending, values)
    if objective is None:
        key = "rate_only" if "min_rate_bps" in values else "limits_only"
        return line.ask(key, values, constraints=line.voice.constraints(values))
    return line.allocate(objective, values, amends=context.objective is not None)


def _users_with_rates(pending: Mapping[str, Constraint]) -> tuple[str, ...]:
    """The users of the one rate that waits; nobody where it is everybody's, or there are several."""
    rates = [value for name, value in pending.items() if name in _RATES]
    only = rates[0] if len(rates) == 1 else None
    return tuple(only) if isinstance(only, Mapping) and EVERYBODY not in only else ()


def _other_user(line: Line) -> Intent | None:
    """ "Actually make that user 3": what was stated last is for somebody else."""
    match = is_all("that_user", line.wish)
    if match is None or not line.users or not has("corrects", line.wish):
        return None
    users, instead_of = line.users, ""
    open_ = line.context.awaits == "clarification"
    freed = None if open_ else _freed_instead(line, users)
    if freed is not None:
        return freed
    if group(match, "not", "other"):
        if len(users) != 2:
            return None
        users, instead_of = (users[:1], users[1]) if group(match, "not") else (users[1:], users[0])
    said = line.context.pending if open_ else line.context.stated
    changed = {name: _for_users(name, value, users, instead_of) for name, value in said.items()}
    moved = {name: value for name, value in changed.items() if value is not None}
    if open_ and moved:
        return line.allocate(str(line.context.objective), {**said, **moved}, amends=True)
    return _restated(line, moved) if moved else line.ask("what_of_user", users=line.voice.users(users))


def _freed_instead(line: Line, users: tuple[str, ...]) -> Intent | None:
    """The users whose limit goes in the place of those whose limit was taken off last; None where none was."""
    names, objective = line.context.user_names, str(line.context.objective)
    for name, stated in line.context.stated.items():
        held = line.context.constraints.get(name, {})
        if not isinstance(stated, Mapping) or isinstance(held, tuple):
            continue
        left = _by_user(held, names)
        if EVERYBODY in stated or numbers_of(stated, names) & numbers_of(left, names):
            continue
        before = {**left, **stated}
        gone = {
            user: figure for user, figure in before.items() if numbers_of((user,), names) & numbers_of(users, names)
        }
        rest = {user: figure for user, figure in before.items() if user not in gone}
        values: dict[str, Constraint] = {name: rest} if rest else {}
        return line.allocate(objective, values, amends=True, dropped=(name,), taken_off={name: gone}) if gone else None
    return None


def _for_users(name: str, value: Constraint, users: tuple[str, ...], instead_of: str) -> Constraint | None:
    """A statement with other users in it; None where it is about nobody, or about several in several ways."""
    if name in LISTS_OF_USERS:
        assert isinstance(value, tuple)
        kept = tuple(user for user in value if instead_of and user != instead_of)
        return tuple(dict.fromkeys((*kept, *users)))
    if name not in FIGURES_OF_USERS or isinstance(value, tuple):
        return None
    named = {user: figure for user, figure in value.items() if user != EVERYBODY} if isinstance(value, Mapping) else {}
    if instead_of in named:
        rest = {user: figure for user, figure in named.items() if user != instead_of}
        return {**rest, **dict.fromkeys(users, named[instead_of])}
    figures = set(named.values()) if isinstance(value, Mapping) else {value}
    return dict.fromkeys(users, figures.pop()) if len(figures) == 1 else None


def _other_figure(line: Line) -> Intent | None:
    """ "No, I meant 2 Mbit/s": what was stated last has another figure."""
    if len(line.figures) != 1 or line.users or not _is_another(line.wish):
        return None
    figure, stated = line.figures[0], line.context.stated
    names = _RATES if figure.kind == "rate" else ("max_power_w", "subcarrier_max_power_w", "circuit_power_w")
    held = [name for name in names if name in stated]
    if len(held) != 1 or figure.doubtful or figure.value <= 0:
        return None
    name, value = held[0], stated[held[0]]
    if figure.comparator in ("at_least", "at_most") and name in _RATES:
        name = "min_rate_bps" if figure.comparator == "at_least" else "max_rate_bps"
    if not isinstance(value, Mapping):
        return line.allocate(str(line.context.objective), {name: figure.value}, amends=True)
    if len(set(value.values())) > 1:
        users = [user for user in value if user != EVERYBODY]
        return line.ask("whose_figure", text=figure.text, users=line.voice.users(users))
    new: dict[str, Constraint] = {name: dict.fromkeys(value, figure.value)}
    return _restated(line, new) if name == held[0] else _restated(line, new, gone=held[0])


def _other_number(line: Line) -> Intent | None:
    """ "Make it 600": the figure that was stated last, in its own unit; asked about where that is not clear."""
    match = is_all("only_number", line.wish)
    held = [name for name in ("max_power_w", *_RATES) if name in line.context.stated]
    if match is None or line.users or line.figures or len(held) != 1 or not has("corrects", line.wish):
        return None
    name, stated = held[0], line.context.stated[held[0]]
    before = set(stated.values()) if isinstance(stated, Mapping) else {stated}
    if len(before) > 1 or isinstance(stated, tuple):
        return None
    old, said = float(str(before.pop())), float(match["number"])
    own = next((scale for scale in (1e9, 1e6, 1e3, 1.0, 1e-3) if old >= scale), 1e-3)
    new = said * (_PREFIXES[match["prefix"]] if match["prefix"] else min(own, 1.0) if name == "max_power_w" else own)
    if not old / _PLAUSIBLE <= new <= old * _PLAUSIBLE:
        return line.ask("unit_missing", text=match["number"])
    value: Constraint = dict.fromkeys(stated, new) if isinstance(stated, Mapping) else new
    return _restated(line, {name: value})


def _is_another(wish: str) -> bool:
    """Whether a line is a figure with words that correct one."""
    return is_all("that_figure", wish) is not None and has("corrects", wish) is not None


def _restated(line: Line, new: Mapping[str, Constraint], *, gone: str = "") -> Intent:
    """The request with what was stated last taken out, and this put in its place."""
    context = line.context
    values: dict[str, Constraint] = dict(new)
    for name in {*new, *([gone] if gone else [])}:
        rest = _without(context.constraints.get(name), context.stated.get(name))
        if rest is not None:
            values[name] = joined(name, rest, new[name]) if name in new else rest
    dropped = tuple(name for name in (*new, *([gone] if gone else [])) if name in context.constraints)
    return line.allocate(str(context.objective), values, amends=True, dropped=dropped)


def _without(held: Constraint | None, stated: Constraint | None) -> Constraint | None:
    """What is left of a constraint after the last statement of it is taken out."""
    if isinstance(held, tuple) and isinstance(stated, tuple):
        return tuple(user for user in held if user not in stated) or None
    if isinstance(held, Mapping) and isinstance(stated, Mapping):
        return {user: figure for user, figure in held.items() if user not in stated} or None
    return None


def _freed(line: Line) -> Intent | None:
    """ "User 2 does not need 1 Mbit/s any more": these users' limit goes, and no other."""
    context = line.context
    if not line.users and is_all("nobody_needs", line.wish):
        held = [name for name in _RATES if name in context.constraints]
        return line.allocate(str(context.objective), {}, amends=True, dropped=(held[0],)) if held else None
    if not line.users or not is_all("freed", line.wish) or not has("of_a_limit", line.wish):
        return None
    freed = numbers_of(line.users, context.user_names)
    names = ("weights",) if has("of_weights", line.wish) else ("max_rate_bps", "min_rate_bps")
    if names[0] != "weights" and not has("of_caps", line.wish):
        names = ("min_rate_bps", "max_rate_bps")
    for name in names:
        held = context.constraints.get(name)
        own = None if held is None or isinstance(held, tuple) else _by_user(held, context.user_names)
        if own is None or held is None or not freed & numbers_of(tuple(own), context.user_names):
            continue
        theirs = {user: figure for user, figure in own.items() if freed & numbers_of((user,), context.user_names)}
        if line.figures and {figure.value for figure in line.figures} != set(theirs.values()):
            asked, stays = line.figures[0].text, line.voice.constraints({name: theirs})
            return line.ask("not_promised", text=asked, users=line.voice.users(line.users), constraints=stays)
        rest = {user: figure for user, figure in own.items() if user not in theirs}
        if line.figures and isinstance(held, Mapping) and EVERYBODY in held:
            common = _of_everybody(held, theirs, freed, context.user_names)
            if common is not None:
                return line.allocate(str(context.objective), {name: common}, amends=True, dropped=(name,))
        values: dict[str, Constraint] = {name: rest} if rest else {}
        gone: dict[str, Constraint] = {name: {user: figure for user, figure in own.items() if user not in rest}}
        return line.allocate(str(context.objective), values, amends=True, dropped=(name,), taken_off=gone)
    return line.ask("no_limit_of_its_own", users=line.voice.users(line.users))


def _of_everybody(
    held: Mapping[str, float], theirs: Mapping[str, float], freed: set[int | str], user_names: Sequence[str]
) -> Mapping[str, float] | None:
    """What is left where the own figures of some go and everybody's holds for them too; None where they have none."""
    left = {user: figure for user, figure in held.items() if not freed & numbers_of((user,), user_names)}
    return left if len(left) < len(held) and held[EVERYBODY] not in theirs.values() else None


def _by_user(held: float | Mapping[str, float], user_names: Sequence[str]) -> dict[str, float]:
    """Figures by user with everybody written out."""
    figures: dict[str, float] = {**held} if isinstance(held, Mapping) else {EVERYBODY: held}
    for_all = figures.pop(EVERYBODY, None)
    if for_all is None:
        return figures
    named = numbers_of(tuple(figures), user_names)
    rest = [place for place in range(1, len(user_names) + 1) if place not in named]
    return {**figures, **{_reference(user_names[place - 1], place): for_all for place in rest}}


def _reference(name: str, place: int) -> str:
    return str(place) if name.lower() == f"user {place}" else name


def _taken_in(line: Line) -> Intent | None:
    """ "Also serve user 2": a user more, where only some are served."""
    context = line.context
    if is_all("everyone_in", line.wish):
        back = tuple(name for name in LISTS_OF_USERS if name in context.constraints)
        if not back:
            return line.ask("all_served")
        return line.allocate(str(context.objective), {}, amends=True, dropped=back)
    if not line.users or line.figures or not is_all("taken_in", line.wish):
        return None
    return _served(line, line.users)


def _same_for(line: Line) -> Intent | None:
    """ "User 3 too": what was stated last of a user holds for another one as well."""
    if not line.users or line.figures or not is_all("same_for", line.wish):
        return None
    values: dict[str, Constraint] = {}
    for name, value in line.context.stated.items():
        if name in LISTS_OF_USERS and isinstance(value, tuple):
            held = line.context.constraints.get(name, value)
            values[name] = tuple(dict.fromkeys((*(held if isinstance(held, tuple) else ()), *line.users)))
        elif isinstance(value, Mapping) and len(set(value.values())) == 1:
            values[name] = dict.fromkeys(line.users, next(iter(value.values())))
    return line.allocate(str(line.context.objective), values, amends=True) if values else None


def _returned(line: Line) -> Intent | None:
    """ "User 3 is here again": who is back is served again, and "he" is the one who was left out."""
    if line.figures or not is_all("back", line.wish):
        return None
    users, left_out = line.users, line.context.constraints.get("leave_out")
    if not users and isinstance(left_out, tuple):
        if len(left_out) > 1:
            return line.ask("who_is_back", users=line.voice.users(left_out))
        users = left_out
    return _served(line, users) if users else None


def _served(line: Line, users: tuple[str, ...]) -> Intent:
    """These users served too; asked about where they are served already."""
    values, dropped = taken_in(users, line.context)
    if not values and not dropped:
        return line.ask("served_already", users=line.voice.users(users))
    return line.allocate(str(line.context.objective), values, amends=True, dropped=dropped)


def keeping_what_holds(line: Line, intent: Intent) -> Intent:
    """A request as a change of the one that holds, or in its place where it starts over; other intents as they are.

    Replacing it would let a power limit go, or a rate that was promised, because a line names an aim and any other
    figure: that is for the operator to say. What was read by its conversation alone is what it is.
    """
    objective = line.context.objective
    if intent.kind != "allocate" or objective is None or intent.recogniser == NAME:
        return intent
    if not has("starts_over", line.shape):
        return dataclasses.replace(intent, amends=True)
    aims = intent.objective != objective or "objective" in intent.evidence
    return dataclasses.replace(intent, amends=False, dropped=()) if aims else intent
