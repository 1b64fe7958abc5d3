"""The only door to Numba.

A kernel is a plain function on arrays, in a file named ``<algorithm>_kernel.py`` and imported inside the method that
uses it. It may call other kernels of its package, but uses no constants from elsewhere, which Numba would freeze.
Kernels release the GIL; fast-math is off.

Nobody waits for a compiler. A call whose machine code is in the cache (:mod:`~wirelessagent.kernels.code_cache`) runs
it. Where it is not, small work runs as the kernel's interpreted twin (:mod:`~wirelessagent.kernels.twin`) while one
process compiles in the background (:mod:`~wirelessagent.kernels.background`), and a process that lives on switches over
as the code appears; large work waits for the code (:mod:`~wirelessagent.kernels.supply`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from wirelessagent.kernels.supply import LARGE_GAINS, Ran, work_on

__all__ = ["LARGE_GAINS", "Ran", "kernel", "work_on"]

P = ParamSpec("P")
R = TypeVar("R")


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Run ``function`` as machine code where that is there, else as :mod:`wirelessagent.kernels` says.

    >>> import numpy as np
    >>> @kernel
    ... def total(values):
    ...     found = 0.0
    ...     for value in values:
    ...         found += value
    ...     return found
    >>> float(total(np.array([1.0, 2.0])))
    3.0
    """
    from wirelessagent.kernels.dispatcher import dispatched

    return dispatched(function)
