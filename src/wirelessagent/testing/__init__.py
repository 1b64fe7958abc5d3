"""Contract suites, one per kind of plug-in, for pytest classes of yours to inherit.

    import wirelessagent as wa

    class TestAlphaFairness(wa.testing.ObjectiveContract):
        objective = AlphaFairness()

Each suite is itself tested on deliberately broken plug-ins, in ``wirelessagent.testing.broken``, which it must reject.
"""

from __future__ import annotations

from wirelessagent.testing.base_station_contract import BaseStationContract
from wirelessagent.testing.method_contract import MethodContract
from wirelessagent.testing.objective_contract import ObjectiveContract
from wirelessagent.testing.repairer_contract import RepairerContract
from wirelessagent.testing.source_contract import ChannelSourceContract

__all__ = ["BaseStationContract", "ChannelSourceContract", "MethodContract", "ObjectiveContract", "RepairerContract"]
