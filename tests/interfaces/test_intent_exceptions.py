"""Users who are exceptions: nobody is left out, and nobody promised a rate, by a word that says the opposite."""

from __future__ import annotations

import pytest

from wirelessagent.language.intent import checked_constraints
from wirelessagent.language.judged import Judged
from wirelessagent.language.offline import OfflineRecogniser, recognise
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.recogniser import Context
from wirelessagent.language.replies import limits_in_words
from wirelessagent.language.text import normalise
from wirelessagent.model.errors import InputError

KEPT = [
    "don't kick user 3 out", "please don't drop user 2", "do not leave out user 4", "user 3 stays in", "别把3号踢掉",
    "不要不服务2号", "不要把5号排除", "3号不用踢", "no dejes fuera al usuario 3", "Nutzer 3 nicht rauswerfen",
]  # fmt: skip
EXCEPTED = [
    "everybody but user 1 gets 500 kbps", "at least 300 kbps apart from users 2 and 3", "1号以外每人至少400k",
    "除1号外每人至少1兆", "每人至少1兆,3号除外",
    "tous sauf l'utilisateur 3 ont 1 Mbit/s", "alle außer Nutzer 3 bekommen 1 Mbit/s",
]  # fmt: skip
NEITHER = {
    **dict.fromkeys(["leave user 3 out", "ohne Nutzer 3", "不要3号", "forget user 3"], "leave_out"),
    **dict.fromkeys(["user 3 gets 1 Mbit/s", "3号1兆"], "given"),
    "only user 3": "users",
}


MORE_KEPT = [
    "user 8 isn't to be left out", "it's not true that user 7 should be dropped", "there's no reason to exclude user 1",
    "nobody needs to kick user 3 out", "user 6 shouldn't be excluded", "I don't want user 9 removed", "3号必须留着",
    "千万别把3号弄下线", "不可以踢掉3号", "no eches al usuario 2", "ne débranchez pas l'utilisateur 3",
]  # fmt: skip
PROMISED_NOTHING = [
    "user 4 is exempt from the floor", "no promise for user 7", "user 3 needs no minimum", "3号不用保证", "5号豁免",
    "pas de minimum pour l'utilisateur 2", "sin garantía para el usuario 4", "keine Garantie für Nutzer 3",
]  # fmt: skip
UNCAPPED = ["no cap on user 2", "the cap doesn't apply to user 2", "user 7 isn't limited", "3号不限速", "2号无上限"]
ALONE = ["nobody except user 3 is served", "no one but user 7", "除了6号都不服务", "除了2号谁也不服务"]


def role(text: str) -> str:
    """What the model takes the first user named for."""
    judged = Judged(normalise(text), parse_quantities(text), (), ())
    chances = judged.said_of(next(mention for mention in judged.mentions if mention.role == "named"))
    return max(chances, key=lambda name: chances[name])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        *((t, "kept") for t in (*KEPT, *MORE_KEPT)),
        *((t, "exempt") for t in (*EXCEPTED, *PROMISED_NOTHING)),
        *((t, "unclear") for t in UNCAPPED),
        *NEITHER.items(),
    ],
)
def test_what_an_exception_is(text: str, expected: str) -> None:
    assert role(text) == expected


@pytest.mark.parametrize("text", [*KEPT, *(f"max rate, {text}" for text in (*KEPT, *MORE_KEPT))])
def test_whoever_is_kept_is_not_left_out(text: str) -> None:
    constraints = recognise(text).constraints
    assert not constraints.keys() & {"leave_out", "users"}


@pytest.mark.parametrize(
    ("text", "floors"),
    [
        ("max rate, everyone except user 3 gets 1 Mbit/s", {"all": 1e6, "3": 0.0}),
        ("除了3号用户，每人至少1兆，总速率最高", {"all": 1e6, "3": 0.0}),
        ("max rate, at least 300 kbps apart from users 2 and 3", {"all": 3e5, "2": 0.0, "3": 0.0}),
        ("everyone, except user 2, gets 1 Mbit/s, least power", {"all": 1e6, "2": 0.0}),
        ("min power, 200 kbit/s each, but users 5 and 6 don't need any minimum", {"all": 2e5, "5": 0.0, "6": 0.0}),
        (
            "max rate, user 1 gets 2 Mbit/s, no promise for user 7, the others 1 Mbit/s",
            {"1": 2e6, "all": 1e6, "7": 0.0},
        ),
        ("总速率最高，每人至少1兆，3号不用保证", {"all": 1e6, "3": 0.0}),
        ("我只关心总的下载量，19号没有最低速率，其他每位至少200k", {"all": 2e5, "19": 0.0}),
        ("débit total maximal, tous sauf l'utilisateur 3 ont 1 Mbit/s", {"all": 1e6, "3": 0.0}),
        ("máximo caudal total y al menos 500 kbps para todos menos el usuario 3", {"all": 5e5, "3": 0.0}),
        ("maximale Summenrate, alle außer Nutzer 3 bekommen 1 Mbit/s", {"all": 1e6, "3": 0.0}),
    ],
)
def test_whoever_is_excepted_from_what_all_get_is_promised_nothing(text: str, floors: dict[str, float]) -> None:
    assert recognise(text).constraints == {"min_rate_bps": floors}


