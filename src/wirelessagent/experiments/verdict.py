"""How a claim becomes a verdict: bars for measured figures, told apart by the figures' intervals.

A claim is first judged as printed. A bar is passed if the whole interval of its figure lies on the right side, failed
if the whole interval lies on the wrong one, and open otherwise. Passed as printed, the claim *holds*. Failed, it *holds
only if* one of the other readings is true whose bars are passed, and *does not hold* if all of them are failed too.
Whatever is open in between is *no verdict*: more draws, or a quieter machine, may bring one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from wirelessagent.experiments.intervals import Measure

Verdict: TypeAlias = Literal["holds", "holds only if", "does not hold", "no verdict"]
State: TypeAlias = Literal["passed", "failed", "open"]

FEWEST_DRAWS = 20
"""A bootstrap over fewer draws, or a fit to times of fewer calls, is surer than it may be."""


@dataclass(frozen=True, kw_only=True)
class Bar:
    """What a measured figure has to reach.

    Attributes:
        measure: the figure's name.
        what: the figure in words.
        side: on which side of ``limit`` it has to lie.
        limit: in the figure's unit.
    """

    measure: str
    what: str
    side: Literal["at least", "at most"]
    limit: float

    def state(self, found: Measure) -> State:
        low, high, limit = found.low, found.high, self.limit
        if self.side == "at most":
            low, high, limit = -high, -low, -limit
        return "passed" if low >= limit else "failed" if high < limit else "open"

    def told(self, found: Measure) -> str:
        return f"{self.what}: {found}, asked {self.side} {self.limit:g} {found.unit}".strip()


@dataclass(frozen=True, kw_only=True)
class Reading:
    """A way to read a claim: ``condition`` completes "holds only if …" and may name measures in braces."""

    condition: str
    bars: tuple[Bar, ...]


@dataclass(frozen=True, kw_only=True)
class Claim:
    """A claim of the paper and all that decides on it.

    Attributes:
        words: the paper's, verbatim but for the markup.
        place: where they stand.
        experiments: those whose figures decide, by name.
        printed: the bars of the paper's own methods and measures.
        otherwise: readings under which it may hold if it does not as printed.
        comment: what the figures show beside the verdict; names measures in braces.
    """

    words: str
    place: str
    experiments: tuple[str, ...]
    printed: tuple[Bar, ...]
    otherwise: tuple[Reading, ...] = ()
    comment: str = ""


@dataclass(frozen=True, kw_only=True)
class Judged:
    """A claim with its verdict.

    Attributes:
        measured: each figure that decides, with its interval and what was asked of it.
        reason: why, with the condition under which the claim holds, and what else the figures show.
        readings: each reading's condition, state, and bars with their measures, as plain values.
    """

    claim: Claim
    verdict: Verdict
    measured: tuple[str, ...]
    reason: str
    readings: tuple[dict[str, Any], ...]

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "claim": self.claim.words,
            "place": self.claim.place,
            "verdict": self.verdict,
            "measured": list(self.measured),
            "reason": self.reason,
            "readings": list(self.readings),
        }


def judge(claim: Claim, measures: Mapping[str, Measure], *, draws: int) -> Judged:
    """The verdict on a claim from measured figures by name, and the fewest draws that one of them rests on."""
    said = {name: str(one) for name, one in measures.items()}
    readings = (Reading(condition="", bars=claim.printed), *claim.otherwise)
    states: list[State] = [_state(reading.bars, measures) for reading in readings]
    verdict, reason = _verdict(readings, states, measures, draws)
    reasons = [text.format_map(said) for text in (reason, claim.comment) if text]
    return Judged(
        claim=claim,
        verdict=verdict,
        measured=tuple(dict.fromkeys(bar.told(measures[bar.measure]) for one in readings for bar in one.bars)),
        reason="; ".join(reasons),
        readings=tuple(
            {"condition": one.condition.format_map(said), "state": state, "bars": _figures(one.bars, measures)}
            for one, state in zip(readings, states, strict=True)
        ),
    )


def _verdict(
    readings: Sequence[Reading], states: Sequence[State], measures: Mapping[str, Measure], draws: int
) -> tuple[Verdict, str]:
    """The verdict and its reason, with measures in braces."""
    if draws < FEWEST_DRAWS:
        return "no verdict", f"{draws} draws are too few for an interval: give {FEWEST_DRAWS} or more"
    if states[0] == "passed":
        return "holds", ""
    conditions = [one.condition for one, state in zip(readings, states, strict=True) if state == "passed"]
    if states[0] == "failed" and conditions:
        return "holds only if", ", or ".join(conditions)
    if "open" in states:
        bars = readings[states.index("open")].bars
        unclear = [bar.what for bar in bars if bar.state(measures[bar.measure]) == "open"]
        return "no verdict", f"the interval reaches to both sides of what is asked ({', '.join(unclear)})"
    return "does not hold", ""


def _state(bars: Sequence[Bar], measures: Mapping[str, Measure]) -> State:
    """Of all bars together."""
    states = [bar.state(measures[bar.measure]) for bar in bars]
    return "failed" if "failed" in states else "open" if "open" in states else "passed"


def _figures(bars: Sequence[Bar], measures: Mapping[str, Measure]) -> list[dict[str, Any]]:
    return [
        {"measure": bar.measure, "what": bar.what, "asked": bar.side, "limit": bar.limit}
        | measures[bar.measure].to_dict()
        for bar in bars
    ]


def markdown(judged: Sequence[Judged]) -> str:
    """The verdicts as a table in Markdown."""
    head = ("the paper says", "measured (95 % interval)", "verdict", "why")
    rows = [
        (f"“{one.claim.words}” ({one.claim.place})", "<br>".join(one.measured), f"**{one.verdict}**", one.reason)
        for one in judged
    ]
    lines = [head, ("---",) * len(head), *rows]
    return "".join(f"| {' | '.join(cell.replace('|', '∣') for cell in line)} |\n" for line in lines)
