"""Answers in words: the figures that were computed, in both languages, for every topic; and the glossary."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from questions import answer

import wirelessagent as wa
from wirelessagent import plugins
from wirelessagent.deciding.objectives.max_rate import MaxRate
from wirelessagent.model.phrases import phrases
from wirelessagent.model.units import human, percent
from wirelessagent.telling import glossary
from wirelessagent.telling.catalogue import called, message
from wirelessagent.telling.explanation import explain
from wirelessagent.telling.facts.accounts import account
from wirelessagent.telling.facts.case import Case, certificate
from wirelessagent.telling.facts.nearest import nearest
from wirelessagent.telling.facts.steps import power_step, rate_step

CELL = wa.Cell(max_power_w=20)
SCENE = wa.simulate("rayleigh", CELL, num_users=4, num_subcarriers=8, seed=6)
SEEN = wa.repair(SCENE.observe(wa.loss.random(0.3), seed=4))
LANGUAGES = ("en", "zh")


def case_of(objective: Any, estimate: wa.ChannelEstimate = SEEN, method: str | None = None, **constraints: Any) -> Case:
    problem = wa.Problem(objective, **{"max_power_w": 10.0, **constraints})
    return Case(decision=wa.decide(estimate, problem, CELL, method), estimate=estimate, method=method)


def told(case: Case, topic: str, language: str = "en", user: int | None = None, **figures: float) -> str:
    found = answer(case, topic, language, user, **figures)
    assert any("\u4e00" <= sign <= "\u9fff" for sign in found[0]) == (language == "zh") or not found[0]
    return found[0]


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_user_who_gets_nothing_is_told_why_and_what_would_help(language: str) -> None:
    case = case_of("max_rate")
    user = int(np.flatnonzero(case.decision.rate_bps <= 0)[0])
    found = account(case, user)
    said = told(case, "why_user", language, user)
    loss = found.losses[0]
    for figure in (f"{loss.behind_db:.1f} dB", "100 kbit/s", called(language, SEEN.user_names[loss.winner])):
        assert figure in said
    assert (f"subcarrier {loss.first + 1}," if language == "en" else f"{loss.first + 1} 号子载波，") in said
    assert found.promise is not None
    assert human(abs(found.promise.change), "bit/s") in said


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_standing_has_its_sentence(language: str) -> None:
    cases = {
        "left_out": (case_of("max_rate", users=("user 1", "user 2", "user 3")), 3),
        "no_promise": (case_of("min_power", min_rate_bps=(1e5, 0, 0, 0)), 2),
        "no_weight": (case_of("max_rate", weights=(1, 1, 1, 0)), 3),
        "nothing_decided": (case_of("max_rate", min_rate_bps=1e9), 0),
        "served": (case_of("max_min_rate", min_rate_bps=1e5), 1),
    }
    said = {name: told(case, "why_user", language, user) for name, (case, user) in cases.items()}
    assert len(set(said.values())) == len(said)
    for name, (_, user) in cases.items():
        assert called(language, SEEN.user_names[user]) in said[name].replace("User", "user")
        assert "{" not in said[name]


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_step_is_told(language: str) -> None:
    case = case_of("max_rate")
    step = power_step(case, 15.0)
    assert step is not None
    said = told(case, "step", language, power_w=15.0)
    for figure in ("25 W", "10 W", human(step.change, "bit/s"), "20 W",
                   percent(step.change / case.decision.value)):  # fmt: skip
        assert figure in said
    assert "10 W" in told(case, "step", language, power_w=-10.0)
    least = case_of("min_power", min_rate_bps=3e5)
    more = rate_step(least, 1e5, 2)
    assert human(more.change, "W") in told(least, "step", language, 2, rate_bps=1e5)
    assert human(least.decision.total_power_w, "W") in told(least, "step", language, power_w=1.0)
    no_longer = told(least, "step", language, rate_bps=1e9)
    assert "1 Gbit/s" in no_longer
    never = case_of("max_rate", min_rate_bps=1e9)
    assert human(11, "W") in told(never, "step", language, power_w=1.0)
    tight = case_of("min_power", min_rate_bps=1e6, max_power_w=0.1)
    assert not tight.decision.is_usable
    assert "20.1 W" in told(tight, "step", language, power_w=20.0)


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_cannot_be_met_is_told_with_what_can(language: str) -> None:
    case = case_of("min_power", min_rate_bps=3e6, max_power_w=0.5)
    found = nearest(case)
    assert found.more_power is not None
    assert found.lower_rates is not None
    assert found.fewer_users is not None
    assert case.decision.needed_power_w is not None
    for topic in ("why_infeasible", "prices", "certificate"):
        said = told(case, topic, language)
        for figure in (human(case.decision.needed_power_w.at_least, "W"), human(found.more_power.power_w, "W"),
                       human(found.lower_rates.factor * 3e6, "bit/s")):  # fmt: skip
            assert figure in said
        assert all(called(language, SEEN.user_names[user]) in said for user in found.fewer_users.left_out)
        assert len(said.splitlines()) == 4
    assert human(case_of("max_rate").decision.value, "bit/s") in told(case_of("max_rate"), "why_infeasible", language)
    beyond = told(case_of("max_rate", min_rate_bps=3e7), "why_infeasible", language)
    assert "1 MW" in beyond
    assert "e+" not in beyond


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_certificate_says_how_it_is_proven_and_what_is_left(language: str) -> None:
    case = case_of("min_power", min_rate_bps=1e6)
    found = certificate(case)
    said = told(case, "certificate", language)
    assert found.left == abs(case.decision.value - case.decision.bound)
    assert human(case.decision.bound, "W") in said
    if case.decision.status != "optimal":
        assert human(found.left, "W") in said
    assert str(int(SEEN.repaired.sum())) in said
    assert certificate(case_of("max_rate")).proof == "closed_form"
    unproven = case_of("max_rate", method="equal_power", min_rate_bps=1e3)
    if np.isnan(unproven.decision.bound):
        assert certificate(unproven).by == "dual"
    promised = case_of("max_min_rate", outage_probability=0.05)
    assert "95 %" in told(promised, "certificate", language)


@pytest.mark.parametrize("language", LANGUAGES)
def test_how_sure_it_is_comes_from_the_posterior(language: str) -> None:
    case = case_of("max_min_rate")
    said = told(case, "uncertainty", language)
    forecast = case.decision.forecast
    assert forecast is not None
    kept = forecast.carried[case.decision.committed_bps > 0].min()
    assert f"{100 * kept:.3g} %" in said
    assert f"{int(SEEN.repaired.sum())}" in said
    assert human(forecast.sum_high_bps, "bit/s") in said
    sure = case_of("max_rate", wa.perfect(SCENE))
    assert told(sure, "uncertainty", language) == message(language, "certainty.all_known")


@pytest.mark.parametrize("language", LANGUAGES)
def test_prices_are_tabled(language: str) -> None:
    case = case_of("max_rate", min_rate_bps=4e5)
    found = answer(case, "prices", language)
    assert human(case.decision.price_of_power, "bit/s") in found[0]
    (promises,) = found[1]
    assert [row[0] for row in promises.rows] == [called(language, name) for name in SEEN.user_names]
    assert promises.rows[0][3] == human(float(case.decision.price_of_rate[0]) * 1e5, "bit/s")
    users = answer(case, "users", language)
    assert len(users[1]) == 1
    assert answer(case, "other", language)[0] == "\n".join(explain(SEEN, wa.report(case.decision), language=language))


def test_terms_are_found_as_people_say_them() -> None:
    for asked, start in (
        ("What is PF?", "proportional_fairness:"),
        ("explain max-min fairness to me", "max_min_rate:"),
        ("what does the price of power mean?", "The price of power"),
        ("What are subcarriers?", "A subcarrier"),
        ("can you explain what bits per joule means?", "max_energy_efficiency:"),
        ("how many dBm is that", "dB is"),
        ("what's an outage probability", "The outage probability"),
    ):
        assert glossary.explained(asked, "en").startswith(start), asked
        assert "\n" not in glossary.explained(asked, "en")
    for asked, start in (
        ("什么是注水法？", "注水法"),
        ("能效是什么意思", "能效："),
        ("差距是什么", "界"),
    ):
        assert glossary.explained(asked, "zh").startswith(start), asked
    for language, asked, start in (
        ("de", "Was ist eine Schranke?", "Die Schranke"),
        ("de", "was bedeutet Gesamtrate", "die höchste Gesamtrate: Die größte Summe"),
        ("es", "¿Qué es una subportadora?", "Una subportadora"),
        ("es", "¿qué significa interrupción?", "La probabilidad de interrupción"),
        ("fr", "Qu’est-ce que l’écart ?", "La borne"),
        ("fr", "que signifie krigeage ?", "La réparation"),
    ):
        assert glossary.explained(asked, language).startswith(start), asked
    assert glossary.explained("les canaux écartés", "fr") == "", "écart is no part of another word"
    assert glossary.explained("what is the weather like", "en") == ""
    assert glossary.explained("once again upfront", "en") == ""


def test_every_term_is_found_by_each_of_its_names_and_told_in_both_languages() -> None:
    for entry in glossary.entries():
        assert any("\u4e00" <= sign <= "\u9fff" for sign in entry.told("zh"))
        for name in entry.names:
            assert entry.told("en") in glossary.explained(name, "en"), name


@dataclass(frozen=True, kw_only=True)
class Alpha(MaxRate):
    """Shares by the alpha of Mo and Walrand."""

    name = "alpha_share"
    phrases = phrases(en=["share alpha-fairly"], zh=["α公平"])


def test_a_plugged_in_objective_tells_of_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    mine = plugins.Plugin(kind="objective", name="alpha_share", package="mine", target="mine:Alpha", cls=Alpha)
    broken = plugins.Plugin(kind="objective", name="no", package="no", target="no", cls=None, error="gone")
    monkeypatch.setattr(plugins, "plugins", lambda _kind: [mine, broken])
    for asked in ("what is alpha share?", "what does share alpha-fairly mean", "α公平是什么"):
        assert "Shares by the alpha of Mo and Walrand." in glossary.explained(asked, "zh")
