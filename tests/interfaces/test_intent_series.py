"""What is said of one user after the other, of odd and even ones, and in relative clauses."""

from __future__ import annotations

from typing import Any

import pytest

from wirelessagent.language.sentence import Sentence, own_words

NAMES = tuple(f"user {number}" for number in range(1, 9))
ODD, EVEN = ("1", "3", "5", "7"), ("2", "4", "6", "8")


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("Floors in Mbit/s: u1 0.5, u2 0.75, u3 1.25. Maximise the sum.",
         {"min_rate_bps": {"1": 5e5, "2": 7.5e5, "3": 1.25e6}}),
        ("Min rates: [1: 300k, 2: 300k, 6: 900k] bit/s. Max EE.", {"min_rate_bps": {"1": 3e5, "2": 3e5, "6": 9e5}}),
        ("le 2 plafonné à 1 Mbit/s, le 3 à 2 Mbit/s, le 4 à 3 Mbit/s ; débit cumulé maximal",
         {"max_rate_bps": {"2": 1e6, "3": 2e6, "4": 3e6}}),
        ("下限(kbit/s):1号100,2号200,3号300;上限(kbit/s):5号1000,6号2000。按max-min来。",
         {"min_rate_bps": {"1": 1e5, "2": 2e5, "3": 3e5}, "max_rate_bps": {"5": 1e6, "6": 2e6}}),
        ("Users 3 to 6 are limited to 1.8 Mbit/s each, user 1 is promised 1.8 Mbit/s; sum rate",
         {"min_rate_bps": {"1": 1.8e6}, "max_rate_bps": dict.fromkeys("3456", 1.8e6)}),
        ("让比特对焦耳的比值最大,单号至少400k,双号至多2M",
         {"min_rate_bps": dict.fromkeys(ODD, 4e5), "max_rate_bps": dict.fromkeys(EVEN, 2e6)}),
        ("Máxima eficiencia en bits por julio, sin servir a los pares.", {"leave_out": EVEN}),
        ("Les utilisateurs impairs ont un plancher de 0,25 Mbit/s et les pairs le double ; le moins de watts émis",
         {"min_rate_bps": {**dict.fromkeys(ODD, 2.5e5), **dict.fromkeys(EVEN, 5e5)}}),
        ("floor 1 Mbps for all bar user 3, whose floor is 250 kbps, max rate",
         {"min_rate_bps": {"all": 1e6, "3": 2.5e5}}),
        ("alle mindestens 200 kbit/s, außer Nutzer 5, der bekommt 1 Mbit/s, minimale Leistung",
         {"min_rate_bps": {"all": 2e5, "5": 1e6}}),
        ("max rate, ohne Nutzer 3, der Rest bekommt 1 Mbit/s", {"min_rate_bps": 1e6, "leave_out": ("3",)}),
        ("max rate, sin el usuario 3, que los demás tengan 1 Mbit/s", {"min_rate_bps": 1e6, "leave_out": ("3",)}),
        ("max rate, user 1 needs 1 Mbit/s, user 2 2 Mbit/s, user 3 3 Mbit/s max",
         {"min_rate_bps": {"1": 1e6, "2": 2e6}, "max_rate_bps": {"3": 3e6}}),
        ("max rate, user 1 at most 3 Mbit/s, user 2 1 Mbit/s guaranteed",
         {"min_rate_bps": {"2": 1e6}, "max_rate_bps": {"1": 3e6}}),
        ("max rate, user 1 gets between 1 and 2 Mbit/s, user 2 3 Mbit/s",
         {"min_rate_bps": {"1": 1e6, "2": 3e6}, "max_rate_bps": {"1": 2e6}}),
        ("max rate, limit users to at most 2 Mbit/s", {"max_rate_bps": 2e6}),
        ("Gewichte: N4 = 2, N6 = 3, N8 = 0,5. Proportional fair", {"weights": {"4": 2.0, "6": 3.0, "8": 0.5}}),
        ("Mindestraten in kbit/s: N1 240, N2 480. Höchstraten in kbit/s: N6 1200, N7 1400. Größte Summe",
         {"min_rate_bps": {"1": 2.4e5, "2": 4.8e5}, "max_rate_bps": {"6": 1.2e6, "7": 1.4e6}}),
        ("PF w/ caps: 4 Mbps for user 1, 2 Mbps for user 2, 1 Mbps for all the rest",
         {"max_rate_bps": {"1": 4e6, "2": 2e6, "all": 1e6}}),
        ("max rate on band n7, 10 W", {"max_power_w": 10.0}),
        ("Jedem 800 kbit/s garantieren, Nutzer 3 das Doppelte, Nutzer 6 die Hälfte, minimale Leistung",
         {"min_rate_bps": {"all": 8e5, "3": 1.6e6, "6": 4e5}}),
        ("le plus faible au plus haut, le 5 ne dépasse pas 1,5 Mbit/s, le 6 non plus",
         {"max_rate_bps": dict.fromkeys("56", 1.5e6)}),
        ("max sum rate, users 6, 7, 8 no guarantee, users 1 through 5 at least 150 kbit/s",
         {"min_rate_bps": dict.fromkeys("12345", 1.5e5)}),
        ("max rate, user 2 at most 1 Mbit/s, no cap on user 3", {"max_rate_bps": {"2": 1e6}}),
        ("奇数号用户保底1 Mbps，偶数号用户不作保证，总速率最大。", {"min_rate_bps": dict.fromkeys(ODD, 1e6)}),
        ("Gerade Nutzernummern höchstens 1 Mbit/s, ungerade ohne Deckel, Ziel: proportional fair.",
         {"max_rate_bps": dict.fromkeys(EVEN, 1e6)}),
        ("Usuarios impares, 500 kbps garantizados; pares, 1000 kbps garantizados; la menor potencia posible.",
         {"min_rate_bps": {**dict.fromkeys(ODD, 5e5), **dict.fromkeys(EVEN, 1e6)}}),
        ("Utilisateurs pairs : 1 Mbit/s minimum ; impairs : 400 kbit/s minimum ; but : la puissance la plus faible.",
         {"min_rate_bps": {**dict.fromkeys(EVEN, 1e6), **dict.fromkeys(ODD, 4e5)}}),
        ("only odd-numbered users 1, 3, 5, 7 get served, each with 1.1 Mbps or more, least power",
         {"min_rate_bps": 1.1e6, "users": ODD}),
        ("le meilleur débit cumulé ; l'utilisateur 1 ne dépasse pas 1 Mbit/s, le 2 pas 2 Mbit/s, le 3 pas 3 Mbit/s.",
         {"max_rate_bps": {"1": 1e6, "2": 2e6, "3": 3e6}}),
        ("除用户3需要2 Mbit/s外，其余用户都保底300 kbit/s，发射功率尽量小。",
         {"min_rate_bps": {"all": 3e5, "3": 2e6}}),
        ("除了用户4和5,其他人都要至少700 kbps,总速率最大。", {"min_rate_bps": {"all": 7e5, "4": 0.0, "5": 0.0}}),
        ("用户一到三下限0.8 Mbps,用户八下限1.6 Mbps,总吞吐最高。",
         {"min_rate_bps": {**dict.fromkeys("123", 8e5), "8": 1.6e6}}),
        ("lowest Tx power; floors [kbps]: u1=100, u2=200, u3=300", {"min_rate_bps": {"1": 1e5, "2": 2e5, "3": 3e5}}),
        ("max the sum rate with 1 Mbps for users 1 to 4", {"min_rate_bps": dict.fromkeys("1234", 1e6)}),
        ("max sum rate with a 0.002 Gbit/s floor for user 7", {"min_rate_bps": {"7": 2e6}}),
        ("bring the total rate of the eight users to its maximum", {}),
        ("not user 3 but user 2 needs 2 Mbps; max sum rate", {"min_rate_bps": {"2": 2e6}}),
        ("maximale Summenrate mit 90 Prozent vom Leistungsbudget", {"max_power_w": 18.0}),
        ("most bits per joule, circuit power 7.5 W, no more than 80 % of the power budget",
         {"circuit_power_w": 7.5, "max_power_w": 16.0}),
        ("max rate, no more than 5 % of the power budget on each subcarrier", {"subcarrier_max_power_w": 1.0}),
        ("最大总速率，每个子载波最多用总功率的5%", {"subcarrier_max_power_w": 1.0}),
        ("max rate with 50 % of the power, blocks of 4 subcarriers",
         {"max_power_w": 10.0, "resource_block_group_size": 4.0}),
        ("max rate but leave 20 % of the power budget unused", {"max_power_w": 16.0}),
        ("máxima tasa total, deja un 20 % de la potencia sin usar", {"max_power_w": 16.0}),
        ("max rate, outage 5 % total power 10 W", {"max_power_w": 10.0, "outage_probability": 0.05}),
        ("中断概率2%功率最小,每人500kbps", {"min_rate_bps": 5e5, "outage_probability": 0.02}),
        ("everyone at least 500 kbit/s, but not user 3, but user 4 gets 1 Mbit/s; least power",
         {"min_rate_bps": {"all": 5e5, "4": 1e6, "3": 0.0}}),
        ("max rate. Everyone 1 Mbit/s, not user 3, but 7.5 W at most",
         {"max_power_w": 7.5, "min_rate_bps": {"all": 1e6, "3": 0.0}}),
        ("Leistung minimal, gerade, wo alle mindestens 1 Mbit/s haben", {"min_rate_bps": 1e6}),
        ("least power, apart from users 3 and 4 everybody gets 1 Mbit/s",
         {"min_rate_bps": {"all": 1e6, "3": 0.0, "4": 0.0}}),
        ("Versorge jeden maximal mit 3 Mbit/s und minimiere die Leistung", {"max_rate_bps": 3e6}),
        ("max rate, jeder andere als Nutzer 3 mindestens 1 Mbit/s", {"min_rate_bps": {"all": 1e6, "3": 0.0}}),
        ("max rate, user 5 counts twice as much as the rest, with a floor of 1 Mbit/s",
         {"min_rate_bps": 1e6, "weights": {"5": 2.0}}),
        ("max rate, use half of the power and leave no subcarrier unused", {"max_power_w": 10.0}),
        ("so wenig Leistung wie möglich, ein halbes Megabit für jeden sowie anderthalb für Nutzer 3",
         {"min_rate_bps": {"all": 5e5, "3": 1.5e6}}),
        ("max rate, 60 % of the power with subcarriers in blocks of four",
         {"max_power_w": 12.0, "resource_block_group_size": 4.0}),
        ("max rate, 50 % of the power with no limit per subcarrier", {"max_power_w": 10.0}),
        ("verteile die Hälfte der Leistung auf die Unterträger, Summenrate maximal", {"max_power_w": 10.0}),
        ("max rate, user 4 2 Mbit/s, user 5 3 Mbit/s as maximum",
         {"min_rate_bps": {"4": 2e6}, "max_rate_bps": {"5": 3e6}}),
        ("总速率最大，帮用户3找平衡，权重2", {"weights": {"3": 2.0}}),
        ("leave out the last two users 7 and 8, max rate", {"leave_out": ("7", "8")}),
        ("die ersten drei Nutzer 1, 2 und 3 mindestens 1 Mbit/s, Summenrate maximal",
         {"min_rate_bps": dict.fromkeys("123", 1e6)}),
        ("100 kbit/s at least for users 1 to 3, 200 for users 4 to 6, least power",
         {"min_rate_bps": {**dict.fromkeys("123", 1e5), **dict.fromkeys("456", 2e5)}}),
    ],
)  # fmt: skip
def test_each_user_has_the_figure_that_is_said_of_them(text: str, values: dict[str, Any]) -> None:
    reading = Sentence(text, own_words(), names=NAMES).reading
    assert not reading.doubts
    assert {name: dict(value) if isinstance(value, dict) else value for name, value in reading.values.items()} == values


@pytest.mark.parametrize(
    "text",
    [
        "max sum rate, serve only users 1 and 2, the others at 1 Mbit/s", "max sum rate of 5 Mbit/s for users 1 and 2",
        "8个用户中7个至少1 Mbps,发射功率最小", "max sum rate for 8 users, 3 at least 1 Mbit/s",
        "max rate, no limit on anyone except user 3", "max rate, everyone unlimited except user 3, max 2 Mbit/s",
        "max rate, serve users 5 to 8, the first two at 1 Mbit/s", "总速率最大，最多两成功率闲置",
        "max rate, nobody but user 3 gets 2 Mbit/s at least", "niemand außer Nutzer 3 bekommt 2 Mbit/s, max rate",
        "max sum rate for eight users, three left out", "everybody at least 1 Mbit/s, user 5 no ceiling, max rate",
        "max rate, users 1 and 2 at least 1 Mbit/s, no subcarriers for user 6",
    ],
)  # fmt: skip
def test_what_may_be_of_others_is_asked(text: str) -> None:
    assert Sentence(text, own_words(), names=NAMES).reading.doubts
