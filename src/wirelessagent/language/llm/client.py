"""The only door to pydantic-ai and the OpenAI client, an optional package: a question to an endpoint, in bounded time.

Whatever goes wrong becomes :class:`NoAnswer` with a few words of ours: no text of a server, no address and no key
stand in them. The request goes to the endpoint alone: no redirects, no retries of the transport, no second endpoint.
Where that is, the environment says: ``WIRELESSAGENT_LLM_BASE_URL``, ``WIRELESSAGENT_LLM_MODEL`` and so on.
"""

from __future__ import annotations

import asyncio
import contextlib
import re
import threading
from collections.abc import AsyncGenerator, AsyncIterable, AsyncIterator, Callable, Coroutine, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, TypeVar
from urllib.parse import urlsplit

from pydantic import BaseModel, ConfigDict, Field, SecretStr, field_validator

from wirelessagent.model.errors import MissingDependencyError, WirelessAgentError
from wirelessagent.settings import EnvironmentSettings
from wirelessagent.telling.catalogue import has_message, message

_PREFIX = "WIRELESSAGENT_LLM_"
_HEADERS = ("host", "authorization", "content-type", "content-length", "accept", "accept-encoding", "connection")
_GRACE_S = 0.5  # for a cancelled request to close its connection
_MOST_ROUNDS_WITH_TOOLS = 8
_MOST_BYTES = 1_000_000
_WHY = ("no_answer", "did_not_hold", "not_asked")

Answer = TypeVar("Answer")


class LlmSettings(EnvironmentSettings):
    """Where the LLM is and how to speak to it.

    Attributes:
        base_url: of an endpoint that speaks the OpenAI protocol, such as http://localhost:11434/v1.
        model: its name there.
        api_key: sent to that endpoint only, and shown nowhere.
        timeout_s: the longest that an operator waits, a second question to the LLM included.
        stream: ask for the answer in pieces, for endpoints that give it in no other way.
        output: how the typed answer is asked for: by a tool call, by a JSON schema, or in words.
    """

    model_config = ConfigDict(hide_input_in_errors=True)

    prefix: ClassVar[str] = _PREFIX
    trouble: ClassVar[str] = "the LLM is not set up"
    example: ClassVar[str] = f"an example: {_PREFIX}BASE_URL=http://localhost:11434/v1 {_PREFIX}MODEL=qwen3"

    base_url: str
    model: str = Field(min_length=1)
    api_key: SecretStr | None = None
    timeout_s: float = Field(20.0, gt=0, le=600)
    stream: bool = False
    output: Literal["tool", "schema", "words"] = "tool"

    @field_validator("base_url")
    @classmethod
    def _is_plain_url(cls, url: str) -> str:
        parts = urlsplit(url)
        if not url.isascii() or any(sign <= " " or sign == "\x7f" for sign in url):
            raise ValueError("must be ASCII without spaces")
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise ValueError("must begin with http:// or https:// and name a host")
        if parts.username or parts.password or parts.query:
            raise ValueError(f"must hold no user, password or query; a key goes into {_PREFIX}API_KEY")
        if parts.port == 0:  # one that is no number or beyond 65535 raises by itself
            raise ValueError("must have a port between 1 and 65535")
        return url

    @field_validator("api_key")
    @classmethod
    def _fits_a_header(cls, key: SecretStr | None) -> SecretStr | None:
        if key is not None and not re.fullmatch(r"[!-~]+", key.get_secret_value()):
            raise ValueError("must be ASCII without spaces or line ends, as it is sent in a header")
        return key


class Objection(Exception):
    """Why a meaning cannot be so: ``reason`` for the LLM, and the ``key`` of what the operator is told."""

    def __init__(self, key: str, reason: str) -> None:
        super().__init__(reason)
        self.key, self.reason = key, reason


class NoAnswer(Exception):
    """The LLM gave nothing that can be used; ``told`` says why, in the operator's language."""

    def __init__(self, key: str, names: Mapping[str, float] | None = None) -> None:
        self.key, self._names = key, names or {}
        super().__init__(self.told("en"))

    def told(self, language: str) -> str:
        """The reason as one clause, "the LLM did not answer: HTTP 500"."""
        kind = next(kind for kind in _WHY if has_message(language, f"llm.{kind}.{self.key}"))
        reason = message(language, f"llm.{kind}.{self.key}", **self._names)
        return message(language, f"llm.because_{kind}", reason=reason)


@dataclass(frozen=True, kw_only=True)
class LlmTool:
    """A tool that an LLM may call: what the operations above hand in, and nothing else.

    ``run`` goes from a filled-in form to text and changes nothing; a ``WirelessAgentError`` is told to the LLM.
    """

    name: str
    summary: str
    form: type[BaseModel]
    run: Callable[[Any], str]


