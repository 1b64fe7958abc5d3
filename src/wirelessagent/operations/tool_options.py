"""Which plug-ins an operation uses, and their options."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from wirelessagent.operations.fields import OptionsOf, PluginName, PluginOptions
from wirelessagent.operations.operation import Request


class RepairerOptions(Request):
    """The repairer of what is missing."""

    panel: ClassVar[str] = "Options"

    repairer: Annotated[str | None, PluginName("repairer")] = Field(
        None, description="repairer, where something is missing; kriging if not given, with history the predictor"
    )
    repairer_options: Annotated[PluginOptions, OptionsOf("repairer")] = Field(
        default_factory=dict, description="options of the repairer"
    )


class MethodOptions(Request):
    """The method that decides."""

    panel: ClassVar[str] = "Options"

    method: Annotated[str | None, PluginName("method")] = Field(
        None, description="method; the objective's own if not given"
    )
    method_options: Annotated[PluginOptions, OptionsOf("method")] = Field(
        default_factory=dict, description="options of the method"
    )
