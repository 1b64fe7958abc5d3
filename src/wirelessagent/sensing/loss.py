"""What gets lost between the users' measurements and the base station: patterns of missing gains.

    scene.observe(loss.random(0.2) | loss.users(1), seed=2)

A pattern strikes each slot independently. Rates are shares of a slot's gains and are kept as exactly as whole entries
allow: where rate × entries is not whole, it is rounded up or down at random, so that the mean is the rate. A pattern
with a rate below 1 never loses a whole slot, even where its rate would round to that; several together, :func:`stale`
and a count of all :func:`users` can.
Entries that are missing already (a measured file with holes) are struck like the others and stay missing.
"""

from __future__ import annotations

import functools
import inspect
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from wirelessagent.model.arrays import BoolArray, FloatArray, positive, whole
from wirelessagent.model.errors import InputError, UnknownNameError
from wirelessagent.model.scene import Loss

_PATIENCE = 500
"""Placements of a burst tried, for each one found, before bursts may touch."""


def random(rate: float) -> Random:
    """Single entries, anywhere, at a rate."""
    return Random(rate)


def bursts(rate: float, min_length: int = 3, max_length: int = 6) -> Bursts:
    """Runs of contiguous subcarriers of one user, of random length."""
    return Bursts(rate, min_length, max_length)


def subcarriers(rate: float) -> Subcarriers:
    """Whole subcarriers, lost for all users."""
    return Subcarriers(rate)


def users(amount: float) -> Users:
    """Whole users: a count (1, 2 …) or, below 1, a share of them."""
    return Users(amount)


def stale(num_slots: int) -> Stale:
    """The last slots, whole: the report is late."""
    return Stale(num_slots)


def when_weak(rate: float, strength: float = 2.0) -> WhenWeak:
    """Single entries at a rate, weak ones more often: not missing at random."""
    return WhenWeak(rate, strength)


class LossPattern(ABC):
    """A pattern of missing entries that can be combined with others by ``|``."""

    @abstractmethod
    def missing(self, gain: FloatArray, rng: np.random.Generator) -> BoolArray:
        """True where an entry of ``gain`` (slot, user, subcarrier) gets lost, same shape."""

    def __or__(self, other: Loss) -> Combined:
        return Combined((self, other))


@dataclass(frozen=True)
class Combined(LossPattern):
    """Everything that any of its parts loses; the parts strike independently of each other."""

    parts: tuple[Loss, ...]

    def __or__(self, other: Loss) -> Combined:
        return Combined((*self.parts, other))

    def missing(self, gain: FloatArray, rng: np.random.Generator) -> BoolArray:
        return functools.reduce(np.logical_or, [part.missing(gain, rng) for part in self.parts])


@dataclass(frozen=True)
class Random(LossPattern):
    """Entries lost at random, whatever their gain, ``rate`` of each slot's."""

    rate: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "rate", _rate(self.rate))

    def missing(self, gain: FloatArray, rng: np.random.Generator) -> BoolArray:
        score = rng.random((len(gain), gain[0].size))
        return _highest(score, self.rate, rng).reshape(gain.shape)


