"""What the places of a server are called for callers elsewhere: nothing that leaves it names a path of its machine.

All that workers say passes here. A file that a caller sent goes by the name that they gave it, the store is "this
server", and of any other file below one of the server's folders its own name is left.
"""

from __future__ import annotations

import json
import re
import sys
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path

_LEAST_PARTS = 3
"""Parts of a folder's path, the root among them, below which it is no place of a server's but of every machine's."""
_OURS = (tempfile.gettempdir(), Path.home(), Path.cwd(), sys.prefix, Path(__file__).parents[2], *filter(None, sys.path))
_BEFORE = rb"(?:(?<![\w.-])|(?<=\\[nrt]))"
_BETWEEN = rb"(?:/|\\\\)"
_PART = rb"(?:[^/\\\"'\s,;:)]|\\u[0-9a-f]{4})+"


class PublicNames:
    """What is told instead of paths.

    Args:
        called: what some places are called.
        folders: where all else is told by the last part of its path.
    """

    def __init__(self, called: Mapping[str, str], folders: Iterable[Path | str]) -> None:
        self._called = called
        ours = {str(Path(folder).absolute()) for folder in (*folders, *_OURS)}
        known = sorted(_written(folder) for folder in ours if len(Path(folder).parts) >= _LEAST_PARTS)
        self._ours = re.compile(
            _BEFORE + b"(?:%s)(?![\\w.-])(?:%s%s)*" % (b"|".join(map(re.escape, known)), _BETWEEN, _PART)
        )

    def told(self, line: bytes, called: Mapping[str, str]) -> bytes:
        """A line of JSON with names in the place of paths; ``called`` says what some more places are called."""
        names = {**self._called, **called}
        for place in sorted(names, key=len, reverse=True):
            line = line.replace(_written(place), _written(names[place]))
        return self._ours.sub(lambda found: re.split(_BETWEEN, found[0])[-1], line)


def _written(text: str) -> bytes:
    """A text as JSON has it."""
    return json.dumps(text)[1:-1].encode("ascii")
