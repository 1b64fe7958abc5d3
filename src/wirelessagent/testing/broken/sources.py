"""Channel sources that :class:`ChannelSourceContract` must reject."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np

from wirelessagent.model.cell import Cell
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.scene import Scene
from wirelessagent.sensing.source import ChannelSource
from wirelessagent.testing.channels import rayleigh_gain


@dataclass(frozen=True, kw_only=True)
class Fading(ChannelSource):
    """Rayleigh fading, sound: the broken ones below differ from it in one thing each."""

    name = "fading"
    caught_by = ""

    def observe(self, cell: Cell, *, seed: int = 0) -> Scene:
        truth = rayleigh_gain(8, 20, seed=seed)[0]
        deviation = 0.01 * truth
        sign = np.random.default_rng(seed).choice(np.array([-1.0, 1.0]), size=truth.shape)
        sensed = ChannelObservation(gain=truth + sign * deviation, noise_variance=np.square(deviation))
        return Scene(cell=cell, sensed=sensed, truth=truth, facts={"Fading": "Rayleigh"})


class NotDecorated(Fading):
    """Its field never becomes an option, because the class is not a dataclass of its own."""

    caught_by = "test_is_a_frozen_dataclass"
    num_users: int = 8


@dataclass(frozen=True, kw_only=True)
class BadlyNamed(Fading):
    """A name that no command line can take."""

    name = "Rayleigh fading"
    caught_by = "test_has_a_name"


@dataclass(frozen=True, kw_only=True)
class WithoutSummary(Fading):
    caught_by = "test_has_a_summary"


@dataclass(frozen=True, kw_only=True)
class WithoutDefault(Fading):
    """Needs something that cannot be written on a command line."""

    caught_by = "test_can_be_made_from_its_options"
    profile: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class HoldsALambda(Fading):
    """Cannot travel to another process."""

    caught_by = "test_survives_pickling"
    path_loss: Callable[[float], float] = lambda distance: distance


@dataclass(frozen=True, kw_only=True)
class HoldsAList(Fading):
    """Cannot be a key."""

    caught_by = "test_is_a_value"
    distances: list[float] = field(default_factory=list[float])


@dataclass(frozen=True, kw_only=True)
class ReturnsAMatrix(Fading):
    """Gains without a scene around them."""

    caught_by = "test_returns_a_scene"

    def observe(self, cell: Cell, *, seed: int = 0) -> Scene:
        return rayleigh_gain(8, 20, seed=seed)[0]


@dataclass(frozen=True, kw_only=True)
class ForgetsTheCell(Fading):
    """The operator's power limit is gone."""

    caught_by = "test_keeps_the_limits_of_the_cell"

    def observe(self, cell: Cell, *, seed: int = 0) -> Scene:
        return Fading.observe(self, Cell(), seed=seed)


@dataclass(frozen=True, kw_only=True)
class DrawsAnew(Fading):
    """Fresh entropy at each call, whatever the seed."""

    caught_by = "test_same_seed_same_scene"

    def observe(self, cell: Cell, *, seed: int = 0) -> Scene:
        del seed
        return Fading.observe(self, cell, seed=int(np.random.default_rng().integers(2**31)))


@dataclass(frozen=True, kw_only=True)
class IgnoresTheSeed(Fading):
    """Says that it draws, and never does."""

    caught_by = "test_the_seed_matters_if_it_draws"

    def observe(self, cell: Cell, *, seed: int = 0) -> Scene:
        del seed
        return Fading.observe(self, cell, seed=0)


@dataclass(frozen=True, kw_only=True)
class HidesItsNoise(Fading):
    """Measurement errors that are not stated."""

    caught_by = "test_truth_fits_what_was_sensed"

    def observe(self, cell: Cell, *, seed: int = 0) -> Scene:
        scene = Fading.observe(self, cell, seed=seed)
        return dataclasses.replace(scene, sensed=dataclasses.replace(scene.sensed, noise_variance=None))


@dataclass(frozen=True, kw_only=True)
class StatesDeviationAsVariance(Fading):
    """Off by the square: the stated variance is far too large for such small gains."""

    caught_by = "test_truth_fits_what_was_sensed"

    def observe(self, cell: Cell, *, seed: int = 0) -> Scene:
        scene = Fading.observe(self, cell, seed=seed)
        deviation = np.sqrt(np.asarray(scene.sensed.noise_variance))
        return dataclasses.replace(scene, sensed=dataclasses.replace(scene.sensed, noise_variance=deviation))


@dataclass(frozen=True, kw_only=True)
class FactsAsNumbers(Fading):
    """Facts that every surface would have to format in its own way."""

    caught_by = "test_facts_are_text"

    def observe(self, cell: Cell, *, seed: int = 0) -> Scene:
        return dataclasses.replace(Fading.observe(self, cell, seed=seed), facts=cast("Any", {"Users": 8}))


BROKEN: tuple[Fading, ...] = (
    NotDecorated(),
    BadlyNamed(),
    WithoutSummary(),
    WithoutDefault(profile=(1.0,)),
    HoldsALambda(),
    HoldsAList(),
    ReturnsAMatrix(),
    ForgetsTheCell(),
    DrawsAnew(),
    IgnoresTheSeed(),
    HidesItsNoise(),
    StatesDeviationAsVariance(),
    FactsAsNumbers(),
)
