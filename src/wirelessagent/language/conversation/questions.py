"""Questions about what holds, what was decided, and what would be: read as a whole, by their forms.

What an answer needs stands in the details of the question: "rank" ("least" or "most") and "of" ("rate", "power" or
"subcarriers") of who has what, "listed", "subcarrier" (its number from 1), "asked" ("gain", "limits", "duration",
"power" or "most"), and "either_1", "either_2" … or "aims" of a comparison.
"""

from __future__ import annotations

import dataclasses

from wirelessagent.language import moods
from wirelessagent.language.conversation.commands import by_form
from wirelessagent.language.conversation.line import NAME, Forms, Line, begins, has, is_all
from wirelessagent.language.intent import EVERYBODY, Constraint, Detail, Intent
from wirelessagent.language.moods import places, table_of
from wirelessagent.language.offline import NAME as OFFLINE
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.language.sentence import Sentence, own_words
from wirelessagent.language.text import lowered, normalise
from wirelessagent.language.topics import about, number_of, tools_named
from wirelessagent.language.vocabulary import languages_of

_ASKED_EVER: Forms = {"in_force": ("status", {}), "turn_said": ("history", {})}
"""What is asked whether a request holds or not."""
_ASKED: Forms = {
    "why_not": ("why_infeasible", {}),
    "channel": ("uncertainty", {}),
    "how_sure": ("uncertainty", {}),
    "for_the_others": ("users", {"rank": "least", "of": "rate"}),
    "wasting": ("what_if", {"asked": "power"}),
    "whom_to_leave_out": ("users", {"listed": "dearest"}),
    "of_each": ("users", {}),
    "was_better": ("compare", {"with": "last"}),
    "result": ("explain", {}),
}
"""What questions about the result are about, whichever users or figures they name; some a command answers."""

_RATES = ("min_rate_bps", "outage_probability", "users", "leave_out")
_LIMITS = ("max_power_w", "outage_probability", "users", "leave_out")
_MOST_COMPARED = 4
_OPEN = ("", "weak", "unclear", "named_user")
"""Questions back that leave open what is meant; a language model does not say which it asks."""


def read_question(line: Line) -> Intent | None:
    """The question that a line is as a whole; None for any other line."""
    if is_all("thanks", line.shape.rstrip(".!。~ ")):
        return line.answer.out_of_scope("welcome")
    holds = line.context.objective is not None
    asked = by_form(line, line.said, {**_ASKED_EVER, **_ASKED} if holds else _ASKED_EVER)
    if asked is not None or not holds or line.figures:
        return asked
    return line.answer.question("what_if", missing_share=0.0) if has("missing", line.said) else _of_the_result(line)


def _of_the_result(line: Line) -> Intent | None:
    """Questions for the time it took, what holds it back, gains, and who has what.

    "What is the SNR of user 3?", "who has subcarrier 5?", "which subcarriers does user 3 have?"
    """
    plain, count = lowered(normalise(line.text)), len(line.users)
    user: dict[str, Detail] = {"user": line.users[0]} if line.users else {}
    if is_all("duration", line.said):
        return line.answer.question("other", asked="duration")
    if is_all("bottleneck", line.said) and not count:
        return line.answer.question("other", asked="limits")
    place = has("on_subcarrier", plain)
    if has("gain", line.wish) and has("asks_for_gain", line.wish) and (count == 1 or place is not None):
        where: dict[str, Detail] = {} if place is None else {"subcarrier": number_of(place["place"])}
        return line.answer.question("users", asked="gain", **user, **where)
    owner = is_all("owner", plain.strip().rstrip("?.。! "))
    if owner is not None:
        return line.answer.question("users", subcarrier=number_of(owner["place"]))
    if count <= 1 and is_all("listed", line.said):
        return line.answer.question("users", listed="subcarriers", **user)
    return line.answer.question("users", **user) if count == 1 and is_all("share_of_one", line.said) else None


