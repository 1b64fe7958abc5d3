"""Lines that go on with the figure that a talk is about: steps without a unit, once more, behind a story, none."""

from __future__ import annotations

from typing import Any

import pytest
from conversations import agreed_into, talked_into

pytestmark = pytest.mark.machine_code

POWER_W = "highest total rate with at most 12 W"


@pytest.mark.parametrize(
    ("lines", "power_w"),
    [
        ((POWER_W, "noch mal 4 weniger"), 8.0), ((POWER_W, "add 2 W"), 14.0),
        ((POWER_W, "太低了，加回3瓦"), 15.0), ((POWER_W, "3 W weg"), 9.0),
        ((POWER_W, "减2瓦", "再1瓦"), 9.0),
        ((POWER_W, "halve that limit", "ok too much, make it 9"), 9.0),
        (("highest total rate", "cap the power at 14"), 14.0), ((POWER_W, "lift it to 14"), 14.0),
        ((POWER_W, "lift it by 2 W", "lift it"), 14.0),
    ],
)  # fmt: skip
def test_a_bare_figure_goes_on_with_the_power_that_was_said(lines: tuple[str, ...], power_w: float) -> None:
    assert agreed_into(*lines)[0] == {"max_power_w": pytest.approx(power_w)}


@pytest.mark.parametrize(
    ("lines", "held"),
    [
        (("highest total rate, groups of 2 subcarriers", "make those groups twice as big"),
         {"resource_block_group_size": 4.0}),
        (("highest total rate, user 3 at most 3 Mbit/s", "scratch the cap on 3"), {}),
        ((POWER_W, "die Leistungsgrenze kann weg"), {}),
        ((POWER_W, "plus besoin de la limite de puissance"), {}),
        ((POWER_W, "scratch that, 6 W"), {"max_power_w": 6.0}),
        (("max energy efficiency, the circuit takes 8 W", "2 W less", "another 1"), {"circuit_power_w": 5.0}),
        (("highest total rate, no subcarrier above 900 mW", "100 mW less"), {"subcarrier_max_power_w": 0.8}),
        (("least power, 400 kbit/s each", "user 3 needs only half of that"),
         {"min_rate_bps": {"all": 4e5, "3": 2e5}}),
        (("highest total rate, 250 kbit/s each", "250k was a bit stingy, let's say 400"), {"min_rate_bps": 4e5}),
        (("highest total rate, 250 kbit/s for user 3", "It's 4K, so raise his to 350 please"),
         {"min_rate_bps": {"3": 3.5e5}}),
        (("让最慢的用户尽量快，不服务用户2和用户3", "2回来了，把他加上"), {"leave_out": ("3",)}),
        (("proportional fairness, weight 2 for user 1", "max-min, sans priorités"), {}),
    ],
)  # fmt: skip
def test_a_line_goes_on_with_any_limit(lines: tuple[str, ...], held: dict[str, Any]) -> None:
    assert agreed_into(*lines)[0] == {name: pytest.approx(value) if isinstance(value, float) else value
                                      for name, value in held.items()}  # fmt: skip


@pytest.mark.parametrize(
    ("lines", "held"),
    [
        (("Nutzer 4 braucht 300 kbit/s", "und die 2 auch", "max rate"), {"min_rate_bps": {"4": 3e5, "2": 3e5}}),
        (("user 4 needs 300 kbit/s", "user 2 as well", "no, 200 for 2", "highest total rate"),
         {"min_rate_bps": {"4": 3e5, "2": 2e5}}),
        (("at least 200 kbit/s for everyone", "except user 3", "and at most 12 W", "go for the highest total rate"),
         {"min_rate_bps": {"all": 2e5, "3": 0.0}, "max_power_w": 12.0}),
        (("leave user 4 out", "10 W at most", "what can you do?", "hello", "make it 8", "max-min"),
         {"leave_out": ("4",), "max_power_w": 8.0}),
        (("3号用户至少200k", "4号也一样", "总速率最高"), {"min_rate_bps": {"3": 2e5, "4": 2e5}}),
        (("10 W at most", "no, forget that", "max-min"), {}),
    ],
)  # fmt: skip
def test_limits_that_are_said_before_their_aim_wait_for_it(lines: tuple[str, ...], held: dict[str, Any]) -> None:
    found, turns = talked_into(*lines)
    assert found == held
    assert {turn.intent.kind for turn in turns[:-1]} <= {"clarify", "question", "out_of_scope", "command"}


