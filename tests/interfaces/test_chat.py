"""Conversations on the command line: from a script, a pipe and a terminal, in words and as JSON; and of one turn."""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import signal
import sys
from pathlib import Path

import pytest

from wirelessagent.acting.file import FileBaseStation
from wirelessagent.interfaces.cli import run
from wirelessagent.operations.chat import ChatRequest
from wirelessagent.operations.chat import converse as begun
from wirelessagent.operations.chat import run as chat
from wirelessagent.operations.operation import InputError, silent

pytestmark = pytest.mark.machine_code

CELL = ("--num-users", "3", "--seed", "3")
SAID = ["Highest total rate, at most 10 W", "", "Save power, 500 kbit/s each"]


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "said.txt"
    path.write_text("\n".join([*SAID, "quit", "maximum rate"]), encoding="utf-8")
    return path


def test_a_script_is_read_to_its_end_or_until_leave_is_taken(
    script: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "240")  # room for each heading on one line
    assert run(["chat", *CELL, "--script", str(script)]) == 0
    told = capsys.readouterr().out
    assert [line for line in told.splitlines() if line.startswith("> ")] == [f"> {SAID[0]}", f"> {SAID[2]}", "> quit"]
    assert "at most 10 W" in told
    assert "500 kbit/s for each user" in " ".join(told.split())
    assert "achieved rate" not in told  # tables come when they are asked for


def test_json_is_a_line_per_turn(script: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["chat", *CELL, "--script", str(script), "--json"]) == 0
    turns = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [turn["number"] for turn in turns] == [1, 2]
    assert [turn["request"]["objective"] for turn in turns] == ["max_rate", "min_power"]
    assert turns[1]["request"]["constraints"] == {"max_power_w": 10.0, "min_rate_bps": 500e3}
    assert turns[1]["decision"]["unit"] == "W"
    assert turns[1]["outcome"]["power_w"] == turns[1]["decision"]["power_w"]
    assert turns[0]["session"] == turns[1]["session"]
    assert turns[1]["stored"] == turns[0]["stored"] + 1
    assert turns[0]["tables"][0]["title"] == "Users"


def test_lines_come_from_a_pipe(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("maximum rate\r\n"))
    assert run(["chat", *CELL]) == 0
    assert "The highest total rate." in capsys.readouterr().out


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_lines_come_from_a_terminal_until_it_ends(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "stdin", Terminal("maximum rate\n"))
    assert run(["chat", *CELL]) == 0
    assert "> The highest total rate." in capsys.readouterr().out  # what was typed stands there already


