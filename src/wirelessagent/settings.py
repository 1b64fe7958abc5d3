"""Settings from the environment: ``WIRELESSAGENT_STORE_URL`` and so on, each a field of :class:`Settings`."""

from __future__ import annotations

from pydantic import ValidationError
from pydantic_settings import BaseSettings, SettingsConfigDict

from wirelessagent.model.errors import InputError

_PREFIX = "WIRELESSAGENT_"


class Settings(BaseSettings):
    """What is set for all commands of a user or a machine.

    Attributes:
        store: whether what is asked for is recorded.
        store_url: where: a SQLAlchemy URL or an SQLite file; a file in the user's data folder if not given.
    """

    model_config = SettingsConfigDict(env_prefix=_PREFIX, env_ignore_empty=True, extra="ignore", frozen=True)

    store: bool = True
    store_url: str | None = None


def settings() -> Settings:
    """The settings as the environment has them now.

    Raises:
        InputError: one of them has a value that it cannot have.
    """
    try:
        return Settings()
    except ValidationError as error:
        first = error.errors()[0]
        name = _PREFIX + str(first["loc"][0]).upper()
        said = first["msg"].removeprefix("Input ")
        raise InputError(f"the environment variable {name}: {said}; got {first['input']!r}") from error
