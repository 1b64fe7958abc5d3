"""Words of five languages on one small set of English base words, so that the models learn from all at once.

The language of a line is told by the lists that have its words, and by its letters.

``base_words/<language>.tsv`` has a base word and the word forms that it stands for on each line: "langsamsten", "lente"
and 最慢 meet in "slow". Latin words that are not listed stand for themselves; Chinese is cut into the longest listed
expressions.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from wirelessagent.language.deferred import deferred
from wirelessagent.language.text import has_chinese, is_chinese, unaccented

FOLDER = Path(__file__).with_name("base_words")
_SMALL = frozenset(("the", "a", "and", "of", "in", "to", "it", "be"))
_TELLING = 3
"""How much speaks for a language, or for it rather than another, where it surely is that one: more than a word."""
_ALONE = 2
"""What a word counts that no other language lists; one of English counts 1, as such are said in any."""
_WORD = deferred(r"[^\W\d_]{2,}")
_LETTERS = {"es": "ñ¿¡", "fr": "çêœàùèîû", "de": "ßäöü"}


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
def _bases() -> frozenset[str]:
    return frozenset(base for path in FOLDER.glob("*.tsv") for base in _base_words(path.stem).values())


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


def language_of(text: str) -> str:
    """The language of a sentence: "zh" where a Chinese character stands, else "es", "fr" or "de" where its words and
    letters outweigh those of English, the first of these where two do alike, else "en".

    >>> language_of("boost 速度"), language_of("boost the speed"), language_of("la potencia más baja")
    ('zh', 'en', 'es')
    """
    if has_chinese(text):
        return "zh"
    counts = _counts(text)
    best = max(counts, key=lambda language: counts[language])
    return best if counts[best] > counts["en"] else "en"


def language_in_a_talk(text: str, before: str) -> str:
    """The language of a line: that of the talk before it, "" at its start, unless its own words tell another clearly.

    >>> language_in_a_talk("plus 6", "en"), language_in_a_talk("mejor 2 Mbit/s", "es"), language_in_a_talk("10 W", "zh")
    ('en', 'es', 'zh')
    >>> language_in_a_talk("and what is the rate of user 3?", "es"), language_in_a_talk("no", "")
    ('en', 'en')
    """
    own = language_of(text)
    if not before or own == "zh":
        return own
    counts, words = _counts(text), len(_WORD.findall(text))
    if before == "zh":
        return own if words > 1 else before
    ahead = counts[own] - counts[before]
    return own if ahead >= _ALONE or (ahead > 0 and words > 1) else before


def languages_of(text: str) -> tuple[str, ...]:
    """The languages that a sentence may be in: all of them where its words hardly tell.

    >>> languages_of("save the power"), languages_of("10 W")
    (('en',), ('en', 'es', 'fr', 'de'))
    """
    if has_chinese(text):
        return ("zh",)
    counts = _counts(text)
    best = max(counts.values())
    return tuple(language for language, count in counts.items() if count == best or best < _TELLING)


@functools.lru_cache(maxsize=64)
def _counts(text: str) -> Mapping[str, int]:
    """How much the words and letters of a sentence speak for each language."""
    small = text.lower()
    counts: dict[str, int] = dict.fromkeys(("en", "es", "fr", "de"), 0)
    for word in map(unaccented, _WORD.findall(small)):
        listing = [language for language in counts if _lists(language, word)]
        for language in listing:
            counts[language] += 1 if language == "en" or len(listing) > 1 else _ALONE
    for language, letters in _LETTERS.items():
        counts[language] += 2 * sum(small.count(letter) for letter in letters)
    return counts


def _lists(language: str, word: str) -> bool:
    """Whether a language lists a word, in lower case and without accents; base words are English."""
    return word in _base_words(language) or (language == "en" and word in _bases())
