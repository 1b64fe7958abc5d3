"""Questions who has what: "who gets the least?", "which subcarriers does user 3 have?", "谁最慢?".

They are questions about the users, with the details "rank" ("least" or "most") and "of" ("rate", "power" or
"subcarriers"), "listed" ("subcarriers"), or "subcarrier" (its number from 1).
"""

from __future__ import annotations

import re

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.conversation.looking import read_looked
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Intent
from wirelessagent.language.numerals import chinese_value
from wirelessagent.language.text import normalise

_LEAST = r"(?P<least>least|lowest|smallest|slowest|worst|fewest|poorest)"
_MOST = r"(?P<most>most|highest|fastest|best|largest|biggest|greatest)"
_HAS = r"(?:'s|\s+(?:is|are|gets?|got|has|have|receives?|uses?|takes?|does|being|currently|now|served|off))"
_OF = (
    r"(?:\s+(?:data|rates?|throughput|speeds?|bandwidth|power|watts|subcarriers?|served|off|users?|ones?|"
    r"of\s+all|now|bits?))*"
)
_RANKED = deferred(
    rf"(?:and\s+|so\s+|but\s+)?(?:who|which\s+(?:users?|ones?|of\s+them))(?:{_HAS})*\s+(?:the\s+)?(?:{_LEAST}|{_MOST}){_OF}|"
    r"who\s+(?:(?P<least3>suffers?|loses?\s+out|is\s+worst\s+off|comes\s+off\s+worst)|(?P<most3>benefits?|profits?|is\s+best\s+off))"
    r"(?:\s+(?:the\s+)?most)?|"
    rf"(?:what|how\s+much)\s+(?:rate\s+|power\s+)?(?:does|do)\s+the\s+(?:{_LEAST.replace('least>', 'least2>')}|"
    rf"{_MOST.replace('most>', 'most2>')})\s+(?:users?|ones?)\s+(?:get|have|receive)s?"
)
_ZH_OF = "(?:的|速率|耗|电量?|速度|功率|子载波|得到|分到|拿到?|用|占|现在|目前|所得|带宽)*"
_ZH_LEAST, _ZH_MOST = "最少|最低|最慢|最差|最小", "最多|最高|最快|最好|最大"
_ZH_RANKED = deferred(
    rf"(?:那|现在)?(?:谁|哪[个位]?(?:用户|人)?)(?:是)?{_ZH_OF}(?:(?P<least>{_ZH_LEAST})|(?P<most>{_ZH_MOST})){_ZH_OF}(?:呢|啊)?|"
    rf"{_ZH_OF}(?:(?P<least2>{_ZH_LEAST})|(?P<most2>{_ZH_MOST})){_ZH_OF}(?:用户)?(?:是)?(?:谁|哪[个位](?:用户)?)(?:呢|啊)?|"
    "(?:谁|哪个用户)(?:最)?(?:(?P<least3>吃亏|受损)|(?P<most3>受益|占便宜|得利))(?:最多|最大)?"
)
_BLOCK = r"(?:sub\s?carriers?|tones?|resource\s+blocks?|prbs?)"
_WORD = (
    r"(?:does|do|did|has|have|had|are|is|was|were|goes|go|went|belongs?|of|for|to|used|assigned|given|allocated|by|the|"
    r"@(?:'s)?|everyone|everybody|each|every|users?|gets?|got|uses?|owns?|takes?|been|now|currently|indices|numbers|serves?)"
)
_LISTED = deferred(
    rf"(?:which|what|(?:list|show|tell|give)(?:\s+me)?)(?:\s+(?:are|the|all|of|indices|numbers|exact))*\s+(?:@'?s?\s+)?{_BLOCK}(?:\s+{_WORD})+|"
    rf"(?:(?:which|what|show|list)(?:\s+(?:are|me|the))*\s+)?@'s?\s+{_BLOCK}(?:\s+(?:indices|numbers))?"
)
_ZH_WHO = "(?:@|每个用户|各用户|大家|所有用户|用户)"
_ZH_DOES = "(?:都|现在|目前|的|用了?|使用|有|占用?|分到|得到|拿到|分配到?|是|了)*"
_ZH_WHICH = "(?:哪些|哪几个|什么|哪个|几号)"
_ZH_LISTED = deferred(
    rf"(?:请|列出|显示|看看|告诉我)*{_ZH_WHO}?{_ZH_DOES}{_ZH_WHICH}(?:个)?子载波(?:编号|号)?(?:呢)?|"
    rf"(?:请|列出|显示|看看|告诉我)*(?:分?给)?{_ZH_WHO}(?:用|分到|得到|占用?)?的?子载波(?:编号)?(?:是|有)?{_ZH_WHICH}?|"
    rf"{_ZH_WHICH}子载波(?:分?给了?|分配给了?|属于|归|是){_ZH_WHO}(?:用)?的?"
)
_OWNED = deferred(
    rf"(?:who|which\s+user)\s+(?:has|gets?|got|uses?|owns?|is\s+on|takes?|holds?)\s+{_BLOCK}\s+(?:number\s+|no\.?\s*|#\s*)?(?P<place>\d+)|"
    rf"(?:who\s+is\s+)?{_BLOCK}\s+(?:number\s+|no\.?\s*|#\s*)?(?P<place2>\d+)\s+(?:goes\s+to\s+who|is\s+whose|belongs\s+to\s+who)m?|"
    r"第?(?P<zh>\d+|[一二三四五六七八九十百]+)(?:号|个)?子载波(?:分?给了?|是|分配给了?|归|属于|现在)*(?:谁|哪个用户)(?:的|用|在用)?|"
    r"(?:谁|哪个用户)(?:在)?(?:用|使用|占用?|有|分到)了?第?(?P<zh2>\d+|[一二三四五六七八九十百]+)(?:号|个)?子载波"
)

