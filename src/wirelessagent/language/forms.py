"""The form of a sentence, whatever it speaks of: a question, a statement, a bare yes or no, a program."""

from __future__ import annotations

from wirelessagent.language.deferred import deferred
from wirelessagent.language.word_tables import either


def _any(name: str) -> str:
    """What a sentence of any language may be said with, by a list of ``[sentences]`` in ``talk_forms``."""
    return either("talk_forms", "sentences", name)


_ASKS = deferred(
    r"(?i)\s*(?:and |so |but |hey,? |hi,? |ok,? |well,? )?(?:(?:who|which|wh?at|what|whose)(?:'?s|\s+(?:is|are|was|"
    r"were|would|will|does|do|did|can|could|has|have|had|ends?|gets?|got|"
    r"\w+\s+(?:is|are|would|does|do|did|gets?|has|have)))(?!\s+(?:i|we)\s+(?:want|need|like|mean))(?!\s+(?:i'm|"
    r"we're|matters?|counts?))\b|why (?!not|don't)(?:is|are|did|does|do|was|were|has|can't)\b|"
    r"how (?:much|many|high|fast|long|far|good|sure|big|come|is|are|did|do|does|would|was)\b|(?:is|are|was|were|"
    r"does|did|has|have)\s+\w+)"
)
_ASKS_ELSEWHERE = deferred(rf"(?i)\s*[¿]?(?:(?:und|et|y) )?(?:{_any('asks')})")
_IMPERATIVE = deferred(r"(?i)^\s*(?:\w+,? )?have\b|\bplease\b|\bbitte\b|\bs'il (?:te|vous)\b|\bpor favor\b")
_KEEPING = deferred(
    rf"(?i)^\s*(?:and|now|but|then|plus|ok,?\s+now|what\s+about|how\s+about)\b|{either('figures', 'kept', 'limits')}"
)
_ONLY_ASKING = deferred(f"(?i){_any('only_asks')}")
_ANSWERS = {topic: deferred(rf"(?i)\s*(?:{_any(topic)})\s*[.!。\uff01~]*\s*") for topic in ("confirm", "reject")}
_COMPARES = deferred(r"(?i)\s*(?:please\s+|请)?(?:compare|vergleiche?|compara|比较|对比)(?![A-Za-z])")
_CODE = deferred(  # programs, mark-up and injections are no wishes
    r"<[|/!a-zA-Z]|\{\{|\}\}|\$\(|--\s*$|\\x|__\w+__|"
    r"(?i:\b(?:select|delete|drop|insert|update)\b.*\b(?:from|table|into|set)\b.*[;*=]|;\s*commit\b|"
    r"\bdrop\s+table\b|\bbegin\b.*\bdelet|\b(?:os|"
    r"sys)\.\w+\()|"
    r"(?i:\b(?:ignore|disregard|forget)\s+(?:all\s+|any\s+|the\s+|your\s+)*(?:previous|prior|above|earlier)\s+"
    r"(?:instructions?|rules?|prompts?))|(?:忽略|无视)[^,\uff0c]{0,6}(?:指令|规则|提示)"
)
_TAG = deferred(  # "…, will you?", "…, ¿vale?", "…，好吗？"
    rf"(?i)(?:[\s,]+(?:will|would|could|can|won't) (?:you|ya)|,\s*(?:{_any('tags')})|"
    rf"[,\uff0c]?\s*(?:{_any('particles')}))\s*[?\uff1f]\s*$"
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
    if _ONLY_ASKING.search(plain) is not None:
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


def keeps_the_limits(plain: str) -> bool:
    """Whether a sentence with a wish changes the request at hand rather than replacing it."""
    return _KEEPING.search(plain) is not None


def is_a_program(text: str) -> bool:
    """Whether a text is a program, a query, mark-up, or speaks to a language model rather than of a cell."""
    return _CODE.search(text) is not None


def plain_command(plain: str) -> str:
    """The command that a sentence is as a whole ("yes", "compare …"), or ""."""
    if _COMPARES.match(plain):
        return "compare"
    return next((topic for topic, words in _ANSWERS.items() if words.fullmatch(plain)), "")
