"""No file ends the process or hangs it: HDF5 is read by a child, which may; what is no ordinary file is refused."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np
import pytest
from damaged_files import FORMATS, write_damaged
from reading import LastingProcess, outcome

import wirelessagent as wa
from wirelessagent.model.errors import FileFormatError, WirelessAgentError
from wirelessagent.sensing.formats import hdf5_format, hdf5_process
from wirelessagent.sensing.formats.hdf5_process import Hdf5Process

GAIN = np.arange(1.0, 7.0).reshape(2, 3)


@pytest.mark.parametrize("form", FORMATS)
def test_damaged_files_are_refused_in_one_line_or_read(form: str, tmp_path: Path) -> None:
    """A part of ``benchmarks/bars_files.py``."""
    with LastingProcess.for_every_file():
        found = [(number, *outcome(write_damaged(tmp_path, form, number))) for number in range(50)]
    assert [each for each in found if each[1] == "fault"] == []
    assert sum(end == "refused" for _, end, _ in found) > 20


@pytest.mark.parametrize(("form", "number"), [("HDF5", 414), ("netCDF-4", 291), ("netCDF-4", 1294)])
def test_what_ends_the_process_of_hdf5_does_not_end_this_one(form: str, number: int, tmp_path: Path) -> None:
    """HDF5 2.0 ends by a segmentation fault on each of these; another release may do as it likes."""
    assert outcome(write_damaged(tmp_path, form, number))[0] != "fault"


def hdf5(folder: Path) -> Path:
    with h5py.File(folder / "a.h5", "w") as file:
        file["gain"] = GAIN
    return folder / "a.h5"


def stand_in(folder: Path, monkeypatch: pytest.MonkeyPatch, answer: str) -> None:
    """Let another program be the child: it is ready, gets the request and then does as it is told."""
    program = folder / "child.py"
    program.write_text(
        "import os, sys, time\n"
        "def serve(max_bytes):\n"
        "    print('{\"ready\": true}', flush=True)\n"
        "    sys.stdin.buffer.readline()\n"
        f"    {answer}\n"
    )
    monkeypatch.setattr(hdf5_process, "_ADAPTER", program)


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        ("os.abort()", r"HDF5's own library broke down over it"),
        ("os._exit(3)", "broke down over it, exit code 3"),
        ("print('{\"datasets\"', end='', flush=True)", "broke down"),
        ("print('no JSON', flush=True)", "JSONDecodeError"),
        ('print(\'{"error": "OSError: x"}\', flush=True)', r"damaged or cut short \(OSError: x\)"),
    ],
)
def test_a_child_that_ends_or_goes_astray_is_one_line(
    answer: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stand_in(tmp_path, monkeypatch, answer)
    with pytest.raises(FileFormatError, match=words) as caught:
        wa.read(hdf5(tmp_path))
    assert str(caught.value).endswith("copy or write it again")


def test_a_child_that_does_not_end_is_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(tmp_path, monkeypatch, "time.sleep(3600)")
    data = hdf5(tmp_path).read_bytes()
    process = Hdf5Process(2**20, limit_s=1.0)
    try:
        with pytest.raises(FileFormatError, match="did not end within 1 s"):
            process.listing(data)
    finally:
        process.close()


def test_a_child_that_does_not_start_says_what_to_check(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = hdf5(tmp_path)
    monkeypatch.setattr(hdf5_process, "_ADAPTER", tmp_path / "none.py")
    with pytest.raises(WirelessAgentError, match=r"does not start: check that .* -c 'import h5py' works"):
        wa.read(path)
    (tmp_path / "none.py").write_text("def serve(max_bytes):\n    print('hello', flush=True)\n")
    with pytest.raises(WirelessAgentError, match=r"does not start"):
        wa.read(path)
    monkeypatch.setattr(sys, "executable", str(tmp_path / "none"))
    with pytest.raises(WirelessAgentError, match="cannot be started"):
        wa.read(path)


def test_no_child_is_left_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[Hdf5Process] = []

    def process(max_bytes: int) -> Hdf5Process:
        started.append(Hdf5Process(max_bytes))
        return started[-1]

    monkeypatch.setattr(hdf5_format, "Hdf5Process", process)
    path = hdf5(tmp_path)
    wa.read(path)
    with pytest.raises(FileFormatError, match="no array called"):
        wa.read(path, key="none")
    path.write_bytes(path.read_bytes()[:1000])
    with pytest.raises(FileFormatError, match="damaged"):
        wa.read(path)
    assert len(started) == 3  # one for each file, not for each array
    assert all(one._child.poll() is not None for one in started)


def test_the_child_does_not_import_from_the_working_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = hdf5(tmp_path)
    (tmp_path / "h5py.py").write_text("raise SystemExit")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend("")
    np.testing.assert_array_equal(wa.read(path).sensed.gain, GAIN)


ADAPTER = f"import runpy, sys; adapter = runpy.run_path({str(hdf5_process._ADAPTER)!r}); "


def test_the_child_needs_nothing_but_numpy_and_h5py() -> None:
    code = (
        ADAPTER
        + "print(sorted({'wirelessagent', 'scipy', 'pydantic', 'numba'} & {m.split('.')[0] for m in sys.modules}))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not limit the address space of a process")
def test_the_memory_of_the_child_is_bounded() -> None:
    code = ADAPTER + "adapter['_limit'](2**20); bytearray(2**31)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stderr.rstrip().endswith("MemoryError")


def no_ordinary_files(folder: Path) -> Iterator[tuple[Path, str]]:
    yield folder, "is a folder; name a file in it"
    if hasattr(os, "mkfifo"):
        os.mkfifo(folder / "pipe.h5")
        yield folder / "pipe.h5", "is a pipe and not an ordinary file; save the gains to a file"
    for device in (Path("/dev/zero"), Path(os.devnull)):
        if device.exists():
            yield device, "is a device and not an ordinary file"
    if Path("/dev/stdin").exists():
        yield Path("/dev/stdin"), "is a pipe and not an ordinary file"


def test_what_is_no_ordinary_file_is_refused_at_once(tmp_path: Path) -> None:
    """In a process of its own, which would otherwise wait forever."""
    code = (
        "import sys, wirelessagent as wa\n"
        "for path in sys.argv[1:]:\n"
        "    try: wa.read(path)\n"
        "    except wa.InputError as error: print(error)\n"
    )
    expected = list(no_ordinary_files(tmp_path))
    command = [sys.executable, "-c", code, *(str(path) for path, _ in expected)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None  # its stdin stays open, as a terminal's does
            process.wait(timeout=120)
            told = process.stdout.read().splitlines()
        finally:
            process.kill()
    assert len(told) == len(expected)
    for line, (path, words) in zip(told, expected, strict=True):
        assert line.startswith(f"{path}: {words}")


@pytest.mark.skipif(not hasattr(socket, "AF_UNIX"), reason="this system has no sockets in its file system")
def test_a_socket_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # names of sockets must be short
    with socket.socket(socket.AF_UNIX) as server:
        server.bind("s.h5")
        with pytest.raises(FileFormatError, match="is a socket and not an ordinary file"):
            wa.read("s.h5")
