"""How the library's objects show themselves: printed, in a notebook, as pictures, as plain data and as tables."""

from __future__ import annotations

import inspect
import json
import sys
import types
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent.agent.turn import Tools
from wirelessagent.model.errors import MissingDependencyError, UnknownNameError
from wirelessagent.model.shown import Plain, Shown

pytestmark = pytest.mark.machine_code

HOSTILE = "<b>7</b>\x1b[2J\n\u202e"
TOOLS = Tools(repairer="user_mean", method="equal_power")
DRAWN = ("Scene", "ChannelObservation", "ChannelEstimate", "Decision", "Outcome", "Report", "Comparison", "Run", "Turn")


def made(num_users: int, num_subcarriers: int, num_slots: int = 1) -> dict[str, Any]:
    """Each kind of object, made by the cheapest means."""
    cell = wa.Cell(max_power_w=20)
    size = {"num_users": num_users, "num_subcarriers": num_subcarriers, "num_slots": num_slots}
    scene = wa.simulate("rayleigh", cell, seed=1, speed_km_per_h=3.0 if num_slots > 1 else 0.0, **size)
    seen = scene.observe(wa.loss.random(0.3), seed=2)
    estimate = wa.repair(seen, "user_mean")
    problem = wa.Problem("max_rate", max_power_w=10)
    decision = wa.decide(estimate, problem, cell, "equal_power")
    outcome = wa.SimulatedBaseStation(scene).apply(decision)
    report = wa.report(decision, outcome)
    compared = wa.compare(estimate, problem, cell, ["equal_power", "round_robin", "paper_scan"])
    wanted = wa.Problem("max_rate", weights=np.arange(1.0, num_users + 1), forbidden=np.zeros(estimate.gain.shape))
    return {
        "Cell": cell,
        "Problem": wanted,
        "Scene": scene,
        "ChannelObservation": seen,
        "ChannelEstimate": estimate,
        "GammaPosterior": estimate.posterior,
        "Decision": decision,
        "Forecast": decision.forecast,
        "Prices": wa.Prices(log_rate=np.linspace(0, 1, num_users), log_power=0.0),
        "Outcome": outcome,
        "Report": report,
        "LinkMetrics": report.predicted,
        "Comparison": compared,
        "Compared": compared[0],
    }


@pytest.fixture(scope="module")
def session() -> wa.Session:
    scene = wa.simulate("rayleigh", num_users=4, seed=1)
    session = wa.Session(scene, wa.loss.random(0.2), seed=1, tools=TOOLS)
    session.say("Highest total rate, at most 10 W")
    session.say("hello")
    return session


@pytest.fixture(scope="module")
def small(session: wa.Session) -> dict[str, Any]:
    turn = session.turns[0]
    return {**made(8, 20), "Run": turn.run, "Turn": turn, "State": session.state}


@pytest.fixture(scope="module")
def large() -> dict[str, Any]:
    return made(64, 273, num_slots=3)


def all_of(*groups: dict[str, Any]) -> list[Any]:
    return [one for group in groups for one in group.values()]


def test_every_type_that_shows_itself_is_tried(small: dict[str, Any]) -> None:
    """Every public dataclass that holds results is one of them."""
    public = [getattr(wa, name) for name in dir(wa)]
    shown = {cls.__name__ for cls in public if inspect.isclass(cls) and issubclass(cls, Plain)}
    assert shown - small.keys() == {"BatchDecision", "FadingPosterior"}
    assert set(DRAWN) <= small.keys()


def test_printed_it_fits_in_twelve_lines(small: dict[str, Any], large: dict[str, Any]) -> None:
    for one in all_of(small, large):
        lines = repr(one).splitlines()
        assert 1 <= len(lines) <= 12, one
        assert max(map(len, lines)) <= 110, one


