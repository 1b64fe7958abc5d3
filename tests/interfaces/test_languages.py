"""Which language a line is in."""

from __future__ import annotations

import pytest

from wirelessagent.language.offline import recognise
from wirelessagent.language.training.examples import spoken
from wirelessagent.language.vocabulary import language_in_a_talk, language_of, languages_of

LINES = {
    "en": ["as fast as possible", "go back one step", "no need", "radiate as little as possible", "6 also back in"],
    "de": [
        "Hallo, was geht hier?",
        "alle 2 Mbit/s",
        "Update bitte",
        "doch lieber proportional fair",
        "Nutzer 3 abschalten",
        "Tempo rauf",
    ],
    "fr": [
        "bonjour, tu peux faire quoi ?",
        "turbo et mode éco",
        "sans plafond",
        "baisse la puissance",
        "l'autre aussi",
    ],
    "es": ["vuelve a ponerlo", "velocidad mínima total", "quita al usuario 8", "ahorra", "el otro también"],
    "zh": ["boost 速度", "5W以内"],
}


@pytest.mark.parametrize(("language", "text"), [(language, text) for language in LINES for text in LINES[language]])
def test_a_line_is_in_the_language_of_its_words(language: str, text: str) -> None:
    assert language_of(text) == language
    assert language in languages_of(text)


def test_what_people_write_is_hardly_ever_taken_for_another_language() -> None:
    written = [each for each in spoken() if each.language != "zh"][::40]
    wrong = {language: [each.text for each in written if each.language == language != language_of(each.text)]
             for language in ("en", "es", "fr", "de")}  # fmt: skip
    assert len(written) > 1_500
    shares = {language: len(wrong[language]) / sum(each.language == language for each in written) for language in wrong}
    assert shares["en"] < 0.005
    assert max(shares.values()) < 0.045


@pytest.mark.parametrize(("text", "before", "language"), [
    ("10 W", "de", "de"), ("ok", "fr", "fr"), ("no", "es", "es"), ("max rate", "zh", "en"),
    ("what about user 3?", "de", "en"),
    ("user 3 auch", "de", "de"), ("proportional fair", "de", "de"), ("export tmf921", "fr", "fr"),
    ("3 Mbit/s", "", "en"),
])  # fmt: skip
def test_a_word_that_tells_little_is_in_the_language_of_its_talk(text: str, before: str, language: str) -> None:
    assert language_in_a_talk(text, before) == language


@pytest.mark.parametrize(
    ("text", "aim", "limits"),
    [
        ("讓最弱的用戶速率最高,每個子載波最多0.6瓦。", "max_min_rate", {"subcarrier_max_power_w": 0.6}),
        ("發射功率越低越好,每個人至少500 kbit/s。", "min_power", {"min_rate_bps": 5e5}),
        ("比例公平分配,用戶1和用戶2權重2倍。", "proportional_fairness", {"weights": {"1": 2.0, "2": 2.0}}),
    ],
)
def test_traditional_characters_are_read_as_simplified_ones(text: str, aim: str, limits: dict[str, object]) -> None:
    intent = recognise(text)
    assert (intent.objective, dict(intent.constraints)) == (aim, limits)
