"""The problem's objective and constraints as options."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from wirelessagent import plugins
from wirelessagent.model.errors import InputError
from wirelessagent.model.problem import Problem
from wirelessagent.operations.fields import OptionsOf, PerEntry, PluginName, PluginOptions
from wirelessagent.operations.operation import Request


class ProblemOptions(Request):
    """Options that describe what to optimise and under which constraints."""

    panel: ClassVar[str] = "Problem"

    objective: Annotated[str, PluginName("objective")] = Field(
        "max_rate", description="what to optimise: a registered objective or an alias such as P1"
    )
    objective_options: Annotated[PluginOptions, OptionsOf("objective")] = Field(
        default_factory=dict, description="options of the objective"
    )
    weights: PerEntry | None = Field(None, description="worth of each user's rate, one value or one per user")
    min_rate_bps: PerEntry | None = Field(None, description="rate each user must get, bit/s, one value or one per user")
    max_rate_bps: PerEntry | None = Field(None, description="rate each user can use, bit/s, one value or one per user")
    max_power_w: float | None = Field(None, description="radiated power budget, W; the cell's limit if not given")
    subcarrier_max_power_w: PerEntry | None = Field(None, description="power cap per subcarrier, W")
    users: list[str] | None = Field(None, description="names of the users to serve, as 'user 3'; all if not given")
    resource_block_group_size: int = Field(1, description="adjacent subcarriers that are assigned together")
    outage_probability: float | None = Field(
        None, description="accepted probability that a user's true rate stays below the promised one"
    )

    def problem(self, user_names: tuple[str, ...]) -> Problem:
        """The problem for a channel with these users, with its objective looked up."""
        unknown = [user for user in self.users or () if user not in user_names]
        if unknown:
            raise InputError(f"no user is called {unknown[0]!r}; the channel has {', '.join(user_names)}")
        return Problem(
            plugins.objective(self.objective, self.objective_options),
            weights=self.weights,
            min_rate_bps=self.min_rate_bps,
            max_rate_bps=self.max_rate_bps,
            max_power_w=self.max_power_w,
            subcarrier_max_power_w=self.subcarrier_max_power_w,
            users=None if self.users is None else tuple(user_names.index(user) for user in self.users),
            resource_block_group_size=self.resource_block_group_size,
            outage_probability=self.outage_probability,
        )
