"""What every contract suite shares: how its checks are found and run, and what any plug-in must be.

A suite is a plain class with ``test_*`` methods, so that pytest runs it when a class called ``Test…`` inherits it, and
``failures()`` runs it without pytest. A check that rests on an answer which another check already rejects is skipped:
one defect shows as one failure.
"""

from __future__ import annotations

import dataclasses
import pickle
import re
from typing import Any, NoReturn, cast
from unittest import SkipTest

from wirelessagent.plugins import options_of

TOLERANCE = 1e-9
"""Relative tolerance of every check that compares numbers."""


def skip(reason: str) -> NoReturn:
    """Leave a check out; pytest and unittest both understand this."""
    raise SkipTest(reason)


def as_returned(value: object) -> object:
    """A plug-in's answer without its annotation, which a check must not believe."""
    return value


class Contract:
    """A set of checks. Subclass one of the suites, not this."""

    @classmethod
    def checks(cls) -> tuple[str, ...]:
        """The names of all checks of the suite."""
        return tuple(name for name in dir(cls) if name.startswith("test_"))

    def failures(self) -> dict[str, Exception]:
        """Runs every check without pytest; what failed, by the name of the check."""
        found: dict[str, Exception] = {}
        for name in self.checks():
            try:
                getattr(self, name)()
            except SkipTest:
                continue
            except Exception as error:  # noqa: BLE001  # a plug-in may fail in any way, and each is a finding
                found[name] = error
        return found


class PluginContract(Contract):
    """What a plug-in of any kind must be, so that the registry, the surfaces and process pools can use it."""

    def subject(self) -> Any:
        """The plug-in under test."""
        raise NotImplementedError

    def _class(self) -> type[Any]:
        return cast("type[Any]", type(self.subject()))

    def test_is_a_frozen_dataclass(self) -> None:
        cls = self._class()
        parameters = vars(cls).get("__dataclass_params__")
        assert parameters is not None, f"decorate {cls.__name__} with @dataclass(frozen=True), or it has no options"
        assert parameters.frozen, f"{cls.__name__} must be frozen: @dataclass(frozen=True)"

    def test_has_a_name(self) -> None:
        name = getattr(self.subject(), "name", None)
        assert isinstance(name, str), f"name must be text; got {name!r}"
        assert re.fullmatch("[a-z][a-z0-9_]*", name), f"a name is lower case with underscores; got {name!r}"

    def test_has_a_summary(self) -> None:
        cls = self._class()
        text = (cls.__doc__ or "").strip()
        generated = text.startswith(f"{cls.__name__}(")  # what the dataclass decorator puts where there is none
        assert text, f"{cls.__name__} needs a docstring: its first line is shown to users"
        assert not generated, f"{cls.__name__} needs a docstring: its first line is shown to users"

    def test_can_be_made_from_its_options(self) -> None:
        cls = self._class()
        options = {option.name for option in options_of(cls)}
        for field in dataclasses.fields(cls):
            has_default = field.default is not dataclasses.MISSING or field.default_factory is not dataclasses.MISSING
            assert not field.init or has_default or field.name in options, (
                f"the field {field.name!r} has no default and is no number, text, switch or path, "
                "so nobody can set it from the command line"
            )

    def test_survives_pickling(self) -> None:
        subject = self.subject()
        again = pickle.loads(pickle.dumps(subject))
        assert repr(again) == repr(subject), f"pickling turned {subject!r} into {again!r}"


class ValueContract(PluginContract):
    """What a plug-in without a scene must be besides: a value that can be compared and used as a key."""

    def test_is_a_value(self) -> None:
        subject = self.subject()
        same = dataclasses.replace(subject)
        assert subject == same, f"{subject!r} differs from a copy of itself"
        assert hash(subject) == hash(same), f"{subject!r} and a copy of it have different hashes"
