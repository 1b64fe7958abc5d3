"""What a sentence says of the whole cell, without a figure of its own: blocks, shares of the power, counts of users.

Counts describe the channel where all users are meant ("for our 8 users"); a part of the users, and a half of something,
raise a doubt.
"""

from __future__ import annotations

from collections.abc import Sequence

from wirelessagent.language import figure_words
from wirelessagent.language.clauses import clause_end, clause_start
from wirelessagent.language.numerals import numbers
from wirelessagent.language.stated import Notes, Span
from wirelessagent.language.surroundings import describes_all


def take_blocks(notes: Notes) -> None:
    """How many subcarriers go together: "in groups of 4"."""
    match = figure_words.BLOCKS.search(notes.plain)
    if match is None or match.lastgroup is None:
        return
    word, place = match[match.lastgroup], match.start(match.lastgroup)
    said = next((number.value for number in numbers(notes.plain) if number.start == place), None)
    size = int(figure_words.BLOCK_WORDS.get(word) or said or 0)
    if size < 1 and word.isalpha():
        return  # "groups of users"
    notes.spoken_for.append(match.span())
    notes.masked.append(match.span())
    if size < 1:
        notes.doubt("impossible", text=notes.text[slice(*match.span())])
    else:
        notes.put("resource_block_group_size", float(size), match.span())


def take_share(notes: Notes, max_power_w: float) -> None:
    """A share of the power, of the cell's limit: "with half the power"."""
    match = figure_words.SHARE.search(notes.plain)
    before = notes.plain[: match.start()] if match is not None else ""
    if match is None or figure_words.CHANGE_BEFORE.search(before):
        return
    if any(each.start < match.start() < each.end for each in notes.quantities):  # "two and a half watts"
        return
    group = match.lastgroup or ""
    tenths = figure_words.TENTHS.get(match[group]) if group.endswith("tenths") else None
    share = figure_words.SHARES.get(group) or tenths or float(match[group]) / 100
    notes.spoken_for.append(match.span())
    notes.masked.append(match.span())
    if 0 < share <= 1:
        notes.put("max_power_w", share * max_power_w, match.span())
    else:
        notes.doubt("impossible", text=notes.text[slice(*match.span())])


def take_counts(notes: Notes, recounted: Sequence[Span], allotted: Sequence[Span]) -> None:
    """How many users there are is the channel's affair; to pick some of them without naming them is a doubt.

    ``recounted`` are counts of users who are named, ``allotted`` spans that speak of named users.
    """
    taken = [*((figure.start, figure.end) for figure in notes.quantities), *notes.spoken_for, *allotted]
    for match in figure_words.COUNTED_USERS.finditer(notes.plain):
        described = any(match.start() <= start < match.end() for start, _ in recounted)
        if described or any(start <= match.start() < end for start, end in taken):
            continue
        words = notes.text[slice(*match.span())]
        notes.counted.append(match.span())
        if describes_all(*_clause_around(notes, *match.span())):
            notes.not_used.append(words)
        else:
            notes.doubt("some_users", text=words)


def doubt_parts(notes: Notes, allotted: Sequence[Span]) -> None:
    """Some of the users, half of something, nobody at all: each a question."""
    settled = [*notes.spoken_for, *allotted, *notes.counted]
    for key, pattern in (
        ("some_users", figure_words.SOME_USERS),
        ("change", figure_words.HALVED),
        ("change", figure_words.OTHERS_HALVED),
        ("some_users", figure_words.NOBODY),
    ):
        match = pattern.search(notes.plain)
        if match is None:
            continue
        if pattern is figure_words.HALVED and any(a < match.end() and match.start() < b for a, b in settled):
            continue
        if any(start <= match.start() and match.end() <= end for start, end in allotted):  # "odd-numbered users"
            continue
        notes.doubt(key, text=notes.text[slice(*match.span())])


def _clause_around(notes: Notes, start: int, end: int) -> tuple[str, str]:
    """What stands before and after a span within its clause, figures being borders too."""
    plain = notes.plain
    from_ = max([0, *(figure.phrase_end for figure in notes.quantities if figure.phrase_end <= start)])
    to = min([len(plain), *(figure.phrase_start for figure in notes.quantities if figure.phrase_start >= end)])
    return plain[clause_start(plain, start, from_) : start], plain[end : clause_end(plain, end, to)]
