"""Bad channel files: each is refused with one clear line that names the value and the mend."""

from __future__ import annotations

import io
import json
import pickle
import struct
import warnings
import zipfile
import zlib
from pathlib import Path

import h5py
import numpy as np
import pytest
from scipy.io import savemat
from scipy.sparse import csc_array

import wirelessagent as wa
from wirelessagent.model.errors import FileFormatError


def npy(array: np.ndarray) -> bytes:
    stream = io.BytesIO()
    np.save(stream, array, allow_pickle=True)
    return stream.getvalue()


def npy_header(header: str) -> bytes:
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header) + 1) + header.encode() + b"\n"


def npz(**arrays: np.ndarray) -> bytes:
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    return stream.getvalue()


def zipped(names: list[str], content: bytes, method: int = zipfile.ZIP_DEFLATED) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method) as archive, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of a name that comes twice
        for name in names:
            archive.writestr(name, content)
    return stream.getvalue()


def mat(**variables: object) -> bytes:
    stream = io.BytesIO()
    savemat(stream, variables, do_compression=True)
    return stream.getvalue()


class Bomb:
    """Unpickling it would fail the test loudly."""

    def __reduce__(self) -> tuple[object, ...]:
        return (pytest.fail, ("a pickle was loaded",))


GAIN = np.arange(1.0, 7.0).reshape(2, 3)
OBJECTS = np.array([[Bomb(), 1.0]], dtype=object)
DEEP = "[" * 100_000 + "]" * 100_000
NESTED = b"[" * 900 + b"1" + b"]" * 900