def test_the_first_line_says_what_it_is(small: dict[str, Any]) -> None:
    assert repr(small["Decision"]).startswith("Decision: feasible, ")
    assert repr(small["ChannelObservation"]).startswith("ChannelObservation: 8 users × 20 subcarriers, 48 of 160 gains")
    assert repr(small["ChannelEstimate"]).splitlines()[0].endswith("48 of 160 gains repaired by user_mean")
    assert repr(small["Run"]).startswith("Run: feasible, by equal power: ")
    assert repr(small["Turn"]).splitlines()[:2] == ["Turn 1: applied", "  said    Highest total rate, at most 10 W"]
    assert repr(wa.Problem("max_rate", max_power_w=10)) == (
        "Problem('max_rate', max_power_w=10, resource_block_group_size=1)"
    )


def test_what_is_long_is_wrapped_cut_or_counted() -> None:
    scene = wa.Scene(
        cell=wa.Cell(),
        sensed=wa.ChannelObservation(gain=np.ones((1, 2))),
        facts={"long": "word " * 40, **{f"fact {number}": "x" for number in range(20)}},
    )
    lines = repr(scene).splitlines()
    assert len(lines) == 12
    assert lines[-1] == "  … and 16 lines more"
    assert all(f"fact {number}" in scene._repr_html_() for number in range(20))


def test_text_of_strangers_is_shown_and_not_acted_on() -> None:
    names = (HOSTILE, "user 2")
    seen = wa.ChannelObservation(gain=np.array([[1e-10, np.nan], [1e-9, 1e-9]]), user_names=names)
    told = repr(seen), seen._repr_html_(), repr(wa.repair(seen, "user_mean"))
    for text in told:
        assert "\x1b" not in text
        assert "\u202e" not in text
        assert r"\u001b[2J\u000a\u202e" in text
    assert "<b>7" not in told[1]
    assert "&lt;b&gt;7" in told[1]


@pytest.mark.parametrize("name", DRAWN)
def test_a_notebook_gets_the_summary_and_a_picture(name: str, small: dict[str, Any]) -> None:
    one = small[name]
    page = one._repr_html_()
    assert "data:image/png;base64," in page
    assert one.summary().title.split(":")[0] in page
    assert len(page) < 300_000


def test_large_ones_are_drawn_too(large: dict[str, Any]) -> None:
    for name in ("ChannelEstimate", "Decision", "Report"):
        assert "data:image/png;base64," in large[name]._repr_html_()


