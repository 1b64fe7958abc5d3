"""A tool that an LLM may call: a name, a typed form, and a function that reads and changes nothing.

Tools are handed in from the operations above; an LLM can call these and nothing else.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel


@dataclass(frozen=True, kw_only=True)
class LlmTool:
    """One tool.

    Attributes:
        name: letters, digits and underscores.
        summary: what it does, for the LLM.
        form: the type of its arguments.
        run: from a filled-in form to text; a ``WirelessAgentError`` is told to the LLM.
    """

    name: str
    summary: str
    form: type[BaseModel]
    run: Callable[[Any], str]
