"""Numba's dispatcher with a say in what runs where it has no machine code.

Calls of code that was loaded once go through Numba alone and cost no more than they do without this.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar, cast

from numba import config as _numba_config
from numba.core import types as _numba_types
from numba.core.registry import CPUDispatcher

from wirelessagent.kernels.code_cache import cache_of
from wirelessagent.kernels.supply import run_interpreted, runs_code
from wirelessagent.kernels.twin import twin_of

P = ParamSpec("P")
R = TypeVar("R")

_config: Any = _numba_config  # Numba has no types of its own
_types: Any = _numba_types
_Dispatcher: Any = CPUDispatcher


def dispatched(function: Callable[P, R]) -> Callable[P, R]:
    """The function as a kernel; itself where ``NUMBA_DISABLE_JIT`` is set."""
    return function if _config.DISABLE_JIT else cast("Callable[P, R]", Kernel(function))


class Kernel(_Dispatcher):
    """Numba's dispatcher, which asks here only where it has no machine code yet, so that calls of code cost no more."""

    def __init__(self, function: Callable[..., Any], *_: Any) -> None:
        options = {"nopython": True, "nogil": True, "error_model": "numpy", "boundscheck": None}
        _Dispatcher.__init__(self, function, targetoptions=options)
        self.missed_at, self.twin = -math.inf, None
        self.cache = cache_of(function)
        if self.cache is not None:
            self._cache = self.cache

    def _compile_for_args(self, *args: Any, **kws: Any) -> Any:
        """What runs this call: loaded or compiled machine code, or the interpreted twin."""
        if runs_code(self, args):
            return _Dispatcher._compile_for_args(self, *args, **kws)
        return run_interpreted(twin_of(self))

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Take integers for integers where another kernel calls with a literal, so that each compiles once."""
        plain = {name: _types.unliteral(kind) for name, kind in kws.items()}
        return _Dispatcher.get_call_template(self, tuple(_types.unliteral(kind) for kind in args), plain)
