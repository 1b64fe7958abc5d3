"""Questions about the channel and the result of a request that holds, which are no reason to ask for the aim again."""

from __future__ import annotations

import dataclasses

from wirelessagent.language import forms
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Intent

_NOW = r"(?:现在|目前|当前|这里|此时)?的?"
_ZH_HOW = "(?:怎么样|怎样|如何|好吗|好不好|质量|状况|状态|情况|条件|咋样)"
_CHANNEL = deferred(
    r"(?:how(?:'s|\s+is|\s+are|\s+good\s+is|\s+good\s+are|\s+does|\s+do)|what(?:'s|\s+is)|what\s+about|is|are)\s+(?:the\s+)?"
    r"(?:(?:quality|state|condition)s?\s+of\s+the\s+)?(?:radio\s+)?(?:channels?|links?|signal)(?:\s+(?:conditions?|quality|state|"
    r"like|look|looks|looking|doing|good|bad|ok|okay|now|right|today))*|"
    r"(?:radio\s+)?channel\s+(?:conditions?|quality|state|status)|"
    rf"{_NOW}(?:无线)?(?:信道|链路)(?:的)?{_ZH_HOW}(?:的)?{_ZH_HOW}?(?:呢|啊)?"
)
_RESULT = deferred(
    r"(?:how(?:'s|\s+is|\s+was)|what(?:'s|\s+is|\s+was))\s+(?:the\s+)?(?:result|outcome|allocation|decision)s?(?:\s+like)?|"
    r"how\s+did\s+(?:it|that)\s+(?:go|turn\s+out)|"
    rf"{_NOW}(?:结果|分配|分配结果|效果)(?:的)?{_ZH_HOW}(?:呢|啊)?"
)
_IN_FORCE = deferred(
    r"(?:(?:show|tell)\s+(?:me\s+)?)?what(?:'s|\s+is)?\s+(?:(?:currently|now)\s+)?(?:holds?|in\s+(?:effect|force|place)|asked\s+for|"
    r"(?:the\s+)?(?:current\s+)?request)(?:\s+(?:right\s+)?now|\s+at\s+the\s+moment)?|"
    r"what\s+(?:did|do|have)\s+you\s+(?:understand|understood|get|got)(?:\s+(?:so\s+far|from\s+that))?|"
    r"(?:现在|目前|当前)的?(?:要求|请求|限制)(?:是|有)?(?:什么|哪些)(?:呢|啊)?|(?:现在|目前)(?:生效|有效)的(?:是)?(?:什么|要求)(?:要求)?|"
    r"你(?:是怎么)?理解(?:了|成)什么|"
    r"(?:what|which)\s+(?:limits?|constraints?|requirements?|restrictions?|rules)\s+(?:currently\s+|now\s+)?"
    r"(?:hold|apply|stand|are\s+(?:there|set|on|active|in\s+(?:effect|force|place)))(?:\s+(?:right\s+)?now)?|"
    r"what\s+are\s+(?:the|my|our)\s+(?:current\s+|present\s+)?(?:limits?|constraints?|requirements?|restrictions?)(?:\s+(?:right\s+)?now)?|"
    r"what\s+(?:did|have)\s+(?:i|we)\s+(?:(?:just|last|actually)\s+)?(?:ask(?:ed)?(?:\s+(?:you\s+)?for)?|request(?:ed)?|said|say|order(?:ed)?)"
    r"(?:\s+(?:so\s+far|last|before|again|until\s+now))?|what\s+(?:was|is)\s+my\s+(?:last\s+|current\s+)?request|"
    r"我(?:刚才|刚刚|之前|前面|现在|都|到底|一共)*(?:要求|请求|说|提|设)(?:了|过|的)*(?:是)?(?:什么|哪些)(?:要求|限制)?(?:来着|呢|啊)?|"
    r"(?:现在|目前|当前)?(?:都)?有(?:什么|哪些)(?:限制|要求|约束)(?:呢|啊)?"
)
_HOW_SURE = deferred(
    r"how\s+(?:sure|certain|reliable|confident|trustworthy)\s+(?:is|are|was|were)\s+(?:this|that|it|they|these|you|we|"
    r"(?:the\s+)?(?:results?|figures?|numbers?|rates?|promises?|plan|decision|allocation|estimate))(?:\s+(?:of|about)\s+(?:it|this|that|them))?|"
    r"(?:这个|这|该|结果|方案|分配|速率|承诺)*(?:有)?多(?:大的?)?(?:可靠|确定|把握|准确?)(?:性)?|(?:这个|结果|方案|分配|承诺)+(?:可靠|靠谱|准确?)吗"
)
_FOR_THE_OTHERS = deferred(
    r"(?:and\s+|but\s+)?(?:is|are|was|would|will)\s+(?:it|that|this|they)(?:\s+be)?\s+(?:really\s+|still\s+)?(?:ok(?:ay)?|fine|fair|good|bad|"
    r"all\s+right|alright|enough|acceptable|a\s+problem)\s+(?:for|to|with)\s+(?:the\s+(?:others?|rest|other\s+users|users)|everyone(?:\s+else)?|"
    r"everybody(?:\s+else)?|all(?:\s+(?:of\s+)?them)?)|(?:and\s+|but\s+)?(?:how\s+(?:are|is)|what\s+about|what\s+(?:do|does))\s+the\s+"
    r"(?:others|rest|other\s+users)(?:\s+(?:doing|get|now))?|(?:does|did)\s+(?:any(?:one|body)|someone)\s+(?:suffer|lose\s+out|get\s+(?:nothing|"
    r"left\s+out|cut\s+off|hurt))|(?:这样|这|那)?对?(?:其他|其余|别的|剩下的?)(?:人|用户|的)*(?:来说)?(?:可以|行|好|公平|没问题|受得了|够|怎么样|"
    r"如何|呢|有影响)+(?:吗|么|呢)?"
)
_WAS_BETTER = deferred(
    r"(?:and\s+|so\s+)?(?:was|is|has)\s+(?:it|that|this)(?:\s+now)?\s+(?:(?:any|really|actually|got(?:ten)?|become)\s+)*(?:better|worse|an?\s+"
    r"improvement)(?:\s+(?:now|than\s+(?:before|it\s+was)))?|did\s+(?:it|that|this)\s+(?:help|improve(?:\s+anything)?|get\s+(?:better|worse)|"
    r"make\s+(?:it|things|anything)\s+(?:better|worse))|(?:这样|现在|刚才那个?|这)?(?:比(?:之前|刚才|原来|以前|上次)的?)?(?:更好|好一?些|好一?点|变好|变差|"
    r"更差|有改善|有提高)了?(?:吗|么)"
)
_WASTING = deferred(
    r"(?:and\s+)?(?:are\s+we|is\s+(?:it|the\s+cell|this)|do\s+we|does\s+(?:it|the\s+cell))\s+(?:just\s+)?wast(?:e|ing)\s+(?:any\s+|much\s+|too\s+"
    r"much\s+)?(?:energy|power|watts|electricity)|(?:is|are)\s+(?:any\s+)?(?:energy|power)\s+(?:being\s+)?wasted|could\s+we\s+do\s+with\s+less\s+"
    r"power|(?:我们|现在)?(?:是不是|有没有|是否)?(?:在)?浪费(?:了)?(?:电|功率|能量|能源|电力)(?:了)?(?:吗|么)?"
)
_WHOM_TO_LEAVE_OUT = deferred(
    r"(?:who|whom|which\s+(?:users?|one)|what\s+user)\s+(?:should|could|would|can|must|shall)\s+(?:i|we|you)\s+(?:best\s+|better\s+)?(?:leave\s+out|drop|"
    r"give\s+up|sacrifice|cut(?:\s+off)?|remove|exclude)|who\s+(?:should|could|is\s+best)\s+(?:be\s+)?(?:left\s+out|dropped|cut\s+off|sacrificed)|"
    r"(?:我们?)?(?:应该|该|最好|可以|要)?(?:放弃|舍弃|不服务|去掉|不管|牺牲)(?:谁|哪个(?:用户)?|哪些(?:用户)?)(?:比较|最)?好?"
)
_TURN_SAID = deferred(
    r"what\s+(?:did|does)\s+turn\s+(?P<did>\d{1,6})\s+(?:say|do|ask(?:\s+for)?|change|decide|mean)|"
    r"what\s+(?:was|is|happened\s+in|about)\s+turn\s+(?P<was>\d{1,6})(?:\s+about)?|第(?P<zh>\d{1,6})轮(?:说|做|要求|问|改)(?:的是|了)?(?:什么|啥)"
)
_TO_WHAT_IS_MISSING = deferred(
    r"\b(?:lose|losing|lost|cost(?:ing)?\s+(?:us|me)|price|worth|suffer|gain|penalty)\b.*\b(?:missing|incomplete|unmeasured|unknown|imperfect|lost)\s+"
    r"(?:csi|measurements?|gains?|channels?|data|entries|information|knowledge)\b|"
    r"(?:缺失|不完整|没测到|没有测得|不完美)的?(?:信道|数据|增益|测量|CSI|csi|信息)*.*(?:损失|代价|影响|亏|少)(?:了|掉)?(?:多少|多大)|"
    r"(?:因为|由于).*(?:缺失|缺少|不完整).*(?:损失|少)(?:了|掉)?(?:多少|多大)"
)
_GIVEN = deferred(
    r"\b(?:delay\s+spread|doppler|noise|bandwidth|carrier|frequency|path\s?loss|fading|antennas?|snr|interference|distance|"
    r"subcarrier\s+spacing|number\s+of\s+subcarriers)\b|时延扩展|多普勒|噪声|带宽|载波频率|路径损耗|路损|衰落|天线|信噪比|干扰|距离"
)
_THANKS = deferred(
    r"(?:(?:ok(?:ay)?|great|good|perfect|fine|many|all\s+right)[,!.\s]+)*(?:thanks|thank\s+you|thx|cheers|ta)"
    r"(?:\s+(?:a\s+lot|very\s+much|so\s+much|again))?|(?:好的?[,，]?)?(?:谢谢|多谢|感谢|谢了)(?:你|您|啦|了)?"
)
_OF_THE_USERS = deferred(
    r"\b(?:who|whose|which\s+(?:user|one)|what\s+(?:rate|speed)|rates?|speeds?|everyone|each\s+user)\b|"
    r"谁|哪[个些位]?(?:用户|人)?|速率|速度|多快|每个用户|各用户|用户"
)
_OF_THE_CHANNEL = deferred(
    r"\b(?:channels?|links?|signal|gains?|fading|measured|estimate)\b|信道|链路|增益|衰落|测量|估计"
)
_OF_THE_RESULT = deferred(
    r"\b(?:results?|outcomes?|allocations?|decisions?|plan|power|subcarriers?|served?)\b|结果|分配|方案|功率|子载波|效果"
)
_ASKING = deferred(r"谁|哪|什么|怎么|怎样|如何|多少|几个|吗|呢")