BAD: dict[str, tuple[str, bytes, dict[str, object], str]] = {
    # what: file name, content, options, the words that must be in the message
    "empty file": ("a.csv", b"", {}, "is empty"),
    "blank file": ("a.csv", b" \n\n", {}, "is empty"),
    "empty archive": ("a.npz", zipped([], b""), {}, "no .npy array"),
    "other archive": ("a.xlsx", zipped(["xl/workbook.xml"], b"<x/>"), {}, "it holds xl/workbook.xml"),
    "unknown format": ("a.bin", b"\x00\x01\x02\x03", {}, "unknown format"),
    "picture": ("a.png", b"\x89PNG\r\n\x1a\n\x00\x00", {}, "unknown format"),
    "wrong name": ("a.npz", b"1,2\n3,4\n", {}, "called .npz but does not start as NPZ"),
    "gzip": ("a.csv.gz", b"\x1f\x8b\x08rest", {}, "unpack it first"),
    "classic netCDF": ("a.nc", b"CDF\x01rest", {}, "nccopy"),
    "pickle": ("a.pkl", pickle.dumps({"gain": 1}), {}, "never loaded"),
    "pickle called npy": ("a.npy", pickle.dumps({"gain": 1}), {}, "never loaded"),
    "objects in npy": ("a.npy", npy(OBJECTS), {}, "Python objects (a pickle), which is never loaded"),
    "objects in npz": ("a.npz", npz(gain=OBJECTS), {}, "'gain' is an array of Python objects"),
    "records": ("a.npy", npy(np.zeros((2, 2), dtype="f4,f4")), {}, "never loaded"),
    "text array": ("a.npz", npz(gain=np.array([["a", "b"]])), {}, "text where gains"),
    "switch array": ("a.npz", npz(gain=np.array([[True, False]])), {}, "switches where gains"),
    "one dimension": ("a.npy", npy(np.ones(5)), {}, "has 1 dimension; it must have two"),
    "no dimension": ("a.npy", npy(np.ones(())), {}, "has 0 dimensions"),
    "four dimensions": ("a.npy", npy(np.ones((1, 1, 2, 2))), {}, "has 4 dimensions"),
    "no users": ("a.npy", npy(np.ones((0, 3))), {}, "is empty; it must hold at least one user"),
    "too many axes": ("a.npy", npy(GAIN), {"axes": "slot,user,subcarrier"}, "2 dimensions, but 3 axes"),
    "no such drop": ("a.npy", npy(GAIN[None]), {"axes": "drop,user,subcarrier", "drop": 1}, "no drop 1"),
    "drop without drops": ("a.npy", npy(GAIN), {"drop": 1}, "there is no drop 1; the file has 1"),
    "negative gain": ("a.csv", b"1,2\n3,-4e-3\n", {}, "negative gain, -0.004 at user 2, subcarrier 2"),
    "negative gain's mend": ("a.csv", b"1,-9\n", {}, "give missing_value=-9 (--missing-value -9)"),
    "two negative gains": ("a.csv", b"-1,-9\n", {}, "subcarrier 1 (counted from 1) and 1 more place;"),
    "negative in a slot": ("a.npy", npy(-GAIN[None]), {}, "slot 1, user 1, subcarrier 1 (counted from 1) and 5 more"),
    "infinite gain": ("a.csv", b"1,inf\n", {}, "infinite, inf at user 1, subcarrier 2"),
    "infinite dB": ("a.csv", b"1,5000\n", {"unit": "db"}, "infinite, 5000 dB"),
    "infinite square": ("a.npy", npy(GAIN * 1e200 * 1j), {}, "infinite"),
    "complex in dB": ("a.npy", npy(GAIN * 1j), {"unit": "db"}, "complex"),
    "repaired by half": ("a.npz", npz(gain=GAIN, repaired=GAIN / 2), {}, "neither 0 nor 1"),
    "all missing": ("a.csv", b",\n,NaN\n", {}, "all 4 entries are missing"),
    "all sentinel": ("a.npy", npy(GAIN * 0), {"missing_value": 0.0}, "all 6 entries are missing"),
    "ragged csv": ("a.csv", b"1,2,3\n4,5\n", {}, "line 2 has 2 cells, line 1 has 3"),
    "ragged header": ("a.csv", b"user,a,b\nx,1,2\ny,1\n", {}, "line 3 has 2 cells, line 1 has 3"),
    "header only": ("a.csv", b"user,f1,f2\n", {}, "only a header"),
    "text cell": ("a.csv", b"1,2\n3,abc\n", {}, "line 2, column 2 holds abc, which is not a number"),
    "text cell behind names": ("a.csv", b"user,a,b\nx,1,2\ny,1,?\n", {}, "line 3, column 3 holds ?"),
    "point after comma": (
        "a.csv",
        b"1;2,5\n3.5;4\n",
        {},
        "3.5 with a decimal point, line 1 has 2,5 with a decimal comma",
    ),
    "comma after point": (
        "a.csv",
        b"1\t2.5\n3,5\t4\n",
        {},
        "3,5 with a decimal comma, line 1 has 2.5 with a decimal point",
    ),
    "thousands": ("a.csv", b"1,234.5;2\n", {}, "without commas that group its digits"),
    "two thousands": ("a.csv", b"1,234,567;2\n", {}, "without commas that group its digits"),
    "quoted comma": ("a.csv", b'"1,5","2,5"\n', {}, "holds 1,5, which is not a number; write it with a decimal point"),
    "comma for both": ("a.csv", b"0,5,0,25\n,0,5\n", {}, "missing. If 1,5 is meant as one number, write 1.5"),
    "spaces": ("a.txt", b"1 2 3\n4 5 6\n", {}, "separate cells with commas"),
    "underscore": ("a.csv", b"1,1_000\n2,3\n", {}, "holds 1_000"),
    "blank line": ("a.csv", b"1,2\n\n3,4\n", {}, "line 2 is empty"),
    "open quote": ("a.csv", b'1,2\n"3,4\n', {}, "check its quotes"),
    "long cell": ("a.csv", b"1,2\n3," + b"4" * 200_000, {}, "is not CSV"),
    "huge number": ("a.csv", b"1," + b"9" * 400, {}, "infinite"),
    "not UTF-8": ("a.csv", b"user,a\nJos\xe9,1\n", {}, "byte 0xe9 in line 2"),
    "UTF-16": ("a.csv", "1,2".encode("utf-16"), {}, "UTF-16"),
    "same user twice": ("a.csv", b"x,1\ny,2\nx,3\n", {}, "lines 1 and 3 are both for user 'x'"),
    "number among names": ("a.csv", b"x,1\n7,2\n", {}, "line 2, column 1 holds '7'"),
    "name among numbers": ("a.csv", b"7,1\nx,2\n", {}, "line 2, column 1 holds x"),
    "numbers as names": ("a.csv", b"user,a\n1,2\n2,3\n", {}, "headed 'user'"),
    "numbers as headings": ("a.csv", b"user,1,2\nAnn,3,4\n", {}, "begins with 'user' as a header does"),
    "name left out": ("a.csv", b"Ann,1\n,2\n", {}, "line 2, column 1 holds '' where line 1 has the user name 'Ann'"),
    "pandas index": ("a.csv", b",0,1,2\n0,.1,.2,.3\n1,.4,.5,.6\n", {}, "index=False"),
    "slots uneven": ("a.csv", b"slot,a\n0,1\n0,2\n1,3\n", {}, "slot '1' has 1 lines, slot '0' has 2"),
    "slots mixed": ("a.csv", b"slot,a\n0,1\n1,2\n0,3\n", {}, "slot '0' comes back in line 4"),
    "slots disordered": ("a.csv", b"slot,u,a\n0,x,1\n0,y,2\n1,y,3\n1,x,4\n", {}, "line 4 is for user 'y'"),
    "broken json": ("a.json", b"[[1, 2], [3,", {}, "cannot be read as JSON"),
    "json number": ("a.json", b"3", {}, "holds 3 where a list of lists"),
    "json null": ("a.json", b"null", {}, "holds None"),
    "json deep": ("a.json", DEEP.encode(), {}, "is nested too deeply"),
    "json deep objects": ("a.json", b'{"a":' * 100_000 + b"1" + b"}" * 100_000, {}, "is nested too deeply"),
    "json deep gain": ("a.json", b'{"gain": ' + NESTED + b"}", {}, "'gain' is nested 900 deep"),
    "json deep cell": ("a.json", b"[[1, 2], [3, " + NESTED + b"]]", {}, "the matrix[1][1] is [[[[[[[...]]]]]]]"),
    "json deep meta": ("a.json", b'{"gain": [[1]], "meta": ' + NESTED + b"}", {}, "meta is [[[[[[[...]]]]]]]"),
    "json deep meta text": (
        "a.json",
        json.dumps({"gain": [[1]], "meta": DEEP}).encode(),
        {},
        "meta is nested too deep",
    ),
    "json deep variance": ("a.json", b'{"gain": [[1]], "noise_variance": ' + NESTED + b"}", {}, "nested 900 deep"),
    "json long name": ("a.json", json.dumps({"a\nb" * 9999: [[1, 2], [3]]}).encode(), {}, "write null where missing"),
    "json ragged": ("a.json", b"[[1, 2], [3]]", {}, "the matrix[1] has 1 entries, the matrix[0] has 2"),
    "json ragged depth": ("a.json", b"[[1, 2], 3]", {}, "the matrix[1] is 3 where a list"),
    "json text": ("a.json", b'{"gain": [[1, "x"]]}', {}, "gain[0][1] is 'x'"),
    "json text first": ("a.json", b'{"gain": [["x", 1]]}', {}, "gain[0][0] is 'x'"),
    "json switch": ("a.json", b'{"gain": [[1, true]]}', {}, "gain[0][1] is True"),
    "json switches": ("a.json", b'{"gain": [[true, false]]}', {}, "switches where gains"),
    "json infinity": ("a.json", b"[[1, Infinity]]", {}, "infinite"),
    "json long number": ("a.json", b"[[1, " + b"9" * 5000 + b"]]", {}, "cannot be read as JSON"),
    "json large number": ("a.json", b"[[1, " + b"9" * 400 + b"]]", {}, "the matrix[0][1] is 999"),
    "json key twice": ("a.json", b'{"gain": [[1]], "gain": [[2]]}', {}, "'gain' twice"),
    "json several": ("a.json", b'{"a": [[1, 2]], "b": [[1, 2]]}', {}, "several arrays"),
    "json object": ("a.json", b'{"gain": {"x": 1}}', {}, "is an object, which is never loaded"),
    "json parts differ": ("a.json", b'{"real": [[1, 2]], "imag": [[1]]}', {}, "ragged"),
    "same name twice": ("a.npz", zipped(["gain.npy"] * 2, npy(GAIN)), {}, "2 arrays called 'gain'"),
    "struct": ("a.mat", mat(gain={"a": 1.0}), {}, "a MATLAB struct array, which is never loaded"),
    "cell": ("a.mat", mat(gain=np.array([[1, "a"]], dtype=object)), {}, "a MATLAB cell array"),
    "sparse": ("a.mat", mat(gain=csc_array(GAIN)), {}, "a MATLAB sparse array"),
    "no variables": ("a.mat", mat(), {}, "no array of gains; it holds nothing"),
    "truth elsewhere": ("a.npz", npz(gain=GAIN, truth=GAIN[:1]), {}, "truth has the shape 1 × 3, its gain 2 × 3"),
    "truth with holes": ("a.npz", npz(gain=GAIN, truth=GAIN * np.nan), {}, "the truth must be complete"),
    "wrong names": ("a.npz", npz(gain=GAIN, user_names=np.array(["a"])), {}, "1 user names for 2 users"),
    "names twice": ("a.npz", npz(gain=GAIN, user_names=np.array(["a", "a"])), {}, "two users are called 'a'"),
    "wrong times": ("a.npz", npz(gain=GAIN[None], slot_times_s=np.arange(2.0)), {}, "slot_times_s holds 2"),
    "falling frequencies": ("a.npz", npz(gain=GAIN, subcarrier_frequencies_hz=-np.arange(3.0)), {}, "increasing"),
    "negative variance": ("a.npz", npz(gain=GAIN, noise_variance=-GAIN), {}, "a variance is finite"),
    "npy too short": ("a.npy", npy(GAIN)[:-1], {}, "needs 48 bytes, the file holds 47"),
    "npy too long": ("a.npy", npy(GAIN) + b"x", {}, "needs 48 bytes, the file holds 49"),
    "file too large": ("a.csv", b"1,2\n" * 100, {"max_bytes": 399}, "the file takes 400 bytes, above the limit"),
}


