"""Tables, paragraphs and paths fit the output, also in Chinese; styles only where they are wanted."""

from __future__ import annotations

import io
import sys
from collections import Counter
from pathlib import Path

import pytest
from rich.cells import cell_len

from wirelessagent.interfaces import cli_output
from wirelessagent.interfaces.cli import run
from wirelessagent.interfaces.cli_layout import tabled, wrapped
from wirelessagent.operations.record import Block, Files, Record, Table

ENGLISH = Table(
    title="Users",
    columns=(
        "user", "subcarriers", "of them repaired", "power", "predicted rate (90 % band)", "committed (kept with)",
        "achieved rate",
    ),
    rows=(
        ("user 1", "0", "0", "0 W", "0 bit/s", "0 bit/s", "0 bit/s"),
        ("user 2", "12", "3", "982 mW", "1.21 (1.1–1.3) Mbit/s", "1.1 Mbit/s (100 %)", "1.2 Mbit/s (3 % short)"),
    ),
)  # fmt: skip
CHINESE = Table(
    title="用户",
    columns=("用户", "子载波", "其中修复的", "功率", "预测速率（90 % 区间）", "承诺速率（兑现概率）", "实现速率"),
    rows=(
        ("用户 1", "0", "0", "0 W", "0 bit/s", "0 bit/s", "0 bit/s"),
        ("用户 2", "12", "3", "982 mW", "1.21 (1.1–1.3) Mbit/s", "1.1 Mbit/s (100 %)", "1.2 Mbit/s（少 3 %）"),
    ),
)


@pytest.mark.parametrize("table", [ENGLISH, CHINESE], ids=["English", "Chinese"])
@pytest.mark.parametrize("width", [40, 60, 80, 160])
def test_tables_fit_and_lose_nothing(table: Table, width: int) -> None:
    lines = tabled(table.columns, table.rows, width)
    assert max(map(cell_len, lines)) <= width
    text = "\n".join(lines)
    assert not Counter("".join(cell for row in table.rows for cell in row).replace(" ", "")) - Counter(text)
    assert "1.1 Mbit/s" in text  # a figure stays with its unit
    assert "982 mW" in text
    assert "（\n" not in text


def test_columns_stand_under_each_other_in_chinese() -> None:
    lines = tabled(CHINESE.columns, CHINESE.rows, 160)
    ends = [
        cell_len(line[: line.index(figure)] + figure) for line, figure in zip(lines[2:], ("0 W", "982 mW"), strict=True)
    ]
    assert ends[0] == ends[1]
    assert all(cell_len(line) == cell_len(lines[1]) for line in lines[2:])


def test_paragraphs_in_chinese_are_folded_between_signs_and_not_before_a_full_stop() -> None:
    text = "在估计的信道上，这是最优的：界证明没有更好的分配。每个用户的速率以至少 99.9 % 的概率得到保证。"
    for width in range(10, 60):
        lines = wrapped(text, width)
        assert max(map(cell_len, lines)) <= width
        assert "".join(lines).replace(" ", "") == text.replace(" ", "")
        assert not any(line[0] in "，。：" for line in lines)


def test_what_is_longer_than_a_line_is_not_broken() -> None:
    path = f"/srv/{'measurements/' * 9}gains.npz"
    assert wrapped(f"{path}: 8 users", 40) == [f"{path}:", "8 users"]


@pytest.mark.parametrize("width", [60, 160])
def test_a_path_can_be_copied(
    width: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    folder = tmp_path / "a folder with spaces in its name and more of them than a line holds"
    folder.mkdir()
    out = folder / "seen.npz"
    assert run(["simulate", "--num-users", "2", "--out", str(out)]) == 0
    assert any(line.endswith(str(out)) for line in capsys.readouterr().out.splitlines())


class Shown(Record):
    def blocks(self) -> list[Block]:
        return [ENGLISH, Files("written to", (Path("a.csv"), Path("b.csv")))]


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_colours_go_to_terminals_that_want_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    said = {}
    for name, stream in (("terminal", Terminal()), ("pipe", io.StringIO())):
        monkeypatch.setattr(sys, "stdout", stream)
        cli_output.show(Shown())
        said[name] = stream.getvalue()
    assert "\x1b[1mUsers\x1b[0m" in said["terminal"]
    assert "\x1b" not in said["pipe"]
    assert said["pipe"].endswith("written to\na.csv\nb.csv\n")
    monkeypatch.setattr(sys, "stdout", plain := Terminal())
    monkeypatch.setenv("NO_COLOR", "1")
    cli_output.show(Shown())
    assert plain.getvalue() == said["pipe"]
