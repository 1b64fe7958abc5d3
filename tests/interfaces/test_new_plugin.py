"""new-plugin: for each kind it writes a package whose own tests pass once it is installed."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from wirelessagent import plugins
from wirelessagent.interfaces.cli import run
from wirelessagent.operations.new_plugin import package_files

pytestmark = pytest.mark.machine_code

ROOT = Path(__file__).parents[2]
NAMES = {
    "channel_source": "free_space",
    "repairer": "nearest",
    "objective": "log_rate",
    "method": "best_pair",
    "base_station": "journal",
}
"""The examples of docs/plugins.md."""


def install(package: Path, site: Path) -> None:
    """The package on the path with its entry points, as an installer would leave it."""
    project = tomllib.loads((package / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for module in package.glob("*.py"):
        (site / module.name).write_bytes(module.read_bytes())
    info = site / f"{project['name'].replace('-', '_')}-{project['version']}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n")
    groups = project["entry-points"].items()
    lines = [line for group, entries in groups for line in (f"[{group}]", *(f"{k} = {v}" for k, v in entries.items()))]
    (info / "entry_points.txt").write_text("\n".join(lines))


def test_the_packages_of_all_kinds_pass_their_own_tests(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert NAMES.keys() == set(plugins.KINDS)
    site = tmp_path / "site"
    site.mkdir()
    for kind, name in NAMES.items():
        assert run(["new-plugin", kind, name, "--folder", str(tmp_path), "--json"]) == 0
        record = json.loads(capsys.readouterr().out)
        package = Path(record["folder"])
        assert package == tmp_path / f"wirelessagent-{name.replace('_', '-')}"
        assert all((package / file).is_file() for file in record["files"])
        install(package, site)
    tests = [str(found) for found in sorted(tmp_path.glob("wirelessagent-*/tests"))]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--import-mode=importlib", *tests],
        capture_output=True,
        text=True,
        timeout=600,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "src"), str(site)])},
        check=False,
    )
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("kind", plugins.KINDS)
def test_a_package_imports_from_one_public_place(kind: plugins.Kind) -> None:
    files = package_files(kind, NAMES[kind])
    assert "import wirelessagent as wa\n" in files[f"wirelessagent_{NAMES[kind]}.py"]
    assert [
        text for text in files.values() if re.search(r"wirelessagent\.\w+ import|import wirelessagent\.", text)
    ] == []


@pytest.mark.parametrize("kind", plugins.KINDS)
def test_the_documentation_shows_what_is_written(kind: plugins.Kind) -> None:
    """But for imports and what options are: the page shows each example once."""
    name = NAMES[kind]
    module = package_files(kind, name)[f"wirelessagent_{name}.py"]
    written = module[module.index("@dataclass") :]
    written = re.sub(r"\n\n    Attributes:\n(        .*\n)+    \"\"\"", '"""', written)
    assert written.strip() in (ROOT / "docs" / "plugins.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["objectve", "log_rate"], "did you mean 'objective'?"),
        (["objective", "Log-Rate"], "lower case with underscores, as in log_rate; got 'Log-Rate'"),
        (["objective", "../evil"], "lower case with underscores"),
        (["objective", "max_rate"], "the name 'max_rate' is taken"),
        (["objective", "log_rate", "--folder", "nowhere"], "cannot write nowhere"),
    ],
)
def test_what_cannot_be_written_is_refused(
    arguments: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["new-plugin", *arguments]) == 2
    assert said in " ".join(capsys.readouterr().err.split())
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_overwritten(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["new-plugin", "channel-source", "free_space", "--folder", str(tmp_path)]
    assert run(arguments) == 0
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")}
    assert run(arguments) == 2
    assert "is there already" in " ".join(capsys.readouterr().err.split())
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")} == before
