"""What a channel file means: axes, units, missing entries, metadata, and that all of it is said."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
from scipy.io import savemat

import wirelessagent as wa
from wirelessagent.interfaces.cli import run
from wirelessagent.model.errors import FileFormatError, InputError
from wirelessagent.sensing.files import File
from wirelessagent.sensing.npz import write_npz

GAIN = np.arange(1.0, 7.0).reshape(2, 3)  # two users, three subcarriers


def npz(tmp_path: Path, **arrays: np.ndarray) -> Path:
    path = tmp_path / "gains.npz"
    np.savez(path, **arrays)
    return path


def csv(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "gains.csv"
    path.write_bytes(text.encode())
    return path


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_csv_with_header_names_and_every_word_for_missing(separator: str, end: str, tmp_path: Path) -> None:
    lines = [["user", "f1", "f2", "f3"], ["Ann", "1", "", " NaN "], ['"B; b, b"', "null", "NA", "2.5e-9"]]
    scene = wa.read(csv(tmp_path, "\ufeff" + end.join(separator.join(line) for line in lines) + end + end))
    np.testing.assert_array_equal(scene.sensed.gain, [[1, np.nan, np.nan], [np.nan, np.nan, 2.5e-9]])
    assert scene.sensed.user_names == ("Ann", "B; b, b")
    assert scene.facts["header"] == "line 1"
    assert scene.facts["user names"] == "from column 1"
    assert scene.facts["users"] == "Ann, B; b, b"
    assert scene.facts["missing"] == "4 of 6 entries (66.7 %)"
    assert scene.truth is None


@pytest.mark.parametrize("separator", [";", "\t"])
def test_csv_with_decimal_commas_is_read_and_it_is_said(separator: str, tmp_path: Path) -> None:
    lines = [["user", "f1", "f2", "f3"], ["Ann", "1", "", "2,5"], ["Bo", "2,5e-9", "NA", "0,125"]]
    scene = wa.read(csv(tmp_path, "\n".join(map(separator.join, lines))))
    np.testing.assert_array_equal(scene.sensed.gain, [[1, np.nan, 2.5], [2.5e-9, np.nan, 0.125]])
    assert scene.facts["decimals"] == "decimal comma: 2,5 is read as 2.5"
    complex_ = wa.read(csv(tmp_path, f"0,3+0,4i{separator}1,5"))
    np.testing.assert_allclose(complex_.sensed.gain, [[0.25, 2.25]], rtol=1e-14)


@pytest.mark.parametrize("text", ["1,5,2,5", "1,5\n2,5", "user,f1,f2\nAnn,1,5", "+1,5,2,50"])
def test_commas_that_may_be_decimal_ones_are_told(text: str, tmp_path: Path) -> None:
    told = wa.read(csv(tmp_path, text)).facts["decimals"]
    assert told.endswith("If 1,5 is meant as one number, write 1.5 or separate cells with semicolons")


@pytest.mark.parametrize("text", ["1.5,2,3,4", "1,2,3", "5;2;3;4", "1,,2,3", "1e1,2"])
def test_commas_that_separate_for_sure_are_not_wondered_about(text: str, tmp_path: Path) -> None:
    assert "decimals" not in wa.read(csv(tmp_path, text)).facts


def test_csv_with_slots(tmp_path: Path) -> None:
    text = "slot,user,f1,f2\n0,a,1,2\n0,b,3,4\n1,a,5,\n1,b,7,8\n"
    scene = wa.read(csv(tmp_path, text))
    np.testing.assert_array_equal(scene.sensed.gain, [[[1, 2], [3, 4]], [[5, np.nan], [7, 8]]])
    assert scene.sensed.user_names == ("a", "b")
    assert "1 of 4 in the current (last) slot" in scene.facts["missing"]


def test_csv_of_bare_numbers_has_neither_header_nor_names(tmp_path: Path) -> None:
    scene = wa.read(csv(tmp_path, "1,2,3\n4,5,6"))
    np.testing.assert_array_equal(scene.sensed.gain, GAIN)
    assert "header" not in scene.facts
    assert "user names" not in scene.facts
    assert "caution" in scene.facts  # 1, 2, 3 could as well be a header


@pytest.mark.parametrize(
    ("axes", "stored"),
    [
        ("user,subcarrier", GAIN),
        ("subcarrier,user", GAIN.T),
        (" Subcarrier , USER ", GAIN.T),
        ("drop,user,subcarrier", np.stack([GAIN * 9, GAIN])),
        ("subcarrier,drop,user", np.stack([GAIN.T * 9, GAIN.T], axis=1)),
    ],
)
def test_axes_are_turned_as_named(axes: str, stored: np.ndarray, tmp_path: Path) -> None:
    drop = 1 if "drop" in axes else 0
    scene = wa.read(npz(tmp_path, gain=stored), axes=axes, drop=drop)
    np.testing.assert_array_equal(scene.sensed.gain, GAIN)
    assert "(as given)" in scene.facts["axes"]
    if drop:
        assert scene.facts["axes"].endswith("drop 1 of 2, counted from 0")


def test_slots_in_any_place_and_drops_of_histories(tmp_path: Path) -> None:
    history = np.arange(24.0).reshape(4, 2, 3)
    turned = np.moveaxis(history, 0, 2)
    path = npz(tmp_path, gain=turned)
    np.testing.assert_array_equal(wa.read(path, axes="user,subcarrier,slot").sensed.gain, history)
    both = npz(tmp_path, gain=np.stack([history, history + 100]))
    scene = wa.read(both, axes="drop,slot,user,subcarrier", drop=1)
    np.testing.assert_array_equal(scene.sensed.gain, history + 100)


def test_an_option_wins_over_the_file(tmp_path: Path) -> None:
    path = npz(tmp_path, gain=GAIN, meta=np.array('{"axes": "subcarrier,user"}'))
    assert wa.read(path).sensed.gain.shape == (3, 2)
    assert "from the file's metadata" in wa.read(path).facts["axes"]
    assert wa.read(path, axes="user,subcarrier").sensed.gain.shape == (2, 3)


def test_decibels(tmp_path: Path) -> None:
    path = npz(tmp_path, gain=np.array([[-30.0, -np.inf, np.nan]]))
    scene = wa.read(path, unit="db")
    np.testing.assert_allclose(scene.sensed.gain, [[1e-3, 0.0, np.nan]], rtol=1e-15)
    assert scene.facts["unit"].startswith("dB, converted")
    np.testing.assert_array_equal(wa.read(path, unit="dB").sensed.gain, scene.sensed.gain)
    assert scene.facts["range"] == "-30.0 to -30.0 dB, and 1 exact zero"


def test_a_unit_that_the_file_states(tmp_path: Path) -> None:
    path = npz(tmp_path, gain=-10 * GAIN, meta=np.array('{"units": "dB"}'))
    scene = wa.read(path)
    np.testing.assert_allclose(scene.sensed.gain, 10.0**-GAIN, rtol=1e-14)
    assert "the file says 'dB'" in scene.facts["unit"]
    with pytest.raises(FileFormatError, match=r"unit=db \(--unit db\)"):
        wa.read(path, unit="linear")


def test_a_power_in_dbm_is_no_gain(tmp_path: Path) -> None:
    path = npz(tmp_path, gain=-10 * GAIN, meta=np.array('{"units": "dBm"}'))
    with pytest.raises(FileFormatError, match=r"'dBm', which is no power gain; .*unit=db"):
        wa.read(path)
    np.testing.assert_allclose(wa.read(path, unit="db").sensed.gain, 10.0**-GAIN, rtol=1e-14)


LOSSES = np.array([[100.0, 90.0, 95.0]])


def test_gains_above_one_in_no_stated_unit_are_asked_about(tmp_path: Path) -> None:
    check = wa.read(npz(tmp_path, gain=LOSSES)).facts["check"]
    assert "gains above 1 (0 dB), up to 100," in check
    for way_out in ("unit=db (--unit db)", "State the noise", "unit=linear (--unit linear)"):
        assert way_out in check


def test_losses_given_as_gains_in_db_are_asked_about(tmp_path: Path) -> None:
    check = wa.read(npz(tmp_path, gain=LOSSES), unit="db").facts["check"]
    assert check.startswith("gains above 0 dB, up to 100 dB,")
    assert "Write them negative" in check


@pytest.mark.parametrize(
    ("gain", "meta", "options"),
    [
        (LOSSES, {}, {"unit": "linear"}),
        (-LOSSES, {}, {"unit": "db"}),
        (LOSSES, {"units": "linear power gain"}, {}),
        (LOSSES, {"noise_w_per_rb": 1.0}, {}),
        (LOSSES, {"noise_psd_w_per_hz": 1e-6}, {}),
        (LOSSES + 0j, {}, {}),
        (LOSSES / 100, {}, {}),
    ],
)
def test_other_gains_are_not_asked_about(
    gain: np.ndarray, meta: dict[str, object], options: dict[str, object], tmp_path: Path
) -> None:
    scene = wa.read(npz(tmp_path, gain=gain, meta=np.array(json.dumps(meta))), **options)
    assert "check" not in scene.facts
    assert scene.facts["shape"] == "1 user × 3 subcarriers"


def test_more_users_than_subcarriers_are_asked_about_where_axes_are_assumed(tmp_path: Path) -> None:
    tall = npz(tmp_path, gain=GAIN.T)
    assert "is it transposed? Then say axes=subcarrier,user (--axes subcarrier,user)" in wa.read(tall).facts["axes"]
    for axes in ("user,subcarrier", "subcarrier,user"):
        assert "transposed" not in wa.read(tall, axes=axes).facts["axes"]
    assert "transposed" not in wa.read(npz(tmp_path, gain=GAIN)).facts["axes"]
    slots = npz(tmp_path, gain=np.stack([GAIN.T, GAIN.T]))
    assert "axes=slot,subcarrier,user (--axes slot,subcarrier,user)" in wa.read(slots).facts["axes"]


def test_real_coefficients_are_squared_when_called_complex(tmp_path: Path) -> None:
    np.testing.assert_array_equal(wa.read(npz(tmp_path, h=-GAIN), unit="complex").sensed.gain, GAIN**2)


@pytest.mark.parametrize("dtype", [np.float64, np.float32, np.int16])
def test_a_value_that_marks_missing_entries(dtype: type, tmp_path: Path) -> None:
    mark = -999 if dtype is np.int16 else -999.9
    stored = GAIN.astype(dtype)
    stored[1, 0] = mark
    scene = wa.read(npz(tmp_path, gain=stored), missing_value=mark)
    assert np.argwhere(np.isnan(scene.sensed.gain)).tolist() == [[1, 0]]
    assert scene.facts["missing"].startswith("1 of 6 entries (16.7 %); NaN and -999")


def test_which_array_is_meant(tmp_path: Path) -> None:
    assert wa.read(npz(tmp_path, H=GAIN)).facts["array"] == "H (2 × 3, float64) (the only one)"
    two = npz(tmp_path, H=GAIN, G=2 * GAIN, f=np.arange(3.0), note=np.array("hello"))
    with pytest.raises(FileFormatError, match=r"H \(2 × 3, float64\), G .*key=H"):
        wa.read(two)
    scene = wa.read(two, key="G")
    np.testing.assert_array_equal(scene.sensed.gain, 2 * GAIN)
    assert scene.facts["not used"] == "H (2 × 3, float64), f (3, float64), note (a single value, <U5)"
    one = npz(tmp_path, H=GAIN, f=np.arange(3.0))
    assert "the only numeric matrix" in wa.read(one).facts["array"]
    with pytest.raises(FileFormatError, match="no array called 'X'"):
        wa.read(one, key="X")


def test_nested_hdf5_and_matlab_names(tmp_path: Path) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["run/1/gain"] = GAIN
        file["run/2/gain"] = 2 * GAIN
    np.testing.assert_array_equal(wa.read(tmp_path / "a.h5", key="run/2/gain").sensed.gain, 2 * GAIN)
    savemat(tmp_path / "a.mat", {"H": GAIN, "fc": 3.5e9, "cells": np.array([1, "a"], dtype=object)})
    scene = wa.read(tmp_path / "a.mat")
    np.testing.assert_array_equal(scene.sensed.gain, GAIN)
    assert "cells (1 × 2, cell)" in scene.facts["not used"]


def test_a_format_under_another_name_is_said(tmp_path: Path) -> None:
    npz(tmp_path, gain=GAIN).rename(tmp_path / "gains.csv")
    scene = wa.read(tmp_path / "gains.csv")
    np.testing.assert_array_equal(scene.sensed.gain, GAIN)
    assert scene.facts["format"] == "NPZ, judged by its content; the name ends in .csv"


METADATA = {
    "axes": "slot,user,subcarrier",
    "units": "linear power gain",
    "rb_bandwidth_hz": 360e3,
    "noise_w_per_rb": 1.8e-14,
    "carrier_hz": 3.5e9,
    "slot_s": 1e-3,
    "suggested_tx_power_w": 4.5,
}


def write_with_metadata(path: Path, gain: np.ndarray) -> None:
    if path.suffix == ".npz":
        write_npz(path, {"gain": gain}, METADATA)
    elif path.suffix == ".json":
        path.write_text(json.dumps({"gain": gain.tolist(), **METADATA}))
    elif path.suffix == ".h5":
        with h5py.File(path, "w") as file:
            file["gain"] = gain
            file.attrs.update(METADATA)
    else:
        savemat(path, {"gain": gain, "meta": json.dumps(METADATA)})


@pytest.mark.parametrize("name", ["a.npz", "a.json", "a.h5", "a.mat"])
def test_metadata_reaches_the_cell_and_the_axes(name: str, tmp_path: Path) -> None:
    write_with_metadata(tmp_path / name, np.ones((4, 2, 3)))
    scene = wa.read(tmp_path / name, wa.Cell(max_power_w=7))
    assert scene.cell.subcarrier_bandwidth_hz == 360e3
    assert scene.cell.noise_power_w == pytest.approx(1.8e-14, rel=1e-12)
    assert scene.cell.max_power_w == 7
    np.testing.assert_allclose(scene.sensed.subcarrier_frequencies_hz, 3.5e9 + 360e3 * np.array([-1, 0, 1]), rtol=1e-15)
    np.testing.assert_allclose(scene.sensed.slot_times_s, [0, 1e-3, 2e-3, 3e-3], rtol=1e-15)
    assert scene.facts["bandwidth"] == "360 kHz (from the file)"
    assert "not applied" in scene.facts["suggested power"]


def test_a_file_that_says_nothing_leaves_the_cell_alone(tmp_path: Path) -> None:
    cell = wa.Cell(subcarrier_bandwidth_hz=15e3, noise_psd_w_per_hz=1e-20)
    scene = wa.read(npz(tmp_path, gain=GAIN), cell)
    assert scene.cell == cell
    assert "does not say" in scene.facts["noise"]
    assert scene.sensed.subcarrier_frequencies_hz is None


@pytest.mark.parametrize(
    "meta",
    ["not json", "[1]", '{"carrier_hz": "fast"}', '{"slot_s": -1}', '{"rb_bandwidth_hz": true}', '{"axes": "user"}'],
)
def test_metadata_that_make_no_sense(meta: str, tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"meta|carrier_hz|slot_s|rb_bandwidth_hz|subcarrier"):
        wa.read(npz(tmp_path, gain=np.ones((2, 2, 3)), meta=np.array(meta)))


def test_an_observed_scene_comes_back(tmp_path: Path) -> None:
    """As `simulate` writes it: gain with holes, truth, variances, names, frequencies, times."""
    rng = np.random.default_rng(5)
    truth = rng.exponential(size=(3, 2, 4))
    gain = np.where(rng.random(truth.shape) < 0.3, np.nan, truth + 0.01)
    arrays = {
        "gain": gain,
        "truth": truth,
        "noise_variance": np.full(truth.shape, 1e-4),
        "user_names": np.array(["Zoë", "用户"]),
        "subcarrier_frequencies_hz": 1e9 + np.arange(4) * 15e3,
        "slot_times_s": np.array([0.0, 0.5, 2.0]),
    }
    path = tmp_path / "scene.npz"
    write_npz(path, arrays, {"axes": "slot,user,subcarrier", "carrier_hz": 2e9})
    scene = wa.read(path)
    np.testing.assert_array_equal(scene.sensed.gain, gain)
    np.testing.assert_array_equal(scene.truth, truth)
    np.testing.assert_array_equal(scene.sensed.noise_variance, arrays["noise_variance"])
    assert scene.sensed.user_names == ("Zoë", "用户")
    np.testing.assert_array_equal(scene.sensed.subcarrier_frequencies_hz, arrays["subcarrier_frequencies_hz"])
    np.testing.assert_array_equal(scene.sensed.slot_times_s, arrays["slot_times_s"])


def test_truth_turns_with_the_gains(tmp_path: Path) -> None:
    gain = GAIN.T.copy()
    gain[0, 0] = np.nan
    variance = GAIN.T / 10
    path = npz(tmp_path, gain=gain, truth=GAIN.T, noise_variance=variance)
    scene = wa.read(path, axes="subcarrier,user")
    np.testing.assert_array_equal(scene.truth, GAIN)
    np.testing.assert_array_equal(scene.sensed.noise_variance, GAIN / 10)


def test_a_repaired_file_is_an_estimate_and_no_truth(tmp_path: Path) -> None:
    repaired = np.zeros(GAIN.shape, dtype=bool)
    repaired[0, 1] = True
    variance = np.where(repaired, 0.5, 0.0)
    scene = wa.read(npz(tmp_path, gain=GAIN, gain_variance=variance, repaired=repaired))
    assert scene.truth is None
    assert scene.facts["truth"] == "not known: 1 entry is marked as repaired, so not measured"
    np.testing.assert_array_equal(scene.sensed.noise_variance, variance)
    np.testing.assert_array_equal(scene.sensed.estimated, repaired)
    estimate = wa.repair(scene.sensed)
    assert estimate.method == "earlier repair"
    np.testing.assert_array_equal(estimate.repaired, repaired)
    np.testing.assert_array_equal(estimate.gain, GAIN)
    np.testing.assert_array_equal(estimate.gain_variance, variance)
    assert not estimate.unobserved_users.any()


def test_what_was_repaired_turns_with_the_gains_and_outlives_a_second_loss(tmp_path: Path) -> None:
    repaired = np.array([[1, 1, 1, 1], [0, 0, 1, 0], [0, 0, 0, 0]])  # no gain of the first user was measured
    gain = np.arange(1.0, 13.0).reshape(3, 4)
    path = npz(tmp_path, gain=gain.T, gain_variance=gain.T / 10, repaired=repaired.T)
    scene = wa.read(path, axes="subcarrier,user")
    seen = scene.observe(wa.loss.random(0.3), seed=3)
    lost = seen.missing
    assert lost.any()
    estimate = wa.repair(seen, "linear")
    np.testing.assert_array_equal(estimate.repaired, lost | (repaired == 1))
    np.testing.assert_array_equal(estimate.gain[~lost], gain[~lost])
    np.testing.assert_array_equal(estimate.gain_variance[~lost], (gain / 10)[~lost])
    assert estimate.unobserved_users.tolist() == [True, False, False]


def test_a_file_without_a_repaired_entry_is_measured(tmp_path: Path) -> None:
    scene = wa.read(npz(tmp_path, gain=GAIN, repaired=np.zeros(GAIN.shape, dtype=bool)))
    assert scene.sensed.estimated is None
    assert wa.repair(scene.sensed).method == "none"


def test_repairs_of_the_history_are_no_repairs_of_the_current_slot() -> None:
    estimated = np.zeros((2, *GAIN.shape), dtype=bool)
    estimated[0] = True
    seen = wa.ChannelObservation(gain=np.stack([GAIN, GAIN]), estimated=estimated)
    estimate = wa.repair(seen)
    assert estimate.method == "none"
    assert not estimate.repaired.any()


@pytest.mark.parametrize("estimated", [np.zeros((3, 2), dtype=bool), np.zeros(GAIN.shape)])
def test_estimated_is_a_switch_for_each_gain(estimated: np.ndarray) -> None:
    with pytest.raises(InputError, match=r"switches \(bool\) of shape \(2, 3\); got"):
        wa.ChannelObservation(gain=GAIN, estimated=estimated)


def test_the_command_line_keeps_what_was_repaired(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    gains, repaired, copy = csv(tmp_path, "1e-9,2e-9,,4e-9\n3e-9,,2e-9,1e-9\n"), tmp_path / "r.npz", tmp_path / "c.npz"
    assert run(["repair", str(gains), "--out", str(repaired)]) == 0
    assert run(["simulate", "--source", "file", "--path", str(repaired), "--out", str(copy)]) == 0
    for path in (repaired, copy):
        capsys.readouterr()
        assert run(["solve", str(path), "--json"]) == 0
        record = json.loads(capsys.readouterr().out)
        assert record["repaired"] == 2
        assert "2 of 8 gains" in " ".join(record["explanation"])
        assert not any("No gain was missing" in line for line in record["explanation"])


def test_complete_gains_are_taken_as_the_truth_and_it_is_said(tmp_path: Path) -> None:
    scene = wa.read(npz(tmp_path, gain=GAIN))
    np.testing.assert_array_equal(scene.truth, GAIN)
    assert "taken as the truth" in scene.facts["truth"]


def test_the_plug_in_and_the_function_agree(tmp_path: Path) -> None:
    path = npz(tmp_path, gain=GAIN.T)
    by_name = wa.simulate("file", path=str(path), axes="subcarrier,user", drop="0", max_bytes="99999")
    np.testing.assert_array_equal(by_name.sensed.gain, wa.read(path, axes="subcarrier,user").sensed.gain)
    assert by_name.facts == wa.read(path, axes="subcarrier,user").facts


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"unit": "dBm"}, "unit must be one of linear, db, complex; got 'dbm'"),
        ({"axes": "users,subcarrier"}, "unknown axis 'users'"),
        ({"axes": "user,user"}, "stands twice"),
        ({"axes": "slot,subcarrier"}, "must name both user and subcarrier"),
        ({"drop": -1}, "drop counts from 0; got -1"),
        ({"max_bytes": 0}, "max_bytes must be more than zero"),
    ],
)
def test_options_that_make_no_sense(options: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        File(path=Path("x.csv"), **options)


def test_reading_hdf5_does_not_load_h5py_in_this_process(tmp_path: Path) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["gain"] = GAIN
    code = "import sys, wirelessagent as wa; wa.read(sys.argv[1]); print('h5py' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code, tmp_path / "a.h5"], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


def test_importing_the_reader_loads_neither_scipy_nor_h5py() -> None:
    code = "import sys, wirelessagent.sensing.files; print(sorted({'scipy', 'h5py', 'numba'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
