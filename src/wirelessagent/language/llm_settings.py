"""Where the LLM is, from the environment: ``WIRELESSAGENT_LLM_BASE_URL``, ``WIRELESSAGENT_LLM_MODEL`` and so on."""

from __future__ import annotations

from typing import Literal
from urllib.parse import urlsplit

from pydantic import Field, SecretStr, ValidationError, field_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

from wirelessagent.model.errors import InputError

_PREFIX = "WIRELESSAGENT_LLM_"


class LlmSettings(BaseSettings):
    """Where the LLM is and how to speak to it.

    Attributes:
        base_url: of an endpoint that speaks the OpenAI protocol, such as http://localhost:11434/v1.
        model: its name there.
        api_key: sent to that endpoint only, and shown nowhere.
        timeout_s: the longest that an operator waits, a second question to the LLM included.
        stream: ask for the answer in pieces, for endpoints that give it in no other way.
        output: how the typed answer is asked for: by a tool call, by a JSON schema, or in words.
    """

    model_config = SettingsConfigDict(
        env_prefix=_PREFIX, frozen=True, extra="ignore", env_ignore_empty=True, hide_input_in_errors=True
    )

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
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise ValueError("must begin with http:// or https:// and name a host")
        if parts.username or parts.password or parts.query:
            raise ValueError(f"must hold no user, password or query; a key goes into {_PREFIX}API_KEY")
        return url

    @classmethod
    def read(cls) -> LlmSettings:
        """The settings as the environment has them now.

        Raises:
            InputError: one is missing or cannot be used; the message holds names, no values.
        """
        try:
            return cls()  # pyright: ignore[reportCallIssue]  # filled from the environment
        except ValidationError as error:
            wrong = "; ".join(
                f"{_PREFIX}{str(item['loc'][0]).upper()}: {item['msg'].removeprefix('Value error, ')}"
                for item in error.errors()
            )
            raise InputError(
                f"the LLM is not set up: {wrong} (an example: {_PREFIX}BASE_URL=http://localhost:11434/v1 "
                f"{_PREFIX}MODEL=qwen3)"
            ) from None
