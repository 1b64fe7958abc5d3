"""The texts of a surface that draws its own pages."""

from __future__ import annotations

from wirelessagent.service.problems import NotFoundError
from wirelessagent.telling.catalogue import languages, messages

LANGUAGES: list[str] = ["en", "zh", *sorted(languages() - {"en", "zh"})]
"""The languages there are: those of the most operators first."""


def words(language: str) -> dict[str, str]:
    """All texts in a language, by their keys.

    Raises:
        NotFoundError: there is no such language.
    """
    if language not in LANGUAGES:
        raise NotFoundError(f"there is no language {language!r}: known are {', '.join(LANGUAGES)}")
    return {**messages("en"), **messages(language)}
