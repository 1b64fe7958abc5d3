"""How engineers write users, figures and units in one line; each was once read as something else."""

from __future__ import annotations

from typing import Any

import pytest

from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context

CELL = Context(user_names=tuple(f"user {number}" for number in range(1, 9)), max_power_w=20.0)


def each(figure: float, *users: str) -> dict[str, float]:
    return dict.fromkeys(users, figure)


@pytest.mark.parametrize(
    ("text", "constraints"),
    [
        ("Highest total rate, exclude users 6,7,8", {"leave_out": ("6", "7", "8")}),
        ("max rate, leave out 3,5", {"leave_out": ("3", "5")}),
        ("Least power, users 1,2: 500 kbit/s", {"min_rate_bps": each(5e5, "1", "2")}),
        ("sum rate, users 1,3-5 at least 200 kbit/s", {"min_rate_bps": each(2e5, "1", "3", "4", "5")}),
        ("least power, users 1,2,3 at 1,2 Mbit/s", {"min_rate_bps": each(1.2e6, "1", "2", "3")}),
        ("max sum rate, users 1,5 Mbit/s each", {"min_rate_bps": 1.5e6}),
        ("max sum rate, 1,5 Mbit/s für Nutzer 3", {"min_rate_bps": each(1.5e6, "3")}),
        ("总速率最大，用户1,2,3至少1 Mbit/s", {"min_rate_bps": each(1e6, "1", "2", "3")}),
        ("Maximise la tasa total sin los usuarios 3,4", {"leave_out": ("3", "4")}),
    ],
)
def test_lists_without_spaces(text: str, constraints: dict[str, Any]) -> None:
    assert OfflineRecogniser().recognise(text, CELL).constraints == constraints


@pytest.mark.parametrize(
    ("text", "constraints"),
    [
        ("users [1,2,3] >= 2 Mbps, min power", {"min_rate_bps": each(2e6, "1", "2", "3")}),
        ("sum rate, users (1, 2, 3) at least 1 Mbps", {"min_rate_bps": each(1e6, "1", "2", "3")}),
        ("users {4, 5} at most 2 Mbps, 12 W, sum rate", {"max_rate_bps": each(2e6, "4", "5"), "max_power_w": 12.0}),
        ("users 1, 2: 1 Mbps, 3, 4: 3 Mbps, sum rate", {"min_rate_bps": each(1e6, "1", "2") | each(3e6, "3", "4")}),
        ("sum rate, users: 1, 2, 3", {"users": ("1", "2", "3")}),
        ("u1..u4 >= 1 Mbps, sum rate", {"min_rate_bps": each(1e6, "1", "2", "3", "4")}),
        ("sum rate, R1..R4 >= 1 Mbps", {"min_rate_bps": each(1e6, "1", "2", "3", "4")}),
        ("sum rate, user 1..3 at least 1 Mbps", {"min_rate_bps": each(1e6, "1", "2", "3")}),
        ("sum rate, cap users 1 to 3 to 2 Mbps", {"max_rate_bps": each(2e6, "1", "2", "3")}),
        ("débit total maximal, plafonne les usagers 1 à 3 à 2 Mbit/s", {"max_rate_bps": each(2e6, "1", "2", "3")}),
    ],
)
def test_brackets_colons_and_dots(text: str, constraints: dict[str, Any]) -> None:
    assert OfflineRecogniser().recognise(text, CELL).constraints == constraints


@pytest.mark.parametrize(
    ("text", "users"),
    [
        ("sum rate, first four users at least 1 Mbps", ("1", "2", "3", "4")),
        ("Les quatre premiers utilisateurs au moins 1 Mbit/s, débit total maximal", ("1", "2", "3", "4")),
        ("Los cuatro primeros usuarios al menos 1 Mbps, tasa total máxima", ("1", "2", "3", "4")),
        ("sum rate, the last two users at least 1 Mbps", ("7", "8")),
        ("Nutzer mit ungerader Nummer mindestens 1 Mbit/s, Summenrate maximieren", ("1", "3", "5", "7")),
        ("Nutzer 5 und höher mindestens 1 Mbit/s, Summenrate maximieren", ("5", "6", "7", "8")),
        ("用户5及以上至少1Mbps，总速率最大", ("5", "6", "7", "8")),
    ],
)
def test_users_by_place(text: str, users: tuple[str, ...]) -> None:
    assert OfflineRecogniser().recognise(text, CELL).constraints == {"min_rate_bps": each(1e6, *users)}


