"""The documents of the server's interfaces are true: what they say is taken, and every answer is as they say."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest
from examining import examined
from openapi_spec_validator import validate
from servers import Server, started, token_for

pytestmark = pytest.mark.machine_code

REST = ("openapi.json", "positive_data_acceptance", "coverage,fuzzing", "all")
"""A request that fits the document is refused with 422 where it names no plug-in, option or format that there is."""

_OFF = "ignored_auth,negative_data_rejection,unsupported_method"
PLUGIN = (("plugin/openapi.json", _OFF, "fuzzing", "all"), ("plugin/openapi.json", _OFF, "coverage", "positive"))
"""Bad data is answered by 200, the error inside; 401 and 405 are sent, but importers want them not listed. Coverage by
positive data alone, since its negative data leave the token out, too."""


@pytest.fixture(scope="module")
def platform(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server of its own, as what is sent there fills it."""
    store = tmp_path_factory.mktemp("platform") / "store.sqlite3"
    with started(store, "--requests-per-s", "5000", token=token_for(store, "platform", "operator")) as server:
        yield server


def test_the_document_is_one_of_openapi_3_1(server: Server) -> None:
    document = server.get("openapi.json")
    validate(document)
    assert document["openapi"].startswith("3.1")
    assert {"/v1/cells", "/v1/sessions/{id}/turns", "/v1/operations/{name}"} <= set(document["paths"])


@pytest.mark.parametrize(("document", "off", "phases", "mode"), [REST, *PLUGIN])
def test_answers_are_as_documented(platform: Server, document: str, off: str, phases: str, mode: str) -> None:
    found = examined(platform.url, document, most=8, off=off, token=platform.token, phases=phases, mode=mode)
    assert found.returncode == 0, found.stdout[-3000:]


def test_each_operation_of_the_catalogue_says_what_it_takes(server: Server) -> None:
    found = server.get("v1/operations")
    names = {operation["name"] for operation in found["operations"]}
    assert {"ask", "solve", "repair", "compare", "history show"} <= names
    assert not {"warm-up", "new-plugin", "reproduce"} & names
    for operation in found["operations"]:
        assert operation["schema"]["additionalProperties"] is False
        assert '"format": "path"' not in json.dumps(operation["schema"])
