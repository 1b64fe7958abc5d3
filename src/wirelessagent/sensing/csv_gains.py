"""Gains as CSV: a header line, then a line per user; :mod:`~wirelessagent.sensing.formats.csv_format` reads it back."""

from __future__ import annotations

import csv
import io
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
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["user", *(f"f{n}" for n in range(1, gain.shape[1] + 1))])
    writer.writerows([name, *map(repr, row)] for name, row in zip(user_names, gain.tolist(), strict=True))
    write_atomically(path, lambda stream: stream.write(text.getvalue().encode()))
