"""What a sentence does with the users whom it names: leave them out, serve them alone, or take them back.

The words stand right before or right after the name; anything in between but small words breaks the tie.
"""

from __future__ import annotations

import functools
from typing import Literal, TypeAlias

from wirelessagent.language.clauses import clause_start
from wirelessagent.language.deferred import deferred

UserRole: TypeAlias = Literal["leave_out", "users", "back", "none"]

_SMALL = (
    r"(?:\s+(?:the|out|of|to|for|off|any|our|my|with|about|from|both|now|please|all|a|al|el|la|los|las|le|les|"
    r"den|die|dem))*\s*(?:l')?"
)
_OUT_BEFORE = deferred(
    r"(?i)(?:(?<![A-Za-z])(?:leav(?:e|ing)\s+(?:out|aside|off)|drop(?:ping)?|skip(?:ping)?|exclud(?:e|es|ing)|"
    r"omit(?:ting)?|"
    r"ignor(?:e|ing)|without(?:\s+serving)?|except(?:ing)?(?:\s+for)?|but\s+not|not\s+serving|"
    r"(?:do\s+not|don't|dont|stop|no\s+longer|quit|never|not|needn't|no\s+need\s+to)\s+(?:serv(?:e|ing)|"
    r"bother(?:ing)?(?:\s+with|\s+about)?|"
    r"includ(?:e|ing)|count(?:ing)?|schedul(?:e|ing)|feed|consider(?:ing)?)|kick(?:ing)?(?:\s+out)?|remov(?:e|ing)|"
    r"disregard(?:ing)?|"
    r"forget(?:\s+about)?|cut\s+off|disconnect|no\s+(?:service|resources|subcarriers)\s+(?:for|to)|"
    r"nothing\s+(?:for|to)|"
    r"(?:everyone|everybody|all|users|anyone|them)\s+but|other\s+than|apart\s+from|minus|barring|save\s+for|"
    r"suspend|bench|sideline|"
    r"pause|park|switch\s+off|turn\s+off|shut\s+out|lock\s+out|not|"
    r"sin(?:\s+servir|\s+contar\s+con|\s+atender)?|excluye(?:ndo)?|excepto|salvo|menos|dej(?:a|ando)\s+fuera|"
    r"quita(?:ndo)?|"
    r"no\s+(?:sirvas|atiendas|incluyas)|ignora(?:ndo)?|omite|"
    r"sans(?:\s+servir|\s+compter)?|exclu(?:s|ant|ez)|sauf|excepté|hormis|hors|laisse(?:\s+de\s+côté)?|"
    r"ne\s+sers\s+pas|oublie|"
    r"retire|enlève|à\s+part|ohne|außer|bis\s+auf|ignorier(?:e|en)?|überspring(?:e|en)?|streich(?:e|en)?|"
    r"abgesehen\s+von)"
    + _SMALL
    + r"|(?:(?:不|别|不用|不要|先不|无需|不必|甭)(?:去|再)?(?:服务|带|管|考虑|包括|包含|含|算|给|理|接入|调度)|"
    r"去掉|踢掉|踢出|排除|剔除|移除|"
    r"除了|除开|除去|除|忽略|跳过|扣掉|撇开|抛开|放弃|停掉|断开|断掉|屏蔽|撤掉|拿掉|不要|别要|不用|甩开)(?:掉|了|"
    r"对)?\s*)$"
)
_PART_BEFORE = deferred(
    r"(?i)(?<![A-Za-z])(?:leav(?:e|ing)|tak(?:e|ing)|put(?:ting)?|keep(?:ing)?|cut(?:ting)?|throw(?:ing)?|lass(?:e|"
    r"en)?|"
    r"schließ(?:e|en)?|nimm|nehmen|deja|laisse)" + _SMALL + r"$|(?:把|将|让|给)\s*$"
)
_PART_AFTER = deferred(
    r"(?i)\s*(?:completely\s+|entirely\s+|both\s+)?(?:out\b|aside\b|off\b|unserved|fuera\b|de\s+côté|dehors|weg\b|"
    r"aus\b|raus\b|"
    r"außen\s+vor)|\s*(?:先|都|也|给)?(?:排除|去掉|踢|剔除|移除|拿掉|关掉|停掉|断开|忽略|摘|撤|扔)"
)
_OUT_AFTER = deferred(
    r"(?i),?\s*(?:who\s+|which\s+)?(?:is|are|be|can\s+be|may\s+be|should\s+be|stays?|remains?|goes|go|will\s+be|"
    r"must\s+be|"
    r"shall\s+be|gets?|can\s+stay)?\s*(?:left\s+|kept\s+|taken\s+|cut\s+|kicked\s+|switched\s+)?(?:out\b|excluded|"
    r"dropped|skipped|"
    r"ignored|omitted|unserved|nothing\b|no\s+(?:service|rate|subcarriers|resources)\b|"
    r"not\s+(?:to\s+be\s+)?(?:served|included|"
    r"scheduled|counted)|off\b)"
    r"|\s+(?:doesn't|does\s+not|do\s+not|don't|need\s+not|needn't|isn't|aren't|must\s+not|mustn't|shouldn't|"
    r"should\s+not|won't|"
    r"will\s+not)\s+(?:to\s+)?(?:need\s+|want\s+|require\s+|be\s+|get\s+|have\s+to\s+be\s+)*(?:to\s+be\s+|any\s+|"
    r"a\s+)?(?:served|service|"
    r"anything|included|scheduled|count|counted)\b"
    r"|\s+(?:queda|quedan|se\s+queda|está|están|reste|restent|est|bleibt|bleiben|wird|werden|soll|"
    r"sollen)\s+(?:(?:aber|doch|jedoch|bitte|heute|diesmal|vorerst|hoy|por ahora|hors|aujourd'hui|"
    r"cette fois)\s+)*(?:fuera|excluid\w+|aparte|"
    r"de\s+côté|dehors|exclu\w*|à\s+l'écart|außen\s+vor|draußen|weg|nicht\s+bedient|ausgeschlossen|weggelassen|"
    r"leer\s+ausgehen)"
    r"|\s*(?:今天|今晚|现在|先|就|都|也|暂时|这次|目前|,|\uff0c|可以|一律|那边|的话)*\s*(?:(?:不用|不需要|不要|别|"
    r"无需|不必|甭|先不|不|暂不|免)(?:再)?"
    r"(?:服务|参与|管|带|考虑|算|分配|参加|计入|给(?!超)|接入|调度|理)|排除|除外|以外|之外|外(?=[\uff0c,的])|踢|"
    r"退出|剔除|去掉|移除|停掉|断开|忽略|跳过|"
    r"拿掉|摘掉|下线|停机|掉线|欠费停机)"
)
_ONLY_BEFORE = deferred(
    r"(?i)(?:(?<![A-Za-z])(?:only|just|solely|exclusively|nobody\s+but|no\s+one\s+but|none\s+but|(?:restrict|limit|"
    r"confine)(?:ed|ing)?\s+"
    r"(?:it\s+|service\s+|this\s+|yourself\s+)?to|stick\s+to|solo|sólo|solamente|únicamente|seulement|uniquement|"
    r"seuls?|ne\s+sers\s+que|nur|"
    r"ausschließlich|lediglich)(?:\s+(?:serve|serving|to|the|for|with|on|consider|include|keep|allow|admit|"
    r"schedule|our|sirve|a|al|para|"
    r"les?|pour|sers|für|den|die|an|bediene))*\s*(?:l')?"
    r"|(?:^|[.,;:!?]\s*|\band\s+|\bplease\s+)(?:serve|serving|sirve\s+a|sers|bediene)\s+(?:the\s+)?"
    r"|(?:只|仅|光|单|只需|只要|仅仅|专门|就)(?:需|要|对)?(?:服务|带|给|管|保障|保证|考虑|算|对|为|留|让|有|保留|"
    r"要|照顾|分给|调度|接入)*\s*)$"
)
_ONLY_AFTER = deferred(
    r"(?i)\s*(?:only|alone|exclusively|and\s+(?:nobody|no\s+one)\s+else|solamente|seulement|uniquement|"
    r"allein)(?![A-Za-z])"
)
_GETS = deferred(
    r"(?i)\s*(?:gets?|needs?|must|should|has\s+to|have\s+to|at\s+least|at\s+most|>=|≥|:|min|wants?|needs|necesita|"
    r"doit|braucht|soll|至少|保底|最少|起码|不低于|"
    r"要|需要|最多|不超过|保证|的)"
)
_BACK = deferred(
    r"(?i)\s*(?:is\s+|are\s+|comes?\s+)?(?:back\b|in\s+again\b|again\b|de\s+vuelta|de\s+nuevo|wieder|zurück|"
    r"à\s+nouveau)"
    r"|\s*(?:先|再|也|都)?(?:加回|放回|恢复|回来|重新加入|拉回|请回|带回|重新服务|接回)"
)
_BACK_BEFORE = deferred(
    r"(?i)(?:(?<![A-Za-z])(?:readmit|re-admit|bring\s+back|put\s+back|take\s+back|add\s+back|restore)\s+|(?:加回|"
    r"恢复|重新服务|带回|拉回|重新带上|重新接入)(?:对)?\s*)$"
)
_SOMETHING_OF = deferred(  # "drop user 2's minimum", "don't serve user 1 more than …": not the user is meant
    r"(?i)\s*(?:['’]s\s+\w|s['’]\s+\w|(?:with\s+|at\s+|any\s+)?(?:more|faster|above|beyond|over)\b|"
    r"的?(?:最低|最高|最小|最大)?(?:速率|速度|上限|下限|限制|限速|保底|功率|权重|要求|承诺)|(?:超过|多于|高于))"
)
_REACH = 120


