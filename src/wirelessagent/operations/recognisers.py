"""Which recogniser understands sentences, as an option."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from pydantic import Field

from wirelessagent.operations.operation import InputError, Request

if TYPE_CHECKING:
    from wirelessagent.language.recogniser import Recogniser


def llm_model() -> str | None:
    """The LLM that the settings name; None where they name none that can be used."""
    from wirelessagent.language.llm.client import LlmSettings

    try:
        return LlmSettings.read().model
    except InputError:
        return None


class RecogniserOption(Request):
    """Requests that understand sentences."""

    recogniser: Literal["offline", "llm"] = Field(
        "offline", description="who understands: the offline recogniser, or the LLM of the settings"
    )

    def chosen_recogniser(self) -> Recogniser:
        """Who understands; the models, or pydantic-ai, are loaded only here."""
        if self.recogniser == "offline":
            from wirelessagent.language.offline import OfflineRecogniser

            return OfflineRecogniser()
        from wirelessagent.language.llm.reader import LlmRecogniser

        return LlmRecogniser()