@pytest.mark.parametrize("said", ["if the surgeon calls, make it 9", "500 was too much"])
def test_what_only_may_be_meant_changes_nothing(said: str) -> None:
    assert agreed_into(POWER_W, said)[0] == {"max_power_w": 12.0}


def test_what_is_said_to_start_over_in_french_is_forgotten() -> None:
    assert agreed_into(POWER_W, "on repart de zéro")[1][-1].stage == "undone"


@pytest.mark.parametrize(
    ("lines", "held"),
    [
        (("highest total rate, leave out user 3", "nor user 4"), {"leave_out": ("3", "4")}),
        (("highest total rate, only users 1 and 2", "plus 4"), {"users": ("1", "2", "4")}),
        (("只服务用户1和2，总速率最高", "再加上4"), {"users": ("1", "2", "4")}),
        (("highest total rate, only users 1 and 2", "no, 1 and 3"), {"users": ("1", "3")}),
        (("highest total rate with 10 W", "at least 500k each", "leave user 3 out", "back to the first"),
         {"max_power_w": 10.0}),
        (("总速率最高，每人最多2兆", "用户3可以到4"), {"max_rate_bps": {"all": 2e6, "3": 4e6}}),
        (("总速率最高，用户2至少1兆", "减半", "用户4和用户2一样"), {"min_rate_bps": {"2": 5e5, "4": 5e5}}),
        (("总速率最高，每人至少250k", "300，不是250"), {"min_rate_bps": 3e5}),
        (("höchste Summenrate, jeder mindestens 300k", "doch lieber 500k"), {"min_rate_bps": 5e5}),
        (("máxima tasa, al menos 500 kbit/s cada uno", "mejor 800 kbit/s"), {"min_rate_bps": 8e5}),
        (("highest total rate", "what if we had 4 W?", "cap the power at 4 W then"), {"max_power_w": 4.0}),
        (("highest total rate", "what if we had 4 W?", "limit power to 5 W?"), {}),
        (("highest total rate, user 4 at least 1 Mbit/s", "half of that for user 2"),
         {"min_rate_bps": {"4": 1e6, "2": 5e5}}),
        (("höchste Gesamtrate, höchstens 14 W", "die Hälfte davon"), {"max_power_w": 7.0}),
        (("highest total rate, 200k each, user 4 at least 800k", "drop user 4's own floor"), {"min_rate_bps": 2e5}),
        (("总速率最高，每人至少200k，用户4至少800k", "用户4的不要了"), {"min_rate_bps": 2e5}),
        (("highest total rate, users 1 and 2 at least 1M", "remove 2's"), {"min_rate_bps": {"1": 1e6}}),
        (("highest total rate, user 3 at least 1 Mbit/s", "sorry, 4, not 3"), {"min_rate_bps": {"4": 1e6}}),
        (("highest total rate", "at least 300k each", "I mean user 3"), {"min_rate_bps": {"3": 3e5}}),
        (("proportional fairness", "user 3 weight 4", "make all weights equal"), {}),
        (("highest total rate", "user 3 at least 1M", "raise it to 2M", "nah, undo the raise"),
         {"min_rate_bps": {"3": 1e6}}),
        (("débit total maximal", "au moins 200k chacun", "10 W au plus", "annule les deux derniers changements"), {}),
    ],
)  # fmt: skip
def test_a_line_that_revises_what_was_said_changes_just_that(lines: tuple[str, ...], held: dict[str, Any]) -> None:
    assert agreed_into(*lines)[0] == {name: pytest.approx(value) if isinstance(value, float) else value
                                      for name, value in held.items()}  # fmt: skip


