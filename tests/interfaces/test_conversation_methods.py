"""The operator names the method: it is used from then on, or refused in the operator's language."""

from __future__ import annotations

import pytest
from conversations import talk

from wirelessagent.agent.turn import Turn
from wirelessagent.language.llm.prompt import plain

HELD = "highest total rate, at most 10 W"


def method_of(turn: Turn) -> str:
    assert turn.run is not None
    return turn.run.decision.method


@pytest.mark.parametrize(
    ("said", "name"),
    [
        ("use the paper's method", "paper"),
        ("switch to exact", "exact"),
        ("solve it with greedy instead", "greedy"),
        ("use the equal power method, please", "equal_power"),
        ("用论文的方法", "paper"),
        ("改用精确法", "exact"),
        ("换成贪心算法试试", "greedy"),
    ],
)
def test_a_method_that_is_named_is_used_from_then_on(said: str, name: str) -> None:
    session, turns = talk(HELD, said, "now with 5 W", "highest total rate, at most 8 W", "what if 3 W?", "undo")
    assert [method_of(turn) for turn in turns[1:5]] == [name] * 4
    assert session.request is not None
    assert session.request.method == name
    assert dict(session.request.constraints) == {"max_power_w": 5.0}


def test_a_method_goes_with_undo_back_to_a_turn_and_the_usual_one() -> None:
    session, turns = talk(
        HELD, "use greedy", "undo", "now with 5 W", "use exact", "back to turn 2", "use the usual method"
    )
    assert [method_of(turns[place]) for place in (3, 4, 5, 6)] == ["dual", "exact", "greedy", "dual"]
    assert "by greedy" in turns[5].reply
    assert session.request is not None
    assert session.request.method is None


@pytest.mark.parametrize(
    ("said", "name", "limits"),
    [
        ("use round robin and at least 1 Mbit/s for everyone", "round_robin", {"min_rate_bps": 1e6}),
        ("user 2 at most 100 kbit/s, and use greedy", "greedy", {"max_rate_bps": {"2": 1e5}}),
        ("用贪心算法，功率不超过5瓦", "greedy", {"max_power_w": 5.0}),
    ],
)
def test_a_method_that_is_named_beside_a_limit_is_used(said: str, name: str, limits: dict[str, object]) -> None:
    session, turns = talk("highest total rate", said)
    assert session.request is not None
    assert method_of(turns[1]) == name
    assert plain(session.request.constraints) == limits


def test_a_method_that_cannot_keep_the_limit_beside_it_is_refused_with_what_can() -> None:
    said = "use equal power and user 2 at most 100 kbit/s"
    turn = talk("highest total rate", said)[1][1]
    assert turn.stage == "nothing"
    assert "knows nothing of maximum rates" in turn.reply
    assert "dual, exact and greedy" in turn.reply
    first = talk(said)[1][0]  # no aim was named yet
    assert first.intent.kind == "clarify"
    assert "method equal_power again" in first.reply


def test_a_method_is_named_with_the_request() -> None:
    _, turns = talk(
        "highest total rate, at most 10 W, using greedy", "least power with 100 kbit/s each by the paper's method"
    )
    assert [method_of(turn) for turn in turns] == ["greedy", "paper"]


@pytest.mark.parametrize(
    ("said", "refusal", "able"),
    [
        (
            "use the paper's method",
            "The paper's method knows nothing of weights.",
            "Methods that can: dual, exact and greedy.",
        ),
        ("用论文的方法", "论文方法不支持权重。", "可用的方法：对偶法、精确法和贪心法。"),
    ],
)
def test_a_method_that_cannot_do_it_is_refused_in_the_operators_language(said: str, refusal: str, able: str) -> None:
    session, turns = talk(HELD, "user 3 counts with weight 2", said, "now with 5 W")
    assert turns[2].stage == "nothing"
    assert turns[2].reply.startswith(refusal)
    assert able in turns[2].reply
    assert method_of(turns[3]) == "dual"
    assert session.request is not None
    assert session.request.method is None


def test_what_a_method_would_make_of_it_is_compared_and_changes_nothing() -> None:
    said = ("what if we use greedy?", "能不能用论文的方法?", "用论文方法会怎样?", "what does the exact method give?")
    session, turns = talk(HELD, *said, "use user 3 only")
    assert [turn.tables[0].columns[2] for turn in turns[1:5]] == ["greedy", "论文方法", "论文方法", "exact"]
    assert session.request is not None
    assert session.request.method is None
    assert talk("use the paper's method")[1][0].reply.startswith("There is nothing yet to work on.")


def test_which_methods_there_are_is_told() -> None:
    _, turns = talk(HELD, "do it the paper's way", "which methods are there?", "有哪些方法?")
    assert turns[2].reply.startswith("In use: the paper's method. Methods that can: dual, ")
    assert turns[3].reply.startswith("正在使用：论文方法。可用的方法：对偶法、")


def test_a_step_that_the_method_cannot_solve_is_solved_by_another() -> None:
    _, turns = talk(
        HELD, "use the paper's method", "what would 100 kbit/s more for user 3 cost?", "3号再多1兆要多少功率?"
    )
    assert [turn.stage for turn in turns[2:]] == ["answered"] * 2
    assert "would lower the total rate" in turns[2].reply
    assert "则需要 " in turns[3].reply


@pytest.mark.parametrize(
    ("said", "told"),
    [
        (
            "what if at least 100 kbit/s for everyone?",
            "The paper's method knows nothing of minimum rates. Solved by dual",
        ),
        ("10瓦下最多能给每个人保证多少?", "改由对偶法求解。"),
    ],
)
def test_a_what_if_that_the_method_cannot_solve_is_solved_by_another(said: str, told: str) -> None:
    session, turns = talk(HELD, "use the paper's method", said)
    assert (turns[2].stage, method_of(turns[2])) == ("answered", "dual")
    assert told in turns[2].reply
    assert session.request is not None
    assert session.request.method == "paper"
