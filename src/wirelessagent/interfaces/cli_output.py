"""The only way to the terminal: records, progress, JSON and what went wrong.

Whatever is printed passes :func:`.legible` here and nowhere else, so that no name, file or sentence can move the
cursor, hide a part of itself or add a line.
"""

from __future__ import annotations

import codecs
import io
import logging
import sys
import warnings
from types import TracebackType
from typing import Any

from rich import box
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn, TimeRemainingColumn
from rich.table import Table as RichTable
from rich.text import Text

from wirelessagent.operations.operation import Event, legible, written_out
from wirelessagent.operations.record import Record, Table


class Listener:
    """Shows the stages of an operation as they happen, and a bar for counted work."""

    def __init__(self) -> None:
        self._console = _console()
        self._bar = Progress(
            TextColumn("{task.description}", markup=False),
            BarColumn(),
            MofNCompleteColumn(),
            TimeRemainingColumn(),
            console=_Screen(stderr=True),
            transient=False,
        )
        self._tasks: dict[str, TaskID] = {}

    def __enter__(self) -> Listener:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._tasks:
            self._bar.stop()

    def __call__(self, event: Event) -> None:
        stage = legible(event.stage, keep="")
        if not event.total:
            said = (f"{stage:>10}", "bold cyan"), f"  {legible(event.message, keep='')}"
            self._console.print(Text.assemble(*said))
            return
        if not self._tasks:
            self._bar.start()
        if stage not in self._tasks:
            self._tasks[stage] = self._bar.add_task(stage, total=event.total)
        self._bar.update(self._tasks[stage], completed=event.done, total=event.total)


class _Notes(logging.Handler):
    """Prints log records to stderr, one line each."""

    def emit(self, record: logging.LogRecord) -> None:
        complain(record.getMessage())


def take_over(*, notes: bool) -> None:
    """Have everything that anybody prints pass here: notes and warnings too, and signs that the terminal has not.

    Told is what is not recorded and, with ``notes``, why a machine's first decision takes time.
    """
    codecs.register_error("written_out", _written_out)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="written_out")  # a terminal without Chinese must not stop the work
    for name, shown in (("wirelessagent.kernels.compiling", notes), ("wirelessagent.store", True)):
        log = logging.getLogger(name)
        log.setLevel(logging.INFO)
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


def show(record: Record) -> None:
    """Print a record's paragraphs and tables."""
    console = _console()
    for block in record.blocks():
        for part in block if isinstance(block, tuple) else (block,):
            console.print(_renderable(part))


def show_json(text: str) -> None:
    """Print JSON as it is; its escapes for what a terminal would not show are those of JSON."""
    print(legible(text), flush=True)  # noqa: T201


def exit_code(record: Record) -> int:
    """How a program that runs us learns what a record came to."""
    return {"done": 0, "failed": 1, "unclear": 2, "unmet": 3}[record.conclusion]


def tell(line: str) -> None:
    """Print a line."""
    print(legible(line, keep=""))  # noqa: T201


def complain(message: str) -> None:
    """Print a message to stderr, on one line."""
    print(f"wirelessagent: {legible(' '.join(message.split()))}", file=sys.stderr)  # noqa: T201


class _Screen(Console):
    """A console that shows text as it is: no markup, no emoji codes, and nothing that a terminal would act on."""

    def __init__(self, **options: Any) -> None:
        super().__init__(highlight=False, markup=False, emoji=False, **options)

    def render_str(self, text: str, **how: Any) -> Text:
        return super().render_str(legible(text, keep=""), **how)


def _console() -> Console:
    """A terminal, or plain text of a fixed width where the output goes elsewhere."""
    console = _Screen(soft_wrap=False)
    return console if console.is_terminal else _Screen(width=120)


def _renderable(block: str | Table) -> RichTable | str:
    if isinstance(block, str):
        return block
    table = RichTable(title=block.title, title_justify="left", title_style="bold", box=box.SIMPLE_HEAD, pad_edge=False)
    for number, column in enumerate(block.columns):
        figures = number > 0 and all(_is_figure(row[number]) for row in block.rows)
        table.add_column(column, justify="right" if figures else "left")
    for row in block.rows:
        table.add_row(*row)
    return table


def _is_figure(cell: str) -> bool:
    return cell in ("–", "") or cell.lstrip("-−")[:1].isdigit()
