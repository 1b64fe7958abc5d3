"""What the rules and the session hold beside a sentence: its users, its limits, what it takes back.

An LLM names no user whom nobody named, lets no limit go that the operator did not take back, and brings back none that
the session does not hold.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence

from wirelessagent.language.deferred import deferred
from wirelessagent.language.followups import dropped_in, keeps_the_limits, with_users_back
from wirelessagent.language.intent import EVERYBODY, Constraint, Intent
from wirelessagent.language.llm_reasons import Objection
from wirelessagent.language.mentions import mentions
from wirelessagent.language.recogniser import Context
from wirelessagent.language.sentence import Sentence

_TAKES_BACK = deferred(
    r"(?i)\b(?:without|drop\w*|remov\w+|lift\w*|forget|no|cancel\w*|get\s+rid|take\s+away|delet\w+|not?\s+longer|any\s?more|"
    r"ignore|scrap\w*|waiv\w+|abolish\w*|relax\w*|unlimited|unrestricted|gone|never\s?mind|"
    r"sin|quita\w*|elimina\w*|sans|supprim\w+|enlèv\w+|ohne|entfern\w+|streich\w+)\b|"
    r"去掉|取消|不要|解除|拿掉|撤|放开|删|忽略|别管|没有|不设|移除|不限|免了|作废|不再|不用"
)
_RATE = r"rate|speed|promis|guarantee|floor|bit|minimum|velocidad|tasa|débit|速|保|兆"
_USERS = r"user|everyone|everybody|every one|who|usuari|utilisat|nutzer|用户|人|大家|号"
_SPEAKS_OF: Mapping[str, re.Pattern[str]] = {
    name: deferred(rf"(?i){words}")
    for name, words in {
        "max_power_w": r"power|watt|budget|\bw\b|potencia|puissance|leistung|功率|瓦|电", "min_rate_bps": _RATE,
        "max_rate_bps": rf"{_RATE}|cap|ceiling|throttl", "circuit_power_w": r"circuit|电路",
        "outage_probability": r"outage|reliab|probab|certain|%|中断|可靠|概率", "weights": r"weight|priorit|权重|优先",
        "subcarrier_max_power_w": r"carrier|子载波", "resource_block_group_size": r"group|block|组|块",
        "users": _USERS, "leave_out": _USERS,
    }.items()
}  # fmt: skip
_NUMBERED = deferred(r"[^0-9]*([0-9]{1,9})[^0-9]*")


class Held:
    """The limits and users of one sentence, as the rules read them, and of its conversation.

    Attributes:
        rules: the constraints that the rules read, whatever kind of sentence they see.
    """

    def __init__(self, sentence: Sentence, context: Context, offline: Intent) -> None:
        self._plain, self._context, self._offline = sentence.plain, context, offline
        asks = offline.kind in ("allocate", "clarify")
        self.rules: Mapping[str, Constraint] = (
            {**offline.pending, **offline.constraints} if asks else sentence.reading.values
        )
        back = with_users_back(sentence.reading, context)[1] if sentence.reading.back else ()
        self._dropped = {*offline.dropped, *dropped_in(sentence.plain, context)[0], *back} & set(context.constraints)
        self._keeps = bool(self._dropped or back or not sentence.reading.values) or keeps_the_limits(sentence.plain)
        self._known = self._known_users(sentence)

    def _known_users(self, sentence: Sentence) -> set[str]:
        """Everybody whom the sentence or the session names."""
        context = self._context
        known = {*sentence.reading.named, *context.pending_users, str(self._offline.details.get("user", EVERYBODY))}
        taken = [(q.start, q.end) for q in sentence.quantities if q.kind in ("power", "rate", "ratio")]
        known.update(user for each in mentions(sentence.plain, context.user_names, taken) for user in each.users)
        for limits in (self.rules, context.pending, context.constraints, context.supposed, context.stated):
            for value in limits.values():
                known.update(value if isinstance(value, tuple) else by_user(value))
        return known

    def user(self, said: str) -> str:
        """A user as the operator calls them, by number or by name.

        Raises:
            Objection: neither the sentence nor the session names them.
        """
        name = said.strip()
        same_name = [known for known in self._known if known.casefold() == name.casefold()]
        match = _NUMBERED.fullmatch(name)
        number = "" if match is None else str(int(match[1]))
        if same_name or number in self._known:
            return same_name[0] if same_name else number
        raise Objection("no_user", f"the sentence names no user {name[:40]!r}")

    def amends(self, said: bool) -> None:
        """Objects to a change that is none, and to a new request that would let the current limits go unsaid."""
        if not self._context.constraints or self._context.objective is None:
            return
        read = self._offline.kind == "allocate"
        expected = self._offline.amends if read else said or self._keeps
        if said != expected:
            raise Objection("let_go" if expected else "no_request", f"amends must be {str(expected).lower()} here")

    def drops(self, names: Sequence[str]) -> None:
        """Objects to limits that go although nobody took them back, and to those that stay although somebody did."""
        back = _TAKES_BACK.search(self._plain) is not None
        more = {name for name in names if not (back and _SPEAKS_OF[name].search(self._plain))}
        if set(names) != self._dropped if self._dropped else more:
            expected = ", ".join(sorted(self._dropped)) or "nothing"
            raise Objection("let_go", f"the sentence takes back {expected}: drops must be that, or use clarify")

    def holds(self, name: str, value: Constraint) -> bool:
        """Whether the session holds exactly this limit."""
        own = self._context.max_power_w if "max_power_w" not in self._context.constraints else ()
        limits = [self._context.constraints.get(name, ()), self._context.pending.get(name, ())]
        return any(same(value, each) for each in (*limits, own if name == "max_power_w" else ()))


def by_user(value: Constraint) -> Mapping[str, float]:
    """A constraint by user, everybody being one."""
    if isinstance(value, Mapping):
        return value
    return {} if isinstance(value, tuple) else {EVERYBODY: value}


def same(one: Constraint, other: Constraint) -> bool:
    """Whether two constraints say the same."""
    if isinstance(one, tuple) or isinstance(other, tuple):
        return isinstance(one, tuple) and isinstance(other, tuple) and set(one) == set(other)
    a, b = by_user(one), by_user(other)
    return set(a) == set(b) and all(math.isclose(a[user], b[user], rel_tol=1e-6) for user in a)
