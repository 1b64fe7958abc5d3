"""Commands about the conversation itself and the method: how much to undo, what to cancel, which turn, solved by what.

The offline recogniser hears "undo" in "the people in the back can't hear us" and in "I didn't say undo". So what it
takes for apply, undo or start over is carried out only where every word of the line belongs to such a command
(:func:`made_certain`). A method that is named changes the request by the detail "method", "auto" for the objective's
own choice; one that is named beside a request goes with it.
"""

from __future__ import annotations

import dataclasses
import functools
import itertools
import re
from collections.abc import Mapping
from typing import Any

from wirelessagent.language import moods
from wirelessagent.language.acts import Drop, LeaveOut, Limit, Named, Prefer, Scale, Serve
from wirelessagent.language.conversation.line import Forms, Line, begins, form, has, is_all
from wirelessagent.language.intent import COMMANDS, OWN_CHOICE, Intent
from wirelessagent.language.number_words import cardinals
from wirelessagent.language.offline import NAME
from wirelessagent.language.text import lowered, normalise, replaced
from wirelessagent.language.topics import number_of, with_tool
from wirelessagent.language.word_tables import deferred, languages_with, table

_LISTED: Mapping[str, Any] = {
    language: table("talk_forms", language)["command"] for language in languages_with("talk_forms")
}
_COUNTS: Mapping[str, int] = {
    word: count
    for language, listed in _LISTED.items()
    if "counts" in listed
    for word, count in (*cardinals(1, 20, (language,)).items(), *listed["counts"].items())
}
_NO_REFERENCE = {word for listed in _LISTED.values() for word in listed.get("no_reference", "").split()}
"""What behind "turn" is no reference: "turn it off"."""
_CHANGING = ("apply", "undo", "reset")
_TAKING_BACK: Forms = {
    "all_steps": ("undo", {"steps": "all"}),
    "stop": ("reject", {"cancel": "pending", "stop": "all"}),
    "cancel": ("reject", {"cancel": "pending"}),
    "back_to_first": ("undo", {"turn": 1.0}),
    "back_to": ("undo", {}),
}
_ABOUT_A_TURN: Forms = {
    "compare_first": ("compare", {"turn": "first"}),
    "compare_turns": ("compare", {}),
    "explain_turn": ("explain", {}),
    "show_turn": ("history", {}),
}
_LONGEST = 120
"""Characters of a line that may be nothing but a command."""
_LATIN = deferred(r"[a-zß-ÿœ](?:[a-zß-ÿœ'’-]*[a-zß-ÿœ])?")
_LETTER = deferred(r"[^\W_]")


def read_command(line: Line) -> Intent | None:
    """The command about the conversation that a line is as a whole, or None."""
    said = line.wish.rstrip("? ").strip()
    if said != line.wish.strip() and not has("polite", line.shape):  # what is only asked about is not done
        return _about_a_turn(line, said)
    return _chosen(line) or _taken_up(line, said) or _undone(line, said) or _about_a_turn(line, said)


def _chosen(line: Line) -> Intent | None:
    """The one that a line takes of several ways that were offered."""
    match = is_all("choice", line.said) if line.context.offers else None
    if match is None:
        return None
    name = next(name for name, word in match.groupdict().items() if word)
    return line.answer.command("confirm", way=float(name.removeprefix("way")) if name != "last" else -1.0)


def _taken_up(line: Line, said: str) -> Intent | None:
    """A what-if that becomes the request, for "do that" right behind it."""
    context = line.context
    if not is_all("do_that", said) or context.awaits == "clarification":
        return None
    if (context.ways or context.offers) and context.awaits == "nothing":
        return line.answer.command("confirm", way="which")
    if context.supposed_objective is None or (context.awaits == "confirmation" and is_all("apply_it", said)):
        return None
    return line.allocate(context.supposed_objective, context.supposed, amends=False)


