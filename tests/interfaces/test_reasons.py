"""Why nothing was found: the limit that is the cause, in figures that people can read, the same wherever it is told."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.agent.session import ask
from wirelessagent.model.decision import Bracket
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import called
from wirelessagent.telling.explanation import certificate_line, explain
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.facts.nearest import nearest, shortage_of
from wirelessagent.telling.margins import Remedies
from wirelessagent.telling.parts import reason_in_words
from wirelessagent.telling.report import figures_of_infeasibility, side_by_side

CELL = wa.Cell(max_power_w=20)
SCENE = wa.simulate("rayleigh", CELL, num_users=4, num_subcarriers=8, seed=6)
SEEN = wa.repair(SCENE.observe(wa.loss.random(0.3), seed=4))
LANGUAGES = ("en", "zh")


def decided(cell: wa.Cell = CELL, **problem: Any) -> wa.Decision:
    found = wa.decide(SEEN, wa.Problem("min_power", **problem), cell)
    assert found.status == "infeasible"
    return found


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("outage", [None, 0.05])
def test_more_power_than_any_cell_has_is_told_alike_everywhere(language: str, outage: float | None) -> None:
    run = ask("Least power with 100 Mbit/s for each user", SCENE, wa.loss.random(0.3), seed=4)
    decision = decided(min_rate_bps=1e8, outage_probability=outage)
    assert decision.needed_power_w is not None
    assert decision.needed_power_w.at_least > 1e6
    case = Case(decision=decision, estimate=SEEN)
    everywhere = [
        certificate_line(decision, language),
        *explain(SEEN, wa.report(decision), language=language),
        Remedies(case, language).told(nearest(case)),
        figures_of_infeasibility(decision, language).rows[0][1],
        next(row[1] for row in side_by_side([("", run.report)], language).rows if row[1].endswith("1 MW")),
    ]
    assert [told for told in everywhere if "1 MW" not in told] == []
    assert not any(sign in "".join(everywhere) for sign in ("e+", "GW", "inf W"))


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_limit_on_each_subcarrier_is_named_as_the_cause(language: str) -> None:
    decision = decided(min_rate_bps=3e6, subcarrier_max_power_w=1e-3)
    said = reason_in_words(decision, language)
    assert "1 mW" in said
    assert "3 Mbit/s" in said
    assert "20 W" not in said
    assert "inf W" not in "".join(figures_of_infeasibility(decision, language).rows[0])
    linked = reason_in_words(decided(replace(CELL, max_spectral_efficiency_bps_per_hz=2.0), min_rate_bps=3e6), language)
    assert "2 bit/s/Hz" in linked


def test_the_total_that_the_limits_allow_is_the_cause_where_the_rates_need_more() -> None:
    short = decided(min_rate_bps=3e6, subcarrier_max_power_w=1e-3)
    alone = replace(short, estimate=None, needed_power_w=Bracket(at_least=2.0, at_most=np.nan))
    assert "no more than 8 mW can be radiated in all" in reason_in_words(alone, "en")
    assert "总共最多只能发射 8 mW" in reason_in_words(alone, "zh")


@pytest.mark.parametrize("language", LANGUAGES)
def test_too_few_subcarriers_are_the_cause_with_their_number(language: str) -> None:
    decision = decided(min_rate_bps=1e5, resource_block_group_size=4)
    said = reason_in_words(decision, language)
    short = shortage_of(decision)
    assert short is not None
    assert (short.kind, short.users, short.served, short.places) == ("too_few", 4, 2, 2)
    assert all(figure in said for figure in ("4", "2"))


def test_shortages_are_those_that_prove_it() -> None:
    """Each kind against the decision's own proof, which counts likewise."""
    capped = decided(min_rate_bps=3e6, subcarrier_max_power_w=1e-3)
    one = shortage_of(capped)
    assert one is not None
    assert one.kind == "one_user"
    assert human(one.most_bps, "bit/s") in capped.reason
    link = replace(CELL, max_spectral_efficiency_bps_per_hz=2.0)
    together = decided(link, min_rate_bps=1e6)
    found = shortage_of(together)
    assert found is not None
    assert found.kind == "together"
    assert found.most_bps == pytest.approx(8 * 2.0 * CELL.data_bandwidth_hz)
    assert human(found.most_bps, "bit/s") in together.reason
    takes = shortage_of(decided(link, min_rate_bps=(1.5e6, 1e5, 1e5, 5e5)))
    assert takes is not None
    assert (takes.kind, takes.needed, takes.places) == ("places", 9, 8)
    assert shortage_of(decided(min_rate_bps=1e8)) is None


