"""What a server counts, for Prometheus."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from prometheus_client import CollectorRegistry, Counter, Histogram, generate_latest

_GAPS = (1e-9, 1e-4, 1e-3, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2)
_SECONDS = (0.005, 0.02, 0.05, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)


class Metrics:
    """Counters of one server."""

    def __init__(self) -> None:
        self._registry = CollectorRegistry()
        name = "wirelessagent"
        self._turns = Counter(f"{name}_turns", "Turns by what they came to", ["stage"], registry=self._registry)
        self._read = Counter(f"{name}_understood", "Turns by who understood", ["recogniser"], registry=self._registry)
        self._decisions = Counter(
            f"{name}_decisions", "Decisions by objective and status", ["objective", "status"], registry=self._registry
        )
        self._gap = Histogram(
            f"{name}_gap_ratio", "Gap of decisions to their bound", buckets=_GAPS, registry=self._registry
        )
        self._promises = Counter(
            f"{name}_promises", "Promised rates that were applied, kept or missed", ["came_to"], registry=self._registry
        )
        self._requests = Histogram(
            f"{name}_request_seconds", "Time to answer, by route and status", ["route", "status"],
            buckets=_SECONDS, registry=self._registry,
        )  # fmt: skip

    def turned(self, record: Mapping[str, Any]) -> None:
        """Count a turn."""
        self._turns.labels(record["stage"]).inc()
        self._read.labels(record["recogniser"]).inc()
        decision, report = record["decision"], record["report"]
        if decision is not None and record["stage"] in ("planned", "nothing"):
            self._decisions.labels(decision["objective"], decision["status"]).inc()
            if decision["gap"] is not None:
                self._gap.observe(decision["gap"])
        if record["outcome"] is not None and record["stage"] == "applied":
            promised = sum(rate > 0 for rate in record["outcome"]["promised_bps"])
            missed = 0 if report is None else len(report["missed_users"])
            self._promises.labels("missed").inc(missed)
            self._promises.labels("kept").inc(promised - missed)

    def answered(self, route: str, status: int, seconds: float) -> None:
        """Count a request."""
        self._requests.labels(route, str(status)).observe(seconds)

    def text(self) -> bytes:
        """All counters in Prometheus' text format."""
        return generate_latest(self._registry)