def test_an_interrupt_is_no_traceback(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(prompt: str) -> str:
        raise KeyboardInterrupt

    monkeypatch.setattr(sys, "stdin", Terminal())
    monkeypatch.setattr("builtins.input", interrupted)
    assert run(["chat", *CELL]) == 130
    streams = capsys.readouterr()
    assert streams.err == ""
    assert streams.out.endswith("\n")  # the shell's prompt gets a line of its own


def test_what_can_be_said_is_told_to_those_who_type(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for stdin, options, told in ((Terminal("quit\n"), [], True), (io.StringIO("quit\n"), [], False),
                                 (Terminal("quit\n"), ["--json"], False)):  # fmt: skip
        monkeypatch.setattr(sys, "stdin", stdin)
        assert run(["chat", *CELL, *options]) == 0
        assert ("Say what the cell should do" in capsys.readouterr().out) == told


def test_every_line_that_the_opening_names_is_understood() -> None:
    opening = begun(ChatRequest(source_options={"num_users": 3}), silent).opening
    lines = re.findall(r'"([^"]+)"', opening)
    assert lines[-1] == "quit"
    record = chat(ChatRequest(say=lines, source_options={"num_users": 3}), silent)
    assert [turn.stage for turn in record.turns] == ["applied", "applied", "answered", "answered", "undone"]


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pseudo-terminals")
@pytest.mark.parametrize(("keys", "code"), [(b"\x04", 0), (b"\x03", 130), (b"quot\x7f\x7fit\r", 0)])
def test_a_terminal_has_a_prompt_and_editing_and_lets_people_leave(keys: bytes, code: int) -> None:
    import pty
    import select

    child, terminal = pty.fork()
    if child == 0:
        signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell ignores in the background
        os.execv(sys.executable, [sys.executable, "-m", "wirelessagent", "chat", *CELL])
    shown = b""
    while b"> " not in shown.split(b"\n")[-1] and select.select([terminal], [], [], 60.0)[0]:
        shown += os.read(terminal, 1024)
    with contextlib.suppress(OSError):  # how Linux tells the end; others read nothing
        more, tries = b" ", 0
        while more and tries < 20:
            tries += 1
            os.write(terminal, keys)  # again where line editing took the terminal over and dropped what was typed
            while more and select.select([terminal], [], [], 2.0)[0]:
                more = os.read(terminal, 1024)
                shown += more
    if tries == 20:
        os.kill(child, signal.SIGKILL)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == code
    assert b"Traceback" not in shown
    assert shown.endswith(b"\n")
    assert b"Say what the cell should do" in shown


def test_a_base_station_asks_unless_it_is_told_yes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "allocation.json"
    options = ["chat", *CELL, "--base-station", "file", "--path", str(out), "--say", "maximum rate", "--json"]
    assert run(options) == 2
    assert json.loads(capsys.readouterr().out)["awaits"] == "confirmation"
    assert not out.exists()
    assert run([*options, "--yes"]) == 0
    assert json.loads(capsys.readouterr().out)["stage"] == "applied"
    assert out.exists()


def test_what_is_said_comes_from_one_place(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["chat", *CELL, "--script", "no.txt"]) == 2
    assert "no.txt cannot be read" in capsys.readouterr().err
    (tmp_path / "latin.txt").write_bytes(b"d\xe9bit")
    assert run(["chat", *CELL, "--script", str(tmp_path / "latin.txt")]) == 2
    assert run(["chat", *CELL, "--script", "no.txt", "--say", "maximum rate"]) == 2
    assert "not from both" in capsys.readouterr().err


def test_without_a_terminal_the_request_says_it_all() -> None:
    record = chat(ChatRequest(say=["maximum rate", "make it nice"], source_options={"num_users": 3}), silent)
    assert [turn.stage for turn in record.turns] == ["applied", "asked"]
    assert record.conclusion == "unclear"
    with pytest.raises(InputError, match="nothing is said"):
        chat(ChatRequest(), silent)


def test_a_request_by_itself_asks_as_well(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "allocation.json"
    command = ["ask", "maximum rate", *CELL, "--base-station", "file", "--path", str(out)]
    assert run(command) == 2
    assert "--yes applies it." in capsys.readouterr().out
    assert not out.exists()
    assert run([*command, "--json"]) == 2
    record = json.loads(capsys.readouterr().out)
    assert (record["stage"], record["waits"], record["outcome"]) == ("planned", True, None)
    assert run([*command, "--yes", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert (record["stage"], record["waits"], record["outcome"]["base_station"]) == ("applied", False, "file")
    assert out.exists()


def test_a_base_station_that_fails_is_a_failure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(self: FileBaseStation, decision: object) -> None:
        raise OSError("the link broke off")

    command = ["ask", "maximum rate", *CELL, "--base-station", "file", "--yes", "--path"]
    assert run([*command, str(tmp_path / "none" / "allocation.json")]) == 2  # nothing was touched yet
    assert "create it first" in capsys.readouterr().err
    monkeypatch.setattr(FileBaseStation, "apply", broken)
    assert run([*command, str(tmp_path / "allocation.json")]) == 1
    assert "The base station file failed: the link broke off." in capsys.readouterr().err


def test_a_question_by_itself_is_answered_or_asked_back(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["ask", "undo", *CELL, "--json"]) == 2
    record = json.loads(capsys.readouterr().out)
    assert (record["stage"], record["decision"]) == ("nothing", None)
    assert record["reply"] == "There is nothing to undo."
