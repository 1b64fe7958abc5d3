"""Gains as CSV: a header line, then a line per user; :mod:`~wirelessagent.sensing.formats.csv_format` reads it back."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.atomic import write_atomically
from wirelessagent.model.errors import InputError
from wirelessagent.sensing.formats.text import is_label


def write_csv(path: Path, gain: FloatArray, user_names: Sequence[str]) -> None:
    """Write complete gains of shape (user, subcarrier), bit by bit as they are, with the users' names before them.

    Raises:
        InputError: a name would be read back as a number, or the folder cannot be written to.
    """
    for name in user_names:
        if not is_label(name):
            raise InputError(
                f"the user name {name!r} would be read back from CSV as a number; write NPZ, or name the user otherwise"
            )
    lines = [["user", *(f"f{n}" for n in range(1, gain.shape[1] + 1))]]
    for name, row in zip(user_names, gain.tolist(), strict=True):
        quoted = name.replace('"', '""')
        lines.append([f'"{quoted}"', *map(repr, row)])  # in quotes, lest what is in it be taken for a separator
    text = "".join(",".join(line) + "\n" for line in lines)
    write_atomically(path, lambda stream: stream.write(text.encode()))
