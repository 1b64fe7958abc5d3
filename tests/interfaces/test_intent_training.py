"""The templates, the sentences drawn from them, and the model that they made."""

from __future__ import annotations

import itertools
import json
import random
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from wirelessagent.language import training
from wirelessagent.language.conversation import read_by_rules as read_as_a_sentence
from wirelessagent.language.conversation.anchors import Anchored
from wirelessagent.language.conversation.line import Line
from wirelessagent.language.conversation.possible import Possible
from wirelessagent.language.conversation.signs import Read, Signs
from wirelessagent.language.conversation.weighing import weigh
from wirelessagent.language.figure_roles import LABELS
from wirelessagent.language.intent import COMMANDS, QUESTIONS, checked_constraints, same_constraints
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.order_model import Frame, OrderModel, shipped_order_model
from wirelessagent.language.sentence import BUILT_IN, Sentence, own_words
from wirelessagent.language.sentence_model import (
    KNOWN,
    SENTENCES_FILE,
    SentenceModel,
    hashes_of,
    places_of,
    rows_of,
    shipped_sentences,
)
from wirelessagent.language.text import hashed
from wirelessagent.language.training import meant, orders, talk_notation, talks
from wirelessagent.language.training.__main__ import taught
from wirelessagent.language.training.examples import (
    FRAMES,
    LANGUAGES,
    SURROUNDINGS,
    Example,
    Grammar,
    framed,
    sentences,
    slots,
    spoken,
)
from wirelessagent.language.training.meant import marked, unmarked
from wirelessagent.language.training.roles import NAMED
from wirelessagent.language.vocabulary import FOLDER as FOLDER_OF_BASE_WORDS
from wirelessagent.language.vocabulary import based, nearest, respelt
from wirelessagent.model.errors import InputError

FOLDER = Path(training.__file__).parent
ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def drawn() -> list[tuple[str, str]]:
    return list(sentences())


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_template_can_be_drawn(language: str) -> None:
    grammar = Grammar.read(FOLDER / f"{language}.txt")
    chance = random.Random(1)
    free = {"other": lambda _: "x", "wish": lambda _: "x"}
    for label, templates in grammar.templates.items():
        kind, _, topic = label.partition(".")
        assert kind in (*BUILT_IN, *SURROUNDINGS, "question", "command", "clarify", "out_of_scope")
        assert kind != "command" or topic in COMMANDS
        assert kind != "question" or topic in (*QUESTIONS, "fact")
        for template in templates:
            text = grammar.draw(template, chance, {**slots(language), **free})
            assert text or label == "opener"
            assert not set(text) & set("<>|"), (template, text)


def test_a_template_stands_for_its_alternatives() -> None:
    grammar = Grammar(language="en", templates={}, lists={"noun": ("(rate|speed)",)})
    texts = {grammar.draw("(max|best) (a|) <noun>", random.Random(seed), {}) for seed in range(60)}
    expected = {
        " ".join(filter(None, words)) for words in itertools.product(("max", "best"), ("a", ""), ("rate", "speed"))
    }
    assert texts == expected


def test_the_same_sentences_for_a_seed(drawn: list[tuple[str, str]]) -> None:
    assert drawn == list(sentences())
    assert drawn[:100] != list(itertools.islice(sentences(seed=2), 100))
    assert len(drawn) > 20_000


def letters(text: str) -> str:
    return re.sub(r"\W+", "", text.lower())


SETS = Path(__file__).parents[1] / "intents"


@pytest.fixture(scope="module")
def tested() -> set[str]:
    if not list(SETS.glob("held_out*.jsonl")):
        pytest.skip("the held-out sentences are not in the source distribution; run this in a checkout")
    files = sorted(SETS.glob("*.jsonl"))
    assert len(files) == 6
    return {letters(json.loads(line)["text"]) for file in files for line in file.read_text("utf-8").splitlines()}


def test_the_source_distribution_has_no_held_out_sentence() -> None:
    root = SETS.parents[1]
    left_out = tomllib.loads((root / "pyproject.toml").read_text("utf-8"))["tool"]["hatch"]["build"]["targets"]["sdist"]
    for file in SETS.glob("held_out*"):
        assert any(file.relative_to(root).match(pattern) for pattern in left_out["exclude"])


