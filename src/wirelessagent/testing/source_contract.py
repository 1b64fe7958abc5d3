"""The contract of channel sources: a scene that the seed alone determines, a truth that fits it, and facts to show."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

import numpy as np

from wirelessagent.model.cell import Cell
from wirelessagent.model.scene import Scene
from wirelessagent.sensing.source import ChannelSource
from wirelessagent.testing.contract import TOLERANCE, ValueContract, as_returned, skip

_ENOUGH_ENTRIES = 50
"""Observed entries from which the size of the measurement error can be judged."""


class ChannelSourceContract(ValueContract):
    """Inherit this and set ``source``; ``random = False`` for sources that do not draw, such as files."""

    source: ChannelSource
    random: bool = True

    def subject(self) -> ChannelSource:
        return self.source

    def test_returns_a_scene(self) -> None:
        scene: object = as_returned(self.source.observe(Cell(), seed=1))
        assert isinstance(scene, Scene), f"observe must return a Scene; got {type(scene).__name__}"

    def test_keeps_the_limits_of_the_cell(self) -> None:
        asked = Cell(max_power_w=3.0, circuit_power_w=2.0, snr_gap_db=1.0, amplifier_efficiency=0.5)
        cell = self._scene(asked).cell
        for name in ("max_power_w", "circuit_power_w", "snr_gap_db", "amplifier_efficiency"):
            assert getattr(cell, name) == getattr(asked, name), (
                f"a source may know bandwidth and noise better, but it turned {name} from {getattr(asked, name)} "
                f"into {getattr(cell, name)}"
            )

    def test_same_seed_same_scene(self) -> None:
        first = self._scene(seed=1)
        again = self._scene(seed=1)
        assert _same(first, again), "two scenes of the same seed differ: draw from np.random.default_rng(seed) only"

    def test_the_seed_matters_if_it_draws(self) -> None:
        same = _same(self._scene(seed=1), self._scene(seed=2))
        if self.random:
            assert not same, "two seeds gave the same scene: draw from default_rng(seed), or set random = False"
        else:
            assert same, "the seed changes the scene of a source that is said not to draw"

    def test_truth_fits_what_was_sensed(self) -> None:
        scene = self._scene()
        if scene.truth is None:
            skip("this source does not know the truth")
        sensed = scene.sensed
        seen = ~np.isnan(sensed.gain)
        error = (sensed.gain - scene.truth)[seen]
        variance = np.zeros(error.shape) if sensed.noise_variance is None else sensed.noise_variance[seen]
        exact = variance == 0
        assert np.all(np.abs(error[exact]) <= TOLERANCE * scene.truth[seen][exact]), (
            "sensed gains differ from the truth although no measurement noise is stated: give noise_variance"
        )
        if np.count_nonzero(~exact) >= _ENOUGH_ENTRIES:
            ratio = float(np.sqrt(np.mean(np.square(error[~exact]) / variance[~exact])))
            assert 1 / 3 < ratio < 3, f"the measurement errors are {ratio:.2g} times what noise_variance states"

    def test_facts_are_text(self) -> None:
        facts: object = as_returned(self._scene().facts)
        assert isinstance(facts, Mapping), f"facts must be a mapping; got {type(facts).__name__}"
        assert facts, "facts are empty: say what was understood or drawn, it is shown to the user"
        for label, text in cast("Mapping[object, object]", facts).items():
            assert isinstance(label, str), f"a fact is text; got {label!r}"
            assert isinstance(text, str), f"a fact is text; got {text!r} for {label!r}"

    def _scene(self, cell: Cell | None = None, *, seed: int = 1) -> Scene:
        scene: object = as_returned(self.source.observe(cell or Cell(), seed=seed))
        return scene if isinstance(scene, Scene) else skip("no scene was returned")


def _same(one: Scene, other: Scene) -> bool:
    return (
        np.array_equal(one.sensed.gain, other.sensed.gain, equal_nan=True)
        and (one.truth is None) == (other.truth is None)
        and (one.truth is None or other.truth is None or np.array_equal(one.truth, other.truth))
    )
