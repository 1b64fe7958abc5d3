"""Short lines of talks in words that no form knows, judged by the model of talk lines."""

from __future__ import annotations

from typing import Any

import pytest
from tests.support.conversations import talked_into

from wirelessagent.language.conversation import leaning
from wirelessagent.language.conversation.leaning import LIKELY, Leaning
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.recogniser import Context

LEAST = ("least power, 300 kbit/s each",)


@pytest.mark.parametrize(
    ("lines", "holds"),
    [
        (("max bits per joule, the box itself eats 40 watts", "45, read it wrong"), {"circuit_power_w": 45.0}),
        (("Équité proportionnelle, 9 W maxi.", "Un de moins."), {"max_power_w": 8.0}),
        (("émets le moins possible et personne sous deux cents kilobits", "trois cents pardon"), {"min_rate_bps": 3e5}),
        (("max rate, 16 W tops", "4 at least a meg"), {"max_power_w": 16.0, "min_rate_bps": {"4": 1e6}}),
        (("max rate", "3 + 4 are visitors. skip"), {"leave_out": ("3", "4")}),
        (("max rate", "leave user 3 out", "venga, todos otra vez"), {}),
        ((*LEAST, "al 4 no le hace falta"), {"min_rate_bps": {"all": 3e5, "4": 0.0}}),
        ((*LEAST, "Nutzer 3 ausgenommen"), {"min_rate_bps": {"all": 3e5, "3": 0.0}}),
        (("máxima tasa total", "el usuario 4 como mucho 5 megabits", "kilobits, perdón"), {"max_rate_bps": {"4": 5e3}}),
        (("总速率最高,功率不超过12瓦", "改成10瓦", "往回退一步吧兄弟"), {"max_power_w": 12.0}),
        (("least power, user 2 at least 2 Mbit/s", "bump all the others up by a fifth"), {"min_rate_bps": {"2": 2e6}}),
        ((*LEAST, "user 2 at least 100 kbit/s", "bump all the others up by a fifth"),
         {"min_rate_bps": {"all": 3.6e5, "2": 1e5}}),
        (("max rate, user 1 counts triple", "hmm double rather"), {"weights": {"1": 2.0}}),
    ],
)  # fmt: skip
def test_lines_in_other_words_do_what_they_say(lines: tuple[str, ...], holds: dict[str, Any]) -> None:
    assert talked_into(*lines)[0] == {
        name: pytest.approx(value) if isinstance(value, float) else value for name, value in holds.items()
    }


@pytest.mark.parametrize(
    "said",
    ["Du darfst auf gar keinen Fall Nutzer 1 rausschmeißen!", "nice weather up here by the way, 12 degrees",
     "no sé, igual siete, déjame pensar", "los monitores son del 5, creo", "我就随口一说,没别的意思"],
)  # fmt: skip
def test_what_does_nothing_changes_nothing(said: str) -> None:
    assert talked_into("max rate, at most 12 W", "user 2 at least 1 Mbit/s", said)[0] == {
        "max_power_w": 12.0, "min_rate_bps": {"2": 1e6},
    }  # fmt: skip


def test_the_talk_leaves_out_what_a_line_cannot_be(monkeypatch: pytest.MonkeyPatch) -> None:
    context = Context(user_names=("user 1", "user 2"), objective="max_rate", language="en", max_power_w=20.0)
    line = Line.of("well 2 it is then, chum", context)

    class Judge:
        def probabilities(self, *_: object) -> dict[str, float]:
            return {"user": 0.7, "out": 0.25, "none": 0.05}

    monkeypatch.setattr(leaning, "shipped_model", lambda _: Judge())
    found = Leaning(line).read(LIKELY)  # nobody was named before, so that it names no other user
    assert found is not None
    assert [type(act).__name__ for act in found.acts] == ["LeaveOut"]