@dataclass(frozen=True)
class Bursts(LossPattern):
    """Runs of contiguous subcarriers of one user lost together, ``rate`` of each slot's entries in all.

    Lengths are uniform from ``min_length`` to ``max_length``. Bursts lie within the band, so that its edges are lost
    less often, and do not touch each other while there is room, which with the default lengths ends at a rate of about
    0.6; beyond it they run together. The last burst is kept or left out at random so that the mean is the rate; a
    slot's own share differs by less than one burst.
    """

    rate: float
    min_length: int = 3
    max_length: int = 6

    def __post_init__(self) -> None:
        object.__setattr__(self, "rate", _rate(self.rate))
        for name in ("min_length", "max_length"):
            object.__setattr__(self, name, whole(name, getattr(self, name)))
        if self.max_length < self.min_length:
            raise InputError(f"max_length must be at least min_length ({self.min_length}); got {self.max_length}")

    def missing(self, gain: FloatArray, rng: np.random.Generator) -> BoolArray:
        if gain.shape[2] < self.min_length:
            raise InputError(
                f"bursts of {self.min_length} subcarriers do not fit into {gain.shape[2]}: lower min_length"
            )
        return np.stack([self._slot(gain.shape[1], gain.shape[2], rng) for _ in gain])

    def _slot(self, num_users: int, num_subcarriers: int, rng: np.random.Generator) -> BoolArray:
        """One slot's losses, shape (user, subcarrier)."""
        lost = np.zeros((num_users, num_subcarriers), dtype=bool)
        if self.rate == 1:
            return ~lost
        wanted = self.rate * lost.size
        patience = _PATIENCE
        while wanted > 0:
            user = lost[rng.integers(num_users)]
            length = rng.integers(self.min_length, min(self.max_length, num_subcarriers) + 1)
            start = rng.integers(num_subcarriers - length + 1)
            if patience > 0 and user[max(0, start - 1) : start + length + 1].any():
                patience -= 1
                continue
            burst = user[start : start + length]
            new = length - np.count_nonzero(burst)
            if new > wanted and rng.random() * new >= wanted:
                break
            if np.count_nonzero(lost) + new == lost.size:
                break
            burst[:] = True
            wanted -= new
            patience = _PATIENCE if patience > 0 else 0
        return lost


@dataclass(frozen=True)
class Subcarriers(LossPattern):
    """Whole subcarriers lost for all users, ``rate`` of each slot's."""

    rate: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "rate", _rate(self.rate))

    def missing(self, gain: FloatArray, rng: np.random.Generator) -> BoolArray:
        lost = _highest(rng.random((gain.shape[0], gain.shape[2])), self.rate, rng)
        return np.repeat(lost[:, np.newaxis], gain.shape[1], axis=1)


@dataclass(frozen=True)
class Users(LossPattern):
    """Whole users lost in each slot: a number of them from 1 on, or a share of them below 1."""

    amount: float

    def __post_init__(self) -> None:
        amount = positive("the number (from 1 on) or share (below 1) of users lost", self.amount, zero=True)
        if amount > 1 and amount != int(amount):
            raise InputError(f"the number of users lost must be whole, or a share below 1; got {self.amount!r}")
        object.__setattr__(self, "amount", amount)

    def missing(self, gain: FloatArray, rng: np.random.Generator) -> BoolArray:
        num_slots, num_users, num_subcarriers = gain.shape
        if self.amount > num_users:
            raise InputError(f"users:{self.amount:g} cannot be lost of {num_users} users: lose fewer")
        rate = self.amount if self.amount < 1 else self.amount / num_users
        lost = _highest(rng.random((num_slots, num_users)), rate, rng)
        return np.repeat(lost[:, :, np.newaxis], num_subcarriers, axis=2)


@dataclass(frozen=True)
class Stale(LossPattern):
    """The last ``num_slots`` slots missing whole; earlier ones must be there, else nothing would be left."""

    num_slots: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "num_slots", whole("the number of stale slots", self.num_slots, smallest=0))

    def missing(self, gain: FloatArray, rng: np.random.Generator) -> BoolArray:
        if self.num_slots >= len(gain):
            raise InputError(
                f"stale:{self.num_slots} leaves nothing of an observation of {len(gain)} slot(s): "
                f"take num_slots of {self.num_slots + 1} or more from the source, or lose less"
            )
        lost = np.zeros(gain.shape, dtype=bool)
        lost[len(gain) - self.num_slots :] = True
        return lost


