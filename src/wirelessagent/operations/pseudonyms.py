"""User names as pseudonyms, where ``WIRELESSAGENT_PSEUDONYM_KEY`` is set.

Names are exchanged at the two places where they come in: with a channel from a file, and in what is said of its users.
Everything behind these, what is decided, told, recorded and replayed, knows pseudonyms alone, and the same name has the
same one as long as the key stays. Without the key nobody can tell whose it is. Names that only count ("user 3") stay.
A name in a sentence that no user of the channel has stays, too, for nobody can tell it from any other word.
"""

from __future__ import annotations

import dataclasses
import hashlib
import hmac
import re
from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING

from wirelessagent.language.text import replaced
from wirelessagent.settings import PseudonymSettings

if TYPE_CHECKING:
    from wirelessagent.model.scene import Scene

_COUNTED = re.compile(r"user \d+")
_CONSONANTS, _VOWELS = "bdfghjklmnprstvz", "aiou"
_SHAPE = "CVCVCCVCVC"
"""Of a pseudonym before its check: 32 bits that can be said (as proquints are, arXiv:0901.4016)."""

_SIGNS = r"\u3040-\u30ff\u3400-\u9fff"
_WORD = re.compile(rf"[{_SIGNS}]|[^\W{_SIGNS}]+|[^\w\s]")
"""Words; each sign of a script without spaces is one."""

_LONGEST_NAME = 6
"""In words."""


def pseudonym(name: str, key: str) -> str:
    """The pseudonym of a name; of a pseudonym itself.

    >>> pseudonym("Alice", "a key of sixteen") == pseudonym("alice", "a key of sixteen")
    True
    """
    if _COUNTED.fullmatch(name) or (len(name) == len(_SHAPE) + 2 and name[-2:] == _letters(name[:-2], key, "CV")):
        return name
    said = _letters(name.casefold(), key, _SHAPE)
    return said + _letters(said, key, "CV")


def hidden_scene(scene: Scene) -> Scene:
    """The scene with its users under pseudonyms, where they are to have these."""
    key = _key()
    if key is None:
        return scene
    names = tuple(pseudonym(name, key) for name in scene.sensed.user_names)
    facts = {**scene.facts, **({"users": ", ".join(names[:8])} if "users" in scene.facts else {})}
    return dataclasses.replace(scene, sensed=dataclasses.replace(scene.sensed, user_names=names), facts=facts)


def hidden_text(text: str, user_names: Collection[str]) -> str:
    """What was said with the pseudonyms of users in the places of their names."""
    key = _key()
    if key is None:
        return text
    return replaced(text, _named(text, frozenset(user_names), key))


def _named(text: str, known: Collection[str], key: str) -> Iterator[tuple[int, int, str]]:
    """Where a name stands and the pseudonym of it, the longest names first."""
    words, first = [found.span() for found in _WORD.finditer(text)], 0
    while first < len(words):
        for last in range(min(first + _LONGEST_NAME, len(words)) - 1, first - 1, -1):
            start, stop = words[first][0], words[last][1]
            said = pseudonym(text[start:stop], key)
            if said in known:
                yield start, stop, said
                first = last
                break
        first += 1


def _letters(of: str, key: str, shape: str) -> str:
    number = int.from_bytes(hmac.digest(key.encode(), f"{shape} {of}".encode(), hashlib.sha256)[:8], "big")
    found = list[str]()
    for kind in shape:
        letters = _CONSONANTS if kind == "C" else _VOWELS
        number, place = divmod(number, len(letters))
        found.append(letters[place])
    return "".join(found)


def _key() -> str | None:
    key = PseudonymSettings.read().pseudonym_key
    return None if key is None else key.get_secret_value()
