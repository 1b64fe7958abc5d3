"""What ``repair`` writes: gains as NPZ or CSV, and a picture."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.interfaces.cli import run
from wirelessagent.model.errors import InputError
from wirelessagent.pictures.repair_picture import repair_canvas
from wirelessagent.sensing.csv_gains import write_csv

TEXT = 'user;f1;f2;f3\nAnn;1,5e-9;;2,5e-9\n"B; b";3e-9;2e-9;\n'


def gains(folder: Path) -> Path:
    path = folder / "gains.csv"
    path.write_text(TEXT)
    return path


def repaired(folder: Path, capsys: pytest.CaptureFixture[str], *options: str) -> str:
    assert run(["repair", str(gains(folder)), "--method", "linear", *options]) == 0
    return capsys.readouterr().out


def test_csv_and_npz_hold_the_same_gains_and_come_back(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    record = json.loads(repaired(tmp_path, capsys, "--json", "--out", str(tmp_path / "a.csv")))
    repaired(tmp_path, capsys, "--out", str(tmp_path / "a.npz"))
    written, whole = (wa.read(tmp_path / name).sensed for name in ("a.csv", "a.npz"))
    assert written.gain.tobytes() == whole.gain.tobytes()
    assert written.gain.tolist() == record["estimate"]["gain"]
    assert written.user_names == whole.user_names == ("Ann", "B; b")
    assert not written.missing.any()


def test_csv_is_said_to_hold_the_gains_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    told = " ".join(repaired(tmp_path, capsys, "--out", str(tmp_path / "a.CSV")).split())
    assert "CSV holds the gains alone; which of them are repaired, how sure they are, noise and bandwidth need" in told
    assert "alone" not in repaired(tmp_path, capsys, "--out", str(tmp_path / "a.npz"))


def test_other_names_are_refused_before_the_work(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["repair", str(tmp_path / "none.csv"), "--out", str(tmp_path / "a.tsv")]) == 2
    assert "written as NPZ or CSV; end the name in .npz or .csv instead of 'a.tsv'" in capsys.readouterr().err
    assert run(["simulate", "--out", str(tmp_path / "a.csv")]) == 2
    assert "gains are written as NPZ" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["7", "1,5", "NaN", ""])
def test_a_name_that_would_be_a_number_is_not_written(name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=f"the user name {name!r} would be read back from CSV as a number"):
        write_csv(tmp_path / "a.csv", np.ones((2, 3)), ["Ann", name])
    assert not list(tmp_path.iterdir())


def test_the_picture_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    told = " ".join(repaired(tmp_path, capsys, "--plot", str(tmp_path / "a.svg")).split())
    assert f"written to {tmp_path / 'a.svg'}" in told
    assert (tmp_path / "a.svg").read_bytes().startswith(b"<?xml")
    assert run(["repair", str(tmp_path / "none.csv"), "--plot", str(tmp_path / "a.gif")]) == 2
    assert ".png, .svg, .pdf" in capsys.readouterr().err


def test_the_picture_shows_holes_their_repair_and_how_sure_it_is(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    seen = wa.read(gains(tmp_path)).sensed
    estimate = wa.repair(seen, "linear")
    sensed, completed, sure = (
        panel.axes.images[0].get_array() for panel in repair_canvas(observation=seen, estimate=estimate).panels
    )
    assert np.array_equal(np.ma.getmaskarray(sensed), seen.missing)
    assert not np.ma.getmaskarray(completed).any()
    assert np.array_equal(np.ma.getmaskarray(sure), ~estimate.repaired)
    share = np.sqrt(estimate.gain_variance) / estimate.gain
    np.testing.assert_allclose(sure.compressed(), share[estimate.repaired], rtol=1e-14)


def test_the_picture_of_a_complete_channel_says_so(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    seen = wa.ChannelObservation(gain=np.ones((2, 3)))
    panels = repair_canvas(observation=seen, estimate=wa.repair(seen)).panels
    assert not panels[2].axes.images
    assert panels[1].axes.get_title(loc="left") == "Nothing to repair"
