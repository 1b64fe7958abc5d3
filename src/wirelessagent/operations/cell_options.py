"""The cell's physics and limits as options."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal, TypeAlias

from pydantic import Field

from wirelessagent.operations.fields import Advanced
from wirelessagent.operations.operation import Request

if TYPE_CHECKING:
    from wirelessagent.model.cell import Cell

_Figure: TypeAlias = Annotated[float | None, Advanced()]


class CellOptions(Request):
    """Options that describe the cell. What was given wins; the rest comes from the channel file, else the preset."""

    panel: ClassVar[str] = "Cell"

    cell_preset: Annotated[Literal["paper", "nr"], Advanced()] = Field(
        "paper", description="defaults of the cell: the paper's, or NR-like"
    )
    subcarrier_bandwidth_hz: _Figure = Field(None, description="bandwidth of one subcarrier, Hz")
    noise_psd_w_per_hz: _Figure = Field(None, description="noise power spectral density, W/Hz")
    cell_max_power_w: float | None = Field(None, description="the cell's power limit, W")
    circuit_power_w: _Figure = Field(None, description="power drawn whatever is radiated, W")
    snr_gap_db: _Figure = Field(None, description="coding gap to Shannon's limit, dB")
    max_spectral_efficiency_bps_per_hz: _Figure = Field(None, description="highest rate per hertz, bit/s/Hz")
    overhead: _Figure = Field(None, description="share of resources that carries no data, 0 to 1")
    amplifier_efficiency: _Figure = Field(None, description="radiated over drawn power, 0 to 1")

    def cell(self, known: Cell | None = None, *, wanted_power_w: float | None = None) -> Cell:
        """The cell: the preset (or what is ``known``), with the options that were given.

        Where the cell's own limit was not given, a budget that asks for more is the limit as well: whoever brings a
        matrix and a budget has no other.
        """
        from wirelessagent.model.cell import Cell

        base = known or (Cell.nr() if self.cell_preset == "nr" else Cell())
        given = {
            name: getattr(self, name)
            for name in CellOptions.model_fields
            if name not in ("cell_preset", "cell_max_power_w") and getattr(self, name) is not None
        }
        if self.cell_max_power_w is not None:
            given["max_power_w"] = self.cell_max_power_w
        elif wanted_power_w is not None and wanted_power_w > base.max_power_w:
            given["max_power_w"] = wanted_power_w
        return dataclasses.replace(base, **given)
