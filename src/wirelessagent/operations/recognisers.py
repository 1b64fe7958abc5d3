"""Which recogniser understands sentences, as an option."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Recogniser
from wirelessagent.operations.operation import Request


class RecogniserOption(Request):
    """Requests that understand sentences."""

    recogniser: Literal["offline", "llm"] = Field(
        "offline", description="who understands: the offline recogniser, or the LLM of the settings"
    )

    def chosen_recogniser(self) -> Recogniser:
        """Who understands; pydantic-ai is loaded only here."""
        if self.recogniser == "offline":
            return OfflineRecogniser()
        from wirelessagent.language.llm import LlmRecogniser

        return LlmRecogniser()
