"""One user's channel over frequency, what was lost of it, and what each method makes of that."""

from __future__ import annotations

import numpy as np

from wirelessagent import chain
from wirelessagent.experiments.draws import seeds_of
from wirelessagent.experiments.evaluated_channels import EvaluatedChannel
from wirelessagent.experiments.evaluated_methods import BASELINE, ORACLE, first_known, repaired, states_uncertainty
from wirelessagent.experiments.table import Table, Value, table_of
from wirelessagent.model.arrays import FloatArray
from wirelessagent.model.units import db
from wirelessagent.sensing.loss import parse as parse_loss

PREFERRED = ("kriging", chain.DEFAULT_REPAIRER, ORACLE)
"""Whose band is shown, of the methods evaluated."""

_FLOOR_DB = 40.0
"""How far below the user's level gains are still drawn."""


def recovery_table(channel: EvaluatedChannel, loss: str, methods: tuple[str, ...], seed: int) -> Table:
    """The first draw's user that lost most but not all: truth, observed, estimates and one method's 90 % band, in dB.

    Columns: user, subcarrier, missing, truth_db, observed_db (as measured, NaN = missing), then ``<method>_db`` for the
    method with the band, one competitor and the user mean, as far as they are evaluated, then ``low_db`` and
    ``high_db``.
    """
    seeds = seeds_of(seed, 0)
    drawn = channel.drawn(seeds.channel)
    observation = drawn.scene.observe(parse_loss(loss), seed=seeds.loss)
    known = tuple(name for name in methods if name != ORACLE or drawn.oracle is not None)
    shown = first_known([name for name in known if states_uncertainty(name)] or known, PREFERRED)
    others = [name for name in ("cubic", "linear", "nncf") if name in known and name != shown][:1]
    names = [shown, *others, *([BASELINE] if BASELINE in known and shown != BASELINE else [])]
    lost = observation.missing.sum(axis=1)
    user = int(np.argmax(np.where(lost < observation.num_subcarriers, lost, -1)))
    estimates = [repaired(name, drawn, observation)[0] for name in names]
    posterior = estimates[0].posterior
    level = drawn.level[user] or 1.0

    def in_db(gain: FloatArray) -> FloatArray:
        return db(gain[user] / level, floor_db=-_FLOOR_DB)

    lines = [in_db(drawn.truth), in_db(observation.current), *(in_db(estimate.gain) for estimate in estimates)]
    lines += [in_db(posterior.quantile(at)) for at in (0.05, 0.95)]
    rows: list[tuple[Value, ...]] = [
        (observation.user_names[user], n + 1, int(observation.missing[user, n]), *(float(line[n]) for line in lines))
        for n in range(observation.num_subcarriers)
    ]
    columns = (
        "user",
        "subcarrier",
        "missing",
        "truth_db",
        "observed_db",
        *(f"{name}_db" for name in names),
        "low_db",
        "high_db",
    )
    return table_of(columns, rows)
