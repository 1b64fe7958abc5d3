"""What operators say every day behind a request in which one user has a rate of their own."""

from __future__ import annotations

from typing import Any

import pytest

from wirelessagent.language.acts import Aim, Limit, Named
from wirelessagent.language.conversation import understood
from wirelessagent.language.intent import acts_of
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context
from wirelessagent.language.request import Request, applied

LIMIT, OWN = Limit(kind="max_power_w", value=16.0), Limit(kind="min_rate_bps", value=2e6, whom=Named(("3",)))
BEFORE = Request(objective="max_rate", constraints={"max_power_w": 16.0})
HELD = Request(objective="max_rate", constraints={"max_power_w": 16.0, "min_rate_bps": {"3": 2e6}})
TALK = Context(
    user_names=tuple(f"user {number}" for number in range(1, 9)), objective=HELD.objective,
    constraints=HELD.constraints, acts=(OWN,), earlier=((Aim(objective="max_rate"), LIMIT), (OWN,)),
    past=(None, BEFORE), spoken_of=("user 3",),
)  # fmt: skip


def after(said: str) -> tuple[str, dict[str, Any]]:
    """The aim and the limits behind a line."""
    request, _ = applied(HELD, acts_of(understood(said, TALK, OfflineRecogniser())))
    assert request is not None
    return request.objective, dict(request.constraints)


@pytest.mark.parametrize(
    "said",
    [
        "everybody at least 500 kbps", "half a meg for each", "give everyone 500 kbps", "每人500k",
        "每个用户都要有500k",
        "Todos al menos 500 kbps", "Tout le monde au moins 500 kbit/s", "Tous au moins 500 kbit/s",
        "Keiner weniger als 500 kbit/s",
    ],
)  # fmt: skip
def test_a_rate_of_everybody_is_no_step_of_somebodys(said: str) -> None:
    assert after(said)[1]["min_rate_bps"] in (5e5, {"all": 5e5, "3": 2e6})


@pytest.mark.parametrize(
    ("said", "rate_bps"),
    [
        ("Usuario 3 al menos 500 kbps", 5e5),
        ("Utilisateur 3 au moins 500 kbit/s", 5e5),
        ("at least 500k more for user 3", 2.5e6),
        ("user 3 gets 500k less", 1.5e6),
        ("Augmente le débit minimum de l'utilisateur 3 jusqu'à 3 Mbit/s", 3e6),
        ("raise user 3 up to 3 Mbit/s", 3e6),
        ("Baja el mínimo del usuario 3 a 1 mega", 1e6),
        ("Baisse le minimum de l'utilisateur 3 à 1 Mbit/s", 1e6),
        ("Minimale Rate von Nutzer 3 auf 1 Mbit/s", 1e6),
        ("Pon la tasa mínima del usuario 3 en 1 Mbit/s", 1e6),
        ("Débit minimum de l'utilisateur 3 : 1 Mbit/s", 1e6),
        ("Minimum rate of user 3: 1 Mbit/s", 1e6),
        ("Monte le débit minimum de l'utilisateur 3 à 3 Mbit/s", 3e6),
        ("把用户3的最低速率设为1兆", 1e6),
        ("keep user 3 at 2 Mbps", 2e6),
    ],
)
def test_the_least_rate_of_somebody_is_set_and_no_aim(said: str, rate_bps: float) -> None:
    assert after(said) == ("max_rate", {"max_power_w": 16.0, "min_rate_bps": {"3": pytest.approx(rate_bps)}})


@pytest.mark.parametrize(
    "said",
    [
        "lower the power to 10 W and leave user 6 out", "leave out user 6 and lower the power to 10 W",
        "set the power to 10 W and drop user 6", "功率降到10瓦，去掉用户6",
    ],
)  # fmt: skip
def test_nobody_who_is_named_is_forgotten(said: str) -> None:
    assert after(said)[1] == {"max_power_w": 10.0, "min_rate_bps": {"3": 2e6}, "leave_out": ("6",)}


