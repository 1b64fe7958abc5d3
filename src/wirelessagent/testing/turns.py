"""Turns of conversations that nobody led, for tests of what records them."""

from __future__ import annotations

import numpy as np

from wirelessagent import __version__, chain, plugins
from wirelessagent.acting.simulated import SimulatedBaseStation
from wirelessagent.agent.turn import Lines, Run, Stage, Tools, Turn
from wirelessagent.language.intent import Intent
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.model.problem import Problem
from wirelessagent.model.scene import Loss, Scene
from wirelessagent.telling.report import report

SENTENCES = (
    "higher speed",
    "至少 1 Mbit/s，最多 10 W",
    "ou bien 25 W…",
    "'); DROP TABLE audit_turn; --",
    "🙂 \x00\ud83d",
    "",
)


def turn_of(
    run: Run | None, *, session: str = "one", number: int = 1, text: str = "higher speed", stage: Stage = "applied"
) -> Turn:
    """A turn that came to ``run``."""
    objective = None if run is None else run.decision.problem.objective
    name = getattr(objective, "name", None)
    intent = Intent(
        kind="question" if name is None else "allocate", objective=name, constraints={}, language="en", confidence=0.9,
        evidence={"objective": text}, reply="understood", recogniser="offline",
    )  # fmt: skip
    return Turn(
        number=number, session=session, text=text, intent=intent, lines=Lines(decided="done"), run=run,
        stage="answered" if run is None else stage,
        at_utc="2026-11-21T12:00:00+00:00", version=__version__, seed=number, recogniser="offline",
    )  # fmt: skip


def decided_turn(
    scene: Scene, problem: Problem, *losses: Loss, tools: Tools | None = None, session: str = "one", number: int = 1
) -> Turn:
    """A turn whose decision the chain made, applied in simulation."""
    tools, seen = tools or Tools(), scene.observe(*losses, seed=number)
    estimate = chain.repair(seen, tools.repairer, **tools.repairer_options)
    decision = chain.decide(estimate, problem, scene.cell, tools.method, **tools.method_options)
    return turn_of(_run(scene, seen, decision, tools), session=session, number=number)


def random_turn(number: int, *, session: str = "one", seed: int) -> Turn:
    """A turn of random size and content that takes no time to make, every fourth without a decision."""
    rng = np.random.default_rng((seed, number))
    text = SENTENCES[int(rng.integers(len(SENTENCES)))] * int(rng.integers(1, 50))
    if number % 4 == 0:
        return turn_of(None, session=session, number=number, text=text)
    users, subcarriers = int(rng.integers(1, 9)), int(rng.integers(1, 200))
    gain = rng.exponential(1e-10, (users, subcarriers))
    scene = Scene(cell=Cell(), sensed=ChannelObservation(gain=gain), truth=gain)
    decision = Decision(
        owner=rng.integers(-1, users, subcarriers), power_w=rng.dirichlet(np.ones(subcarriers)) * 10.0,
        rate_bps=rng.exponential(1e6, users), status="feasible", value=rng.random(), bound=np.inf, gap=np.nan,
        unit="bit/s", method="dual", problem=Problem(plugins.objective("max_rate"), max_rate_bps=np.inf),
        cell=scene.cell, user_names=scene.sensed.user_names,
    )  # fmt: skip
    return turn_of(_run(scene, scene.observe(), decision, Tools()), session=session, number=number, text=text)


def _run(scene: Scene, seen: ChannelObservation, decision: Decision, tools: Tools) -> Run:
    outcome = SimulatedBaseStation(scene).apply(decision) if decision.is_usable else None
    return Run(
        intent=turn_of(None).intent, scene=scene, observation=seen, decision=decision, outcome=outcome,
        estimate=chain.repair(seen, tools.repairer, **tools.repairer_options), report=report(decision, outcome),
        notes=("a note",), explanation=("because",), tools=tools,
    )  # fmt: skip
