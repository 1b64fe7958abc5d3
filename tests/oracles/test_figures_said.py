"""Figures as they are said in five languages: number words in full, units of the street, signs that mark thousands."""

from __future__ import annotations

import importlib
import re
from collections.abc import Sequence

import pytest

from wirelessagent.language.judged import Judged
from wirelessagent.language.number_words import spoken
from wirelessagent.language.quantities import Quantity, parse_quantities
from wirelessagent.language.text import CJK, normalise


def figures_of(text: str) -> Sequence[Quantity]:
    """The figures of a sentence, those that borrow the unit of another among them."""
    return Judged(normalise(text), parse_quantities(text), (), ()).figures


ENGLISH = [
    ("forty-five hundred kilobits", "rate", 4.5e6), ("a quarter of a megabit", "rate", 250e3),
    ("two and a half megs", "rate", 2.5e6), ("two megs a second", "rate", 2e6), ("five hundred kay", "rate", 5e5),
    ("half a million bits per second", "rate", 5e5), ("a dozen watts", "power", 12.0),
    ("half a dozen watts", "power", 6.0), ("out of eleven watts", "power", 11.0),
    ("twenty... six watts", "power", 26.0),
    ("a floor of two hundred kilobits", "rate", 2e5), ("2×10^6 bit/s", "rate", 2e6), ("1*10^5 bps", "rate", 1e5),
    ("2 x 10^6 bit/s", "rate", 2e6), ("1/2 Mbps", "rate", 5e5), ("½ Mbps each", "rate", 5e5),
    ("1'500 kbit/s", "rate", 1.5e6),
    ("3/4 of a megabit", "rate", 750e3), ("1½ Mbit/s", "rate", 1.5e6), ("2 and a half Mbit/s", "rate", 2.5e6),
    ("point five megabits", "rate", 5e5), ("nine hundred and ninety-nine milliwatts", "power", 0.999),
    ("20 dBms", "power", 0.1), ("UE2 ≥ 4 Mb/s / UE9", "rate", 4e6), ("1 mega per second", "rate", 1e6),
]  # fmt: skip
SPANISH = [
    ("treinta y cinco vatios", "power", 35.0), ("medio mega", "rate", 5e5), ("mil quinientos kilobits", "rate", 1.5e6),
    ("dos y medio megas", "rate", 2.5e6), ("0,7 megas mínimos para todos", "rate", 7e5),
    ("cien mil bits por segundo", "rate", 1e5), ("un cuarto de mega", "rate", 250e3),
    ("medio millón de bits por segundo", "rate", 5e5), ("2,5 millones de bits por segundo", "rate", 2.5e6),
    ("dos coma cinco vatios", "power", 2.5), ("noventa y nueve por ciento", "ratio", 0.99),
    ("ciento veinte milivatios", "power", 0.12), ("dieciséis vatios", "power", 16.0), ("menos 10 dBm", "power", 1e-4),
    ("una docena de vatios", "power", 12.0), ("30 decibelios milivatio", "power", 1.0), ("5 por mil", "ratio", 0.005),
    ("doscientas cincuenta mil bits por segundo", "rate", 250e3), ("1.500 kbit/s para el resto", "rate", 1.5e6),
    ("3 megas al segundo", "rate", 3e6),
]  # fmt: skip
FRENCH = [
    ("quatre-vingt-dix watts", "power", 90.0), ("un demi-méga", "rate", 5e5), ("vingt-et-un watts", "power", 21.0),
    ("deux mégas la seconde", "rate", 2e6), ("quatre cents kilobits", "rate", 4e5),
    ("soixante et onze W", "power", 71.0),
    ("quatre-vingt-quinze pour cent", "ratio", 0.95), ("trois quarts de mégabit", "rate", 750e3),
    ("un quart d'un mégabit", "rate", 250e3), ("mille cinq cents kbit/s", "rate", 1.5e6),
    ("deux virgule cinq mégabits par seconde", "rate", 2.5e6), ("1 Mo/s minimum", "rate", 8e6),
    ("600 ko/s", "rate", 4.8e6), ("deux et demi mégas", "rate", 2.5e6),
    ("cent vingt-quatre milliwatts", "power", 0.124),
    ("septante-cinq watts", "power", 75.0), ("un million de bits par seconde", "rate", 1e6),
    ("moins 10 dBm", "power", 1e-4), ("le débit de 1,500 Mbit/s pour tous", "rate", 1.5e6),
]  # fmt: skip
GERMAN = [
    ("siebzehneinhalb Watt", "power", 17.5), ("anderthalb Megabit", "rate", 1.5e6),
    ("achthundert Milliwatt", "power", 0.8), ("eine Viertelmillion Bit pro Sekunde", "rate", 250e3),
    ("dreieinhalb Megabit pro Sekunde", "rate", 3.5e6), ("zwei Komma fünf Watt", "power", 2.5),
    ("siebenundzwanzig Watt", "power", 27.0), ("hunderttausend Bit pro Sekunde", "rate", 1e5),
    ("ein halbes Megabit", "rate", 5e5), ("zweihundertfünfzig Kilobit", "rate", 250e3),
    ("eine halbe Million Bit in der Sekunde", "rate", 5e5), ("ein dreiviertel Megabit", "rate", 750e3),
    ("zwoelf Watt", "power", 12.0), ("neunzig Prozent", "ratio", 0.9),
    ("95-prozentiger Zuverlässigkeit", "ratio", 0.95),
    ("3 Promille", "ratio", 0.003), ("ein Dutzend Watt", "power", 12.0),
    ("eine Leistung von 1,500 kW für alle", "power", 1500.0), ("1.500 kbit/s für jeden", "rate", 1.5e6),
]  # fmt: skip
CHINESE = [
    ("一点五兆", "rate", 1.5e6), ("两兆半", "rate", 2.5e6), ("五百k", "rate", 5e5), ("四十七个dBm", "power", 10**1.7),
    ("一百二十八千比特每秒", "rate", 128e3), ("一百零五千比特每秒", "rate", 105e3),
    ("二十五千比特每秒", "rate", 25e3), ("三百千比特每秒", "rate", 3e5), ("一万五千比特每秒", "rate", 15e3),
    ("十哇以内", "power", 10.0), ("1.5个兆", "rate", 1.5e6),
]  # fmt: skip


