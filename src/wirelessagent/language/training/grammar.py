"""Templates as text: lists of alternatives that stand for many sentences.

A line ``[label]`` begins the templates of a label, ``= name`` a list that ``<name>`` refers to; ``(a|b|)`` is a choice
and ``%`` begins a comment. ``<power>``, ``<rate>``, ``<ratio>``, ``<bare>`` and ``<user_ref>`` are figures and users.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

Slot: TypeAlias = Callable[[random.Random], str]

_SPACES = re.compile(r"\s+")
_TIGHT = re.compile(r"\s+([,.;:!?\uff0c。？])")


@dataclass(frozen=True, kw_only=True)
class Grammar:
    """The templates of one language."""

    language: str
    templates: Mapping[str, tuple[str, ...]]
    lists: Mapping[str, tuple[str, ...]]

    @classmethod
    def read(cls, path: Path) -> Grammar:
        templates: dict[str, list[str]] = {}
        lists: dict[str, list[str]] = {}
        into: list[str] = []
        for line in path.read_text(encoding="utf-8").splitlines():
            text = line.strip()
            if not text or text.startswith("%"):
                continue
            if text.startswith("["):
                into = templates.setdefault(text.strip("[]"), [])
            elif text.startswith("= "):
                into = lists.setdefault(text[2:].strip(), [])
            else:
                into.append(text)
        return cls(
            language=path.stem,
            templates={name: tuple(lines) for name, lines in templates.items()},
            lists={name: tuple(lines) for name, lines in lists.items()},
        )

    def draw(self, template: str, chance: random.Random, slots: Mapping[str, Slot]) -> str:
        """One of the sentences that a template stands for."""
        text, end = self._draw(template, 0, chance, slots)
        assert end == len(template), f"unbalanced brackets in {template!r}"
        text = _SPACES.sub("" if self.language == "zh" and text.isascii() is False else " ", text).strip()
        return _TIGHT.sub(r"\1", text)

    def _draw(self, template: str, start: int, chance: random.Random, slots: Mapping[str, Slot]) -> tuple[str, int]:
        options: list[str] = [""]
        place = start
        while place < len(template):
            letter = template[place]
            if letter == "(":
                drawn, place = self._draw(template, place + 1, chance, slots)
                options[-1] += drawn
            elif letter == ")":
                return chance.choice(options), place + 1
            elif letter == "|" and start > 0:
                options.append("")
                place += 1
            elif letter == "<":
                end = template.index(">", place)
                options[-1] += self._slot(template[place + 1 : end], chance, slots)
                place = end + 1
            else:
                options[-1] += letter
                place += 1
        return options[0], place

    def _slot(self, name: str, chance: random.Random, slots: Mapping[str, Slot]) -> str:
        if name in slots:
            return slots[name](chance)
        return self.draw(chance.choice(self.lists[name]), chance, slots)

    def variety(self, template: str) -> int:
        """Roughly how many sentences a template stands for."""
        several = template.count("|") + 1
        return several * (1 + 3 * template.count("<"))
