"""What a request leaves as it holds: another aim changes no limit that it does not name, unless it starts over.

Recognisers say whether a line changes the request or replaces it. Replacing it would let a power limit go, or a rate
that was promised, because a line names an aim and any other figure: that is for the operator to say.
"""

from __future__ import annotations

import dataclasses

from wirelessagent.language.conversation.line import NAME, Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Intent

_STARTS_OVER = deferred(
    r"\b(?:new|fresh|different|another)\s+(?:request|task|job|start|intent|order)\b|\b(?:start|begin)(?:ing)?\s+(?:all\s+)?"
    r"(?:over|again|afresh|anew|from\s+(?:scratch|zero|the\s+beginning))\b|\bfrom\s+scratch\b|\bafresh\b|"
    r"\b(?:instead\s+of|forget(?:\s+about)?|replac(?:e|ing)|drop|scrap|ignore|discard)\s+(?:all|everything)\b|"
    r"\b(?:instead\s+of|forget(?:\s+about)?|replac(?:e|ing))\s+(?:the\s+(?:rest|old\s+one|last\s+one|previous\s+\w+)|what\s+"
    r"(?:i|we)\s+\w+)|\b(?:nothing|no\s+other\s+limits?|no\s+limits?)\s+(?:else|besides|apart)\b|"
    r"新的?(?:要求|请求|需求|任务|意图)|重新(?:来|开始|提)|从头(?:来|开始)|(?:忘掉|不管|忽略|作废|抛开)(?:之前|前面|刚才|以前|原来|所有|全部)|"
    r"(?:之前|前面|刚才|以前|原来)的?(?:要求|请求|限制|条件)?(?:都|全部|全)?(?:作废|不算|不要了?|取消)"
)


def keeping_what_holds(line: Line, intent: Intent) -> Intent:
    """A request as a change of the one that holds, or in its place where it starts over; other intents as they are.

    What was read by its conversation alone is what it is.
    """
    objective = line.context.objective
    if intent.kind != "allocate" or objective is None or intent.recogniser == NAME:
        return intent
    if not starts_over(line):
        return dataclasses.replace(intent, amends=True)
    aims = intent.objective != objective or "objective" in intent.evidence
    return dataclasses.replace(intent, amends=False, dropped=()) if aims else intent


def starts_over(line: Line) -> bool:
    """Whether a line says that nothing of what was asked for before should hold.

    >>> from wirelessagent.language.recogniser import Context
    >>> starts_over(Line.of("new request: least power", Context())), starts_over(Line.of("least power", Context()))
    (True, False)
    """
    return _STARTS_OVER.search(line.shape) is not None