def read_needed(line: Line) -> Intent | None:
    """The what-if of a question what power rates take, or whether a power is needed or enough; else None."""
    powers = [figure.value for figure in line.figures if figure.kind == "power"]
    rates = [figure.value for figure in line.figures if figure.kind == "rate"]
    if has("step", line.wish) or (line.users and not rates):
        return None
    needs = is_all("needs_power", line.wish)
    judges = needs or is_all("enough_power", line.wish)
    if judges and len(powers) == 1 and has("asking", line.shape) and line.context.objective is not None:
        how: dict[str, Detail] = {"enough_w": powers[0], "judged": "needed" if needs else "enough"}
    elif has("takes_power", line.wish) and not powers and (rates or line.context.objective is not None):
        how = {}
    else:
        return None
    aim, floors = "min_power" if line.context.objective is None else "", _read(line, _RATES)
    if len(rates) == 1 and not (floors or line.users):  # what a rate takes, each has it
        floors = {"min_rate_bps": rates[0]}
    return _what_if(line, asked="power", **how, constraints=floors, objective=aim)


def read_promisable(line: Line) -> Intent | None:
    """The what-if of a question what could be promised at most, to everyone or to one user; else None."""
    said = line.shape
    if not has("how_much", said) or len(line.users) > 1 or has("not_promised", said):
        return None
    promises, most, can, of_all = (has(name, said) for name in ("promise", "at_most", "can", "of_all"))
    if of_all or line.users:
        asked = (promises and (most or can)) or (has("give", said) and most and can)
    else:
        asked = promises and can and (most or has("rate", said))
    if not asked or any(figure.kind == "rate" for figure in line.figures):
        return None
    limits = _read(line, _LIMITS)
    if of_all or not line.users:
        dropped = "min_rate_bps weights"
        return _what_if(line, asked="most", objective="max_min_rate", dropped=dropped, constraints=limits)
    user = line.users[0]
    limits = {name: value for name, value in limits.items() if name not in ("users", "leave_out")}
    limits["weights"] = {EVERYBODY: 0.0, user: 1.0}
    return _what_if(line, asked="most", objective="max_rate", dropped="weights", constraints=limits, user=user)


def _what_if(line: Line, **details: Detail) -> Intent:
    """The question what would be, with those details that say something."""
    return line.answer.question("what_if", **{name: value for name, value in details.items() if value not in ("", {})})


def _read(line: Line, names: tuple[str, ...]) -> dict[str, Constraint]:
    """The constraints of these names that a line states."""
    return {name: value for name, value in line.sentence.reading.values.items() if name in names}


def read_comparison(line: Line) -> Intent | None:
    """The comparison of figures, aims or methods that a line asks for; None for any other line."""
    if line.context.objective is None or not has("compares", line.shape) or has("compares_others", line.shape):
        return None
    figures = _compared(line.text)
    if figures:
        return _of_figures(line, figures)
    found = Sentence(line.text, own_words()).found
    aims = dict.fromkeys(each.term.objective for each in found if each.term.objective)
    if aims:
        return line.answer.command("compare", aims=" ".join(aims)) if len(aims) <= _MOST_COMPARED else None
    tools = tools_named(line.text, "method", "repairer") if has("better", line.shape) else ()
    return line.answer.command("compare", **{"with": " ".join(tools)}) if tools else None


def _compared(text: str) -> list[Quantity]:
    """Powers, rates and shares; a bare number beside a share is one in percent too: "95, 99 and 99.9 %"."""
    said = parse_quantities(text)
    shared = any(figure.kind == "ratio" for figure in said)
    return [
        dataclasses.replace(figure, kind="ratio", value=figure.value / 100) if figure.kind == "bare" else figure
        for figure in said
        if figure.kind in ("power", "rate", "ratio") or (shared and figure.kind == "bare")
    ]


def _of_figures(line: Line, figures: list[Quantity]) -> Intent | None:
    kinds = {figure.kind for figure in figures}
    if len(kinds) > 1 or len(figures) > _MOST_COMPARED or any(one.doubtful or one.value <= 0 for one in figures):
        return None
    limits = [_limit(line, figure) for figure in figures]
    details: dict[str, Detail] = {f"either_{place}": limit for place, limit in enumerate(limits, start=1) if limit}
    return line.answer.command("compare", **details) if len(details) == len(figures) else None


