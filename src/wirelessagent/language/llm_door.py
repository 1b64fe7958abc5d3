"""The only door to pydantic-ai and the OpenAI client, an optional package: a question to an endpoint, in bounded time.

Whatever goes wrong becomes :class:`NoAnswer` with a few words of ours: no text of a server, no address and no key
stand in them. The request goes to the endpoint alone: no redirects, no retries of the transport, no second endpoint.
"""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import (
    AsyncGenerator,
    AsyncIterable,
    AsyncIterator,
    Callable,
    Coroutine,
    Iterator,
    Mapping,
    Sequence,
)
from typing import TYPE_CHECKING, Any, TypeVar

from pydantic import BaseModel

from wirelessagent.language.llm_reasons import Objection, told
from wirelessagent.language.llm_settings import LlmSettings
from wirelessagent.language.llm_tool import LlmTool
from wirelessagent.model.errors import MissingDependencyError, WirelessAgentError

if TYPE_CHECKING:
    from pydantic_ai.models.openai import OpenAIChatModel

_HEADERS = ("host", "authorization", "content-type", "content-length", "accept", "accept-encoding", "connection")
_GRACE_S = 0.5  # for a cancelled request to close its connection
_MOST_ROUNDS_WITH_TOOLS = 8
_MOST_BYTES = 1_000_000

Answer = TypeVar("Answer")
Filled = TypeVar("Filled", bound=BaseModel)


class NoAnswer(Exception):
    """The LLM gave nothing that can be used; ``told`` says why, in the operator's language."""

    def __init__(self, key: str, names: Mapping[str, float] | None = None) -> None:
        self.key, self._names = key, names or {}
        super().__init__(self.told("en"))

    def told(self, language: str) -> str:
        return told(self.key, language, self._names)


def require_llm() -> None:
    """Raise :class:`MissingDependencyError` where the extra ``llm`` is not installed."""
    try:
        import openai
        import pydantic_ai  # noqa: F401  # pyright: ignore[reportUnusedImport]
    except ImportError as error:
        raise MissingDependencyError("pydantic-ai-slim[openai]", "llm", "the LLM recogniser") from error
    del openai


def fill_in(
    settings: LlmSettings, task: str, data: str, form: type[Filled], check: Callable[[Filled], Answer]
) -> Answer:
    """What ``check`` makes of the form that the LLM fills in; where it objects, the LLM is asked once more.

    Raises:
        NoAnswer: there is none, or none that holds.
    """
    objections: list[Objection] = []

    async def ask() -> Answer:
        from pydantic_ai import Agent, ModelRetry, NativeOutput, PromptedOutput, ToolOutput
        from pydantic_ai.usage import UsageLimits

        def checked(filled: Filled) -> Filled:
            try:
                check(filled)
            except Objection as objection:
                objections.append(objection)
                raise ModelRetry(objection.reason) from objection
            return filled

        ways: dict[str, Any] = {"tool": ToolOutput, "schema": NativeOutput, "words": PromptedOutput}
        agent: Any = Agent(output_type=ways[settings.output](form, name="meaning"), instructions=task, retries=1)
        agent.output_validator(checked)
        async with _model(settings) as model:
            limits = UsageLimits(request_limit=2)
            run = await agent.run(data, model=model, usage_limits=limits, event_stream_handler=_streaming(settings))
        return check(run.output)

    return _held(lambda: _within(settings, ask), objections)


def converse(
    settings: LlmSettings, task: str, data: str, tools: Sequence[LlmTool], check: Callable[[str, Sequence[str]], None]
) -> str:
    """What the LLM says to a question, having called the tools that it wants.

    ``check`` gets the answer and all that the tools told; where it objects, the LLM is asked once more.

    Raises:
        NoAnswer: there is none, or none that holds.
    """
    told: list[str] = []
    objections: list[Objection] = []

    async def ask() -> str:
        from pydantic_ai import Agent, ModelRetry
        from pydantic_ai.usage import UsageLimits

        def checked(answer: str) -> str:
            try:
                check(answer, told)
            except Objection as objection:
                objections.append(objection)
                raise ModelRetry(objection.reason) from objection
            return answer

        agent: Any = Agent(output_type=str, instructions=task, retries=1, tools=[_tool(tool, told) for tool in tools])
        agent.output_validator(checked)
        async with _model(settings) as model:
            limits = UsageLimits(request_limit=_MOST_ROUNDS_WITH_TOOLS)
            run = await agent.run(data, model=model, usage_limits=limits, event_stream_handler=_streaming(settings))
        return str(run.output)

    return _held(lambda: _within(settings, ask), objections)


def _held(ask: Callable[[], Answer], objections: Sequence[Objection]) -> Answer:
    """The answer, or what was last objected to where the second one did not hold either."""
    try:
        return ask()
    except NoAnswer as error:
        if objections and error.key == "unusable":
            raise NoAnswer(objections[-1].key) from None
        raise


