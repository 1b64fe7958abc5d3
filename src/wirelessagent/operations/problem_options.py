"""The problem's objective and constraints as options."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Annotated, ClassVar

from pydantic import Field

from wirelessagent import plugins
from wirelessagent.model.errors import InputError
from wirelessagent.operations.fields import Advanced, OptionsOf, PerEntry, PluginName, PluginOptions
from wirelessagent.operations.operation import Request

if TYPE_CHECKING:
    from wirelessagent.model.arrays import BoolArray
    from wirelessagent.model.problem import Problem


class ProblemOptions(Request):
    """Options that describe what to optimise and under which constraints."""

    panel: ClassVar[str] = "Problem"

    objective: Annotated[str, PluginName("objective")] = Field(
        "max_rate", description="what to optimise: a registered objective or an alias such as P1"
    )
    objective_options: Annotated[PluginOptions, OptionsOf("objective")] = Field(
        default_factory=dict, description="options of the objective"
    )
    weights: Annotated[PerEntry | None, Advanced()] = Field(
        None, description="worth of each user's rate, one value or one per user"
    )
    min_rate_bps: PerEntry | None = Field(
        None, description="rate each user must get, bit/s, one value or one per user as 1e6,0,2e6"
    )
    max_rate_bps: Annotated[PerEntry | None, Advanced()] = Field(
        None, description="rate each user can use, bit/s, one value or one per user"
    )
    max_power_w: float | None = Field(
        None,
        description="radiated power budget, W; the cell's limit if not given. A larger one is the cell's "
        "limit as well, unless --cell-max-power-w is given",
    )
    subcarrier_max_power_w: Annotated[PerEntry | None, Advanced()] = Field(
        None, description="power cap per subcarrier, W"
    )
    users: list[str] | None = Field(
        None, description="names of the users to serve, as 'user 1,user 3' or one by one; all if not given"
    )
    forbidden: Annotated[list[str] | None, Advanced()] = Field(
        None,
        description="subcarriers that a user may not use, counted from 0, as 'user 2:5-9,user 3:0' or one by one",
    )
    resource_block_group_size: Annotated[int, Advanced()] = Field(
        1, description="adjacent subcarriers that are assigned together"
    )
    outage_probability: float | None = Field(
        None, description="accepted probability that a user's true rate stays below the promised one"
    )

    def problem(self, user_names: tuple[str, ...], num_subcarriers: int) -> Problem:
        """The problem for a channel with these users and so many subcarriers, with its objective looked up."""
        from wirelessagent.model.problem import Problem

        users = None if self.users is None else tuple(_split(self.users, lambda text: text in user_names))
        problem = Problem(
            plugins.objective(self.objective, self.objective_options),
            weights=self.weights,
            min_rate_bps=self.min_rate_bps,
            max_rate_bps=self.max_rate_bps,
            max_power_w=self.max_power_w,
            subcarrier_max_power_w=self.subcarrier_max_power_w,
            forbidden=None if self.forbidden is None else _forbidden(self.forbidden, user_names, num_subcarriers),
            users=users,
            resource_block_group_size=self.resource_block_group_size,
            outage_probability=self.outage_probability,
        )
        return problem.for_users(user_names)


def _split(texts: Iterable[str], is_whole: Callable[[str], bool]) -> list[str]:
    """The parts between commas, except of texts that are whole as they are: a name may hold a comma."""
    return [part.strip() for text in texts for part in ([text] if is_whole(text) else text.split(",")) if part.strip()]


def _forbidden(pairs: Iterable[str], user_names: tuple[str, ...], num_subcarriers: int) -> BoolArray:
    """The mask (user, subcarrier) of pairs such as "user 2:5-9".

    Raises:
        InputError: a text is not of this form, or names a user or a subcarrier that there is not.
    """
    import numpy as np

    from wirelessagent.model.user_names import index_of

    mask = np.zeros((len(user_names), num_subcarriers), dtype=bool)
    for text in _split(pairs, lambda text: text.rpartition(":")[0] in user_names):
        name, _, where = text.rpartition(":")
        found = re.fullmatch(r"(\d+)(?:-(\d+))?", where.strip())
        if not name or found is None:
            raise InputError(f"forbidden must be of the form 'user 2:5-9' or 'user 2:5'; got {text!r}")
        user = index_of(name, user_names, "forbidden")
        first, last = int(found[1]), int(found[2] or found[1])
        if not first <= last < num_subcarriers:
            raise InputError(
                f"forbidden: subcarriers go from 0 to {num_subcarriers - 1}, the first before the last; got {text!r}"
            )
        mask[user, first : last + 1] = True
    return mask
