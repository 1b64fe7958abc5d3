"""The quantity parser against a table of spellings with exact SI values: a wrong unit is a wrong watt."""

from __future__ import annotations

import math
from collections.abc import Mapping
from decimal import Decimal

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wirelessagent.language.offline import recognise
from wirelessagent.language.quantities import Quantity, parse_quantities

POWERS = [
    ("10 W", 10.0), ("10W", 10.0), ("10 w", 10.0), ("10 watts", 10.0), ("1 watt", 1.0), ("10-watt", 10.0),
    ("0.5 W", 0.5), (".5 W", 0.5), ("2,5 W", 2.5), ("0,125 W", 0.125), ("1,000 W", 1000.0), ("1,234.5 W", 1234.5),
    ("12 500 mW", 12.5), ("200 mW", 0.2), ("200mW", 0.2), ("200 mw", 0.2), ("200 milliwatts", 0.2),
    ("200 milliwatt", 0.2), ("3 MW", 3e6), ("3 megawatts", 3e6), ("2 kW", 2000.0), ("2 KW", 2000.0),
    ("2 kilowatts", 2000.0), ("50 µW", 50e-6), ("50 μW", 50e-6), ("50 uW", 50e-6), ("50 microwatts", 50e-6),
    ("7 nW", 7e-9), ("20 dBm", 0.1), ("30dBm", 1.0), ("30 dbm", 1.0), ("30 DBM", 1.0), ("0 dBm", 1e-3),
    ("-10 dBm", 1e-4), ("−10 dBm", 1e-4), ("minus 10 dBm", 1e-4), ("10 dBW", 10.0), ("-3 dBW", 10**-0.3),
    ("46 dBm", 10**1.6), ("ten watts", 10.0), ("twenty-five watts", 25.0), ("half a watt", 0.5),
    ("a twentieth of a watt", 0.05), ("ein zwanzigstel Watt", 0.05), ("un vingtième de watt", 0.05),
    ("one and a half watts", 1.5), ("two point five watts", 2.5), ("three hundred and fifty milliwatts", 0.35),
    ("three quarters of a watt", 0.75), ("5 thousand milliwatts", 5.0), ("1e-3 W", 1e-3), ("-5 W", -5.0),
    ("10瓦", 10.0), ("10 瓦特", 10.0), ("200毫瓦", 0.2), ("5微瓦", 5e-6), ("2千瓦", 2000.0), ("十瓦", 10.0),
    ("二十五瓦", 25.0), ("两瓦", 2.0), ("半瓦", 0.5), ("两瓦半", 2.5), ("一百二十毫瓦", 0.12), ("三点五瓦", 3.5),
    ("一百零五毫瓦", 0.105), ("一千五毫瓦", 1.5), ("十五毫瓦", 0.015), ("\uff11\uff10\uff37", 10.0),
    ("10\u00a0W", 10.0), ("30分贝毫瓦", 1.0),
    ("负5瓦", -5.0), ("1万毫瓦", 10.0),
]  # fmt: skip

