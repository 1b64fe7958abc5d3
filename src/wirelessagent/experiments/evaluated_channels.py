"""The channels of an evaluation: simulated ones, of which all is known, and those in files.

A simulated channel is the source ``rayleigh``, whose users all have one delay spread, or each one of several ("mixed").
Errors are relative to each user's ensemble mean, and there is an oracle. A file may hold independent drops or the slots
of one; a draw takes any of them. Errors are then relative to the true mean of the user's row, since that is all that is
known of its level, and there is no oracle.
"""

from __future__ import annotations

import dataclasses
import functools
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias, cast

import numpy as np

from wirelessagent import plugins
from wirelessagent.experiments.oracle import Oracle
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import InputError
from wirelessagent.model.scene import Scene
from wirelessagent.model.units import from_db
from wirelessagent.sensing.files import File
from wirelessagent.sensing.rayleigh import Rayleigh, measured, streams

SIMULATED = "rayleigh"
MIXED_NS = (30.0, 100.0, 300.0, 1000.0)
"""The delay spreads of "mixed", each user's drawn from them."""

CellRule: TypeAlias = Callable[[Cell], Cell]
"""What is changed about the cell that a file states. To run in other processes it must pickle."""


@dataclass(frozen=True)
class Drawn:
    """One draw of a channel.

    Attributes:
        scene: with its truth; the last slot is the current one.
        level: what errors are relative to, shape (user,); 0 for users without any gain.
        oracle: who knows mean, covariance and noise; None where nobody does.
    """

    scene: Scene
    level: FloatArray
    oracle: Oracle | None

    @property
    def truth(self) -> FloatArray:
        """The true gains of the current slot, shape (user, subcarrier)."""
        truth = self.scene.current_truth
        assert truth is not None
        return truth


class EvaluatedChannel(ABC):
    """A channel that draws can be made of."""

    name: str

    @abstractmethod
    def drawn(self, seed: int) -> Drawn:
        """A draw; the same for the same seed."""

    @property
    def has_oracle(self) -> bool:
        return False

    @abstractmethod
    def caption(self) -> str:
        """What it is, in a few words."""


@dataclass(frozen=True, kw_only=True)
class SimulatedChannel(EvaluatedChannel):
    """The source ``rayleigh``.

    Attributes:
        name: how it is called in tables.
        source: all about it but the delay spread.
        rms_delay_spreads_s: the users', each one of these.
        cell: whose subcarriers and noise it has.
    """

    name: str = SIMULATED
    source: Rayleigh = field(default_factory=lambda: Rayleigh(snr_db=30.0))
    rms_delay_spreads_s: tuple[float, ...] = (100e-9,)
    cell: Cell = field(default_factory=Cell)

    def __post_init__(self) -> None:
        if self.source.user_correlation > 0 and len(self.rms_delay_spreads_s) > 1:
            raise InputError(
                f"users are correlated over one delay spread; got user_correlation {self.source.user_correlation:g} "
                f"and the channel {self.name!r}: name one delay spread"
            )

    @property
    def has_oracle(self) -> bool:
        return True

    def drawn(self, seed: int) -> Drawn:
        source = self.source
        (chosen,) = streams(seed, 6)[5:]  # the first five are the source's own
        spread_s = chosen.choice(np.array(self.rms_delay_spreads_s), source.num_users)
        scenes = {
            one: dataclasses.replace(source, rms_delay_spread_s=one).observe(self.cell, seed=seed)
            for one in np.unique(spread_s).tolist()
        }
        level = source.mean_gain(seed=seed)
        oracle = Oracle(
            mean_gain=level,
            rms_delay_spread_s=spread_s,
            snr=np.inf if source.snr_db is None else float(from_db(source.snr_db)),
            doppler_hz=source.doppler_hz,
            user_correlation=source.user_correlation,
        )
        return Drawn(_with_users_of(scenes, spread_s), level, oracle)

    def caption(self) -> str:
        source = self.source
        noise = "exact" if source.snr_db is None else f"{source.snr_db:g} dB SNR"
        moving = f", {source.num_slots} slots at {source.speed_km_per_h:g} km/h" if source.num_slots > 1 else ""
        alike = f", users correlated by {source.user_correlation:g}" if source.user_correlation else ""
        return f"{source.num_users} × {source.num_subcarriers}, {noise}{moving}{alike}"


def _with_users_of(scenes: Mapping[float, Scene], spread_s: FloatArray) -> Scene:
    """The scene whose user k is that of the scene with its delay spread; users of one seed are the same in all."""
    first = next(iter(scenes.values()))
    if len(scenes) == 1:
        return first

    def joint(part: Callable[[Scene], FloatArray | None]) -> FloatArray | None:
        parts = [part(scenes[one]) for one in spread_s.tolist()]
        rows = [one[..., [k], :] for k, one in enumerate(parts) if one is not None]
        return np.concatenate(rows, axis=-2) if rows else None

    gain = joint(lambda scene: scene.sensed.gain)
    assert gain is not None
    variance = joint(lambda scene: scene.sensed.noise_variance)
    sensed = dataclasses.replace(first.sensed, gain=gain, noise_variance=variance)
    return dataclasses.replace(first, sensed=sensed, truth=joint(lambda scene: scene.truth))


