"""A call of a client: who calls, the work that it leads to, its progress, and a question back."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

from mcp.server.context import ServerRequestContext
from mcp.types import CallToolRequestParams, ElicitRequest, ElicitRequestFormParams, ElicitResult, InputRequiredResult
from mcp.types.version import MODERN_PROTOCOL_VERSIONS

from wirelessagent.service.access import Caller
from wirelessagent.service.assistant import Assistant
from wirelessagent.service.jobs import Tell
from wirelessagent.service.service import Service

Json: TypeAlias = dict[str, Any]

_ANSWER = "answer"
_FORM: Json = {
    "type": "object",
    "properties": {_ANSWER: {"type": "string", "title": "Answer", "description": "in your own words"}},
    "required": [_ANSWER],
}


@dataclass(frozen=True, kw_only=True)
class Call:
    """A call.

    Attributes:
        service: what it is about.
        caller: who calls.
        context: of the protocol.
        params: of a tool's call.
    """

    service: Service
    caller: Caller
    context: ServerRequestContext[Any, Any]
    params: CallToolRequestParams

    @property
    def assistant(self) -> Assistant:
        return Assistant(self.service)

    async def work(self, do: Callable[[Tell], Awaitable[Any]]) -> Any:
        """What came of some work; the client is told of its stages, and ends it by hanging up or cancelling.

        Raises:
            ProblemError: it failed.
        """
        job = self.service.job(self.caller, do)
        try:
            async for number, kind, said in job.told():
                if kind == "stage":
                    message = said["message"] or said["label"] or said["stage"]
                    await self.context.session.report_progress(number, None, message)
            return await job.finished()
        finally:
            job.cancel()

    # A question back: today's protocol ends the call with it, and the client calls again with the answer; before, the
    # server asked while the call went on.

    @property
    def may_ask(self) -> bool:
        """Whether the client's user can be asked something."""
        capabilities = self.context.session.client_capabilities
        if capabilities is None or capabilities.elicitation is None:
            return False
        return self._asks_by_ending or self.context.session.can_send_request

    @property
    def _asks_by_ending(self) -> bool:
        return self.context.protocol_version in MODERN_PROTOCOL_VERSIONS

    async def ask(self, question: str, state: str) -> str | InputRequiredResult | None:
        """The answer to a question; None where there is none, or what ends the call so that the client asks."""
        if self._asks_by_ending:
            asked = ElicitRequest(params=ElicitRequestFormParams(message=question, requested_schema=_FORM))
            return InputRequiredResult(input_requests={_ANSWER: asked}, request_state=state)
        result = await self.context.session.elicit_form(question, _FORM, self.context.request_id)
        return _text(result)

    @property
    def state(self) -> str | None:
        """What was given with the question that this call answers; the client may have changed it."""
        return self.params.request_state if self.params.input_responses is not None else None

    @property
    def answer(self) -> str | None:
        """The answer to the question that an earlier call ended with; None where there is none."""
        result = (self.params.input_responses or {}).get(_ANSWER)
        return _text(result) if isinstance(result, ElicitResult) else None


def _text(result: ElicitResult) -> str | None:
    said = (result.content or {}).get(_ANSWER) if result.action == "accept" else None
    return said if isinstance(said, str) and said.strip() else None
