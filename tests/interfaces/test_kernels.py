"""The kernel door: an edited kernel takes effect, and no cache can harm or mislead."""

from __future__ import annotations

import ast
import errno
import functools
import itertools
import json
import os
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from numba.core import caching, config

import wirelessagent
from wirelessagent import kernels

PACKAGE = Path(wirelessagent.__file__).parent

INNER = """
from wirelessagent.kernels import kernel

@kernel
def inner(x):
    return x + 1.0
"""

OUTER = """
from wirelessagent.kernels import kernel
from wirelessagent.trial.inner_kernel import inner

@kernel
def outer(x):
    return inner(x) * 2.0
"""

RUN = """
import json
from wirelessagent.trial.outer_kernel import outer
value = outer(3.0)
print(json.dumps([value, sum(outer.stats.cache_hits.values()), outer.stats.cache_path]))
"""


class Install:
    """A copy of the package with two kernels of which one calls the other, and a user with a home of their own."""

    def __init__(self, folder: Path) -> None:
        self.site, self.home, self.temp = folder / "site", folder / "home", folder / "temp"
        self.trial = self.site / "wirelessagent" / "trial"
        shutil.copytree(PACKAGE, self.site / "wirelessagent", ignore=shutil.ignore_patterns("__pycache__"))
        for made in (self.trial, self.home, self.temp):
            made.mkdir()
        (self.trial / "__init__.py").touch()
        (self.trial / "inner_kernel.py").write_text(INNER)
        (self.trial / "outer_kernel.py").write_text(OUTER)

    def start(self, **environment: str) -> subprocess.Popen[str]:
        kept = {name: value for name, value in os.environ.items() if not name.startswith(("NUMBA", "XDG", "PYTHON"))}
        settings = {"PYTHONPATH": str(self.site), "HOME": str(self.home), "TMPDIR": str(self.temp)}
        return subprocess.Popen(
            [sys.executable, "-W", "error", "-c", RUN],
            env={**kept, **settings, **environment},
            cwd=self.temp,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def run(self, **environment: str) -> tuple[float, int, str | None]:
        """The kernel's result in a new process, how often its cache was hit, and where that is."""
        return answer_of(self.start(**environment))


def answer_of(process: subprocess.Popen[str]) -> tuple[float, int, str | None]:
    out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    value, hits, path = json.loads(out)
    return value, hits, path


@pytest.fixture
def install(tmp_path: Path) -> Install:
    return Install(tmp_path)


def test_an_edited_kernel_takes_effect_in_the_kernel_that_calls_it(install: Install) -> None:
    inner = install.trial / "inner_kernel.py"
    assert install.run()[:2] == (8.0, 0)
    assert install.run()[:2] == (8.0, 1)
    inner.write_text(INNER.replace("x + 1.0", "x + 2.0"))
    assert install.run()[:2] == (10.0, 0)
    inner.write_text(INNER)
    assert install.run()[:2] == (8.0, 1)
    assert list(install.temp.iterdir()) == []


@pytest.mark.parametrize(
    "environment",
    [{"HOME": "/dev/null"}, {"HOME": "/dev/null", "XDG_CACHE_HOME": "/proc/nowhere"}],
    ids=["the home is no folder", "the cache home cannot be made"],
)
def test_without_a_writable_home_kernels_are_not_cached_anywhere(install: Install, environment: dict[str, str]) -> None:
    assert install.run(**environment) == (8.0, 0, None)
    assert list(install.temp.iterdir()) == []
    assert not [path for path in install.site.rglob("*.nb?") if path.is_file()]


def test_six_processes_at_once_share_an_empty_cache(install: Install) -> None:
    processes = [install.start() for _ in range(6)]
    answers = [answer_of(process) for process in processes]
    assert [value for value, _, _ in answers] == [8.0] * 6
    assert install.run()[:2] == (8.0, 1)


def test_a_cache_that_a_crash_cut_short_is_made_anew(install: Install) -> None:
    install.run()
    for suffix, size in (("nbc", 100), ("nbi", 0)):
        files = list(install.home.rglob(f"*.{suffix}"))
        assert files
        for path in files:
            os.truncate(path, size)
        assert install.run()[:2] == (8.0, 0)
    assert install.run()[:2] == (8.0, 1)


def double(x: float) -> float:
    return 2.0 * x


@pytest.fixture
def cache_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An empty cache home for this process."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    kernels.cache_folder.cache_clear()
    yield tmp_path
    kernels.cache_folder.cache_clear()


@pytest.mark.parametrize("mode", [0o770, 0o707, 0o777])
@pytest.mark.parametrize("part", ["wirelessagent", "wirelessagent/kernels", ""])
def test_a_cache_that_others_could_write_to_is_refused(cache_home: Path, part: str, mode: int) -> None:
    folder = kernels.cache_folder((Path(__file__),))
    assert folder is not None
    assert folder.is_relative_to(cache_home)
    (cache_home / part if part else folder).chmod(mode)
    kernels.cache_folder.cache_clear()
    assert kernels.cache_folder((Path(__file__),)) is None


def test_a_new_cache_is_private_whatever_the_umask(cache_home: Path) -> None:
    before = os.umask(0)
    try:
        folder = kernels.cache_folder((Path(__file__),))
    finally:
        os.umask(before)
    assert folder is not None
    for made in (folder, folder.parent, folder.parent.parent):
        assert made.stat().st_mode & 0o777 == 0o700


def test_threads_that_import_kernels_at_once_do_not_mix_up_their_caches(
    cache_home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    turn = itertools.count(1)

    class Slow(kernels._Cache):
        def __init__(self, function: Any) -> None:
            time.sleep(0.02 * next(turn))  # long enough for another thread to change the setting that is read now
            super().__init__(function)

    monkeypatch.setattr(kernels, "_Cache", Slow)
    monkeypatch.setattr(config, "CACHE_DIR", "")
    made: list[Any] = []
    threads = [threading.Thread(target=lambda: made.append(kernels.kernel(double))) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(made) == 6
    assert all(Path(str(one.stats.cache_path)).is_relative_to(cache_home) for one in made)
    assert config.CACHE_DIR == ""


def test_a_cache_that_numba_would_put_elsewhere_is_not_used(cache_home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(config, "CACHE_LOCATOR_CLASSES", "InTreeCacheLocator", raising=False)
    compiled: Any = kernels.kernel(double)
    assert compiled.stats.cache_path is None
    assert compiled(2.0) == 4.0


def test_a_full_disk_costs_the_cache_and_not_the_answer(cache_home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(caching.FunctionCache, "save_overload", full)
    compiled: Any = kernels.kernel(double)
    assert Path(str(compiled.stats.cache_path)).is_relative_to(cache_home)
    assert compiled(2.0) == 4.0


def imports_of(source: Path) -> set[str]:
    """The modules that a file imports, at any level."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            found.add(node.module or "")
    return found


def test_kernels_import_only_kernels_and_types() -> None:
    """What else they imported would be frozen into compiled code, and an edit of it would go unseen."""
    allowed = {"__future__", "math", "typing", "numpy", "wirelessagent.kernels", "wirelessagent.model.arrays"}
    sources = sorted(PACKAGE.rglob("*_kernel.py"))
    assert sources
    surplus = {
        source.name: rest
        for source in sources
        if (rest := {name for name in imports_of(source) - allowed if not name.endswith("_kernel")})
    }
    assert surplus == {}


def test_nothing_else_opens_a_door_to_numba() -> None:
    doors = {
        source.relative_to(PACKAGE).as_posix()
        for source in PACKAGE.rglob("*.py")
        if any(name.split(".")[0] == "numba" for name in imports_of(source))
    }
    assert doors == {"kernels.py"}


def test_the_first_compilation_is_told_of_once(
    cache_home: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(kernels, "_say_compiling", functools.cache(kernels._say_compiling.__wrapped__))
    with caplog.at_level("INFO", logger="wirelessagent.kernels.compiling"):
        for one in (kernels.kernel(double), kernels.kernel(double)):
            one(1.0)
            one(1)
    assert [record.getMessage() for record in caplog.records if "compiling" in record.name] == [
        "compiling what this machine needs for the first time, which may take a minute"
    ]
