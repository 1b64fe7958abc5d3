"""What came from outside reaches a terminal as text and no more: every way out is walked with hostile names."""

from __future__ import annotations

import ast
import io
import json
import logging
import sys
import unicodedata
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wirelessagent
from wirelessagent.acting.simulated import SimulatedBaseStation
from wirelessagent.interfaces import cli_output
from wirelessagent.interfaces.cli import run
from wirelessagent.model.legible import legible
from wirelessagent.operations.catalogue import OPERATIONS
from wirelessagent.operations.operation import Event

pytestmark = pytest.mark.machine_code

HOSTILE = "\x1b[31mred\x9b2J\x7f\x07[bold]b[/bold][/]:warning:\u202eW 01\u2066\u2069\u200b\u3164\U000e0041\u2028"
FORGED = "Checked: nothing was changed"
LINES = f"{HOSTILE}\n{FORGED}\r"
USERS = tuple(f"{LINES}{k}" for k in range(3))


@pytest.fixture
def hostile(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of hostile name with a channel whose users, facts and base station have hostile names, and a store."""
    folder = tmp_path / LINES.replace("/", "|")
    folder.mkdir()
    gain = np.random.default_rng(3).exponential(1e-10, (3, 6))
    truth = gain.copy()
    gain[0, 2] = np.nan
    names = np.array(USERS)
    np.savez(folder / "gain.npz", gain=gain, truth=truth, user_names=names, meta=np.array(json.dumps({"axes": LINES})))
    np.savez(folder / "seen.npz", gain=gain, truth=truth, user_names=names)
    np.savez(folder / "complete.npz", gain=truth, user_names=names)
    (folder / "said.jsonl").write_text(json.dumps({"text": LINES}) + f"\n{LINES}\n", encoding="utf-8")
    meant = {"language": "en", "kind": "allocate", "objective": "max_rate", "constraints": {}}
    (folder / "meant.jsonl").write_text(json.dumps({"text": LINES, **meant}) + "\n", encoding="utf-8")
    apply = SimulatedBaseStation.apply
    monkeypatch.setattr(
        SimulatedBaseStation, "apply", lambda self, decision: replace(apply(self, decision), base_station=LINES)
    )
    monkeypatch.setenv("WIRELESSAGENT_STORE_URL", str(folder / "audit.sqlite3"))
    return folder


def ways(folder: Path) -> list[list[str]]:
    """Commands, at least one for each operation, with hostile text wherever text goes in."""
    seen, asked = str(folder / "seen.npz"), ["--csi", str(folder / "seen.npz")]
    evaluated = [str(folder / "complete.npz"), "--loss", "random:0.3", "--draws", "1", "--methods", "user_mean"]
    return [
        ["ask", "Highest total rate", *asked],
        ["ask", f"Least power, 100 kbit/s each, {LINES}", *asked],
        ["ask", "Least power, 1 kbit/s each", *asked, "--plot", str(folder / "a.png"), "--out", str(folder / "a.json")],
        ["chat", *asked, "--say", "Least power, 1 kbit/s each", "--say", f"user {HOSTILE} gets 1 Mbit/s",
         "--say", "Serve user 9", "--say", LINES, "--say", "why does user 1 get so little?", "--say", "history",
         "--say", "what do the users get?", "--say", "每用户 10 kbit/s，功率最低"],
        ["intent", LINES],
        ["intent", "--batch", str(folder / "said.jsonl")],
        ["simulate", "--num-users", "2", "--num-subcarriers", "4", "--out", str(folder / "s.npz")],
        ["repair", seen, "--out", str(folder / "r.npz")],
        ["repair", str(folder / "gain.npz")],
        ["solve", seen, "--objective", "min_power", "--min-rate-bps", "1e3", "--out", str(folder / "a.csv")],
        ["solve", seen, "--users", HOSTILE],
        ["solve", str(folder / "no.csv")],
        ["solve", seen, "--objective", LINES],
        ["compare", seen, "--methods", "dual,greedy,exact", "--objective", "min_power", "--min-rate-bps", "1e8"],
        ["reproduce", LINES],
        ["evaluate repair", *evaluated],
        ["evaluate decision", *evaluated],
        ["evaluate intents", str(folder / "meant.jsonl"), "--errors"],
        ["plugins", "--kind", LINES],
        ["new-plugin", "objective", LINES],
        ["warm-up", LINES],
        ["history"],
        ["history", "--session", LINES],
        ["history show", "1"],
        ["history show", "2"],
        ["history replay", "1"],
        ["history export", str(folder / "turns.jsonl")],
        ["history seal", str(folder / "old.jsonl"), "--session", LINES],
        ["export", "1"],
        ["export", "1", "--format", "tmf921", "--out", str(folder / "intent.json")],
        [LINES],
        ["ask", "--" + LINES],
        ["solve", seen, "--effort", LINES],
        ["history", "--store", f"sqlite://{LINES}"],
    ]  # fmt: skip


def check(shown: str) -> None:
    """No sign that a terminal acts on or hides, no line that was not ours, and hostile markup as it was written."""
    kinds = {sign: unicodedata.category(sign) for sign in shown if sign != "\n"}
    assert not [sign for sign, kind in kinds.items() if kind in ("Cc", "Cf", "Zl", "Zp") or sign == "\u3164"]
    assert not [line for line in shown.splitlines() if line.strip().startswith(FORGED)]
    assert "⚠" not in shown


@pytest.mark.parametrize("as_json", [False, True], ids=["text", "json"])
def test_every_way_out(as_json: bool, hostile: Path, capsys: pytest.CaptureFixture[str]) -> None:
    walked = ways(hostile)
    assert {way[0] for way in walked} >= set(OPERATIONS)
    for way in walked:
        command = way[0].split() if way[0] != LINES else [LINES]
        code = run([*command, *way[1:], *["--json"] * as_json])
        streams = capsys.readouterr()
        assert "internal error" not in streams.err, way
        check(streams.out + streams.err)
        if as_json and streams.out and code == 0 and way[0] not in ("chat", "intent"):
            json.loads(streams.out)


def test_json_holds_what_was_there(hostile: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["ask", "Highest total rate", "--csi", str(hostile / "seen.npz"), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["decision"]["user_names"] == list(USERS)
    assert found["outcome"]["base_station"] == LINES
    assert run(["intent", f"Highest total rate {HOSTILE}", "--json"]) in (0, 2)
    assert json.loads(capsys.readouterr().out)["text"] == f"Highest total rate {HOSTILE}"


def test_names_are_shown_with_their_markup(hostile: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["repair", str(hostile / "seen.npz")]) == 0
    shown = "".join(capsys.readouterr().out.split())
    assert "[bold]b[/bold][/]:warning:" in shown


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_on_a_terminal_too(hostile: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """There, the only escape sequences are the program's own colours."""
    out, error = _Terminal(), _Terminal()
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setattr(sys, "stderr", error)
    monkeypatch.setenv("TERM", "xterm-256color")
    with cli_output.Listener() as listener:
        listener(Event(stage=HOSTILE, message=LINES))
        listener(Event(stage=HOSTILE, message=LINES, done=1, total=1))
    assert run(["repair", str(hostile / "seen.npz")]) == 0
    for text in (out.getvalue(), error.getvalue()):
        assert not set("\x9b\x7f\x07\u202e\u2066\u200b\u2028\u3164⚠").intersection(text)
        assert "\x1b[31m" not in text
        assert "[bold]b[/bold][/]:warning:" in "".join(text.split())


def test_notes_and_warnings(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(logging, "lastResort", logging.lastResort)
    cli_output.take_over(notes=True)
    for name in ("wirelessagent.store", "wirelessagent.kernels.compiling"):
        logging.getLogger(name).warning("not recorded: %s", LINES)
    assert logging.lastResort is not None
    logging.lastResort.handle(logging.LogRecord("other", logging.WARNING, "", 0, LINES, None, None))
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.warn(LINES, RuntimeWarning, stacklevel=1)
    streams = capsys.readouterr()
    assert len(streams.err.splitlines()) == 4
    check(streams.err)


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp1252"])
def test_json_in_any_encoding(encoding: str, monkeypatch: pytest.MonkeyPatch) -> None:
    written = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(written, encoding=encoding))
    cli_output.take_over(notes=False)
    cli_output.show_json(json.dumps({"said": f"é 用户 😀 {HOSTILE}"}, ensure_ascii=False))
    assert json.loads(written.getvalue().decode(encoding)) == {"said": f"é 用户 😀 {HOSTILE}"}


@pytest.mark.parametrize("sign", [*map(chr, (*range(32), *range(0x7F, 0xA0), *range(0x202A, 0x202F),
                                             *range(0x2066, 0x206A), 0x200B, 0xFEFF, 0xE0041, 0xD800))])  # fmt: skip
def test_signs(sign: str) -> None:
    assert sign not in legible(f"a{sign}b", keep="")
    assert json.loads(legible(json.dumps({"a": sign}, ensure_ascii=False))) == {"a": sign}


def test_there_is_one_door() -> None:
    """Nothing but the output's module prints or makes a console; ``__main__`` tells of an interruption."""
    package = Path(str(wirelessagent.__file__)).parent
    doors = {
        path.relative_to(package).as_posix()
        for path in package.rglob("*.py")
        if "training" not in path.parts and any(map(_prints, ast.walk(ast.parse(path.read_text(encoding="utf-8")))))
    }
    assert doors == {"interfaces/cli_output.py", "__main__.py"}


def _prints(node: ast.AST) -> bool:
    if not isinstance(node, ast.Call):
        return False
    called: Callable[[Any], str] = ast.unparse
    name = called(node.func)
    return name in ("print", "Console", "click.echo", "sys.stdout.write", "sys.stderr.write") or (
        name.startswith("rich.") and "markup" not in name
    )
