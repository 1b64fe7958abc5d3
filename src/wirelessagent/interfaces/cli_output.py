"""The only way to the terminal: records, progress, JSON and what went wrong.

Whatever is printed passes :func:`.legible` here and nowhere else, so that no name, file or sentence can move the
cursor, hide a part of itself or add a line.
"""

from __future__ import annotations

import codecs
import io
import logging
import os
import sys
import warnings
from types import TracebackType
from typing import TYPE_CHECKING, Any

from rich.cells import cell_len

from wirelessagent.interfaces.cli_layout import output_width, tabled, wrapped
from wirelessagent.operations.operation import Event, legible, written_out
from wirelessagent.operations.record import Block, Files, Record, Table

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

_BOLD, _STAGE_STYLE = "1", "1;36"
_STAGE = 11
"""Columns for the names of stages."""


class Listener:
    """Shows the stages of an operation as they happen, and a bar for counted work; ``told`` once it showed one."""

    def __init__(self) -> None:
        self.told = False
        self._bar: Any = None
        self._tasks: dict[str, TaskID] = {}

    def __enter__(self) -> Listener:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def __call__(self, event: Event) -> None:
        stage = legible(event.label, keep="")
        if not event.total:
            self.told = True
            first, *more = wrapped(legible(event.message, keep=""), output_width() - _STAGE - 2)
            print(f"{' ' * (_STAGE - cell_len(stage))}{_styled(stage, _STAGE_STYLE)}  {first}")  # noqa: T201
            for line in more:
                print(f"{'':{_STAGE}}  {line}")  # noqa: T201
            return
        if self._bar is None:
            self._bar = _started_bar()
        if stage not in self._tasks:
            self._tasks[stage] = self._bar.add_task(stage, total=event.total)
        self._bar.update(self._tasks[stage], completed=event.done, total=event.total)


def _started_bar() -> Progress:
    """A progress bar on stderr; Rich is loaded only here."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    bar = Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=Console(stderr=True, highlight=False, markup=False, emoji=False),
        transient=False,
    )
    bar.start()
    return bar


class _Notes(logging.Handler):
    """Prints log records to stderr, one line each, and those that count as a bar."""

    def __init__(self, level: int = logging.NOTSET) -> None:
        super().__init__(level)
        self._listener: Listener | None = None

    def emit(self, record: logging.LogRecord) -> None:
        done, total = (getattr(record, name, 0) for name in ("done", "total"))
        if not total:
            complain(record.getMessage())
            return
        self._listener = self._listener or Listener()
        self._listener(Event(stage=record.getMessage(), message="", done=done, total=total))
        if done == total:
            self._listener.__exit__(None, None, None)
            self._listener = None


def take_over(*, notes: bool) -> None:
    """Have everything that anybody prints pass here: notes and warnings too, and signs that the terminal has not.

    Told is what is not recorded and, with ``notes``, why a machine's first decision takes time.
    """
    codecs.register_error("written_out", _written_out)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            # a terminal without Chinese must not stop the work, and who reads a pipe wants to know how far it is
            stream.reconfigure(errors="written_out", line_buffering=True)
    wanted = ("wirelessagent.kernels.compiling", notes, logging.DEBUG), ("wirelessagent.store", True, logging.INFO)
    for name, shown, level in wanted:
        log = logging.getLogger(name)
        log.setLevel(level)
        log.propagate = False
        log.handlers = [_Notes()] if shown else [logging.NullHandler()]
    logging.lastResort = _Notes(logging.WARNING)
    warnings.showwarning = _warn


def _written_out(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return written_out(error.object[error.start : error.end]), error.end


def _warn(message: Warning | str, category: type[Warning], *_: object) -> None:
    complain(f"{category.__name__}: {message}")


def show(record: Record, *, after_stages: bool = False) -> None:
    """Print a record's paragraphs, tables and files, within the width of the output."""
    width, last = output_width(), ""
    if after_stages:
        print()  # noqa: T201
    for block in record.blocks():
        apart = [""] if isinstance(block, Table) and last else []
        for line in [*apart, *_lines(block, width)]:
            print(line)  # noqa: T201
            last = line


def _lines(block: Block, width: int) -> list[str]:
    if isinstance(block, Files):
        return _file_lines(block, width)
    if isinstance(block, Table):
        title = [_styled(line, _BOLD) for line in wrapped(legible(block.title, keep=""), width)]
        columns, *rows = ([legible(cell, keep="") for cell in row] for row in (block.columns, *block.rows))
        return [*title, "", *tabled(columns, rows, width), ""]
    return [
        line
        for part in ((block,) if isinstance(block, str) else block)
        for line in wrapped(legible(part, keep=""), width)
    ]


def _file_lines(files: Files, width: int) -> list[str]:
    """One path beside what was done with it where that fits, else each on a line of its own, whole."""
    paths = [legible(str(path), keep="") for path in files.paths]
    together = f"{files.done} {paths[0]}"
    return [together] if len(paths) == 1 and len(together) <= width else [files.done, *paths]


def show_json(text: str) -> None:
    """Print JSON as it is; its escapes for what a terminal would not show are those of JSON."""
    print(legible(text), flush=True)  # noqa: T201


def exit_code(record: Record) -> int:
    """How a program that runs us learns what a record came to."""
    return {"done": 0, "failed": 1, "unclear": 2, "unmet": 3}[record.conclusion]


def tell(line: str) -> None:
    """Print a line."""
    print(legible(line, keep=""))  # noqa: T201


def tell_paragraph(text: str) -> None:
    """Print a paragraph within the width of the output."""
    for line in _lines(text, output_width()):
        print(line)  # noqa: T201


def tell_page(text: str) -> None:
    """Print lines as they are laid out."""
    print(legible(text))  # noqa: T201


def complain(message: str) -> None:
    """Print a message to stderr, on one line."""
    print(f"wirelessagent: {legible(' '.join(message.split()))}", file=sys.stderr)  # noqa: T201


def _styled(text: str, style: str) -> str:
    """Text in a style, where the output is a terminal that is to have one."""
    wanted = sys.stdout.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
    understood = os.name != "nt" or "WT_SESSION" in os.environ
    return f"\x1b[{style}m{text}\x1b[0m" if wanted and understood else text
