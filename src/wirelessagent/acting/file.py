"""A base station behind a file: the allocation is written for other software to take up, whole or not at all."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from wirelessagent.acting.base_station import BaseStation, check_applicable
from wirelessagent.model.arrays import positive
from wirelessagent.model.atomic import write_atomically
from wirelessagent.model.decision import Decision
from wirelessagent.model.errors import InputError
from wirelessagent.model.outcome import Outcome

OWNER_MEANS = "the user of each subcarrier, as an index from 0 into user_names; -1 for nobody"


@dataclass(frozen=True)
class FileBaseStation(BaseStation):
    """Writes the allocation as JSON, CSV or NPZ, by the file's suffix, atomically.

    JSON and NPZ hold ``owner``, ``owner_means``, ``power_w``, ``promised_bps`` and ``user_names``: people count users
    from 1, so the file itself says that an owner is an index from 0, −1 for nobody. CSV has a line per subcarrier,
    ``subcarrier_from_0,owner_from_0,user_name,power_w``.

    Attributes:
        path: the file to write, .json, .csv or .npz.
        power_resolution_w: the finest step of the power that the software behind the file can set; 0 for any power.
    """

    name = "file"

    path: Path = Path("allocation.json")
    power_resolution_w: float = 0.0

    def __post_init__(self) -> None:
        positive("power_resolution_w", self.power_resolution_w, zero=True)

    def apply(self, decision: Decision) -> Outcome:
        path = Path(self.path)
        writer = allocation_writer(path)
        check_applicable(decision, decision.cell if self.scene is None else self.scene.cell)
        outcome = self.read_back(decision, written_to=path)
        write_atomically(path, lambda stream: writer(stream, outcome, decision.user_names))
        return outcome


def allocation_writer(path: Path) -> Callable[[BinaryIO, Outcome, tuple[str, ...]], None]:
    """What writes an outcome for users of these names, as the suffix of ``path`` says.

    Raises:
        InputError: the suffix is not known.
    """
    writer = _WRITERS.get(path.suffix.lower())
    if writer is None:
        raise InputError(f"an allocation is written as {', '.join(_WRITERS)}; got {path.name!r}: change the suffix")
    return writer


def _write_json(stream: BinaryIO, told: Outcome, user_names: tuple[str, ...]) -> None:
    content = {
        "owner": told.owner.tolist(),
        "owner_means": OWNER_MEANS,
        "power_w": told.power_w.tolist(),
        "promised_bps": told.promised_bps.tolist(),
        "user_names": list(user_names),
    }
    stream.write(json.dumps(content, ensure_ascii=False, allow_nan=False, indent=1).encode())


def _write_csv(stream: BinaryIO, told: Outcome, user_names: tuple[str, ...]) -> None:
    text = io.StringIO(newline="")
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["subcarrier_from_0", "owner_from_0", "user_name", "power_w"])
    for n, (owner, power) in enumerate(zip(told.owner.tolist(), told.power_w.tolist(), strict=True)):
        rows.writerow([n, owner, user_names[owner] if owner >= 0 else "", repr(power)])
    stream.write(text.getvalue().encode())


def _write_npz(stream: BinaryIO, told: Outcome, user_names: tuple[str, ...]) -> None:
    np.savez(
        stream,
        owner=told.owner,
        owner_means=np.array(OWNER_MEANS),
        power_w=told.power_w,
        promised_bps=told.promised_bps,
        user_names=np.array(user_names),
    )


_WRITERS: dict[str, Callable[[BinaryIO, Outcome, tuple[str, ...]], None]] = {
    ".json": _write_json,
    ".csv": _write_csv,
    ".npz": _write_npz,
}
