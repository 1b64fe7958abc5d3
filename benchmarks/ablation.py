"""The guard without each of its parts: how many sentences are then acted upon wrongly, how many needlessly asked.

Run with ``python benchmarks/ablation.py [FILE.jsonl…]`` (files as ``bars_frames.py`` reads them; without one, the
sentences of ``bars_composed.py``); each sentence is said first and where a request holds. Parts are the views that the
judge of orders has of a frame, the classes of mood, and the names of strangers. A part whose absence changes no figure
earns nothing on these sentences. The judge is not trained anew for each, so what a view is worth is rather overstated.
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

from wirelessagent.language import guard, order_model
from wirelessagent.language.figure_roles import View
from wirelessagent.language.moods import table_of
from wirelessagent.language.order_model import Frame

VIEWS = {"words": "w", "base words": "b", "classes, in place": "c", "classes, alone": "e"}
CLASSES = tuple(table_of("en"))


def figures(rows: list[dict[str, Any]]) -> tuple[int, int]:
    """Sentences acted upon wrongly, and plain ones asked about, first and later together."""
    said = [word for context in (FIRST, LATER) for _, word in score(rows, context)]
    return said.count("wrong act"), said.count("asked")


@contextlib.contextmanager
def without(part: str) -> Iterator[None]:
    """The guard without a part."""
    grams, classes_in = order_model._grams, order_model.classes_in

    def fewer(frame: Frame, known: frozenset[int]) -> Iterator[str]:
        return (gram for gram in grams(frame, known) if gram[0] not in VIEWS[part])

    if part in VIEWS:
        patch = mock.patch.object(order_model, "_grams", fewer)
    elif part == "names":
        patch = mock.patch.object(View, "strangers", return_value=[])
    else:
        patch = mock.patch.object(
            order_model, "classes_in", lambda plain: [one for one in classes_in(plain) if one[0].split(":")[0] != part]
        )
    with patch:
        yield


def main() -> None:
    rows = [row for argument in sys.argv[1:] for row in read(Path(argument))] or list(composed())
    print(f"{'without':20}{'wrong act':>12}{'asked':>12}")
    print("{:20}{:12}{:12}".format("(nothing)", *figures(rows)))
    for part in (*VIEWS, *CLASSES, "names"):
        with without(part):
            print("{:20}{:12}{:12}".format(part, *figures(rows)))
    with without("names"), mock.patch.object(guard, "doubted", return_value=None):
        print("{:20}{:12}{:12}".format("the whole guard", *figures(rows)))


if __name__ == "__main__":
    main()
