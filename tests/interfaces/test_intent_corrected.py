"""What is taken back in the same breath, and figures and users that stand close to others."""

from __future__ import annotations

from typing import Any

import pytest

from wirelessagent.language.as_meant import without_corrected
from wirelessagent.language.offline import recognise
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.sentence import Sentence, own_words


def read(text: str) -> dict[str, Any]:
    reading = Sentence(text, own_words()).reading
    assert not reading.doubts
    return {name: dict(value) if hasattr(value, "items") else value for name, value in reading.values.items()}


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("user 6 at least 1, no, 2 Mbit/s", "user 6 at least 2 Mbit/s"),
        ("power at most 12, make that 10 W", "power at most 10 W"),
        ("höchstens 8, Quatsch, höchstens 6 Watt", "höchstens 6 Watt"),
        ("al menos 2, no, 3 Mbit/s", "al menos 3 Mbit/s"), ("au moins 1, non, 1,5 Mbit/s", "au moins 1,5 Mbit/s"),
        ("至少1，不对，2 Mbit/s", "至少 2 Mbit/s"), ("for user 3 - sorry, I mean user 5 -", "for user 5 -"),
        ("Nutzer 5 – äh, falsch, Nutzer 7 – braucht", "Nutzer 7 – braucht"), ("给5号，哦不，给6号", "给 6号"),
        ("user 2 at 1 Mbit/s minimum, make that 1.3,", "user 2 at 1.3 Mbit/s minimum,"),
        ("promet 1 Mbit/s, pardon, 1,4, au 6", "promet 1,4 Mbit/s, au 6"),
        ("stay under fifteen no sorry twelve watts", "stay under twelve watts"),
        ("in blocks of six no hang on in blocks of eight", "in blocks of eight"),
        ("höchstens drei nee höchstens vier Watt", "höchstens vier Watt"), ("六号啊不对是七号", "七号"),
        ("每人至少1兆,说错了,2兆", "每人至少 2兆"), ("hmm", "hmm"),
        ("起码三兆哎不对起码四兆", "起码 四兆"),
        ("user 3 at 2 Mbit/s, no, 5", "user 3 at 5 Mbit/s"), ("at 2 Mbit/s, no more", "at 2 Mbit/s, no more"),
        ("1 Mbit/s at least, no, 3 W at most", "1 Mbit/s at least, no, 3 W at most"),
        ("users 1, 2 and 3, no more than 10 W", "users 1, 2 and 3, no more than 10 W"),
        ("no service to 6, no service to 7", "no service to 6, no service to 7"),
        ("con 10 W, no 20 W", "con 10 W,"), ("不超过10瓦，不是20瓦", "不超过10瓦，"),
        ("everyone 1 Mbit/s, rather 2 Mbit/s for user 3", "everyone 1 Mbit/s, rather 2 Mbit/s for user 3"),
        ("at most 10 W, hold on, 8 W is the circuit power", "at most 10 W, hold on, 8 W is the circuit power"),
        ("drop user 3, sorry for user 4", "drop user 3, sorry for user 4"),
        ("drop 1, 2 and 3, sorry, cap is 10 W", "drop 1, 2 and 3, sorry, cap is 10 W"),
        ("drop 7, no, 7 stays", "drop 7, no, 7 stays"),
        ("user 1: no, user 2: 1 Mbit/s", "user 1: no, user 2: 1 Mbit/s"),
        ("users 1 and 2, no, 3 and 4", "users 1 and 2, no, 3 and 4"), ("users 1 to 3, no, 4", "users 1 to 3, no, 4"),
        ("weight for user 3: make it 2", "weight for user 3: make it 2"),
    ],
)  # fmt: skip
def test_what_is_taken_back_is_blanked(said: str, meant: str) -> None:
    left = without_corrected(said)
    assert " ".join(left.split()) == meant
    assert len(left) == len(said)
    assert set(left) <= {*said, " "}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a third of the power", {"max_power_w": 20 / 3}), ("zwei Drittel der Leistung", {"max_power_w": 40 / 3}),
        ("trois quarts de la puissance", {"max_power_w": 15.0}),
        ("la quinta parte de la potencia", {"max_power_w": 4.0}),
        ("halbe Leistung, maximaler Durchsatz", {"max_power_w": 10.0}), ("最多用八成功率", {"max_power_w": 16.0}),
        ("95 % reliability and no more than 50 % of the power", {"outage_probability": 0.05, "max_power_w": 10.0}),
        ("max throughput at 60% of the power", {"max_power_w": 12.0}),
    ],
)  # fmt: skip
def test_a_share_of_the_power_is_a_figure_in_words_too(text: str, expected: dict[str, float]) -> None:
    assert read(text) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("for users 3, 6 and 9: 200k, 400k and 800k minimum", {"3": 2e5, "6": 4e5, "9": 8e5}),
        ("2, 3 and 5 Mbit/s for users 1, 2 and 3 at least", {"1": 2e6, "2": 3e6, "3": 5e6}),
        ("Nutzer 2, 3 und 8 mindestens 1, 2 und 4 Mbit/s", {"2": 1e6, "3": 2e6, "8": 4e6}),
        ("1 Mbit/s for each, double for user 3", {"all": 1e6, "3": 2e6}),
        ("1 → 400k, 4 → 1M, rest 200k", {"1": 4e5, "4": 1e6, "all": 2e5}),
        ("users 1 and 2 get 300k, 3 and 4 1M", {"1": 3e5, "2": 3e5, "3": 1e6, "4": 1e6}),
        ("least power, 750 kbit/s for 1, 2 and 6, and twice as much for 8",
         {"1": 7.5e5, "2": 7.5e5, "6": 7.5e5, "8": 1.5e6}),
        ("user 2 at least 800 kbit/s, user 5 the same, user 6 double", {"2": 8e5, "5": 8e5, "6": 1.6e6}),
        ("el 2 con 1 Mbit/s, el 4 lo mismo", {"2": 1e6, "4": 1e6}), ("2号至少1兆，5号也一样", {"2": 1e6, "5": 1e6}),
        ("1,5 Mbit/s mindestens für die 2 und ebenso viel für die 3", {"2": 1.5e6, "3": 1.5e6}),
        ("le 2 au moins 1 Mbit/s, le 5 pareil", {"2": 1e6, "5": 1e6}),
    ],
)  # fmt: skip
def test_lists_have_one_figure_for_each_user(text: str, expected: dict[str, float]) -> None:
    assert read(text) == {"min_rate_bps": expected}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("sin el usuario 7, el 4 con 450 kbit/s como mínimo", {"leave_out": ("7",), "min_rate_bps": {"4": 4.5e5}}),
        ("ohne Nutzer 1, und Nutzer 6 nicht unter 750 kbit/s", {"leave_out": ("1",), "min_rate_bps": {"6": 7.5e5}}),
        ("不服务3号，8号的速率至少1兆", {"leave_out": ("3",), "min_rate_bps": {"8": 1e6}}),
        ("without users 1, 2, and 3", {"leave_out": ("1", "2", "3")}),
        ("只管3号和8号，3号至少2兆，8号至少1兆", {"users": ("3", "8"), "min_rate_bps": {"3": 2e6, "8": 1e6}}),
        ("max rate, cap 12 at 2 Mbit/s", {"max_rate_bps": {"12": 2e6}}),
        ("energy-efficient, only users one six and nine", {"users": ("1", "6", "9")}),
        ("max rate but users 7, 4 get 1 Mbit/s", {"min_rate_bps": {"7": 1e6, "4": 1e6}}),
        ("max rate, leave out 5 and 6, give 2, 3 Mbit/s", {"leave_out": ("5", "6"), "min_rate_bps": {"2": 3e6}}),
        ("users 5 and 6 have weight 2, 3 Mbit/s each",
         {"weights": {"5": 2.0, "6": 2.0}, "min_rate_bps": {"5": 3e6, "6": 3e6}}),
        ("users 1 thru 4 only", {"users": ("1", "2", "3", "4")}),
    ],
)  # fmt: skip
def test_neighbours_are_not_thrown_together(text: str, expected: dict[str, Any]) -> None:
    assert read(text) == expected