def _undone(line: Line, said: str) -> Intent | None:
    if is_all("forget", said):
        open_ = line.context.awaits != "nothing"
        return line.answer.command("reject", cancel="pending") if open_ else line.answer.command("reset")
    whole = by_form(line, said, _TAKING_BACK)
    if whole is not None:
        return whole
    match = is_all("some_steps", said)
    steps = "" if match is None else _number(match["n"].removeprefix("a "))
    return line.answer.command("undo", steps=steps) if isinstance(steps, float) and steps >= 1 else None


def _about_a_turn(line: Line, said: str) -> Intent | None:
    found = by_form(line, said, _ABOUT_A_TURN)
    return None if found is None or found.details["turn"] in _NO_REFERENCE else found


def by_form(line: Line, said: str, forms: Forms) -> Intent | None:
    """The command or the question of the first form that is all that is said, with the turns that it names."""
    for name, (topic, details) in forms.items():
        match = is_all(name, said)
        if match is not None:
            turns = {each: _number(word) for each, word in match.groupdict().items() if word}
            return (line.answer.command if topic in COMMANDS else line.answer.question)(topic, **details, **turns)
    return None


def _number(word: str) -> float | str:
    """The number that a word is, or the word that should have been one."""
    if re.fullmatch(r"[-+]?\d+(?:\.\d+)?", word):
        return float(word)
    if re.fullmatch("[一二两三四五六七八九十]+", word):
        return number_of(word)
    return float(_COUNTS[word]) if word in _COUNTS else word


def made_certain(line: Line, intent: Intent, text: str) -> Intent:
    """The command where a line is nothing else or it changes nothing, a question of yes or no in its place otherwise.

    ``text`` is all that was said; a line may be the beginning of it.
    """
    if not intent.recogniser.startswith(NAME):
        return intent
    topic = intent.topic if intent.kind == "command" and not is_only_a_command(text) else ""
    if topic not in _CHANGING and intent.offered not in _CHANGING:
        return intent
    if line.context.objective is not None and has("names_a_command", lowered(normalise(text))) is None:
        return line.answer.ask("what_changes", 1.0)
    if topic not in _CHANGING:
        return intent
    return line.answer.ask("unsure_command", 1.0, offered=topic, text=line.voice.say(f"command.{topic}"))


def is_only_a_command(text: str) -> bool:
    """Whether every word of a line belongs to a command, and none denies it, supposes it or asks about it.

    >>> is_only_a_command("oh no, please take that back"), is_only_a_command("he's back")
    (True, False)
    """
    plain = normalise(text).lower().strip()
    if len(plain) > _LONGEST:
        return False
    politely = itertools.chain.from_iterable(form("command_politely", language) for language in _LISTED)
    said = functools.reduce(lambda rest, polite: polite.sub(" ", rest), politely, plain)
    if said == plain and (plain.endswith("?") or moods.begins_like_a_question(plain)):
        return False
    latin, chinese, denies = _command_words()
    if denies.search(said):
        return False
    if any(word.replace("’", "'") not in latin for word in _LATIN.findall(said)):
        return False
    return not _LETTER.search(chinese.sub("", _LATIN.sub("", said)))


@functools.cache
def _command_words() -> tuple[frozenset[str], re.Pattern[str], re.Pattern[str]]:
    """The words that commands consist of, the Chinese ones as a pattern, the longest first, and what denies them."""
    denies = re.compile("|".join(each for listed in _LISTED.values() for each in listed.get("denies", ())))
    words = {language: listed["words"].split() for language, listed in _LISTED.items()}
    chinese = sorted(words.pop("zh"), key=len, reverse=True)
    return frozenset(itertools.chain.from_iterable(words.values())), re.compile("|".join(chinese)), denies


