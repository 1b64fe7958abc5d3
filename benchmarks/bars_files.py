"""The bar of damaged files: 2,000 of each format are refused in one line or read, and none ends the process.

Run with ``python benchmarks/bars_files.py [--files 2000] [--only HDF5,NPZ]`` from the repository; takes some minutes.
A process of its own reads the files, so that its death is counted here and not suffered: "death" is the bar, and
"fault" too (anything but a refusal in one line). HDF5's child is started anew only where it broke down ("guarded").
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

from damaged_files import FORMATS, write_damaged
from reading import LastingProcess, outcome

OUTCOMES = ("read", "refused", "guarded", "fault", "death")
LONGEST_S = 120.0
"""For one file: a hundred times what the slowest takes, short of those that HDF5 never ends."""


def work(form: str, first: int, last: int) -> None:
    """Read files of a format and print what becomes of each."""
    with tempfile.TemporaryDirectory() as folder, LastingProcess.for_every_file():
        for number in range(first, last):
            print(number, *outcome(write_damaged(Path(folder), form, number)), flush=True)


def measured(form: str, files: int) -> tuple[Counter[str], list[str]]:
    """How many files came to which end, and the words of those that should not have come to theirs."""
    counts, told, number = Counter[str](), list[str](), 0
    while number < files:
        command = [sys.executable, __file__, "--work", form, str(number), str(files)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as worker:
            assert worker.stdout is not None
            for line in worker.stdout:
                place, end, words = line.rstrip("\n").split(" ", 2)
                counts[end] += 1
                number = int(place) + 1
                if end == "fault":
                    told.append(f"{form} {place}: {words}")
        if number < files:
            counts["death"] += 1
            told.append(f"{form} {number}: the process ended with {worker.returncode}")
            number += 1
    return counts, told


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--files", type=int, default=2000, help="damaged files of each format (2000)")
    parser.add_argument("--only", default=",".join(FORMATS), help="formats, separated by commas: %(default)s")
    parser.add_argument("--work", nargs=3, metavar=("FORMAT", "FIRST", "LAST"), help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.work:
        work(chosen.work[0], int(chosen.work[1]), int(chosen.work[2]))
        return 0
    print(f"{'format':12}" + "".join(f"{name:>10}" for name in OUTCOMES) + f"{'time':>10}")
    failures: list[str] = []
    for form in chosen.only.split(","):
        start = time.perf_counter()
        counts, told = measured(form, chosen.files)
        failures += told
        seconds = f"{time.perf_counter() - start:.0f} s"
        print(f"{form:12}" + "".join(f"{counts[name]:>10}" for name in OUTCOMES) + f"{seconds:>10}", flush=True)
    print(*failures, sep="\n")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
