"""Questions about the channel and the result of a request that holds, which are no reason to ask for the aim again."""

from __future__ import annotations

import dataclasses
import re

from wirelessagent.language import forms
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.intent import Intent

_NOW = r"(?:现在|目前|当前|这里|此时)?的?"
_ZH_HOW = "(?:怎么样|怎样|如何|好吗|好不好|质量|状况|状态|情况|条件|咋样)"
_CHANNEL = re.compile(
    r"(?:how(?:'s|\s+is|\s+are|\s+good\s+is|\s+good\s+are|\s+does|\s+do)|what(?:'s|\s+is)|what\s+about|is|are)\s+(?:the\s+)?"
    r"(?:(?:quality|state|condition)s?\s+of\s+the\s+)?(?:radio\s+)?(?:channels?|links?|signal)(?:\s+(?:conditions?|quality|state|"
    r"like|look|looks|looking|doing|good|bad|ok|okay|now|right|today))*|"
    r"(?:radio\s+)?channel\s+(?:conditions?|quality|state|status)|"
    rf"{_NOW}(?:无线)?(?:信道|链路)(?:的)?{_ZH_HOW}(?:的)?{_ZH_HOW}?(?:呢|啊)?"
)
_RESULT = re.compile(
    r"(?:how(?:'s|\s+is|\s+was)|what(?:'s|\s+is|\s+was))\s+(?:the\s+)?(?:result|outcome|allocation|decision)s?(?:\s+like)?|"
    r"how\s+did\s+(?:it|that)\s+(?:go|turn\s+out)|"
    rf"{_NOW}(?:结果|分配|分配结果|效果)(?:的)?{_ZH_HOW}(?:呢|啊)?"
)
_IN_FORCE = re.compile(
    r"(?:(?:show|tell)\s+(?:me\s+)?)?what(?:'s|\s+is)?\s+(?:(?:currently|now)\s+)?(?:holds?|in\s+(?:effect|force|place)|asked\s+for|"
    r"(?:the\s+)?(?:current\s+)?request)(?:\s+(?:right\s+)?now|\s+at\s+the\s+moment)?|"
    r"what\s+(?:did|do|have)\s+you\s+(?:understand|understood|get|got)(?:\s+(?:so\s+far|from\s+that))?|"
    r"(?:现在|目前|当前)的?(?:要求|请求|限制)(?:是|有)?(?:什么|哪些)(?:呢|啊)?|(?:现在|目前)(?:生效|有效)的(?:是)?(?:什么|要求)(?:要求)?|"
    r"你(?:是怎么)?理解(?:了|成)什么"
)
_THANKS = re.compile(
    r"(?:(?:ok(?:ay)?|great|good|perfect|fine|many|all\s+right)[,!.\s]+)*(?:thanks|thank\s+you|thx|cheers|ta)"
    r"(?:\s+(?:a\s+lot|very\s+much|so\s+much|again))?|(?:好的?[,，]?)?(?:谢谢|多谢|感谢|谢了)(?:你|您|啦|了)?"
)
_OF_THE_USERS = re.compile(
    r"\b(?:who|whose|which\s+(?:user|one)|what\s+(?:rate|speed)|rates?|speeds?|everyone|each\s+user)\b|"
    r"谁|哪[个些位]?(?:用户|人)?|速率|速度|多快|每个用户|各用户|用户"
)
_OF_THE_CHANNEL = re.compile(
    r"\b(?:channels?|links?|signal|gains?|fading|measured|estimate)\b|信道|链路|增益|衰落|测量|估计"
)
_OF_THE_RESULT = re.compile(
    r"\b(?:results?|outcomes?|allocations?|decisions?|plan|power|subcarriers?|served?)\b|结果|分配|方案|功率|子载波|效果"
)
_ASKING = re.compile(r"谁|哪|什么|怎么|怎样|如何|多少|几个|吗|呢")


def read_question(line: Line) -> Intent | None:
    """A question about the channel or the result as a whole, where there is one; None for any other line."""
    said = line.wish.rstrip("?？ ").strip()
    if _THANKS.fullmatch(line.shape.rstrip(".!。！~ ")):
        return line.courtesy("welcome")
    if _IN_FORCE.fullmatch(said):
        return line.command("status")
    if line.context.objective is None:
        return None
    if _CHANNEL.fullmatch(said):
        return line.question("uncertainty")
    return line.command("explain") if _RESULT.fullmatch(said) else None


def asked_instead(line: Line, understood: Intent) -> Intent | None:
    """What to answer instead of a question back about the aim, which is known; None where that is not asked."""
    if line.context.objective is None or understood.kind != "clarify":
        return None
    plain = line.shape
    asks = forms.is_asked(plain) or forms.begins_like_a_question(plain) or _ASKING.search(plain) is not None
    if understood.pending or not (asks or plain.endswith("?")):
        return _without_the_aim(line, understood)
    if _OF_THE_CHANNEL.search(plain):
        return line.question("uncertainty")
    if _OF_THE_USERS.search(plain):
        return line.question("users", **({"user": line.users[0]} if line.users else {}))
    return line.question("other") if _OF_THE_RESULT.search(plain) else _without_the_aim(line, understood)


def _without_the_aim(line: Line, understood: Intent) -> Intent | None:
    """The same question back without the aim; None where it does not ask for it."""
    voice = line.voice
    if line.users and understood.reply.endswith(voice.ending("named_user")):
        return dataclasses.replace(understood, reply=voice.say("what_of_user", users=voice.users(line.users)))
    if understood.reply == voice.say("unclear"):
        return dataclasses.replace(understood, reply=voice.say("what_changes"))
    return None