def test_no_long_sentence_of_the_test_sets_is_drawn(drawn: list[tuple[str, str]], tested: set[str]) -> None:
    long = {letters(text) for text, _ in drawn if len(text) > (12 if not text.isascii() else 40)}
    assert not long & tested


def test_no_sentence_of_the_test_sets_was_written_for_training(tested: set[str]) -> None:
    by_name = (unmarked(line)[0] for path in NAMED.glob("*.txt") for line in path.read_text("utf-8").splitlines())
    in_talks = (text for _, lines, _ in talk_notation.talks() for text, _ in lines)
    written = [*(each.text for each in spoken()), *(text for text, _ in meant.sentences()), *by_name, *in_talks]
    assert len(written) > 30_000
    assert [text for text in written if letters(text) in tested] == []


def test_spoken_sentences_have_labels_of_the_model_and_constraints_of_an_intent() -> None:
    labels = shipped_sentences().labels
    heads = {*labels, *(label.partition(".")[0] for label in labels), "order", "none"}
    wrong = [each for each in spoken() if each.label not in heads or not checked_constraints(each.constraints or {})]
    assert [each for each in wrong if each.label not in heads or each.constraints] == []


def test_an_installed_package_says_that_the_sentences_are_in_the_sources(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="checkout"):
        list(spoken(tmp_path))


@pytest.mark.parametrize(
    ("language", "tokens", "expected"),
    [
        ("de", ["dem", "langsamsten", "nutzer", "xqzt"], ["slow", "user", "xqzt"]),
        ("es", ["la", "maxima", "velocidad"], ["most", "speed"]),
        ("fr", ["le", "debit"], ["rate"]),
        ("zh", list("最慢的用户"), ["slow", "user"]),
        ("zh", [*"速率", "users", "龘"], ["rate", "user"]),
        ("xx", ["the", "speed"], ["speed"]),
    ],
)
def test_words_of_all_languages_meet_in_base_words(language: str, tokens: list[str], expected: list[str]) -> None:
    assert based(tokens, language) == expected


@pytest.mark.parametrize("language", LANGUAGES)
def test_base_words_are_forms_as_the_features_see_them(language: str) -> None:
    lines = (FOLDER_OF_BASE_WORDS / f"{language}.tsv").read_text("utf-8").splitlines()
    pairs = [(word, base) for base, words in (line.split("\t") for line in lines) for word in words.split(" ")]
    assert len({word for word, _ in pairs}) == len(pairs) > 10_000
    assert [word for word, base in pairs if word != word.lower() or not base.isascii() or not base] == []


def test_the_shipped_network_knows_the_labels_of_the_templates(drawn: list[tuple[str, str]]) -> None:
    assert {label for _, label in drawn} < set(shipped_sentences().labels)
    assert SENTENCES_FILE.stat().st_size < 3_000_000
    chances = Sentence("maximise the total rate", own_words()).chances
    assert sum(chances.kinds.values()) == pytest.approx(1.0)
    assert max(chances.kinds, key=lambda kind: chances.kinds[kind]) == "max_rate"
    assert chances.is_order
    assert not Sentence("yesterday we wanted to maximise the total rate", own_words()).chances.is_order


FRAMED = {"Yesterday {}": False, "He said {}": False, "Please {}": True, "Now {}": True}
WISHES = ("max total rate", "save power, 5 W at most", "user 3 at least 2 Mbit/s")


@pytest.fixture(scope="module")
def small() -> SentenceModel:
    """A network that was taught four frames with two wishes, and nothing else."""
    kinds = ("max_rate", "min_power")
    lines = [
        Example(form.format(wish), kind if does else "clarify.told", 1.0, does, 1.0, 1.0)
        for form, does in FRAMED.items() for wish, kind in zip(WISHES, kinds, strict=False)
    ]  # fmt: skip
    return taught(lines * 8, passes=16, processes=1)


def test_a_network_tells_apart_what_it_was_taught_also_once_it_is_written(small: SentenceModel, tmp_path: Path) -> None:
    small.save(tmp_path / "sentences.npz")
    for model in (small, SentenceModel.load(tmp_path / "sentences.npz")):
        for form, does in FRAMED.items():
            told = [model.chances(Sentence(form.format(wish), own_words()).words) for wish in WISHES]
            assert [chances.is_order for chances in told] == [does] * 3
            best = [max(chances.kinds, key=lambda kind: chances.kinds[kind]) for chances in told[:2]]
            assert best == (["max_rate", "min_power"] if does else ["clarify.told"] * 2)


