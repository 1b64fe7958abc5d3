"""The list from which every surface is derived."""

from __future__ import annotations

from wirelessagent.operations.ask import ASK
from wirelessagent.operations.chat import CHAT
from wirelessagent.operations.compare import COMPARE
from wirelessagent.operations.evaluate import EVALUATE_DECISION, EVALUATE_REPAIR
from wirelessagent.operations.evaluate_intents import EVALUATE_INTENTS
from wirelessagent.operations.export import EXPORT
from wirelessagent.operations.history import HISTORY, HISTORY_EXPORT, HISTORY_REPLAY, HISTORY_SHOW
from wirelessagent.operations.intent import INTENT
from wirelessagent.operations.list_plugins import PLUGINS
from wirelessagent.operations.new_plugin import NEW_PLUGIN
from wirelessagent.operations.operation import AnyOperation
from wirelessagent.operations.repair import REPAIR
from wirelessagent.operations.reproduce import REPRODUCE
from wirelessagent.operations.simulate import SIMULATE
from wirelessagent.operations.solve import SOLVE
from wirelessagent.operations.warm_up import WARM_UP

OPERATIONS: tuple[AnyOperation, ...] = (
    ASK, CHAT, INTENT, SIMULATE, REPAIR, SOLVE, COMPARE, REPRODUCE, EVALUATE_REPAIR, EVALUATE_DECISION,
    EVALUATE_INTENTS, PLUGINS, NEW_PLUGIN, HISTORY, HISTORY_SHOW, HISTORY_REPLAY, HISTORY_EXPORT, EXPORT, WARM_UP,
)  # fmt: skip

GROUPS: dict[str, str] = {
    "evaluate": "Compare methods on many draws, with confidence intervals",
    "history": "List what was asked, decided and applied; show, replay or export it",
}
"""Summaries of the first words of names that have two; where an operation has the first word alone, it is what is done
without a second."""
