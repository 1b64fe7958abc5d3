"""What the trainers share: features made by some processes, a matrix of them, weights of eight bits, and the file."""

from __future__ import annotations

import logging
import multiprocessing
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt
from scipy import sparse

Item = TypeVar("Item")
Made = TypeVar("Made")
_LOG = logging.getLogger(__name__)


def matrix_of(columns: Sequence[npt.NDArray[np.int64]], width: int) -> sparse.csr_matrix:
    """(sentence, bucket) of the buckets that sentences fall into: every row has length one."""
    sizes = np.array([len(each) for each in columns])
    values = np.repeat(1 / np.sqrt(sizes), sizes)
    starts = np.concatenate([[0], np.cumsum(sizes)])
    return sparse.csr_matrix((values, np.concatenate(columns), starts), shape=(len(columns), width))


_TASK = list[Callable[[int], Any]]()
"""What forked processes find there, as not every item can be sent to them."""


def _done(place: int) -> Any:
    return _TASK[0](place)


def in_parallel(
    do: Callable[[Item], Made], items: Sequence[Item], processes: int = 2, at_once: int = 500
) -> list[Made]:
    """What some processes make of each item, in order; one process is this one."""
    if processes == 1:
        return list(map(do, items))
    _TASK[:] = [lambda place: do(items[place])]
    with multiprocessing.get_context("fork").Pool(processes) as pool:
        return pool.map(_done, range(len(items)), chunksize=at_once)


def rounded(weights: npt.NDArray[np.float32], faint: int = 0) -> tuple[npt.NDArray[np.int8], npt.NDArray[np.float32]]:
    """Weights (bucket, any) as int8, those of at most so many 127ths of the largest as none, and their scales."""
    scales = np.asarray(np.abs(weights).max(axis=0) / 127, dtype=np.float32)
    found = np.asarray(np.rint(weights / scales), dtype=np.int8)
    return np.where(np.abs(found) > faint, found, np.int8(0)), scales


def write(shipped: Path, make: Callable[[Path], object]) -> None:
    """Make a model and write it to the file that the command line names, or to the one that is shipped."""
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    path, start = Path(sys.argv[1]) if len(sys.argv) > 1 else shipped, time.perf_counter()
    make(path)
    _LOG.info("%s: %d kB (%.0f s)", path.name, path.stat().st_size // 1000, time.perf_counter() - start)