@pytest.mark.parametrize(
    ("text", "asked"),
    [("max rate at 45 %", "share"), ("功率减半", "change"), ("max rate, half the power less", "change"),
     ("user 3 gets twice 1 Mbit/s", "calculated"), ("max rate, user 3 no, user 5 at least 1 Mbit/s", "named_user"),
     ("neither user 3 nor 4 gets 1 Mbit/s, min power", "whose_rate")],
)  # fmt: skip
def test_what_no_limit_can_be_is_asked_about(text: str, asked: str) -> None:
    """A promise that is hardly kept is a share of something else; nor is a change a share, or a multiple a rate."""
    assert asked in [doubt.key for doubt in Sentence(text, own_words()).reading.doubts]


def test_the_whole_power_is_a_share_too() -> None:
    assert read("max rate with 100 % of the power") == {"max_power_w": 20.0}


@pytest.mark.parametrize(("text", "bare"), [("au moins 200 pour le 1", "200"), ("0,001 como máximo", "0,001")])
def test_a_small_word_is_no_unit(text: str, bare: str) -> None:
    assert [(each.kind, each.text) for each in parse_quantities(text)][:1] == [("bare", bare)]


def test_a_share_before_many_blanks_is_read_at_once() -> None:
    """Where each blank could belong to two parts of a pattern, two dozen took ten seconds."""
    assert read("max rate at half" + " " * 400 + "the power") == {"max_power_w": 10.0}
    assert Sentence("max rate at 50 %" + " " * 400 + "x", own_words()).reading.doubts


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("user 4: 0.7; user 6: 1.1, all in Mbit/s", {"4": 7e5, "6": 1.1e6}),
        ("以兆为单位：3号至少1.2，5号至少0.6", {"3": 1.2e6, "5": 6e5}),
        ("in Mbit/s: user 3 at least 2", {"3": 2e6}),
        ("1号至少1.1，2号至少1.2，单位都是Mbit/s", {"1": 1.1e6, "2": 1.2e6}),
    ],
)  # fmt: skip
def test_a_unit_said_once_is_that_of_all_rates(text: str, expected: dict[str, float]) -> None:
    assert read(text) == {"min_rate_bps": expected}