@pytest.mark.parametrize(
    "said",
    [
        "never drop the power limit", "do not remove the power limit", "don't forget the power limit",
        "lass die Leistungsgrenze nicht weg", "no quites el límite de potencia", "不要取消功率上限",
        "do not push it up to 9 W", "please don't drop the limit to 5 W", "dreh nicht auf 20 W auf",
        "ne monte pas la limite à 15 W", "no subas el límite a 15 W", "不要把上限降到5瓦",
    ],
)  # fmt: skip
def test_a_change_that_is_denied_is_not_made(said: str) -> None:
    assert talked_into(POWER_W, said)[0] == {"max_power_w": 12.0}


@pytest.mark.parametrize(
    "said",
    [
        "the cap on power is gone",
        "the power limit no longer applies",
        "we can do away with the power limit",
        "die Leistungsgrenze entfällt",
        "le plafond de puissance saute",
        "功率上限不算了",
    ],
)
def test_a_limit_goes_in_the_words_of_each_language(said: str) -> None:
    assert agreed_into(POWER_W, said)[0] == {}


BOTH_RATES = "highest total rate, at least 100 kbit/s each, at most 3 Mbit/s each"
CAPPED_BUT_2 = dict.fromkeys("134", 3e6)
"""Everybody's ceiling but user 2's."""


@pytest.mark.parametrize(
    "said",
    [
        "lift the speed limit for user 2",
        "heb die Geschwindigkeitsgrenze für Nutzer 2 auf",
        "enlève la limite de débit de l'utilisateur 2", "quita el límite de velocidad del usuario 2", "取消用户2的限速",
    ],
)  # fmt: skip
def test_a_limit_that_goes_for_a_user_is_the_one_that_is_named(said: str) -> None:
    assert agreed_into(BOTH_RATES, said)[0] == {"min_rate_bps": 1e5, "max_rate_bps": CAPPED_BUT_2}


@pytest.mark.parametrize(
    ("lines", "held"),
    [
        ((POWER_W, "a bit less... no, a third less power"), {"max_power_w": 8.0}),
        ((POWER_W, "un peu moins de puissance"), {"max_power_w": 12.0}),
        (("highest total rate", "max energy efficiency, at most 6 W", "halve the power"), {"max_power_w": 3.0}),
        ((POWER_W, "forget the cap", "nah, put the cap back"), {"max_power_w": 12.0}),
        ((POWER_W, "leave out 3 and 4", "bring 3 back"), {"max_power_w": 12.0, "leave_out": ("4",)}),
        (("least power, 200k each", "user 3 at least 1M", "treat user 3 like the others again"), {"min_rate_bps": 2e5}),
        (("least power, 200k each", "user 4 is far out, 100k is enough there"),
         {"min_rate_bps": {"all": 2e5, "4": 1e5}}),
        (("least power, users 1, 2 and 3 at least 700k", "halve it for 1 and 3"),
         {"min_rate_bps": {"1": 3.5e5, "2": 7e5, "3": 3.5e5}}),
        (("proportional fairness, outage at most 5 %", "make that two percent"), {"outage_probability": 0.02}),
        (("比例公平，中断概率不超过5%", "太宽了，改成1%"), {"outage_probability": 0.01}),
        (("proportional fairness, user 3 counts double", "and triple, not double"), {"weights": {"3": 3.0}}),
        (("proportional fairness, no subcarrier over 0.5 W", "total power 9 watts"),
         {"subcarrier_max_power_w": 0.5, "max_power_w": 9.0}),
        (("la máxima velocidad total, 10 W como máximo", "sin el usuario 4", "vuelve a poner al 4"),
         {"max_power_w": 10.0}),
        (("le moins de puissance, 500 kbit/s pour chacun", "pour le 4, 900k"),
         {"min_rate_bps": {"all": 5e5, "4": 9e5}}),
    ],
)  # fmt: skip
def test_a_line_is_of_what_the_talk_is_about(lines: tuple[str, ...], held: dict[str, Any]) -> None:
    assert agreed_into(*lines)[0] == {name: pytest.approx(value) if isinstance(value, float) else value
                                      for name, value in held.items()}  # fmt: skip
