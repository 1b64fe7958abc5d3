"""The list from which every surface is derived; what it lists is loaded when it is asked for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from wirelessagent.model.errors import UnknownNameError

if TYPE_CHECKING:
    from wirelessagent.operations.operation import AnyOperation

OPERATIONS: Mapping[str, str] = {
    "ask": "Say what the cell should do: understand, sense, repair, decide, act, read back, explain",
    "chat": "Talk about a cell: ask, change, confirm, undo, and ask why, line by line",
    "intent": "Show what a sentence is understood to mean, without doing anything",
    "simulate": "Draw a channel, lose some of it, and write both",
    "repair": "Fill the holes of a gain matrix, with how sure each filled entry is",
    "solve": "Decide who gets which subcarrier at what power, on a gain matrix from a file",
    "compare": "Show several methods on one problem side by side: value, bound, gap, time",
    "history": "List what was asked, decided and applied; show, replay or export it",
    "history show": "Show all that is recorded of a turn, and check that it was not changed",
    "history replay": "Repair and decide again as a turn did, and say whether the decision is the same",
    "history export": "Write turns with the channels that they saw as JSON lines",
    "history seal": "Write old sessions to a file and let their channels go from the store; turns stay",
    "export": "Hand a request and what came of it on as a document of 3GPP TS 28.312 or TMF921",
    "reproduce": "Reproduce the paper's figures (picture, CSV table, JSON record) and judge its claims by them",
    "evaluate repair": "Compare repairers and their competitors: error, calibration and time, channel by channel",
    "evaluate decision": "Compare what decisions on repaired channels reach on the true one, beside perfect knowledge",
    "evaluate intents": "Measure how well sentences are understood, against a file of sentences with their meanings",
    "plugins": "List what is installed: channel sources, repairers, objectives, methods, base stations",
    "new-plugin": "Write a package for a plug-in of your own, with its contract test, to start from",
    "warm-up": "Make the machine code of all kernels now, so that nothing runs interpreted later",
}
"""What can be asked for, in a sentence each. A name of two words belongs to the family of its first."""

FAMILIES: Mapping[str, str] = {"evaluate": "Compare methods on many draws, with confidence intervals"}
"""First words that are no operation by themselves."""

GROUPS: Mapping[str, tuple[str, ...]] = {
    "In plain words": ("ask", "chat", "intent"),
    "Step by step, from file to file": ("simulate", "repair", "solve", "compare"),
    "Looking back": ("history", "export"),
    "Research": ("reproduce", "evaluate"),
    "What is installed": ("plugins", "new-plugin", "warm-up"),
}
"""Headings for people who read the list from the top."""


def load(name: str) -> AnyOperation:
    """The operation of this name; nothing of the others is loaded.

    Raises:
        UnknownNameError: there is none.
    """
    match name:
        case "ask":
            from wirelessagent.operations.ask import ASK as found
        case "chat":
            from wirelessagent.operations.chat import CHAT as found
        case "intent":
            from wirelessagent.operations.intent import INTENT as found
        case "simulate":
            from wirelessagent.operations.simulate import SIMULATE as found
        case "repair":
            from wirelessagent.operations.repair import REPAIR as found
        case "solve":
            from wirelessagent.operations.solve import SOLVE as found
        case "compare":
            from wirelessagent.operations.compare import COMPARE as found
        case "history":
            from wirelessagent.operations.history import HISTORY as found
        case "history show":
            from wirelessagent.operations.history import HISTORY_SHOW as found
        case "history replay":
            from wirelessagent.operations.history import HISTORY_REPLAY as found
        case "history export":
            from wirelessagent.operations.history import HISTORY_EXPORT as found
        case "history seal":
            from wirelessagent.operations.history_seal import HISTORY_SEAL as found
        case "export":
            from wirelessagent.operations.export import EXPORT as found
        case "reproduce":
            from wirelessagent.operations.reproduce import REPRODUCE as found
        case "evaluate repair":
            from wirelessagent.operations.evaluate import EVALUATE_REPAIR as found
        case "evaluate decision":
            from wirelessagent.operations.evaluate import EVALUATE_DECISION as found
        case "evaluate intents":
            from wirelessagent.operations.evaluate_intents import EVALUATE_INTENTS as found
        case "plugins":
            from wirelessagent.operations.list_plugins import PLUGINS as found
        case "new-plugin":
            from wirelessagent.operations.new_plugin import NEW_PLUGIN as found
        case "warm-up":
            from wirelessagent.operations.warm_up import WARM_UP as found
        case _:
            raise UnknownNameError("command", name, OPERATIONS)
    return found
