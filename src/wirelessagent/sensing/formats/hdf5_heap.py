"""A check that HDF5's own library does not make: that its global heaps, where texts and references lie, end.

On a damaged heap the library (2.0, and since 1.12 at least: HDFGroup/hdf5 issue 1707) runs forever, which no error
handling could catch. Format: HDF5 File Format Specification, III.E "Level 1E - Global Heap".
"""

from __future__ import annotations

import struct

from wirelessagent.model.errors import FileFormatError

_HEAP = b"GCOL\x01"
_HEADER_BYTES = 16  # of a heap, and of each object in it
_SMALLEST_HEAP_BYTES = 4096


def check_heaps(data: bytes) -> None:
    """Refuse a file in which walking through a global heap would not come to an end.

    Raises:
        FileFormatError: an object of a heap does not fit into it.
    """
    start = data.find(_HEAP)
    while start >= 0:
        size = _length(data, start + 8)
        if _SMALLEST_HEAP_BYTES <= size <= len(data) - start:  # the library itself refuses others
            _check_heap(data, start, start + size)
        start = data.find(_HEAP, start + 1)


def _check_heap(data: bytes, start: int, end: int) -> None:
    place = start + _HEADER_BYTES
    while place + _HEADER_BYTES <= end:
        (index,) = struct.unpack_from("<H", data, place)
        size = _length(data, place + 8)
        needed = size if index == 0 else _HEADER_BYTES + size + -size % 8  # 0 is free space, header included
        if needed < _HEADER_BYTES or place + needed > end:
            raise FileFormatError(f"is damaged: the heap at byte {start} has an object of {size} bytes; write it again")
        place += needed


def _length(data: bytes, place: int) -> int:
    return int.from_bytes(data[place : place + 8], "little")
