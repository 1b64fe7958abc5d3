"""Words of five languages on one small set of English base words, so that the linear model learns from all at once.

``base_words/<language>.tsv`` has a word form and its base word on each line: "langsamsten", "plus lent" and 最慢 meet
in "slow". Latin words that are not listed stand for themselves; Chinese is cut into the longest listed expressions.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from wirelessagent.language.text import is_chinese

FOLDER = Path(__file__).with_name("base_words")
_SMALL = frozenset(("the", "a", "and", "of", "in", "to", "it", "be"))


def based(tokens: Sequence[str], language: str) -> list[str]:
    """The base words of a sentence's tokens, without the smallest words.

    ``tokens`` are lower case, without accents, Chinese by the character; ``language`` is "en", "zh", "es", "fr" or
    "de".

    >>> based(["dem", "langsamsten", "nutzer"], "de")
    ['slow', 'user']
    """
    own, english = _base_words(language), _base_words("en")
    found: list[str] = []
    run = ""
    for token in (*tokens, ""):
        if is_chinese(token):
            run += token
            continue
        found.extend(_cut(run, own))
        run = ""
        if token:
            found.append(own.get(token) or (english.get(token, token) if language == "zh" else token))
    return [word for word in found if word not in _SMALL]


def _cut(run: str, words: Mapping[str, str]) -> Iterator[str]:
    """The base words of the longest listed expressions in a run of Chinese characters, from left to right."""
    longest, place = _longest("zh"), 0
    while place < len(run):
        for size in range(min(longest, len(run) - place), 0, -1):
            word = words.get(run[place : place + size])
            if word is not None:
                yield word
                break
        else:
            size = 1
        place += size


@functools.cache
def _base_words(language: str) -> Mapping[str, str]:
    path = FOLDER / f"{language}.tsv"
    if not path.is_file():
        return {}
    pairs = (line.partition("\t") for line in path.read_text(encoding="utf-8").splitlines())
    return {word: base for word, _, base in pairs}


@functools.cache
def _longest(language: str) -> int:
    return max(map(len, _base_words(language)), default=0)
