"""What each figure and each named user of a sentence is there for, and the small model that says so."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from wirelessagent.language.constraints import read_constraints
from wirelessagent.language.figure_roles import BUCKETS, LABELS, Token, around, hashed, likely, shipped_roles, tokens_of
from wirelessagent.language.intent import same_constraints
from wirelessagent.language.offline import recognise
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.stated import Reading, loose_numbers, unread
from wirelessagent.language.text import normalise
from wirelessagent.language.training import roles as training

# Each in words that no list of this program holds, or that once meant something else to it.
STATED: list[tuple[str, dict[str, Any]]] = [
    # what a power is
    ("On cherche le meilleur rapport bits par joule, l'électronique consommant 5 W", {"circuit_power_w": 5.0}),
    ("设备自己就吃掉5瓦,每焦耳的数据最多", {"circuit_power_w": 5.0}),
    ("the box itself takes 35 W, most bits per unit of energy", {"circuit_power_w": 35.0}),
    ("Con los circuitos en 4 W y 12 W de emisión, lo más eficiente", {"circuit_power_w": 4.0, "max_power_w": 12.0}),
    ("Elektronikverbrauch 7,5 W, Senden maximal 28 W", {"circuit_power_w": 7.5, "max_power_w": 28.0}),
    ("Au lieu de 25 W, prends 14 W, équité proportionnelle", {"max_power_w": 14.0}),
    # what a correction leaves
    ("max rate, user 4 never above 5 Mbit/s, sorry, 6 Mbit/s", {"max_rate_bps": {"4": 6e6}}),
    ("max rate, at least 1 Mbit/s each, no, at most 2 Mbit/s", {"max_rate_bps": 2e6}),
    ("max rate, 5 W, no, 2 Mbit/s each", {"max_power_w": 5.0, "min_rate_bps": 2e6}),
    ("总速率最高，4号最多5兆，不对，6兆", {"max_rate_bps": {"4": 6e6}}),
    # what a rate is
    ("Max throughput, but user 4 never above 5 Mbit/s", {"max_rate_bps": {"4": 5e6}}),
    ("max rate with 2.5 Mbit/s each", {"min_rate_bps": 2.5e6}),
    ("with a max rate of 2 Mbit/s each, save power", {"max_rate_bps": 2e6}),
    ("best sum rate, nobdy below 750 kbit/s", {"min_rate_bps": 7.5e5}),
    ("max rate, no more than two and a half watts", {"max_power_w": 2.5}),
    ("8 Mbit/s de plafond par personne, la plus grande vitesse totale", {"max_rate_bps": 8e6}),
    ("Gesamtdurchsatz maximieren, Nutzer 8 wird auf 3 Mbit/s gedeckelt", {"max_rate_bps": {"8": 3e6}}),
    ("9号给他封到4兆,其余的总量往上顶", {"max_rate_bps": {"9": 4e6}}),
    ("clamp each UE at 15 Mbps and let it rip", {"max_rate_bps": 15e6}),
    ("Que el usuario 8 no pase de 6 Mbit/s", {"max_rate_bps": {"8": 6e6}}),
    # whose it is
    ("800 kbit/s al cliente número 2 y 300 kbit/s al resto", {"min_rate_bps": {"2": 8e5, "all": 3e5}}),
    ("64 kbit/s al usuario 1 y 16 kbit/s a los otros", {"min_rate_bps": {"1": 64e3, "all": 16e3}}),
    ("Rate limits: 9 Mbps for user 1, 4 Mbps for every other one", {"max_rate_bps": {"1": 9e6, "all": 4e6}}),
    ("User 2 should have between 1 and 2 Mbit/s, everybody else at least 200 kbit/s",
     {"min_rate_bps": {"2": 1e6, "all": 2e5}, "max_rate_bps": {"2": 2e6}}),
    # who is served
    ("UEs 3 & 18 barred, 17 W", {"leave_out": ("3", "18"), "max_power_w": 17.0}),
    ("Potencia mínima, usuarios 6 y 7 fuera", {"leave_out": ("6", "7")}),
    ("Teilnehmer 12 ist gesperrt und bekommt nichts", {"leave_out": ("12",)}),
    ("maximise la somme mais laisse dehors les utilisateurs 6 et 16", {"leave_out": ("6", "16")}),
    ("只排1、3、7号用户", {"users": ("1", "3", "7")}),
    ("Ne servez que les utilisateurs 1, 4 et 6", {"users": ("1", "4", "6")}),
    ("Busca el mejor rendimiento dejando fuera al 6 y al 12", {"leave_out": ("6", "12")}),
    # who weighs
    ("2号用户权重3,9号用户权重2", {"weights": {"2": 3.0, "9": 2.0}}),
    ("PF metric, w4=2, w8=0.5, total 16 W", {"weights": {"4": 2.0, "8": 0.5}, "max_power_w": 16.0}),
    ("double weight for user 1, one and a half for user 14, proportional fair", {"weights": {"1": 2.0, "14": 1.5}}),
    ("R4, R5 >= 1 Mbps, 8 W cap", {"min_rate_bps": {"4": 1e6, "5": 1e6}, "max_power_w": 8.0}),
    ("Nutzer 2 mit Gewicht 3, der Rest 1", {"weights": {"2": 3.0}}),
    # probabilities without a unit, or in words
    ("Energieeffizienz maximieren, Ausfallwahrscheinlichkeit 0,02", {"outage_probability": 0.02}),
    ("It has to hold 95 % of the time", {"outage_probability": 0.05}),
]  # fmt: skip

DESCRIBED = [
    "twelve buses upload their data over the next two hours, highest total rate",
    "sixty thousand people are in the stadium, open the taps",
    "three in the morning and nobody is awake, save power",
    "L'examen commence à 9 h pour 24 élèves, le plus de débit possible",
    "Um 18 Uhr kommen 300 Gäste, volle Kapazität",
    "A las 20:45 llegan 40 autobuses, capacidad máxima",
    "下午3点有300人开会,总速率最大",
]

LIMITS = [
    "max rate, 10 joules",
    "save power, 43 dB",
    "maximum throughput, power 10",
    "fastest, at most 50",
    "max rate, 1 2 Mbps",
    "proportional fair, weight -1 for user 2",
]


def reading(text: str) -> Reading:
    return read_constraints(text, normalise(text), parse_quantities(text))


def asked_about(text: str) -> bool:
    found = reading(text)
    return bool(found.doubts) or unread(normalise(text), [*found.masked, *found.counted]) is not None


@pytest.mark.parametrize(("text", "stated"), STATED)
def test_what_is_stated(text: str, stated: dict[str, Any]) -> None:
    found = reading(text)
    assert not found.doubts
    assert same_constraints(found.values, stated), found.values


@pytest.mark.parametrize("text", DESCRIBED)
def test_numbers_that_describe_are_not_asked_about(text: str) -> None:
    assert not asked_about(text)
    assert not reading(text).values


@pytest.mark.parametrize("text", LIMITS)
def test_numbers_that_may_be_limits_are_asked_about(text: str) -> None:
    assert asked_about(text)


def test_a_number_ends_where_a_name_begins() -> None:
    numbers = loose_numbers("权重3,9号用户", [(4, 8)])
    assert [(str(number.value), number.start, number.end) for number in numbers] == [("3", 2, 3)]


def test_what_lies_beyond_a_clause_counts_apart() -> None:
    tokens = tokens_of("save power, 5 W each", [Token("@power", 12, 15)])
    assert [token.word for token in tokens] == ["save", "power", ",", "@power", "each"]
    features = around(tokens, 3)
    assert {"R0each", "L1power"} <= features
    assert "near each" in features
    assert "near power" not in features


def shown(text: str, constraints: dict[str, Any]) -> list[tuple[str, set[str]]]:
    return [
        (
            example.question,
            {label for label, right in zip(LABELS[example.question], example.right, strict=True) if right},
        )
        for example in training.examples(text, constraints)
        if example.question != "link"
    ]


def test_a_meaning_shows_what_its_figures_are() -> None:
    text = "3 W in the circuits, 10 W on air, user 4 at 1 Mbit/s at most, skip user 5, room 12"
    meaning = {"circuit_power_w": 3, "max_power_w": 10, "max_rate_bps": {"4": 1e6}, "leave_out": [5]}
    assert sorted(shown(text, meaning), key=str) == sorted(
        [
            ("number", {"harmless"}), ("user", {"given"}), ("user", {"leave_out"}), ("power", {"circuit_power_w"}),
            ("power", {"max_power_w"}), ("rate", {"max_rate_bps"}),
        ],
        key=str,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("Leave user 3 out and maximise the rate", "Leave user 3 out"),
        ("max rate, 不要用户3", "不要用户3"), ("save power without user 3", "without user 3"),
        ("max rate without user 3", "without user 3"), ("maximale Rate ohne Nutzer 3", "ohne Nutzer 3"),
        ("máxima tasa sin el usuario 3", "sin el usuario 3"), ("max rate, skip user 3", "skip user 3"),
        ("Without user 3 and with 150 kbit/s for all others, save power", "Without user 3"),
    ],
)  # fmt: skip
def test_the_words_that_say_what_somebody_is_there_for_are_evidence_and_wish_nothing(text: str, words: str) -> None:
    intent = recognise(text)
    assert (intent.kind, intent.constraints["leave_out"]) == ("allocate", ("3",))
    assert intent.evidence["leave_out"] == words


def test_marks_show_what_no_constraint_can() -> None:
    line = "drop [user 2]{stale}, that's wrong, [user 4]{leave_out}, [8 W]{part} halved or [3]{limit} in room 7"
    shown_by = [
        (
            example.question,
            {label for label, right in zip(LABELS[example.question], example.right, strict=True) if right},
        )
        for example in training.shown_by(line)
    ]
    assert shown_by == [
        ("number", {"power"}), ("number", {"harmless"}), ("user", {"stale"}),
        ("user", {"leave_out"}), ("power", {"part"}), ("power", {"max_power_w"}),
    ]  # fmt: skip


def test_a_meaning_whose_figure_was_not_read_shows_nothing_of_its_kind() -> None:
    assert shown("with 3 W", {"max_power_w": 7}) == []


def test_whose_a_rate_is() -> None:
    links = training.examples("user 1 2 Mbit/s, user 2 1 Mbit/s", {"min_rate_bps": {"1": 2e6, "2": 1e6}})
    assert [example.right for example in links if example.question == "link"] == [
        (True, False, False),
        (False, True, False),
    ]


def test_a_fitted_model_says_what_it_was_shown(tmp_path: Path) -> None:
    taught = [
        (f"{words} {watts} W", {name: watts})
        for watts in (3, 5, 8, 13)
        for words, name in (("boards eat", "circuit_power_w"), ("radiate up to", "max_power_w"))
    ]
    examples = [each for text, meaning in taught for each in training.examples(text, meaning)]
    weights = training.fit("power", [each for each in examples if each.question == "power"])
    training.save(tmp_path / "roles.npz", {"power": weights})
    with np.load(tmp_path / "roles.npz") as arrays:
        scaled = arrays["power_weights"] * arrays["power_scales"]
    for text, meaning in (("boards eat 21 W", "circuit_power_w"), ("radiate up to 21 W", "max_power_w")):
        (example,) = [e for e in training.examples(text, {meaning: 21}) if e.question == "power"]
        score = scaled[example.rows[0]].sum(axis=0)
        assert LABELS["power"][int(np.argmax(score))] == meaning


def test_the_shipped_model_answers_every_question() -> None:
    model = shipped_roles()
    for question, labels in LABELS.items():
        assert model.weights[question].shape == (BUCKETS, len(labels))
        assert np.abs(model.weights[question]).max() == 127


def test_every_question_has_its_own_hash() -> None:
    assert hashed("power", {"near circuit"}) != hashed("rate", {"near circuit"})


def test_probabilities_add_up() -> None:
    chances = likely([1000.0, 0.0, -5.0], ("a", "b", "c"))
    assert sum(chances.values()) == pytest.approx(1.0)
    assert max(chances, key=lambda name: chances[name]) == "a"


def test_the_sentences_to_learn_from_say_what_they_mean() -> None:
    sentences = list(training.sentences())
    assert len(sentences) > 300
    named = {name for _, meaning in sentences for name in meaning}
    assert {"max_power_w", "circuit_power_w", "users", "leave_out", "weights"} <= named
