"""All commands: one for each operation, and those that run a server."""

from __future__ import annotations

from collections.abc import Mapping

from wirelessagent.interfaces import serving
from wirelessagent.interfaces.mcp import stdio
from wirelessagent.operations import catalogue
from wirelessagent.operations.catalogue import FAMILIES
from wirelessagent.operations.operation import AnyOperation

__all__ = ["COMMANDS", "FAMILIES", "GROUPS", "load"]

COMMANDS: Mapping[str, str] = {**catalogue.OPERATIONS, **serving.COMMANDS, **stdio.COMMANDS}
"""What can be typed, in a sentence each."""

GROUPS: Mapping[str, tuple[str, ...]] = {**catalogue.GROUPS, "As a service": (*serving.COMMANDS, *stdio.COMMANDS)}
"""Headings for people who read the list from the top."""


def load(name: str) -> AnyOperation:
    """The operation behind a command; nothing of the others is loaded.

    Raises:
        UnknownNameError: there is none.
    """
    own = {"serve": serving.SERVE, "token": serving.TOKEN, "mcp": stdio.MCP}
    return own[name] if name in own else catalogue.load(name)
