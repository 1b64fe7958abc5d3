"""Array types and the checks that every type of the model shares.

Arrays inside the model are read-only: a frozen dataclass whose arrays could be written to would not be frozen.
"""

from __future__ import annotations

import operator
from collections.abc import Iterable
from typing import Any, TypeAlias, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wirelessagent.model.errors import InputError

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]
BoolArray: TypeAlias = NDArray[np.bool_]

LARGEST = 1e100
"""No quantity of a cell is larger in SI units. Beyond lie mistaken units, and squares and products (a variance is the
square of a gain) that are no longer numbers."""
_TOO_LARGE = 2**63
"""Whole numbers from here on do not fit the arrays and kernels that they go to."""
_LONGEST_SHOWN = 80


def frozen(array: NDArray[Any]) -> NDArray[Any]:
    """A read-only array with the same content; copies only what someone else could still write to."""
    if array.flags.writeable or array.base is not None:
        array = array.copy()
    array.flags.writeable = False
    return array


def shown(value: object) -> str:
    """A value as a message shows it: as people write it, and not too long.

    >>> shown(np.zeros(3)), shown(np.float64(2.0)), shown(np.array(1.5))
    ('[0.0, 0.0, 0.0]', '2.0', '1.5')
    """
    plain: object = cast("Any", value).tolist() if isinstance(value, np.ndarray | np.generic) else value
    text = repr(plain)
    return text if len(text) <= _LONGEST_SHOWN else f"{text[:_LONGEST_SHOWN]} …"


def real_array(name: str, value: ArrayLike) -> FloatArray:
    """``value`` as a float64 array, or an error that names it. Complex numbers are refused, even without imaginary
    part: nobody means the real part of a channel coefficient.
    """
    try:
        is_complex = np.iscomplexobj(value)
        array = None if is_complex else np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} must be numbers; got {shown(value)}") from error
    if array is None:
        hint = ": the power gain of a channel coefficient h is |h|², np.abs(h) ** 2" if "gain" in name else ""
        raise InputError(f"{name} must be real; got complex numbers{hint or ': give real ones'}")
    return array


def float_array(name: str, value: ArrayLike) -> FloatArray:
    """``value`` as a read-only float64 array, or an error that names it."""
    return frozen(real_array(name, value))


def per_user(name: str, value: ArrayLike, num_users: int) -> FloatArray:
    """A scalar or one value per user, as a read-only array of shape (user,)."""
    array = float_array(name, value)
    if array.ndim > 1 or (array.ndim == 1 and array.size not in (1, num_users)):
        raise InputError(f"{name} must be one value or one per user ({num_users}); got {_size(array)}")
    filled = np.empty(num_users)
    filled[:] = array
    filled.flags.writeable = False
    return filled


def _size(array: FloatArray) -> str:
    """How many values an array holds, in words."""
    return f"{array.size} values" if array.ndim == 1 else f"an array of shape {array.shape}"


def amounts(name: str, value: ArrayLike, *, infinite: bool = False) -> FloatArray:
    """``value`` as a read-only array of numbers that are zero or more (or infinite, where allowed), or an error."""
    array = float_array(name, value)
    if np.isnan(array).any() or np.any(array < 0) or (np.isinf(array).any() and not infinite):
        raise InputError(f"{name} must be zero or more{'' if infinite else ' and finite'}; got {shown(value)}")
    if np.any((array > LARGEST) & np.isfinite(array)):
        raise InputError(f"{name} must be {LARGEST:g} at most; got {shown(value)}: check its unit")
    return array


def positive(name: str, value: float, *, zero: bool = False, infinite: bool = False) -> float:
    """``value`` as a float that is positive (or zero, or infinite, where allowed), or an error that names it."""
    number = _number(name, value)
    wanted = "zero or more" if zero else "more than zero"
    if np.isnan(number) or number < 0 or (number == 0 and not zero) or (np.isinf(number) and not infinite):
        raise InputError(f"{name} must be {wanted}{'' if infinite else ' and finite'}; got {shown(value)}")
    if LARGEST < number < np.inf:
        raise InputError(f"{name} must be {LARGEST:g} at most; got {shown(value)}: check its unit")
    return number


def whole(name: str, value: int, *, smallest: int = 1) -> int:
    """``value`` as a whole number from ``smallest`` on, or an error that names it."""
    try:
        number = operator.index(value)
    except TypeError as error:
        raise InputError(f"{name} must be a whole number; got {shown(value)}") from error
    if number < smallest:
        raise InputError(f"{name} must be {smallest} or more; got {shown(value)}")
    if number >= _TOO_LARGE:
        raise InputError(f"{name} must be below 2^63; got {shown(value)}")
    return number


def within(
    name: str, value: float, smallest: float, largest: float, *, above: bool = False, below: bool = False
) -> float:
    """``value`` as a number from ``smallest`` (or above it) to ``largest`` (or below it), or an error that names it."""
    number = _number(name, value)
    if not smallest <= number <= largest or (above and number == smallest) or (below and number == largest):
        span = f"{'above' if above else 'from'} {smallest:g} {'and below' if below else 'to'} {largest:g}"
        raise InputError(f"{name} must be {span}; got {shown(value)}")
    return number


def switches(name: str, value: ArrayLike, shape: tuple[int, ...]) -> BoolArray:
    """``value`` as a read-only array of bool of this shape, or an error that names it."""
    array = np.asarray(value)
    if array.shape != shape or array.dtype != np.bool_:
        raise InputError(
            f"{name} must be switches (bool) of shape {shape}; got {array.dtype} of shape {array.shape}"
        )  # fmt: skip
    return frozen(array)


def names(name: str, value: object, num_names: int) -> tuple[str, ...]:
    """``value`` as so many different names, or an error that names it."""
    is_row = not isinstance(value, str) and isinstance(value, Iterable)
    given = tuple(cast("Iterable[object]", value)) if is_row else ()
    found = tuple(each for each in given if isinstance(each, str) and each)
    if len(given) != num_names or len(set(found)) != num_names:
        raise InputError(f"{name} must be {num_names} different names; got {shown(cast('object', value))}")
    return found


def _number(name: str, value: float) -> float:
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"{name} must be a number; got {shown(value)}") from error
