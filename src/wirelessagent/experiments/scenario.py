"""The world of an experiment: a cell, a simulated channel and what gets lost of it."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from typing import Literal

from wirelessagent import chain
from wirelessagent.experiments.draws import Seeds
from wirelessagent.model.cell import Cell
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.scene import Scene
from wirelessagent.model.units import human
from wirelessagent.sensing import loss
from wirelessagent.sensing.rayleigh import Rayleigh

AT_FACE_VALUE = ("nncf_paper", "user_mean")
"""The paper's own ways to repair, which know no variance."""


@dataclass(frozen=True, kw_only=True)
class Scenario:
    """The paper's set-up (section IV.A): Rayleigh fading with path loss, entries lost at random.

    Attributes:
        cell: the cell; by default the paper's.
        channel: the simulated channel; by default of the paper's size, with the delay spread that it leaves open.
        loss_rate: probability that an entry is missing.
    """

    cell: Cell = field(default_factory=Cell)
    channel: Rayleigh = field(default_factory=Rayleigh)
    loss_rate: float = 0.2

    def sense(self, seeds: Seeds) -> tuple[Scene, ChannelObservation]:
        """The cell of a draw, with its true channel, and what is observed of it."""
        scene = self.channel.observe(self.cell, seed=seeds.channel)
        return scene, scene.observe(loss.random(self.loss_rate), seed=seeds.loss)

    def caption(self, draws: int, *, varied: Literal["", "loss", "delay spread", "correlation"] = "") -> str:
        """What a figure of so many draws rests on, in a line, but for what varies within the figure."""
        alike = not self.channel.shadowing_std_db and self.channel.inner_radius_m == self.channel.outer_radius_m
        facts = {
            "size": f"K × N = {self.channel.num_users} × {self.channel.num_subcarriers}",
            "loss": f"{100 * self.loss_rate:g} % random loss",
            "delay spread": f"{human(self.channel.rms_delay_spread_s, 's')} RMS delay spread",
            "users": "the same path loss for all users" if alike else "",
            "draws": "1 draw" if draws == 1 else f"{draws} draws",
        }
        return ", ".join(text for fact, text in facts.items() if text and fact != varied)

    def with_loss(self, loss_rate: float) -> Scenario:
        return dataclasses.replace(self, loss_rate=loss_rate)

    def with_delay_spread(self, rms_delay_spread_s: float) -> Scenario:
        return dataclasses.replace(
            self, channel=dataclasses.replace(self.channel, rms_delay_spread_s=rms_delay_spread_s)
        )


def known(observation: ChannelObservation, repairer: str) -> ChannelEstimate:
    """What is decided on: the estimate, or of the paper's own repairs the gains as if they were certain."""
    estimate = chain.repair(observation, repairer)
    return chain.certain(estimate.gain, estimate.user_names) if repairer in AT_FACE_VALUE else estimate
