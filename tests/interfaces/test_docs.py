"""What the documentation shows works: Python blocks and commands of the pages, and the examples in docstrings."""

from __future__ import annotations

import doctest
import importlib
import pkgutil
import re
import shlex
import shutil
import sys
import types
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import wirelessagent
from wirelessagent.interfaces.cli import run

pytestmark = pytest.mark.machine_code

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
SLOW = {"reproduce", "evaluate", "serve", "mcp"}
"""Commands of minutes or without an end; their own tests run them."""


def blocks(page: Path, language: str) -> list[tuple[int, str]]:
    """(line number, text) of every fenced block of a language."""
    text = page.read_text(encoding="utf-8")
    found = re.finditer(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    return [(text.count("\n", 0, match.start(1)) + 1, match.group(1)) for match in found]


def commands(page: Path) -> list[str]:
    """Every call of the command line in the page's console and shell blocks."""
    lines = [
        line
        for language in ("console", "sh", "bash")
        for _, text in blocks(page, language)
        for line in text.split("\n")
    ]
    stripped = [line.removeprefix("$ ").strip() for line in lines]
    return [line for line in stripped if line.startswith("wirelessagent ")]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where examples run: an empty folder with the examples' data and matrices of the reader's own."""
    shutil.copytree(ROOT / "examples" / "data", tmp_path / "examples" / "data")
    gain = np.random.default_rng(1).exponential(1e-10, (4, 12))
    gain[1, 3] = np.nan
    np.savetxt(tmp_path / "gains.csv", gain, delimiter=",")
    np.savetxt(tmp_path / "my_gains.csv", 10 * np.log10(gain), delimiter=",")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def namespace() -> Iterator[types.ModuleType]:
    """A module that a page's blocks share, so that dataclasses in it find their annotations."""
    module = types.ModuleType("page_of_the_documentation")
    sys.modules[module.__name__] = module
    yield module
    del sys.modules[module.__name__]


def with_blocks(language: str) -> list[Path]:
    return [page for page in PAGES if blocks(page, language)]


@pytest.mark.parametrize("page", with_blocks("python"), ids=lambda page: page.name)
def test_python_blocks_run_in_order(page: Path, folder: Path, namespace: types.ModuleType) -> None:
    for line, text in blocks(page, "python"):
        code = compile("\n" * (line - 1) + text, str(page), "exec")  # so that a traceback shows the page's line
        exec(code, vars(namespace))


@pytest.mark.parametrize("page", [page for page in PAGES if commands(page)], ids=lambda page: page.name)
def test_commands_run_in_order(
    page: Path, folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("WIRELESSAGENT_STORE_URL", str(folder / "audit.sqlite3"))  # of which turn 1 is the page's
    for command in commands(page):
        _, *arguments = shlex.split(command, comments=True)
        if arguments[0] not in SLOW:
            assert run(arguments) == 0, f"{command}\n{capsys.readouterr().err}"


def test_there_are_blocks_to_run() -> None:
    assert {"index.md", "plugins.md"} <= {page.name for page in with_blocks("python")}
    assert "cli.md" in {page.name for page in PAGES if commands(page)}


def modules() -> list[str]:
    """Every module of the package whose docstrings show an example."""
    found = pkgutil.walk_packages(wirelessagent.__path__, "wirelessagent.")
    sources = {"wirelessagent": ROOT / "src" / "wirelessagent" / "__init__.py"}
    for item in found:
        relative = Path(*item.name.split("."))
        package = ROOT / "src" / relative / "__init__.py"
        sources[item.name] = package if item.ispkg else (ROOT / "src" / relative).with_suffix(".py")
    return sorted(name for name, path in sources.items() if ">>> " in path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", modules())
def test_examples_in_docstrings(name: str, folder: Path) -> None:
    result = doctest.testmod(importlib.import_module(name))
    assert result.attempted > 0
    assert result.failed == 0
