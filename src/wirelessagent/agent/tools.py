"""Which plug-ins a run of the chain uses."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, kw_only=True)
class Tools:
    """Plug-ins by name, and their options; None leaves the choice to the chain."""

    repairer: str | None = None
    repairer_options: Mapping[str, Any] = dataclasses.field(default_factory=dict[str, Any])
    method: str | None = None
    method_options: Mapping[str, Any] = dataclasses.field(default_factory=dict[str, Any])
    base_station: str | None = None
    base_station_options: Mapping[str, Any] = dataclasses.field(default_factory=dict[str, Any])
