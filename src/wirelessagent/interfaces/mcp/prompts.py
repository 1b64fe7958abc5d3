"""Prompts: ways into a conversation that a client's user can pick."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from mcp.shared.exceptions import MCPError
from mcp.types import INVALID_PARAMS, GetPromptResult, Prompt, PromptArgument, PromptMessage, TextContent


@dataclass(frozen=True)
class _Prompt:
    title: str
    description: str
    arguments: Mapping[str, str]
    text: str


_PROMPTS: Mapping[str, _Prompt] = {
    "plan_cell": _Prompt(
        "Plan a cell", "Say what a cell should do, look at what would change, and apply it after a yes",
        {"goal": "what the cell should do, in plain words"},
        "Read wirelessagent://docs/guide. Call `cells` and choose the cell with me if there are several. Then pass on "
        "my wish with `say`, word for word: “{goal}”. Show me what was decided, how sure it is and what would change. "
        "Call `apply` with the plan's id only after I have said yes to exactly that; `discard` it if I say no.",
    ),
    "explain_allocation": _Prompt(
        "Explain an allocation", "Why the allocation is as it is, and what it would take to do better",
        {"question": "what is not clear"},
        "Call `show_allocation`, then pass on my question with `say`: “{question}”. Explain in plain words with the "
        "figures of the answers only; compute none yourself, and say which are predicted and which achieved.",
    ),
    "compare_methods": _Prompt(
        "Compare methods", "The paper's methods beside the certified one, on a channel with holes",
        {"objective": "max_rate, min_power or max_energy_efficiency"},
        "Call `observe` with loss [\"random:0.2\"], then `compare` on that observation with objective {objective} and "
        "the methods dual, paper and equal_power. Put values, bounds and gaps in one table and say which method "
        "serves best and why.",
    ),
}  # fmt: skip


def listed() -> list[Prompt]:
    """The prompts."""
    return [
        Prompt(
            name=name, title=one.title, description=one.description,
            arguments=[
                PromptArgument(name=key, description=said, required=True) for key, said in one.arguments.items()
            ],
        )
        for name, one in _PROMPTS.items()
    ]  # fmt: skip


def filled(name: str, given: Mapping[str, str]) -> GetPromptResult:
    """A prompt with its arguments.

    Raises:
        MCPError: there is none, or an argument lacks.
    """
    if name not in _PROMPTS:
        raise MCPError(INVALID_PARAMS, f"there is no prompt {name[:100]!r}: known are {', '.join(_PROMPTS)}")
    prompt = _PROMPTS[name]
    missing = [key for key in prompt.arguments if not given.get(key)]
    if missing:
        raise MCPError(INVALID_PARAMS, f"the prompt {name} needs {', '.join(missing)}")
    text = prompt.text.format_map({key: given[key] for key in prompt.arguments})
    message = PromptMessage(role="user", content=TextContent(type="text", text=text))
    return GetPromptResult(description=prompt.description, messages=[message])
