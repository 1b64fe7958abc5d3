"""plugins: what is installed, of all five kinds."""

from __future__ import annotations

from typing import Any

from pydantic import Field

from wirelessagent import plugins
from wirelessagent.model.errors import UnknownNameError
from wirelessagent.operations.operation import Operation, Progress, Request
from wirelessagent.operations.record import Block, Record, Table


class PluginsRequest(Request):
    kind: str | None = Field(None, description=f"only this kind: {', '.join(plugins.KINDS)}")


class OptionAnswer(Record):
    """An option of a plug-in; a default of null means that it has none or that it is off.

    ``help`` is empty where its docstring says nothing of it, ``choices`` where any value of the type may be given;
    ``several`` says that a list of such values may be given as well.
    """

    name: str
    type: str
    default: Any
    required: bool
    help: str
    choices: list[Any]
    several: bool


class PluginAnswer(Record):
    """A registered plug-in; ``error`` says why it cannot be used, empty if it can."""

    kind: str
    name: str
    package: str
    target: str
    summary: str
    error: str
    options: list[OptionAnswer]

    @classmethod
    def of(cls, found: plugins.Plugin) -> PluginAnswer:
        options = [
            OptionAnswer(
                name=option.name,
                type=option.type.__name__,
                default=option.default if option.default is None or option.several else option.type(option.default),
                required=option.required,
                help=option.help,
                choices=list(option.choices),
                several=option.several,
            )
            for option in found.options
        ]
        return cls(
            kind=found.kind,
            name=found.name,
            package=found.package,
            target=found.target,
            summary=found.summary if found.cls else "",
            error=found.error,
            options=options,
        )


class PluginsRecord(Record):
    """Every registered plug-in."""

    plugins: list[PluginAnswer]

    def blocks(self) -> list[Block]:
        kinds = dict.fromkeys(found.kind for found in self.plugins)
        return [self._table(kind) for kind in kinds]

    def _table(self, kind: str) -> Table:
        rows = tuple(
            (
                found.name,
                found.error or found.summary,
                ", ".join(option.name for option in found.options) or "–",
                found.package,
            )
            for found in self.plugins
            if found.kind == kind
        )
        title = kind.replace("_", " ").capitalize()
        return Table(title=title, columns=("name", "what it does", "options", "package"), rows=rows)


def run(request: PluginsRequest, progress: Progress) -> PluginsRecord:
    del progress
    if request.kind is not None and request.kind not in plugins.KINDS:
        raise UnknownNameError("kind of plug-in", request.kind, plugins.KINDS)
    kinds: list[plugins.Kind] = [kind for kind in plugins.KINDS if request.kind in (None, kind)]
    return PluginsRecord(plugins=[PluginAnswer.of(found) for kind in kinds for found in plugins.plugins(kind)])


PLUGINS = Operation(
    name="plugins",
    request=PluginsRequest,
    record=PluginsRecord,
    run=run,
    examples=("plugins", "plugins --kind method"),
)
