"""Users who are spoken of as exceptions: kept although a word of leaving out is near, or excepted from a rate.

"Don't kick user 3 out" leaves nobody out. "Everyone except user 3 gets 500 kbit/s" promises user 3 nothing, but does
not say whether user 3 is served.
"""

from __future__ import annotations

import re
from typing import Literal, TypeAlias

from wirelessagent.language.text import CLAUSE_END

Standing: TypeAlias = Literal["kept", "excepted", "leaves", ""]

_SMALL = r"(?:\s+(?:the|our|my|out|any|of|to|please|ever|a|al|la|el|los|le|les|l'|den|die))*\s*(?:l')?"
_OUT = (
    r"(?:kick|drop|leav|exclud|remov|cut|skip|forget|ignor|throw|disconnect|omit|bench|los|neglect|abandon|"
    r"quit|exclu|dej|elimin|olvid|retir|enlev|laiss|oubli|coup)\w*(?:\s+(?:out|off|aside|fuera|de\s+côté))?"
)
_KEPT_BEFORE = re.compile(
    rf"(?i)(?:\b(?:don'?t|do\s+not|never|mustn'?t|must\s+not|shouldn'?t|should\s+not|without|no|ne|n'|not)\s*"
    rf"(?:please\s+|yet\s+|you\s+dare\s+)?{_OUT}{_SMALL}|(?:别|不要|不许|不准|不能|不得|勿|甭|不用|不必)再?(?:把|将|让)?\s*|"
    rf"(?:别|不要|不许|不准|不能|不得|勿)再?(?:不服务|不管|不带|漏掉|漏|排除|踢掉|去掉|忽略|忘了|忘记|丢下|落下|丢掉))$"
)
_ZH_OUT_AFTER = re.compile(
    r"\s*(?:给|都|也)?(?:踢|排除|去掉|剔除|移除|拿掉|停掉|断开|丢下|落下|漏掉|漏了|忘了|删|撤|摘|甩|扔|除名|不服务)"
)
_BARE_NOT = re.compile(r"(?:别|不要|不许|不准|不能|不得|勿|甭|不用|不必)再?(?:把|将|让)?\s*$")
_KEPT_AFTER = re.compile(
    r"(?i)\s*(?:(?:is|are|be|bleibt|bleiben)\s+)?(?:not|never|nicht|niemals)\s+(?:to\s+be\s+|be\s+)?"
    r"(?:kick|drop|left|exclud|remov|cut|skip|forgotten|ignor|raus|weg|aus|rauswerf|vergess|weglass)|"
    r"\s*(?:stays?|remains?|keeps?)\s+in\b|\s*(?:不用|不要|别|不能|不许|不必)(?:踢|排除|去掉|剔除|移除|拿掉|停掉|断开)"
)
_EXCEPT_BEFORE = re.compile(
    r"(?i)(?:\b(?:except(?:ing)?(?:\s+for)?|but(?!\s+(?:only|also))|apart\s+from|aside\s+from|other\s+than|save(?:\s+for)?|"
    r"excluding|besides|excepto|salvo|menos|aparte\s+de|sauf|hormis|excepté|à\s+part|außer|ausser|bis\s+auf|"
    rf"mit\s+ausnahme\s+von){_SMALL}|除了?|除去|除开)$"
)
_EXCEPT_AFTER = re.compile(
    r"\s*(?:以外|之外|除外|外(?=[\uff0c,的每都其]))|(?i:\s+(?:aside|excepted|exempt(?:ed)?|ausgenommen))\b"
)
_LEAVES_BEFORE = re.compile(r"(?:让|叫|请)\s*$")
_LEAVES_AFTER = re.compile(r"\s*(?:离开|走吧|走开|走人|退场|下去|先走|出去)")
_CUT = re.compile(CLAUSE_END)


def exception_of(plain: str, start: int, end: int) -> Standing:
    """What the words around the users named at [start, end) of a normalised text make of them.

    >>> exception_of("don't kick user 3 out", 11, 17), exception_of("everyone except user 3 gets", 16, 22)
    ('kept', 'excepted')
    """
    cuts = [cut.end() for cut in _CUT.finditer(plain, 0, start)]
    before = plain[cuts[-1] if cuts else 0 : start]
    if _BARE_NOT.search(before):
        return "kept" if _ZH_OUT_AFTER.match(plain, end) else ""
    if _KEPT_BEFORE.search(before) or _KEPT_AFTER.match(plain, end):
        return "kept"
    if _LEAVES_BEFORE.search(before) and _LEAVES_AFTER.match(plain, end):
        return "leaves"
    if _EXCEPT_BEFORE.search(before) or _EXCEPT_AFTER.match(plain, end):
        return "excepted"
    return ""
