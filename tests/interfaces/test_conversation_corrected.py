"""Lines that correct, swap, share, except, repeat and drop by what holds, in five languages."""

from __future__ import annotations

from typing import Any

import pytest
from conversations import agreed_into

pytestmark = pytest.mark.machine_code

Talks = list[tuple[tuple[str, ...], dict[str, Any]]]
EN, DE, ES = "highest total rate", "höchste Gesamtrate", "máxima tasa total"
FR, ZH = "débit total maximal", "总速率最高"

FIGURES: Talks = [
    ((f"{EN}, at most 12 W", "leave user 3 out", "the 12 should be 9"), {"max_power_w": 9.0, "leave_out": ("3",)}),
    ((f"{ES}, 12 W como máximo", "sin el usuario 3", "12 no, 9 W"), {"max_power_w": 9.0, "leave_out": ("3",)}),
    ((f"{FR}, 12 W au plus", "j'ai dit 12 mais je voulais dire 9"), {"max_power_w": 9.0}),
    ((f"{ZH}，最多12瓦", "不服务3号", "12改成9吧"), {"max_power_w": 9.0, "leave_out": ("3",)}),
]
USERS: Talks = [
    (
        (EN, "user 2 at least 1 Mbit/s", "everyone else 300k", "sorry, user 4 is the one in the call, not 2"),
        {"min_rate_bps": {"4": 1e6, "all": 3e5}},
    ),
    ((EN, "leave users 2 and 3 out", "I said 3 but meant 4"), {"leave_out": ("2", "4")}),
    (
        (DE, "Nutzer 2 mindestens 1 Mbit/s", "die anderen 300 kbit/s", "halt, nicht Nutzer 2, sondern Nutzer 4"),
        {"min_rate_bps": {"4": 1e6, "all": 3e5}},
    ),
    (
        (ES, "el usuario 2 al menos 1 Mbit/s", "los demás 300 kbit/s", "perdona, no es el 2 sino el 4"),
        {"min_rate_bps": {"4": 1e6, "all": 3e5}},
    ),
]
SWAPS: Talks = [
    (
        (EN, "user 2 at least 1 Mbit/s", "user 4 at least 500k", "oh, it is the other way around"),
        {"min_rate_bps": {"2": 5e5, "4": 1e6}},
    ),
    (
        (DE, "Nutzer 2 mindestens 1 Mbit/s", "Nutzer 4 mindestens 500k", "genau andersherum, bitte tauschen"),
        {"min_rate_bps": {"2": 5e5, "4": 1e6}},
    ),
    (
        (ES, "el usuario 2 al menos 1 Mbit/s", "el usuario 4 al menos 500k", "es justo al revés, intercámbialos"),
        {"min_rate_bps": {"2": 5e5, "4": 1e6}},
    ),
    (
        (FR, "au moins 1 Mbit/s pour l'utilisateur 2", "au moins 500k pour l'utilisateur 4", "échange-les"),
        {"min_rate_bps": {"2": 5e5, "4": 1e6}},
    ),
    ((ZH, "2号至少1 Mbps", "4号至少500 kbps", "弄反了，把他们俩对调一下"), {"min_rate_bps": {"2": 5e5, "4": 1e6}}),
]
OF_ANOTHER: Talks = [
    (
        (EN, "user 2 at least 1 Mbit/s", "user 4 should get half as much as user 2"),
        {"min_rate_bps": {"2": 1e6, "4": 5e5}},
    ),
    ((f"{EN}, 300k each", "give 4 twice what the others get"), {"min_rate_bps": {"all": 3e5, "4": 6e5}}),
    (
        (DE, "Nutzer 2 mindestens 1 Mbit/s", "Nutzer 4 soll halb so viel wie Nutzer 2 bekommen"),
        {"min_rate_bps": {"2": 1e6, "4": 5e5}},
    ),
    (
        (ES, "el usuario 2 al menos 1 Mbit/s", "al 4 dale la mitad de lo que tiene el 2"),
        {"min_rate_bps": {"2": 1e6, "4": 5e5}},
    ),
    (
        (FR, "au moins 1 Mbit/s pour l'utilisateur 2", "le 4 reçoit la moitié de ce que reçoit le 2"),
        {"min_rate_bps": {"2": 1e6, "4": 5e5}},
    ),
    ((ZH, "2号至少1 Mbps", "4号只要2号的一半就够"), {"min_rate_bps": {"2": 1e6, "4": 5e5}}),
    ((EN, "users 2, 3 and 4 at least 1 Mbit/s", "double all three"), {"min_rate_bps": {"2": 2e6, "3": 2e6, "4": 2e6}}),
    ((DE, "Nutzer 2 und 4 mindestens 1 Mbit/s", "beide um 50 % rauf"), {"min_rate_bps": {"2": 1.5e6, "4": 1.5e6}}),
]
EXCEPTIONS: Talks = [
    (
        (f"{EN}, nobody over 4 Mbit/s", "user 2 is allowed 6 Mbit/s"),
        {"max_rate_bps": {"all": 4e6, "2": 6e6}},
    ),
    ((f"{DE}, keiner über 4 Mbit/s", "Nutzer 2 darf bis 6 Mbit/s"), {"max_rate_bps": {"all": 4e6, "2": 6e6}}),
    (
        (f"{ES}, nadie por encima de 4 Mbit/s", "salvo el 2, 6 Mbit/s para él"),
        {"max_rate_bps": {"all": 4e6, "2": 6e6}},
    ),
    (
        (f"{FR}, personne au-dessus de 4 Mbit/s", "sauf le 2, 6 Mbit/s pour lui"),
        {"max_rate_bps": {"all": 4e6, "2": 6e6}},
    ),
    ((f"{ZH}，谁都不许超过4 Mbps", "2号可以放到6 Mbps"), {"max_rate_bps": {"all": 4e6, "2": 6e6}}),
    ((f"{ZH}，中断概率不超过1%", "太严了，放松到3%"), {"outage_probability": 0.03}),
]
AGAIN: Talks = [
    ((f"{EN}, at most 10 W", "power down 20 %", "another 20 % down"), {"max_power_w": 6.4}),
    ((f"{ZH}，最多10瓦", "功率降一成", "再降一成"), {"max_power_w": 8.1}),
    (
        (f"{DE}, höchstens 10 W", "jetzt 8 W", "dann 6 W", "rückgängig", "noch einen Schritt zurück"),
        {"max_power_w": 10.0},
    ),
    ((f"{ES}, 10 W como máximo", "ahora 8 W", "ahora 6 W", "deshaz", "otro paso atrás"), {"max_power_w": 10.0}),
    (
        (f"{FR}, 10 W au plus", "maintenant 8 W", "maintenant 6 W", "annule", "encore un pas en arrière"),
        {"max_power_w": 10.0},
    ),
]
DROPPED: Talks = [
    ((f"{EN}, at most 10 W, 1 Mbit/s each", "get rid of the minimum rate", "and the power cap"), {}),
    (
        (
            "Please do proportional fairness, user 2 counts double",
            "user 4 as well",
            "forget the weights, they all count the same",
        ),
        {},
    ),
]
TOGETHER: Talks = [
    ((FR, "sans l'utilisateur 3", "remets le 3 et retire le 4"), {"leave_out": ("4",)}),
    ((ZH, "只服务1号和2号", "加上4号，去掉1号"), {"users": ("2", "4")}),
]


@pytest.mark.parametrize(
    ("lines", "held"), [*FIGURES, *USERS, *SWAPS, *OF_ANOTHER, *EXCEPTIONS, *AGAIN, *DROPPED, *TOGETHER]
)
def test_a_line_is_read_by_what_holds(lines: tuple[str, ...], held: dict[str, Any]) -> None:
    found, _ = agreed_into(*lines)
    wanted = {name: pytest.approx(value) if isinstance(value, float | dict) else value for name, value in held.items()}
    assert found == wanted


@pytest.mark.parametrize(
    "said",
    ["don't swap them", "user 2 used to have half of what user 4 has", "why not drop user 2?", "bitte nicht halbieren"],
)
def test_what_is_no_order_changes_nothing(said: str) -> None:
    held, _ = agreed_into(EN, "user 2 at least 1 Mbit/s", "user 4 at least 500k", said)
    assert held == {"min_rate_bps": {"2": 1e6, "4": 5e5}}
