"""The documents of the server's interfaces are true: what they say is taken, and every answer is as they say."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from examining import examined
from openapi_spec_validator import validate
from servers import Server, started

pytestmark = pytest.mark.machine_code

OFF = "positive_data_acceptance"
"""A request that fits the document is refused with 422 where it names no plug-in, option or format that there is."""


def test_the_document_is_one_of_openapi_3_1(server: Server) -> None:
    document = server.get("openapi.json")
    validate(document)
    assert document["openapi"].startswith("3.1")
    assert {"/v1/cells", "/v1/sessions/{id}/turns", "/v1/operations/{name}"} <= set(document["paths"])


def test_answers_are_as_documented(tmp_path: Path) -> None:
    with started(tmp_path / "store.sqlite3", "--requests-per-s", "5000") as server:
        found = examined(server.url, "openapi.json", most=8, off=OFF)
    assert found.returncode == 0, found.stdout[-3000:]


def test_each_operation_of_the_catalogue_says_what_it_takes(server: Server) -> None:
    found = server.get("v1/operations")
    names = {operation["name"] for operation in found["operations"]}
    assert {"ask", "solve", "repair", "compare", "history show"} <= names
    assert not {"warm-up", "new-plugin", "reproduce"} & names
    for operation in found["operations"]:
        assert operation["schema"]["additionalProperties"] is False
        assert '"format": "path"' not in json.dumps(operation["schema"])