def test_without_matplotlib_a_notebook_gets_the_summary_and_what_to_install(
    small: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    page = small["Decision"]._repr_html_()
    assert "<img" not in page
    assert "Decision: feasible" in page
    assert "pip install &#x27;wirelessagent[plot]&#x27;" in page
    with pytest.raises(MissingDependencyError, match=r"pip install 'wirelessagent\[plot\]'"):
        small["Decision"].plot()


@pytest.mark.parametrize("name", DRAWN)
def test_a_picture_can_be_had_and_saved(name: str, small: dict[str, Any], tmp_path: Path) -> None:
    picture = small[name].plot()
    picture.save(str(tmp_path / "picture.png"))
    assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")
    assert picture._repr_html_().startswith("<img")


def test_what_has_no_picture_says_so(session: wa.Session) -> None:
    turn = session.turns[1]
    assert turn.run is None
    assert "<img" not in turn._repr_html_()
    with pytest.raises(wa.InputError, match="there is nothing to draw: Turn 2"):
        turn.plot()


def test_gains_are_drawn_on_one_colour_scale(large: dict[str, Any]) -> None:
    panels = large["Scene"].plot().panels
    assert len(panels) == 2
    assert len({panel.axes.images[0].get_clim() for panel in panels}) == 1


def test_plain_data_is_ready_for_json(small: dict[str, Any], large: dict[str, Any]) -> None:
    for one in all_of(small, large):
        assert json.loads(json.dumps(one.to_dict(), allow_nan=False)) == one.to_dict()


def test_plain_data_is_the_fields_with_null_for_what_is_no_number(small: dict[str, Any]) -> None:
    seen = small["ChannelObservation"]
    found = seen.to_dict()
    assert [[value is None for value in row] for row in found["gain"]] == seen.missing.tolist()
    assert found["user_names"] == list(seen.user_names)
    decision = small["Decision"].to_dict()
    assert decision["owner"] == small["Decision"].owner.tolist()
    assert decision["problem"]["objective"] == {"name": "max_rate"}
    assert (decision["is_usable"], decision["total_power_w"]) == (True, pytest.approx(10.0))
    assert decision["price_of_power"] is None
    assert "estimate" not in decision
    assert small["Problem"].to_dict()["objective"] == "max_rate"


@pytest.fixture
def frames(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where pandas is not installed: its one class that is used, which refuses columns of different lengths."""

    def data_frame(columns: dict[str, Any]) -> dict[str, Any]:
        assert len({len(column) for column in columns.values()}) == 1
        return columns

    monkeypatch.setitem(sys.modules, "pandas", types.SimpleNamespace(DataFrame=data_frame))


@pytest.mark.usefixtures("frames")
def test_tables_have_a_row_for_each_entry_subcarrier_user_or_method(small: dict[str, Any]) -> None:
    rows = {name: len(next(iter(small[name].to_frame().values()))) for name in DRAWN}
    assert rows == {
        "Scene": 160, "ChannelObservation": 160, "ChannelEstimate": 160, "Decision": 20, "Outcome": 20, "Report": 8,
        "Comparison": 3, "Run": 4, "Turn": 1,
    }  # fmt: skip


@pytest.mark.usefixtures("frames")
def test_tables_keep_users_and_places_together(large: dict[str, Any]) -> None:
    seen, table = large["ChannelObservation"], large["ChannelObservation"].to_frame()
    for row in (0, 5000, 64 * 273 * 3 - 1):
        user = seen.user_names.index(table["user"][row])
        there = seen.gain[table["slot"][row], user, table["subcarrier"][row]]
        assert np.array_equal(there, table["gain"][row], equal_nan=True)
    decision, table = large["Decision"], large["Decision"].to_frame()
    assert [decision.user_names[owner] for owner in decision.owner] == list(table["user"])


def test_without_pandas_it_says_what_to_install(small: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match=r"Decision\.to_frame\(\) needs the package 'pandas'.*: pip install pandas$"):
        small["Decision"].to_frame()


def test_with_pandas_it_is_a_table_of_it(small: dict[str, Any]) -> None:
    pandas = pytest.importorskip("pandas")
    for name in DRAWN:
        assert isinstance(small[name].to_frame(), pandas.DataFrame)


def test_many_decisions_at_once_are_counted() -> None:
    shape = (3,)
    batch = wa.BatchDecision(
        owner=np.zeros((3, 5), dtype=int), power_w=np.ones((3, 5)), rate_bps=np.ones((3, 2)),
        status=np.array(["optimal", "feasible", "infeasible"]), value=np.array([1e6, 3e6, np.nan]),
        bound=np.full(shape, 4e6), gap=np.array([0.0, 0.25, np.nan]), unit="bit/s", problem=wa.Problem("max_rate"),
        cell=wa.Cell(),
    )  # fmt: skip
    assert repr(batch).splitlines() == [
        "BatchDecision: max_rate on 3 channels (3 × 2 × 5: channel, user, subcarrier)",
        "  status  1 feasible, 1 infeasible, 1 optimal",
        "  value   2 Mbit/s on average, gap at most 25 %",
        "  power   5 W on average",
    ]
    assert batch.to_dict()["value"] == [1e6, 3e6, None]
    assert list(batch.columns()["total_power_w"]) == [5, 5, 5]


def test_comparisons_are_gone_through_counted_and_indexed(small: dict[str, Any]) -> None:
    compared = small["Comparison"]
    assert [one.method for one in compared] == ["equal_power", "round_robin", "paper_scan"]
    assert (len(compared), compared[-1].method) == (3, "paper_scan")
    assert all(issubclass(type(one), Shown) for one in (compared, small["Report"]))


MISTAKES = {
    "an objective": (lambda: wa.Problem("max_rat"), "unknown objective 'max_rat': did you mean 'max_rate'?"),
    "an argument of a problem": (lambda: wa.Problem(max_power=10), "did you mean 'max_power_w'?"),
    "an argument of a cell": (lambda: wa.Cell(max_power=20), "did you mean 'max_power_w'?"),
    "an argument of an observation": (
        lambda: wa.ChannelObservation(gains=np.ones((1, 1))),
        "unknown argument 'gains' of ChannelObservation(…): did you mean 'gain'?",
    ),
    "an argument of a plug-in": (
        lambda: wa.plugins.load("method", "dual")(efort="fast"),
        "unknown argument 'efort' of Dual(…): did you mean 'effort'?",
    ),
    "a source": (lambda: wa.simulate("raylegh"), "unknown channel source 'raylegh': did you mean 'rayleigh'?"),
    "an option of a source": (lambda: wa.simulate("rayleigh", num_user=8), "did you mean 'num_users'?"),
    "an argument of simulate": (lambda: wa.simulate("rayleigh", sed=1), "did you mean 'seed'?"),
    "a source of one's own": (lambda: wa.simulate(3), "channel source must be a registered name"),
    "a repairer": (lambda: wa.repair(SEEN, "krigin"), "unknown repairer 'krigin': did you mean 'kriging'?"),
    "an option of a repairer": (
        lambda: wa.repair(SEEN, "nncf_paper", frequency_weigt=2),
        "did you mean 'frequency_weight'?",
    ),
    "a repairer where nothing is missing": (lambda: wa.repair(COMPLETE, "krigin"), "did you mean 'kriging'?"),
    "a method": (lambda: wa.decide(ESTIMATE, PROBLEM, method="exat"), "unknown method 'exat': did you mean 'exact'?"),
    "an option of a method": (lambda: wa.decide(ESTIMATE, PROBLEM, efort="fast"), "did you mean 'effort'?"),
    "an argument of decide": (lambda: wa.decide(ESTIMATE, PROBLEM, metod="dual"), "did you mean 'method'?"),
    "an argument of compare": (lambda: wa.compare(ESTIMATE, PROBLEM, method=["dual"]), "did you mean 'methods'?"),
}
COMPLETE = wa.ChannelObservation(gain=np.ones((2, 3)))
SEEN = wa.ChannelObservation(gain=np.array([[1.0, np.nan], [1.0, 1.0]]))
ESTIMATE = wa.repair(COMPLETE)
PROBLEM = wa.Problem("max_rate")


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistyped_name_is_answered_with_the_one_that_was_meant(mistake: str) -> None:
    make, said = MISTAKES[mistake]
    with pytest.raises(wa.InputError) as caught:
        make()
    assert said in str(caught.value)


def test_the_signature_of_a_constructor_stays_to_be_seen() -> None:
    assert list(inspect.signature(wa.Cell).parameters)[:2] == ["subcarrier_bandwidth_hz", "noise_psd_w_per_hz"]
    assert next(iter(inspect.signature(wa.Problem).parameters)) == "objective"


def test_a_plugin_that_takes_any_argument_is_left_alone() -> None:
    class Loose(wa.Repairer):
        name = "loose"

        def __init__(self, **settings: float) -> None:
            object.__setattr__(self, "settings", settings)

        def repair(self, observation: Any, *, at_s: float | None = None) -> Any:
            raise NotImplementedError

    assert Loose(anything=1.0).settings == {"anything": 1.0}
    with pytest.raises(UnknownNameError):
        wa.Kriging(anything=1.0)
