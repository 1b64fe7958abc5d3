"""The form of a sentence, whatever it speaks of: a question, a statement, a bare yes or no, a program."""

from __future__ import annotations

from wirelessagent.language.deferred import deferred

_ASKS = deferred(
    r"(?i)\s*(?:and |so |but |hey,? |hi,? |ok,? |well,? )?(?:(?:who|which|wh?at|what|whose)(?:'?s|\s+(?:is|are|was|"
    r"were|would|will|does|do|did|can|could|has|have|had|ends?|gets?|got|"
    r"\w+\s+(?:is|are|would|does|do|did|gets?|has|have)))(?!\s+(?:i|we)\s+(?:want|need|like|mean))(?!\s+(?:i'm|"
    r"we're|matters?|counts?))\b|why (?!not|don't)(?:is|are|did|does|do|was|were|has|can't)\b|"
    r"how (?:much|many|high|fast|long|far|good|sure|big|come|is|are|did|do|does|would|was)\b|(?:is|are|was|were|"
    r"does|did|has|have)\s+\w+)"
)
_ASKS_ELSEWHERE = deferred(
    r"(?i)\s*[¿]?(?:(?:und|et|y) )?(?:wie (?:hoch|viele?|groß|schnell|gut|sicher|ist|sind|war)|wer (?:hat|ist|bekommt)|"
    r"was (?:ist|sind|kostet|war|bringt)|welche[rsn]? \w+ (?:ist|hat|bekommt)|quel(?:le)?s? (?:est|sont|était)|combien|"
    r"qu'est-ce|qui (?:a|est|reçoit)|est-ce qu|cuál(?:es)? (?:es|son|era)|cu[aá]nt[oa]s?|qué (?:es|son|tal)|"
    r"quién (?:tiene|es|recibe))\b"
)
_IMPERATIVE = deferred(r"(?i)^\s*(?:\w+,? )?have\b|\bplease\b|\bbitte\b|\bs'il (?:te|vous)\b|\bpor favor\b")
_ONLY_ASKING = deferred(
    r"(?i)\b(?:just|only|merely) (?:asking|curious|wondering|checking|a question)\b|\bwithout (?:changing|touching|"
    r"applying) (?:anything|it)\b|\b(?:don'?t|do not) (?:touch|change|apply|do) "
    r"(?:it|anything|a thing)\b(?!\s+else)|\bhypothetical(?:ly)?\b|只是问问|随便问问|先别动|别真改|不要真的改|"
    r"只是想知道"
)
_ANSWERS = {
    "confirm": deferred(
        r"(?i)\s*(?:yes|yeah|yep|yup|ok|okay|sure|of course|yes,? please|confirm(?:ed)?|agreed|do that|sí|si|vale|"
        r"oui|d'accord|ja|jawohl|jawoll|"
        r"是|是的|对|对的|好|好的|好吧|好啊|行|行吧|可以|可以的|确认|确定|同意|没错|没问题|嗯|"
        r"嗯嗯)\s*[.!。\uff01~]*\s*"
    ),
    "reject": deferred(
        r"(?i)\s*(?:no|nope|nah|no thanks|no,? thank you|not now|better not|non|nein|no,? gracias|non merci|"
        r"nein danke|"
        r"不|不要|不用|不用了|不行|不是|不对|不了|否|别|算了|不同意|先不|不必)\s*[.!。\uff01~]*\s*"
    ),
}
_COMPARES = deferred(r"(?i)\s*(?:please\s+|请)?(?:compare|vergleiche?|compara|比较|对比)(?![A-Za-z])")
_CODE = deferred(  # programs, mark-up and injections are no wishes
    r"<[|/!a-zA-Z]|\{\{|\}\}|\$\(|--\s*$|\\x|__\w+__|"
    r"(?i:\b(?:select|delete|drop|insert|update)\b.*\b(?:from|table|into|set)\b.*[;*=]|;\s*commit\b|"
    r"\bbegin\b.*\bdelet|\b(?:os|"
    r"sys)\.\w+\()|"
    r"(?i:\b(?:ignore|disregard|forget)\s+(?:all\s+|any\s+|the\s+|your\s+)*(?:previous|prior|above|earlier)\s+"
    r"(?:instructions?|rules?|prompts?))|(?:忽略|无视)[^,\uff0c]{0,6}(?:指令|规则|提示)"
)
_ASKS_IN_CHINESE = deferred(
    r"^\s*(?:我?想)?(?:请教|请问|问一下|打听)|^\s*(?:为啥|为什么|为何|凭什么|咋)(?![不别])|(?:多少|什么|怎么|"
    r"为什么|谁|哪[个些里]|几[个瓦位]|"
    r"啥)[^\uff0c。,]{0,8}[\uff1f?]\s*$"
)
_TAG = deferred(  # "…, will you?", "…, ¿vale?", "…，好吗？"
    r"(?i)(?:[\s,]+(?:will|would|could|can|won't) (?:you|ya)|,\s*(?:please|ok(?:ay)?|right|yes|vale|sí|por favor|"
    r"puedes|understood|clear|got it|klar|"
    r"verstanden|oíste|entendido|está claro|compris|d'accord|s'il (?:te|vous) pla[iî]t|ja|bitte|gut|in ordnung)|"
    r"[,\uff0c]?\s*(?:好吗|好吧|行吗|可以吗|好不好|行不行))\s*[?\uff1f]\s*$"
)


def without_a_tag(text: str) -> str:
    """A text without the polite question at its end.

    >>> without_a_tag("stay below 8 W, will you?"), without_a_tag("is 8 W enough?")
    ('stay below 8 W', 'is 8 W enough?')
    """
    tag = _TAG.search(text.replace("¿", ""))
    return text.replace("¿", "")[: tag.start()] if tag is not None else text


def is_asked(plain: str) -> bool:
    """Whether a sentence is certainly a question: it ends like one, or says that it only asks."""
    if _ONLY_ASKING.search(plain) is not None or _ASKS_IN_CHINESE.search(plain) is not None:
        return True
    return begins_like_a_question(plain) and plain.rstrip().endswith(("?", "\uff1f"))


def begins_like_a_question(plain: str) -> bool:
    """Whether a sentence begins with who, what, how much or an auxiliary verb."""
    return _ASKS.match(plain) is not None


def asks_without_a_mark(plain: str) -> bool:
    """Whether a sentence is a question by its first words, with a question mark or without.

    >>> asks_without_a_mark("what's the total rate"), asks_without_a_mark("have everyone at 1 Mbit/s")
    (True, False)
    """
    asks = begins_like_a_question(plain) or _ASKS_ELSEWHERE.match(plain) is not None
    return asks and _IMPERATIVE.search(plain) is None


def is_a_program(text: str) -> bool:
    """Whether a text is a program, a query, mark-up, or speaks to a language model rather than of a cell."""
    return _CODE.search(text) is not None


def plain_command(plain: str) -> str:
    """The command that a sentence is as a whole ("yes", "compare …"), or ""."""
    if _COMPARES.match(plain):
        return "compare"
    return next((topic for topic, words in _ANSWERS.items() if words.fullmatch(plain)), "")
