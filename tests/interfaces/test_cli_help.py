"""What the command line tells those who ask: help that is quick and short, help with everything, and completion."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path

import click
import pytest
from rich.cells import cell_len

from wirelessagent.interfaces.cli import run
from wirelessagent.interfaces.cli_commands import Commands
from wirelessagent.operations.catalogue import FAMILIES, GROUPS, OPERATIONS, load
from wirelessagent.operations.operation import AnyOperation, InputError
from wirelessagent.plugins import names

HEAVY = {"numpy", "scipy", "numba", "sqlalchemy", "h5py", "matplotlib", "rich.console"}


def shown(capsys: pytest.CaptureFixture[str], *arguments: str, code: int = 0) -> str:
    assert run([*arguments]) == code
    return capsys.readouterr().out


def listed(text: str) -> list[str]:
    """The options that a page of help lists."""
    return [line.split()[0].rstrip(",") for line in text.splitlines() if line.startswith("  -")]


def program() -> Commands:
    def perform(operation: AnyOperation, values: dict[str, object], as_json: bool) -> int:
        raise AssertionError("nothing is to be done")

    return Commands("", perform)


@pytest.mark.parametrize("arguments", [["--help"], ["ask", "--help"], ["solve", "--help"]])
def test_help_comes_before_what_it_is_about_is_loaded(arguments: list[str]) -> None:
    code = (
        f"import sys; from wirelessagent.interfaces.cli import run; run({arguments!r}); "
        f"sys.exit(', '.join(sorted(set(sys.modules) & {HEAVY!r})))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False)
    assert done.stderr.strip() == ""
    assert "Usage: wirelessagent" in done.stdout


def test_an_answer_loads_nothing_that_it_does_not_need() -> None:
    code = (
        "import re._compiler as compiler, sys; made = []; compile = compiler.compile\n"
        "compiler.compile = lambda *given: made.append(sys._getframe(2).f_code.co_filename) or compile(*given)\n"
        "from wirelessagent.language.offline import OfflineRecogniser\n"
        "from wirelessagent.interfaces.cli import run; run(['ask', 'Share fairly', '--no-store', '--json'])\n"
        "heavy = 'scipy.linalg scipy.special scipy.optimize sqlalchemy h5py matplotlib rich.console'.split()\n"
        "loaded = {*heavy} & set(sys.modules)\n"
        "sys.exit(f'{sorted(loaded)} {len(made)}')"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300, check=False)
    loaded, _, expressions = done.stderr.splitlines()[-1].rpartition(" ")
    assert loaded == "[]"
    assert int(expressions) < 300  # more than 500 if all are made that there are


def test_every_operation_has_a_place_in_the_list_and_is_what_it_is_called() -> None:
    first_words = [name for names in GROUPS.values() for name in names]
    assert sorted(first_words) == sorted({name.split()[0] for name in OPERATIONS})
    assert set(FAMILIES) == set(first_words) - set(OPERATIONS)
    assert [load(name).name for name in OPERATIONS] == list(OPERATIONS)
    with pytest.raises(InputError, match="unknown command 'askk': did you mean 'ask'"):
        load("askk")


def test_the_list_of_commands_stands_in_groups(capsys: pytest.CaptureFixture[str]) -> None:
    page = shown(capsys, "--help")
    places = [page.index(f"\n{title}:\n") for title in GROUPS]
    assert places == sorted(places)
    assert page.index("\n  ask ") < page.index("\n  simulate ") < page.index("\n  history ")


def test_plain_help_has_what_people_use_and_help_all_the_rest(capsys: pytest.CaptureFixture[str]) -> None:
    plain, everything = shown(capsys, "ask", "--help"), shown(capsys, "ask", "--help-all")
    assert set(listed(plain)) == {
        "--out", "--plot", "--csi", "--loss", "--yes", "--seed", "--recogniser", "--method", "--repairer",
        "--cell-max-power-w", "--full", "--json", "-h", "--help-all",
    }  # fmt: skip
    assert set(listed(plain)) < set(listed(everything))
    for option in ("--snr-gap-db", "--num-users", "--effort", "--no-store", "--path"):
        assert option in listed(everything)
    assert 'wirelessagent ask "Higher speed for video streaming"' in plain
    for page in (plain, everything):
        assert all(name in page for name in names("method"))
    assert "when_weak:RATE[,STRENGTH]" in everything


@pytest.mark.parametrize("name", OPERATIONS)
def test_examples_are_commands_that_there_are(name: str) -> None:
    operation = load(name)
    assert operation.examples
    root = program()
    for typed in operation.examples:
        words = shlex.split(typed)
        assert typed.split()[: len(name.split())] == name.split() or name == "history"
        context = root.make_context("wirelessagent", words)
        while isinstance(context.command, click.Group) and (context._protected_args or context.args):
            word, command, rest = context.command.resolve_command(context, [*context._protected_args, *context.args])
            assert command is not None
            context = command.make_context(word, rest, parent=context)


@pytest.mark.parametrize("width", [60, 80, 160])
@pytest.mark.parametrize("arguments", [["--help"], ["ask", "--help"], ["solve", "--help-all"]], ids=" ".join)
def test_help_fits_the_width_and_breaks_no_name(
    arguments: list[str], width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    page = shown(capsys, *arguments)
    lines = [line for line in page.splitlines() if not line.startswith("  wirelessagent ")]  # examples are to be copied
    assert max(map(cell_len, lines)) <= width
    if "solve" in arguments:
        assert "--max-spectral-efficiency-bps-per-hz NUMBER" in page


def test_options_of_plugins_are_looked_for_where_one_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["simulate", "--num-usrs", "3"]) == 2
    assert "--num-users" in capsys.readouterr().err
    assert run(["simulate", "--num-users", "3", "--json"]) == 0
    assert '"num_users": 3' in capsys.readouterr().out


def completions(typed: str) -> list[str]:
    """What bash is told may follow, for the last word of what is typed."""
    words = typed.split(" ")
    told = {**os.environ, "_WIRELESSAGENT_COMPLETE": "bash_complete", "COMP_WORDS": typed,
            "COMP_CWORD": str(len(words) - 1)}  # fmt: skip
    done = subprocess.run(
        [sys.executable, "-m", "wirelessagent"], env=told, capture_output=True, text=True, timeout=120, check=True
    )
    assert done.stderr == ""
    return [line.partition(",")[2] for line in done.stdout.splitlines()]


@pytest.mark.parametrize(
    ("typed", "found"),
    [
        ("wirelessagent s", ["simulate", "solve", "serve"]),
        ("wirelessagent history ", ["show", "replay", "export", "seal"]),
        ("wirelessagent ask --se", ["--seed"]),
        ("wirelessagent ask --num-us", ["--num-users"]),
        ("wirelessagent solve x.npz --method gr", ["greedy"]),
        ("wirelessagent repair x.npz --method user", ["user_mean"]),
        ("wirelessagent ask --recogniser ", ["offline", "llm"]),
        ("wirelessagent solve --unit ", ["linear", "db", "complex"]),
    ],
)
def test_a_shell_completes(typed: str, found: list[str]) -> None:
    assert completions(typed) == found


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_is_shown_and_installed_once(
    shell: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("HOME", "XDG_DATA_HOME", "XDG_CONFIG_HOME", "ZDOTDIR"):
        monkeypatch.setenv(name, str(tmp_path))
    monkeypatch.setenv("SHELL", f"/usr/bin/{shell}")
    script = shown(capsys, "--show-completion")
    assert f"_WIRELESSAGENT_COMPLETE={shell}_complete" in script
    (tmp_path / f".{shell}rc").write_text("alias ll='ls -l'")
    for _ in range(2):
        said = shown(capsys, "--install-completion", shell)
    place = next(Path(line) for line in said.splitlines() if line.startswith(str(tmp_path)))
    assert place.read_text(encoding="utf-8").strip() == script.strip()
    start = (tmp_path / f".{shell}rc").read_text(encoding="utf-8").splitlines()
    assert start[0] == "alias ll='ls -l'"
    assert len(start) == (1 if shell == "fish" else 2)


def test_completion_for_another_shell_is_refused(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("SHELL", "/bin/tcsh")
    assert run(["--show-completion"]) == 2
    assert "got 'tcsh'" in capsys.readouterr().err
