"""Records and progress on a terminal."""

from __future__ import annotations

from types import TracebackType

from rich import box
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn, TimeRemainingColumn
from rich.table import Table as RichTable

from wirelessagent.operations.operation import Event
from wirelessagent.operations.record import Block, Record, Table


class Listener:
    """Shows the stages of an operation as they happen, and a bar for counted work."""

    def __init__(self) -> None:
        self._console = _console()
        self._bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeRemainingColumn(),
            console=Console(stderr=True),
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
        if not event.total:
            self._console.print(f"[bold cyan]{event.stage:>10}[/]  {escape(event.message)}")
            return
        if not self._tasks:
            self._bar.start()
        if event.stage not in self._tasks:
            self._tasks[event.stage] = self._bar.add_task(event.stage, total=event.total)
        self._bar.update(self._tasks[event.stage], completed=event.done, total=event.total)


def show(record: Record) -> None:
    """Print a record's paragraphs and tables."""
    console = _console()
    for block in record.blocks():
        console.print(_renderable(block))


def _console() -> Console:
    """A terminal, or plain text of a fixed width where the output goes elsewhere."""
    console = Console(highlight=False, soft_wrap=False)
    return console if console.is_terminal else Console(highlight=False, width=120)


def _renderable(block: Block) -> RichTable | str:
    if not isinstance(block, Table):
        return escape(block)
    table = RichTable(title=block.title, title_justify="left", title_style="bold", box=box.SIMPLE_HEAD, pad_edge=False)
    for number, column in enumerate(block.columns):
        figures = number > 0 and all(_is_figure(row[number]) for row in block.rows)
        table.add_column(column, justify="right" if figures else "left")
    for row in block.rows:
        table.add_row(*(escape(cell) for cell in row))
    return table


def _is_figure(cell: str) -> bool:
    return cell in ("–", "") or cell.lstrip("-−")[:1].isdigit()
