"""The guard without each of its parts: how many sentences are then acted upon wrongly, how many needlessly asked.

Run with ``python benchmarks/ablation.py [FILE.jsonl…]`` (files as ``bars_frames.py`` reads them; without one, the
sentences of ``bars_composed.py``); each sentence is said first and where a request holds. Parts are what the network
sees of a word, the classes of mood, what it says of the reading, and the names of strangers. A part whose absence
changes no figure earns nothing on these sentences. The network is not taught anew for each, so what a part is worth is
rather overstated.
"""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest import mock

from bars_composed import composed
from bars_frames import FIRST, LATER, read, score

from wirelessagent.language import guard, sentence, sentence_model
from wirelessagent.language.figure_roles import View
from wirelessagent.language.moods import table_of

SEEN = {
    "the word as it is said": "w", "its letters": "c", "Chinese neighbours": "pt", "base words": "b",
    "what the lexicon knows": "C", "classes of mood": "m", "what is part of a wish": "@",
    "what it was read as": "r",
}  # fmt: skip
CLASSES = tuple(table_of("en"))
VERDICT, READINGS = "the lexicon's verdict", "whether it was read as meant"


def figures(rows: list[dict[str, Any]]) -> tuple[int, int]:
    """Sentences acted upon wrongly, and plain ones asked about, first and later together."""
    said = [word for context in (FIRST, LATER) for _, word in score(rows, context)]
    return said.count("wrong act"), said.count("asked")


@contextlib.contextmanager
def without(part: str) -> Iterator[None]:
    """The reader without a part."""
    hashed, marks = sentence_model.hashed, SEEN.get(part, "")

    def fewer(text: str) -> int:
        return 0 if text[0] in marks or text.startswith(f"m{part}:") else hashed(text)

    if part == "names":
        patch = mock.patch.object(View, "strangers", return_value=[])
    elif part == READINGS:
        patch = mock.patch.object(guard, "is_bent", return_value=False)
    elif part == VERDICT:
        patch = mock.patch.object(sentence, "START", mock.Mock(_replace=lambda moods: sentence_model.START))
    else:
        patch = mock.patch.object(sentence_model, "hashed", fewer)
    sentence._read.cache_clear()
    with patch:
        yield


def main() -> None:
    rows = [row for argument in sys.argv[1:] for row in read(Path(argument))] or list(composed())
    print(f"{'without':28}{'wrong act':>12}{'asked':>12}")
    print("{:28}{:12}{:12}".format("(nothing)", *figures(rows)))
    for part in (*SEEN, *CLASSES, VERDICT, READINGS, "names"):
        with without(part):
            print("{:28}{:12}{:12}".format(part, *figures(rows)))
    with without("names"), mock.patch.object(guard, "doubted", return_value=None):
        print("{:28}{:12}{:12}".format("the whole guard", *figures(rows)))


if __name__ == "__main__":
    main()
