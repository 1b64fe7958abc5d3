"""An intent of TMF921 as a request: the inverse of :mod:`wirelessagent.standards.tmf921`, as far as requests go.

Read are an objective (the characteristic ``Objective``, or the metric of an expectation to be better than the current
value), floors on users' throughput, a ceiling on the cell's energy, and the characteristics that the other way writes.
What the server sets (ids, dates, life cycle) is passed over. Everything else is refused by its name: an intent is
carried out whole or not at all.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias, cast

from wirelessagent.model.errors import InputError
from wirelessagent.standards.subject import (
    AVERAGE_THROUGHPUT,
    ENERGY_CONSUMPTION,
    ENERGY_EFFICIENCY,
    JOULES_PER_KWH,
    USER_THROUGHPUT,
)

Json: TypeAlias = Mapping[str, Any]

OBJECTIVES: Mapping[str, str] = {
    AVERAGE_THROUGHPUT.name: "max_rate",
    USER_THROUGHPUT.name: "max_min_rate",
    ENERGY_CONSUMPTION.name: "min_power",
    ENERGY_EFFICIENCY.name: "max_energy_efficiency",
}
"""What "better than the current value" of a metric asks for."""

_PASSED_OVER = frozenset({
    "@type", "@baseType", "@schemaLocation", "id", "href", "name", "description", "version", "lifecycleStatus",
    "creationDate", "lastUpdate", "statusChangeDate", "isBundle",
})  # fmt: skip
_EXPECTATION = frozenset({"@id", "@type", "icm:target", "log:allOf", "rdfs:comment", "rdfs:label"})
_MORE = {"quan:atLeast": True, "quan:greater": True, "quan:atMost": False, "quan:smaller": False}
_COUNTED_WITH = ("ObservationPeriodInSeconds", "CircuitPowerInW", "AmplifierEfficiency")
"""What an energy was counted with; properties of the cell and no wish."""

_SAME = 1e-6


@dataclass
class _Read:
    """What was read so far."""

    user_names: Sequence[str]
    objective: str | None = None
    constraints: dict[str, Any] = field(default_factory=dict[str, Any])
    counted_with: dict[str, float] = field(default_factory=dict[str, float])
    ceiling_kwh: float | None = None


def request_of(intent: Json, user_names: Sequence[str]) -> tuple[str, dict[str, Any]]:
    """The objective by its registered name, and constraints as in :class:`wirelessagent.language.intent.Intent`.

    Raises:
        InputError: something in the intent cannot be asked for here; it is named.
    """
    read = _Read(user_names)
    if intent.get("@type", "Intent") != "Intent":
        raise InputError(f"@type: an Intent is wanted; got {intent['@type']!r}")
    if intent.get("isBundle"):
        raise InputError("isBundle: bundles of intents are not taken; send each by itself")
    for name in intent:
        if name not in {*_PASSED_OVER, "characteristic", "expression"}:
            raise InputError(f"{name}: this cannot be asked of a cell; leave it out")
    told = _objects(intent.get("characteristic", []), "characteristic")
    given = {_text(one.get("name"), "characteristic name"): one.get("value") for one in told}
    for name, value in given.items():
        _characteristic(read, name, value, given)
    if "expression" in intent:
        expression = _object(intent["expression"], "expression")
        for one in _all_of(_object(expression.get("expressionValue"), "expression.expressionValue"), "expressionValue"):
            _expectation(read, one)
    _ceiling(read)
    if read.objective is None:
        known = ", ".join(OBJECTIVES)
        raise InputError(f"no objective: give the characteristic Objective, or expect more or less of one of {known}")
    return read.objective, read.constraints


def _characteristic(read: _Read, name: str, value: Any, given: Json) -> None:
    """What a characteristic asks for."""
    place = f"characteristic {name}"
    match name:
        case "Objective":
            read.objective = _text(value, place)
        case "RadiatedPowerInW":
            read.constraints["max_power_w"] = _number(value, place)
        case "OutageProbability":
            read.constraints["outage_probability"] = _number(value, place)
        case "ResourceBlockGroupSize":
            read.constraints["resource_block_group_size"] = _number(value, place)
        case "ServedUEs":
            read.constraints["users"] = tuple(_reference(read, user, place) for user in _list(value, place))
        case "UEsOfLimitedDemand" | "DemandInKbps":
            read.constraints["max_rate_bps"] = _by_user(read, given, "UEsOfLimitedDemand", "DemandInKbps", 1e3)
        case "UEs" | "UEWeights":
            weights = _by_user(read, given, "UEs", "UEWeights", 1.0)
            read.constraints["weights"] = {user: weight for user, weight in weights.items() if weight != 1}
        case "SubcarrierPowerInW":
            caps = {_number(cap, place) for cap in _list(value, place)}
            if len(caps) != 1:
                raise InputError(f"{place}: one limit for all subcarriers can be asked for, and no several")
            read.constraints["subcarrier_max_power_w"] = caps.pop()
        case _ if name in _COUNTED_WITH:
            read.counted_with[name] = _number(value, place)
        case _:
            raise InputError(f"{place}: this cannot be asked of a cell; leave it out")


def _expectation(read: _Read, one: Json) -> None:
    """What an expectation asks for."""
    name = str(one.get("@id", "an expectation without @id"))
    if one.get("@type") != "icm:PropertyExpectation":
        raise InputError(f"{name}: only an icm:PropertyExpectation is taken; got {one.get('@type')!r}")
    for key in one:
        if key not in _EXPECTATION:
            raise InputError(f"{name}: {key} cannot be asked of a cell; leave it out")
    conditions = _all_of(one, name)
    if len(conditions) != 1:
        raise InputError(f"{name}: one condition is wanted in log:allOf; got {len(conditions)}")
    (relation,) = [key for key in conditions[0] if key not in ("@id", "@type")] or [""]
    if relation not in _MORE:
        raise InputError(
            f"{name}: the condition {relation or 'without a relation'} is not known; {', '.join(_MORE)} are"
        )
    measured, wanted = _pair(_object(conditions[0][relation], name).get("@list"), name)
    metric = _metric(measured, name)
    users = _users(read, _object(one.get("icm:target"), f"{name}: icm:target"), name)
    strict = relation in ("quan:greater", "quan:smaller")
    if strict or name.endswith(":objective"):
        objective = read.objective or OBJECTIVES.get(metric)
        if objective is None or (metric in OBJECTIVES and read.objective not in (None, OBJECTIVES[metric])):
            raise InputError(
                f"{name}: better {metric} is no objective here, or not that of the characteristic Objective"
            )
        read.objective = objective
    elif metric == USER_THROUGHPUT.name and _MORE[relation] and users:
        rates = read.constraints.setdefault("min_rate_bps", {})
        rate = 1e3 * _quantity(wanted, USER_THROUGHPUT.unit, name)
        rates.update(dict.fromkeys(users, rate))
    elif metric == ENERGY_CONSUMPTION.name and not _MORE[relation] and not users:
        read.ceiling_kwh = _quantity(wanted, ENERGY_CONSUMPTION.unit, name)
    else:
        raise InputError(
            f"{name}: {relation} of {metric} cannot be asked for; {USER_THROUGHPUT.name} of users at least, and "
            f"{ENERGY_CONSUMPTION.name} of the cell at most, can"
        )


def _ceiling(read: _Read) -> None:
    """An energy ceiling as the power that it leaves to radiate; everybody's same rate as everybody's."""
    rates = read.constraints.get("min_rate_bps", {})
    served = read.constraints.get("users") or tuple(_called(name) for name in read.user_names)
    if rates and set(rates) == set(served) and len(set(rates.values())) == 1:
        read.constraints["min_rate_bps"] = next(iter(rates.values()))
    if read.ceiling_kwh is None:
        return
    radiated = read.constraints.get("max_power_w")
    if not all(name in read.counted_with for name in _COUNTED_WITH):
        if radiated is None:
            raise InputError(
                f"{ENERGY_CONSUMPTION.name}: say what it counts by the characteristics {', '.join(_COUNTED_WITH)}, or "
                "give RadiatedPowerInW"
            )
        return
    period, circuit, efficiency = (read.counted_with[name] for name in _COUNTED_WITH)
    left = (read.ceiling_kwh * JOULES_PER_KWH / period - circuit) * efficiency
    if radiated is not None and abs(left - radiated) > _SAME * radiated:
        raise InputError(f"{ENERGY_CONSUMPTION.name} leaves {left:g} W to radiate, RadiatedPowerInW {radiated:g} W")
    if radiated is None:
        read.constraints["max_power_w"] = float(f"{left:.9g}")


def _users(read: _Read, target: Json, name: str) -> list[str]:
    """The users that a target means; none where it is the cell."""
    found = list[str]()
    for member in _objects(target.get("rdfs:member", []), f"{name}: rdfs:member"):
        if member.get("@id") == "wa:cell":
            return []
        found.append(_reference(read, member.get("rdfs:label"), f"{name}: rdfs:member"))
    return found


def _metric(measured: Any, name: str) -> str:
    """The metric whose last value, or whose smallest among the target's, is meant."""
    node = _object(measured, name)
    if "quan:smallestInSet" in node:
        node = _object((_list(_object(node["quan:smallestInSet"], name).get("@list"), name) or [None])[0], name)
    for key in ("met:lastValue", "icm:valuesOfTargetProperty"):
        if key in node:
            metric = (_list(_object(node[key], name).get("@list"), name) or [None])[0]
            return str(_object(metric, name).get("@id", "")).removeprefix("wa:")
    raise InputError(f"{name}: met:lastValue or quan:smallestInSet of a metric is wanted; got {', '.join(node)}")