@pytest.mark.parametrize(("text", "kind", "value"), [*ENGLISH, *SPANISH, *FRENCH, *GERMAN, *CHINESE])
def test_a_figure_is_read_as_it_is_said(text: str, kind: str, value: float) -> None:
    found = [(figure.kind, figure.value) for figure in parse_quantities(text) if figure.kind != "bare"]
    assert found == [(kind, pytest.approx(value, rel=1e-12))]


@pytest.mark.parametrize(
    "text",
    [
        "三十来瓦", "三十多瓦", "30多瓦", "十几瓦", "unos cientos de kilobits", "une trentaine de watts",
        "quelques watts", "ein paar Watt", "höchstens einige hundert Kilobit", "two three watts of noise",
        "as few watts as possible", "so wenige Watt wie möglich", "einen Megaherz", "2 mega vatios hora",
        "una velocidad media", "le mille-feuille", "un peu plus vite", "ein anderer Nutzer", "3 megapixels",
    ],
)  # fmt: skip
def test_nothing_vague_becomes_a_figure(text: str) -> None:
    found = [figure for figure in parse_quantities(text) if figure.kind not in ("other", "bare")]
    assert [figure.value for figure in found] == ([3.0] if "two three" in text else [])


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("UE 2 750 kbps, UE 3 500 kbps", [750e3, 500e3]), ("Nutzer 3 700 kbit/s", [700e3]),
        ("user one hundred kilobits", [1e5]), ("user 2 two megabits", [2e6]), ("12 500 mW", [12.5]),
        ("usuarios 1 y 2 500 kbit/s", [500e3]),
    ],
)  # fmt: skip
def test_the_number_of_a_user_is_no_part_of_the_figure(text: str, values: list[float]) -> None:
    assert [figure.value for figure in parse_quantities(text) if figure.kind in ("rate", "power")] == values


@pytest.mark.parametrize(
    ("words", "language"),
    [
        ("two three", "en"),
        ("dix deux", "fr"),
        ("vingt cinquante", "fr"),
        ("cien doscientos", "es"),
        ("drei vier", "de"),
    ],
)
def test_words_that_do_not_fit_together_are_no_number(words: str, language: str) -> None:
    found = spoken(words.split(), language)
    assert found is not None
    assert found.words == 1


