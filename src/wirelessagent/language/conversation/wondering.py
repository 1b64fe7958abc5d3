"""Questions whether something can be done, which are what-ifs: "能不能只用一半功率?", "can we leave user 8 out?"

So is all that is only supposed or weighed: "what if …", "should we …?", "要不要…". "Could you …?" is politeness, and
left as it is.
"""

from __future__ import annotations

import dataclasses

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Detail, Intent
from wirelessagent.language.text import normalise

_POLITE = deferred(r"(?i)\bplease\b|\byou\b|请|麻烦|帮")
_BEGINS = deferred(
    r"(?i)\s*(?:(?:and|but|so|hm+|well|ok(?:ay)?)[,\s]+)*(?:"
    r"(?:can|could|may|might)\s+(?:we|i|it|they|the\s+cell)\s+(?:also\s+|still\s+|even\s+|just\s+|maybe\s+)*|"
    r"(?:can|could)\s+(?=user|everyone|everybody|all\b|each)|"
    r"(?:is|would)\s+it\s+(?:be\s+)?(?:possible|feasible|okay|ok|all\s+right|doable|work)\s+(?:to|that|if)\s+(?:we\s+|i\s+)?|"
    r"(?:那么?|那我们|我们)*(?:能不能|可不可以|能否|可否|是否可以|是否能|是不是可以|行不行)(?:就|也|把)?)"
    r"(?P<rest>.+?)\s*[?？。.吗呢]*\s*"
)
_ENDS = deferred(
    r"(?i)\s*(?:(?:is|are|would)\s+(?P<rest>.+?)\s+(?:be\s+)?(?:possible|feasible|doable|achievable|realistic)\s*\?*|"
    r"(?:可以|能)(?P<polar>.+?)吗[?？]*|"
    r"(?P<then>.+?)的话[,，]?(?:又|会|将|结果|情况)*(?:是|变成?)?(?:什么样子?|怎么?样|如何|什么情况|啥样)?[?？]*|"
    r"(?P<said>.+?)[,，]?(?:可行吗|可以吗|行吗|行不行|可能吗|能行吗|做得到吗|可不可以|能不能做到|好不好)[?？]*)\s*"
)
_LEAD = r"(?:(?:and|but|so|ok(?:ay)?|well|hm+|now|then|just|hey)[,\s]+)*"
_SUPPOSES = deferred(
    rf"{_LEAD}(?:what\s+(?:if|happens|would|could|might)\b|(?:what|how)\s+about\b|(?:let's\s+|let\s+us\s+)?(?:suppose|supposing|imagine|assume|"
    r"assuming|pretend)\b|(?:let's\s+|let\s+us\s+)say\b|say\s+(?:we|i|they)\b|hypothetically|(?:i\s+|i'm\s+|just\s+)+wonder|"
    r"(?:should|shall|ought|must|do|are|would|could|might|may)\s+(?:we|i|it|they)\b(?=.*\?\s*$)|"
    r"(?:is|would|will|wouldn't|isn't|might)\s+(?!you\b).*\b(?:better|wiser|smarter|worth\w*|sensible|make\s+sense|help|good\s+idea)\b|"
    r"how\s+(?:much|many|few|little|fast|high|low)\b|how\s+would\b|"
    r"(?:if|when)\s+(?:we|i|they|it|the\s+cell|every\w+|all|@)\s+(?:\w+\s+)?(?:had|used|were|went|gave|got|did|let|took|ran|chose|"
    r"could|\w+ed)\b|if\s+(?:we|i|they|it|the\s+cell|every\w+|all|@)\b.*\b(?:instead|what|how)\b)|"
    r".*(?<!matter )(?<!of )(?<!care )\bhow\s+(?:much|many)\b.*\?\s*$|.*[,;:\s](?:what\s+if|what\s+would)\b"
)
_ZH_SUPPOSES = deferred(
    "[那么但是可嗯，, ]*(?:(?:如果|要是|若是?|倘若)(?!可以|可能|行|能|方便|没问题|允许|有)|"
    "假如|假设|假若|假定|万一|设想|试想|想象)|"
    ".*(?:要不要|该不该|应不应该|应该不应该|需不需要|有没有必要|有必要.*吗|是不是(?:应该|该|要|最好)|是否(?:应该?|该|需要|要|值得)|值不值得|"
    "划不划算|(?:应该|该)[^，,]*吗|会怎么?样|会如何|会发生什么|会不会|的话(?:呢|会|[?？])|(?:呢|又?怎么样)[?？]?$)|"
    "(?!.*多少.*多少).*(?:需要|要|得|用|花|耗|费|够|有|是|能|给|省|到)多少(?!都|也|就|算)"
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


def only_supposed(line: Line, intent: Intent) -> Intent:
    """A what-if of what a line supposes, weighs or asks about, where it was read as a request; else the intent."""
    if intent.kind != "allocate" or not supposes(line.text):
        return intent
    said = supposed(line, intent)
    weighed = said.details or {"objective": str(intent.objective)}
    return dataclasses.replace(said, details=weighed)


def supposes(text: str) -> bool:
    """Whether a line only supposes or weighs something, and asks for nothing.

    >>> supposes("what if we used 5 W"), supposes("if possible, 1 Mbit/s each"), supposes("要不要省点电？")
    (True, False, True)
    """
    plain = normalise(text).strip().lower()
    return _SUPPOSES.match(plain) is not None or _ZH_SUPPOSES.match(plain) is not None
