"""What a sentence does with the users whom it names: leave them out, serve them alone, take them back, or except them.

The words of a role stand right before or right after the name; anything in between but small words breaks the tie.
"Don't kick user 3 out" leaves nobody out. "Everyone except user 3 gets 500 kbit/s" promises user 3 nothing, who is
served nevertheless; so is whoever is "exempt from the floor".
"""

from __future__ import annotations

import functools
import re
from typing import Literal, TypeAlias

from wirelessagent.language.clauses import clause_end, clause_start
from wirelessagent.language.deferred import deferred

Standing: TypeAlias = Literal["kept", "excepted", "exempt", "uncapped", "alone", "leaves", ""]

_SMALL = (
    r"(?:\s+(?:the|our|my|out|any|of|to|please|ever|for|a|al|de|del|la|el|los|las|para|le|les|des|pour|chez|l'|den|die|"
    r"für|in\s+the\s+case\s+of))*\s*(?:l')?"
)
_OUT = (
    r"(?:kick|drop|leav|exclud|remov|cut|skip|forget|ignor|throw|disconnect|omit|bench|los|neglect|abandon|"
    r"quit|exclu|dej|elimin|olvid|retir|enlev|laiss|oubli|coup)\w*(?:\s+(?:out|off|aside|fuera|de\s+côté))?"
)
_KEPT_BEFORE = deferred(
    rf"(?i)(?:\b(?:don'?t|do\s+not|never|mustn'?t|must\s+not|shouldn'?t|should\s+not|without|no|ne|n'|not)\s*"
    rf"(?:please\s+|yet\s+|you\s+dare\s+)?{_OUT}{_SMALL}|"
    rf"(?:别|不要|不许|不准|不能|不得|勿)再?(?:不服务|不管|不带|漏掉|漏|排除|踢掉|去掉|忽略|忘了|忘记|丢下|落下|丢掉))$"
)
_ZH_OUT_AFTER = deferred(
    r"\s*(?:给|都|也)?(?:踢|排除|去掉|剔除|移除|拿掉|停掉|断开|丢下|落下|漏掉|漏了|忘了|删|撤|摘|甩|扔|除名|不服务|"
    r"弄(?:下线|没|掉)|出去|下线|砍|赶)"
)
_BARE_NOT = deferred(r"(?:别|不要|不许|不准|不能|不得|勿|甭|不用|不必)再?(?:把|将|让)?\s*$")
_KEPT_AFTER = deferred(
    r"(?i)\s*(?:(?:is|are|be|bleibt|bleiben)\s+)?(?:not|never|nicht|niemals)\s+(?:to\s+be\s+|be\s+)?"
    r"(?:kick|drop|left|exclud|remov|cut|skip|forgotten|ignor|raus|weg|aus|rauswerf|vergess|weglass)|"
    r"\s*(?:不用|不要|别|不能|不许|不必)(?:踢|排除|去掉|剔除|移除|拿掉|停掉|断开)"
)
_EXCEPT_BEFORE = deferred(
    r"(?i)(?:\b(?:except(?:ing)?(?:\s+for)?|but(?!\s+(?:only|also))|apart\s+from|aside\s+from|other\s+than|save(?:\s+for)?|"
    r"excluding|barring|bar|besides|not\s+counting|(?:but|just|only)\s+not(?:\s+for)?|with\s+the\s+exception\s+of|"
    rf"excepto|salvo|menos|aparte\s+de|(?:a|con)\s+(?:la\s+)?excepción|"
    rf"sauf|hormis|excepté|à\s+part|(?:à\s+l')?exception(?:\s+faite)?|außer|ausser|bis\s+auf|"
    rf"mit\s+ausnahme\s+von){_SMALL}|除了?|除去|除开|不(?:包?括|包?含|算))$"
)
_EXCEPT_AFTER = deferred(
    r"\s*(?:以外|之外|除外|例外|不在此列|外(?=[\uff0c,的每都其]))|(?i:\s+(?:aside|excepted|ausgenommen|"
    r"(?:is\s+|as\s+|being\s+)?the\s+(?:one\s+|only\s+|sole\s+)?exception))\b"
)
# Nothing is promised to somebody: a negation and a promise in a clause without a figure.
_PROMISE = (
    r"(?:\b(?:floors?|minim(?:um|a)|minimums|min|guarant\w+|promis\w+|assured?|m[ií]nimo|garant\w+|prom[ei][st]\w*|"
    r"asegur\w+|plancher|mindest\w+|garantie\w*|zusagen?|zugesagt|verspr[eo]ch\w*|anspruch|untergrenze)\b|"
    r"承诺|保证|保障|保底|最低速率|下限|速率(?:指标|要求)|答应)"
)
_NO = (
    r"(?:\b(?:no|not|cannot|never|nothing|without|none|sin|nada|ningun\w*|pas|sans|rien|aucune?|nichts?|kein\w*|ohne)\b|"
    r"n't\b|[不没无免])"
)
_NO_PROMISE = deferred(
    rf"(?i){_NO}[^0-9]{{0,25}}?{_PROMISE}|"
    rf"{_PROMISE}[^0-9]{{0,12}}(?:\b(?:(?:do|does|is|are)(?:n't|\s+not)|n[o']|nicht)\b|不|取消|免)|"
    r"\b(?:exempt\w*|excused?|off\s+the\s+hook|exent\w+|eximid\w+|exime|dispensad\w+|dispensée?s?|exemptée?s?|befreit|"
    r"verzichtet)\b|豁免|不(?:用|必|需要|给|对|为)?保(?![留持护])|[免无]保|不[做作]要求|不设最低|[都就可]免[了掉]?\s*$"
)
_CAP = (
    r"(?:cap|caps|capped|ceiling|limit(?:ed|s)?|maximum|max|l[ií]mites?|limitad\w+|tope|plafonds?|plafonné\w*|limité\w*|"
    r"obergrenze|begrenzt|gedeckelt|grenze)"
)
_NO_CAP = deferred(  # "the cap doesn't apply to user 3", "3号不限速"
    rf"(?i)@[^0-9]{{0,30}}?(?:{_NO}[^0-9]{{0,20}}?\b{_CAP}\b|\b(?:unlimited|uncapped|unbegrenzt)\b|\b(?:illimité|ilimitad)\w*)|"
    rf"(?:{_NO}\s+(?:\w+\s+)?{_CAP}|\b{_CAP}\b[^0-9@]{{0,12}}(?:n't|\bnot|\bno|\bnicht)\b)[^0-9@]{{0,15}}@|"
    r"@\s*[^0-9]{0,4}?(?:不|无|没有?|别)[受设做]?(?:这个|此|该)?(?:限(?!制功率)|封顶|上限)|"
    r"(?:上限|限速|封顶)[^0-9@]{0,6}@[^0-9]{0,4}?(?:不|除外|例外)|(?:不限|不封)@"
)
# In one clause with somebody, "@": that they stay in, or that nobody else is served.
_OUT_LATER = (
    r"(?:(?:left|kept|taken|cut|kicked|thrown|switched|dropped|shut|locked)\s+(?:out|off)|(?:kick|throw|shut|cut|leav|count)\w*"
    r"\s+(?:@\s+)?(?:out|off)|dropp?(?:ed|ing|s)?|exclud\w+|remov\w+|disconnect\w*|skipp?\w*|ignor\w+|omit\w*|forgott?\w*|"
    r"ech(?:es|ar|en|e)|expuls\w+|saqu?\w+|quit\w+|exclu\w+|vir(?:ez|er|e)|débranch\w+|coup(?:er|ez|e)|abandonn\w+|"
    r"(?:dej\w+|laiss\w+)\s+(?:@\s+)?(?:fuera|de\s+côté)|abgeklemmt|ausgesperrt|unter\s+den\s+tisch|rausgeworfen|"
    r"weggelassen|vergessen|ausgeschlossen)"
)
_NEVER = (
    r"(?:\b(?:not|never|nobody|no\s+one|cannot|no\s+reason|rather\s+than|instead\s+of|why\s+(?:would|should)|tampoco|nadie|"
    r"no(?=\s+(?:me\s+|nos\s+|se\s+|lo\s+)?(?:ech|expuls|saqu|quit|dej|exclu))|n[e']|pas|personne|nicht|niemand\w*)\b|n't\b)"
)
_ON = r"(?:(?!\b(?:only|nur|and|but|y|et|und|sondern|sino|mais)\b)[^0-9])"  # one thing goes on being said
_ZH_OUT = r"(?:踢|赶|扔|丢|落下|漏|砍|断开|断掉|停|剔除|移除|排除|去掉|弄(?:下线|没|掉)|舍弃|放弃|出去|下线|除名|忘)"
_STAYS = deferred(
    rf"(?i){_NEVER}{_ON}{{0,40}}?\b{_OUT_LATER}\b{_ON}{{0,12}}@|"
    rf"@{_ON}{{0,20}}?{_NEVER}{_ON}{{0,20}}?\b{_OUT_LATER}\b|{_NEVER}{_ON}{{0,25}}@{_ON}{{0,15}}?\b{_OUT_LATER}\b|"
    rf"{_NEVER}{_ON}{{0,25}}?\b(?:kick|throw|shut|cut|leav|count|tak|put|lock)\w*\s+@\s*(?:out|off)\b|"
    r"@\s*(?:(?:must|should|shall|will|may|can|is|are|also|definitely)\s+)*(?:stay(?:s|ing)?|remains?|keeps?\s+(?:being\s+served|going)|"
    r"bleibt\s+(?:drin|dabei)|sigue[n]?\s+dentro|drinlassen)\b(?!\s+(?:out|off|below|under|at|above|unserved|away|home)\b)|"
    rf"(?:别|不要|不许|不准|不能|不得|勿|不可以?|谁也别|不必)[^0-9,\uff0c]{{0,8}}(?:@[^0-9]{{0,6}}{_ZH_OUT}|{_ZH_OUT}(?:了|掉|出)?\s*@)|"
    rf"不{_ZH_OUT}(?:了|掉)?\s*@|@\s*[^0-9]{{0,4}}?(?:别|不许|不准|不能|不要|不可以?|勿|不)(?:再|给我|给)?{_ZH_OUT}|"
    r"\bkeep(?:ing)?\s+@\s+(?:in|on|served|connected|included|online|aboard|on\s+board)\s*$|"
    r"(?<![只仅光就])(?:留着|留下|带上)\s*@\s*$|"
    r"@\s*(?:也|还|都|必须|一定|要|得|先|继续)*(?:留(?!空)|保留|正常服务|照常服务|照旧服务)"
)
_NOBODY_ELSE = deferred(
    r"(?i)(?:\b(?:no\s*body|no\s+one|none)\b[^0-9@]{0,25}@|@[^0-9]{0,30}?\b(?:nobody|no\s+one|nothing\s+else|niemand|nadie|personne)\b"
    r"[^0-9]{0,12}?(?:serv\w*|bedient|atiend\w+|atender|else|$)|"
    r"@(?:[^0-9]{0,10})(?:谁|其他|其它|其余|别|全|的人|人|都|一律)[^0-9]{0,8}?(?:不用?|别|不要)(?:再)?(?:服务|管|发|带|给|理))"
)
_LEAVES_BEFORE = deferred(r"(?:让|叫|请)\s*$")
_LEAVES_AFTER = deferred(r"\s*(?:离开|走吧|走开|走人|退场|下去|先走|出去)")
_REACH = 100
_MERE_BUT = deferred(r"(?i)but\b(?!\s+not)")
_ALL = deferred(r"(?i)\b(?:all|every\w*|each|any\w*|no\w*|per|the\s+(?:lot|rest|others))\b")

