"""Who has what, in words that agree with the allocation."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.model.units import human
from wirelessagent.telling.catalogue import called
from wirelessagent.telling.facts.case import Case
from wirelessagent.telling.roster import Roster

CELL = wa.Cell(max_power_w=20)
SCENE = wa.simulate("rayleigh", CELL, num_users=5, num_subcarriers=16, seed=6)
SEEN = wa.repair(SCENE.observe(wa.loss.random(0.3), seed=4))
LANGUAGES = ("en", "zh")


def case_of(objective: Any, **constraints: Any) -> Case:
    problem = wa.Problem(objective, **{"max_power_w": 10.0, **constraints})
    return Case(decision=wa.decide(SEEN, problem, CELL), estimate=SEEN)


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("rank", ["least", "most"])
def test_the_first_is_named_with_its_figure(rank: str, language: str) -> None:
    case = case_of("proportional_fairness")
    rates = case.decision.rate_bps
    user = int(np.argmin(rates) if rank == "least" else np.argmax(rates))
    said = Roster(case, language).rank(rank, "rate")
    assert said.lower().startswith(called(language, SEEN.user_names[user]))
    assert human(float(rates[user]), "bit/s") in said
    power = np.array([case.decision.power_w[case.decision.owner == one].sum() for one in range(5)])
    most = Roster(case, language).rank("most", "power")
    assert most.lower().startswith(called(language, SEEN.user_names[int(np.argmax(power))]))
    assert human(float(power.max()), "W") in most


@pytest.mark.parametrize("language", LANGUAGES)
def test_those_who_get_nothing_are_named_apart_from_the_least(language: str) -> None:
    case = case_of("max_rate", users=("user 1", "user 2", "user 3", "user 4"))
    rates = case.decision.rate_bps
    served = np.flatnonzero(rates > 0)
    assert 0 < served.size < 4
    said = Roster(case, language).rank("least", "rate")
    nothing, others = re.split("[.。]", said)[:2]
    named = {int(number) - 1 for number in re.findall(r"\d+", nothing)}
    assert named == set(range(4)) - set(served.tolist())
    assert called(language, SEEN.user_names[int(served[np.argmin(rates[served])])]) in others
    assert "720" not in Roster(case_of("min_power", min_rate_bps=1e5), language).rank("least", "rate")


@pytest.mark.parametrize("language", LANGUAGES)
def test_subcarriers_are_listed_from_one(language: str) -> None:
    case = case_of("proportional_fairness")
    owner = case.decision.owner
    for user in range(5):
        said = Roster(case, language).subcarriers(user)
        places = said.split(":" if language == "en" else "：")[1].split("(" if language == "en" else "（")[0]
        listed = [place for part in re.findall(r"\d+(?:–\d+)?", places) for place in _spread(part)]
        assert listed == (np.flatnonzero((owner == user) & (case.decision.power_w > 0)) + 1).tolist()
    everybody = Roster(case, language).subcarriers(None)
    assert all(called(language, name) in everybody for name in SEEN.user_names)
    assert called(language, SEEN.user_names[int(owner[4])]) in Roster(case, language).owner(5)
    assert "16" in Roster(case, language).owner(17)


def _spread(part: str) -> range:
    first, _, last = part.partition("–")
    return range(int(first), int(last or first) + 1)