@dataclass(frozen=True)
class WhenWeak(LossPattern):
    """Entries lost more often where they are weak, ``rate`` of each slot's.

    Entries are drawn one after the other without putting back, each with odds exp(−strength · g/ḡ_k) for the mean ḡ_k
    of its user over the observation: at the strength of 2 an entry in a full fade is e² = 7.4 times likelier to go
    next than one at its user's mean. Strength 0 is :class:`Random`. (Efraimidis and Spirakis, 2006, as the highest of
    log-odds plus Gumbel noise.)
    """

    rate: float
    strength: float = 2.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "rate", _rate(self.rate))
        object.__setattr__(self, "strength", positive("strength", self.strength, zero=True))

    def missing(self, gain: FloatArray, rng: np.random.Generator) -> BoolArray:
        observed = ~np.isnan(gain)
        total = np.where(observed, gain, 0.0).sum(axis=(0, 2), keepdims=True)
        mean = total / np.maximum(observed.sum(axis=(0, 2), keepdims=True), 1)
        level = np.divide(gain, mean, out=np.ones(gain.shape), where=observed & (mean > 0))
        score = rng.gumbel(size=gain.shape) - self.strength * level
        return _highest(score.reshape(len(gain), -1), self.rate, rng).reshape(gain.shape)


@dataclass(frozen=True, kw_only=True)
class Pattern:
    """A pattern that can be named in text: how it is written, what it loses, and what makes it."""

    usage: str
    summary: str
    make: Callable[..., LossPattern]


def _pattern(usage: str, make: Callable[..., LossPattern]) -> Pattern:
    return Pattern(usage=usage, summary=(make.__doc__ or "").strip(), make=make)


PATTERNS: Mapping[str, Pattern] = MappingProxyType(
    {
        "random": _pattern("random:RATE", random),
        "bursts": _pattern("bursts:RATE[,MIN_LENGTH,MAX_LENGTH]", bursts),
        "subcarriers": _pattern("subcarriers:RATE", subcarriers),
        "users": _pattern("users:COUNT or users:SHARE", users),
        "stale": _pattern("stale:SLOTS", stale),
        "when_weak": _pattern("when_weak:RATE[,STRENGTH]", when_weak),
    }
)
"""Every pattern that :func:`parse` knows, by name."""


def parse(text: str) -> LossPattern:
    """The pattern that a text names: ``NAME:VALUE``, several joined by +.

    >>> parse("random:0.1 + users:1")
    Combined(parts=(Random(rate=0.1), Users(amount=1.0)))

    Raises:
        InputError: a name that is not a pattern's, or a value that it cannot take.
    """
    parts = [_parse_one(part.strip(), text) for part in text.split("+")]
    return parts[0] if len(parts) == 1 else Combined(tuple(parts))


def _parse_one(part: str, text: str) -> LossPattern:
    name, _, value = part.partition(":")
    usages = ", ".join(pattern.usage for pattern in PATTERNS.values())
    if not name.strip():
        raise InputError(f"a loss pattern is missing in {text!r}; known are {usages}, several joined by +")
    pattern = PATTERNS.get(name.strip())
    if pattern is None:
        raise UnknownNameError("loss pattern", name.strip(), PATTERNS)
    try:
        numbers = [_number(item) for item in value.split(",")]
        inspect.signature(pattern.make).bind(*numbers)
    except (ValueError, TypeError) as error:
        raise InputError(f"{part!r} is not of the form {pattern.usage}; known are {usages}") from error
    try:
        return pattern.make(*numbers)
    except InputError as error:
        raise InputError(f"{part!r} cannot be used: {error}; known are {usages}") from error


def _number(text: str) -> float:
    """The number in ``text``, an int where it is written as one."""
    try:
        return int(text)
    except ValueError:
        return float(text)


def _highest(score: FloatArray, rate: float, rng: np.random.Generator) -> BoolArray:
    """True at the ``rate`` of each row's highest scores; same shape (row, entry).

    rate × entries is rounded at random; below a rate of 1 at least one entry stays.
    """
    size = score.shape[1]
    exact = round(rate * size, 9)  # a share that was made from a whole number of entries gives that number back
    count = np.floor(exact).astype(int) + (rng.random(len(score)) < exact % 1)
    if rate < 1:
        count = np.minimum(count, size - 1)
    lost = np.zeros(score.shape, dtype=bool)
    for row, order, number in zip(lost, np.argsort(-score, axis=1), count, strict=True):
        row[order[:number]] = True
    return lost


def _rate(value: float) -> float:
    rate = positive("a loss rate", value, zero=True)
    if rate > 1:
        raise InputError(f"a loss rate must be in [0, 1]; got {value!r} (20 % is 0.2)")
    return rate