RATES = [
    ("a million bits", 1e6), ("eine Million Bit", 1e6), ("un million de bits", 1e6), ("two million bits", 2e6),
    ("1 bit/s", 1.0), ("64 bps", 64.0), ("300 b/s", 300.0), ("500 bits per second", 500.0), ("500 bits/s", 500.0),
    ("200 kbit/s", 200e3), ("200kbit/s", 200e3), ("200 Kbit/s", 200e3), ("200 kbps", 200e3), ("200 Kbps", 200e3),
    ("200 KBPS", 200e3), ("200 kb/s", 200e3), ("200 Kb/s", 200e3), ("200 kbits/s", 200e3), ("200 kbit/sec", 200e3),
    ("200 kilobits per second", 200e3), ("200 kilobits", 200e3), ("200 kilobit/s", 200e3), ("200 kb", 200e3),
    ("1 Mbit/s", 1e6), ("1 Mbps", 1e6), ("1 mbps", 1e6), ("1 MBPS", 1e6), ("1 Mb/s", 1e6), ("1 mb/s", 1e6),
    ("1 Mbit", 1e6), ("1 Mbits/s", 1e6), ("1 MBit/s", 1e6), ("1 Mb", 1e6), ("1 Mbit per second", 1e6),
    ("1 megabit per second", 1e6), ("1 megabit", 1e6), ("1 megabits a second", 1e6), ("1.5 Mbps", 1.5e6),
    ("1,5 Mbit/s", 1.5e6), ("2.5 Gbit/s", 2.5e9), ("1 Gbps", 1e9), ("1 gigabit per second", 1e9),
    ("1 Tbit/s", 1e12), ("1 kB/s", 8e3), ("1 KB/s", 8e3), ("1 MB/s", 8e6), ("1 MBps", 8e6), ("1 GB/s", 8e9),
    ("2 megabytes per second", 16e6), ("100 bytes per second", 800.0), ("100 B/s", 800.0), ("1 Mibit/s", 1048576.0),
    ("1 MiB/s", 8388608.0), ("1,000,000 bit/s", 1e6), ("1.000.000 bit/s", 1e6), ("1 000 kbit/s", 1e6),
    ("5 million bits per second", 5e6),
    ("half a megabit", 5e5), ("one megabit per second", 1e6), ("a hundred kilobits per second", 1e5),
    ("two hundred kbps", 2e5), ("1.2e6 bit/s", 1.2e6), ("1兆", 1e6), ("1兆比特每秒", 1e6), ("2 兆比特/秒", 2e6),
    ("5兆每秒", 5e6), ("每秒500比特", 500.0), ("每秒2兆", 2e6), ("1000比特每秒", 1000.0), ("500千比特每秒", 5e5),
    ("500kbps", 5e5), ("一兆", 1e6), ("半兆", 5e5), ("三百千比特每秒", 3e5), ("5万比特每秒", 5e4), ("一兆半", 1.5e6),
    ("2兆字节每秒", 16e6), ("1吉比特每秒", 1e9), ("1百万比特每秒", 1e6), ("两百kbps", 2e5), ("3 M比特每秒", 3e6),
]  # fmt: skip

RATIOS = [
    ("5 %", 0.05), ("5%", 0.05), ("5\uff05", 0.05), ("99.9 %", 0.999), ("five percent", 0.05), ("95 per cent", 0.95),
    ("百分之五", 0.05), ("百分之九十五", 0.95), ("百分之99.9", 0.999), ("20 pct", 0.2),
]  # fmt: skip


def only(text: str) -> Quantity:
    found = parse_quantities(text)
    assert len(found) == 1, found
    return found[0]


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [(t, "power", v) for t, v in POWERS] + [(t, "rate", v) for t, v in RATES] + [(t, "ratio", v) for t, v in RATIOS],
)
def test_spelling(text: str, kind: str, value: float) -> None:
    for sentence in (text, f"please {text}.", f"({text}, thanks)", f"用 {text} 吧"):
        found = only(sentence)
        assert (found.kind, found.value) == (kind, value)
        assert sentence[found.start : found.end] == found.text
        assert found.text.strip() in text


@pytest.mark.parametrize(
    "text",
    [
        "8 users", "user 3", "users 1 and 2", "20 subcarriers", "用户3", "3号用户", "8个用户", "P1", "4K video",
        "5G", "6G cell",
        "user3", "3.5 GHz", "20 MHz", "100 ns", "3 km/h", "a bit faster", "one more time", "the last one", "快一点",
        "一些用户", "统一", "not a watt more", "10 GB file", "5 kWh", "5千瓦时", "3 dB", "5 Mbit/J", "2 bit/s/Hz",
        "3 bits per joule", "10 W/Hz", "5兆赫", "10² W", "24/7", "every second counts", "",
    ],
)  # fmt: skip
def test_what_is_no_quantity(text: str) -> None:
    assert parse_quantities(text) == ()


