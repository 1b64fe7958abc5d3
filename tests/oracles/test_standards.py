"""Documents of standards: their figures are the run's in the standards' units, and the models read their JSON back."""

from __future__ import annotations

import importlib.util
import json
import math
import sys
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

import wirelessagent as wa
from wirelessagent.standards import tmf921, ts28312, ts28312_models
from wirelessagent.standards.expectations import expectations
from wirelessagent.standards.subject import Subject

AT = datetime(2026, 11, 21, 12, 0, tzinfo=UTC)
CELL = wa.Cell(amplifier_efficiency=0.4, circuit_power_w=7.0)
ROOT = Path(__file__).parents[2]


def alpha_fairness() -> wa.Objective:
    """The example's objective, as a third party would bring it."""
    spec = importlib.util.spec_from_file_location(
        "alpha_fairness_example", ROOT / "examples" / "third_party_objective" / "alpha_fairness.py"
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module.AlphaFairness(alpha=2.0)


def scene(users: int = 4, subcarriers: int = 8) -> wa.Scene:
    return wa.simulate("rayleigh", CELL, num_users=users, num_subcarriers=subcarriers, seed=3)


def subject(objective: Any = "max_rate", *, apply: bool = True, seen: float = 0.0, **problem: Any) -> Subject:
    """A run on a simulated cell; ``seen`` is the share of gains that is missing."""
    made = scene()
    observation = made.observe(wa.loss.random(seen), seed=5) if seen else made.observe()
    decision = wa.decide(wa.repair(observation), wa.Problem(objective, **problem), CELL)
    outcome = wa.SimulatedBaseStation(made).apply(decision) if apply and decision.is_usable else None
    return Subject(name="r-1", text="a request", decision=decision, outcome=outcome, at=AT)


def intent_of(run: Subject) -> dict[str, Any]:
    return json.loads(ts28312.to_json(ts28312.document(run)))["Intent"][0]


def report_of(run: Subject) -> dict[str, Any]:
    return json.loads(ts28312.to_json(ts28312.document(run)))["IntentReport"][0]


def target(run: Subject, name: str) -> dict[str, Any]:
    """The target of the expectation of this name."""
    (found,) = [one for one in intent_of(run)["intentExpectations"] if one["expectationId"] == name]
    return found["expectationTargets"][0]


def result(run: Subject, name: str) -> dict[str, Any]:
    """What became of the target of the expectation of this name."""
    results = report_of(run)["intentFulfilmentReport"]["expectationFulfilmentResult"]
    (found,) = [one for one in results if one["expectaitonId"] == name]
    return found["targetFulfilmentResults"][0]


def contexts(part: dict[str, Any], key: str) -> dict[str, Any]:
    return {one["contextAttribute"]: one["contextValueRange"] for one in part.get(key, [])}


def drawn_kwh(power_w: float, seconds: float = 3600.0) -> float:
    return (power_w / 0.4 + 7.0) * seconds / 1000 / 3600


def geometric_mean_kbps(rate: np.ndarray) -> float:
    return float(np.prod(rate / 1e6)) ** (1 / rate.size) * 1e3


def worth(run: Subject, name: str) -> tuple[str, float, str]:
    """The metric, the achieved figure and the unit that a standard has for an objective, worked out by hand."""
    assert run.outcome is not None
    assert run.outcome.achieved is not None
    rate, power = run.outcome.achieved.user_rate_bps, float(run.outcome.power_w.sum())
    return {
        "max_rate": ("AveDLRANUEThpt", rate.sum() / rate.size / 1e3, "kbit/s"),
        "min_power": ("RANEnergyConsumption", drawn_kwh(power), "kWh"),
        "max_energy_efficiency": ("RANEnergyEfficiency", rate.sum() / (power / 0.4 + 7.0), "bit/J"),
        "max_min_rate": ("DlThptPerUE", rate.min() / 1e3, "kbit/s"),
        "proportional_fairness": ("ProportionalFairness", geometric_mean_kbps(rate), "kbit/s"),
        "alpha_fairness": ("AlphaFairness", float(rate.size / np.sum(1 / np.maximum(rate, 1e-300))) / 1e3, "kbit/s"),
    }[name]


OBJECTIVES = [
    "max_rate", "min_power", "max_energy_efficiency", "max_min_rate", "proportional_fairness", "alpha_fairness",
]  # fmt: skip


def run_of(name: str, **changes: Any) -> Subject:
    objective = alpha_fairness() if name == "alpha_fairness" else name
    return subject(objective, min_rate_bps=2e5 if name == "min_power" else None, **changes)


@pytest.mark.parametrize("name", OBJECTIVES)
def test_achieved_figures_are_the_runs_in_the_standards_units(name: str):
    run = run_of(name)
    metric, figure, unit = worth(run, name)
    found = result(run, "objective")
    assert found["targetName"] == metric
    assert found["targetAchievedValue"] == pytest.approx(figure, rel=1e-12)
    assert contexts(found, "targetContexts")["Unit"] == unit
    assert found["targetFulfilmentInfo"] == {"fulfilmentStatus": "FULFILLED"}


@pytest.mark.parametrize("name", OBJECTIVES)
def test_the_objective_is_to_be_better_than_the_current_value(name: str):
    run = run_of(name)
    more = {"min_rate_bps": 1e5} if name == "min_power" else {"max_power_w": 20.0}
    objective = alpha_fairness() if name == "alpha_fairness" else name
    better = replace(subject(objective, **more), current=run.outcome)
    wanted = target(better, "objective")
    if name == "min_power":  # who is promised less draws less
        assert result(better, "objective")["targetFulfilmentInfo"] == {"fulfilmentStatus": "FULFILLED"}
    assert wanted["targetValueRange"] == pytest.approx(worth(run, name)[1], rel=1e-12)
    assert wanted["targetCondition"] == ("IS_LESS_THAN" if name == "min_power" else "IS_GREATER_THAN")
    said = contexts(wanted, "targetContexts")
    assert "current value" in (said.get("BetterThan"), said.get("NoWorseThan"))


@pytest.mark.parametrize("name", OBJECTIVES)
def test_what_is_in_effect_already_is_to_be_no_worse(name: str):
    run = run_of(name)
    again = replace(run, current=run.outcome)
    wanted = target(again, "objective")
    assert wanted["targetValueRange"] == pytest.approx(worth(run, name)[1], rel=1e-12)
    said = contexts(wanted, "targetContexts")
    assert said["BoundaryIncluded"] is True
    assert said["NoWorseThan"] == "current value"
    assert result(again, "objective")["targetFulfilmentInfo"] == {"fulfilmentStatus": "FULFILLED"}
    (condition,) = tmf(again)["intent"]["expression"]["expressionValue"]["log:allOf"]["@list"][0]["log:allOf"]["@list"]
    assert ("quan:atMost" if name == "min_power" else "quan:atLeast") in condition


def test_what_the_bound_proves_unbeatable_is_to_be_no_worse():
    made = scene()
    best = subject(max_power_w=10.0)
    decision = wa.decide(wa.perfect(made), wa.Problem("max_rate", max_power_w=10.0), CELL, "round_robin")
    outcome = wa.SimulatedBaseStation(made).apply(decision)
    run = replace(best, decision=decision, outcome=outcome, current=best.outcome)
    assert contexts(target(run, "objective"), "targetContexts")["NoWorseThan"] == "current value"
    assert report_of(run)["intentFeasibilityCheckReport"]["feasibilityCheckResult"] == "FEASIBLE"  # so it was before
    info = result(run, "objective")["targetFulfilmentInfo"]
    assert info["notFullfilledState"] == "DEGRADED"
    assert "below" in info["notFulfilledReasons"][0]
    other = replace(best, current=outcome)
    assert contexts(target(other, "objective"), "targetContexts")["BetterThan"] == "current value"


def only_the_last_user() -> np.ndarray:
    forbidden = np.ones((4, 8), dtype=bool)
    forbidden[3] = False
    return forbidden


@pytest.mark.parametrize(
    "limits",
    [
        {"max_power_w": 5.0},
        {"users": ("user 3", "user 4")},
        {"min_rate_bps": 5e5},
        {"max_rate_bps": 1e5},
        {"forbidden": only_the_last_user()},
        {"subcarrier_max_power_w": 0.5},
        {"resource_block_group_size": 8},
    ],
    ids=lambda limits: next(iter(limits)),
)
def test_what_breaks_a_limit_of_the_request_is_no_measure_of_it(limits: dict[str, Any]):
    shared = "resource_block_group_size" in limits
    before = subject("proportional_fairness" if shared else "max_rate", max_power_w=10.0)
    run = replace(subject(**{"max_power_w": 10.0, **limits}), current=before.outcome)
    wanted = target(run, "objective")
    assert wanted["targetValueRange"] == 0
    assert contexts(wanted, "targetContexts")["BetterThan"] == "nothing"
    assert report_of(run)["intentFulfilmentReport"]["intentFulfilmentInfo"] == {"fulfilmentStatus": "FULFILLED"}


def test_more_than_the_budget_is_no_measure_of_energy():
    before = subject("min_power", min_rate_bps=4e5)
    assert before.outcome is not None
    power_w = float(before.outcome.power_w.sum())
    run = replace(subject("min_power", min_rate_bps=1e5, max_power_w=power_w / 2), current=before.outcome)
    wanted = target(run, "objective")
    assert contexts(wanted, "targetContexts")["BetterThan"] == "the power budget in full"
    assert wanted["targetValueRange"] == pytest.approx(drawn_kwh(power_w / 2), rel=1e-12)


def test_what_was_taken_back_is_neither_fulfilled_nor_active():
    run = replace(subject(max_power_w=10.0), taken_back=True)
    assert intent_of(run)["intentAdminState"] == "DEACTIVATED"
    info = report_of(run)["intentFulfilmentReport"]["intentFulfilmentInfo"]
    assert info["notFullfilledState"] == "TERMINATED"
    assert info["notFulfilledReasons"] == ["the allocation was applied, and taken back: it is not in effect"]
    assert "targetAchievedValue" not in result(run, "objective")
    sent = tmf(run)
    assert sent["intent"]["lifecycleStatus"] == "Terminated"
    report = sent["intentReport"]["expression"]["expressionValue"]
    assert report["imo:handlingState"] == {"@id": "imo:StateDegraded"}
    assert report["icm:result"] is False


def test_promises_and_the_budget_are_floors_and_a_ceiling():
    run = subject(min_rate_bps=[2e5, 2e5, 1e5, 0.0], max_power_w=10.0)
    assert target(run, "energy-ceiling")["targetValueRange"] == pytest.approx(drawn_kwh(10.0), rel=1e-12)
    assert contexts(intent_of(run), "intentContexts")["RadiatedPowerInW"] == 10
    floors = {
        tuple(contexts(one["expectationObject"], "objectContexts")["UEs"]): one["expectationTargets"][0]
        for one in intent_of(run)["intentExpectations"]
        if one["expectationId"].startswith("throughput-floor")
    }
    assert {users: floor["targetValueRange"] for users, floor in floors.items()} == {
        ("user 3",): 100, ("user 1", "user 2"): 200,
    }  # fmt: skip
    assert {floor["targetName"] for floor in floors.values()} == {"DlThptPerUE"}
    assert report_of(run)["intentFulfilmentReport"]["intentFulfilmentInfo"]["fulfilmentStatus"] == "FULFILLED"
    assert report_of(run)["intentFeasibilityCheckReport"] == {
        "feasibilityCheckResult": "FEASIBLE", "infeasibilityReasons": [],
    }  # fmt: skip


def test_the_budget_is_kept_by_who_uses_it_in_full():
    run = subject(max_power_w=10.0)
    assert run.decision.total_power_w == pytest.approx(10.0)
    found = result(run, "energy-ceiling")
    assert found["targetFulfilmentInfo"] == {"fulfilmentStatus": "FULFILLED"}
    assert contexts(target(run, "energy-ceiling"), "targetContexts")["BoundaryIncluded"] is True
    assert contexts(target(run, "objective"), "targetContexts")["BoundaryIncluded"] is False


def test_the_observation_period_scales_the_energy():
    run = subject(max_power_w=10.0)
    day = replace(run, observation_period_s=86400)
    assert target(day, "energy-ceiling")["targetValueRange"] == pytest.approx(drawn_kwh(10.0, 86400), rel=1e-12)
    assert intent_of(day)["intentReportControl"][0]["observationPeriod"] == 86400


def test_who_falls_short_on_the_true_channel_is_named():
    made = scene()
    decision = wa.decide(wa.repair(made.observe()), wa.Problem("min_power", min_rate_bps=4e5), CELL)
    faded = made.sensed.gain * np.array([[1.0], [0.5], [1.0], [0.9]])
    outcome = wa.SimulatedBaseStation(wa.Scene(cell=CELL, sensed=made.sensed, truth=faded)).apply(decision)
    run = replace(subject(apply=False), decision=decision, outcome=outcome)
    info = result(run, "throughput-floor-1")["targetFulfilmentInfo"]
    assert info["fulfilmentStatus"] == "NOT_FULFILLED"
    assert info["notFullfilledState"] == "DEGRADED"
    assert [reason.split(" gets")[0] for reason in info["notFulfilledReasons"]] == ["user 2", "user 4"]
    whole = report_of(run)["intentFulfilmentReport"]["intentFulfilmentInfo"]
    assert whole == info
    expression = tmf(run)["intentReport"]["expression"]["expressionValue"]
    assert expression["imo:handlingState"] == {"@id": "imo:StateDegraded"}


@pytest.mark.parametrize(("left", "progress"), [(1 - 3e-5, "kept"), (1 - 3e-4, "missed")])
def test_a_shortfall_that_nobody_sees_is_none(left: float, progress: str):
    made = scene()
    decision = wa.decide(wa.repair(made.observe()), wa.Problem("min_power", min_rate_bps=4e5), CELL)
    applied = wa.SimulatedBaseStation(wa.Scene(cell=CELL, sensed=made.sensed, truth=made.sensed.gain)).apply(decision)
    assert applied.achieved is not None
    rate = applied.achieved.user_rate_bps * np.array([1.0, left, 1.0, 1.0])
    outcome = replace(applied, achieved=replace(applied.achieved, user_rate_bps=rate))
    assert int(outcome.missed.sum()) == (progress == "missed")
    found = expectations(replace(subject(apply=False), decision=decision, outcome=outcome))
    (floor,) = [one for one in found if one.name == "throughput-floor-1"]
    assert floor.progress == progress


def test_what_cannot_be_done_says_what_could():
    run = subject("min_power", min_rate_bps=2e7, max_power_w=0.5)
    decision = run.decision
    assert decision.status == "infeasible"
    assert decision.needed_power_w is not None
    assert decision.rate_scaling is not None
    made = report_of(run)
    check = made["intentFeasibilityCheckReport"]
    assert check["feasibilityCheckResult"] == "INFEASIBLE"
    recommended = {
        one["expectationId"]: one["inFeasibleTargets"][0].get("recommendedValue")
        for one in check["inFeasibleExpectationInfos"]
    }
    if math.isfinite(decision.needed_power_w.at_most):
        assert recommended["energy-ceiling"] == pytest.approx(drawn_kwh(decision.needed_power_w.at_most), rel=1e-12)
        assert made["intentConflictReports"][0]["conflictingTarget"] == "RANEnergyConsumption"
    assert recommended["throughput-floor-1"] == pytest.approx(2e4 * decision.rate_scaling.at_least, rel=1e-12)
    info = made["intentFulfilmentReport"]["intentFulfilmentInfo"]
    assert info["notFullfilledState"] == "RECEIVED"
    assert decision.reason in info["notFulfilledReasons"]
    assert "targetAchievedValue" not in result(run, "objective")
    expression = tmf(run)["intentReport"]["expression"]["expressionValue"]
    assert expression["imo:handlingState"] == {"@id": "imo:StateIntentReceived"}
    told = {key: value for one in expression["icm:information"] for key, value in one.items()}
    assert told["wa:PromisedRateScaling"]["@list"] == [decision.rate_scaling.at_least, decision.rate_scaling.at_most]


def test_recommended_floors_can_be_kept():
    run = subject("max_rate", min_rate_bps=2e7, max_power_w=0.5)
    made = report_of(run)["intentFeasibilityCheckReport"]["inFeasibleExpectationInfos"]
    (floor,) = [one for one in made if one["expectationId"] == "throughput-floor-1"]
    rate = floor["inFeasibleTargets"][0]["recommendedValue"] * 1e3 * (1 - 1e-6)
    assert subject("max_rate", min_rate_bps=rate, max_power_w=0.5).decision.is_usable


def test_what_could_be_done_instead_is_solved_for_where_the_decision_does_not_know_it():
    made, cell = wa.simulate("rayleigh", num_users=4, num_subcarriers=12, seed=1), CELL
    problem = wa.Problem("max_rate", min_rate_bps=5e6, max_power_w=2.0, outage_probability=0.05)
    decision = wa.decide(wa.repair(made.observe(wa.loss.random(0.2), seed=1)), problem, cell)
    need, scaling = decision.needed_power_w, decision.rate_scaling
    assert decision.status == "infeasible"
    assert need is not None
    assert scaling is not None
    assert math.isnan(need.at_most)
    assert scaling.at_least == 0
    run = replace(subject(apply=False), decision=decision)
    check = report_of(run)["intentFeasibilityCheckReport"]
    ceiling, floor = (one["inFeasibleTargets"][0]["recommendedValue"] for one in check["inFeasibleExpectationInfos"])
    assert drawn_kwh(need.at_least) <= ceiling < drawn_kwh(2 * need.at_least)
    lower = wa.Problem("max_rate", min_rate_bps=floor * 1e3, max_power_w=2.0, outage_probability=0.05)
    assert floor > 0
    assert wa.decide(decision.estimate, lower, cell).is_usable
    assert "?" not in check["additionalPreEvaluationInfo"]
    assert "no bound" not in json.dumps(report_of(run))
    unknown = replace(run, decision=replace(decision, estimate=None))
    told = report_of(unknown)["intentFeasibilityCheckReport"]
    assert all("recommendedValue" not in one["inFeasibleTargets"][0] for one in told["inFeasibleExpectationInfos"])
    assert "at least" in told["additionalPreEvaluationInfo"]


def test_nothing_is_fulfilled_before_it_is_applied():
    run = subject(apply=False)
    info = report_of(run)["intentFulfilmentReport"]["intentFulfilmentInfo"]
    assert info == {
        "fulfilmentStatus": "NOT_FULFILLED", "notFullfilledState": "RECEIVED",
        "notFulfilledReasons": ["the allocation is decided, but not applied"],
    }  # fmt: skip
    promised = contexts(result(run, "objective"), "targetContexts")["PromisedValue"]
    assert promised == pytest.approx(run.decision.value / 4 / 1e3, rel=1e-12)
    assert tmf(run)["intent"]["lifecycleStatus"] == "Created"


def test_an_outage_probability_is_a_guarantee_and_a_context():
    run = subject("min_power", min_rate_bps=1e5, outage_probability=0.05, seen=0.2)
    found = {
        one["expectaitonId"]: one.get("guaranteeConfidenceLevel")
        for one in report_of(run)["intentFulfilmentReport"]["expectationFulfilmentResult"]
    }
    assert found == {"objective": None, "throughput-floor-1": 95}
    assert contexts(intent_of(run), "intentContexts")["OutageProbability"] == 0.05


def test_what_the_standard_has_no_name_for_is_named():
    forbidden = np.zeros((4, 8), dtype=bool)
    forbidden[1, 3] = True
    run = subject(
        weights=[1.0, 2.0, 1.0, 1.0], max_rate_bps=[np.inf, 5e6, np.inf, np.inf], users=("user 1", "user 2", "user 3"),
        forbidden=forbidden,
        subcarrier_max_power_w=3.0, resource_block_group_size=2,
    )  # fmt: skip
    said = contexts(intent_of(run), "intentContexts")
    assert said["UEWeights"] == [1, 2, 1, 0]
    assert (said["UEsOfLimitedDemand"], said["DemandInKbps"]) == (["user 2"], [5000])
    assert said["ServedUEs"] == ["user 1", "user 2", "user 3"]
    assert said["SubcarrierPowerInW"] == [3] * 8
    assert said["ForbiddenUESubcarriers"] == ["user 2: 3"]
    assert said["ResourceBlockGroupSize"] == 2
    assert result(run, "objective")["targetName"] == "WeightedMaxRate"
    sent = {one["name"]: one["value"] for one in tmf(run)["intent"]["characteristic"]}
    assert sent == said


def tmf(run: Subject) -> dict[str, Any]:
    return json.loads(tmf921.to_json(tmf921.document(run)))


@pytest.mark.parametrize("name", OBJECTIVES)
def test_both_standards_say_the_same(name: str):
    run = subject(alpha_fairness() if name == "alpha_fairness" else name, min_rate_bps=1e4, max_power_w=15.0)
    sent = tmf(run)
    expected = intent_of(run)["intentExpectations"]
    stated = sent["intent"]["expression"]["expressionValue"]["log:allOf"]["@list"]
    assert len(stated) == len(expected)
    for one, other in zip(stated, expected, strict=True):
        (condition,) = one["log:allOf"]["@list"]
        wanted = other["expectationTargets"][0]
        said = contexts(wanted, "targetContexts")
        operator = {
            ("IS_GREATER_THAN", True): "quan:atLeast",
            ("IS_GREATER_THAN", False): "quan:greater",
            ("IS_LESS_THAN", True): "quan:atMost",
            ("IS_LESS_THAN", False): "quan:smaller",
        }[wanted["targetCondition"], said["BoundaryIncluded"]]
        measured, quantity = condition[operator]["@list"]
        assert (quantity["rdf:value"], quantity["quan:unit"]) == (wanted["targetValueRange"], said["Unit"])
        service = other["expectationObject"]["objectType"] == "RADIO_SERVICE"
        assert list(measured) == ["quan:smallestInSet" if service else "met:lastValue"]
        members = [member["rdfs:label"] for member in one["icm:target"]["rdfs:member"] if "rdfs:label" in member]
        assert members == contexts(other["expectationObject"], "objectContexts").get("UEs", [])
    report = sent["intentReport"]["expression"]["expressionValue"]
    observed = report["icm:resultFrom"][0]["icm:resultFrom"][0]["met:observed"]["rdf:value"]
    assert observed["rdf:value"] == result(run, "objective")["targetAchievedValue"]
    assert report["icm:result"] is True
    assert report["imo:handlingState"] == {"@id": "imo:StateCompliant"}


def test_a_report_speaks_of_what_the_intent_states():
    run = subject("min_power", min_rate_bps=2e5, max_power_w=10.0)
    sent = tmf(run)

    def ids(node: Any) -> set[str]:
        if isinstance(node, list):
            return set().union(*map(ids, node)) if node else set()
        if not isinstance(node, dict):
            return set()
        own = {node["@id"]} if "@id" in node and len(node) > 1 else set()
        return own.union(*(ids(value) for key, value in node.items() if key != "@context"))

    def abouts(node: Any) -> set[str]:
        if isinstance(node, list):
            return set().union(*map(abouts, node)) if node else set()
        if not isinstance(node, dict):
            return set()
        own = {node["icm:about"]["@id"]} if "icm:about" in node else set()
        return own.union(*(abouts(value) for value in node.values()))

    stated = ids(sent["intent"]["expression"]["expressionValue"])
    spoken_of = abouts(sent["intentReport"]["expression"]["expressionValue"])
    assert spoken_of
    assert spoken_of <= stated
    used = {
        key.split(":")[0] for key in json.dumps(sent).split('"') if ":" in key and not key.startswith(("http", ":"))
    }
    assert used & {"icm", "log", "quan", "met", "imo", "t"} <= set(tmf921.CONTEXT)


@pytest.mark.parametrize("name", OBJECTIVES)
def test_models_read_what_they_write_and_nothing_is_nan(name: str):
    for run in (run_of(name), run_of(name, apply=False)):
        for standard in (ts28312, tmf921):
            made = standard.document(run)
            text = standard.to_json(made)
            assert type(made).model_validate_json(text) == made
            json.loads(text, parse_constant=lambda constant: pytest.fail(f"{constant} in the document"))
            assert ": null" not in text


@dataclass(frozen=True, kw_only=True)
class Logarithms(wa.Objective):
    """Σ ln r, shown as it is: −∞ where anybody gets nothing."""

    name = "logarithms"

    def utility(self, rate: np.ndarray) -> np.ndarray:
        with np.errstate(divide="ignore"):
            return np.log(rate)

    def conjugate(self, price: Any, min_rate: Any, max_rate: Any) -> Any:
        raise NotImplementedError


def test_a_figure_that_no_document_can_hold_is_left_out():
    made = scene()
    decision = wa.decide(wa.repair(made.observe()), wa.Problem("proportional_fairness"), CELL)
    decision = replace(decision, problem=decision.problem.resolved(Logarithms()))
    dark = wa.Scene(cell=CELL, sensed=made.sensed, truth=np.zeros_like(made.sensed.gain))
    outcome = wa.SimulatedBaseStation(dark).apply(decision)
    run = replace(subject(), decision=decision, outcome=outcome)
    for standard in (ts28312, tmf921):
        json.loads(standard.to_json(standard.document(run)), parse_constant=lambda constant: pytest.fail(constant))
    found = result(run, "objective")
    assert found["targetFulfilmentInfo"]["fulfilmentStatus"] == "NOT_FULFILLED"
    assert "targetAchievedValue" not in found
    again = replace(run, current=outcome)
    assert target(again, "objective")["targetValueRange"] == 0


def test_the_models_refuse_what_the_standard_does_not_know():
    good = {"targetName": "RANEnergyConsumption", "targetCondition": "IS_LESS_THAN", "targetValueRange": 1.5}
    ts28312_models.ExpectationTarget(**good)
    for change in (
        {"targetCondition": "IS_GREATER_THAN"},
        {"targetCondition": "IS_LARGEST"},
        {"targetValueRange": math.nan},
        {"targetUnit": "kWh"},
    ):
        with pytest.raises(ValidationError):
            ts28312_models.ExpectationTarget(**{**good, **change})


@pytest.mark.parametrize("change", [{"at": datetime(2026, 1, 1)}, {"name": "a b"}, {"observation_period_s": 0}])
def test_a_subject_without_time_zone_or_name_is_refused(change: dict[str, Any]):
    run = subject(apply=False)
    with pytest.raises(wa.InputError):
        Subject(**{**vars(run), **change})
