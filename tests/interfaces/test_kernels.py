"""The kernel door: nobody waits for a compiler, an edited kernel takes effect, and no cache can harm or mislead."""

from __future__ import annotations

import ast
import errno
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numba.core import caching

import wirelessagent
from wirelessagent import kernels
from wirelessagent.experiments.draws import run_draws
from wirelessagent.kernels import background, code_cache, supply
from wirelessagent.kernels.lock import Lock
from wirelessagent.kernels.twin import twin_of
from wirelessagent.model.errors import InputError

pytestmark = pytest.mark.machine_code

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
print(json.dumps([float(value), sum(outer.stats.cache_hits.values()), outer.stats.cache_path]))
"""

SWITCH = """
import time
from wirelessagent.kernels import work_on
from wirelessagent.trial.outer_kernel import outer
with work_on(1) as work:
    print(float(outer(3.0)), work.ran, flush=True)
while True:
    with work_on(1) as work:
        value = outer(3.0)
    if work.ran == "compiled":
        break
    time.sleep(0.1)
print(float(value), work.ran, outer.stats.cache_hits and "loaded", flush=True)
"""
"""A process that lives on until it runs machine code, which it does not compile."""


class Install:
    """A copy of the package with two kernels of which one calls the other, and a user with a home of their own."""

    def __init__(self, folder: Path) -> None:
        self.site, self.home, self.temp = folder / "site", folder / "home", folder / "temp"
        self.trial = self.site / "wirelessagent" / "trial"
        shutil.copytree(PACKAGE, self.site / "wirelessagent", ignore=shutil.ignore_patterns("__pycache__"))
        for made in (self.trial, self.home, self.temp):
            made.mkdir(exist_ok=True)
        (self.trial / "__init__.py").touch()
        (self.trial / "inner_kernel.py").write_text(INNER)
        (self.trial / "outer_kernel.py").write_text(OUTER)

    def start(self, script: str = RUN, **environment: str) -> subprocess.Popen[str]:
        kept = {name: value for name, value in os.environ.items() if not name.startswith(("NUMBA", "XDG", "PYTHON"))}
        settings = {"PYTHONPATH": str(self.site), "HOME": str(self.home), "TMPDIR": str(self.temp)}
        settings["WIRELESSAGENT_COMPILE"] = "foreground"
        return subprocess.Popen(
            [sys.executable, "-W", "error", "-c", script],
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
    inner.write_text(INNER.replace("x + 1.0", "x + 12.0"))  # of another length: Python tells no edit of the same second
    assert install.run()[:2] == (30.0, 0)
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


def test_a_second_checkout_compiles_nothing(install: Install, tmp_path: Path) -> None:
    install.run()
    (tmp_path / "second").mkdir()
    second = Install(tmp_path / "second")
    assert second.run(HOME=str(install.home))[:2] == (8.0, 1)


def test_six_compilers_at_once_are_one(tmp_path: Path) -> None:
    locks = [Lock(tmp_path / "lock") for _ in range(6)]
    assert [lock.seize() for lock in locks] == [True, *[False] * 5]
    assert not locks[1].is_free
    locks[0].release()
    assert locks[1].is_free


def test_a_first_call_runs_interpreted_and_a_process_that_lives_on_switches_over(install: Install) -> None:
    first = install.start(SWITCH, WIRELESSAGENT_COMPILE="background")
    out, err = first.communicate(timeout=300)
    assert first.returncode == 0, err
    assert out.split() == ["8.0", "interpreted", "8.0", "compiled", "loaded"]
    for path in compilers_of(install):  # the rest of the set would take minutes, and dying is allowed at any time
        os.kill(path, signal.SIGKILL)
    assert install.run(WIRELESSAGENT_COMPILE="never")[:2] == (8.0, 1)


def compilers_of(install: Install) -> list[int]:
    """The processes that compile for this installation."""
    found: list[int] = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            line, settings = (folder / "cmdline").read_bytes(), (folder / "environ").read_bytes()
        except OSError:
            continue
        if b"warm-up" in line and str(install.home).encode() in settings:
            found.append(int(folder.name))
    return found


def test_never_starts_no_compiler_and_leaves_no_notes(install: Install) -> None:
    assert install.run(WIRELESSAGENT_COMPILE="never")[:2] == (8.0, 0)
    assert not compilers_of(install)
    assert not [path for path in install.home.rglob("*") if path.suffix in (".wanted", ".nbi", ".nbc")]


def test_a_mode_that_does_not_exist_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("WIRELESSAGENT_COMPILE", "later")
    with pytest.raises(
        InputError, match="WIRELESSAGENT_COMPILE must be one of background, foreground, never; got 'later'"
    ):
        supply.mode()


SMALL, FACTORS = 1e-300, (1e300, 2.0)


@kernels.kernel
def divide(x: float, y: float) -> float:
    return x / max(y, 0.0)


@kernels.kernel
def arithmetic(values: Any, count: int) -> float:
    found = 0.0
    for factor in (1e300, -2.0):
        found += divide(factor, values[0]) + np.log(values[0]) * float(count)
    return found * (1.0 / values[1]) / SMALL + FACTORS[0] * FACTORS[0]


@pytest.mark.parametrize("values", [(1.0, 2.0), (0.0, 1.0), (0.0, 0.0), (-0.0, -1.0), (1e-320, 1e308), (np.nan, 0.0)])
def test_a_twin_divides_and_overflows_as_machine_code_does(values: tuple[float, float], cache_home: Path) -> None:
    """Warnings are errors in this suite."""
    twin = supply.run_interpreted(twin_of(arithmetic))
    with supply.foreground():
        np.testing.assert_array_equal(twin(np.array(values), 3), arithmetic(np.array(values), 3))
    assert twin(np.array(values), 3).dtype == np.float64


def inner(x: float, times: int) -> float:
    return x * times


def test_a_literal_argument_compiles_nothing_again(cache_home: Path) -> None:
    called: Any = kernels.kernel(inner)

    def outer(x: float, times: int) -> float:
        return called(x, 3) + called(x, 0) + called(x, times)

    with supply.foreground():
        assert kernels.kernel(outer)(2.0, 1) == 8.0
    assert len(called.signatures) == 1


def test_large_work_waits_for_its_code(cache_home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("WIRELESSAGENT_COMPILE", "background")
    waits: list[str] = []
    monkeypatch.setattr(background, "_start", lambda: waits.append("started"))
    monkeypatch.setattr(background, "wait_for", lambda is_there: waits.append(f"waited, {is_there()}"))
    one: Any = kernels.kernel(double)
    with kernels.work_on(supply.LARGE_GAINS - 1) as work:
        assert one(2.0) == 4.0
    assert (work.ran, waits) == ("interpreted", ["started"])
    with kernels.work_on(supply.LARGE_GAINS) as work, kernels.work_on(1):  # a part of large work is large
        assert one(2.0) == 4.0
    assert (work.ran, waits) == ("compiled", ["started", "waited, False"])


@pytest.mark.parametrize(("draws", "waits"), [(2, 0), (100, 1)])
def test_many_draws_are_large_work(cache_home: Path, monkeypatch: pytest.MonkeyPatch, draws: int, waits: int) -> None:
    monkeypatch.setenv("WIRELESSAGENT_COMPILE", "background")
    waited: list[bool] = []
    monkeypatch.setattr(background, "_start", lambda: None)
    monkeypatch.setattr(background, "wait_for", lambda is_there: waited.append(is_there()))
    one: Any = kernels.kernel(double)
    assert run_draws(lambda _: np.array(one(2.0)), draws=draws, seed=1).mean() == 4.0
    assert len(waited) == waits


def test_a_wait_ends_where_nobody_compiles_any_more(cache_home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(background, "_started_at", time.monotonic() - background.START_S)
    background.wait_for(lambda: False)


def test_notes_are_compiled_and_taken_away(cache_home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(background, "_start", lambda: None)
    arithmetic._reset_overloads()
    background.ask_for(arithmetic.py_func, tuple(map(arithmetic.typeof_pyval, (np.zeros(2), 1))))
    background.ask_for(double, ("no signature",))
    assert len(list(cache_home.rglob("*.wanted"))) == 2
    monkeypatch.setattr(background, "resolve_name", lambda name: globals()[name.partition(":")[2]])
    background.compile_requests()
    assert len(arithmetic.signatures) == 1
    assert not list(cache_home.rglob("*.wanted"))


def double(x: float) -> float:
    return 2.0 * x


@pytest.fixture
def cache_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An empty cache home for this process."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(background, "_started_at", -background.START_S)
    code_cache.cache_folder.cache_clear()
    yield tmp_path
    code_cache.cache_folder.cache_clear()


@pytest.mark.parametrize("mode", [0o770, 0o707, 0o777])
@pytest.mark.parametrize("part", ["wirelessagent", "wirelessagent/kernels", ""])
def test_a_cache_that_others_could_write_to_is_refused(cache_home: Path, part: str, mode: int) -> None:
    folder = code_cache.cache_folder((Path(__file__),))
    assert folder is not None
    assert folder.is_relative_to(cache_home)
    (cache_home / part if part else folder).chmod(mode)
    code_cache.cache_folder.cache_clear()
    assert code_cache.cache_folder((Path(__file__),)) is None


def test_a_new_cache_is_private_whatever_the_umask(cache_home: Path) -> None:
    before = os.umask(0)
    try:
        folder = code_cache.cache_folder((Path(__file__),))
    finally:
        os.umask(before)
    assert folder is not None
    for made in (folder, folder.parent, folder.parent.parent):
        assert made.stat().st_mode & 0o777 == 0o700


def test_a_full_disk_costs_the_cache_and_not_the_answer(cache_home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(caching.FunctionCache, "save_overload", full)
    compiled: Any = kernels.kernel(double)
    assert Path(str(compiled.stats.cache_path)).is_relative_to(cache_home)
    with supply.foreground():
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
    assert doors == {"kernels/code_cache.py", "kernels/dispatcher.py"}
