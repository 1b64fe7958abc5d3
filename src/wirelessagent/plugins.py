"""The one door for plug-ins: channel sources, repairers, objectives, methods and base stations.

A plug-in is a class in one file and one entry point in the group of its kind, for example

    [project.entry-points."wirelessagent.objective"]
    alpha_fairness = "my_package.alpha_fairness:AlphaFairness"

The built-in ones enter the same way. Two plug-ins of one name are an error that names both packages, raised when the
name is asked for; one that fails to load is named with its package, and the others go on working.
"""

from __future__ import annotations

import functools
import importlib
import inspect
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib import metadata
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, cast, get_args

from wirelessagent.model.errors import InputError, PluginError, UnknownNameError
from wirelessagent.plugin_options import Option, converted, options_of

if TYPE_CHECKING:
    from wirelessagent.model.objective import Objective

Kind: TypeAlias = Literal["channel_source", "repairer", "objective", "method", "base_station"]

KINDS: tuple[Kind, ...] = get_args(Kind)

_BASES: dict[Kind, str] = {
    "channel_source": "wirelessagent.sensing.source:ChannelSource",
    "repairer": "wirelessagent.repairing.repairer:Repairer",
    "objective": "wirelessagent.model.objective:Objective",
    "method": "wirelessagent.deciding.method:Method",
    "base_station": "wirelessagent.acting.base_station:BaseStation",
}


@dataclass(frozen=True, kw_only=True)
class Plugin:
    """What is registered under a name: where it comes from and, once loaded, its class or why it failed."""

    kind: Kind
    name: str
    package: str
    target: str
    cls: type[Any] | None
    error: str = ""

    @property
    def summary(self) -> str:
        """The first line of its docstring."""
        text = (self.cls.__doc__ or "").strip() if self.cls else ""
        return text.splitlines()[0] if text else self.error

    @property
    def options(self) -> tuple[Option, ...]:
        return options_of(self.cls) if self.cls else ()


def names(kind: Kind) -> list[str]:
    """Every registered name of a kind, sorted."""
    return sorted(_entry_points(kind))


def plugin(kind: Kind, name: str) -> Plugin:
    """The plug-in of this name, loaded if it can be; a plug-in that fails carries its error.

    Raises:
        UnknownNameError: nothing is registered under the name.
        PluginError: two packages registered it.
    """
    entries = _entry_points(kind).get(name)
    if entries is None:
        raise UnknownNameError(kind.replace("_", " "), name, names(kind))
    if len(entries) > 1:
        owners = " and ".join(f"{package_of(entry)} ({entry.value})" for entry in entries)
        raise PluginError(f"two plug-ins are called {name!r} ({kind}): {owners}; remove or rename one")
    return _load(kind, entries[0])


