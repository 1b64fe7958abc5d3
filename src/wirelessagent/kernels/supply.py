"""Which of the two runs a kernel: its machine code or its interpreted twin.

``WIRELESSAGENT_COMPILE`` says who compiles what is missing: a process in the ``background`` (the default), the caller
in the ``foreground`` before it goes on, or ``never`` anybody: the machine code that is there is used, and the rest is
interpreted.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeAlias, cast, get_args

import numpy as np

from wirelessagent.model.errors import InputError

if TYPE_CHECKING:
    from wirelessagent.kernels.code_cache import CodeCache

Mode: TypeAlias = Literal["background", "foreground", "never"]
Ran: TypeAlias = Literal["compiled", "interpreted"]

LARGE_GAINS = 2_500
"""Gains (slots × users × subcarriers) from which on work waits for its machine code: interpreted, a repair takes some
10 ms for each, and compiling all that it needs half a minute."""

RETRY_S = 1.0
"""How often code that was missing is looked for again."""

_interpreted_calls = 0
_compiles_here = False
_is_large: ContextVar[bool] = ContextVar("_is_large", default=False)


class Compilable(Protocol):
    """A kernel, as far as its machine code is concerned. ``missed_at`` is when that was last looked for in vain."""

    py_func: Callable[..., object]
    targetctx: Any
    cache: CodeCache | None
    missed_at: float

    def typeof_pyval(self, value: Any) -> Any: ...


def mode() -> Mode:
    """Who compiles, as ``WIRELESSAGENT_COMPILE`` says.

    Raises:
        InputError: it says something else.
    """
    if _compiles_here:
        return "foreground"
    named = os.environ.get("WIRELESSAGENT_COMPILE") or "background"
    if named not in get_args(Mode):
        raise InputError(f"WIRELESSAGENT_COMPILE must be one of {', '.join(get_args(Mode))}; got {named!r:.40}")
    return cast(Mode, named)


@contextmanager
def foreground() -> Generator[None]:
    """Have this process compile what it misses, whatever the environment says."""
    global _compiles_here
    before, _compiles_here = _compiles_here, True
    try:
        yield
    finally:
        _compiles_here = before


class Work:
    """Work with kernels, from when this was made."""

    def __init__(self) -> None:
        self._before = _interpreted_calls

    @property
    def ran(self) -> Ran:
        """``interpreted`` where the process interpreted any kernel since."""
        return "compiled" if _interpreted_calls == self._before else "interpreted"


@contextmanager
def work_on(num_gains: int) -> Generator[Work]:
    """Say how large the work is whose kernels are called now, and see what ran; a part of large work is large."""
    token = _is_large.set(_is_large.get() or num_gains >= LARGE_GAINS)
    try:
        yield Work()
    finally:
        _is_large.reset(token)


def runs_code(kernel: Compilable, arguments: tuple[Any, ...]) -> bool:
    """Whether a call runs machine code, because that is there or is to be compiled now; a large call waits for it."""
    who, cache, large = mode(), kernel.cache, _is_large.get()
    if who == "foreground" or kernel.py_func.__module__ == "__main__":  # which no other process can import
        return True
    if cache is None:
        return who == "background" and large
    if time.monotonic() - kernel.missed_at < RETRY_S and not large:
        return False
    signature = tuple(kernel.typeof_pyval(argument) for argument in arguments)

    def is_there() -> bool:
        return cache.has(signature, kernel.targetctx)

    if is_there():
        return True
    kernel.missed_at = time.monotonic()
    if who == "never":
        return False
    from wirelessagent.kernels import background

    background.ask_for(kernel.py_func, signature)
    if large:
        background.wait_for(is_there)
    return large


def run_interpreted(twin: Callable[..., Any]) -> Callable[..., Any]:
    """A call of the twin without warnings, which counts that it was interpreted."""

    def run(*arguments: Any, **named: Any) -> Any:
        global _interpreted_calls
        _interpreted_calls += 1
        with np.errstate(all="ignore"):
            return twin(*(np.float64(one) if type(one) is float else one for one in arguments), **named)

    return run
