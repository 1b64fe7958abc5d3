"""Users who are back: "user 3 is here again", "3号又来了", and "he's back" for the one who was left out."""

from __future__ import annotations

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.followups import taken_in
from wirelessagent.language.intent import Intent

_ONE = (
    r"(?:he|she|they|it|(?:the|that|this)\s+(?:user|guy|man|woman|lady|customer|client|subscriber|device|phone|other|one)|"
    r"(?:the|that|this)\s+other\s+(?:user|one|guy))"
)
_IS = r"(?:'s|'re|\s+(?:is|are|has|have|just|now|already|finally|also))*"
_BACK = (
    r"\s+(?:back|returned|returns|(?:come|came|comes|coming)\s+back|(?:here|there|online|connected|present|in|on)\s+again|"
    r"reconnected|reappeared|(?:showed|shown|shows|turned|turns|popped)\s+up\s+again|re-?joined|rejoins)"
)
_NOW = r"(?:\s+(?:again|now|online|already|today|with\s+us|on\s+air|in\s+the\s+cell))*"
_ZH_ONE = "(?:[他她它]们?|那个?用户|那位用户|那个人)"
_ZH_JUST = "(?:又|已经|已|现在|刚刚?|重新|再次|也|终于)*"
_ZH_BACK = "(?:回来|来|回到小区|恢复|上线|归来|回归|在线|接入|连上|返回|出现)(?:服务)?"
_RETURNED = deferred(
    rf"(?P<said>@|{_ONE}){_IS}{_BACK}{_NOW}|(?P<zh>@|{_ZH_ONE}){_ZH_JUST}{_ZH_BACK}(?:了|啦|吧)*|"
    r"(?P<again>(?:请|把|给)*恢复(?:对|给)?@)(?:的)?(?:服务)?(?:吧|了)*|"
    r"(?P<served>(?:重新|再)(?:给|为|对)?@(?:恢复|提供)?服务)"
)


def read_return(line: Line) -> Intent | None:
    """The users whom a line says to be back served again, where a request holds; None for any other line."""
    match = _RETURNED.fullmatch(line.wish) if not line.figures else None
    if match is None:
        return None
    users, left_out = line.users, line.context.constraints.get("leave_out")
    if not users and isinstance(left_out, tuple):
        if len(left_out) > 1:
            return line.ask("who_is_back", users=line.voice.users(left_out))
        users = left_out
    if not users:
        return None
    values, dropped = taken_in(users, line.context)
    if not values and not dropped:
        return line.ask("served_already", users=line.voice.users(users))
    return line.allocate(str(line.context.objective), values, amends=True, dropped=dropped)
