"""Lines that name the method to solve with: "use the paper's method", "switch to exact", "改用论文的方法".

The request stays as it is; the method is the detail "method" of an amendment, "auto" for the objective's own choice.
A method that is named beside a request ("use greedy and at least 1 Mbit/s each") goes with it.
"""

from __future__ import annotations

import dataclasses

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Intent
from wirelessagent.language.intent_acts import OWN_CHOICE
from wirelessagent.language.named_tools import with_tool
from wirelessagent.language.text import normalise

_NOUN = r"(?:methods?|algorithms?|solvers?|approach|scheme|way)"
_VERB = (
    r"(?:use|using|try|run|take|apply|(?:switch|change|go|move)(?:\s+(?:it|back|over))*\s+(?:to|with)|stick\s+(?:to|with)|"
    r"(?:solve|do|redo|repeat|calculate|compute|decide|plan)(?:\s+(?:it|this|that|again|the\s+same))*\s+(?:with|by|using))"
)
_NAMED = rf"(?:the\s+)?(?:{_NOUN}\s+(?:of|from|in|called)\s+)?(?:the\s+)?%(?:'s)?"
_LATER = r"(?:\s+(?:instead|from\s+now\s+on|now|then|for\s+(?:this|that|it|all)|again))*"
_ZH_NOUN = "(?:的|里的|中的|里|中)?(?:那个|那种)?(?:方法|算法|求解器|办法|方案|做法|法)"
_ZH_VERB = "(?:用|使用|采用|换成|换用|换到|改用|改成|改为|切换到|切换为|切换成|切到|用回|换回|试试|试一下)"
_ZH_LATER = "(?:来?(?:做|算|解|求解|分配|计算))?(?:一下|试试|看看)?"
_SWITCHED = deferred(
    rf"(?:(?:now|then|also|just)\s+)*(?:{_VERB}\s+{_NAMED}(?:\s+{_NOUN})?|(?:do\s+(?:it|this|that)\s+)?{_NAMED}\s+{_NOUN}){_LATER}|"
    rf"(?:现在|就|也|都|再|以后|改)*{_ZH_VERB}(?:一下)?%(?:{_ZH_NOUN})?{_ZH_LATER}"
)
_SUPPOSED = deferred(
    r"(?:what\s+(?:if|about)|how\s+about|suppose|if|can|could|may)\s+(?:(?:we|i|you|it)\s+)?|"
    r"(?:如果|要是|假如|能不能|可以|可不可以|能否)(?:我们)?"
)
_SUPPOSED_END = deferred(r"(?:[,，]?\s*(?:what\s+(?:then|happens)|会?(?:怎么样|怎样|如何)|的话|呢|吗))*$")
_GIVES = deferred(
    rf"(?:what|how)\s+(?:would|does|do|could|will)\s+{_NAMED}(?:\s+{_NOUN})?\s+(?:give|do|yield|make|bring|get|find|need|take|reach|say)s?"
    rf"(?:\s+(?:us|me|of\s+(?:it|this)|here|instead|now))*|{_ZH_VERB}?%(?:{_ZH_NOUN})?(?:会|能|可以)?(?:得到|给出|做到|算出)(?:什么|多少|怎样)(?:结果)?"
)
_WHICH = deferred(
    rf"(?:which|what)\s+(?:other\s+)?{_NOUN}\s+(?:are\s+there|are\s+available|exist|(?:do|can)\s+(?:you|we|i)\s+(?:have|know|use|offer|choose)|"
    r"(?:is|are|was|were)\s+(?:being\s+)?used|can\s+(?:do|solve)\s+(?:it|this|that))|"
    "(?:现在|目前)?(?:有|能用|可以用|可用|支持|用的是|用了|在用)?的?(?:哪些|什么|哪种|哪个)(?:方法|算法)(?:可用|可以用|能用|可选)?"
)
_ADDED = deferred(
    rf"\b(?:with|by|using|via)\s+{_NAMED}\s+{_NOUN}\b|\busing\s+{_NAMED}(?!\w)|(?:用|采用|使用|按)%{_ZH_NOUN}"
)
_AND = r"(?:\s*[,;，；。]\s*(?:and|but|with)?|\s+(?:and|but|with))"
_ZH_AND = r"(?:\s*[,，；;。]\s*|并且?|且|和|同时)"
_USED = rf"(?:(?:now|then|also|just|please)\s+)*{_VERB}\s+{_NAMED}(?:\s+{_NOUN})?{_LATER}"
_ZH_USED = rf"(?:现在|就|请)*{_ZH_VERB}(?:一下)?%(?:{_ZH_NOUN})?{_ZH_LATER}"
_FIRST = deferred(rf"{_USED}{_AND}\s*(?P<rest>.+)|{_ZH_USED}{_ZH_AND}(?P<zh>.+)")
_LAST = deferred(rf"(?P<rest>.+?){_AND}\s+{_USED}|(?P<zh>.+?){_ZH_AND}{_ZH_USED}")
_COURTESY = deferred(r"(?:(?:please|thanks?(?:\s+you)?|thank\s+you|ok(?:ay)?|now|谢谢|吧)[\s,!]*)+")
_USUAL = deferred(
    rf"(?:{_VERB}\s+|back\s+to\s+)(?:the\s+|your\s+|its\s+)?(?:default|usual|normal|standard|own|original|best|automatic)(?:\s+{_NOUN})?|"
    rf"(?:恢复|{_ZH_VERB})(?:默认|原来|通常|自动|平常)的?(?:方法|算法)"
)


