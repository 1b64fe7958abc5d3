"""Sentences written down as people say them, beside those drawn from templates: ``spoken/<language>.tsv``.

Each line is a label and a sentence. Labels are objectives and kinds of intents; what a question or a command is about
is left to the templates. They were written for training, by authors who saw no test set.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path


def spoken(folder: Path) -> Iterator[tuple[str, str]]:
    """(sentence, label) of all languages."""
    for path in sorted(folder.glob("*.tsv")):
        for line in path.read_text(encoding="utf-8").splitlines():
            label, _, text = line.partition("\t")
            yield text, label
