"""Where the LLM is, from the environment: ``WIRELESSAGENT_LLM_BASE_URL``, ``WIRELESSAGENT_LLM_MODEL`` and so on."""

from __future__ import annotations

import re
from typing import ClassVar, Literal
from urllib.parse import urlsplit

from pydantic import ConfigDict, Field, SecretStr, field_validator

from wirelessagent.settings import EnvironmentSettings

_PREFIX = "WIRELESSAGENT_LLM_"


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