@pytest.mark.parametrize(
    ("text", "comparator"),
    [
        ("at least 1 Mbit/s", "at_least"), ("no less than 1 Mbit/s", "at_least"), ("minimum 1 Mbit/s", "at_least"),
        ("a minimum rate of 1 Mbit/s", "at_least"), ("1 Mbit/s or more", "at_least"), ("≥ 1 Mbit/s", "at_least"),
        (">= 1 Mbit/s", "at_least"), ("1 Mbit/s minimum", "at_least"), ("more than 1 Mbit/s", "at_least"),
        ("nobody below 1 Mbit/s", "at_least"), ("never drop under 1 Mbit/s", "at_least"),
        ("Rmin = 1 Mbit/s", "at_least"),
        ("at most 10 W", "at_most"), ("no more than 10 W", "at_most"), ("up to 10 W", "at_most"),
        ("under 10 W", "at_most"),
        ("below 10 W", "at_most"), ("less than 10 W", "at_most"), ("within 10 W", "at_most"), ("max 10 W", "at_most"),
        ("maximum power of 10 W", "at_most"), ("10 W max", "at_most"), ("10 W or less", "at_most"),
        ("<= 10 W", "at_most"),
        ("not exceeding 10 W", "at_most"), ("don't use more than 10 W", "at_most"), ("must not exceed 10 W", "at_most"),
        ("never go above 10 W", "at_most"), ("without going over 10 W", "at_most"), ("capped at 10 W", "at_most"),
        ("limited to 10 W", "at_most"), ("keep the power under 10 W", "at_most"), ("Pmax=10W", "at_most"),
        ("10 watts tops", "at_most"), ("no higher than 10 W", "at_most"), ("not over 10 W", "at_most"),
        ("exactly 10 W", "exactly"), ("precisely 1 Mbit/s", "exactly"), ("正好1兆", "exactly"),
        ("至少1兆", "at_least"), ("不低于1兆", "at_least"), ("不少于1兆", "at_least"), ("1兆以上", "at_least"),
        ("最低速率1兆", "at_least"), ("起码1兆", "at_least"), ("不超过10瓦", "at_most"), ("最多10瓦", "at_most"),
        ("10瓦以内", "at_most"), ("10瓦以下", "at_most"), ("最大功率10瓦", "at_most"), ("功率上限10瓦", "at_most"),
        ("功率别超过10瓦", "at_most"), ("低于10瓦", "at_most"), ("控制在10瓦以内", "at_most"),
        ("10瓦以上免谈", "at_most"), ("12瓦以上的功率我不要", "at_most"), ("超过四瓦一概不批", "at_most"),
        ("1兆以下绝对不行", "at_least"), ("1兆以下的用户不要管", "at_most"), ("anything over 10 W is out", "at_most"),
        ("with 10 W", None), ("10 W", None), ("max rate with 10 W", None), ("min power 1 Mbit/s each", None),
        ("maximum throughput, 10 W", None), ("用10瓦", None),
    ],
)  # fmt: skip
def test_comparator(text: str, comparator: str | None) -> None:
    assert only(text).comparator == comparator


def test_two_quantities_keep_their_own_comparators() -> None:
    rate, power = parse_quantities("At least 1 Mbit/s each, at most 10 W")
    assert (rate.kind, rate.value, rate.comparator) == ("rate", 1e6, "at_least")
    assert (power.kind, power.value, power.comparator) == ("power", 10.0, "at_most")
    first, second = parse_quantities("1 Mbit/s at most 10 W")
    assert (first.comparator, second.comparator) == (None, "at_most")
    first, second = parse_quantities("每人至少半兆\uff0c总功率不超过43dBm")
    assert (first.value, first.comparator, second.comparator) == (5e5, "at_least", "at_most")
    assert second.value == pytest.approx(10**1.3, rel=1e-15)


@pytest.mark.parametrize(
    "text",
    ["between 1 and 2 Mbit/s", "1 to 2 Mbit/s", "1-2 Mbit/s", "1–2 Mbit/s", "from 1 to 2 Mbit/s", "1到2兆", "1~2兆"],
)
def test_a_range_is_a_floor_and_a_ceiling(text: str) -> None:
    low, high = parse_quantities(text)
    assert (low.value, low.comparator, high.value, high.comparator) == (1e6, "at_least", 2e6, "at_most")


def test_a_number_without_a_unit_is_bare() -> None:
    assert [(q.kind, q.value) for q in parse_quantities("max power 10")] == [("bare", 10.0)]
    assert [(q.kind, q.value) for q in parse_quantities("rate 5 each please")] == [("bare", 5.0)]
    assert [(q.kind, q.value) for q in parse_quantities("at least 2M")] == [("bare", 2e6)]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("at least 2M each", 2e6), ("500k each", 5e5), ("1M for everyone", 1e6), ("300k per user", 3e5),
        ("1.5M/user", 1.5e6),
        ("everyone gets at least 2M", 2e6), ("500k chacun", 5e5), ("300k por usuario", 3e5), ("1M für jeden", 1e6),
    ],
)  # fmt: skip
def test_a_scaled_number_for_each_is_a_rate(text: str, value: float) -> None:
    assert [(q.kind, q.value) for q in parse_quantities(text)] == [("rate", value)]


