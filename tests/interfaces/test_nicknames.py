"""What operators call users in a talk."""

from __future__ import annotations

import pytest

from wirelessagent.language.conversation.line import called, only_called, with_users
from wirelessagent.operations.chat import ChatRequest

NOTED = {
    "user 3 is the ambulance, just so you know": {"ambulance": "3"},
    "User 1 is the control room and user 7 the camera.": {"control room": "1", "camera": "7"},
    "用户3是急救车": {"急救车": "3"},
    "El usuario 2 es el médico.": {"médico": "2"},
    "L'utilisateur 6, c'est la caméra.": {"caméra": "6"},
    "User 5 ist die Leitstelle.": {"leitstelle": "5"},
}
NO_NAME = (
    "user 3 is slow", "user 3 is the slowest", "user 2 is the one", "user 3 is at the back", "is user 3 the ambulance?",
    "用户3是最慢的", "Nutzer 3 ist der langsamste", "leave user 2 out", "users 1 and 2 are the slow ones",
)  # fmt: skip


@pytest.mark.parametrize("text", NOTED)
def test_a_line_that_only_names_users_is_noted(text: str) -> None:
    assert dict(only_called(text)) == dict(called([text])) == NOTED[text]


@pytest.mark.parametrize("text", NO_NAME)
def test_what_is_said_of_a_user_is_no_name(text: str) -> None:
    assert called([text]) == {}


def test_an_order_beside_a_name_is_no_mere_note() -> None:
    for text in ("Nutzer 3 ist die Leitstelle, maximiere die Rate", "user 3 is the ambulance: 2 Mbit/s"):
        assert called([text])
        assert only_called(text) == {}


@pytest.mark.parametrize(
    ("text", "name", "read"),
    [
        ("the ambulance needs 2 Mbit/s", "ambulance", "user 3 needs 2 Mbit/s"),
        ("der Leitstelle 2 Mbit/s", "leitstelle", "Nutzer 3 2 Mbit/s"),
        ("débit maximal, et 2 Mbit/s au médecin", "médecin", "débit maximal, et 2 Mbit/s à l'utilisateur 3"),
        ("la potencia mínima, 2 Mbit/s para la cámara", "cámara", "la potencia mínima, 2 Mbit/s para el usuario 3"),
        ("急救车要2 Mbit/s", "急救车", "用户3要2 Mbit/s"),
        ("user 3 is the ambulance", "ambulance", "user 3 is the ambulance"),
        ("ambulances everywhere", "ambulance", "ambulances everywhere"),
    ],
)
def test_a_name_is_read_as_its_user(text: str, name: str, read: str) -> None:
    assert with_users(text, {name: "3"}) == read


def test_a_promise_to_a_name_is_one_to_its_user() -> None:
    session = ChatRequest(no_store=True).session(lambda event: None)
    assert session.say("user 3 is the ambulance, just so you know").lines.decided.startswith("Noted: ambulance = 3")
    assert session.request is None
    session.say("save power, everyone gets at least 300 kbit/s")
    session.say("the ambulance needs 1 Mbit/s though")
    assert session.request is not None
    assert session.request.constraints["min_rate_bps"] == {"all": 3e5, "3": 1e6}
    session.say("user 4 is the ambulance")
    session.say("at most 500 kbit/s for the ambulance")
    assert session.request.constraints["max_rate_bps"] == {"4": 5e5}