def _quantity(node: Any, unit: str, name: str) -> float:
    found = _object(node, name)
    if found.get("quan:unit") != unit:
        raise InputError(f"{name}: its unit is {unit} here; got {found.get('quan:unit')!r}")
    return _number(found.get("rdf:value"), f"{name}: rdf:value")


def _by_user(read: _Read, given: Json, names: str, figures: str, factor: float) -> dict[str, float]:
    users, values = (_list(given.get(one), f"characteristic {one}") for one in (names, figures))
    if len(users) != len(values):
        raise InputError(f"characteristic {figures}: one figure for each of {names} is wanted; got {len(values)}")
    place = f"characteristic {names}"
    return {
        _reference(read, user, place): factor * _number(value, place) for user, value in zip(users, values, strict=True)
    }


def _reference(read: _Read, user: Any, place: str) -> str:
    if user not in read.user_names:
        raise InputError(f"{place}: no user is called {user!r}; the cell has {', '.join(read.user_names[:12])}")
    return _called(user)


def _called(user: str) -> str:
    """How a request names a user: "3" is "user 3"."""
    number = user.removeprefix("user ")
    return number if user != number and number.isdecimal() else user


def _all_of(node: Json, name: str) -> list[Json]:
    return _objects(_object(node.get("log:allOf"), f"{name}: log:allOf").get("@list"), f"{name}: log:allOf")


def _pair(value: Any, name: str) -> tuple[Any, Any]:
    found = _list(value, name)
    if len(found) != 2:
        raise InputError(f"{name}: a condition compares two things; got {len(found)}")
    return found[0], found[1]


def _object(value: Any, name: str) -> Json:
    return cast("Json", _of(value, name, "an object", lambda one: isinstance(one, Mapping)))


def _list(value: Any, name: str) -> list[Any]:
    return cast("list[Any]", _of(value, name, "a list", lambda one: isinstance(one, list)))


def _objects(value: Any, name: str) -> list[Json]:
    return [_object(one, name) for one in _list(value, name)]


def _number(value: Any, name: str) -> float:
    return float(_of(value, name, "a number", lambda one: isinstance(one, int | float) and not isinstance(one, bool)))


def _text(value: Any, name: str) -> str:
    return str(_of(value, name, "a text", lambda one: isinstance(one, str)))


def _of(value: Any, name: str, what: str, fits: Callable[[Any], bool]) -> Any:
    if not fits(value):
        raise InputError(f"{name}: {what} is wanted; got {str(value)[:80]!r}")
    return value
