"""Make the model of short talk lines anew: ``python -m wirelessagent.language.training.talk [FILE]``; half a minute.

It learns what a line does from ``talk/<language>.tsv``, a label and a line each, and that whole requests, questions and
remarks do none of it from the short sentences of :mod:`.spoken`.
"""

from __future__ import annotations

import dataclasses
import logging
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt

from wirelessagent.language.conversation.leaning import NONE, seen
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.conversation.tokens import tokens_of
from wirelessagent.language.features import BUCKETS, buckets, word_hashes
from wirelessagent.language.intent import COMMANDS
from wirelessagent.language.linear_model import TALK_FILE
from wirelessagent.language.recogniser import Context
from wirelessagent.language.training.compose import OBJECTIVES
from wirelessagent.language.training.fit import fit, known_words, matrix_of, save
from wirelessagent.language.training.spoken import spoken

TALK = Path(__file__).with_name("talk")
_LONGEST, _EVERY = 60, 3
_OTHER = ("question", "out_of_scope", *(f"command.{topic}" for topic in COMMANDS if topic not in ("undo", "reset")))
_RIDGE = 5e-7
_CONTEXT = Context(user_names=tuple(f"user {number}" for number in range(1, 9)), objective="max_rate")


Said = tuple[str, str, str]
"""A line, its label, and its language."""


def lines(folder: Path = TALK) -> Iterator[Said]:
    """The lines of all languages."""
    for path in sorted(folder.glob("*.tsv")):
        for each in path.read_text("utf-8").splitlines():
            label, line = each.split("\t")
            yield line, label, path.stem


def others() -> list[Said]:
    """Short sentences that do nothing to what was said before."""
    alone = [each for each in spoken() if each.label in (*OBJECTIVES, "none") or each.label.startswith(_OTHER)]
    return [(each.text, NONE, each.language) for each in alone if len(each.text) <= _LONGEST][::_EVERY]


def columns_of(text: str, language: str) -> tuple[npt.NDArray[np.int64], list[int]]:
    """The buckets that a line falls into, and the hashes of its words."""
    line = Line.of(text, dataclasses.replace(_CONTEXT, language=language))
    shown = seen(line, tokens_of(line, language, lenient=True) or (), language)
    return buckets(*shown), word_hashes(shown[0])


def main(path: Path) -> None:
    """Read, fit, write."""
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    said = [*lines(), *others()]
    labels, names = [label for _, label, _ in said], sorted({label for _, label, _ in said})
    found = [columns_of(text, language) for text, _, language in said]
    rows = matrix_of([columns for columns, _ in found], BUCKETS)
    weights, intercepts = fit(rows, labels, names, np.ones(len(said)), _RIDGE)
    save(path, names, weights, intercepts, known_words(words for _, words in found))
    told: list[int] = np.argmax(np.asarray(rows @ weights) + intercepts, axis=1).tolist()
    right = sum(names[guess] == label for guess, label in zip(told, labels, strict=True)) / len(said)
    logging.getLogger(__name__).info("%d lines, %.1f %% told apart; %s: %d kB", len(said), 100 * right, path.name,
                                     path.stat().st_size // 1000)  # fmt: skip


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else TALK_FILE)
