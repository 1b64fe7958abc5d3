"""0 done, 1 failure, 2 bad input or a question back, 3 infeasible or undecided, 130 interrupted: for every command."""

from __future__ import annotations

import io
import json
import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.acting.simulated import SimulatedBaseStation
from wirelessagent.interfaces.cli import run
from wirelessagent.operations.catalogue import OPERATIONS
from wirelessagent.operations.warm_up import WarmUpRecord

CELL = ("--num-users", "2", "--num-subcarriers", "4")
SAID = "Least power, 10 kbit/s each"
TOO_MUCH = "Least power, 1 Gbit/s each"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A channel, sentences, and a store of two turns, of which the second is another's."""
    folder = tmp_path_factory.mktemp("codes")
    gain = np.random.default_rng(3).exponential(1e-10, (2, 4))
    np.savetxt(folder / "gain.csv", gain, delimiter=",")
    (folder / "good.jsonl").write_text('{"text": "save power"}\n', encoding="utf-8")
    (folder / "bad.jsonl").write_text('{"text": "save power"}\n{}\n', encoding="utf-8")
    meant = {"text": SAID, "language": "en", "kind": "allocate", "objective": "min_power"}
    (folder / "meant.jsonl").write_text(json.dumps({**meant, "constraints": {}}) + "\n", encoding="utf-8")
    for name in ("store", "sealed", "changed"):
        store = folder / f"{name}.sqlite3"
        assert run(["ask", SAID, *CELL, "--store", str(store)]) == 0
    with closing(sqlite3.connect(store)) as connection, connection:
        connection.execute("DROP TRIGGER audit_turn_no_update")
        connection.execute("UPDATE audit_turn SET text = 'nothing' WHERE number = 1")
    return folder


CASES: list[tuple[int, str, str]] = [
    (0, "ask", f"{SAID}|CELL"),
    (2, "ask", "make it nice|CELL"),
    (2, "ask", f"{SAID}|CELL|--base-station|file|--path|FOLDER/a.json"),
    (2, "ask", f"{SAID}|CELL|--loss|nonsense"),
    (3, "ask", f"{TOO_MUCH}|CELL"),
    (0, "chat", f"CELL|--say|{TOO_MUCH}|--say|{SAID}"),
    (0, "chat", f"CELL|--say|{SAID}|--say|what if 1 Gbit/s each?"),
    (2, "chat", f"CELL|--say|{SAID}|--say|make it nice"),
    (2, "chat", f"CELL|--base-station|file|--path|FOLDER/b.json|--say|{SAID}"),
    (3, "chat", f"CELL|--say|{SAID}|--say|{TOO_MUCH}"),
    (2, "chat", "CELL|--script|FOLDER/none.txt"),
    (0, "intent", SAID),
    (2, "intent", "make it nice"),
    (0, "intent", "--batch|FOLDER/good.jsonl"),
    (2, "intent", "--batch|FOLDER/bad.jsonl"),
    (0, "simulate", "CELL"),
    (2, "simulate", "--num-users|-1"),
    (0, "repair", "FOLDER/gain.csv"),
    (2, "repair", "FOLDER/none.csv"),
    (2, "repair", "FOLDER/gain.csv|--out|FOLDER/no/where.npz"),
    (0, "solve", "FOLDER/gain.csv"),
    (2, "solve", "FOLDER/gain.csv|--objective|nonsense"),
    (3, "solve", "FOLDER/gain.csv|--min-rate-bps|1e8"),
    (3, "solve", "FOLDER/gain.csv|--method|equal_power|--min-rate-bps|5e6"),
    (0, "compare", "FOLDER/gain.csv|--methods|dual,equal_power|--min-rate-bps|1e5"),
    (2, "compare", "FOLDER/gain.csv|--methods|greedy|--effort|fast"),
    (2, "compare", "FOLDER/gain.csv|--objective|proportional_fairness|--methods|paper_scan"),
    (3, "compare", "FOLDER/gain.csv|--methods|dual,greedy|--min-rate-bps|1e8"),
    (0, "reproduce", "rate_versus_power|--draws|1|--out|FOLDER/figures"),
    (2, "reproduce", "nonsense"),
    (0, "evaluate repair", "FOLDER/gain.csv|--loss|random:0.3|--draws|1|--methods|user_mean"),
    (2, "evaluate repair", "--draws|0"),
    (0, "evaluate decision", "FOLDER/gain.csv|--loss|random:0.3|--draws|1|--methods|user_mean"),
    (2, "evaluate decision", "--methods|nonsense"),
    (0, "evaluate intents", "FOLDER/meant.jsonl"),
    (2, "evaluate intents", "FOLDER/bad.jsonl"),
    (0, "plugins", ""),
    (2, "plugins", "nonsense"),
    (0, "history", "--store|FOLDER/store.sqlite3"),
    (2, "history", "--store|FOLDER/store.sqlite3|--session|nonsense"),
    (1, "history", "--store|FOLDER/gain.csv"),
    (0, "history show", "1|--store|FOLDER/store.sqlite3"),
    (1, "history show", "1|--store|FOLDER/changed.sqlite3"),
    (2, "history show", "7|--store|FOLDER/store.sqlite3"),
    (0, "history replay", "1|--store|FOLDER/store.sqlite3"),
    (1, "history replay", "1|--store|FOLDER/changed.sqlite3"),
    (2, "history replay", "7|--store|FOLDER/store.sqlite3"),
    (0, "history export", "FOLDER/turns.jsonl|--store|FOLDER/store.sqlite3"),
    (2, "history export", "FOLDER/no/where.jsonl|--store|FOLDER/store.sqlite3"),
    (0, "history seal", "FOLDER/old.jsonl|--before|2999-01-01|--store|FOLDER/sealed.sqlite3"),
    (1, "history seal", "FOLDER/older.jsonl|--before|2999-01-01|--store|FOLDER/changed.sqlite3"),
    (2, "history seal", "FOLDER/no.jsonl|--store|FOLDER/store.sqlite3"),
    (2, "history seal", "FOLDER/no.jsonl|--session|nonsense|--store|FOLDER/store.sqlite3"),
    (0, "export", "1|--store|FOLDER/store.sqlite3"),
    (1, "export", "1|--store|FOLDER/changed.sqlite3"),
    (2, "export", "7|--store|FOLDER/store.sqlite3"),
    (0, "new-plugin", "objective|log_rate|--folder|FOLDER"),
    (2, "new-plugin", "objective|No Name|--folder|FOLDER"),
    (2, "warm-up", "nonsense"),
    (2, "nonsense", ""),
    (2, "", ""),
]


