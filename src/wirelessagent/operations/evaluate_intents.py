"""evaluate intents: how well a recogniser understands a file of sentences with their meanings."""

from __future__ import annotations

import csv
import io
import json
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from wirelessagent import __version__
from wirelessagent.experiments.evaluate_intents import Figures, Understood, evaluate, figures_of, read_meant
from wirelessagent.experiments.evaluation import make_folder
from wirelessagent.language import vocabulary
from wirelessagent.language.conversation.weighing import TALKS_FILE
from wirelessagent.language.figure_roles import ROLES_FILE
from wirelessagent.language.order_model import ORDER_FILE
from wirelessagent.language.sentence_model import SENTENCES_FILE
from wirelessagent.model.atomic import write_atomically
from wirelessagent.operations.fields import Positional
from wirelessagent.operations.intent import plain, shown
from wirelessagent.operations.operation import Event, Operation, Progress
from wirelessagent.operations.recognisers import RecogniserOption
from wirelessagent.operations.record import Block, Files, Record, Table

_LOAD = (
    "import time; start = time.perf_counter(); from wirelessagent.language.offline import recognise; "
    "recognise('save power, 10 W'); print(time.perf_counter() - start)"
)


class EvaluateIntentsRequest(RecogniserOption):
    file: Annotated[Path, Positional()] = Field(
        description="JSON lines with text, language, kind, objective and constraints"
    )
    errors: bool = Field(False, description="list what was not understood as meant")
    out: Path | None = Field(
        None, description="folder for the sentences with their answers (CSV) and the record (JSON)"
    )


class IntentsFigures(Record):
    """What was found. Shares are of 1; ``load_s`` and ``shipped_bytes`` are of the offline recogniser."""

    recogniser: str
    version: str
    sentences: int
    with_quantities: int
    kind_and_objective: float
    constraints: float
    wrong_actions: float
    unit_errors: int
    median_ms: float
    slow_ms: float
    load_s: float | None
    shipped_bytes: int | None
    answered_by: dict[str, int]
    by_language: dict[str, tuple[int, int]]
    confusion: dict[str, dict[str, int]]
    errors: list[dict[str, Any]]
    files: list[Path] = Field(default_factory=list[Path])
    listed: bool = Field(False, exclude=True)

    def blocks(self) -> list[Block]:
        said: list[Block] = [self._figures(), self._languages(), self._confusion()]
        if self.listed and self.errors:
            columns = ("line", "sentence", "meant", "understood", "reply")
            rows = tuple((str(e["line"]), e["text"], e["meant"], e["understood"], e["reply"]) for e in self.errors)
            said.append(Table(title="Not as meant", columns=columns, rows=rows))
        return [*said, *([Files("written:", tuple(self.files))] if self.files else [])]

    def _figures(self) -> Table:
        rows = [
            ("sentences", str(self.sentences), ""),
            ("kind and objective right, %", f"{100 * self.kind_and_objective:.1f}", "≥ 95"),
            (f"constraints right, % of {self.with_quantities}", f"{100 * self.constraints:.1f}", "≥ 97"),
            ("wrong actions, %", f"{100 * self.wrong_actions:.1f}", "≤ 1"),
            ("unit errors", str(self.unit_errors), "0"),
            ("ms per sentence, median", f"{self.median_ms:.2f}", "≤ 5"),
            ("ms per sentence, 95 %", f"{self.slow_ms:.2f}", ""),
        ]
        if self.load_s is not None and self.shipped_bytes is not None:
            rows.append(("load, s", f"{self.load_s:.2f}", "≤ 0.5"))
            rows.append(("models and word lists shipped, kB", f"{self.shipped_bytes / 1000:.0f}", "≤ 3700"))
        rows += [(f"answered by {name}", str(count), "") for name, count in self.answered_by.items()]
        return Table(title=f"Understanding, {self.recogniser}", columns=("figure", "value", "bar"), rows=tuple(rows))

    def _languages(self) -> Table:
        rows = tuple(
            (name or "–", str(total), f"{100 * right / total:.1f}") for name, (right, total) in self.by_language.items()
        )
        return Table(title="By language", columns=("language", "sentences", "right, %"), rows=rows)

    def _confusion(self) -> Table:
        columns = list(dict.fromkeys(name for row in self.confusion.values() for name in row))
        rows = tuple(
            (meant, *(str(row.get(column, "")) for column in columns)) for meant, row in self.confusion.items()
        )
        return Table(title="Meant (rows) and understood (columns)", columns=("meant", *columns), rows=rows)


