"""What ``--help`` and ``--help-all`` show: what people use, with examples; or everything, the plug-ins' options too."""

from __future__ import annotations

from collections.abc import Sequence

import click

from wirelessagent.interfaces.cli_layout import listed, name_width, output_width, wrapped
from wirelessagent.interfaces.cli_options import FieldArgument, FieldOption
from wirelessagent.interfaces.commands import COMMANDS, FAMILIES, GROUPS
from wirelessagent.operations.fields import described

_WIDEST = 110
"""Longer lines are hard to read, however wide the terminal is."""

_EXIT_CODES = (
    "Errors go to stderr. Exit codes: 0 done, 1 failure, 2 bad input or a question back, 3 infeasible or undecided, "
    "130 interrupted."
)

Sections = list[tuple[str, list[tuple[str, str]]]]
"""Headings with what stands under them: a name and what is said of it."""


def page(usage: str, summary: str, *parts: Sections, examples: Sequence[str] = ()) -> str:
    """A page of help that fits the output; what is said stands in one column throughout a part."""
    width = min(output_width(), _WIDEST)
    lines = [*wrapped(f"Usage: {usage}", width, "  "), "", *wrapped(f"{summary}.", width)]
    for sections in parts:
        left = name_width([name for _, rows in sections for name, _ in rows], width)
        for title, rows in sections:
            lines += ["", f"{title}:", *listed(rows, width, left)]
    if examples:
        lines += ["", "Examples:", *(f"  wirelessagent {typed}" for typed in examples)]
    return "\n".join([*lines, "", *wrapped(_EXIT_CODES, width)])


def program_sections() -> Sections:
    """The commands in groups that somebody new can follow."""
    return [(title, [(name, _summary(name)) for name in names]) for title, names in GROUPS.items()]


def family_sections(family: str, names: Sequence[str]) -> Sections:
    """The commands of a family."""
    return [("Commands", [(name, COMMANDS[f"{family} {name}"]) for name in names])]


def parameter_sections(parameters: Sequence[click.Parameter], *, everything: bool) -> Sections:
    """Arguments and options; with ``everything`` also the advanced ones, each under its heading."""
    arguments = [(one.metavar or "", described(one.info)) for one in parameters if isinstance(one, FieldArgument)]
    panels: dict[str, list[tuple[str, str]]] = {"Arguments": arguments, "Options": []}
    for one in parameters:
        if isinstance(one, click.Option) and (everything or not getattr(one, "advanced", False)):
            panel = getattr(one, "panel", "Options") if everything else "Options"
            panels.setdefault(panel, []).append((_flags(one), _said(one, everything=everything)))
    return [(title, rows) for title, rows in panels.items() if rows]


def _summary(name: str) -> str:
    return COMMANDS.get(name) or FAMILIES[name]


def _flags(option: click.Option) -> str:
    names = ", ".join([*option.opts, *option.secondary_opts])
    return names if option.is_flag else f"{names} {option.metavar}"


def _said(option: click.Option, *, everything: bool) -> str:
    """What an option is, what may be given, and its default."""
    if not isinstance(option, FieldOption):
        return option.help or ""
    text = described(option.info, briefly=not everything)
    return f"{text} [default: {option.default_shown}]" if option.default_shown else text