@pytest.mark.parametrize(
    "text", ["at most 2 Mbps each, except user 3 who is unlimited", "at least 1 and at most 2 Mbit/s each but user 4"]
)
def test_whoever_is_excepted_from_a_cap_is_asked_about(text: str) -> None:
    intent = recognise(f"max rate, {text}")
    assert intent.kind == "clarify", intent
    assert intent.reply.endswith(("?", "\uff1f"))


def test_nothing_is_promised_in_words() -> None:
    assert recognise("max rate, all but user 3 get 1 Mbit/s").reply.endswith(
        "at least 1 Mbit/s for each user but user 3."
    )
    assert recognise("总速率最高，除3号外每人至少1兆").reply == "总速率最高，除用户3外每个用户至少 1 Mbit/s。"
    floors = {"min_rate_bps": {"all": 1e6, "1": 2e6, "3": 0.0}}
    assert limits_in_words(floors, "en") == (
        "at least 2 Mbit/s for user 1, at least 1 Mbit/s for everyone else but user 3"
    )
    assert limits_in_words({"min_rate_bps": {"3": 0.0}}, "zh") == "不保证用户3的最低速率"


@pytest.mark.parametrize("text", ["max rate, at least 0 Mbit/s for everyone", "max rate, 0 bit/s each"])
def test_nothing_for_everybody_is_asked_about(text: str) -> None:
    assert recognise(text).kind == "clarify"


def test_zero_is_the_least_rate_of_a_named_user_alone() -> None:
    assert checked_constraints({"min_rate_bps": {"all": 1e6, "3": 0}})["min_rate_bps"] == {"all": 1e6, "3": 0.0}
    for floors in (0.0, {"all": 0.0}, {"all": 1e6, "3": -1.0}):
        with pytest.raises(InputError, match="min_rate_bps must be positive"):
            checked_constraints({"min_rate_bps": floors})


@pytest.mark.parametrize(
    "text", ["max rate for everyone except user 3", "除了3号，总速率最高", "save power, all but user 3"]
)
def test_a_wish_for_all_but_somebody_leaves_them_out(text: str) -> None:
    assert recognise(text).constraints.get("leave_out") == ("3",)


@pytest.mark.parametrize("text", UNCAPPED)
def test_whoever_has_no_cap_is_not_left_out(text: str) -> None:
    intent = recognise(f"max rate, at most 2 Mbit/s each, {text}")
    assert intent.kind == "clarify"
    assert "leave_out" not in intent.pending


@pytest.mark.parametrize(
    ("text", "constraints"),
    [
        ("users 1 to 4 at most 2 Mbps, no cap on user 3", {"max_rate_bps": dict.fromkeys("124", 2e6)}),
        ("users 1-4 at least 500k, no floor for user 2", {"min_rate_bps": dict.fromkeys("134", 5e5)}),
        ("cap users 4 to 6 at 3 Mbps, user 5 without a cap", {"max_rate_bps": dict.fromkeys("46", 3e6)}),
        (
            "at least 300k for everybody and at most 2 Mbps, no cap on user 3",
            {"min_rate_bps": 3e5, "max_rate_bps": dict.fromkeys("1245678", 2e6)},
        ),
        ("users 2, 4 and 6 at least 1 Mbps, but user 4 needs no guarantee", {"min_rate_bps": dict.fromkeys("26", 1e6)}),
    ],
)
def test_what_somebody_goes_without_is_taken_from_what_others_have(text: str, constraints: dict[str, object]) -> None:
    cell = Context(user_names=tuple(f"user {number}" for number in range(1, 9)))
    assert OfflineRecogniser().recognise(f"max rate, {text}", cell).constraints == constraints


@pytest.mark.parametrize("text", ALONE)
def test_whoever_is_the_only_exception_is_served_alone(text: str) -> None:
    aim = "proportional fairness, " if text.isascii() else "公平分配，"
    constraints = recognise(f"{aim}{text}").constraints
    assert "leave_out" not in constraints
    assert isinstance(constraints["users"], tuple)
    assert len(constraints["users"]) == 1


@pytest.mark.parametrize(
    ("text", "out"),
    [
        ("leave user 5 out, no, user 6", ("6",)),
        ("kick user 2 out, sorry, user 3", ("3",)),
        ("踢出19号，哦不是，踢出18号", ("18",)),
        ("去掉7号，不，7号留着，去掉17号", ("17",)),
        ("keep user 3 in, drop user 5", ("5",)),
        ("留着3号，去掉5号", ("5",)),
    ],
)
def test_who_is_left_out_may_be_corrected(text: str, out: tuple[str, ...]) -> None:
    assert recognise(f"max rate, {text}").constraints == {"leave_out": out}


def test_somebody_may_leave() -> None:
    assert recognise("让8号离开，总速率最高").constraints["leave_out"] == ("8",)


def test_whoever_is_excepted_may_have_a_cap_alone() -> None:
    names = tuple(f"user {number}" for number in range(1, 9))
    said = "max rate; everyone except user 1 must get at least 600 kbit/s; user 1 must not exceed 1 Mbit/s"
    constraints = OfflineRecogniser().recognise(said, Context(user_names=names)).constraints
    assert constraints == {"min_rate_bps": {"all": 6e5, "1": 0.0}, "max_rate_bps": {"1": 1e6}}
