"""Sentences with what they mean: ``meanings/*.tsv``, and the spoken requests that say their constraints."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from wirelessagent.language.training.compose import OBJECTIVES
from wirelessagent.language.training.spoken import spoken

MEANINGS = Path(__file__).with_name("meanings")


def sentences() -> Iterator[tuple[str, Mapping[str, Any]]]:
    """(sentence, constraints)."""
    for path in sorted(MEANINGS.glob("*.tsv")):
        for line in path.read_text(encoding="utf-8").splitlines():
            text, _, meaning = line.partition("\t")
            yield text, json.loads(meaning)
    for each in spoken():
        if (each.label in OBJECTIVES or each.near) and each.constraints is not None:
            yield each.text, each.constraints
