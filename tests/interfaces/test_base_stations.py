"""What a base station writes and reads back: users by index said so, power in the steps that it can set."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np

import wirelessagent as wa
from wirelessagent.acting.file import FileBaseStation

SCENE = wa.simulate("rayleigh", num_users=4, num_subcarriers=12, seed=1)
ESTIMATE = wa.perfect(SCENE)


def test_a_written_allocation_says_that_an_owner_is_an_index(tmp_path: Path) -> None:
    decision = wa.decide(ESTIMATE, wa.Problem("max_rate", users=("user 4",)), SCENE.cell)
    for suffix in ("json", "csv", "npz"):
        FileBaseStation(SCENE, path=tmp_path / f"allocation.{suffix}").apply(decision)
    written = json.loads((tmp_path / "allocation.json").read_text())
    with np.load(tmp_path / "allocation.npz") as arrays:
        read = {name: arrays[name].tolist() for name in arrays}
    for found in (written, read):
        assert "index from 0 into user_names" in found["owner_means"]
        assert {found["user_names"][owner] for owner in found["owner"] if owner >= 0} == {"user 4"}
    with (tmp_path / "allocation.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert {(row["owner_from_0"], row["user_name"]) for row in rows} <= {("3", "user 4"), ("-1", "")}
