"""new-plugin: write a package for a plug-in of one's own that works from the start, with its contract test."""

from __future__ import annotations

import re
import shutil
from collections.abc import Mapping
from pathlib import Path
from string import Template
from typing import Annotated

from pydantic import Field

from wirelessagent import plugins
from wirelessagent.model.errors import InputError, UnknownNameError
from wirelessagent.operations.fields import Positional
from wirelessagent.operations.operation import Operation, Progress, Request
from wirelessagent.operations.record import Block, Files, Record

_TEMPLATES = Path(__file__).parent / "plugin_templates"
_NAME = "[a-z][a-z0-9_]*"


_USE: Mapping[plugins.Kind, str] = {
    "channel_source": "wirelessagent simulate --source",
    "repairer": "wirelessagent repair gains.csv --method",
    "objective": "wirelessagent solve gains.csv --objective",
    "method": "wirelessagent solve gains.csv --objective max_rate --method",
    "base_station": 'wirelessagent ask "Highest total rate" --base-station',
}
"""How a plug-in of each kind is named on the command line."""


class NewPluginRequest(Request):
    kind: Annotated[str, Positional()] = Field(description=f"what it is: {', '.join(plugins.KINDS)}")
    name: Annotated[str, Positional()] = Field(description="what it is called, as in log_rate")
    folder: Path = Field(Path(), description="folder to put the package in; the current one if not given")


class NewPluginRecord(Record):
    """The package that was written; ``files`` are relative to its folder."""

    kind: str
    name: str
    folder: Path
    files: list[str]

    def blocks(self) -> list[Block]:
        return [
            Files("written to", (self.folder,)),
            ", ".join(self.files),
            f"next: cd {self.folder} && pip install -e '.[test]' && pytest",
        ]


def run(request: NewPluginRequest, progress: Progress) -> NewPluginRecord:
    del progress
    kind = _kind(request.kind)
    name = _free_name(kind, request.name)
    folder = request.folder / f"wirelessagent-{name.replace('_', '-')}"
    files = package_files(kind, name)
    _write(folder, files)
    return NewPluginRecord(kind=kind, name=name, folder=folder, files=sorted(files))


def package_files(kind: plugins.Kind, name: str) -> dict[str, str]:
    """The text of each file of the package for a plug-in, by its place in the package."""
    module = f"wirelessagent_{name}"
    words = {
        "kind": kind,
        "what": kind.replace("_", " "),
        "name": name,
        "words": name.replace("_", " ").strip(),
        "package": module.replace("_", "-"),
        "module": module,
        "cls": "".join(part.capitalize() for part in name.split("_")),
        "use": f"{_USE[kind]} {name}",
    }
    templates = {
        "pyproject.toml": "pyproject.toml",
        "README.md": "README.md",
        f"{module}.py": f"{kind}.py",
        f"tests/test_{module}.py": f"test_{kind}.py",
    }
    return {place: _filled(template, words) for place, template in templates.items()}


def _filled(template: str, words: Mapping[str, str]) -> str:
    return Template((_TEMPLATES / f"{template}.txt").read_text(encoding="utf-8")).substitute(words)


def _kind(given: str) -> plugins.Kind:
    kind = given.strip().lower().replace("-", "_").replace(" ", "_")
    if kind not in plugins.KINDS:
        raise UnknownNameError("kind of plug-in", given, plugins.KINDS)
    return kind


def _free_name(kind: plugins.Kind, name: str) -> str:
    if not re.fullmatch(_NAME, name):
        raise InputError(f"a name is lower case with underscores, as in log_rate; got {name!r}")
    if name in plugins.names(kind):
        raise InputError(f"the name {name!r} is taken among the {kind.replace('_', ' ')}s: choose another")
    return name


def _write(folder: Path, files: Mapping[str, str]) -> None:
    """All the files in a folder of their own, or none of them."""
    try:
        folder.mkdir()
    except FileExistsError as error:
        raise InputError(f"{folder} is there already: choose another name or another --folder") from error
    except OSError as error:
        raise InputError(f"cannot write {folder}: {error.strerror or error}; choose another --folder") from error
    try:
        for place, text in files.items():
            target = folder / place
            target.parent.mkdir(exist_ok=True)
            target.write_text(text, encoding="utf-8")
    except OSError as error:
        shutil.rmtree(folder)
        raise InputError(f"cannot write {folder}: {error.strerror or error}; nothing was left there") from error


NEW_PLUGIN = Operation(
    name="new-plugin",
    request=NewPluginRequest,
    record=NewPluginRecord,
    local=True,
    run=run,
    examples=("new-plugin objective log_rate",),
)
