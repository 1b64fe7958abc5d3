"""Files of our own are written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pytest

from wirelessagent.model.atomic import write_atomically
from wirelessagent.model.errors import InputError, WirelessAgentError
from wirelessagent.sensing.npz import write_npz

GAIN = np.ones((2, 3))


def fill(stream: BinaryIO) -> None:
    stream.write(b"new")


def test_a_file_appears_with_all_its_content_and_nothing_beside_it(tmp_path: Path) -> None:
    path = tmp_path / "a.bin"
    write_atomically(path, fill)
    assert path.read_bytes() == b"new"
    assert list(tmp_path.iterdir()) == [path]
    other = tmp_path / "plain"
    other.write_bytes(b"")
    assert path.stat().st_mode == other.stat().st_mode  # as the user's umask wants it


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt(), ValueError("x")])
def test_a_failure_leaves_the_old_file_and_no_other(error: BaseException, tmp_path: Path) -> None:
    path = tmp_path / "a.bin"
    path.write_bytes(b"old")

    def fail(stream: BinaryIO) -> None:
        stream.write(b"half")
        raise error

    expected = WirelessAgentError if isinstance(error, OSError) else type(error)
    with pytest.raises(expected):
        write_atomically(path, fail)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_the_old_file_stands_until_the_new_one_is_complete(tmp_path: Path) -> None:
    path = tmp_path / "a.bin"
    path.write_bytes(b"old")
    seen: list[bytes] = []

    def look(stream: BinaryIO) -> None:
        stream.write(b"new")
        stream.flush()
        seen.append(path.read_bytes())

    write_atomically(path, look)
    assert seen == [b"old"]
    assert path.read_bytes() == b"new"


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_bytes(b"old")
    link.symlink_to(target)
    write_atomically(link, fill)
    assert link.is_symlink()
    assert target.read_bytes() == b"new"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("no/a.bin", "does not exist; create it first"),
        (".", "is a folder"),
        ("x" * 300, "cannot write"),
        ("a\0b", "cannot write"),
    ],
)
def test_places_that_cannot_be_written(name: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=words):
        write_atomically(tmp_path / name, fill)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may write everywhere")
def test_protected_files_and_folders(tmp_path: Path) -> None:
    path = tmp_path / "a.bin"
    path.write_bytes(b"old")
    path.chmod(0o444)
    with pytest.raises(InputError, match="write-protected"):
        write_atomically(path, fill)
    tmp_path.chmod(0o555)
    with pytest.raises(InputError, match="Permission denied"):
        write_atomically(tmp_path / "b.bin", fill)
    tmp_path.chmod(0o755)


def test_special_files_are_not_replaced() -> None:
    with pytest.raises(InputError, match="not an ordinary file"):
        write_atomically(Path(os.devnull), fill)


def test_the_same_content_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a.npz", "b.npz"):
        write_npz(tmp_path / name, {"gain": GAIN}, {"units": "linear power gain", "note": "高"})
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


@pytest.mark.parametrize(
    ("name", "arrays", "meta", "words"),
    [
        ("a.csv", {"gain": GAIN}, None, r"call the file .a\.npz. instead of .a\.csv."),
        ("a.npz", {"gain": np.array([None])}, None, "'gain' cannot be written"),
        ("a.npz", {"meta": GAIN}, None, "'meta' cannot be written"),
        ("a.npz", {"gain": GAIN}, {"x": np.nan}, "JSON"),
        ("a.npz", {"gain": GAIN}, {"x": GAIN}, "JSON"),
    ],
)
def test_what_is_no_channel_file_is_not_written(
    name: str, arrays: dict[str, np.ndarray], meta: dict[str, object] | None, words: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=words):
        write_npz(tmp_path / name, arrays, meta)
    assert list(tmp_path.iterdir()) == []