def _tool(tool: LlmTool, told: list[str]) -> Any:
    """One of our tools as pydantic-ai's; what it refuses goes back to the LLM as the reason."""
    from pydantic_ai import ModelRetry, Tool

    def call(**values: Any) -> str:
        try:
            told.append(tool.run(tool.form.model_validate(values)))
        except (WirelessAgentError, ValueError) as error:
            raise ModelRetry(str(error)) from error
        except MemoryError as error:
            raise ModelRetry("that is too large") from error
        return told[-1]

    schema = tool.form.model_json_schema()
    return Tool.from_schema(call, name=tool.name, description=tool.summary, json_schema=schema)


@contextlib.asynccontextmanager
async def _model(settings: LlmSettings) -> AsyncGenerator[OpenAIChatModel]:
    """The model at its endpoint, its connections closed at the end."""
    from openai import AsyncOpenAI, DefaultAsyncHttpxClient
    from pydantic_ai.models.openai import OpenAIChatModel
    from pydantic_ai.providers.openai import OpenAIProvider

    key = "none" if settings.api_key is None else settings.api_key.get_secret_value()
    async with (
        DefaultAsyncHttpxClient(
            follow_redirects=False, trust_env=False, event_hooks={"request": [_keep_needed], "response": [_bounded]}
        ) as http,
        AsyncOpenAI(
            base_url=settings.base_url, api_key=key, max_retries=0, timeout=settings.timeout_s, http_client=http
        ) as client,
    ):
        yield OpenAIChatModel(settings.model, provider=OpenAIProvider(openai_client=client))


async def _keep_needed(request: Any) -> None:
    """Send no header but those that the protocol needs: the client adds some about this machine and its environment."""
    for name in [name for name in request.headers if name.lower() not in _HEADERS]:
        del request.headers[name]
    request.headers["accept-encoding"] = "identity"


async def _bounded(response: Any) -> None:
    """Read no answer of more than a megabyte, and none that is packed, as nobody asked for that."""
    from httpx2 import AsyncByteStream

    packed = response.headers.get("content-encoding", "identity").strip().lower() not in ("", "identity")
    if packed or int(response.headers.get("content-length") or 0) > _MOST_BYTES:
        raise NoAnswer("unreadable" if packed else "too_long")
    whole = response.stream

    class Counted(AsyncByteStream):
        def __aiter__(self) -> AsyncIterator[bytes]:
            return counted(whole)

        async def aclose(self) -> None:
            await whole.aclose()

    response.stream = Counted()


async def counted(parts: AsyncIterable[bytes]) -> AsyncIterator[bytes]:
    """The parts of an answer, as long as together they are not too much.

    Raises:
        NoAnswer: they are.
    """
    taken = 0
    async for part in parts:
        taken += len(part)
        if taken > _MOST_BYTES:
            raise NoAnswer("too_long")
        yield part


def _streaming(settings: LlmSettings) -> Any:
    """A handler that reads a stream to its end, which has the request made as one; None for a whole answer."""

    async def drain(_: Any, events: Any) -> None:
        async for _event in events:
            pass

    return drain if settings.stream else None


def _within(settings: LlmSettings, ask: Callable[[], Coroutine[Any, Any, Answer]]) -> Answer:
    """The result of a question, asked on a thread of its own: the caller may be running a loop already."""
    done: list[Answer] = []
    failed: list[NoAnswer] = []
    late = NoAnswer("late", {"seconds": settings.timeout_s})

    async def bounded() -> Answer:
        async with asyncio.timeout(settings.timeout_s):
            return await ask()

    def work() -> None:
        try:
            done.append(asyncio.run(bounded()))
        except TimeoutError:
            failed.append(late)
        except BaseException as error:  # noqa: BLE001  # whatever it is, the operator gets an answer
            failed.append(_understood(error))

    thread = threading.Thread(target=work, name="wirelessagent-llm", daemon=True)
    thread.start()
    thread.join(settings.timeout_s + _GRACE_S)
    if done:
        return done[0]
    raise failed[0] if failed else late


def _understood(error: BaseException) -> NoAnswer:
    """Why there is no answer, in words of ours: those of servers and libraries may hold anything."""
    from pydantic_ai import exceptions

    ours = next((each for each in _causes(error) if isinstance(each, NoAnswer)), None)
    if ours is not None:
        return ours
    if any(isinstance(each, UnicodeEncodeError) for each in _causes(error)):
        return NoAnswer("unsent")
    if isinstance(error, exceptions.ModelHTTPError):
        return NoAnswer("key" if error.status_code in (401, 403) else "status", {"status": error.status_code})
    if isinstance(error, exceptions.ContentFilterError):
        return NoAnswer("refused")
    if isinstance(error, exceptions.ModelConnectionError):
        return NoAnswer("broken" if error.phase == "read" else "unreachable")
    if isinstance(error, exceptions.UnexpectedModelBehavior | exceptions.UsageLimitExceeded):
        return NoAnswer("unusable")
    return NoAnswer("unreadable")


def _causes(error: BaseException) -> Iterator[BaseException]:
    """An error and what it came from."""
    cause: BaseException | None = error
    while cause is not None:
        yield cause
        cause = cause.__cause__ or cause.__context__