def read_method(line: Line) -> Intent | None:
    """The change of the method, or what another one would make of the request; None for any other line."""
    said = line.wish.rstrip("?？.。!！ ")
    if _USUAL.fullmatch(said):
        return _changed(line, OWN_CHOICE)
    if _WHICH.fullmatch(said):
        return line.question("other", listed="methods")
    shape, name = with_tool(said, "method")
    if not name:
        return None
    if _SWITCHED.fullmatch(shape):
        return _changed(line, name)
    lead, plain = _SUPPOSED.match(shape), _SUPPOSED_END.sub("", shape)
    supposed = plain[lead.end() :] if lead is not None else plain
    asked = (lead is not None or plain != shape) and _SWITCHED.fullmatch(supposed)
    if not asked and not _GIVES.fullmatch(shape):
        return None
    return line.question("other") if line.context.objective is None else line.command("compare", **{"with": name})


def beside_method(text: str) -> tuple[str, str] | None:
    """What is asked beside a method that a sentence says to use, and the method; None for any other sentence.

    >>> beside_method("use round robin and at least 1 Mbit/s for everyone")
    ('at least 1 Mbit/s for everyone', 'round_robin')
    """
    plain = " ".join(normalise(text).split()).rstrip("?？.。!！ ")
    shape, name = with_tool(plain, "method")
    match = (_FIRST.fullmatch(shape) or _LAST.fullmatch(shape)) if name else None
    if match is None:
        return None
    start, end = match.span("rest" if match["rest"] else "zh")
    rest = plain[len(plain) - (len(shape) - start) :] if start else plain[:end]
    return None if _COURTESY.fullmatch(rest.lower()) else (rest, name)


def with_method(line: Line, intent: Intent, name: str) -> Intent | None:
    """A request by a method that is named beside it; None for what is neither a request nor a question back."""
    if intent.kind == "allocate":
        return dataclasses.replace(intent, details={**intent.details, "method": name})
    if intent.kind != "clarify":
        return None
    later = line.voice.say("method_later", method_name=name)
    return dataclasses.replace(intent, reply=f"{intent.reply} {later}")


def by_method(line: Line, intent: Intent) -> Intent:
    """A request with the method that its sentence names beside it; any other intent as it is."""
    shape, name = with_tool(line.shape, "method")
    if intent.kind != "allocate" or not name or not _ADDED.search(shape):
        return intent
    return dataclasses.replace(intent, details={**intent.details, "method": name})


def _changed(line: Line, name: str) -> Intent:
    """The request that holds by another method; where none holds, a question that finds nothing to work on."""
    objective = line.context.objective
    if objective is None:
        return line.question("other")
    return line.allocate(objective, {}, amends=True, details={"method": name})