@pytest.mark.parametrize(
    "text",
    [
        "Gbit/s would be nice, user 3 at least 2",
        "chaque kbit/s compte, l'utilisateur 3 au moins 2",
        "not in kbit/s: user 3 at least 2",
        "as many Mbit/s as possible, budget 8",
        "get the most Mbit/s, user 3 at least 500",
        "user 3 gets 2 Mbit/s, user 5 as much as possible",
        "user 3 gets 2 Mbit/s, user 5 the same device",
        "Nutzer 3 mindestens 2 Mbit/s, Nutzer 5 gleich abschalten",
        "user 3 gets 2 Mbit/s, the same not for user 5",
    ],
)  # fmt: skip
def test_a_unit_in_passing_is_no_figures_and_what_is_alike_in_passing_gives_nothing(text: str) -> None:
    assert Sentence(text, own_words()).reading.doubts


@pytest.mark.parametrize(
    ("said", "left"),
    [
        ("user two counts twice er no three times", "user two counts three times"),
        ("总功率15W，哦不对，是18W", "总功率 18W"),
        ("Usuario 2: 1 Mbps, perdón, 1,8 Mbps como mínimo", "Usuario 2: 1,8 Mbps como mínimo"),
        ("fair avec 15 W de limite, et non 14.", "fair avec 15 W de limite, ."),
        ("circuits 11 W statt 10 W, 5 W total", "circuits 11 W , 5 W total"),
        ("10 W, not 5 Mbit/s", "10 W, not 5 Mbit/s"),
        ("user 4 at least 1 Mbit/s, sorry, and user 7 at least 1 Mbit/s",
         "user 4 at least 1 Mbit/s, sorry, and user 7 at least 1 Mbit/s"),
        ("user 3 at least 1 Mbit/s, no service for 4, user 5 at least 1 Mbit/s",
         "user 3 at least 1 Mbit/s, no service for 4, user 5 at least 1 Mbit/s"),
    ],
)  # fmt: skip
def test_what_another_figure_stands_for_is_blanked(said: str, left: str) -> None:
    assert " ".join(without_corrected(said).split()) == left


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("min power, 2 Mbps for user 1 and 3 Mbps for user 2, no wait, make user 2's 2.5",
         {"min_rate_bps": {"1": 2e6, "2": 2.5e6}}),
        ("用户1 2Mbps，用户2 3Mbps。更正，用户2是2.5Mbps。", {"min_rate_bps": {"1": 2e6, "2": 2.5e6}}),
        ("600 kbit/s à l'utilisateur 2, non, 700 à l'utilisateur 2", {"min_rate_bps": {"2": 7e5}}),
        ("2 Mbit/s each at minimum er no 3 Mbit/s each at minimum", {"min_rate_bps": 3e6}),
        ("max rate, at most 10 W, no sorry, at most 8 W in total", {"max_power_w": 8.0}),
        ("max rate, at most 10 W in total, no more than 10 W", {"max_power_w": 10.0}),
    ],
)  # fmt: skip
def test_of_two_figures_of_one_thing_the_one_behind_what_takes_back_holds(text: str, values: dict[str, Any]) -> None:
    assert read(text) == values