@pytest.mark.parametrize(
    "text", ["the last two users at least 1 Mbit/s, sum rate", "95 % of the users at 1 Mbps, sum rate"]
)
def test_users_whom_nobody_can_tell_are_asked_about(text: str) -> None:
    assert OfflineRecogniser().recognise(text).asks == "some_users"


@pytest.mark.parametrize(
    "text",
    [
        "sum rate, all users 1-5 Mbps",
        "each user 1 to 5 Mbps, sum rate",
        "Jeder Nutzer 1–5 Mbit/s, Leistung minimieren",
        "chaque utilisateur 1–5 Mbit/s, débit total maximal",
        "Todos los usuarios 1-5 Mbps, tasa total máxima",
        "总速率最大，每个用户1~5Mbps",
    ],
)
def test_a_range_of_rates_for_each_user_names_nobody(text: str) -> None:
    found = OfflineRecogniser().recognise(text, CELL).constraints
    assert found == {"min_rate_bps": 1e6, "max_rate_bps": 5e6}


@pytest.mark.parametrize(
    ("text", "constraints"),
    [
        ("min power, 2+ Mbps each", {"min_rate_bps": 2e6}),
        ("Summenrate maximieren, Leistung max. 50 %", {"max_power_w": 10.0}),
        ("Max. débit total, Pmax = 50 %", {"max_power_w": 10.0}),
        ("总速率最大，功率不超过50%", {"max_power_w": 10.0}),
        ("sum rate, 250 mW/subcarrier", {"subcarrier_max_power_w": 0.25}),
        (
            "1 Mbps each, total power max. 10 W, of which max. 0.5 W per subcarrier, sum rate",
            {"min_rate_bps": 1e6, "max_power_w": 10.0, "subcarrier_max_power_w": 0.5},
        ),
        (
            "sum rate, user 1 <= 2 Mbps, user 2 >= 3 Mbps, P <= 10 W",
            {"min_rate_bps": each(3e6, "2"), "max_rate_bps": each(2e6, "1"), "max_power_w": 10.0},
        ),
        ("sum rate w/o users 4, 5, 2 Mbps each", {"min_rate_bps": 2e6, "leave_out": ("4", "5")}),
    ],
)
def test_figures_with_their_bounds(text: str, constraints: dict[str, Any]) -> None:
    assert OfflineRecogniser().recognise(text, CELL).constraints == constraints


@pytest.mark.parametrize(
    "text",
    [
        "RB size 4, sum rate",
        "sum rate, RBs of 4 subcarriers",
        "4 subcarriers per RB, highest total rate",
        "group subcarriers by 4, PF",
        "4-subcarrier RBs, sum rate",
        "sum rate, RB=4",
        "Sum rate max. RBG 4.",
        "group the resource blocks in fours, sum rate",
        "Gesamtrate maximieren, Ressourcenblöcke zu je 4 Unterträgern",
        "Gesamtrate maximieren, Blockgröße 4",
        "Maximiser le débit, blocs de ressources de 4 sous-porteuses",
        "Tasa total máxima, bloques de recursos de 4 subportadoras",
        "总速率最大，资源块大小4",
        "总速率最大，每4个子载波组成一个资源块",
        "highest sum rate, block size four",
        "Höchste Summenrate in Viererblöcken",
        "Summenrate maximieren, immer vier Unterträger zusammen",
        "débit total maximal, par blocs de quatre sous-porteuses",
    ],
)
def test_blocks(text: str) -> None:
    assert OfflineRecogniser().recognise(text, CELL).constraints == {"resource_block_group_size": 4.0}


