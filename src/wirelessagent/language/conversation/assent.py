"""Whether a line lets the waiting plan be applied: a closed grammar, no model, whichever recogniser is at work.

A base station is only told to act by a line that is, as a whole, an assent or a plain command to apply: "yes, please",
"apply it now", "好的，应用吧". A negation, a question mark, a condition, a time, another target, a figure or any word
left over makes it something else, which at most leads to a question.
"""

from __future__ import annotations

import re
from typing import Literal, TypeAlias

from wirelessagent.language.conversation.line import Line
from wirelessagent.language.deferred import deferred
from wirelessagent.language.intent import Intent
from wirelessagent.language.text import is_chinese, lowered, normalise

Assent: TypeAlias = Literal["yes", "mild", "apply", "no", "later", "doubtful", "other"]
"""What a line is to a plan that waits: a yes; a mild one, such as "ok", which may only take note of an answer; a
command to apply; a refusal; a wish to wait; words about applying that are none of these, such as a question; or
anything else."""

_LONGEST = 100
"""Characters of a line that may be an assent."""
_PLAN = (
    r"(?:it|this|that|them|(?:(?:the|this|that|your)\s+)(?:new\s+|whole\s+)?(?:plan|allocation|decision|change|changes|"
    r"proposal|request)(?:\s+now)?)"
)
_VERB = r"(?:apply|activate|deploy|implement|execute|enact|commit)"
_APPLY = "|".join(
    (
        rf"{_VERB}(?:\s+{_PLAN})?", rf"(?:roll\s+out|carry\s+out)\s+{_PLAN}", rf"(?:roll|carry)\s+{_PLAN}\s+out",
        rf"use\s+{_PLAN}", rf"(?:put|bring)\s+{_PLAN}\s+(?:in\s?to\s+)(?:effect|force|operation)", r"ship\s+it",
        rf"(?:make|take|push)\s+{_PLAN}\s+live", r"go\s+live", rf"(?:go|proceed)\s+with\s+{_PLAN}",
        # Spanish, French, German
        r"apl[ií]ca(?:r?l[oa]|r)?(?:\s+(?:el\s+plan|esto))?", r"apl[ií]quelo", r"ponlo\s+en\s+marcha",
        r"applique(?:z|r)?(?:[- ]l[ea])?(?:\s+le\s+plan)?", r"mets-le\s+en\s+(?:œuvre|oeuvre|service)",
        r"(?:(?:es|ihn|das|den\s+plan)\s+)?(?:anwenden|übernehmen|umsetzen|ausführen)",
        r"wende(?:n\s+sie)?\s+(?:es|ihn|das|den\s+plan)\s+an", r"setze?(?:n\s+sie)?\s+(?:es|ihn|das|den\s+plan)\s+um",
        # Chinese
        (
            r"(?:把(?:它|这个|方案|计划))?(?:应用|應用|执行|執行|下发|下發|部署|启用|实施|采用)(?:上|掉)?"
            r"(?:它|这个|(?:这个|该|此|这份|这一)?(?:方案|计划|分配|决定))?(?:一下)?(?:吧|啊)?"
        ),
        r"让(?:它|方案|计划)生效(?:吧)?",
    )
)  # fmt: skip
_YES = "|".join(
    (
        r"y|ye[sp]|yeah|yup|aye|of\s+course|absolutely|definitely|certainly|by\s+all\s+means",
        r"go\s+(?:right\s+)?ahead|go\s+for\s+it|do\s+(?:it|that|this|so)|let'?s\s+(?:do\s+(?:it|that|this)|go)",
        r"make\s+it\s+so|make\s+it\s+happen|proceed|(?:i\s+)?(?:confirm|agree|accept|approve)(?:\s+(?:it|that|this|the\s+plan))?",
        r"(?:it'?s\s+|it\s+is\s+)?(?:confirmed|agreed|accepted|approved)|you\s+(?:can|may)|please\s+do",
        r"sí|si|claro|adelante|confirm(?:o|ado)|hazlo|de\s+acuerdo|oui|ouais|d'accord|bien\s+sûr|vas-y|allez-y|fai[st]e?s?-le",
        r"je\s+confirme|confirmée?|ja|jawohl|jawoll|genau|natürlich|klar|einverstanden|(?:ich\s+)?bestätig(?:e|t)",
        r"(?:mache?|tue?)(?:n\s+sie)?\s+(?:es|das)",
        r"是的?|对的?|對的?|我?(?:确认|確認|确定|同意)|没错|沒錯|当然|没问题|沒問題|那?就(?:这样|这么(?:办|做|定))|照办|批准|执行吧",
    )
)
_MILD = "|".join(
    (
        r"ok(?:ay)?|okey|k|sure(?:\s+thing)?|al?l\s?right|right|correct|fine|good|great|perfect|excellent|nice|cool|wonderful",
        r"(?:(?:it|that|this|all)\s+)?(?:looks?|sounds?|seems?)\s+(?:very\s+)?(?:good|fine|ok(?:ay)?|great|right|perfect|reasonable)",
        r"(?:(?:that|it)'?s|(?:that|it|this|all)\s+is|all)\s+(?:ok(?:ay)?|fine|good|great|right|perfect)|very\s+(?:good|well)",
        r"vale|bien|está\s+bien|muy\s+bien|perfecto|parfait|c'est\s+bon|très\s+bien|gut|sehr\s+gut|perfekt|in\s+ordnung|passt",
        r"好|好[的吧啊呀]|好嘞|可以的?|可以了|行|行[的吧啊]|嗯|不错|很好|非常好|挺好",
    )
)
_POLITE = (
    r"please|pls|thanks(?:\s+a\s+lot)?|thank\s+you(?:\s+very\s+much)?|thx|now|right\s+(?:now|away)|immediately|at\s+once|"
    r"then|and|just|well|to\s+me|for\s+me|por\s+favor|gracias|ahora|s'il\s+(?:te|vous)\s+pla[iî]t|merci|maintenant|bitte|danke|jetzt|y|et|"
    r"und|请|麻烦你?|谢谢(?:你|您)?|现在|立即|马上|立刻|就|那就?|直接|吧|啊"
)
_APART = r"(?:(?<![^\W\d_])|(?<=[\u3400-\u9fff]))"
_OVER = r"(?:(?![^\W\d_])|(?=[\u3400-\u9fff]))"


