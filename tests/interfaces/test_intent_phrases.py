"""Patterns that are searched only where a mark of theirs stands find all that they would find anywhere."""

from __future__ import annotations

import importlib
import pkgutil
from pathlib import Path

import pytest

from wirelessagent import language
from wirelessagent.language.text import Phrases, clause_end, clause_start, lowered, normalise

SPOKEN = Path(language.__file__).parent / "training" / "spoken"
MARKED = {
    f"{module.name}.{name}": pattern
    for module in pkgutil.iter_modules(language.__path__)
    for name, pattern in vars(importlib.import_module(f"wirelessagent.language.{module.name}")).items()
    if isinstance(pattern, Phrases) and pattern.marks
}


def texts() -> list[str]:
    lines = [line for path in sorted(SPOKEN.glob("*.tsv")) for line in path.read_text(encoding="utf-8").splitlines()]
    return [lowered(normalise(line.partition("\t")[2])) for line in lines[::5]]


def test_every_match_holds_a_mark():
    assert len(MARKED) > 5
    for name, pattern in MARKED.items():
        missed = [text for text in texts() if not pattern.may_match(text) and pattern.compiled.search(text)]
        assert not missed, (name, missed[:3])


@pytest.mark.parametrize("text", ["İSTANBUL: 5 W", "ÉNERGIE", "功率 5W", "ẞ"])
def test_small_letters_move_nothing(text: str):
    assert len(lowered(text)) == len(text)
    match = Phrases("5 ?w").search(text)
    assert match is None or text[match.start() : match.end()] in ("5 W", "5W")


def test_clauses_end_at_marks_but_not_within_figures():
    text = "1.5 Mbit/s each, max 20 W. Leave 3 out"
    assert text[clause_start(text, 20) : clause_end(text, 20)] == " max 20 W"
    assert text[clause_start(text, 4) : clause_end(text, 0)] == "1.5 Mbit/s each"
    assert (clause_start(text, 20, from_=18), clause_end(text, 20, to=21)) == (18, 21)
    assert (clause_start("no.5", 3), clause_end("no.5", 0, to=3)) == (3, 2)