@pytest.mark.parametrize(
    "text",
    [
        "sum rate, tx power 10 W, 3 W circuit, bandwidth 1.4 MHz",
        "maximise the rate of user 1 with 10 W, others 1 Mbps",
        "Gesamtrate der Nutzer 1, 2 und 3 maximieren",
        "sum rate for the next 10 s, 10 W",
    ],
)
def test_nobody_is_left_out_and_nothing_limited_by_what_says_something_else(text: str) -> None:
    found = OfflineRecogniser().recognise(text, CELL)
    assert "leave_out" not in found.constraints
    assert found.constraints.get("max_power_w", 10.0) == 10.0


@pytest.mark.parametrize(
    "text",
    [
        "users 1-3 at least 2 Mbit/s, the rest at most 1 Mbit/s, sum rate",
        "Nutzer 1-3 mindestens 2 Mbit/s, alle anderen höchstens 1 Mbit/s, Summenrate maximieren",
        "用户1到3至少2Mbps，其余用户不超过1Mbps，总速率最大",
    ],
)
def test_a_ceiling_of_the_others_is_not_one_of_the_named(text: str) -> None:
    found = OfflineRecogniser().recognise(text, CELL).constraints
    assert found == {"min_rate_bps": each(2e6, "1", "2", "3"), "max_rate_bps": each(1e6, "4", "5", "6", "7", "8")}


@pytest.mark.parametrize(
    ("text", "power_w"),
    [
        ("sum rate, at most 43 dBm, that is 20 W", 19.95),
        ("sum rate, at most 33 dBm (1.995 W)", 1.995),
        ("10 W (40 dBm) at most, highest sum rate", 10.0),
        ("sum rate, at most 40 dBm (i.e. 10 W)", 10.0),
        ("Gesamtrate maximieren, höchstens 40 dBm, das sind 10 W", 10.0),
        ("débit total maximal, 5 W au plus, soit 37 dBm", 5.0),
        ("tasa total máxima, como máximo 30 dBm, es decir 1 W", 1.0),
        ("总速率最大，功率不超过40dBm，也就是10瓦", 10.0),
    ],
)
def test_a_figure_in_two_units_is_one(text: str, power_w: float) -> None:
    found = OfflineRecogniser().recognise(text, CELL)
    assert (found.kind, dict(found.constraints)) == ("allocate", {"max_power_w": pytest.approx(power_w, rel=1e-3)})


def test_a_share_with_a_decimal_comma_is_read() -> None:
    found = OfflineRecogniser().read("höchste Gesamtrate mit 12,5 % der Leistung", CELL)
    assert dict(found.constraints) == {"max_power_w": 2.5}


@pytest.mark.parametrize(
    "text",
    [
        "max rate, power 10 % lower",
        "Gesamtrate maximieren, Sendeleistung 0,1 % niedriger",
        "tasa máxima, potencia 10 % menos",
        "débit total maximal, puissance 10 % en plus",
        "max rate, power 10 % below the limit",
    ],
)
def test_a_share_to_change_by_is_no_limit(text: str) -> None:
    assert (found := OfflineRecogniser().recognise(text, CELL)).kind == "clarify"
    assert found.asks == "change"


@pytest.mark.parametrize(
    ("text", "constraints"),
    [
        ("max energy efficiency, circuit power is 10 W (10 W transmit power)",
         {"circuit_power_w": 10.0, "max_power_w": 10.0}),
        ("min power, user 3 has 1 Mbit/s, so 1 Mbit/s for everyone else", {"min_rate_bps": each(1e6, "3", "all")}),
        ("总速率最大，双倍权重给3号和4号", {"weights": each(2.0, "3", "4")}),
        ("总速率最大,功率不超过12,5%", {"max_power_w": 2.5}),
    ],
)  # fmt: skip
def test_two_figures_of_one_size_stay_two_and_shares_are_read(text: str, constraints: dict[str, Any]) -> None:
    found = OfflineRecogniser().recognise(text, CELL)
    assert (found.kind, dict(found.constraints)) == ("allocate", constraints)


def test_two_figures_are_not_one() -> None:
    assert OfflineRecogniser().recognise("max rate, 10 W or 10.05 W", CELL).kind == "clarify"
