"""The chain's stages: what is checked before they run."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

import wirelessagent as wa
from wirelessagent import chain, plugins
from wirelessagent.model.errors import UnsupportedProblemError
from wirelessagent.plugins import Plugin


@dataclass(frozen=True, kw_only=True)
class Needy(wa.Method):
    """A method with an option that has no default, and that honours minimum rates."""

    name = "needy"
    constraints = frozenset({"min_rate_bps"})

    depth: int

    def solve(self, estimate: wa.ChannelEstimate, problem: wa.Problem, cell: wa.Cell) -> wa.Decision:
        raise AssertionError("nothing is solved here")


def test_a_refusal_names_a_method_that_needs_options(monkeypatch: pytest.MonkeyPatch) -> None:
    needy = Plugin(kind="method", name="needy", package="some-package", target="some:Needy", cls=Needy)
    installed = [*plugins.plugins("method"), needy]
    monkeypatch.setattr(plugins, "plugins", lambda kind: installed)
    with pytest.raises(UnsupportedProblemError, match=r"does not honour min_rate_bps.*\(.*needy\)"):
        chain.check_solvable(wa.Problem("max_rate", min_rate_bps=1e6))


def test_a_problem_that_its_method_solves_passes() -> None:
    chain.check_solvable(wa.Problem("max_rate", max_power_w=3))
    chain.check_solvable(wa.Problem("min_power", min_rate_bps=1e6), "paper_inversion")
