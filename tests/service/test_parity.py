"""The same request gives the same record on the command line and over REST, but for what is of the surface."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from servers import Server

pytestmark = pytest.mark.machine_code


def _command(*arguments: str) -> Any:
    done = subprocess.run(
        [sys.executable, "-m", "wirelessagent", *arguments, "--json"], capture_output=True, text=True, check=False
    )
    assert done.returncode in (0, 2, 3), done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize(
    "form",
    [
        {"objective": "max_rate"},
        {"objective": "min_power", "min_rate_bps": 100_000.0},
        {"objective": "max_rate", "min_rate_bps": 1e12},
        {"objective": "proportional_fairness", "max_power_w": 5.0},
    ],
)
def test_solving(server: Server, tmp_path: Path, form: dict[str, Any]) -> None:
    gains = "1e-9,2e-9,,4e-9\n2e-9,1e-9,3e-9,1e-9\n"
    file = tmp_path / "gains.csv"
    file.write_text(gains)
    headers = {"Content-Type": "application/octet-stream"}
    seen = server.post("v1/observations?name=gains.csv", content=gains, headers=headers).json()
    over_rest = server.post("v1/operations/solve", {**form, "observation": seen["id"]}).json()["record"]
    flags = [part for name, value in form.items() for part in (f"--{name.replace('_', '-')}", str(value))]
    assert over_rest == _command("solve", str(file), *flags)


def test_simulating_and_reading_a_sentence(server: Server) -> None:
    simulated = server.post("v1/operations/simulate", {"seed": 7, "loss": ["random:0.3"]}).json()["record"]
    assert simulated == _command("simulate", "--seed", "7", "--loss", "random:0.3")
    read = server.post("v1/operations/intent", {"text": "最大总速率，功率不超过 10 W"}).json()["record"]
    assert read == _command("intent", "最大总速率，功率不超过 10 W")


def test_a_conversation(server: Server) -> None:
    """A server waits for a yes where a simulated base station on the command line does not."""
    lines = ["Save power, at least 1 Mbit/s each", "how sure is this?", "what if we had 10 W?", "who has subcarrier 5?"]
    session = server.cell()["session"]
    over_rest = [server.say(session, line) for line in lines]
    asked = [part for line in lines for part in ("--say", line)]
    done = subprocess.run(
        [sys.executable, "-m", "wirelessagent", "chat", "--json", "--no-store", *asked], capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    typed = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(typed) == len(lines)
    for here, there in zip(over_rest, typed, strict=True):
        for name in ("number", "text", "request", "decision", "recogniser", "seed", "version"):
            assert here[name] == there[name]
        for name in ("kind", "objective", "constraints", "acts", "diff"):
            assert here["intent"][name] == there["intent"][name]
