"""The bar of promises, measured: ``python benchmarks/bars_promises.py [--draws 600] [--delay-spread-ns 300,100,1000]``.

P2 on repaired channels: each user is promised 0.5 Mbit/s with an outage probability of 5 %, at the least power. Who
misses is counted on the true channel, among all users and among those whose allocation rests on a repaired entry: there
the bar is 3–6 %, over all users at most 5.5 %, at less power than never using a repaired entry. Channels are
those of :mod:`channels` (8 users, 20 subcarriers; seeds from 1000), lost at random, repaired by the default, measured
exactly and at 30 dB SNR. The budget is ample, so that every draw counts. Beside the promises stand

- perfect knowledge, whose power is the unit;
- the same rates on the estimate as it stands, without a probability;
- the same promises without any repaired entry, which is what there was to beat.

Powers are geometric means over draws. Intervals are 95 %, of shares of users, whose misses in a draw are independent
enough; the powers of two strategies are compared draw by draw.
"""

from __future__ import annotations

import argparse
import dataclasses
import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from channels import FIRST_SEED
from measuring import duration, table

import wirelessagent as wa
from wirelessagent.model.cell import Cell
from wirelessagent.model.decision import Decision
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.metrics import kept
from wirelessagent.model.problem import Problem
from wirelessagent.model.rates import user_rate_bps
from wirelessagent.model.scene import Scene

RATE_BPS, OUTAGE = 0.5e6, 0.05
CELL = Cell(max_power_w=1e3)
PLAIN = Problem("min_power", min_rate_bps=RATE_BPS)
PROMISE = dataclasses.replace(PLAIN, outage_probability=OUTAGE)
LOSSES = (0.2, 0.5)
SNRS_DB = (None, 30.0)
LOSS_SEED = 1_000_000
STRATEGIES = ("perfect knowledge", "estimate as it stands", "no repaired entry", "promised at 95 %")
HEADER = (
    "delay spread, loss, SNR",
    "strategy",
    "rest on repaired",
    "of these miss",
    "of all miss",
    "power / perfect",
    "promised over it: power",
    "time: median",
)


@dataclass
class Count:
    """What one strategy did on many draws.

    Attributes:
        users, missed, resting, missed_resting: numbers of users.
        power_w, time_s: of each draw.
    """

    users: int = 0
    missed: int = 0
    resting: int = 0
    missed_resting: int = 0
    power_w: list[float] = field(default_factory=list)
    time_s: list[float] = field(default_factory=list)

    def add(self, decision: Decision, estimate: ChannelEstimate, scene: Scene, elapsed_s: float) -> None:
        truth = scene.current_truth
        assert truth is not None
        assert decision.is_usable
        missed = ~kept(user_rate_bps(truth, decision.owner, decision.power_w, CELL), np.full(len(truth), RATE_BPS))
        used = (decision.owner == np.arange(len(truth))[:, np.newaxis]) & (decision.power_w > 0)
        resting = (used & estimate.repaired).any(axis=1)
        self.users += missed.size
        self.missed += int(missed.sum())
        self.resting += int(resting.sum())
        self.missed_resting += int((missed & resting).sum())
        self.power_w.append(decision.total_power_w)
        self.time_s.append(elapsed_s)


def measure(delay_spread_s: float, loss: float, snr_db: float | None, count: int) -> dict[str, Count]:
    """The strategies' counts on ``count`` draws of one case."""
    counts = {name: Count() for name in STRATEGIES}
    for seed in range(FIRST_SEED, FIRST_SEED + count):
        scene = wa.simulate(
            "rayleigh", CELL, seed=seed, num_users=8, num_subcarriers=20, rms_delay_spread_s=delay_spread_s,
            snr_db=snr_db,
        )  # fmt: skip
        estimate = wa.repair(scene.observe(wa.loss.random(loss), seed=LOSS_SEED + seed))
        avoiding = dataclasses.replace(PROMISE, forbidden=np.asarray(estimate.repaired))
        posed = ((wa.perfect(scene), PLAIN), (estimate, PLAIN), (estimate, avoiding), (estimate, PROMISE))
        for name, (known, problem) in zip(STRATEGIES, posed, strict=True):
            start = time.process_time()
            decision = wa.decide(known, problem, CELL)
            counts[name].add(decision, known, scene, time.process_time() - start)
    return counts


def rows(case: str, counts: dict[str, Count]) -> list[list[str]]:
    perfect, promised = (np.log(counts[name].power_w) for name in (STRATEGIES[0], STRATEGIES[-1]))
    found: list[list[str]] = []
    for name, one in counts.items():
        power = np.log(one.power_w)
        found.append(
            [
                case,
                name,
                _share(one.resting, one.users),
                _share(one.missed_resting, one.resting),
                _share(one.missed, one.users),
                f"{np.exp(np.mean(power - perfect)):.3f}",
                _ratio(promised - power),
                duration(float(np.median(one.time_s))),
            ]
        )
    return found


def _share(part: int, whole: int) -> str:
    """A share in percent with its 95 % interval."""
    if not whole:
        return "–"
    share = part / whole
    return f"{100 * share:.2f} ± {196 * np.sqrt(share * (1 - share) / whole):.2f} %"


def _ratio(difference: np.ndarray[tuple[int], np.dtype[np.float64]]) -> str:
    """A geometric mean with its 95 % interval."""
    mean, error = float(difference.mean()), 1.96 * float(difference.std(ddof=1)) / np.sqrt(difference.size)
    return f"{np.exp(mean):.3f} ± {error:.3f}"


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--draws", type=int, default=600, help="channels per case (600)")
    parser.add_argument("--delay-spread-ns", default="300,100,1000", help="separated by commas: %(default)s")
    chosen = parser.parse_args(arguments)
    for delay_ns in map(float, chosen.delay_spread_ns.split(",")):
        found: list[list[str]] = []
        for loss in LOSSES:
            for snr_db in SNRS_DB:
                measured = "exact" if snr_db is None else f"{snr_db:g} dB"
                case = f"{delay_ns:g} ns, {100 * loss:g} %, {measured}"
                found += rows(case, measure(delay_ns * 1e-9, loss, snr_db, chosen.draws))
        title = f"Promises: {RATE_BPS / 1e6:g} Mbit/s each with an outage of {100 * OUTAGE:g} %, 8×20"
        table(f"{title}, {chosen.draws} draws", HEADER, found)


if __name__ == "__main__":
    main()
