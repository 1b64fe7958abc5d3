"""What a channel file says of the cell and of its axes: bandwidth, noise, carrier, slot length.

The keys, in a JSON text or object called ``meta``, as attributes of an HDF5 file, or beside the gains in JSON:

| key | meaning |
|---|---|
| axes | names of the array's axes in order, such as "slot,user,subcarrier" |
| units | unit of the gains, in words |
| rb_bandwidth_hz or subcarrier_bandwidth_hz | bandwidth of one subcarrier or resource block |
| noise_w_per_rb or noise_psd_w_per_hz | noise power in that bandwidth, or its density |
| carrier_hz | centre frequency of the band |
| slot_s | time from one slot to the next |
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, cast

import numpy as np

from wirelessagent.model.arrays import FloatArray, positive
from wirelessagent.model.cell import Cell
from wirelessagent.model.errors import FileFormatError
from wirelessagent.model.units import human
from wirelessagent.sensing.formats.contents import Contents
from wirelessagent.sensing.formats.json_format import parse
from wirelessagent.sensing.wording import shown

FROM_FILE = "from the file"
"""How a fact says that the file states it."""


def metadata_of(contents: Contents) -> dict[str, Any]:
    """Everything that the file states by name; what stands in ``meta`` wins over what stands beside it."""
    meta: Any = contents.metadata.get("meta", {})
    entry = contents.entry("meta")
    if entry is not None and entry.kind == "text":
        texts = entry.read()
        if texts.size != 1:
            raise FileFormatError(f"meta holds {texts.size} texts; it must be one JSON object")
        meta = str(texts.reshape(-1)[0])
    if isinstance(meta, str):
        try:
            meta = parse(meta)
        except FileFormatError as error:
            raise FileFormatError(f"meta {error}") from error
    if not isinstance(meta, dict):
        raise FileFormatError(f'meta is {shown(meta)}; it must be a JSON object such as {{"carrier_hz": 3.5e9}}')
    return {**contents.metadata, **cast("dict[str, Any]", meta)}


def stated_cell(cell: Cell, metadata: Mapping[str, Any], facts: dict[str, str]) -> Cell:
    """The cell with the bandwidth and noise that the file states; both go to ``facts``."""
    bandwidth_hz = _number(metadata, "rb_bandwidth_hz", "subcarrier_bandwidth_hz")
    if bandwidth_hz is not None:
        cell = dataclasses.replace(cell, subcarrier_bandwidth_hz=bandwidth_hz)
    noise_w = _number(metadata, "noise_w_per_rb")
    psd = _number(metadata, "noise_psd_w_per_hz") if noise_w is None else noise_w / cell.subcarrier_bandwidth_hz
    if psd is not None:
        cell = dataclasses.replace(cell, noise_psd_w_per_hz=psd)
    origin = {True: FROM_FILE, False: "the cell's; the file does not say"}
    facts["bandwidth"] = f"{human(cell.subcarrier_bandwidth_hz, 'Hz')} ({origin[bandwidth_hz is not None]})"
    facts["noise"] = f"{cell.noise_psd_w_per_hz:.4g} W/Hz ({origin[psd is not None]})"
    power_w = _number(metadata, "suggested_tx_power_w")
    if power_w is not None:
        facts["suggested power"] = f"{human(power_w, 'W')} (not applied: give it as the power budget)"
    return cell


def states_noise(metadata: Mapping[str, Any]) -> bool:
    """Whether the file states its noise, so that gains in any unit that suits this noise make sense."""
    return any(metadata.get(name) is not None for name in ("noise_w_per_rb", "noise_psd_w_per_hz"))


def stated_frequencies_hz(cell: Cell, metadata: Mapping[str, Any], num_subcarriers: int) -> FloatArray | None:
    """Centre frequencies around the stated carrier, spaced by the subcarrier bandwidth, shape (subcarrier,)."""
    carrier_hz = _number(metadata, "carrier_hz")
    if carrier_hz is None:
        return None
    offsets = np.arange(num_subcarriers, dtype=np.float64) - (num_subcarriers - 1) / 2
    return carrier_hz + offsets * cell.subcarrier_bandwidth_hz


def stated_slot_times_s(metadata: Mapping[str, Any], num_slots: int) -> FloatArray | None:
    """The time of each slot from the stated distance, the first at 0, shape (slot,)."""
    slot_s = _number(metadata, "slot_s")
    return None if slot_s is None else slot_s * np.arange(num_slots, dtype=np.float64)


def _number(metadata: Mapping[str, Any], *names: str) -> float | None:
    """The first of these keys that is there, as a positive number."""
    for name in names:
        value = metadata.get(name)
        if value is None:
            continue
        if isinstance(value, bool):
            raise FileFormatError(f"the file's {name} must be a number; got {value!r}")
        return positive(f"the file's {name}", value)
    return None
