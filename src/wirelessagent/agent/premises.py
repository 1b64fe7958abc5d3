"""What a question takes for granted, held against what is: "why does user 5 get the least?" where all get the same."""

from __future__ import annotations

import re

import numpy as np

from wirelessagent.agent import answers
from wirelessagent.agent.posing import user_number
from wirelessagent.agent.turn import Run
from wirelessagent.language.intent import Intent
from wirelessagent.telling.catalogue import called, message
from wirelessagent.telling.roster import rank_answer

_RANKS = (
    ("least", re.compile(r"(?i)\b(?:least|lowest|slowest|worst)\b|最少|最慢|最低|最差")),
    ("most", re.compile(r"(?i)\b(?:the\s+most|highest|fastest|best)\b|最多|最快|最高|最好")),
)
_NOTHING = re.compile(
    r"(?i)\b(?:nothing|no\s+(?:rate|service|subcarriers?|power)|not\s+(?:be(?:ing)?\s+)?served|cut\s+off|zero)\b|"
    r"没有?(?:分到|得到|拿到)?(?:速率|服务|任何|东西)|什么[都也]没|没被?服务|一点[都也]没|为零|断"
)
_SAME = 1e-3


def corrected(run: Run, intent: Intent, text: str) -> str:
    """What is not so in a question why a user gets the least, the most or nothing; empty where it is so."""
    reference, decision, language = intent.details.get("user"), run.decision, intent.language
    if intent.topic != "why_user" or not isinstance(reference, str) or not decision.is_usable:
        return ""
    rates, names = decision.rate_bps, decision.user_names
    user = user_number(reference, names, language)[0]
    name = called(language, names[user])
    if rates[user] > 0 and _NOTHING.search(text):
        return message(language, "about.not_nothing", user=name)
    rank = next((rank for rank, words in _RANKS if words.search(text)), "")
    served = rates[decision.problem.serves(rates.size)]
    if not rank or not served.size:
        return ""
    edge = np.min(served) if rank == "least" else np.max(served)
    alone = np.ptp(served) > _SAME * np.max(served)
    if alone and abs(rates[user] - edge) <= _SAME * edge:
        return ""
    return message(
        language, f"about.not_{rank}", user=name, who=rank_answer(answers.case_of(run), rank, "rate", language)
    )
