"""Sentences written down as people say them, beside those drawn from templates: ``spoken/<language>.tsv``.

Each line is a label, a sentence, and for a request its constraints as JSON in SI units, where they are known. Labels
are objectives, kinds of intents, and topics of questions and commands. They were written for training, by authors who
saw no test set.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from wirelessagent.model.errors import InputError

SPOKEN = Path(__file__).with_name("spoken")


@dataclass(frozen=True, kw_only=True)
class Spoken:
    """A sentence with its label; ``constraints`` are None where nobody wrote them down."""

    text: str
    label: str
    language: str
    constraints: Mapping[str, Any] | None = None


def spoken(folder: Path = SPOKEN) -> Iterator[Spoken]:
    """The sentences of all languages.

    Raises:
        InputError: they are not here; an installed package leaves them out.
    """
    paths = sorted(folder.glob("*.tsv"))
    if not paths:
        raise InputError(f"no sentences in {folder}: train from a checkout of the sources, which has them")
    for path in paths:
        for line in path.read_text(encoding="utf-8").splitlines():
            label, text, *more = line.split("\t")
            yield Spoken(text=text, label=label, language=path.stem, constraints=json.loads(more[0]) if more else None)