@functools.lru_cache(maxsize=256)
def role_of(plain: str, start: int, end: int) -> tuple[UserRole, int, int]:
    """The role of the users named at [start, end) and the span of the words that say so.

    >>> role_of("leave user 3 out, max rate", 6, 12)
    ('leave_out', 0, 16)
    """
    from_ = clause_start(plain, start, max(0, start - _REACH))
    before = plain[from_:start]
    back = _BACK.match(plain, end) or None
    if back is not None or _BACK_BEFORE.search(before):
        return "back", from_ if back is None else start, back.end() if back is not None else end
    part = _PART_BEFORE.search(before)
    behind = _PART_AFTER.match(plain, end) if part is not None else None
    if part is not None and behind is not None:
        return "leave_out", from_ + part.start(), behind.end()
    lead = _OUT_BEFORE.search(before)
    if lead is not None and is_something_of(plain, end):
        return "none", start, end
    if lead is not None:
        behind = _PART_AFTER.match(plain, end)
        return "leave_out", from_ + lead.start(), behind.end() if behind is not None else end
    after = _OUT_AFTER.match(plain, end)
    if after is not None:
        return "leave_out", start, after.end()
    return _only(plain, start, end, from_)


def is_something_of(plain: str, end: int) -> bool:
    """Whether something of the users named up to ``end`` is meant, not they: "user 2's minimum"."""
    return _SOMETHING_OF.match(plain, end) is not None


def _only(plain: str, start: int, end: int, from_: int) -> tuple[UserRole, int, int]:
    lead = _ONLY_BEFORE.search(plain[from_:start])
    if lead is not None and not _GETS.match(plain, end):
        return "users", from_ + lead.start(), end
    after = _ONLY_AFTER.match(plain, end)
    if after is not None:
        return "users", start, after.end()
    return "none", start, end
