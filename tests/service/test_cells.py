"""Cells that could never be talked to are not made."""

from __future__ import annotations

import pytest
from servers import Server

pytestmark = pytest.mark.machine_code


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"loss": ["random:nan"]}, "random:nan"),
        ({"loss": ["nonsense"]}, "nonsense"),
        ({"loss": [""]}, "loss pattern"),
        ({"recogniser": "llm"}, "WIRELESSAGENT_LLM_MODEL"),
    ],
)
def test_options_that_no_conversation_could_begin_with(server: Server, options: object, named: str) -> None:
    refused = server.post("v1/cells", {"name": "never", "options": options})
    assert refused.status_code == 422
    assert named in refused.json()["detail"]


def test_a_line_that_no_store_can_keep(server: Server) -> None:
    refused = server.post(f"v1/sessions/{server.cell()['session']}/turns", {"text": "highest\x00 rate"})
    assert (refused.status_code, "NUL" in refused.json()["detail"]) == (422, True)