UserRole: TypeAlias = Literal["leave_out", "users", "back", "none"]
_SMALL_AHEAD = (
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
    + _SMALL_AHEAD
    + r"|(?:(?:不|别|不用|不要|先不|无需|不必|甭)(?:去|再)?(?:服务|带|管|考虑|包括|包含|含|算|给|理|接入|调度)|"
    r"去掉|踢掉|踢出|排除|剔除|移除|"
    r"除了|除开|除去|除|忽略|跳过|扣掉|撇开|抛开|放弃|停掉|断开|断掉|屏蔽|撤掉|拿掉|不要|别要|不用|甩开)(?:掉|了|"
    r"对)?\s*)$"
)
_PART_BEFORE = deferred(
    r"(?i)(?<![A-Za-z])(?:leav(?:e|ing)|tak(?:e|ing)|put(?:ting)?|keep(?:ing)?|cut(?:ting)?|throw(?:ing)?|lass(?:e|"
    r"en)?|"
    r"schließ(?:e|en)?|nimm|nehmen|deja|laisse)" + _SMALL_AHEAD + r"$|(?:把|将|让|给)\s*$"
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
_ROLE_REACH = 120


def exception_of(plain: str, start: int, end: int) -> Standing:
    """What the words around the users named at [start, end) of a normalised text make of them.

    >>> exception_of("don't kick user 3 out", 11, 17), exception_of("everyone except user 3 gets", 16, 22)
    ('kept', 'excepted')
    >>> exception_of("user 3 needs no minimum", 0, 6)
    'exempt'
    """
    before = _lead(plain, start)
    if _BARE_NOT.search(before):
        return "kept" if _ZH_OUT_AFTER.match(plain, end) else ""
    if _KEPT_BEFORE.search(before) or _KEPT_AFTER.match(plain, end):
        return "kept"
    if _LEAVES_BEFORE.search(before) and _LEAVES_AFTER.match(plain, end):
        return "leaves"
    clause = f"{before}@{_rest(plain, end)}"
    if _STAYS.search(clause):
        return "kept"
    if _NO_CAP.search(clause):
        return "uncapped"
    if promised_nothing(plain, start, end):
        return "exempt"
    excepting = _EXCEPT_BEFORE.search(before)
    if excepting is not None and _MERE_BUT.match(before, excepting.start()) and not _ALL.search(before):
        return ""  # "max throughput, but user 4 never above 5 Mbit/s"
    if excepting is not None or _EXCEPT_AFTER.match(plain, end):
        return "alone" if _serves_nobody_else(before, plain, end) else "excepted"
    return ""


def promised_nothing(plain: str, start: int, end: int) -> tuple[int, int] | None:
    """The words by which nothing is promised to the users named at [start, end); None where there are none.

    >>> promised_nothing("user 3 needs no minimum", 0, 6)
    (13, 23)
    """
    before, after = _lead(plain, start), _rest(plain, end)
    before = re.split("[0-9]", before)[-1]  # what stands before a figure is that figure's
    match = _NO_PROMISE.search(f"{before} @ {after}")
    if match is None or any(letter.isdigit() for letter in after):
        return None
    ahead, behind = start - len(before), end - len(before) - 3
    return (
        match.start() + (ahead if match.start() < len(before) else behind),
        min(match.end(), len(before)) + ahead if match.end() <= len(before) + 3 else match.end() + behind,
    )


def _lead(plain: str, start: int) -> str:
    """What a clause says before ``start``, no farther than its words may reach."""
    return plain[clause_start(plain, start, max(0, start - _REACH)) : start]


def _rest(plain: str, end: int) -> str:
    """The rest of the clause after ``end``, no farther than its words may reach."""
    return plain[end : clause_end(plain, end, min(len(plain), end + _REACH))]


def _serves_nobody_else(before: str, plain: str, end: int) -> bool:
    """Whether nobody but those excepted is served: "nobody except user 3", "除了3号，其他人都不服务"."""
    rest = _rest(plain, end)
    following = _rest(plain, end + len(rest) + 1)
    return (
        _NOBODY_ELSE.search(f"{before}@{rest}") is not None or _NOBODY_ELSE.search(f"@{rest},{following}") is not None
    )


@functools.lru_cache(maxsize=256)
def role_of(plain: str, start: int, end: int) -> tuple[UserRole, int, int]:
    """The role of the users named at [start, end) and the span of the words that say so.

    >>> role_of("leave user 3 out, max rate", 6, 12)
    ('leave_out', 0, 16)
    """
    from_ = clause_start(plain, start, max(0, start - _ROLE_REACH))
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
