"""What a question or a command is about: its user, its figures, what to compare with, and whether it was meant."""

from __future__ import annotations

import re

from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Detail
from wirelessagent.language.named_tools import tools_named
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.sentence import Sentence

_FORMATS = (("tmf921", deferred(r"(?i)tmf\s*-?921")), ("ts28312", deferred(r"(?i)28\.?312|3gpp")))
_WITH = deferred(
    r"(?i)\bcompare\s+(?:(?:it|this|that)\s+)?(?:with|to|against)\s+([a-z][\w.-]*)[\s.!?]*$|"
    r"[和与跟同]\s*([A-Za-z][\w.-]*)\s*(?:作|做|进行)?(?:个|一)?(?:比较|对比|相比|比)"
)
_AS = deferred(
    r"(?i)\bexport\s+(?:(?:it|this|that|everything|the\s+\w+)\s+)?(?:as|to|in|into)\s+([a-z][\w.-]*)[\s.!?]*$|"
    r"导出(?:为|成|到)\s*([A-Za-z][\w.-]*)\s*$"
)
_NO_TOOL = deferred(
    r"(?i)last|previous|earlier|before|first|others?|one|it|this|that|now|then|yesterday|everything|all|turn|mine|ours|"
    r"reality|theory|optimum|optimal|best"
)
_NO_FORMAT = deferred(r"(?i)json|files?|disk|standard|document|text|it|this|that|me|us")
_MORE = deferred(r"(?i)\b(?:more|extra|additional|further|another)\s+")
_EACH = deferred(
    r"(?i)\b(?:each|every(?:one|body)?|all\s+(?:the\s+)?users|per\s+(?:user|head)|apiece)\b|每[个位名]?|大家|所有人|所有用户|"
    r"各用户|人人"
)
_MORE_USERS = deferred(
    r"(?i)\b(?:one|an?|another)\s+(?:more|extra|additional|further)?\s*(?:user|subscriber|customer|terminal)\b|"
    r"[多加]一?[个位名]?(?:用户|终端)"
)
_HALF_MISSING = deferred(
    r"(?i)\bhalf\b.{0,30}\b(?:missing|lost|unknown|gone)\b|(?:一半.{0,12}(?:缺|丢)|(?:缺|丢).{0,8}一半)"
)

_GONE = deferred(
    r"(?i)\b(?:gone|left|leaves?|leaving|out|off|away|without|drop\w*|lost|absent|missing|exist|there|skip\w*|exclu\w*|"
    r"remov\w*|ignor\w*|sin|fuera|sans|dehors|ohne|weg|raus)\b|走|离|不在|没|去掉|下线|掉线|不服务|不管|退|除|停|少"
)

_STEPS = {"power": "power_w", "rate": "rate_bps"}

CHANGING = ("apply", "confirm", "undo", "reset")
_SURE_OF_A_COMMAND = 0.6
_CUES = {  # a command that changes something is carried out only where one of these is in it
    "reset": deferred(
        r"(?i)reset|clear|wip|eras|forget|delet|start over|again|scratch|afresh|anew|zero|new|fresh|slate|"
        r"square one|back|drop|scrap|"
        r"flush|beginning|defaults?|restart|top|重|清|忘|新|初始|零|默认|出厂|归|reinici|borr|cero|empe|olvid|"
        r"recommen|effac|zéro|réinit|"
        r"oubli|zurück|vorn|neu|lösch|vergiss|anfang"
    ),
    "undo": deferred(
        r"(?i)undo|rever|roll|back|restor|previous|before|cancel|retract|mistake|wrong|old|withdraw|oops|撤|回|退|"
        r"还原|恢复|取消|后悔|错|"
        r"deshac|deshaz|vuelve|revier|restaura|annul|retour|revien|défai|rückgängig|zurück|alten"
    ),
    "apply": deferred(
        r"(?i)appl|deploy|activ|implement|execut|roll|push|commit|install|enact|\buse\b|send|live|effect|operation|"
        r"happen|on air|"
        r"production|\bgo\b|proceed|do it|let's|carry|make it|engage|run with|ship|put it|write|load|take it|应用|"
        r"执行|下发|部署|生效|启用|实施|"
        r"落地|采用|提交|办|定|上线|开|推|动手|搞|走|就|用|按|照|做|发|adelante|hazlo|ponlo|aplíca|aplica|ejec|"
        r"despl|activa|vas-y|mets|exéc|"
        r"déplo|envoie|anwend|wende|übern|ausf|ausroll|spiel|mach|leg|setz|aktiv|damit"
    ),
}


def details_of(topic: str, sentence: Sentence) -> dict[str, Detail]:
    """The figures and names of a question or command of this topic."""
    reading = sentence.reading
    if topic in ("why_user", "users", "prices"):
        return {"user": reading.named[0]} if reading.named else {}
    if topic == "what_if":
        return _what_if(sentence)
    if topic == "step":
        return _step(sentence)
    if topic == "compare":
        unknown = _named_in(_WITH, _NO_TOOL, sentence.plain)
        return {"with": " ".join(tools_named(sentence.plain, "method", "repairer")) or unknown or "last"}
    if topic == "export":
        known = next((name for name, pattern in _FORMATS if pattern.search(sentence.plain)), "")
        return {"format": known or _named_in(_AS, _NO_FORMAT, sentence.plain) or "ts28312"}
    return {}


def _named_in(pattern: re.Pattern[str], common: re.Pattern[str], plain: str) -> str:
    """The name that a sentence ends with, where it is no common word; else empty."""
    match = pattern.search(plain)
    name = "" if match is None else next(group for group in match.groups() if group).strip()
    return "" if common.fullmatch(name) else name


def _what_if(sentence: Sentence) -> dict[str, Detail]:
    reading, details = sentence.reading, dict[str, Detail]()
    share = reading.missing
    if share is None and _HALF_MISSING.search(sentence.plain):
        share = 0.5
    if share is not None and 0 <= share < 1:
        details["missing_share"] = share
    values = dict(reading.values)
    if reading.named and not values and not reading.back and _GONE.search(sentence.plain):
        values["leave_out"] = reading.named  # "what if user 3 were gone?"
    if values:
        details["constraints"] = values
    if sentence.goal.verdict == "clear":
        details["objective"] = sentence.goal.objective
    return details


def _step(sentence: Sentence) -> dict[str, Detail]:
    """How much more is asked about: power, rate or users; a watt where nothing is said."""
    if _MORE_USERS.search(sentence.plain):
        return {"users": 1.0}
    plain, steps = _MORE.sub("", sentence.plain), dict[str, Detail](sentence.reading.steps)
    for figure in parse_quantities(plain):  # "5 more watts"
        if figure.kind in _STEPS and figure.value > 0:
            steps.setdefault(_STEPS[figure.kind], figure.value)
    if "rate_bps" in steps and sentence.reading.named:
        steps["user"] = sentence.reading.named[0]
    elif "rate_bps" in steps and _EACH.search(plain):
        steps["each"] = 1.0
    return steps or {"power_w": 1.0}


def is_unsure(topic: str, plain: str, certainty: float) -> bool:
    """Whether a command that changes something may have been meant, and has to be asked for.

    >>> is_unsure("undo", "undo that", 0.9), is_unsure("undo", "hmm", 0.9), is_unsure("history", "hmm", 0.5)
    (False, True, False)
    """
    cue = _CUES.get(topic)
    said = cue is None or cue.search(plain) is not None
    return topic in CHANGING and not (said and certainty >= _SURE_OF_A_COMMAND)
