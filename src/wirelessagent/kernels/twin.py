"""The interpreted twin of a kernel: the same function, run by Python with the arithmetic of machine code.

Machine code divides by zero as IEEE 754 says, without an error. So do NumPy's scalars, and so that no other floats come
up, the twin's constants are NumPy's, and so is what ``float`` and ``math`` make. A twin calls the twins of the kernels
that its kernel calls: its globals are those of the kernel's module with a twin in each kernel's place.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import CodeType, FunctionType
from typing import Any, Protocol, cast

import numpy as np


class Twinned(Protocol):
    """A kernel, as far as its twin is concerned."""

    py_func: Callable[..., Any]
    twin: Callable[..., Any] | None


_lock = threading.RLock()
_globals: dict[int, tuple[dict[str, Any], dict[str, Any]]] = {}
"""By the identity of a module's globals: these, so that they live, and the twins' globals."""


def twin_of(kernel: Twinned) -> Callable[..., Any]:
    """The interpreted twin of a kernel, made at its first use."""
    if kernel.twin is None:
        with _lock:
            function: Any = kernel.py_func
            code, names = _with_numpy_floats(function.__code__), _twin_globals(function.__globals__)
            kernel.twin = FunctionType(code, names, function.__name__, function.__defaults__, function.__closure__)
    return kernel.twin


def _twin_globals(names: dict[str, Any]) -> dict[str, Any]:
    if id(names) not in _globals:
        made: dict[str, Any] = {}
        _globals[id(names)] = names, made  # before it is filled: modules may name each other's kernels
        made.update({name: _twin_value(value) for name, value in names.items()}, float=np.float64)
    return _globals[id(names)][1]


def _twin_value(value: Any) -> Any:
    if hasattr(value, "py_func") and hasattr(value, "twin"):
        return twin_of(value)
    return np.float64(value) if type(value) is float else value


def _with_numpy_floats(code: CodeType) -> CodeType:
    return code.replace(co_consts=tuple(_numpy_constant(constant) for constant in code.co_consts))


def _numpy_constant(constant: object) -> object:
    if type(constant) is float:
        return np.float64(constant)
    if isinstance(constant, tuple):
        return tuple(_numpy_constant(one) for one in cast("tuple[object, ...]", constant))
    return _with_numpy_floats(constant) if isinstance(constant, CodeType) else constant
