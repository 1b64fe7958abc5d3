"""All that the agent says, by key: one file of messages for each language, and one function that says them.

``messages/<language>.toml`` holds sentences with ``{place}`` fields, in tables by topic, all of them in each language.
A language more is one more file; what it does not have yet is said in English. Beside sentences are told tables for
people, and events while a piece of work is running.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias, cast

from wirelessagent.model.legible import legible

_MESSAGES = Path(__file__).with_name("messages")
_NAMES = frozenset({"user", "name", "station", "method", "recogniser"})
"""Places for what has a name of its own."""
_NUMBERED = re.compile(r"(?i)user\s*(\d+)")
_SEVERAL = 3
"""So many users are named by their numbers alone."""
_FIRST_WORD = re.compile(r"[^\W\d_]+(?![^\s,:'’])")


class Said(str):
    """What is said, and what it was said by: the key of its message and its places, or the messages it is made of."""

    key: str
    places: Mapping[str, object]
    parts: tuple[Said, ...]

    def __new__(
        cls, text: str, key: str = "", places: Mapping[str, object] | None = None, parts: tuple[Said, ...] = ()
    ) -> Said:
        said = super().__new__(cls, text)
        said.key, said.places, said.parts = key, places or {}, parts
        return said

    def messages(self) -> list[dict[str, Any]]:
        """The key and the places of each message in this, as plain data; places may hold messages themselves."""
        own = [{"key": self.key, "places": {name: _plain(value) for name, value in self.places.items()}}]
        return [*(own if self.key else []), *(one for part in self.parts for one in part.messages())]


def _plain(value: object) -> Any:
    if isinstance(value, Said) and (value.key or value.parts):
        return value.messages()
    if isinstance(value, str):
        return str(value)
    if hasattr(value, "item"):  # a figure of NumPy's
        return cast("Any", value).item()
    return value if isinstance(value, int | float) else str(value)


def message(language: str, key: str, /, **places: object) -> Said:
    """The message of this key in the operator's language, with its places filled in.

    >>> message("en", "stage.repaired", missing=3, method="dual"), message("zh", "status.optimal")
    ('3 gains filled by dual', '最优')
    """
    filled = {
        place: called(language, value) if place in _NAMES and isinstance(value, str) else value
        for place, value in places.items()
    }
    text = _text(language, key)
    said = text.format(**filled)
    if text.startswith("{") and text.endswith((".", "?")):
        word = _FIRST_WORD.match(said)  # a sentence begins with a capital; an identifier such as "ue_3" stays as it is
        said = said[0].upper() + said[1:] if word is not None and word[0].islower() else said
    return Said(said, key, places)


def has_message(language: str, key: str) -> bool:
    """Whether there is something to say for a key."""
    return key in messages(language) or key in messages("en")


def _text(language: str, key: str) -> str:
    own = messages(language)
    return own[key] if key in own else messages("en")[key]


def called(language: str, name: str) -> str:
    """A user, a method or the like by name, as the operator's language calls it where it has no name of its own.

    A name stays within its line, so that none can add a line to what is said.

    >>> called("zh", "user 3"), called("zh", "Ada"), called("en", "user 3"), called("zh", "dual")
    ('用户3', 'Ada', 'user 3', '对偶法')
    """
    name, own = legible(name, keep=""), messages(language)
    number = _NUMBERED.fullmatch(name)
    if number is not None and language != "en" and "whom.user" in own:
        return own["whom.user"].format(number=number[1])
    return own.get(f"name.{name}") or own.get(f"legend.{name}", name)


def joined(language: str, sentences: Iterable[str]) -> Said:
    """Sentences one after the other, as the language sets them."""
    return lines_of(sentences, gap=_text(language, "text.gap"))


class Voice:
    """Whoever speaks one language: says messages in it, and puts sentences together."""

    language: str

    def say(self, key: str, /, **places: object) -> Said:
        """A message in the operator's language."""
        return message(self.language, key, **places)

    def joined(self, *sentences: str) -> Said:
        """Sentences one after the other; those that are empty are left out."""
        return joined(self.language, sentences)


def lines_of(sentences: Iterable[str], *, gap: str = "\n") -> Said:
    """Sentences, a line each, or with another gap between them; those that are empty are left out."""
    said = [one for one in sentences if one]
    return Said(gap.join(said), parts=tuple(one for one in said if isinstance(one, Said)))


def listed(language: str, names: Iterable[str]) -> str:
    """Users, methods or the like in a row.

    >>> listed("en", ["user 1", "user 2", "user 4"]), listed("en", ["user 1", "Ada"]), listed("zh", ["user 1"])
    ('users 1, 2 and 4', 'user 1 and Ada', '用户1')
    """
    given = list(names)
    numbers = [number[1] for number in map(_NUMBERED.fullmatch, given) if number is not None]
    if len(numbers) == len(given) >= _SEVERAL:
        return message(language, "whom.users", numbers=in_a_row(language, numbers))
    return in_a_row(language, [called(language, name) for name in given])


def in_a_row(language: str, said: Sequence[str], last: str = "and") -> str:
    """What is said in a row, with "and", "or" or "either" before the last."""
    head = [message(language, "text.comma").join(said[:-1])] if len(said) > 1 else []
    return message(language, f"text.{last}").join([*head, *said[-1:]])


def goal_named(objective: str, otherwise: str, language: str) -> str:
    """What a built-in objective is called; one of a plug-in is called otherwise."""
    key = f"goal.{objective}"
    return message(language, key) if has_message(language, key) else otherwise


def capital(said: str) -> str:
    """The same with a capital at its beginning."""
    return said[:1].upper() + said[1:]


@functools.cache
def messages(language: str) -> Mapping[str, str]:
    """The messages that the file of a language holds, by key; none where there is no such file."""
    if language not in languages():
        return {}
    import tomllib  # which whoever asks for help only need not wait for

    return dict(_flat(tomllib.loads((_MESSAGES / f"{language}.toml").read_text(encoding="utf-8"))))


def _flat(topics: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, str]]:
    """The messages of nested tables by dotted keys."""
    for name, held in topics.items():
        if isinstance(held, str):
            yield above + name, held
        else:
            yield from _flat(held, f"{above}{name}.")


@functools.cache
def languages() -> frozenset[str]:
    """The languages that there are messages in."""
    return frozenset(file.stem for file in _MESSAGES.glob("*.toml"))


@dataclass(frozen=True, kw_only=True)
class Table:
    """All cells are text; numbers come with their units in the column's name or in the cell."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, kw_only=True)
class Event:
    """Something that just happened.

    Attributes:
        stage: "read", "understand", "note", "sense", "repair", "decide", "act" or the name of a piece of long work.
        message: one sentence for the user.
        done, total: how far counted work has come; both 0 where nothing is counted.
        language: of the message.
    """

    stage: str
    message: str
    done: int = 0
    total: int = 0
    language: str = "en"

    @property
    def label(self) -> str:
        """What the stage is called."""
        key = f"doing.{self.stage}"
        return message(self.language, key) if has_message(self.language, key) else self.stage


Progress: TypeAlias = Callable[[Event], None]


def silent(event: Event) -> None:
    """A progress listener for callers that want none."""
    del event