@pytest.mark.parametrize("case", BAD)
def test_refused_with_one_clear_line(case: str, tmp_path: Path) -> None:
    name, content, options, words = BAD[case]
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(FileFormatError) as caught:
        wa.read(path, **options)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert words in message
    assert "\n" not in message
    assert len(message) < len(str(path)) + 500


def test_json_that_is_nested_deeply_does_not_end_the_process(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text('{"gain": [[1]], "deep": ' + "[" * 900 + "]" * 900 + "}")
    assert wa.read(path).sensed.gain.tolist() == [[1]]


def test_names_with_half_a_character_can_be_written_down(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text('{"gain": [[1], [2]], "user_names": ["Zo\\ud800", "x"], "\\udfff": [[1]]}')
    scene = wa.read(path)
    assert scene.sensed.user_names == ("Zo?", "x")
    assert json.dumps(scene.facts, ensure_ascii=False).encode()


@pytest.mark.parametrize(
    ("name", "words"), [("none.csv", "no such file"), ("folder", "is a folder"), ("x" * 300, "cannot be opened")]
)
def test_paths_that_lead_nowhere(name: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    with pytest.raises(FileFormatError, match=words):
        wa.read(tmp_path / name)


LIMIT = 100_000
BIG = np.zeros((8, 20_000))  # 1.28 MB that deflate to about 1.3 kB


def bombs(folder: Path) -> dict[str, bytes]:
    """Small files that unpack beyond the limit, or say that they do."""
    with h5py.File(folder / "a.h5", "w") as file:
        file.create_dataset("gain", data=BIG, compression="gzip")
    with h5py.File(folder / "b.h5", "w") as file:
        file.create_dataset("gain", shape=(1 << 20, 1 << 30), dtype="f8", chunks=(1, 1024))
    with h5py.File(folder / "c.h5", "w") as file:
        file.create_dataset("gain", data=np.ones((1, 1)), maxshape=(None, None), chunks=(1000, 1000), compression=9)
    header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1000000, 1000000), }"
    stored = zipfile.ZIP_STORED
    lying = zipped(["gain.npy"], npy_header(header), stored)
    claim = struct.pack("<II", 14, 1 << 31)  # an element inside that claims 2 GiB
    packed = zlib.compress(claim)
    return {
        "npz": zipped(["gain.npy"], npy(BIG)),
        "npz in pieces": zipped([f"a{i}.npy" for i in range(20)], npy(np.zeros((1, 1000)))),
        "npz header": lying,
        "npy header": npy_header(header),
        "mat": mat(gain=BIG),
        "mat in pieces": mat(**{f"a{i}": np.zeros((1, 1000)) for i in range(20)}),
        "mat claim": mat(gain=GAIN)[:128] + struct.pack("<II", 15, len(packed)) + packed,
        "h5": (folder / "a.h5").read_bytes(),
        "h5 empty": (folder / "b.h5").read_bytes(),
        "h5 chunk": (folder / "c.h5").read_bytes(),
    }


@pytest.mark.parametrize(
    "case",
    [
        "npz",
        "npz in pieces",
        "npz header",
        "npy header",
        "mat",
        "mat in pieces",
        "mat claim",
        "h5",
        "h5 empty",
        "h5 chunk",
    ],
)
def test_what_unpacks_beyond_the_limit_is_refused_before_it_is_unpacked(case: str, tmp_path: Path) -> None:
    import tracemalloc

    path = tmp_path / f"bomb.{case.split()[0]}"
    path.write_bytes(bombs(tmp_path)[case])
    assert path.stat().st_size < LIMIT
    tracemalloc.start()
    try:
        with pytest.raises(FileFormatError, match=r"above the limit|cut short"):
            wa.read(path, max_bytes=LIMIT)
        assert tracemalloc.get_traced_memory()[1] < 8_000_000
    finally:
        tracemalloc.stop()


def test_an_archive_that_lies_about_its_size_is_cut_off(tmp_path: Path) -> None:
    """The size in a ZIP's directory is what was judged, so no more than that is read."""
    content = bytearray(zipped(["gain.npy"], npy(BIG)))
    real = struct.pack("<I", len(npy(BIG)))
    path = tmp_path / "a.npz"
    path.write_bytes(bytes(content).replace(real, struct.pack("<I", 300)))
    with pytest.raises(FileFormatError, match=r"above the limit|damaged"):
        wa.read(path, max_bytes=LIMIT)


def test_hdf5_texts_longer_than_the_file_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file["gain"] = GAIN
        file["user_names"] = ["a", "b"]
        start = file["user_names"].id.get_offset()
    content = bytearray(path.read_bytes())
    struct.pack_into("<I", content, start, 0xE0000001)
    path.write_bytes(content)
    with pytest.raises(FileFormatError, match="a text in /user_names claims 3758096385 bytes"):
        wa.read(path)


def test_hdf5_heaps_that_would_never_end_are_refused(tmp_path: Path) -> None:
    """HDF5's own library runs forever on this file."""
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file["gain"] = GAIN
        file["user_names"] = ["a", "b"]
    content = path.read_bytes()
    heap = content.index(b"GCOL")
    for name, damaged in {"none": 0, "wraps": 2**64 - 8}.items():
        path.write_bytes(content[: heap + 24] + struct.pack("<Q", damaged) + content[heap + 32 :])
        if name == "none":  # an object of no bytes is allowed
            path.write_bytes(content[: heap + 16] + bytes(16) + content[heap + 32 :])
        with pytest.raises(FileFormatError, match=f"the heap at byte {heap} has an object of {damaged} bytes"):
            wa.read(path)


def test_hdf5_data_outside_the_file_are_not_followed(tmp_path: Path) -> None:
    (tmp_path / "secret").write_bytes(GAIN.tobytes())
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file.create_dataset("gain", shape=(2, 3), dtype="f8", external=[(str(tmp_path / "secret"), 0, 48)])
    with pytest.raises(FileFormatError, match="data outside the file"):
        wa.read(path)
    with h5py.File(path, "w") as file:
        file["gain"] = h5py.ExternalLink(str(tmp_path / "other.h5"), "/gain")
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["gain"] = GAIN
    with pytest.raises(FileFormatError, match="holds nothing"):
        wa.read(path)


def test_hdf5_cells_and_references_are_not_loaded(tmp_path: Path) -> None:
    path = tmp_path / "a.mat"
    with h5py.File(path, "w") as file:
        file["#refs#/a"] = GAIN
        cell = file.create_dataset("gain", shape=(1, 1), dtype=h5py.ref_dtype)
        cell[0, 0] = file["#refs#/a"].ref
    with pytest.raises(FileFormatError, match="references"):
        wa.read(path)


def test_metadata_inside_json_are_refused_when_they_are_no_object(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text(json.dumps({"gain": GAIN.tolist(), "meta": [1, 2]}))
    with pytest.raises(FileFormatError, match="meta is"):
        wa.read(path)
