"""The form of a sentence, whatever it speaks of: a question, a polite request, a bare yes or no, a program."""

from __future__ import annotations

import re

_ASKS = re.compile(
    r"(?i)\s*(?:and |so |but |hey,? |hi,? |ok,? |well,? )?(?:(?:who|which|wh?at|what|whose)(?:'?s|\s+(?:is|are|was|"
    r"were|would|will|does|do|did|can|could|has|have|had|ends?|gets?|got|"
    r"\w+\s+(?:is|are|would|does|do|did|gets?|has|have)))(?!\s+(?:i|we)\s+(?:want|need|like|mean))(?!\s+(?:i'm|"
    r"we're|matters?|counts?))\b|why (?!not|don't)(?:is|are|did|does|do|was|were|has|can't)\b|"
    r"how (?:much|many|high|fast|long|far|good|sure|big|come|is|are|did|do|does|would|was)\b|(?:is|are|was|were|"
    r"does|did|has|have)\s+\w+)"
)
_FORM = re.compile(
    r"(?i)[?\uff1f¿]|[吗么呢]|什么|怎么|怎样|如何|为何|为啥|多少|多大|多高|多快|哪|谁|几|啥|够不够|行不行|是否|"
    r"有没有|会不会|能不能|"
    r"\b(?:what|why|how|who|which|whose|when|where|whether|if|suppose|imagine|explain|tell me|show|list|wonder|"
    r"curious|qué|cuál|cuánt[oa]s?|cómo|por qué|quién|"
    r"pourquoi|combien|quel(?:le)?s?|comment|que|qui|est-ce|warum|wieso|wie|was|wer|welche[rsn]?|reichen|"
    r"genügen)\b|'s\b"
)
_STRONG_FORM = re.compile(r"[?\uff1f]\s*$|吗|呢|什么|为何|为啥|有啥|啥区别|多少|谁|几[瓦个位]|够不够|行不行")
_POLITE = re.compile(  # "could you make it faster?", which asks for it
    r"(?i)\s*(?:please,?\s+|hi,?\s+|hello,?\s+)?(?:(?:can|could|would|will)\s+(?:you|we)\s+|why\s+(?:not|"
    r"don't\s+(?:we|you))\s+|(?:how|what)\s+about\s+)(?!tell|explain|say|"
    r"describe|show|reach|handle|guarantee that)"
)
_ONLY_ASKING = re.compile(
    r"(?i)\b(?:just|only|merely) (?:asking|curious|wondering|checking|a question)\b|\bwithout (?:changing|touching|"
    r"applying) (?:anything|it)\b|\b(?:don'?t|do not) (?:touch|change|apply|do) "
    r"(?:it|anything|a thing)\b(?!\s+else)|\bhypothetical(?:ly)?\b|只是问问|随便问问|先别动|别真改|不要真的改|"
    r"只是想知道"
)
_ANSWERS = {
    "confirm": re.compile(
        r"(?i)\s*(?:yes|yeah|yep|yup|ok|okay|sure|of course|yes,? please|confirm(?:ed)?|agreed|do that|sí|si|vale|"
        r"oui|d'accord|ja|jawohl|jawoll|"
        r"是|是的|对|对的|好|好的|好吧|好啊|行|行吧|可以|可以的|确认|确定|同意|没错|没问题|嗯|"
        r"嗯嗯)\s*[.!。\uff01~]*\s*"
    ),
    "reject": re.compile(
        r"(?i)\s*(?:no|nope|nah|no thanks|no,? thank you|not now|better not|non|nein|no,? gracias|non merci|"
        r"nein danke|"
        r"不|不要|不用|不用了|不行|不是|不对|不了|否|别|算了|不同意|先不|不必)\s*[.!。\uff01~]*\s*"
    ),
}
_COMPARES = re.compile(r"(?i)\s*(?:please\s+|请)?(?:compare|vergleiche?|compara|比较|对比)(?![A-Za-z])")
_CODE = re.compile(  # programs and mark-up are no wishes
    r"<[|/!a-zA-Z]|\{\{|\}\}|\$\(|--\s*$|\\x|__\w+__|"
    r"(?i:\b(?:select|delete|drop|insert|update)\b.*\b(?:from|table|into|set)\b.*[;*=]|;\s*commit\b|"
    r"\bbegin\b.*\bdelet|\b(?:os|"
    r"sys)\.\w+\()"
)
_ASKS_IN_CHINESE = re.compile(
    r"^\s*(?:我?想)?(?:请教|请问|问一下|打听)|^\s*(?:为啥|为什么|为何|凭什么|咋)(?![不别])|(?:多少|什么|怎么|"
    r"为什么|谁|哪[个些里]|几[个瓦位]|"
    r"啥)[^\uff0c。,]{0,8}[\uff1f?]\s*$"
)
_REFUSES = re.compile(  # "n'optimise pas le débit", "no maximices …", "ich will keinen …"
    r"(?i)\bn(?:e\s+|')(?:(?:me|nous)\s+)?(?:optimis|maximis|minimis|cherch|vis|privilégi|augment|rédui|économis|veu|"
    r"voul|pouss)\w*\s+(?:surtout\s+)?(?:pas|plus|jamais)\b|"
    r"\bno\s+(?:me\s+)?(?:optimi[cz]|maximi[cz]|minimi[cz]|bus[cq]|prior|aument|redu[czj]|ahorr|quier|quer|sub|"
    r"baj)\w*|"
    r"\b(?:optimier|maximier|minimier|erhöh|senk|spar)\w*\s+(?:\w+\s+){0,4}nicht\b|\bwill\s+(?:\w+\s+){0,2}kein"
)
_INSTEAD = re.compile(
    r"(?i)\b(?:mais|plutôt|seulement|uniquement|au contraire|sino|pero|mejor|solo|sólo|sondern|aber|lieber|nur|"
    r"stattdessen|más que|que de)\b|[,.;:]\s*\w+\s+\w+\s+\w+"
)
_OF_THE_TRADE = re.compile(
    r"(?i)poten[ct]|puissan|leistung|watt|vatio|veloc|vites|rapid|lent|schnell|langsam|tempo|flott|flink|tasa|caudal|"
    r"débit|durchsatz|rate|rendi|capaci|kapazit|datos|donnée|daten|bit|mega|giga|ancho|bande|usuari|usager|utilis|"
    r"abon|nutzer|teilnehm|kund|client|equi|équi|just|gerecht|fair|gleich|igual|égal|parej|repart|répart|verteil|"
    r"energ|énerg|electr|électr|corriente|courant|strom|luz|spar|ahorr|économ|consum|consom|verbrauch|bater|"
    r"batter|akku|"
    r"\bred(?:es)?\b|réseau|netz|celda|célula|cellul|zelle|funk|send|émett|émis|emit|emis|radi|rayon|strahl|transm|"
    r"antena|antenn|señal|signal|internet|wifi|wlan|móvil|mobil|handy|teléfon|téléph|telefon|optimi|maxim|minim|"
    r"mejor|meilleur|mieux|besser|ajust|réglag|einstell|änder|cambi|chang|peor|pire|schwäch|débil|faible|effiz|efici|"
    r"effic|video|vidéo|stream|descarg|téléch|download|upload|subida|bajada|plan|result|résult|ergeb|ferm|grün|"
    r"vert|verd|"
    r"eco|öko|todo|tous|tout|alle|jede|cada|chacun|nadie|personne|niemand|leis|voll|plein|tope|mach|mehr|más|"
    r"plus|menos|"
    r"moins|wenig"
)
_STATED = re.compile(
    r"(?i)\s*(?:the|our|this|that|your)\s+[\w -]{2,30}?\s+(?:is|are|looks?|seems?|was|feels?)\s+(?:good|fine|ok|"
    r"okay|nice|"
    r"all right|alright|great|perfect|normal|acceptable)\b"
)