def read_alike(line: Line) -> Intent | None:
    """What was said last of some users, said of another one: "user 6 too"; "nor 6" of what takes something away."""
    context = line.context
    if context.objective is None or context.earlier[-1:] != (context.acts,) or context.awaits == "clarification":
        return None
    said = "" if line.is_asked else _with_its_user(line)
    denied = is_all("alike_denied", said) is not None
    if not denied and is_all("alike", said) is None:
        return None
    able = (LeaveOut, Drop) if denied else (LeaveOut, Drop, Limit, Scale, Serve)
    if any(isinstance(act, Drop) and not isinstance(act.whom, Named) for act in context.acts):
        return None  # "user 5 back in" says of the others, too, who goes on to be left out
    whose = [act for act in context.acts if isinstance(act, able) and isinstance(act.whom, Named)]
    users = line.anchored.named(len(context.user_names))
    of_one = (act for act in whose if act.whom == whose[-1].whom)
    alike = tuple(Serve(whom=Named(users)) if isinstance(act, Serve) else dataclasses.replace(act, whom=Named(users))
                  for act in of_one)  # fmt: skip
    return line.allocate(context.objective, {}, amends=True, acts=alike) if users and alike else None


def _with_its_user(line: Line) -> str:
    """What a line says, with a mark in the place of those whom it names first, by a number alone or by more."""
    anchors = [each for each in line.anchored.anchors if each.kind in ("users", "number")]
    spans = [(each.start, each.end, "@") for each in anchors[:1]]
    return lowered(replaced(line.anchored.plain, spans)).rstrip("?.。! ").strip()


def read_method(line: Line) -> Intent | None:
    """The change of the method, or what another one would make of the request; None for any other line."""
    if is_all("usual_method", line.said):
        return _solved_by(line, OWN_CHOICE)
    if is_all("which_methods", line.said):
        return line.answer.question("other", listed="methods")
    shape, name = with_tool(line.said, "method")
    if not name:
        return None
    if is_all("method_used", shape):
        return _solved_by(line, name)
    lead, end = begins("method_supposed", shape), has("method_supposed_end", shape)
    plain = shape if end is None else shape[: end.start()]
    asked = (lead is not None or plain != shape) and is_all("method_used", plain[lead.end() if lead else 0 :])
    if not asked and not is_all("method_gives", shape):
        return None
    if line.context.objective is None:
        return line.answer.question("other")
    return line.answer.command("compare", **{"with": name})


def _solved_by(line: Line, name: str) -> Intent:
    """The request that holds by another method; where none holds, a question that finds nothing to work on."""
    if line.context.objective is None:
        return line.answer.question("other")
    return line.allocate(line.context.objective, {}, amends=True, details={"method": name})


def beside_method(text: str) -> tuple[str, str] | None:
    """What is asked beside a method that a sentence says to use, and the method; None for any other sentence.

    >>> beside_method("use round robin and at least 1 Mbit/s for everyone")
    ('at least 1 Mbit/s for everyone', 'round_robin')
    """
    plain = " ".join(normalise(text).split()).rstrip("?.。! ")
    shape, name = with_tool(plain, "method")
    match = is_all("beside_method", shape) if name else None
    if match is None:
        return None
    start, end = match.span("rest")
    rest = plain[len(plain) - (len(shape) - start) :] if start else plain[:end]
    return None if is_all("only_courtesy", rest.lower()) else (rest, name)


def with_method(line: Line, intent: Intent, name: str) -> Intent | None:
    """A request by a method that is named beside it; None for what is neither a request nor a question back."""
    if intent.kind == "allocate":
        acts = (*intent.acts, Prefer(method="" if name == OWN_CHOICE else name)) if intent.acts else ()
        return dataclasses.replace(intent, details={**intent.details, "method": name}, acts=acts)
    if intent.kind != "clarify":
        return None
    later = line.voice.say("method_later", method_name=name)
    return dataclasses.replace(intent, reply=f"{intent.reply} {later}")


def by_method(line: Line, intent: Intent) -> Intent:
    """A request with the method that its sentence names beside it; any other intent as it is."""
    shape, name = with_tool(line.shape, "method")
    requests = intent.kind == "allocate" and name and has("with_method", shape)
    return (with_method(line, intent, name) if requests else None) or intent