def run(request: EvaluateIntentsRequest, progress: Progress) -> IntentsFigures:
    meant = read_meant(request.file)
    if request.out is not None:
        make_folder(request.out)
    recogniser = request.chosen_recogniser()
    recogniser.recognise(meant[0].text)  # what loads once is not a sentence's time

    def told(done: int, total: int) -> None:
        progress(Event(stage="evaluate", message="sentences", done=done, total=total))

    found = evaluate(recogniser, meant, told)
    offline = request.recogniser == "offline"
    record = _record(request, found, figures_of(found), load_seconds() if offline else None)
    return record if request.out is None else record.model_copy(update={"files": _write(request.out, record, found)})


def load_seconds(times: int = 3) -> float:
    """Seconds to import the offline recogniser and understand a sentence, in a fresh process; the best of some."""
    runs = [
        subprocess.run([sys.executable, "-c", _LOAD], capture_output=True, text=True, check=True) for _ in range(times)
    ]
    return min(float(each.stdout) for each in runs)


def _shipped_bytes() -> int:
    """What the offline recogniser brings along beside its code: four models, base words and classes of mood."""
    listed = (*vocabulary.FOLDER.glob("*.tsv"), *vocabulary.FOLDER.with_name("moods").glob("*.toml"))
    models = (SENTENCES_FILE, ORDER_FILE, ROLES_FILE, TALKS_FILE)
    return sum(path.stat().st_size for path in (*models, *listed))


def _record(
    request: EvaluateIntentsRequest, found: Sequence[Understood], figures: Figures, load_s: float | None
) -> IntentsFigures:
    confusion: dict[str, dict[str, int]] = {}
    for (meant, understood), count in sorted(figures.confusion.items()):
        confusion.setdefault(meant, {})[understood] = count
    answered: dict[str, int] = {}
    for each in found:
        answered[each.intent.recogniser] = answered.get(each.intent.recogniser, 0) + 1
    names = set(IntentsFigures.model_fields) & set(Figures.__dataclass_fields__) - {"confusion", "by_language"}
    return IntentsFigures(
        recogniser=request.recogniser, version=__version__, load_s=load_s, answered_by=answered, confusion=confusion,
        shipped_bytes=_shipped_bytes() if load_s is not None else None,
        by_language=dict(figures.by_language), listed=request.errors,
        errors=[_error(each) for each in found if not each.right],
        **{name: getattr(figures, name) for name in names},
    )  # fmt: skip


def _error(each: Understood) -> dict[str, Any]:
    meant, intent = each.meant, each.intent
    return {
        "line": meant.line,
        "text": meant.text,
        "meant": _in_words(meant.kind, meant.objective, meant.constraints),
        "understood": _in_words(intent.kind, intent.objective, intent.constraints),
        "reply": intent.reply,
        "wrong_action": each.wrong_action,
        "unit_errors": list(each.unit_errors),
    }


def _in_words(kind: str, objective: str | None, constraints: Mapping[str, Any]) -> str:
    stated = [f"{name} {shown(plain(value))}" for name, value in constraints.items()]
    return ", ".join([objective or kind, *stated])


def _write(out: Path, record: IntentsFigures, found: Sequence[Understood]) -> list[Path]:
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("line", "text", "meant", "understood", "right", "wrong_action", "unit_errors", "time_s"))
    for each in found:
        meant, intent = each.meant, each.intent
        writer.writerow((
            meant.line, meant.text, _in_words(meant.kind, meant.objective, meant.constraints),
            _in_words(intent.kind, intent.objective, intent.constraints), int(each.right), int(each.wrong_action),
            " ".join(each.unit_errors), each.seconds,
        ))  # fmt: skip
    paths = [out / "evaluate_intents.csv", out / "evaluate_intents.json"]
    write_atomically(paths[0], lambda stream: stream.write(text.getvalue().encode()))
    record_text = json.dumps(record.model_dump(mode="json", exclude={"files"}), ensure_ascii=False, indent=1)
    write_atomically(paths[1], lambda stream: stream.write(f"{record_text}\n".encode()))
    return paths


EVALUATE_INTENTS = Operation(
    name="evaluate intents",
    request=EvaluateIntentsRequest,
    record=IntentsFigures,
    local=True,
    run=run,
    examples=("evaluate intents sentences.jsonl --errors",),
)
