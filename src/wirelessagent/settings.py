"""Settings from the environment: ``WIRELESSAGENT_STORE_URL`` and so on, each a field of a class of settings."""

from __future__ import annotations

import os
from typing import ClassVar, Self

from pydantic import BaseModel, ConfigDict, Field, SecretStr, ValidationError

from wirelessagent.model.errors import InputError


class EnvironmentSettings(BaseModel):
    """Fields that environment variables of one prefix set, in any capitals; empty ones count as not set.

    Attributes:
        prefix: what the names of the variables begin with.
        trouble: what to say where a variable cannot be used.
        example: how to set them, at the end of that.
    """

    model_config = ConfigDict(frozen=True)

    prefix: ClassVar[str] = "WIRELESSAGENT_"
    trouble: ClassVar[str] = "the environment cannot be used"
    example: ClassVar[str] = ""

    @classmethod
    def read(cls) -> Self:
        """The settings as the environment has them now.

        Raises:
            InputError: one is missing or cannot be used; values are shown unless the class hides its input.
        """
        there = {name.upper(): value for name, value in os.environ.items() if value}
        names = {field: f"{cls.prefix}{field.upper()}" for field in cls.model_fields}
        try:
            return cls.model_validate({field: there[name] for field, name in names.items() if name in there})
        except ValidationError as error:
            wrong = [cls._told(str(item["loc"][0]), item["msg"], item["input"]) for item in error.errors()]
        example = f" ({cls.example})" if cls.example else ""
        raise InputError(f"{cls.trouble}: {'; '.join(wrong)}{example}")

    @classmethod
    def _told(cls, field: str, message: str, value: object) -> str:
        """What is wrong with one variable."""
        said = message.removeprefix("Value error, ").removeprefix("Input ")
        got = "" if cls.model_config.get("hide_input_in_errors") else f"; got {value!r}"
        return f"{cls.prefix}{field.upper()}: {said}{got}"


class Settings(EnvironmentSettings):
    """What is set for all commands of a user or a machine.

    Attributes:
        store: whether what is asked for is recorded.
        store_url: where: a SQLAlchemy URL or an SQLite file; a file in the user's data folder if not given.
    """

    store: bool = True
    store_url: str | None = None


class PseudonymSettings(EnvironmentSettings):
    """What user names are turned into pseudonyms with; read by itself, so that no other setting gets in its way.

    Attributes:
        pseudonym_key: 16 characters or more; names stay if not given.
    """

    model_config = ConfigDict(frozen=True, hide_input_in_errors=True)

    pseudonym_key: SecretStr | None = Field(None, min_length=16)