@pytest.mark.parametrize("text", ["5 G each", "$2k each", "500k in total", "2 m each"])
def test_what_else_is_said_of_each_is_no_rate(text: str) -> None:
    assert "rate" not in {q.kind for q in parse_quantities(text)}


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("12 wats", "power", 12.0), ("12 wat", "power", 12.0), ("300 milliwats", "power", 0.3),
        ("43 dbn", "power", 10**1.3),
        ("2 megabts", "rate", 2e6), ("500 kbis/s", "rate", 5e5), ("1 mpbs", "rate", 1e6), ("10 vatois", "power", 10.0),
    ],
)  # fmt: skip
def test_a_unit_may_have_one_slip(text: str, kind: str, value: float) -> None:
    (found,) = parse_quantities(text)
    assert (found.kind, found.text) == (kind, text)
    assert found.value == pytest.approx(value)


@pytest.mark.parametrize("text", ["8 want more", "3 wait", "2 megabites", "10 mbs", "5 mbpm", "12 cats", "43 dbx"])
def test_another_word_is_no_unit_with_a_slip(text: str) -> None:
    assert {q.kind for q in parse_quantities(text)} <= {"bare", "other"}


@pytest.mark.parametrize(
    "text",
    [
        "1,23,456 bit/s",
        "latency below 10 ms",
        "at least 5 Mbit/J",
        "at most 3 users",
        "at most a few watts",
        "up to several hundred kbit/s",
    ],
)
def test_a_bound_that_cannot_be_read_is_reported_not_dropped(text: str) -> None:
    assert only(text).kind == "other"


def test_capitals_that_leave_bits_or_bytes_open_are_doubtful() -> None:
    assert only("2 MB/S").doubtful
    assert not only("2 MB/s").doubtful
    assert not only("2 MBPS").doubtful


UNITS = {
    "W": ("power", Decimal(1)), "mW": ("power", Decimal("1e-3")), "kW": ("power", Decimal(1000)),
    "MW": ("power", Decimal(10**6)), "µW": ("power", Decimal("1e-6")), "毫瓦": ("power", Decimal("1e-3")),
    "bit/s": ("rate", Decimal(1)), "kbit/s": ("rate", Decimal(1000)), "Mbps": ("rate", Decimal(10**6)),
    "Gb/s": ("rate", Decimal(10**9)), "MB/s": ("rate", Decimal(8 * 10**6)), "kB/s": ("rate", Decimal(8000)),
    "兆": ("rate", Decimal(10**6)), "%": ("ratio", Decimal("0.01")),
}  # fmt: skip


@settings(deadline=None)
@given(
    number=st.decimals(min_value=0, max_value=999999, places=3, allow_nan=False),
    unit=st.sampled_from(sorted(UNITS)),
    gap=st.sampled_from(["", " "]),
    thousands=st.booleans(),
)
def test_any_number_with_a_unit_comes_back(number: Decimal, unit: str, gap: str, thousands: bool) -> None:
    kind, factor = UNITS[unit]
    text = f"{number:,f}" if thousands else f"{number:f}"
    found = only(f"use {text}{gap}{unit} now")
    assert (found.kind, found.value) == (kind, float(number * factor))


@settings(deadline=None)
@given(level=st.decimals(min_value=-120, max_value=80, places=1, allow_nan=False))
def test_any_level_in_dbm_comes_back(level: Decimal) -> None:
    assert only(f"{level} dBm").value == pytest.approx(math.pow(10, (float(level) - 30) / 10), rel=1e-14)


@settings(deadline=None, max_examples=300)
@given(
    text=st.text(max_size=80)
    | st.text(alphabet="0123456789.,-+eE kMGmWbBits/%dBm瓦兆千百十一半点 atleostmr", max_size=60)
)
def test_no_text_breaks_the_parser(text: str) -> None:
    end = 0
    for found in parse_quantities(text):
        assert end <= found.start < found.end <= len(text)
        assert text[found.start : found.end] == found.text
        assert not math.isnan(found.value)
        end = found.end