@pytest.mark.parametrize(
    "text",
    [
        "min power, user 3 gets 500 kbit/s, sorry, user 4 gets 500 kbit/s",
        "max bits per joule, at most 10 W, hold on, 8 W is the circuit power",
        "veinte vatios no espera dieciocho y el maximo throughput que salga",
        "max rate, cap user one at 2 megabits no wait cap user seven at 2 megabits",
        "max rate, no more than thirty watts, uh thirty two",
        "吞吐最大，功率一百毫瓦 不 九十毫瓦",
    ],
)
def test_what_takes_back_nobody_knows_what_is_asked_about(text: str) -> None:
    assert recognise(text).kind == "clarify"


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("max rate, 10 W, user 1 weight 3, hold on, user 2 at most 1 Mbit/s",
         {"max_power_w": 10.0, "weights": {"1": 3.0}, "max_rate_bps": {"2": 1e6}}),
        ("energy efficiency, 10 W, uh, 5 W circuit power", {"max_power_w": 10.0, "circuit_power_w": 5.0}),
        ("max rate with at most 10 W, uh, 1 W per carrier", {"max_power_w": 10.0, "subcarrier_max_power_w": 1.0}),
        ("leave out user 7, I mean it, leave out user 6", {"leave_out": ("7", "6")}),
        ("leave out user 7, sorry for him, leave out user 6 too", {"leave_out": ("7", "6")}),
        ("min power, at least 1 Mbit/s and, uh, 2 Mbit/s for users 3 and 4", {"min_rate_bps": {"3": 1e6, "4": 2e6}}),
        ("users 3, 4 and, uh, 5 at least 1 Mbit/s", {"min_rate_bps": {"3": 1e6, "4": 1e6, "5": 1e6}}),
        ("1 Mbit/s pour 3, 2 Mbit/s pour 4, enfin 10 W", {"min_rate_bps": {"3": 1e6, "4": 2e6}, "max_power_w": 10.0}),
        ("nicht Nutzer 3 sondern Nutzer 2 bekommt 1 Mbit/s", {"min_rate_bps": {"2": 1e6}}),
        ("max rate, 40 W, use a reliability of 80 %, each 1 Mbit/s",
         {"max_power_w": 40.0, "outage_probability": 0.2, "min_rate_bps": 1e6}),
        ("40 W, take users 1 and 2 only, outage 20 %",
         {"max_power_w": 40.0, "outage_probability": 0.2, "users": ("1", "2")}),
        ("max rate, 40 W, user 3 half a megabit", {"max_power_w": 40.0, "min_rate_bps": {"3": 5e5}}),
        ("each subcarrier stays but 8 W total", {"max_power_w": 8.0}),
        ("débit max, un méga trois, deux mégas quatre, dix watts",
         {"min_rate_bps": {"3": 1e6, "4": 2e6}, "max_power_w": 10.0}),
        ("users 1 and 2 at least 2 Mbit/s, the rest shared evenly, 10 W",
         {"min_rate_bps": {"1": 2e6, "2": 2e6}, "max_power_w": 10.0}),
        ("10 W split evenly, users 1 and 2 get 1 Mbit/s", {"min_rate_bps": {"1": 1e6, "2": 1e6}, "max_power_w": 10.0}),
        ("maximise the rate per subcarrier with 10 W", {"max_power_w": 10.0}),
        ("not 10 W per subcarrier but 10 W in total, max rate", {"max_power_w": 10.0}),
        ("user 3 at least 1 Mbit/s, cap user 4 at the double",
         {"min_rate_bps": {"3": 1e6}, "max_rate_bps": {"4": 2e6}}),
        ("débit max, un méga deux exclu, dix watts", {"min_rate_bps": 1e6, "leave_out": ("2",), "max_power_w": 10.0}),
        ("用户五五百k，用户六六百k", {"min_rate_bps": {"5": 5e5, "6": 6e5}}),
    ],
)  # fmt: skip
def test_what_takes_nothing_back_and_is_shared_by_nobody_leaves_the_rest_as_it_is(
    text: str, values: dict[str, Any]
) -> None:
    assert read(text) == values