def test_a_network_learns_whether_a_sentence_says_what_was_read_of_it() -> None:
    good, bent = "max rate, at most {} W", "max rate, at most {} W less"
    lines = [
        Example(form.format(watts), "max_rate", 1.0, True, 1.0, 1.0, form == bent, {"max_power_w": float(watts)})
        for watts in range(2, 40) for form in (good, bent)
    ]  # fmt: skip
    model = taught(lines, passes=24, processes=1)
    chances = [model.chances(Sentence(form.format(50), own_words()).words).faithful for form in (good, bent)]
    assert chances[0] > 0.9 > 0.1 > chances[1]


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ({"max_power_w": 10.0}, {"max_power_w": 10}, True),
        ({"max_power_w": 10.0}, {"max_power_w": 11}, False),
        ({"max_power_w": 10.0}, {}, False),
        ({"min_rate_bps": 1e6}, {"min_rate_bps": {"all": 1e6}}, True),
        ({"min_rate_bps": {"3": 1e6}}, {"min_rate_bps": {"4": 1e6}}, False),
        ({"min_rate_bps": {"all": 1e6, "3": 0.0}}, {"min_rate_bps": 1e6}, False),
        ({"users": ("1", "2"), "min_rate_bps": 1e6}, {"users": ("2", "1"), "min_rate_bps": {"1": 1e6, "2": 1e6}}, True),
        ({"users": ("1", "2")}, {"leave_out": ("1", "2")}, False),
    ],
)
def test_what_was_read_is_compared_with_what_is_meant(one: dict[str, Any], other: dict[str, Any], same: bool) -> None:
    assert same_constraints(one, other) == same_constraints(other, one) == same


def test_the_judge_of_orders_sees_the_frame_and_not_the_wish(tmp_path: Path) -> None:
    def frame(text: str) -> Frame:
        return Sentence(text, own_words()).frame

    said = [frame(form.format(wish)) for form in FRAMED for wish in WISHES[:2]]
    does = np.array([does for does in FRAMED.values() for _ in WISHES[:2]])
    orders.made(said, does, np.ones(len(does))).save(tmp_path / "orders.npz")
    model = OrderModel.load(tmp_path / "orders.npz")
    assert {form: model.score(frame(form.format(WISHES[2]))) > 0 for form in FRAMED} == FRAMED
    assert frame("Please max rate").tokens == frame("Please save power").tokens == ("please", "@")


def test_the_words_that_speak_against_an_order_are_quoted() -> None:
    said = "Tomorrow at eight, save power"
    start, end = shipped_order_model().against(Sentence(said, own_words()).frame) or (0, 0)
    assert said[start:end] == "Tomorrow at eight"
    assert shipped_order_model().against(Sentence("please save power now", own_words()).frame) is None


def test_what_the_training_hardly_saw_has_one_mark() -> None:
    words = Sentence("xqzt vbnm", own_words()).words
    known = np.zeros(KNOWN, np.bool_)
    rows = rows_of(*hashes_of(words), known)
    assert rows[1].tolist() == rows[2].tolist()
    known[places_of(np.array([hashed("wxqzt")]))] = True
    assert rows_of(*hashes_of(words), known)[1].tolist() != rows[2].tolist()


def test_a_sentence_too_long_to_be_read_to_its_end_orders_nothing() -> None:
    assert Sentence("please save power, " + "and so on " * 40, own_words()).chances.order > 0
    assert Sentence("please save power, " + "and so on " * 140, own_words()).chances.order == 0


def test_the_frames_for_training_have_one_place_and_are_no_sentence_of_a_test(tested: set[str]) -> None:
    lines = [line.split("\t") for path in sorted(FRAMES.glob("*.tsv")) for line in _lines(path)]
    assert {label for label, _ in lines} == {"order", "none"}
    assert all(frame.count("{}") <= 1 for _, frame in lines)
    assert not {letters(text) for text, *_ in framed()} & tested


