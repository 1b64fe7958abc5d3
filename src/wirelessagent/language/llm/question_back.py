"""What of an LLM's question back the operator is shown: questions alone, with figures that were listed.

An answer that is mistaken for a report does harm, and so does one that sends somebody elsewhere. So sentences that ask
nothing are left out, and a question that claims something was done, or names an address, is no question.
"""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Sequence

from wirelessagent.language.deferred import deferred
from wirelessagent.language.llm.client import Objection
from wirelessagent.language.quantities import parse_quantities

_SENTENCE = deferred(r"(?s).+?(?:[.!?](?=\s|$)|[。！？\uff1f\uff01]|\n|$)")
_ADDRESS = deferred(
    r"(?i)[a-z][a-z0-9+.-]*:\s*/\s*/|\bwww\.|\b(?:mailto|javascript|data|tel):|[^\s@]@[^\s@]|\[\s*link|\]\s*\(|"
    r"(?<![0-9])[a-z0-9-]+\.(?:[a-z]{2,24})(?=[/\s:?#,;)\uff1f]|$)"
)
_CLAIM = deferred(
    r"(?i)(?<!\bbe )\b(?:done|applied|activated|deployed|executed|completed?|confirmed|committed|reverted|undone|"
    r"finished|succe\w+|"
    r"(?:i|we|it|has|have|was|were|is|are|been|i've|we've|just|already|now)\s+(?:\w+\s+)?(?:set|changed|saved|"
    r"switched|reset|updated|configured|adjusted|started|stopped)|"
    r"hecho|aplicado|appliqué|fait|angewendet|erledigt|fertig)\b|已经?|完成|成功|(?:应用|执行|设置|更改|修改|改|生效|下发)(?:好)?了"
)


def question_back(text: str, known: Sequence[float]) -> str:
    """What to ask the operator, of what an LLM says; ``known`` are the figures in W and bit/s that it may name.

    >>> question_back("I see. The least power or the highest rate?", [])
    'The least power or the highest rate?'

    Raises:
        Objection: it asks nothing, or does not only ask.
    """
    if _ADDRESS.search(text):
        raise Objection("pretended", "the question may hold no address or link")
    shown = "".join(sign if unicodedata.category(sign)[0] != "C" or sign == "\n" else " " for sign in text)
    asked = [said for each in _SENTENCE.findall(shown.strip()) if (said := each.strip()).endswith(("?", "\uff1f"))]
    question = " ".join(asked)
    if not question:
        raise Objection("asked_nothing", "kind clarify needs a question to the operator, with its question mark")
    if _CLAIM.search(question):
        raise Objection("pretended", "nothing was done, so the question may not say so")
    said = [q for q in parse_quantities(question) if q.kind in ("power", "rate")]
    if any(not any(math.isclose(q.value, value, rel_tol=1e-3) for value in known) for q in said):
        raise Objection("invented", "the question may only name listed figures")
    return question