@pytest.mark.parametrize("outage", [None, 0.05])
def test_lower_rates_are_found_whatever_is_known_of_them(outage: float | None) -> None:
    case = Case(decision=decided(min_rate_bps=1e8, outage_probability=outage), estimate=SEEN)
    lower = nearest(case).lower_rates
    assert lower is not None
    assert np.all(lower.decision.rate_bps >= 1e8 * lower.factor * (1 - 1e-9))
    best = wa.decide(SEEN, wa.Problem("max_min_rate", outage_probability=outage), CELL)
    assert 1e8 * lower.factor == pytest.approx(best.value, rel=0.02)


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_limit_without_which_it_can_be_met_is_offered(language: str) -> None:
    for limit in ({"subcarrier_max_power_w": 1e-3}, {"resource_block_group_size": 4}):
        decision = decided(min_rate_bps=1e5, **limit)
        case = Case(decision=decision, estimate=SEEN)
        found = nearest(case).without_limits
        assert [one.limit for one in found] == list(limit)
        free = wa.decide(SEEN, wa.Problem("min_power", min_rate_bps=1e5), CELL)
        assert found[0].decision.value == pytest.approx(free.value, rel=1e-6)
        assert human(free.value, "W") in Remedies(case, language).told(nearest(case))


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_is_open_is_told_with_how_far_it_came(language: str) -> None:
    decision = wa.decide(SEEN, wa.Problem("max_rate", min_rate_bps=6e5, max_power_w=10.0), CELL, "equal_power")
    assert decision.status == "undecided"
    assert decision.needed_power_w is not None
    said = reason_in_words(decision, language)
    assert human(decision.needed_power_w.at_least, "W") in said
    assert "10 W" in said


def test_more_power_is_offered_where_promises_need_a_little_to_spare() -> None:
    """Promises on uncertain gains are seldom found with exactly the least power that carries them."""
    decision = wa.decide(SEEN, wa.Problem("max_rate", min_rate_bps=1e6, max_power_w=1.0, outage_probability=0.05), CELL)
    assert decision.status == "infeasible"
    more = nearest(Case(decision=decision, estimate=SEEN)).more_power
    least = wa.decide(SEEN, wa.Problem("min_power", min_rate_bps=1e6, outage_probability=0.05), CELL)
    assert more is not None
    assert least.value <= more.power_w <= 1.2001 * least.value
    assert more.decision.is_usable
    assert np.all(more.decision.rate_bps >= 1e6 * (1 - 1e-9))


@pytest.mark.parametrize(("language", "told"), [("en", "for {} alone"), ("zh", "只服务{}")])
def test_who_can_be_served_is_named_where_most_are_left_out(language: str, told: str) -> None:
    case = Case(decision=decided(min_rate_bps=8e6, max_power_w=8.0), estimate=SEEN)
    found = nearest(case)
    assert found.fewer_users is not None
    assert len(found.fewer_users.left_out) == 3
    (kept,) = set(range(4)) - set(found.fewer_users.left_out)
    assert told.format(called(language, SEEN.user_names[kept])) in Remedies(case, language).told(found)


@pytest.mark.parametrize("language", LANGUAGES)
def test_figures_that_say_nothing_are_left_out(language: str) -> None:
    run = ask("Least power with 100 Mbit/s for each user", SCENE, wa.loss.random(0.3), seed=4)
    assert all(set(row[1:]) != {"–"} for row in side_by_side([("a", run.report), ("b", run.report)], language).rows)
