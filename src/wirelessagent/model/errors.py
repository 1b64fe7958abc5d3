"""What can go wrong, in one tree.

WirelessAgentError
├── InputError                     something the caller gave; the command line exits with 2
│   ├── FileFormatError            a file that is not what it should be
│   ├── UnknownNameError           a plug-in, experiment or operation that does not exist
│   ├── UnsupportedProblemError    a method that does not solve this problem
│   ├── UnclearRequestError        a sentence that needs a question back
│   └── NothingRecordedError       an audit store that does not exist yet, or a turn that is not in it
├── PluginError                    a plug-in that cannot be loaded, or two that share a name
├── StoreError                     an audit store that cannot be opened, read or written, or is none
└── MissingDependencyError         an optional package that is not installed

Every message says what was wrong, the value received and what to do next.
"""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


class WirelessAgentError(Exception):
    """The root: catch this to catch all that the library raises on purpose."""


class InputError(WirelessAgentError, ValueError):
    """Something the caller gave cannot be used."""


class FileFormatError(InputError):
    """A file is not what it should be."""


class UnknownNameError(InputError):
    """A name that nothing is registered under; ``beside`` are names of something else that may have been meant."""

    def __init__(self, kind: str, name: str, known: Iterable[str], *, of: str = "", beside: Iterable[str] = ()) -> None:
        names = sorted(known)
        close = get_close_matches(name, [*names, *beside], n=1)
        hint = f"did you mean {close[0]!r}? " if close else ""
        none = f"{of} has none" if of else "there is none"
        told = f"known are {', '.join(names)}" if names else none
        super().__init__(f"unknown {kind} {name!r}{f' of {of}' if of else ''}: {hint}{told}")


class UnsupportedProblemError(InputError):
    """A method was given a problem that it does not solve."""


class UnclearRequestError(InputError):
    """A sentence that must be answered with a question."""


class NothingRecordedError(InputError):
    """An audit store does not exist yet, or holds no such turn."""


class SealedError(NothingRecordedError):
    """What a turn saw of its channel is in a file elsewhere."""


class PluginError(WirelessAgentError):
    """A plug-in cannot be loaded, or two share a name."""


class StoreError(WirelessAgentError):
    """An audit store cannot be opened, read or written, or what is there is none."""


class MissingDependencyError(WirelessAgentError, ImportError):
    """An optional package is needed and not installed; ``extra`` is the one that brings it, "" where none does."""

    def __init__(self, package: str, extra: str, purpose: str) -> None:
        wanted = f"'wirelessagent[{extra}]'" if extra else package
        super().__init__(f"{purpose} needs the package {package!r}, which is not installed: pip install {wanted}")
