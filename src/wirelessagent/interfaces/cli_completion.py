"""Completion of commands, options and plug-ins' names in bash, zsh and fish."""

from __future__ import annotations

import os
from pathlib import Path

import click
import platformdirs
from click.shell_completion import get_completion_class, shell_complete

from wirelessagent.operations.operation import InputError

PROGRAM = "wirelessagent"
SHELLS = ("bash", "zsh", "fish")

_VARIABLE = "_WIRELESSAGENT_COMPLETE"


def completed(program: click.Command) -> int | None:
    """Answer a shell that asks what may follow; None where none asks."""
    asked = os.environ.get(_VARIABLE)
    return shell_complete(program, {}, PROGRAM, _VARIABLE, asked) if asked else None


def script(program: click.Command, shell: str) -> str:
    """What a shell has to read to complete our commands."""
    kind = get_completion_class(_known(shell))
    assert kind is not None
    return kind(program, {}, PROGRAM, _VARIABLE).source()


def install(program: click.Command, shell: str) -> str:
    """Have a shell read the script when it starts; says what was written.

    Fish finds it by its place; bash and zsh get a line at the end of the file that they read when they start.
    """
    shell = _known(shell)
    if shell == "fish":
        place = platformdirs.user_config_path("fish") / "completions" / f"{PROGRAM}.fish"
        return _written(place, script(program, shell))
    place = platformdirs.user_data_path(PROGRAM) / f"completion.{shell}"
    said = _written(place, script(program, shell))
    start = Path(os.environ.get("ZDOTDIR") or Path.home()) / ".zshrc" if shell == "zsh" else Path.home() / ".bashrc"
    line = f"{'autoload -Uz compinit && compinit && ' if shell == 'zsh' else ''}source '{place}'"
    there = start.read_text(encoding="utf-8") if start.exists() else ""
    if line not in there.splitlines():
        said += "\n" + _written(start, f"{there.rstrip()}\n{line}".lstrip())
    return f"{said}\nA new shell completes wirelessagent's commands."


def _known(shell: str) -> str:
    """The shell of this name, or the one in use where none is named."""
    found = shell or Path(os.environ.get("SHELL", "")).name
    if found not in SHELLS:
        raise InputError(f"completion is there for {', '.join(SHELLS)}; got {found!r}: name one of them")
    return found


def _written(place: Path, text: str) -> str:
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_text(f"{text.rstrip()}\n", encoding="utf-8")
    return f"written to\n{place}"