def _part(name: str, words: str) -> str:
    return rf"(?P<{name}>{_APART}(?:{words}){_OVER})"


_ASSENT = deferred(
    rf"(?:\s*(?:{_part('apply', _APPLY)}|{_part('mild', _MILD)}|{_part('yes', _YES)}|"
    rf"{_APART}(?:{_POLITE}){_OVER})){{1,9}}\s*"
)
_NO_ASSENT = deferred(r"[?？\d]|[是对對]吧")
"""A question or a figure, which no assent has in it."""
_PLAIN = deferred(r"[\s,，、.。!！~;；:：…]+")

_WORDS_KNOWN = (
    "a about again ahead all already an any anything and are as at be been before but by can cancel could defer delay "
    "did do does doesn't doing don't done dont either else even ever first for from go good great has have he hold i "
    "i'd i'll i'm if in is isn't it it's its just later let let's like maybe me minute moment more must my need "
    "neither never no nope none not nothing now of off ok okay on once one only or other perhaps please postpone put "
    "rather really refrain refuse reject right said say says sec second see shall she should shouldn't so some soon "
    "stop such sure thank thanks that that's the them then there they this to today tomorrow tonight too until unless "
    "us want wait was wasn't we what when which who why will with without won't would wouldn't yeah yep yes yet you "
    "your y n fine well also worries problem plan plans allocation decision change changes proposal request effect "
    "into application deployment activation apply applied applies applying unapply deploy deployed deploying activate "
    "activated activating implement implemented implementing execute executed executing enact enacted commit "
    "committed roll rolled rolling out confirm confirmed confirming agree agreed disagree accept accepted approve "
    "approved proceed understand understood abort can't cannot happens happen safe everything everywhere nowhere live "
    "use used lo la el los apliques aplicar aplica aplicarlo todavía aún espera nada nunca sí si ne n' l'applique "
    "applique appliquer appliquez pas rien jamais le les attends attendez encore oui nicht nichts nie kein keine "
    "keinen anwenden wende es ihn das den noch warte warten später bitte ja nein umsetzen non merci danke gracias "
)
_KNOWN = frozenset(_WORDS_KNOWN.split())
"""Words of which a line about applying or not applying a plan may be made, and nothing else of the cell."""
_KNOWN_SIGNS = frozenset(
    "对對不没沒别勿先再等会會儿一下明后天晚稍点应應用执執行下发發部署生效确確认認同意可以好的是吗嗎么麼什呢啊吧了就请請它这個个方案"
    "计计划划要想取消停止算都也无無需必全现在时时候何谁吗该应否能让还還暂暫缓拒绝绝放弃弃任何东西我们你您他说说懂明白知道"
)
_OF_APPLYING = (
    r"\b(?:appl(?:y|ie[sd]|ying|ication)|unapply|deploy\w*|activat\w+|implement\w*|execut\w+|enact\w*|commit\w*|roll\w*|"
    r"confirm\w*|accept\w*|approve\w*|do\s+(?:it|that|this|so)|aplic\w+|apliques|appli(?:que|quer|quez)|anwenden|wende|"
    r"umsetzen|proceed|go\s+ahead|into\s+effect|live)\b|应用|應用|执行|執行|下发|下發|部署|生效|确认|確認"
)
_WORDS_OF_ASSENT = r"\b(?:agree|disagree|yes|yeah|yep|ok|okay|sure|fine|good|great|right|sí|oui|ja)\b|同意"
_SPOKEN_OF = deferred(rf"{_OF_APPLYING}|{_WORDS_OF_ASSENT}")
_ABOUT = deferred(rf"{_OF_APPLYING}|{_WORDS_OF_ASSENT}|可以|行|好|是|对|對")
_ASKED = deferred(
    r"[?？]|^(?:(?:ok|so|and|but|well|please)\s+)*(?:should|shall|can|could|may|will|would|do|does|did|is|are|was|has|have|"
    r"what|when|who|why|which|how)\b(?!\s+(?:it|that|this|so|not)(?:\s+(?:not|now|never))?$)(?!\s+not\b)|"
    r"\b(?:what|when|who|why|which|how)\b|吗|嗎|呢|什么(?!都|也)|何时|谁|是否|行不行|好不好|是不是|可不可以|要不要"
)
_IF = deferred(
    r"\b(?:if|unless|but|until|before|once|only|maybe|perhaps|either|or|else|other|first|see|understand|understood|said|"
    r"says?|sure|with|safe)\b|如果|要是|除非|但|(?<!再)说|懂|明白|知道"
)
_LATER = deferred(
    r"\b(?:wait|hold|later|yet|tomorrow|tonight|soon|postpone|defer|delay|moment|minute|sec|second|not\s+now|"
    r"todavía|aún|espera|attends|attendez|encore|warten?|später|noch)\b|等|明天|后天|晚点|稍后|先[不别]|暂|还不|再说"
)
_REFUSED = deferred(
    r"\b(?:not|\w+n't|dont|cannot|never|nothing|none|neither|nowhere|without|refuse|refrain|reject|cancel|stop|abort|unapply|"
    r"disagree|nada|nunca|pas|rien|jamais|nichts?|nie|keinen?)\b|^\s*(?:no|non|nein)\b|\bno\s+(?:appl|plan|alloc|change)|"
    r"不|别|勿|取消|停止|拒绝|放弃|没|无"
)
_NO = deferred(
    r"(?:(?:no|nope|nah|n|never|please|thanks?|thank\s+you|don'?t|do\s+not|no\s+way|(?:better|rather|i'd\s+rather)\s+not|"
    r"non|nein|gracias|merci|danke|不|不要|不用|不用了|不行|不是|不对|不了|否|别|不同意|不必|不可以|谢谢)\s*)+"
)
_COURTESY = deferred(r"(?:(?:please|thanks?|thank\s+you|gracias|merci|danke|谢谢)\s*)+")
_CONTRADICTS = deferred(r"\b(?:yes|yeah|yep|y)\b.*\b(?:no|not|nope)\b|\b(?:no|nope)\b.*\b(?:yes|yeah|yep|y|ok|okay)\b")
_TAKEN_BACK = deferred(r"\b(?:no\s+(?:problem|worries)|why\s+not)\b")


