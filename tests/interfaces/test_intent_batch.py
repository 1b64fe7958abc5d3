"""``intent`` on one sentence and on a file, and ``evaluate intents``."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest

from wirelessagent.experiments.evaluate_intents import Meant, compared, figures_of, read_meant
from wirelessagent.interfaces.cli import run
from wirelessagent.language.intent import Intent
from wirelessagent.language.offline import recognise
from wirelessagent.model.errors import InputError


def written(folder: Path, *lines: str) -> str:
    path = folder / "said.jsonl"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return str(path)


def test_one_sentence_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["intent", "save power, user 3 at least 2 Mbit/s", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert (record["kind"], record["objective"]) == ("allocate", "min_power")
    assert record["constraints"] == {"min_rate_bps": {"3": 2e6}}
    assert record["recogniser"] == "offline"
    assert record["evidence"]["min_rate_bps"] == "2 Mbit/s"


def test_one_sentence_for_people(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["intent", "max rate, only users 1 and 2, user 2 counts double"]) == 0
    said = capsys.readouterr().out
    assert all(part in said for part in ("max_rate", "1, 2", "2: 2", "weight 2 for user 2"))
    assert run(["intent", "10 W"]) == 2


def test_a_file_of_sentences(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = written(
        tmp_path,
        '{"text": "save power"}',
        "",
        '{"text": "省电\uff0c每人至少1兆", "language": "zh"}',
        '{"text": "better"}',
    )
    assert run(["intent", "--batch", file]) == 0
    first, second, third = (json.loads(line) for line in capsys.readouterr().out.splitlines())
    assert (first["text"], first["objective"]) == ("save power", "min_power")
    assert second["constraints"] == {"min_rate_bps": 1e6}
    assert third["kind"] == "clarify"
    assert run(["intent", "--batch", file, "--json"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 3


def test_bad_lines_are_named_and_the_others_answered(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = written(
        tmp_path, '{"text": "save power"}', "{nonsense", '{"words": 1}', "[" * 100_000, '{"text": "max rate"}'
    )
    assert run(["intent", "--batch", file]) == 2
    output = capsys.readouterr()
    rows = [json.loads(line) for line in output.out.splitlines()]
    assert [row.get("objective") for row in rows] == ["min_power", None, None, None, "max_rate"]
    assert [row.get("line") for row in rows] == [None, 2, 3, 4, None]
    errors = output.err.splitlines()
    assert len(errors) == 3
    assert "line 2: not JSON" in errors[0]
    assert 'line 3: no {"text": "…"}' in errors[1]


@pytest.mark.parametrize("arguments", [[], ["save power", "--batch", "x.jsonl"], ["--batch", "missing.jsonl"]])
def test_bad_calls_are_one_line(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["intent", *arguments]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def meant(kind: str, objective: str | None = None, **constraints: Any) -> Meant:
    return Meant(text="x", language="en", kind=kind, objective=objective, constraints=constraints, line=1)


def understood(kind: Any, objective: str | None = None, topic: str | None = None, **constraints: Any) -> Intent:
    return Intent(kind=kind, objective=objective, constraints=constraints, language="en", confidence=1.0, evidence={},
                  reply="", recogniser="r", topic=topic)  # fmt: skip


def allocate(objective: str = "max_rate", /, **constraints: Any) -> Intent:
    return understood("allocate", objective, **constraints)


TEN_WATTS = meant("allocate", "max_rate", max_power_w=10.0)
A_MEGABIT = meant("allocate", "max_rate", min_rate_bps={"3": 1e6})


@pytest.mark.parametrize(
    ("said", "read", "right", "wrong", "units"),
    [
        (TEN_WATTS, allocate(max_power_w=10.0), True, False, 0),
        (TEN_WATTS, understood("clarify"), False, False, 0),
        (TEN_WATTS, allocate("min_power", max_power_w=10.0), False, True, 0),
        (TEN_WATTS, allocate(max_power_w=12.0), False, True, 0),
        (TEN_WATTS, allocate(max_power_w=0.01), False, True, 1),
        (meant("allocate", "max_rate", max_power_w=20.0), allocate(max_power_w=0.1), False, True, 1),
        (A_MEGABIT, allocate(min_rate_bps={"3": 8e6}), False, True, 1),
        (A_MEGABIT, allocate(min_rate_bps=1e6), False, True, 0),
        (meant("allocate", "max_rate", users=("1", "2")), allocate(users=("2", "1")), True, False, 0),
        (meant("question"), allocate(), False, True, 0),
        (meant("question"), understood("command", topic="apply"), False, True, 0),
        (meant("question"), understood("command", topic="explain"), False, False, 0),
    ],
)
def test_what_counts_as_wrong(said: Meant, read: Intent, right: bool, wrong: bool, units: int) -> None:
    found = compared(said, read)
    assert (found.right, found.wrong_action, len(found.unit_errors)) == (right, wrong, units)


def test_figures_count_sentences_and_those_with_quantities() -> None:
    found = [
        compared(
            meant("allocate", "max_rate", max_power_w=10.0), understood("allocate", "max_rate", max_power_w=10.0), 1e-3
        ),
        compared(meant("allocate", "max_rate", max_power_w=10.0), understood("clarify"), 3e-3),
        compared(meant("question"), understood("allocate", "min_power"), 2e-3),
        compared(meant("question"), understood("question"), 2e-3),
    ]
    figures = figures_of(found)
    assert (figures.sentences, figures.with_quantities, figures.kind_and_objective) == (4, 2, 0.5)
    assert (figures.constraints, figures.wrong_actions, figures.unit_errors) == (0.5, 0.25, 0)
    assert figures.median_ms == pytest.approx(2.0)
    assert figures.confusion["max_rate", "clarify"] == 1
    assert figures.by_language == {"en": (2, 4)}


SAVE = {"text": "save power, 10 W", "kind": "allocate", "objective": "min_power", "constraints": {"max_power_w": 10}}
SERVE = {
    "text": "serve only users 1 and 2, max rate", "kind": "allocate", "objective": "max_rate",
    "constraints": {"users": [1, 2]},
}  # fmt: skip
NOT_ASKED = {"text": "今天别省电", "language": "zh", "kind": "question", "objective": None, "constraints": {}}
ROWS = tuple(json.dumps(row, ensure_ascii=False) for row in (SAVE, SERVE, NOT_ASKED))


def test_the_evaluation_as_a_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, out = written(tmp_path, *ROWS), tmp_path / "out"
    assert run(["evaluate", "intents", file, "--json", "--out", str(out)]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["sentences"] == 3
    assert record["constraints"] == 1.0
    assert record["kind_and_objective"] == pytest.approx(2 / 3)
    assert record["confusion"]["question"] == {"clarify": 1}
    assert [error["line"] for error in record["errors"]] == [3]
    assert 0 < record["load_s"] < 60
    assert 0 < record["shipped_bytes"] < 3_700_000  # all four models, and 0.8 MB of words
    rows = list(csv.DictReader((out / "evaluate_intents.csv").read_text(encoding="utf-8").splitlines()))
    assert [row["right"] for row in rows] == ["1", "1", "0"]
    assert json.loads((out / "evaluate_intents.json").read_text(encoding="utf-8"))["sentences"] == 3
    assert run(["evaluate", "intents", file, "--errors"]) == 0
    assert "今天别省电" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("line", "named"),
    [
        ("{", "line 2"), ('{"text": "a", "kind": "x"', "line 2"), ('{"kind": "question"}', "no 'text'"),
        ('{"text": "a", "kind": "allocate", "constraints": {"altitude": 1}}', "altitude"), ("[1]", "line 2"),
        ('{"text": "a", "kind": "allocate", "constraints": {"max_power_w": -1}}', "-1"),
        ('{"text": "a", "kind": "allocate", "objective": ["max_rate"]}', "objective is ['max_rate']"),
        ('{"text": "a", "kind": "allocate", "objective": "max_fun"}', "objective is 'max_fun'"),
        ('{"text": "a", "kind": "bogus"}', "kind is 'bogus'"), ('{"text": "a", "kind": ["question"]}', "kind is ["),
        ('{"text": "a", "kind": "question", "constraints": []}', "constraints are []"),
        ('{"text": "a", "kind": "question", "constraints": 7}', "constraints are 7"), ("7", "it is 7"),
    ],
)  # fmt: skip
def test_a_bad_line_of_meanings_is_named(line: str, named: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="line 2") as error:
        read_meant(Path(written(tmp_path, ROWS[0], line)))
    assert named in str(error.value)


def test_the_recogniser_is_fit_for_the_development_set() -> None:
    """The bars, on sentences that were never trained on; the times are measured by ``evaluate intents``."""
    path = Path(__file__).parents[1] / "intents" / "development.jsonl"
    found = [compared(each, recognise(each.text)) for each in read_meant(path)]
    figures = figures_of(found)
    wrong = [each.meant.text for each in found if not each.right]
    assert figures.kind_and_objective >= 0.95, wrong
    assert figures.constraints >= 0.97, wrong
    assert figures.wrong_actions <= 0.01, [each.meant.text for each in found if each.wrong_action]
    assert figures.unit_errors == 0
