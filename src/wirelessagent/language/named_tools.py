"""Methods and repairers by the names that operators say: "equal power", "the paper's method", "等功率"."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping

from wirelessagent import plugins
from wirelessagent.language.deferred import deferred
from wirelessagent.language.word_tables import words_of
from wirelessagent.telling.catalogue import called, languages


def tools_named(text: str, *kinds: plugins.Kind) -> tuple[str, ...]:
    """The installed plug-ins of these kinds that are named, in their order.

    >>> tools_named("compare with equal power and the paper's method", "method")
    ('equal_power', 'paper')
    """
    spoken, pattern = _spoken(tuple(name for kind in kinds for name in plugins.names(kind)))
    return tuple(dict.fromkeys(spoken[match[0]] for match in pattern.finditer(_plain(text))))


def with_tool(text: str, kind: plugins.Kind) -> tuple[str, str]:
    """The words with "%" for the only plug-in that they name, and its name; "" where they name none or several.

    >>> with_tool("use the paper's method", "method")
    ("use the %'s method", 'paper')
    """
    spoken, pattern = _spoken(tuple(plugins.names(kind)))
    plain = _plain(text)
    found = list(pattern.finditer(plain))
    if len(found) != 1:
        return text, ""
    return f"{plain[: found[0].start()]}%{plain[found[0].end() :]}", spoken[found[0][0]]


def _plain(text: str) -> str:
    return re.sub(r"[-_\s]+", " ", text.lower().replace("’", "'"))


@functools.cache
def _spoken(names: tuple[str, ...]) -> tuple[Mapping[str, str], re.Pattern[str]]:
    """The plug-in that each name, as it is said or told in any language, means, and a pattern for all of them."""
    spoken = {said: name for name in names for said in (_plain(name), *words_of("talk_forms", "tools", name))}
    plain = _either(spoken)
    told = {_plain(called(language, name)): name for language in sorted(languages()) for name in names}
    for said, name in told.items():  # as the agent itself says them, where nothing in it says so already
        if {spoken[match[0]] for match in plain.finditer(said)} != {name}:
            spoken = {**spoken, said: name}
    return spoken, _either(spoken)


def _either(spoken: Mapping[str, str]) -> re.Pattern[str]:
    longest_first = sorted(spoken, key=len, reverse=True)
    either = "|".join(rf"\b{re.escape(said)}(?![a-z])" if said.isascii() else said for said in longest_first)
    return deferred(either or r"(?!)")
