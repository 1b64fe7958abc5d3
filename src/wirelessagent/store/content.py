"""Channels as blobs: the arrays of an observation or an estimate in compressed NPZ, named by a hash of what they hold.

The hash is over names, types, shapes and bytes of the arrays and not over the file, so that it stays the same whatever
compresses it.
"""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from wirelessagent.model.errors import StoreError
from wirelessagent.model.estimate import ChannelEstimate
from wirelessagent.model.observation import ChannelObservation
from wirelessagent.store.plain import canonical, plain

Arrays = Mapping[str, NDArray[Any]]

_WORDS = "words"
"""The array that holds, as JSON in UTF-8, what is no array."""


@dataclass(frozen=True, kw_only=True)
class Content:
    """Arrays under the hash of what they hold."""

    hash: str
    arrays: Arrays

    @classmethod
    def of(cls, arrays: Arrays) -> Content:
        return cls(hash=_hash(arrays), arrays=arrays)

    @classmethod
    def unpacked(cls, hash: str, data: bytes) -> Content:
        """The content of a blob.

        Raises:
            StoreError: it is not what was stored under this hash.
        """
        try:
            with np.load(io.BytesIO(data), allow_pickle=False) as stored:
                found = cls.of(dict(stored))
        except Exception as error:  # a database may hold anything by now, and it fails in any way
            raise StoreError(f"the content {hash[:12]}… was changed: it can no longer be read") from error
        if found.hash != hash:
            raise StoreError(f"the content {hash[:12]}… was changed: it is now {found.hash[:12]}…")
        return found

    def packed(self) -> bytes:
        stream = io.BytesIO()
        np.savez_compressed(stream, **self.arrays)  # pyright: ignore[reportArgumentType]  # its last is a switch
        return stream.getvalue()

    def exported(self) -> dict[str, Any]:
        """Plain data from which the arrays, and so the hash, can be had again."""
        return {
            name: {"dtype": array.dtype.str, "shape": list(array.shape), "values": plain(array.ravel())}
            for name, array in self.arrays.items()
        }

    @classmethod
    def imported(cls, arrays: Mapping[str, Any]) -> Content:
        """The content of what :meth:`exported` gave.

        Raises:
            ValueError, KeyError, TypeError: it is something else.
        """
        return cls.of(
            {
                name: np.array(array["values"], dtype=np.dtype(array["dtype"])).reshape(array["shape"])
                for name, array in arrays.items()
            }
        )


def _hash(arrays: Arrays) -> str:
    digest = hashlib.sha256()
    for name in sorted(arrays):
        array = np.ascontiguousarray(arrays[name])
        digest.update(f"{name} {array.dtype.str} {array.shape} ".encode() + array.tobytes())
    return digest.hexdigest()


def observation_content(observation: ChannelObservation) -> Content:
    names = ("gain", "noise_variance", "estimated", "subcarrier_frequencies_hz", "slot_times_s")
    arrays = {name: getattr(observation, name) for name in names if getattr(observation, name) is not None}
    return Content.of({**arrays, _WORDS: _packed_words(user_names=observation.user_names)})


def observation_of(content: Content) -> ChannelObservation:
    return ChannelObservation(**_arguments(content))


def estimate_content(estimate: ChannelEstimate) -> Content:
    """The estimate without its joint posterior, which repairing again gives."""
    names = ("gain", "gain_variance", "repaired", "unobserved_users")
    words = _packed_words(user_names=estimate.user_names, method=estimate.method)
    return Content.of({**{name: getattr(estimate, name) for name in names}, _WORDS: words})


def estimate_of(content: Content) -> ChannelEstimate:
    return ChannelEstimate(**_arguments(content))


def _packed_words(**words: object) -> NDArray[np.uint8]:
    return np.frombuffer(canonical(words).encode(), dtype=np.uint8)


def _arguments(content: Content) -> dict[str, Any]:
    words = cast("dict[str, Any]", json.loads(content.arrays[_WORDS].tobytes()))
    arrays = {name: array for name, array in content.arrays.items() if name != _WORDS}
    return {**arrays, **words, "user_names": tuple(words["user_names"])}