def test_marked_sentences_have_known_roles_and_are_no_sentence_of_a_test(tested: set[str]) -> None:
    lines = [unmarked(line) for line in marked()]
    known = {role for labels in LABELS.values() for role in labels}
    assert {role for _, marks in lines for *_, role in marks} - {""} <= known
    assert not [text for text, _ in lines if set(text) & set("[]{}|")]
    assert not [text for text, _ in lines if letters(text) in tested]


def test_the_composed_bench_has_no_frame_of_the_training() -> None:
    """So that it measures what was not learned: the words around its wishes are its own."""
    trained = {letters(frame) for path in FRAMES.glob("*.tsv") for _, frame in map(_parted, _lines(path))}
    bench = [tomllib.loads(path.read_text("utf-8")) for path in (ROOT / "benchmarks" / "composed").glob("*.toml")]
    forms = [form for parts in bench for kind in ("acts", "asks") for each in parts[kind].values() for form in each]
    assert len(forms) > 200
    assert {form for form in forms if letters(form.replace("{wish}", "{}")) in trained} == {"{wish}"}


def _lines(path: Path) -> list[str]:
    return path.read_text("utf-8").splitlines()


def _parted(line: str) -> tuple[str, str]:
    label, _, frame = line.partition("\t")
    return label, frame


def test_features_are_the_same_everywhere() -> None:
    def seen(text: str) -> list[int]:
        return hashes_of(Sentence(text, own_words()).words)[0].tolist()

    assert seen("save power") == seen("SAVE  Power")
    assert seen("max rate") != seen("rate max")
    assert [hashed("save"), hashed("功率")] == [1432763102, 2471434032]


def test_slips_of_the_pen() -> None:
    assert respelt("比列公平,功律最抵") == "比例公平,功率最低"
    assert respelt("公里数") == "公里数"
    assert nearest("effiency", ["efficiency", "everyone"]) == "efficiency"
    assert nearest("zebra", ["efficiency"]) == ""


SAID = """# en
max rate, 300 kbit/s each => aim max_rate; limit min_rate_bps 300000 @all
user 4 gets 1 Mbit/s => limit min_rate_bps 1000000 @4
and 7 too => limit min_rate_bps 1000000 @7
thanks => nothing
no, 6 => undo 1; limit min_rate_bps 1000000 @6
the others half of that => scale min_rate_bps 0.5 @others
drop the floor of 4 => drop min_rate_bps @4
what if we left 2 out => suppose out 2
lift a cap that is not there => drop max_rate_bps
"""


def test_a_talk_is_an_example_a_line_with_what_it_comes_to(tmp_path: Path) -> None:
    (tmp_path / "one.txt").write_text(SAID, "utf-8")
    found = list(talk_notation.examples(tmp_path))
    assert [each.text for each in found] == [line.split(" => ")[0] for line in SAID.splitlines()[2:-1]]
    assert dict(found[1].effect) == {("min_rate_bps", "7"): 1e6}
    assert not found[2].effect
    assert dict(found[3].effect) == {("min_rate_bps", "7"): 3e5, ("min_rate_bps", "6"): 1e6}
    assert dict(found[4].effect) == {("min_rate_bps", user): 1.5e5 for user in "123578"}
    assert dict(found[5].effect) == {("min_rate_bps", "4"): None}
    assert dict(found[6].effect) == {("leave_out", "2"): 1.0, ("min_rate_bps", "2"): None}
    assert [each.supposed for each in found] == [False] * 6 + [True]


def test_a_model_of_talks_learns_what_it_is_shown_and_is_the_same_each_time(tmp_path: Path) -> None:
    (tmp_path / "one.txt").write_text(SAID, "utf-8")
    said = [talks.parsed(each) for each in talk_notation.examples(tmp_path)]
    model, again = (talks.trained(said) for _ in range(2))
    assert (model.weights == again.weights).all()
    for example in talk_notation.examples(tmp_path):
        line = Line.of(example.text, example.context)
        possible = Possible(Anchored.of(example.text, "en", talk_notation.USERS), example.context)
        read = Read.of(read_as_a_sentence(example.text, example.context, OfflineRecogniser()), possible)
        assert weigh(Signs(line, possible, read, "en"), model).said == (example.supposed, example.effect)
