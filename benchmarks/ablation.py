"""The guard without each of its classes: how many sentences are then acted upon wrongly, how many needlessly asked.

Run with ``python benchmarks/ablation.py FILE.jsonl…`` (files as ``bars_frames.py`` reads them); each sentence is said
first and where a request holds. A class whose absence changes no figure earns nothing on these files.
"""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from unittest import mock

from bars_frames import FIRST, LATER, read, score

from wirelessagent.language import guard
from wirelessagent.language.intent import Intent
from wirelessagent.language.recogniser import Context

CLASSES = (*guard.MOODS, "names")


def figures(paths: Sequence[Path]) -> tuple[int, int]:
    """Sentences acted upon wrongly, and plain ones asked about, first and later together."""
    said = [word for path in paths for context in (FIRST, LATER) for _, word in score(read(path), context)]
    return said.count("wrong act"), said.count("asked")


def without(name: str, paths: Sequence[Path]) -> tuple[int, int]:
    """The figures with a class switched off."""
    with switched_off(name):
        return figures(paths)


@contextlib.contextmanager
def switched_off(*names: str) -> Iterator[None]:
    """The guard without these classes."""
    doubted, stranger = guard.doubted, guard.stranger

    def fewer(text: str, context: Context | None, intent: Intent, moods: Sequence[str]) -> guard.Doubt | None:
        return doubted(text, context, intent, [mood for mood in moods if mood not in names])

    with contextlib.ExitStack() as stack:
        stack.enter_context(mock.patch.object(guard, "doubted", fewer))
        stack.enter_context(mock.patch.object(guard, "stranger", (lambda *_: None) if "names" in names else stranger))
        yield


def main() -> None:
    paths = [Path(argument) for argument in sys.argv[1:]]
    if not paths:
        raise SystemExit("say which files: python benchmarks/ablation.py FILE.jsonl…")
    print(f"{'without':16}{'wrong act':>12}{'asked':>12}")
    print("{:16}{:12}{:12}".format("(nothing)", *figures(paths)))
    for name in CLASSES:
        print("{:16}{:12}{:12}".format(name, *without(name, paths)))
    with switched_off(*CLASSES):
        print("{:16}{:12}{:12}".format("the whole guard", *figures(paths)))


if __name__ == "__main__":
    main()