def read_question(line: Line) -> Intent | None:
    """A question about the channel or the result as a whole, where there is one; None for any other line."""
    said = line.wish.rstrip("?？ ").strip()
    if _THANKS.fullmatch(line.shape.rstrip(".!。！~ ")):
        return line.courtesy("welcome")
    if _IN_FORCE.fullmatch(said):
        return line.command("status")
    match = _TURN_SAID.fullmatch(said)
    if match is not None:
        return line.command("history", turn=float(next(group for group in match.groups() if group)))
    if line.context.objective is None:
        return None
    if _CHANNEL.fullmatch(said) or _HOW_SURE.fullmatch(said):
        return line.question("uncertainty")
    return _judged(line, said)


def _judged(line: Line, said: str) -> Intent | None:
    """Questions what is good or bad about the result, each answered by the figures that tell it."""
    if _FOR_THE_OTHERS.fullmatch(said):
        return line.question("users", rank="least", of="rate")
    if _WAS_BETTER.fullmatch(said):
        return line.command("compare", **{"with": "last"})
    if _WASTING.fullmatch(said):
        return line.question("what_if", asked="power")
    if _WHOM_TO_LEAVE_OUT.fullmatch(said):
        return line.question("users", listed="dearest")
    if not line.figures and _TO_WHAT_IS_MISSING.search(said):
        return line.question("what_if", missing_share=0.0)
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


def given_instead(line: Line, intent: Intent) -> Intent:
    """A what-if of the channel, which is as it was sensed; any other intent as it is."""
    wonders = intent.kind == "question" and intent.topic == "what_if"
    if not wonders or intent.details or not _GIVEN.search(line.shape):
        return intent
    return line.question("what_if", of="channel")


def _without_the_aim(line: Line, understood: Intent) -> Intent | None:
    """The same question back without the aim; None where it does not ask for it."""
    voice = line.voice
    if line.users and understood.asks == "named_user":
        reply = voice.say("what_of_user", users=voice.users(line.users))
        return dataclasses.replace(understood, reply=reply, asks="what_of_user")
    if understood.asks == "unclear":
        return dataclasses.replace(understood, reply=voice.say("what_changes"), asks="what_changes")
    return None