def is_asked(plain: str) -> bool:
    """Whether a sentence is certainly a question: it ends like one, or says that it only asks."""
    if _ONLY_ASKING.search(plain) is not None or _ASKS_IN_CHINESE.search(plain) is not None:
        return True
    return begins_like_a_question(plain) and plain.rstrip().endswith(("?", "\uff1f"))


def begins_like_a_question(plain: str) -> bool:
    """Whether a sentence begins with who, what, how much or an auxiliary verb."""
    return _ASKS.match(plain) is not None


def may_be_a_question(plain: str) -> bool:
    """Whether a sentence ends, begins or is built like a question, in any of the languages."""
    return begins_like_a_question(plain) or _FORM.search(plain) is not None


def is_built_like_a_question(plain: str) -> bool:
    """Whether a question mark or a Chinese word of asking leaves little doubt."""
    return _STRONG_FORM.search(plain) is not None


def is_a_refusal(plain: str) -> bool:
    """Whether a sentence in Spanish, French or German says what not to aim for, and nothing instead."""
    return _REFUSES.search(plain) is not None and _INSTEAD.search(plain) is None


def speaks_of_the_trade(plain: str) -> bool:
    """Whether a Spanish, French or German word of radio, power, rates or sharing stands in a sentence."""
    return _OF_THE_TRADE.search(plain) is not None


def is_polite(plain: str) -> bool:
    """Whether a sentence begins with "could you …" or the like, which asks for something to be done."""
    return _POLITE.match(plain) is not None


def asks_you(plain: str) -> bool:
    """Whether a sentence begins with "could you …", whatever is asked for."""
    return (
        re.match(
            r"(?i)\s*(?:can|could|would|will)\s+you\s+(?!tell|explain|say|describe|show|handle|support|"
            r"understand|cope|deal)",
            plain,
        )
        is not None
    )


def is_no_wish(text: str) -> bool:
    """Whether a text is a program, mark-up, or the statement that something is all right."""
    return _CODE.search(text) is not None or _STATED.match(text) is not None


def plain_command(plain: str) -> str:
    """The command that a sentence is as a whole ("yes", "compare …"), or ""."""
    if _COMPARES.match(plain):
        return "compare"
    return next((topic for topic, words in _ANSWERS.items() if words.fullmatch(plain)), "")