def test_absurd_numbers_are_infinite_not_errors() -> None:
    assert only("99999 dBm").value == math.inf
    assert only("9" * 400 + " W").value == math.inf


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("cinco vatios", "power", 5.0), ("veinticinco vatios", "power", 25.0), ("dix watts", "power", 10.0),
        ("zehn Watt", "power", 10.0), ("200 milivatios", "power", 0.2), ("0,08 kW", "power", 80.0),
        ("al menos 1.500 kbit/s por usuario", "rate", 1.5e6), ("3 megabits por segundo", "rate", 3e6),
        ("2 mégabits par seconde", "rate", 2e6), ("4 Megabit pro Sekunde", "rate", 4e6),
        ("vingt pour cent", "ratio", 0.2), ("5 por ciento", "ratio", 0.05), ("99 Prozent", "ratio", 0.99),
        ("a quarter of a megabit", "rate", 250e3), ("a half watt", "power", 0.5),
        ("每人2M", "rate", 2e6), ("每人五百k", "rate", 5e5), ("不低于100 kbit/s的", "rate", 1e5),
        ("one miss in thirty", "ratio", 1 / 30), ("99 out of 100", "ratio", 0.99), ("九成八就够", "ratio", 0.98),
        ("quatre-vingt-dix-sept fois sur cent", "ratio", 0.97), ("une fois sur quarante", "ratio", 0.025),
        ("einmal in vierzig", "ratio", 0.025), ("diecinueve veces de cada veinte", "ratio", 0.95),
    ],
)  # fmt: skip
def test_plain_figures_of_other_languages_and_of_the_trade(text: str, kind: str, value: float) -> None:
    found = only(text)
    assert (found.kind, found.value) == (kind, value)


@pytest.mark.parametrize(
    "text",
    ["4M瓦", "每人2M赫兹", "the most bits out of one watt", "一瓦换最多的比特", "every joule counts"],
)
def test_what_is_no_figure_of_a_rate_or_a_power(text: str) -> None:
    assert not [found for found in parse_quantities(text) if found.kind in ("rate", "power")]


@pytest.mark.parametrize(
    ("text", "comparator"),
    [
        ("como mucho 10 W", "at_most"), ("10 W como máximo", "at_most"), ("al menos 1 Mbit/s", "at_least"),
        ("au plus 10 W", "at_most"), ("10 W au maximum", "at_most"), ("au moins 1 Mbit/s", "at_least"),
        ("höchstens 10 W", "at_most"), ("mindestens 1 Mbit/s", "at_least"), ("nicht mehr als 10 W", "at_most"),
        ("封顶八兆", "at_most"), ("没人掉到100 kbit/s以下", "at_least"), ("128 kbit/s or better", "at_least"),
    ],
)  # fmt: skip
def test_comparators_of_other_languages(text: str, comparator: str) -> None:
    assert only(text).comparator == comparator


@pytest.mark.parametrize("text", ["entre 1 y 2 Mbit/s", "entre 1 et 2 Mbit/s", "zwischen 1 und 2 Mbit/s"])
def test_ranges_of_other_languages(text: str) -> None:
    assert [(q.value, q.comparator) for q in parse_quantities(text)] == [(1e6, "at_least"), (2e6, "at_most")]


@pytest.mark.parametrize(
    "text",
    [
        "1 Mbit per minute each",
        "5 Mbit an hour",
        "2 megabits every minute",
        "每分钟1兆",
        "每人每小时300兆",
        "1 Mbit pro Minute",
    ],
)
def test_an_amount_in_another_time_is_no_rate(text: str) -> None:
    assert not [found for found in parse_quantities(text) if found.kind == "rate"]
    assert recognise(f"max rate, {text}").kind == "clarify"


def test_each_user_and_second_are_no_other_time() -> None:
    for text in ("1 Mbit each", "1 Mbps each", "每人1兆", "1 Mbit/s per user", "每秒1兆", "2 Mbit/s a user"):
        assert [found.kind for found in parse_quantities(text)] == ["rate"], text


def test_a_user_ahead_of_a_rate_with_a_suffix_is_no_part_of_it() -> None:
    for text, value in (("user 7 400k", 4e5), ("3 at least 1 500 kbit/s", 1.5e6), ("7 400k though", 4e5)):
        found = recognise(f"max rate, {text}")
        figures = {**found.constraints, **found.pending}.get("min_rate_bps", {})
        assert set(figures.values() if isinstance(figures, Mapping) else [figures]) == {value}, text