@dataclass(frozen=True, kw_only=True)
class FileChannel(EvaluatedChannel):
    """The drops or slots of a file.

    Attributes:
        path: the file.
        options: how to read it, as of :class:`wirelessagent.sensing.files.File`.
        num_slots: slots that a draw holds, the last one the current one.
        snr_db: of noise added to it, as a receiver would have it; none where not set.
        cell: where the file does not state its bandwidth and noise.
        rule: what is changed about the cell that results.
    """

    path: Path
    options: tuple[tuple[str, Any], ...] = ()
    num_slots: int = 1
    snr_db: float | None = None
    cell: Cell = field(default_factory=Cell)
    rule: CellRule | None = field(default=None, repr=False)

    @property
    def name(self) -> str:  # pyright: ignore[reportIncompatibleVariableOverride]
        return self.path.stem

    def drawn(self, seed: int) -> Drawn:
        scenes = _scenes(self.path, self.options, self.cell)
        choice, noise = streams(seed, 2)
        scene = _last_slots(scenes[choice.integers(len(scenes))], self.num_slots, choice, self.path)
        if self.rule is not None:
            scene = dataclasses.replace(scene, cell=self.rule(scene.cell))
        if self.snr_db is not None:
            scene = _noisy(scene, float(from_db(self.snr_db)), noise)
        truth = scene.current_truth
        assert truth is not None
        return Drawn(scene, truth.mean(axis=1), None)

    def caption(self) -> str:
        num_users, num_subcarriers = _scenes(self.path, self.options, self.cell)[0].sensed.current.shape
        slots = f", {self.num_slots} slots" if self.num_slots > 1 else ""
        noise = "as it is" if self.snr_db is None else f"{self.snr_db:g} dB SNR"
        return f"{num_users} × {num_subcarriers}, {noise}{slots}"


@functools.lru_cache(maxsize=8)
def _scenes(path: Path, options: tuple[tuple[str, Any], ...], cell: Cell) -> tuple[Scene, ...]:
    """Every drop of a file."""
    source = cast(File, plugins.create("channel_source", "file", {**dict(options), "path": path}))
    scenes = tuple(dataclasses.replace(source, drop=drop).observe(cell) for drop in range(source.num_drops()))
    if any(scene.truth is None for scene in scenes):
        raise InputError(
            f"{path}: gains are missing, so nobody can tell how wrong a repair of them is; "
            "give a complete file, or one that holds the truth as well"
        )
    return scenes


def _last_slots(scene: Scene, num_slots: int, choice: np.random.Generator, path: Path) -> Scene:
    """The slots of a draw: ``num_slots`` of them in a row, anywhere in the file."""
    sensed = scene.sensed
    if sensed.num_slots < num_slots:
        raise InputError(f"{path}: holds {sensed.num_slots} slot(s), fewer than the {num_slots} asked for")
    if sensed.gain.ndim == 2:
        return scene
    start = int(choice.integers(sensed.num_slots - num_slots + 1))
    chosen = slice(start, start + num_slots) if num_slots > 1 else start
    part: Callable[[Any], Any] = lambda values: None if values is None else values[chosen]  # noqa: E731
    times_s = sensed.slot_times_s[chosen] if num_slots > 1 and sensed.slot_times_s is not None else None
    cut = dataclasses.replace(
        sensed,
        gain=part(sensed.gain),
        noise_variance=part(sensed.noise_variance),
        estimated=part(sensed.estimated),
        slot_times_s=times_s,
    )
    return dataclasses.replace(scene, sensed=cut, truth=part(scene.truth))


def _noisy(scene: Scene, snr: float, rng: np.random.Generator) -> Scene:
    """The true gains as a receiver measures them, each user's noise relative to the mean of its row.

    Of a coefficient's phase nothing depends, as the noise is circular, so that gains are enough.
    """
    truth = scene.truth
    assert truth is not None
    level = truth.mean(axis=-1, keepdims=True)
    level = np.where(level > 0, level, 1.0)
    gain, variance = measured(np.sqrt(truth / level).astype(np.complex128), snr, rng)
    sensed = dataclasses.replace(scene.sensed, gain=gain * level, noise_variance=variance * level**2, estimated=None)
    return dataclasses.replace(scene, sensed=sensed)


def parse_channel(
    text: str,
    *,
    source: Rayleigh,
    cell: Cell,
    options: Mapping[str, Any],
    file_snr_db: float | None = None,
    rule: CellRule | None = None,
) -> EvaluatedChannel:
    """The channel that a text names: ``rayleigh:NS``, ``rayleigh:mixed``, or a file's path.

    Raises:
        InputError: a delay spread that is none.
    """
    kind, separator, value = text.partition(":")
    if kind != SIMULATED:
        given = tuple(sorted(options.items()))
        path = Path(text)
        return FileChannel(
            path=path, options=given, num_slots=source.num_slots, snr_db=file_snr_db, cell=cell, rule=rule
        )
    if separator and value == "mixed":
        spreads_ns = MIXED_NS
    else:
        try:
            spreads_ns = (float(value or "100"),)
        except ValueError as error:
            raise InputError(
                f"a simulated channel is written {SIMULATED}:NANOSECONDS or {SIMULATED}:mixed; got {text!r}"
            ) from error
    name = text if separator else f"{SIMULATED}:100"
    spreads_s = tuple(spread / 1e9 for spread in spreads_ns)
    dataclasses.replace(source, rms_delay_spread_s=max(spreads_s))  # so that its own check speaks up now
    return SimulatedChannel(name=name, source=source, rms_delay_spreads_s=spreads_s, cell=cell)