def _limit(line: Line, figure: Quantity) -> dict[str, Constraint]:
    """The limit that a figure is: a probability of 50 % or more is that of keeping a promise. Empty for none."""
    if figure.kind == "power":
        return {"max_power_w": figure.value}
    if figure.kind == "rate":
        rate: Constraint = dict.fromkeys(line.users, figure.value) if line.users else figure.value
        return {"max_rate_bps" if has("cap", line.shape) else "min_rate_bps": rate}
    if has("power", line.shape):
        held, limit = line.context.constraints.get("max_power_w"), line.context.max_power_w
        return {"max_power_w": figure.value * (min(held, limit) if isinstance(held, float) else limit)}
    outage = 1.0 - figure.value if figure.value >= 0.5 else figure.value
    return {"outage_probability": round(outage, 12)} if 0 < outage < 1 else {}


def asked_instead(line: Line, understood: Intent) -> Intent | None:
    """What to answer instead of a question back about the aim, which is known; None where that is not asked.

    That is a question that the line likely asks, else the same question back without the aim.
    """
    if line.context.objective is None or understood.kind != "clarify":
        return None
    asks = moods.asks_without_a_mark(line.shape) or has("asking", line.shape)
    if asks and understood.asks in _OPEN and not understood.pending:
        kinds = line.sentence.chances.kinds
        questions = {label: share for label, share in kinds.items() if label.startswith("question")}
        others = (share for label, share in kinds.items() if not label.startswith(("question", "command")))
        if sum(questions.values()) > max(others):
            likeliest = max(questions, key=lambda label: questions[label]).partition(".")[2]
            topic, details = about(likeliest, line.sentence)
            return line.answer.question(topic, **details)
    if line.users and understood.asks == "named_user":
        reply = line.voice.say("what_of_user", users=line.voice.users(line.users))
        return dataclasses.replace(understood, reply=reply, asks="what_of_user")
    if understood.asks == "unclear":
        return dataclasses.replace(understood, reply=line.voice.say("what_changes"), asks="what_changes")
    return None


def given_instead(line: Line, intent: Intent) -> Intent:
    """A what-if of the channel as it was sensed, and a question about "3", who is user 3; any other intent as it is."""
    if intent.kind != "question" or intent.details:
        return intent
    if intent.topic == "what_if" and has("given", line.shape):
        return line.answer.question("what_if", of="channel")
    if intent.topic not in ("why_user", "users") or intent.recogniser not in (OFFLINE, NAME):
        return intent  # a language model names users itself
    named = line.anchored.named(len(line.context.user_names))
    return line.answer.question(intent.topic, user=named[0]) if len(named) == 1 else intent


def only_supposed(line: Line, intent: Intent) -> Intent:
    """A what-if of what a line supposes, weighs or asks about, where it was read as a request; else the intent."""
    supposing = supposes(line.text) and not is_courtesy(line.text)
    if intent.kind != "allocate" or not (supposing or moods.asks_without_a_mark(line.text)):
        return intent
    if not supposing and not intent.constraints and not intent.dropped and not intent.acts:
        return line.answer.question("other")  # "what's the total rate" names no aim
    stays = intent.objective == line.context.objective and (intent.constraints or intent.dropped)
    aim, dropped = "" if stays else str(intent.objective), " ".join(intent.dropped)
    asked = _what_if(line, constraints=intent.constraints, dropped=dropped, objective=aim)
    return dataclasses.replace(asked, recogniser=intent.recogniser)


def is_courtesy(text: str) -> bool:
    """Whether a condition or a question is one of politeness: "could I trouble you for the least power?"."""
    return any(any(places(table_of(language)["courtesy"]["words"], normalise(text))) for language in languages_of(text))


def supposes(text: str) -> bool:
    """Whether a line only supposes or weighs something, or whether it is possible, and asks for nothing.

    >>> supposes("what if we used 5 W"), supposes("if possible, 1 Mbit/s each"), supposes("要不要省点电？")
    (True, False, True)
    >>> supposes("can we leave user 8 out?"), supposes("could you leave user 8 out?")
    (True, False)
    """
    plain = " ".join(lowered(normalise(text)).split())
    possible = is_all("possible", plain) is not None and not has("polite", plain) and not is_courtesy(text)
    return possible or begins("supposes", plain) is not None
