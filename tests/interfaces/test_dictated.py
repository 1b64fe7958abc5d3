"""Lines as dictation spells them."""

from __future__ import annotations

from typing import Any

import pytest

from wirelessagent.language.as_meant import heard, without_corrected
from wirelessagent.language.sentence import Sentence, own_words, read_once
from wirelessagent.language.text import normalise

NAMES = tuple(f"user {number}" for number in range(1, 9))


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("lift the slowest user as far as you can with thirty dee bee em in total", {"max_power_w": 1.0}),
        ("max throughput total power twenty what's", {"max_power_w": 20.0}),
        ("no more than fifty milli what's on a subcarrier", {"subcarrier_max_power_w": 0.05}),
        ("highest some rate and keep user for under one and a half megabits", {"max_rate_bps": {"4": 1.5e6}}),
        ("max min and leave out user ate", {"leave_out": ("8",)}),
        ("greatest total throughput and user to capped at one megabit", {"max_rate_bps": {"2": 1e6}}),
        ("lowest transmit power that still gives user for a megabit", {"min_rate_bps": {"4": 1e6}}),
        ("maximise the sum with eighteen watts and drop user won", {"max_power_w": 18.0, "leave_out": ("1",)}),
        ("user for needs too megabits and keep the power low", {"min_rate_bps": {"4": 2e6}}),
        ("users won threw four get five hundred kay each", {"min_rate_bps": dict.fromkeys("1234", 5e5)}),
        ("cap user sicks at won point five megabits on any sub carrier", {"max_rate_bps": {"6": 1.5e6}}),
        ("potencia mínima y ocho cientos kilo bits para cada usuario", {"min_rate_bps": 8e5}),
        ("serve only users one too and five and max sum rate", {"users": ("1", "2", "5")}),
        ("users 1 to 3 only, max rate", {"users": ("1", "2", "3")}),
        ("drop user 3, also drop user 4", {"leave_out": ("3", "4")}),
        ("in blocks of six und vierzig dbm sind das limit", {"resource_block_group_size": 6, "max_power_w": 10.0}),
        ("en bloques de four con diez vatios", {"resource_block_group_size": 4, "max_power_w": 10.0}),
        ("puissance minimale et cinq sans kilobits par seconde pour chacun au minimum", {"min_rate_bps": 5e5}),
    ],
)
def test_what_dictation_misspells_is_read_as_it_was_said(text: str, values: dict[str, Any]) -> None:
    assert dict(Sentence(text, own_words(), names=NAMES).reading.values) == values


@pytest.mark.parametrize(
    "text",
    ["limit user to 2 Mbit/s", "limit users to at most 2 Mbit/s", "users to drop: 3", "drop user for now",
     "each user to get 1 Mbit/s", "the slowest user for now", "what's the rate of user 3",
     "sans limite pour 3", "some rate for user 3"],
)  # fmt: skip
def test_what_is_spelt_as_it_is_meant_stays(text: str) -> None:
    assert heard(text) == text


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("at fourteen watts uh no thirteen watts", "at thirteen watts"),
        ("para cada usuario quinientos no perdón cuatrocientos kilobits", "para cada usuario cuatrocientos kilobits"),
        ("plafonné à deux enfin non à trois mégabits", "plafonné à trois mégabits"),
        ("auf vierzig dbm ach quatsch achtunddreißig dbm", "auf achtunddreißig dbm"),
        ("每个人给五百哦不对给六百k", "每个人给 六百k"),
        ("gewicht zwei quatsch drei", "gewicht drei"),
        ("zwei megabit nee warte zweieinhalb megabit und", "zweieinhalb megabit und"),
        ("it is forty dbm not forty one and max rate", "it is forty dbm and max rate"),
        *(
            (text, text)
            for text in (
                "let me see the rate of user 3", "do you know what user 3 gets", "what kind of power is it",
                "halt user 3 at 2 Mbit/s", "a ver si sube", "voyons ce que donne 10 W", "du genre 10 W",
                "让用户3回来吧", "users two two and three", "保1号1 Mbps", "user 2 yes 2 megabits",
                "each user 2 megabits yes 2 users are out", "it does not work well",
                "al 3 no, al 8", "i would like 10 W", "no service for 6 no 10 W limit",
                "circuit power 10 W, power 10 W", "blocks of 4, yes, 4 W", "用户1、2就是2兆",
                "10 W, i said 10 W for circuits",
                "每人至少1，不是2兆", "con 10, no 20 vatios",
                "everybody at most 2 Mbit/s, yes 2 Mbit/s at least for user 4",
            )
        ),
    ],
)  # fmt: skip
def test_a_figure_that_is_taken_back_is_gone_before_a_line_is_read(said: str, meant: str) -> None:
    assert " ".join(without_corrected(said).split()) == meant


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("maximise bits per joule with 14 W, no, wait, maximise the sum rate", "14 W maximise the sum rate"),
        ("user 3 at least 1 Mbit/s and least power, sorry, max sum rate", "user 3 at least 1 Mbit/s and max sum rate"),
        ("min power no wait max rate no sorry proportional fairness", "proportional fairness"),
        ("mínima potencia, perdón, máxima tasa total", "máxima tasa total"),
        ("le plus gros débit total possible euh non équité proportionnelle", "équité proportionnelle"),
        ("minimale leistung nein moment maximale summenrate mit zehn watt", "maximale summenrate mit zehn watt"),
        ("能效最高，不对，总速率最高", "总速率最高"),
        *(
            (text, text)
            for text in (
                "give me max rate rather than min power", "we had been on max rate, no wait, least power",
                "max rate, no min power please", "min power, sorry, the circuit power is 5 W",
                "le débit maximal plutôt que la puissance minimale", "el peor usuario con el mejor caudal total",
                "max rate, sorry, no min power", "max rate, wait, minimum power matters too",
                "能效最高，口误，不是速率最高",
                "max rate, scrap that least power setting", "max rate, sorry, but least power is useless",
                "maximale Summenrate, warte mit minimaler Leistung",
            )
        ),
    ],
)  # fmt: skip
def test_the_aim_that_was_said_last_holds(said: str, meant: str) -> None:
    assert " ".join(read_once(said, own_words(), None).plain.split()) == " ".join(normalise(meant).split())