FLOORS = [
    "nobody under 1 Mbit/s", "keiner unter 1 Mbit/s", "auf keinen Fall unter ein Megabit pro Sekunde",
    "unter 1 Mbit/s soll keiner fallen", "nadie por debajo de 1 Mbit/s", "sin bajar de 1 mega",
    "niemand unter 1 Mbit/s",
    "que nadie baje de 1 Mbit/s", "ne doit pas descendre sous 1 Mbit/s", "personne en dessous de 1 Mbit/s",
    "nadie con menos de 1 Mbit/s", "aucun utilisateur sous 1 Mbit/s", "谁都不许掉到1兆以下", "别低于1兆", "每户底限1兆",
    "降到每户刚好够1兆为止", "1 Mbit/s, no less.",
]  # fmt: skip
CEILINGS = [
    "auf 1 Mbit/s gedeckelt", "bei 1 Mbit/s kappen", "auf je 1 Mbit/s drosseln", "keiner über 1 Mbit/s",
    "nie mehr als 1 Mbit/s", "mehr als 1 Mbit/s braucht kein Mensch", "Obergrenze 1 Mbit/s",
    "Deckel pro Nutzer 1 Mbit/s",
    "plafonnés à 1 Mbit/s", "limite l'utilisateur 5 à 1 Mbit/s", "1 Mbit/s de plafond",
    "sans dépasser 1 Mbit/s",
    "ne pas aller au-delà de 1 Mbit/s", "brider UE 2 à 1 méga",
    "que no pase de 1 Mbit/s", "que nadie supere 1 mega", "limitado a 1 Mbit/s",
    "capado a 1 Mbit/s", "tope de 1 Mbit/s",
    "nunca por encima de 1 Mbit/s", "a nadie más de 1 mega",
    "stop user 1 at 1 Mbit/s", "with UE 2 throttled to 1 Mbps", "policed at 1 Mbps", "clamp each UE at 1 Mbps",
    "Cap UE 1 and UE 2 at 1 Mbps", "no UE past 1 Mbps", "nobody faster than 1 Mbps", "rate-cap subscriber 11 at 1 Mbps",
    "1 Mbit/s at the very most", "1 Mbit/s, no more", "限速1兆", "封到1兆", "人人不超1兆", "别超1兆", "上限各1兆",
]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "comparator"),
    [(text, "at_least") for text in FLOORS]
    + [(text, "at_most") for text in CEILINGS]
    + [
        ("1 Mbit/s, no less and no more", "exactly"), ("genau 1 Mbit/s", "exactly"), ("Max-Min bei 1 Mbit/s", None),
        ("权限1兆", None), ("mehr als 1 Mbit/s für jeden", "at_least"), ("plus de 1 Mbit/s chacun", "at_least"),
    ],
)  # fmt: skip
def test_a_figure_is_a_floor_a_ceiling_or_exact_in_every_language(text: str, comparator: str | None) -> None:
    (found,) = (figure for figure in parse_quantities(text) if figure.kind == "rate")
    assert (found.value, found.comparator) == (1e6, comparator)


@pytest.mark.parametrize(
    ("text", "rates"),
    [
        ("users 2, 4 and 6 get 1, 2 and 4 Mbit/s", [1e6, 2e6, 4e6]),
        ("mit 600 beziehungsweise 900 kbit/s", [6e5, 9e5]), ("mindestens 300 und höchstens 900 kbit/s", [3e5, 9e5]),
        ("user 1 two Mbit/s, user 2 one and a half, UE 3 750 kbit/s", [2e6, 1.5e6, 750e3]),
        ("User 1 should have 1 Mbit/s, user 2 should have 2 and user 3 should have 3", [1e6, 2e6, 3e6]),
        ("600 kbit/s for user 1, 100 for the others", [6e5, 1e5]), ("user 7 gets 4 Mbit/s, user 1 gets 1", [4e6, 1e6]),
        ("UE 1 vier Megabit, die anderen ein halbes", [4e6, 5e5]),
        ("Nutzer 2 vier Megabit, sonst jeder eins", [4e6, 1e6]),
        ("jeder 200 kbit/s, UE 3 sogar 800", [2e5, 8e5]), ("1 mega por usuario y 3 para el 5", [1e6, 3e6]),
        ("al abonado 1 con 5 megas y al 2 con 2", [5e6, 2e6]), ("seis megas cada uno; los demás, uno", [6e6, 1e6]),
        ("lo prometido en megas: 6 para el usuario 2, 3 para el usuario 3", [6e6, 3e6]),
        ("deux mégas à l'utilisateur 2 et un seul à l'utilisateur 3", [2e6, 1e6]),
        ("quatre mégabits pour l'utilisateur 1, deux pour l'utilisateur 2", [4e6, 2e6]),
        # none of these leans
        ("100 kbit/s aux UE 1 à 3 et le reste", [1e5]), ("1 Mbit/s Mindestrate für alle 25", [1e6]),
        ("4 Mbit/s for user 1, serve the other five.", [4e6]), ("Pr{R ≥ 1.5 Mbps} ≥ 0.95 for all k", [1.5e6]),
        ("1 Mbit/s each, users 2 and 3 first", [1e6]), ("in 2024, 2 Mbit/s each", [2e6]),
        ("1 Mbit/s for 12 users", [1e6]),
        ("4 Mbit/s for every other one", [4e6]), ("dos megas para el usuario 3 y medio mega para el resto", [2e6, 5e5]),
    ],
)  # fmt: skip
def test_a_number_leans_on_the_unit_of_another(text: str, rates: list[float]) -> None:
    assert [figure.value for figure in figures_of(text) if figure.kind == "rate"] == rates