def assent(text: str) -> Assent:
    """What a line is to a plan that waits.

    >>> assent("Yes, please apply it now!"), assent("apply nothing"), assent("should I apply it?"), assent("non merci")
    ('apply', 'no', 'doubtful', 'no')
    >>> assent("好的，应用吧"), assent("ok, hold on"), assent("now with 5 W")
    ('apply', 'later', 'other')
    """
    if len(text) > _LONGEST:
        return "other"
    said = lowered(normalise(text)).strip()
    match = None if _NO_ASSENT.search(said) else _ASSENT.fullmatch(_PLAIN.sub(" ", said).strip())
    if match is not None and any(match.groupdict().values()):
        return "apply" if match["apply"] else "yes" if match["yes"] else "mild"
    plain = " ".join(_PLAIN.sub(" ", said).split())
    return _about_applying(plain) if _is_known(plain) else "other"


def is_assent(text: str) -> bool:
    """Whether a line, as a whole, lets the waiting plan be applied."""
    return assent(text) in ("yes", "mild", "apply")


def speaks_of_applying(text: str) -> bool:
    """Whether a line has a word of assent or of applying in it, whatever it says of it."""
    return _SPOKEN_OF.search(lowered(normalise(text[:_LONGEST]))) is not None


def read_assent(line: Line) -> Intent | None:
    """A line that is about the plan that waits for a yes and about nothing else; None for any other."""
    if line.context.awaits != "confirmation":
        return None
    said = assent(line.text)
    if said == "other":
        return None
    if said == "no":
        return line.command("reject")
    return line.command("apply" if said == "apply" else "confirm")


def _is_known(plain: str) -> bool:
    """Whether every word, or every Chinese sign, is one of those that speak of applying and nothing else."""
    words = re.findall(r"[^\W\d_]+(?:'[^\W\d_]+)?|\S", plain)
    return all(
        word in _KNOWN or word in "?？'\"" or all(is_chinese(sign) and sign in _KNOWN_SIGNS for sign in word)
        for word in words
    )


def _about_applying(plain: str) -> Assent:
    if _NO.fullmatch(plain) and not _COURTESY.fullmatch(plain):
        return "no"
    later, about = _LATER.search(plain), _ABOUT.search(plain)
    if _TAKEN_BACK.search(plain) or (about and _ASKED.search(plain)):
        return "doubtful"
    if later is not None:
        return "doubtful" if _IF.search(plain) else "later"
    if about is None:
        return "other"
    if _IF.search(plain) or _CONTRADICTS.search(plain):
        return "doubtful"
    return "no" if _REFUSED.search(plain) else "doubtful"