_SIZED = deferred(
    r"(?:how\s+(?:much|many|fast|high)|what)(?:\s+(?:power|watts?|rates?|speed|throughput|data|bandwidth|subcarriers?|mbit/s))?\s+"
    r"(?:does|do|did|is|will)\s+@\s*(?:now\s+|currently\s+)?(?:use|get|have|take|receive|need|getting|using|served)s?"
    r"(?:\s+(?:now|at\s+the\s+moment|with))?|"
    "@(?:现在|目前)?(?:用了?|占用?了?|得到了?|分到了?|有|拿到了?|的)+(?:多少|多大|几个|多快)?的?(?:功率|速率|速度|瓦|子载波)(?:是)?(?:多少|多大)?"
)
"""What one user has: "how many watts does user 5 use?"."""


def read_share(line: Line) -> Intent | None:
    """The question who has what that a line is as a whole; None for any other line."""
    if line.context.objective is None or line.figures:
        return None
    looked = read_looked(line)
    if looked is not None:
        return looked
    said = line.wish.rstrip("?？.。!！ ")
    owned = _OWNED.fullmatch(normalise(line.text).lower().strip().rstrip("?？.。!！ "))
    if owned is not None:
        return line.question("users", subcarrier=_number(next(group for group in owned.groups() if group)))
    if len(line.users) <= 1 and (_LISTED.fullmatch(said) or _ZH_LISTED.fullmatch(said)):
        user = {"user": line.users[0]} if line.users else {}
        return line.question("users", listed="subcarriers", **user)
    if len(line.users) == 1 and _SIZED.fullmatch(said):
        return line.question("users", user=line.users[0])
    match = _RANKED.fullmatch(said) or _ZH_RANKED.fullmatch(said)
    if match is None:
        return None
    rank = next(name for name, word in match.groupdict().items() if word).rstrip("23")
    return line.question("users", rank=rank, of=_of(said))


def _of(said: str) -> str:
    """What is ranked: the rate where nothing else is named."""
    if re.search("子载波|subcarrier", said):
        return "subcarriers"
    return "power" if re.search("power|watts|energy|功率|电", said) else "rate"


def _number(word: str) -> float:
    return float(word) if word.isdigit() else float(chinese_value(word) or 0)