@pytest.mark.parametrize(
    ("said", "limits"),
    [
        ("same but without user 2", {"leave_out": ("2",)}),
        ("same but 8 W", {"max_power_w": 8.0}),
        ("the same, but 20 W", {"max_power_w": 20.0}),
        ("一样，但是8瓦", {"max_power_w": 8.0}),
        ("其他不变，去掉用户2", {"leave_out": ("2",)}),
        ("lo mismo pero sin el 2", {"leave_out": ("2",)}),
        ("das Gleiche aber mit 8 W", {"max_power_w": 8.0}),
        ("la même chose mais sans le 2", {"leave_out": ("2",)}),
    ],
)
def test_all_else_stays_the_same(said: str, limits: dict[str, Any]) -> None:
    assert after(said) == ("max_rate", {**HELD.constraints, **limits})


@pytest.mark.parametrize("said", ["same limits, but fair", "keep everything but make it fair"])
def test_an_aim_beside_the_same_limits(said: str) -> None:
    assert after(said) == ("proportional_fairness", dict(HELD.constraints))


@pytest.mark.parametrize(
    ("said", "power_w"),
    [("加4瓦", 20.0), ("ein Watt mehr", 17.0), ("un vatio más", 17.0), ("an extra 4 watts", 20.0)],
)
def test_more_power_is_no_question_of_what_it_would_bring(said: str, power_w: float) -> None:
    assert after(said)[1]["max_power_w"] == pytest.approx(power_w)


@pytest.mark.parametrize(
    "said",
    [
        "what would one more watt bring", "was bringt ein Watt mehr", "Nutzer 3 darf mehr bekommen", "用户3提速",
        "用户3限速",
        "Le 3 peut aller plus vite", "Sers les trois premiers", "Solo los dos primeros", "only the first two",
        "用户4优先",
    ],
)  # fmt: skip
def test_what_takes_nothing_away_takes_nothing_away(said: str) -> None:
    assert after(said) == ("max_rate", dict(HELD.constraints))


@pytest.mark.parametrize(
    "said",
    [
        "Nutzer 5 bleibt, Nutzer 6 raus", "Deja el 5 y quita el 6", "Quita el 6 pero deja el 5",
        "Garde le 5 et enlève le 6",
        "keep user 5 and drop user 6", "保留用户5，去掉用户6",
    ],
)  # fmt: skip
def test_who_stays_is_not_left_out(said: str) -> None:
    assert after(said)[1] in ({**HELD.constraints, "leave_out": ("6",)}, dict(HELD.constraints))


@pytest.mark.parametrize(
    ("said", "limits"),
    [
        (
            "power cap away, but 0.2 W per subcarrier at most",
            {"subcarrier_max_power_w": 0.2, "min_rate_bps": {"3": 2e6}},
        ),
        ("drop the power limit, user 4 at least 1 Mbps", {"min_rate_bps": {"3": 2e6, "4": 1e6}}),
    ],
)
def test_a_limit_goes_and_another_comes(said: str, limits: dict[str, Any]) -> None:
    assert after(said) == ("max_rate", limits)


FIRST = Context(user_names=TALK.user_names)


@pytest.mark.parametrize(
    ("said", "limits"),
    [
        ("don't leave user 8 out, max rate 10 W", {"max_power_w": 10.0}),
        ("功率不超过10瓦，用户8不要漏掉，速率最大", {"max_power_w": 10.0}),
        ("除了用户6和7，其他用户都服务，速率最大", {"leave_out": ("6", "7")}),
        ("不服务2和3，10瓦吞吐量最大", {"leave_out": ("2", "3"), "max_power_w": 10.0}),
        ("Máxima tasa, usuario 5 se queda y el 6 fuera", {"leave_out": ("6",)}),
        ("max rate, users 1 to 4 500k each", {"min_rate_bps": dict.fromkeys("1234", 5e5)}),
        ("Máxima tasa, usuarios 1 a 4 500 kbps cada uno", {"min_rate_bps": dict.fromkeys("1234", 5e5)}),
        ("Débit maximal, utilisateurs 1 à 4 500 kbit/s chacun", {"min_rate_bps": dict.fromkeys("1234", 5e5)}),
        ("max rate, increase the static power to 8 W", {"circuit_power_w": 8.0}),
        ("maximise the rate at fixed power 10 W", {"max_power_w": 10.0}),
        (
            "max rate, 1 Mbit/s at least for user 4, and user 8 no more than 5 Mbit/s",
            {"min_rate_bps": {"4": 1e6}, "max_rate_bps": {"8": 5e6}},
        ),
        ("max rate, leave out user 6 and user 4 at least 1 Mbps", {"min_rate_bps": {"4": 1e6}, "leave_out": ("6",)}),
        ("max rate, 2 Mbit/s pour le 3, et le 8 pas sous 350 kbit/s", {"min_rate_bps": {"3": 2e6, "8": 3.5e5}}),
        (
            "set rmin(user 4)=1.1 Mbps, rmax(user 8)=2 Mbps, goal=max sum rate",
            {"min_rate_bps": {"4": 1.1e6}, "max_rate_bps": {"8": 2e6}},
        ),
    ],
)
def test_a_first_line_of_every_day(said: str, limits: dict[str, Any]) -> None:
    intent = understood(said, FIRST, OfflineRecogniser())
    intent = intent.guess or intent  # what a yes would do
    assert (intent.objective, dict(intent.constraints)) == ("max_rate", limits)


