"""Words of five languages on one small set of English base words, so that the models learn from all at once.

``base_words/<language>.tsv`` has a base word and the word forms that it stands for on each line: "langsamsten", "lente"
and 最慢 meet in "slow". Latin words that are not listed stand for themselves; Chinese is cut into the longest listed
expressions.
"""

from __future__ import annotations

import functools
import itertools
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
    return [base for base, _ in _expressions(tokens, language) if base and base not in _SMALL]


def aligned(tokens: Sequence[str], language: str) -> list[str]:
    """For each of a sentence's tokens its base word, that of a Chinese expression for each of its characters.

    >>> aligned(["die", "langsamsten", "xqzt"], "de")
    ['the', 'slow', 'xqzt']
    """
    found = list[str]()
    for base, size in _expressions(tokens, language):
        found += [base or tokens[len(found)]] * size
    return found


def is_listed(word: str) -> bool:
    """Whether a language lists a word, in lower case and without accents; a Chinese character within an expression.

    >>> is_listed("langsamsten"), is_listed("xqzt")
    (True, False)
    """
    return word in _listed()


@functools.cache
def _listed() -> frozenset[str]:
    words = [word for path in FOLDER.glob("*.tsv") for word in _base_words(path.stem)]
    return frozenset((*words, *(sign for word in words if is_chinese(word) for sign in word)))


def _expressions(tokens: Sequence[str], language: str) -> Iterator[tuple[str, int]]:
    """The base words of tokens, or of the longest listed expression where Chinese begins, and of how many it is.

    A Chinese character that is in no listed expression has none.
    """
    own, english, chinese = (_base_words(each) for each in (language, "en", "zh"))
    place, longest = 0, _longest("zh")
    while place < len(tokens):
        token, size = tokens[place], 1
        run = "".join(itertools.takewhile(is_chinese, tokens[place : place + longest]))
        if run:
            size = next((size for size in range(len(run), 0, -1) if run[:size] in chinese), 1)
            yield chinese.get(run[:size], ""), size
        else:
            yield own.get(token) or (english.get(token, token) if language == "zh" else token), size
        place += size


@functools.cache
def _base_words(language: str) -> Mapping[str, str]:
    path = FOLDER / f"{language}.tsv"
    if not path.is_file():
        return {}
    lines = (line.split("\t") for line in path.read_text(encoding="utf-8").splitlines())
    return {word: base for base, words in lines for word in words.split(" ")}


@functools.cache
def _longest(language: str) -> int:
    return max(map(len, _base_words(language)), default=0)
