"""Questions what power rates take, and whether a power is needed or enough: "how many watts would 1 Mbit/s each need?"

They are what-ifs with the detail "asked": "power". A power that is asked about is the detail "enough_w".
"""

from __future__ import annotations

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Constraint, Detail, Intent
from wirelessagent.language.sentence import Sentence, own_words

_TAKES = deferred(
    r"\b(?:how\s+much\s+(?:radiated\s+)?power|how\s+many\s+(?:milli)?watts|(?:what|which)\s+power)\b.*"
    r"\b(?:needs?|needed|takes?|requires?|required|necessary|costs?)\b|"
    r"(?:需要?|要|得)(?:用|花)?(?:多少|几|多大)的?(?:瓦|功率|电)|(?:多少|多大)的?(?:瓦|功率)才?(?:能|够|可以|行)"
)
_NEEDS = deferred(
    r"(?:(?:do|does|would|will)\s+(?:we|i|it|they|this|that|the\s+cell)\s+(?:(?:really|actually|even|still|all)\s+)*"
    r"(?:need|take|require)|(?:is|are)\s+(?=#\s+(?:\w+\s+)?(?:needed|necessary|required)))\s*(?:all\s+(?:of\s+)?)?(?:the\s+)?#.*|"
    r"(?:真的?|现在|我们)*(?:需要|用得着|非要|必须用?)#.*[吗么]?"
)
_ENOUGH = deferred(
    r"(?:is|are|would|will)\s+#\s+(?:be\s+)?(?:really\s+|still\s+)?(?:enough|sufficient).*|.*#(?:够不够|足?够)(?:用)?(?:了|吗|么)?.*"
)
_ENDS = deferred(r"[?？]\s*$|[吗么]\s*$|够不够")
_STEP = deferred(
    r"\b(?:more|extra|additional|further|another|less|fewer|sav\w+|rais\w+|increas\w+|cut|each\s+watt)\b|%|再|还|[多加](?![少大])|提高|增|省|节|降"
)
_RATES = ("min_rate_bps", "outage_probability", "users", "leave_out")


def read_needed(line: Line) -> Intent | None:
    """The what-if of a question what power rates take, or whether a power does; None for any other line."""
    said = line.wish.strip()
    powers = [figure.value for figure in line.figures if figure.kind == "power"]
    rates = len(line.figures) > len(powers)
    if _STEP.search(said) or (line.users and not rates):
        return None
    judged = _NEEDS.fullmatch(said) or _ENOUGH.fullmatch(said)
    if judged is not None and len(powers) == 1 and _ENDS.search(line.text) and line.context.objective is not None:
        how: dict[str, Detail] = {"enough_w": powers[0], "judged": "needed" if _NEEDS.fullmatch(said) else "enough"}
    elif _TAKES.search(said) and not powers and (rates or line.context.objective is not None):
        how = {}
    else:
        return None
    context = line.context
    sentence = Sentence(line.text, own_words(), names=context.user_names, max_power_w=context.max_power_w)
    asked: dict[str, Constraint] = {name: value for name, value in sentence.reading.values.items() if name in _RATES}
    further: dict[str, Detail] = {"constraints": asked} if asked else {}
    if context.objective is None:
        further["objective"] = "min_power"
    return line.question("what_if", asked="power", **how, **further)