def version_of(package: str) -> str:
    """The installed version of a package; "" if it is not installed."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return ""


def plugins(kind: Kind) -> list[Plugin]:
    """Every plug-in of a kind; duplicates and failures carry their error instead of a class."""
    found: list[Plugin] = []
    for name, entries in sorted(_entry_points(kind).items()):
        try:
            found.append(plugin(kind, name))
        except PluginError as error:
            owners = " and ".join(package_of(entry) for entry in entries)
            target = " and ".join(entry.value for entry in entries)
            found.append(Plugin(kind=kind, name=name, package=owners, target=target, cls=None, error=str(error)))
    return found


def load(kind: Kind, name: str) -> type[Any]:
    """The class of the plug-in ``name``; a :class:`PluginError` where it cannot be loaded."""
    found = plugin(kind, name)
    if found.cls is None:
        raise PluginError(found.error)
    return found.cls


def create(
    kind: Kind, name: str, options: Mapping[str, Any] | None = None, /, *args: Any, beside: Iterable[str] = ()
) -> Any:
    """An instance of the plug-in ``name`` with its options; positional ``args`` go before them.

    ``beside`` are names that the caller takes itself, one of which may be what a mistyped option meant.

    Raises:
        InputError: an option that it does not have, or a value that it refuses.
    """
    cls = load(kind, name)
    given = options or {}
    known = {option.name: option for option in options_of(cls)}
    for key in given:
        if key not in known:
            raise UnknownNameError("option", key, known, of=f"the {kind.replace('_', ' ')} {name!r}", beside=beside)
    missing = [option.name for option in known.values() if option.required and option.name not in given]
    if missing:
        raise InputError(f"the {kind.replace('_', ' ')} {name!r} needs {', '.join(missing)}")
    return cls(*args, **{key: converted(known[key], value) for key, value in given.items()})


def objective(name: str, options: Mapping[str, Any] | None = None) -> Objective:
    """The objective of this name or alias ("max_rate" or "P1"), with its options."""
    return _plain_objective(name) if not options else _objective(name, options)


def check_objective(name: str) -> None:
    """Raise where no objective has this name or alias. A registered name loads nothing; an alias is asked for.

    Raises:
        UnknownNameError: nothing is registered under the name.
    """
    if name not in _entry_points("objective"):
        objective(name)


@functools.cache
def _plain_objective(name: str) -> Objective:
    """Objectives are frozen, so one without options serves everybody."""
    return _objective(name, None)


def _objective(name: str, options: Mapping[str, Any] | None) -> Objective:
    if name not in _entry_points("objective"):
        found = [item for item in plugins("objective") if item.cls is not None and name in item.cls.aliases]
        if len(found) > 1:
            owners = " and ".join(f"{item.name!r} of {item.package}" for item in found)
            raise PluginError(f"two objectives have the alias {name!r}: {owners}; ask for one by its name")
        if found:
            return cast("Objective", create("objective", found[0].name, options))
    return cast("Objective", create("objective", name, options))


def package_of(entry: metadata.EntryPoint) -> str:
    """The distribution that an entry point belongs to."""
    return entry.dist.name if entry.dist is not None else "unknown package"


def refresh() -> None:
    """Forget what was found, so that packages installed since are seen."""
    _installed.cache_clear()
    _entry_points.cache_clear()
    _load.cache_clear()
    _plain_objective.cache_clear()


@functools.cache
def _installed() -> metadata.EntryPoints:
    """The entry points of all packages, whose folders are looked through once for all kinds."""
    return cast("metadata.EntryPoints", metadata.entry_points())


@functools.cache
def _entry_points(kind: Kind) -> dict[str, list[metadata.EntryPoint]]:
    found: dict[str, list[metadata.EntryPoint]] = {}
    for entry in _installed().select(group=f"wirelessagent.{kind}"):
        same = found.setdefault(entry.name, [])
        # one package found twice on the path is one plug-in
        if not any((other.value, package_of(other)) == (entry.value, package_of(entry)) for other in same):
            same.append(entry)
    return found


@functools.cache
def _load(kind: Kind, entry: metadata.EntryPoint) -> Plugin:
    package = package_of(entry)
    known = functools.partial(Plugin, kind=kind, name=entry.name, package=package, target=entry.value)
    try:
        cls = entry.load()
        _check(kind, entry.name, cls)
    except (Exception, SystemExit) as error:  # noqa: BLE001  # a stranger's code must not take the rest down
        reason = str(error) if isinstance(error, PluginError) else f"{type(error).__name__}: {error}"
        return known(cls=None, error=f"the {kind} {entry.name!r} of {package} cannot be loaded: {reason}")
    return known(cls=cls)


def _check(kind: Kind, name: str, cls: object) -> None:
    module, _, attribute = _BASES[kind].partition(":")
    base: type[Any] = getattr(importlib.import_module(module), attribute)
    if not (isinstance(cls, type) and issubclass(cls, base)):
        raise PluginError(f"{cls!r} is not a subclass of {base.__name__}")
    if inspect.isabstract(cls):
        lacking = ", ".join(sorted(cast("Any", cls).__abstractmethods__))
        raise PluginError(f"{cls.__name__} is abstract: it must define {lacking}, as wa.{base.__name__} describes")
    if "__dataclass_params__" not in vars(cls):  # the base is a dataclass, so is_dataclass() is true of every subclass
        raise PluginError(f"{cls.__name__} is not a dataclass: decorate it with @dataclass(frozen=True, kw_only=True)")
    if getattr(cls, "name", None) != name:
        raise PluginError(
            f"its entry point is called {name!r} but {cls.__name__}.name is {getattr(cls, 'name', None)!r}"
        )
    options_of(cls)  # annotations that cannot be resolved show here, not on a surface that lists them
