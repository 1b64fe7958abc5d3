"""Intents in the shape of TMF921: what they can say becomes the same turn, what they cannot is refused by its name."""

from __future__ import annotations

import copy
import json
from typing import Any

import pytest
from servers import Server

from wirelessagent.model.errors import InputError
from wirelessagent.operations.intended import sentence_of

pytestmark = pytest.mark.machine_code

USERS = [f"user {number}" for number in range(1, 9)]


@pytest.mark.parametrize(
    "line",
    [
        "highest total rate, at most 10 W",
        "least power, at least 1 Mbit/s for user 2 and 500 kbit/s for user 3, kept with 95 %",
        "least power, 200 kbit/s for everyone, kept with 90 %",
        "max-min, at most 2 W, only users 1 and 2",
        "best energy efficiency",
        "proportional fairness, user 1 counts twice, at most 3 Mbit/s for user 4",
    ],
)
def test_what_was_said_comes_back_as_the_same_turn(server: Server, line: str) -> None:
    cell = server.cell()
    said = server.say(cell["session"], line)
    document = server.get(f"v1/intents/{said['stored']}")
    made = server.post(f"v1/intents?cell={cell['id']}", document["intent"])
    assert made.status_code == 201, made.text
    turn = made.json()
    assert turn["request"] == said["request"]
    assert turn["decision"] == said["decision"]
    assert turn["number"] == 1
    assert turn["session"] == server.get(f"v1/cells/{cell['id']}")["session"] != cell["session"]
    again = server.get(f"v1/intents/{turn['stored']}")["intent"]
    assert again["characteristic"] == document["intent"]["characteristic"]
    assert server.plan(turn["session"])


def test_one_that_is_refused_changes_nothing(server: Server) -> None:
    cell = server.cell()
    server.say(cell["session"], "highest total rate")
    plan = server.plan(cell["session"])
    for body, named in (({}, "objective"), ({"priority": "1", **intent()}, "priority"), ({"@type": "Fee"}, "@type")):
        refused = server.post(f"v1/intents?cell={cell['id']}", body)
        assert refused.status_code == 422
        assert named in refused.json()["detail"]
    assert server.post("v1/intents?cell=none", intent()).status_code == 404
    assert server.plan(cell["session"]) == plan


def intent(**characteristics: object) -> dict[str, Any]:
    """An intent as somebody else writes it."""
    floor = {
        "@id": "ex:floor", "@type": "icm:PropertyExpectation",
        "icm:target": {"rdfs:member": [{"@id": "ex:1", "rdfs:label": "user 2"}]},
        "log:allOf": {"@list": [{"quan:atLeast": {"@list": [
            {"quan:smallestInSet": {"@list": [{"icm:valuesOfTargetProperty": {"@list": [{"@id": "wa:DlThptPerUE"}]}}]}},
            {"rdf:value": 1000, "quan:unit": "kbit/s"},
        ]}}]},
    }  # fmt: skip
    return {
        "@type": "Intent", "name": "video",
        "characteristic": [{"name": name, "value": value} for name, value in
                           {"Objective": "max_rate", **characteristics}.items()],
        "expression": {"@type": "JsonLdExpression", "iri": "x", "expressionValue": {"log:allOf": {"@list": [floor]}}},
    }  # fmt: skip


def changed(what: str, by: object) -> dict[str, Any]:
    """The same with a part of its text changed."""
    return json.loads(json.dumps(intent()).replace(what, str(by)))


def test_what_others_write_is_read() -> None:
    assert sentence_of(intent(RadiatedPowerInW=10), USERS) == (
        "Please set this now: The highest total rate: at most 10 W of radiated power, at least 1 Mbit/s for user 2."
    )
    whole = copy.deepcopy(intent())
    del whole["expression"]
    assert sentence_of(whole, USERS) == "Please set this now: The highest total rate."


@pytest.mark.parametrize(
    ("given", "named"),
    [
        (intent(Latency=1), "characteristic Latency"),
        (intent(ForbiddenUESubcarriers=["user 1: 3"]), "ForbiddenUESubcarriers"),
        (intent(SubcarrierPowerInW=[1, 2]), "SubcarrierPowerInW"),
        (intent(RadiatedPowerInW="ten"), "RadiatedPowerInW: a number"),
        (intent(RadiatedPowerInW=10.123456), "max_power_w.*four digits"),
        (intent(RadiatedPowerInW=-1), "max_power_w"),
        (intent(ServedUEs=["nobody"]), "no user is called 'nobody'"),
        (intent(Objective="world_peace"), "world_peace"),
        (changed("user 2", "user 99"), "user 99"),
        (changed("atLeast", "atMost"), "quan:atMost of DlThptPerUE"),
        (changed("quan:atLeast", "quan:about"), "quan:about"),
        (changed("DlThptPerUE", "Latency"), "Latency"),
        (changed("kbit/s", "mph"), "unit is kbit/s"),
        (changed("icm:PropertyExpectation", "icm:DeliveryExpectation"), "DeliveryExpectation"),
        ({**intent(), "expression": {}}, "expressionValue"),
        ({**intent(), "characteristic": {}}, "characteristic: a list"),
        ({**intent(), "isBundle": True}, "isBundle"),
        ({**intent(), "validFor": {}}, "validFor"),
    ],
)
def test_what_cannot_be_asked_is_named(given: dict[str, Any], named: str) -> None:
    with pytest.raises(InputError, match=named):
        sentence_of(given, USERS)