def require_llm() -> None:
    """Raise :class:`MissingDependencyError` where the extra ``llm`` is not installed."""
    try:
        import openai  # noqa: F401  # pyright: ignore[reportUnusedImport]
        import pydantic_ai  # noqa: F401  # pyright: ignore[reportUnusedImport]
    except ImportError as error:
        raise MissingDependencyError("pydantic-ai-slim[openai]", "llm", "the LLM recogniser") from error


def ask(
    settings: LlmSettings, task: str, data: str, check: Callable[[Any], Answer], *,
    form: type[BaseModel] | None = None, tools: Sequence[LlmTool] = (),
) -> Answer:  # fmt: skip
    """What ``check`` makes of an LLM's answer, a filled-in ``form`` or words; it may call the tools before.

    Where ``check`` raises an :class:`Objection`, the LLM is told and asked once more.

    Raises:
        NoAnswer: there is none, or none that holds.
    """
    made: list[Answer] = []

    async def answered() -> Answer:
        from pydantic_ai import Agent, ModelRetry, NativeOutput, PromptedOutput, ToolOutput
        from pydantic_ai.usage import UsageLimits

        def checked(answer: Any) -> Any:
            try:
                made.append(check(answer))
            except Objection as objection:
                raise ModelRetry(objection.reason) from objection
            return answer

        ways: dict[str, Any] = {"tool": ToolOutput, "schema": NativeOutput, "words": PromptedOutput}
        output = str if form is None else ways[settings.output](form, name="meaning")
        agent: Any = Agent(output_type=output, instructions=task, retries=1, tools=[_tool(tool) for tool in tools])
        agent.output_validator(checked)
        async with _model(settings) as model:
            limits = UsageLimits(request_limit=_MOST_ROUNDS_WITH_TOOLS if tools else 2)
            stream = _to_its_end if settings.stream else None  # a stream that is handled is asked for
            await agent.run(data, model=model, usage_limits=limits, event_stream_handler=stream)
        return made[-1]

    return _within(settings, answered)


def _tool(tool: LlmTool) -> Any:
    """One of our tools as pydantic-ai's; what it refuses goes back to the LLM as the reason."""
    from pydantic_ai import ModelRetry, Tool

    def call(**values: Any) -> str:
        try:
            return tool.run(tool.form.model_validate(values))
        except (WirelessAgentError, ValueError) as error:
            raise ModelRetry(str(error)) from error
        except MemoryError as error:
            raise ModelRetry("that is too large") from error

    schema = tool.form.model_json_schema()
    return Tool.from_schema(call, name=tool.name, description=tool.summary, json_schema=schema)


@contextlib.asynccontextmanager
async def _model(settings: LlmSettings) -> AsyncGenerator[Any]:
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


async def _to_its_end(_: Any, events: Any) -> None:
    async for _event in events:
        pass


def _within(settings: LlmSettings, ask: Callable[[], Coroutine[Any, Any, Answer]]) -> Answer:
    """The result of a question, asked on a thread of its own: the caller may be running a loop already."""
    result: Future[Answer] = Future()
    late = NoAnswer("late", {"seconds": settings.timeout_s})

    async def bounded() -> Answer:
        async with asyncio.timeout(settings.timeout_s):
            return await ask()

    def work() -> None:
        try:
            result.set_result(asyncio.run(bounded()))
        except TimeoutError:
            result.set_exception(late)
        except BaseException as error:  # noqa: BLE001  # whatever it is, the operator gets an answer
            result.set_exception(_understood(error))

    threading.Thread(target=work, name="wirelessagent-llm", daemon=True).start()
    try:
        return result.result(settings.timeout_s + _GRACE_S)
    except TimeoutError:
        raise late from None


def _understood(error: BaseException) -> NoAnswer:
    """Why there is no answer, in words of ours: those of servers and libraries may hold anything."""
    from pydantic_ai import exceptions

    cause: BaseException | None = error
    while cause is not None:
        if isinstance(cause, NoAnswer):
            return cause
        if isinstance(cause, Objection | UnicodeEncodeError):
            return NoAnswer(cause.key if isinstance(cause, Objection) else "unsendable")
        cause = cause.__cause__ or cause.__context__
    if isinstance(error, exceptions.ModelHTTPError):
        return NoAnswer("key" if error.status_code in (401, 403) else "status", {"status": error.status_code})
    if isinstance(error, exceptions.ContentFilterError):
        return NoAnswer("refused")
    if isinstance(error, exceptions.ModelConnectionError):
        return NoAnswer("broken" if error.phase == "read" else "unreachable")
    if isinstance(error, exceptions.UnexpectedModelBehavior | exceptions.UsageLimitExceeded):
        return NoAnswer("unusable")
    return NoAnswer("unreadable")
