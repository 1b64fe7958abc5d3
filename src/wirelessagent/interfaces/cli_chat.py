"""Conversations on a terminal: a line in, a record out, until the lines end."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator

from click.exceptions import Exit

from wirelessagent.interfaces.cli_output import exit_code, show, show_json, tell, tell_paragraph
from wirelessagent.operations.operation import AnyOperation, Event, Request, silent

_PROMPT = "> "


def converse(operation: AnyOperation, request: Request, *, as_json: bool) -> int:
    """Hand lines over as they come and show what becomes of each; with ``as_json`` one line of JSON per turn.

    Lines come from the request, else from the terminal or from a pipe. Returns the exit code: that of the last line,
    and 0 where somebody typed, who has read what it came to.
    """
    assert operation.converse is not None
    conversation = operation.converse(request, silent if as_json else _file_read)
    code, lines = 0, conversation.lines
    typed = lines is None and sys.stdin.isatty() and not as_json
    if typed:
        tell_paragraph(conversation.opening)
    if lines is None:
        lines = _typed() if typed else (line.rstrip("\r\n") for line in sys.stdin)
    for line in lines:
        if not line.strip():
            continue
        if not (typed or as_json):
            tell(f"{_PROMPT}{line}")
        record = conversation.answer(line)
        if record is None:
            break
        code = exit_code(record)
        if as_json:
            show_json(record.model_dump_json())
        else:
            show(record)
    return 0 if typed else code


def _file_read(event: Event) -> None:
    """Tell what was understood of a file; of the rest the replies tell."""
    if event.stage == "read":
        tell_paragraph(event.message)


def _typed() -> Iterator[str]:
    """Lines from the terminal, until its end is signalled or the waiting for one is interrupted."""
    with contextlib.suppress(ImportError):  # Windows has none, and its terminals edit lines by themselves
        import readline  # noqa: F401  # pyright: ignore[reportUnusedImport]  # input() edits and remembers lines
    while True:
        try:
            yield input(_PROMPT)
        except EOFError:
            tell("")
            return
        except KeyboardInterrupt:
            tell("")
            raise Exit(130) from None