@pytest.mark.parametrize(
    ("said", "aim", "limits"),
    [
        ("就服务二五七这三个 别的都不要 让最差的那个速率尽可能高", "max_min_rate", {"users": ("2", "5", "7")}),
        ("二号和四号不服务 十九瓦是上限 总速率最大", "max_rate", {"leave_out": ("2", "4"), "max_power_w": 19.0}),
        ("just one two five and eight nine watts tops highest total rate", "max_rate",
         {"users": ("1", "2", "5", "8"), "max_power_w": 9.0}),
        ("ohne die eins maximale Summenrate", "max_rate", {"leave_out": ("1",)}),
    ],
)  # fmt: skip
def test_what_is_dictated_without_commas(said: str, aim: str, limits: dict[str, Any]) -> None:
    intent = understood(said, FIRST, OfflineRecogniser())
    assert (intent.objective, dict(intent.constraints)) == (aim, limits)


@pytest.mark.parametrize("said", ["Maximiere die Mindestrate mit 10 W", "Maximise le débit minimum avec 10 W"])
def test_the_least_rate_is_an_aim_with_a_power(said: str) -> None:
    intent = understood(said, FIRST, OfflineRecogniser())
    assert (intent.objective, dict(intent.constraints)) == ("max_min_rate", {"max_power_w": 10.0})


@pytest.mark.parametrize(
    ("said", "limits"),
    [
        ("Nimm Nutzer 8 raus und begrenze die 5 auf 1 Mbit/s.", {"leave_out": ("8",), "max_rate_bps": {"5": 1e6}}),
        ("too thin. 3 Mbit/s for user 3, and don't serve user 8", {"leave_out": ("8",), "min_rate_bps": {"3": 3e6}}),
        ("Schaltung braucht 3,8 W. Und das Minimum der 3 kann weg.", {"circuit_power_w": 3.8, "min_rate_bps": None}),
        ("quita al 7 y limita el 2 a 1,5 Mbit/s", {"leave_out": ("7",), "max_rate_bps": {"2": 1.5e6}}),
        ("coupe le 6, et 12 W au total", {"leave_out": ("6",), "max_power_w": 12.0}),
        ("踢掉8号，总功率降到12瓦", {"leave_out": ("8",), "max_power_w": 12.0}),
    ],
)  # fmt: skip
def test_a_line_of_several_things_is_the_sum_of_its_parts(said: str, limits: dict[str, Any]) -> None:
    held = {**HELD.constraints, **limits}
    assert after(said)[1] == {name: value for name, value in held.items() if value is not None}


@pytest.mark.parametrize(
    "said",
    [
        "user 4 either 1 or 2 Mbit/s, user 5 500 kbit/s",
        "he said drop user 6, and give user 4 2 Mbit/s", "drop user 6 and give user 4 2 Mbit/s if it rains",
        "should we drop user 6, and give user 4 2 Mbit/s?",
        "Sure, crank it to 20 W and leave out user 4, because the electricity bill isn't insane enough already /s",
    ],
)  # fmt: skip
def test_parts_of_what_orders_nothing_or_is_at_odds_are_not_done(said: str) -> None:
    assert after(said) == (HELD.objective, dict(HELD.constraints))
