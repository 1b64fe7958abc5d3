"""An export as the place of channels that were sealed.

Whatever is read of it is known by its hash to be what was recorded, so that nobody has to trust the file.
"""

from __future__ import annotations

import functools
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, cast

from wirelessagent.model.errors import FileFormatError
from wirelessagent.store.content import Content


class Archive:
    """The file of an export."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def content(self, hash: str) -> Content | None:
        """The channel of this hash; None where the file does not hold it.

        Raises:
            FileFormatError: the file is no export, or what it holds there is not what was recorded.
        """
        place = self._places.get(hash)
        if place is None:
            return None
        with self.path.open("rb") as stream:
            stream.seek(place)
            found = Content.imported(json.loads(stream.readline())["arrays"])
        if found.hash != hash:
            raise FileFormatError(f"{self.path}: the channel {hash[:12]}… was changed: it is now {found.hash[:12]}…")
        return found

    def turns(self) -> Iterator[dict[str, Any]]:
        """The turns in the file, as plain data."""
        for _, line in self._lines():
            if line["kind"] == "turn":
                yield {name: value for name, value in line.items() if name != "kind"}

    @functools.cached_property
    def _places(self) -> dict[str, int]:
        """Where the line of each channel begins."""
        return {line["hash"]: place for place, line in self._lines() if line["kind"] == "content"}

    def _lines(self) -> Iterator[tuple[int, dict[str, Any]]]:
        try:
            with self.path.open("rb") as stream:
                place = 0
                for text in stream:
                    line: object = json.loads(text)
                    if not isinstance(line, dict) or not {"kind", "hash"} <= line.keys():
                        raise FileFormatError(f"{self.path}: this is no export of 'history export' or 'history seal'")
                    yield place, cast("dict[str, Any]", line)
                    place += len(text)
        except (OSError, ValueError) as error:
            raise FileFormatError(f"{self.path} cannot be read as an export: {error}") from error
