"""Sentences written down as people say them, beside those drawn from templates: ``spoken/<language>.tsv``.

Each line is a label, a sentence, and for a request its constraints as JSON in SI units, where they are known. Labels
are objectives, kinds of intents, and topics of questions and commands; "none" is a question, a remark or a report, all
that orders nothing now, and "order" is what orders something that nobody wrote down. They were written for training, by
authors who saw no test set; those in ``<language>_near.tsv`` so that what orders something and what does not are easily
mistaken for each other; those in ``<language>_turned.tsv`` so that what means what its figures and users look like and
what does not are, too: groups of orders, and between them what has to be asked about, "clarify" without constraints.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from wirelessagent.language.training.compose import OBJECTIVES
from wirelessagent.model.errors import InputError

SPOKEN = Path(__file__).with_name("spoken")


@dataclass(frozen=True, kw_only=True)
class Spoken:
    """A sentence with its label; ``constraints`` are None where nobody wrote them down.

    Attributes:
        near: whether it was written to be mistaken.
        turned: whether it was written so that something else is read of it than it means, or nearly so.
    """

    text: str
    label: str
    language: str
    constraints: Mapping[str, Any] | None = None
    near: bool = False
    turned: bool = False

    @property
    def is_order(self) -> bool | None:
        """Whether it orders something now; None where it may or may not."""
        if self.label.startswith(("order", "command", *OBJECTIVES)) or (self.label == "clarify" and self.constraints):
            return True
        return False if self.label.startswith(("none", "question", "out_of_scope")) else None


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
            language, _, near = path.stem.partition("_")
            yield Spoken(
                text=text, label=label, language=language, near=bool(near), turned=near == "turned",
                constraints=json.loads(more[0]) if more else None,
            )  # fmt: skip