@pytest.mark.parametrize(
    ("text", "powers"),
    [
        ("25, no, 30 W", [30.0]), ("10 W, perdón, 12", [10.0, 12.0]), ("dix watts, pardon, douze", [10.0, 12.0]),
        ("max ten watts, hang on, make that fifteen", [10.0, 15.0]), ("nimm 10 Watt, ach nein, 12", [10.0, 12.0]),
        ("nine watts on the air, the electronics take three", [9.0, 3.0]), ("10 W, no user above 12", [10.0]),
        ("10 W, sorry, 12 users", [10.0]), ("not one milliwatt more", []), ("pas un watt de plus", []),
    ],
)  # fmt: skip
def test_a_correction_takes_the_unit_of_what_it_corrects(text: str, powers: list[float]) -> None:
    assert [figure.value for figure in figures_of(text) if figure.kind == "power"] == powers


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("可靠性九成九五", 0.995), ("可靠性九成半", 0.95), ("20分之一的中断概率", 0.05),
        ("九成五", 0.95), ("可靠性九成九", 0.99), ("中断不超一成", 0.1), ("千分之一", 0.001), ("万分之五", 0.0005),
        ("nineteen times out of twenty", 0.95), ("99 times in a hundred", 0.99), ("one in twenty", 0.05),
        ("19 de cada 20", 0.95), ("que ça tienne neuf fois sur dix", 0.9), ("9 out of 10 users", None),
        ("serve 3 of 10", None), ("一成不变", None), ("设成20", None),
    ],
)  # fmt: skip
def test_shares_in_words_are_ratios(text: str, value: float | None) -> None:
    ratios = [figure.value for figure in parse_quantities(text) if figure.kind == "ratio"]
    assert ratios == ([] if value is None else [pytest.approx(value, rel=1e-12)])


@pytest.mark.parametrize(
    ("text", "ceilings"),
    [
        ("rate limits: 9 Mbps for user 1, 4 Mbps for user 2", [9e6, 4e6]),
        ("Nutzer 2 auf 2 Mbit/s deckeln und Nutzer 3 auf 4 Mbit/s", [2e6, 4e6]),
        ("cap user 1 at 2 Mbps and everyone else at 1 Mbps", [2e6, 1e6]),
        ("user 1 at most 2 Mbps, everyone 1 Mbps", [2e6]),
    ],
)
def test_a_bound_holds_for_the_next_figure_of_the_same_form(text: str, ceilings: list[float]) -> None:
    judged = Judged(normalise(text), parse_quantities(text), (), ())
    roles = [(figure.value, judged.role(place)) for place, figure in enumerate(judged.figures)]
    assert [value for value, role in roles if role == "max_rate_bps"] == ceilings


@pytest.mark.parametrize("module", ["text", "units", "number_words", "numerals", "comparators", "quantities"])
def test_the_patterns_of_the_parser_are_quick_to_compile(module: str) -> None:
    """A microsecond for each character of a pattern, milliseconds for a range over all of Chinese: every start pays."""
    members = vars(importlib.import_module(f"wirelessagent.language.{module}")).values()
    patterns = [member.pattern for member in members if isinstance(member, re.Pattern)]
    assert sum(map(len, patterns)) < 10_000
    assert not [pattern for pattern in patterns if CJK in pattern]