@pytest.mark.parametrize(("code", "command", "rest"), CASES)
def test_exit_codes(code: int, command: str, rest: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = [word.replace("FOLDER", str(folder)) for word in rest.split("|") if word]
    words = [word for given in words for word in (CELL if given == "CELL" else (given,))]
    assert run([*command.split(), *words]) == code, capsys.readouterr().err


def test_every_command_is_there() -> None:
    codes = {name: {code for code, command, _ in CASES if command == name} for name in OPERATIONS}
    assert not [name for name, found in codes.items() if not {0, 2} <= found and name != "warm-up"]  # takes minutes


def test_machine_code_that_cannot_be_kept_is_a_failure() -> None:
    assert WarmUpRecord(kernels=0, of=9, folder=None, time_s=0.0).conclusion == "failed"


def test_without_words_the_codes_are_the_same_in_json(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["solve", str(folder / "gain.csv"), "--min-rate-bps", "1e8", "--json"]) == 3
    assert json.loads(capsys.readouterr().out)["status"] == "infeasible"


@pytest.mark.parametrize("mood", ["fails", "falls short"])
def test_what_fails_at_the_base_station(mood: str, monkeypatch: pytest.MonkeyPatch) -> None:
    apply, told = SimulatedBaseStation.apply, list[wa.Decision]()

    def applied(self: SimulatedBaseStation, decision: wa.Decision) -> wa.Outcome:
        told.append(decision)
        outcome = apply(self, decision)
        if len(told) == 2 and mood == "fails":
            raise OSError("the link is down")
        return replace(outcome, power_w=outcome.power_w / 2) if len(told) == 2 else outcome

    monkeypatch.setattr(SimulatedBaseStation, "apply", applied)
    assert run(["chat", *CELL, "--say", SAID, "--say", "at least 20 kbit/s"]) == 1


@pytest.mark.parametrize("mood", ["fails", "falls short"])
def test_what_fails_at_the_first_and_has_nothing_to_go_back_to(
    mood: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    apply = SimulatedBaseStation.apply

    def applied(self: SimulatedBaseStation, decision: wa.Decision) -> wa.Outcome:
        if mood == "fails":
            raise OSError("the link is down")
        outcome = apply(self, decision)
        return replace(outcome, power_w=outcome.power_w / 2)

    monkeypatch.setattr(SimulatedBaseStation, "apply", applied)
    assert run(["ask", SAID, *CELL]) == 1
    assert "There is no earlier allocation to go back to." in " ".join("".join(capsys.readouterr()).split())
    assert run(["chat", *CELL, "--say", SAID]) == 1


def test_an_interruption(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(self: SimulatedBaseStation, decision: wa.Decision) -> wa.Outcome:
        raise KeyboardInterrupt

    monkeypatch.setattr(SimulatedBaseStation, "apply", interrupted)
    assert run(["ask", SAID, *CELL]) == 130
    assert run(["chat", *CELL, "--say", SAID]) == 130


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_whoever_typed_has_read_it(monkeypatch: pytest.MonkeyPatch) -> None:
    lines = iter(["make it nice"])

    def typed(prompt: str) -> str:
        return next(lines, "quit")

    monkeypatch.setattr("sys.stdin", _Terminal())
    monkeypatch.setattr("builtins.input", typed)
    assert run(["chat", *CELL]) == 0
