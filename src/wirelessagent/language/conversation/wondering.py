"""Questions whether something can be done, which are what-ifs: "能不能只用一半功率?", "can we leave user 8 out?"

"Could you …?" is politeness, and left as it is.
"""

from __future__ import annotations

import dataclasses
import re

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.intent import Detail, Intent

_POLITE = re.compile(r"(?i)\bplease\b|\byou\b|请|麻烦|帮")
_BEGINS = re.compile(
    r"(?i)\s*(?:(?:and|but|so|hm+|well|ok(?:ay)?)[,\s]+)*(?:"
    r"(?:can|could|may|might)\s+(?:we|i|it|they|the\s+cell)\s+(?:also\s+|still\s+|even\s+|just\s+|maybe\s+)*|"
    r"(?:can|could)\s+(?=user|everyone|everybody|all\b|each)|"
    r"(?:is|would)\s+it\s+(?:be\s+)?(?:possible|feasible|okay|ok|all\s+right|doable|work)\s+(?:to|that|if)\s+(?:we\s+|i\s+)?|"
    r"(?:那么?|那我们|我们)*(?:能不能|可不可以|能否|可否|是否可以|是否能|是不是可以|行不行)(?:就|也|把)?)"
    r"(?P<rest>.+?)\s*[?？。.吗呢]*\s*"
)
_ENDS = re.compile(
    r"(?i)\s*(?:(?:is|are|would)\s+(?P<rest>.+?)\s+(?:be\s+)?(?:possible|feasible|doable|achievable|realistic)\s*\?*|"
    r"(?:可以|能)(?P<polar>.+?)吗[?？]*|"
    r"(?P<said>.+?)[,，]?(?:可行吗|可以吗|行吗|行不行|可能吗|能行吗|做得到吗|可不可以|能不能做到|好不好)[?？]*)\s*"
)
_FIGURES = ("constraints", "rate_bps", "missing_share")


def wondered(text: str) -> str | None:
    """What a line asks to be possible, without the words that ask; None for any other line.

    >>> wondered("can we leave user 8 out?"), wondered("could you leave user 8 out?")
    ('leave user 8 out', None)
    """
    if _POLITE.search(text):
        return None
    match = _BEGINS.fullmatch(text) or _ENDS.fullmatch(text)
    if match is None:
        return None
    return next((said for said in match.groupdict().values() if said), None)


def supposed(line: Line, intent: Intent) -> Intent:
    """A what-if of what an intent would ask for; an intent that asks for nothing as it is."""
    if intent.kind != "allocate":
        return intent
    details: dict[str, Detail] = {key: value for key, value in intent.details.items() if key.startswith("share_")}
    if intent.constraints:
        details["constraints"] = intent.constraints
    if intent.objective != line.context.objective:
        details["objective"] = str(intent.objective)
    if intent.dropped:
        details["dropped"] = " ".join(intent.dropped)
    said = line.question("what_if", **details)
    return dataclasses.replace(said, recogniser=intent.recogniser)


def is_worked_out(intent: Intent) -> bool:
    """Whether a question names the figures that it is about, so that it is solved for them."""
    return intent.kind == "question" and any(intent.details.get(name) for name in _FIGURES)
