"""What each condition of the reader is worth: how many readings change where it is fixed to false or to true.

First the lines are recorded that tests say, each with its conversation, then every condition of ``language`` is fixed
in turn (the test of an ``if``, the filter of a comprehension, what "and" and "or" join) and the lines are read again::

    PYTHONPATH=src:benchmarks python -m pytest -n 2 -p branches tests/interfaces tests/contracts
    PYTHONPATH=src:benchmarks python benchmarks/branches.py [goals conversation/fragments …]

Without names, all modules are gone through (about half an hour on one core). A condition is listed where no reading
changes: where fixed to false, nobody needs what it leads to; where fixed to true, nobody needs the condition. A guard
against odd input belongs to those, too: the list says where to look, and not what to delete.
"""

from __future__ import annotations

import ast
import builtins
import copyreg
import functools
import importlib.abc
import importlib.machinery
import os
import pickle
import signal
import sys
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType, ModuleType
from typing import Any

PACKAGE = "wirelessagent.language"
RECORDED = Path(__file__).parents[1] / "build" / "recorded"
_MOST_READ, _LONGEST_S = 400, 2.0
"""Lines that a condition is judged by, and how long one may take with it fixed."""


def _view(values: dict[str, Any]) -> MappingProxyType[str, Any]:
    return MappingProxyType(values)


copyreg.pickle(MappingProxyType, lambda view: (_view, (dict(view),)))

_said: dict[str, tuple[str, Any]] = {}


def pytest_load_initial_conftests() -> None:
    """Record each line that is read, with its conversation."""
    from wirelessagent.language import conversation, offline

    def listening(function: Any, *, bound: bool) -> Any:
        def listened(*args: Any, **named: Any) -> Any:
            text, context = (*args[bound:], None)[:2]
            _said.setdefault(repr((text, context)), (text, context))
            return function(*args, **named)

        return listened

    offline.OfflineRecogniser.recognise = listening(offline.OfflineRecogniser.recognise, bound=True)
    conversation.understood = listening(conversation.understood, bound=False)


def pytest_unconfigure() -> None:
    RECORDED.mkdir(parents=True, exist_ok=True)
    (RECORDED / f"{os.getpid()}.pickle").write_bytes(pickle.dumps(list(_said.values())))


@dataclass
class Conditions:
    """All conditions by number, which of them is fixed to what, and by which lines each was false or true."""

    places: list[tuple[str, int, str, str]] = field(default_factory=list[tuple[str, int, str, str]])
    fixed: int = -1
    value: bool = False
    line: int = -1
    seen: dict[tuple[int, bool], dict[int, None]] = field(default_factory=lambda: defaultdict(dict))

    def __call__(self, number: int, value: Any) -> Any:
        if self.line >= 0:
            self.seen[number, bool(value)][self.line] = None
        return self.value if number == self.fixed else value


CONDITIONS = Conditions()


class _Marked(ast.NodeTransformer):
    """A module in which each condition asks :data:`CONDITIONS` for its value."""

    def __init__(self, module: str, source: str) -> None:
        self._module, self._source = module, source

    def _mark(self, node: ast.expr, kind: str) -> ast.expr:
        said = " ".join((ast.get_source_segment(self._source, node) or "").split())
        CONDITIONS.places.append((self._module, node.lineno, kind, said[:120]))
        number = ast.Constant(len(CONDITIONS.places) - 1)
        call = ast.Call(func=ast.Name("__condition__", ast.Load()), args=[number, self.visit(node)], keywords=[])
        return ast.copy_location(call, node)

    def visit_If(self, node: ast.If) -> ast.AST:
        node.test = self._mark(node.test, "if")
        node.body, node.orelse = [self.visit(each) for each in node.body], [self.visit(each) for each in node.orelse]
        return node

    def visit_IfExp(self, node: ast.IfExp) -> ast.AST:
        node.test = self._mark(node.test, "if")
        node.body, node.orelse = self.visit(node.body), self.visit(node.orelse)
        return node

    def visit_comprehension(self, node: ast.comprehension) -> ast.AST:
        node.iter, node.ifs = self.visit(node.iter), [self._mark(each, "filter") for each in node.ifs]
        return node

    def visit_BoolOp(self, node: ast.BoolOp) -> ast.AST:
        kind = "or" if isinstance(node.op, ast.Or) else "and"
        node.values = [self._mark(each, kind) for each in node.values]
        return node


class _Loader(importlib.machinery.SourceFileLoader):
    def get_code(self, fullname: str) -> Any:
        path = self.get_filename(fullname)
        source = Path(path).read_text(encoding="utf-8")
        marked = _Marked(fullname.removeprefix(PACKAGE + ".").replace(".", "/"), source).visit(ast.parse(source))
        return compile(ast.fix_missing_locations(marked), path, "exec")


class _Finder(importlib.abc.MetaPathFinder):
    def find_spec(self, name: str, path: Any, target: ModuleType | None = None) -> Any:
        spec = importlib.machinery.PathFinder.find_spec(name, path) if name.startswith(PACKAGE + ".") else None
        if spec is not None and spec.origin is not None and not {"llm", "training"} & set(name.split(".")):
            spec.loader = _Loader(name, spec.origin)
        return spec


class _TooLongError(Exception):
    """A reading that does not end: what is fixed was needed."""


def _stop(*_: Any) -> None:
    raise _TooLongError


class Lines:
    """The recorded lines, and what is read in them."""

    def __init__(self) -> None:
        found = [line for file in RECORDED.glob("*.pickle") for line in pickle.loads(file.read_bytes())]
        lines, contexts = list({repr(line): line for line in found}.values()), Counter[str]()
        self.lines = [line for line in lines if not contexts.update([line[0]]) and contexts[line[0]] <= 2]
        from wirelessagent.language.conversation import understood
        from wirelessagent.language.offline import OfflineRecogniser

        self._read, self._recogniser = understood, OfflineRecogniser()
        signal.signal(signal.SIGALRM, _stop)

    def read(self, number: int) -> str:
        """What is understood; or that, and how, it fails."""
        text, context = self.lines[number]
        signal.setitimer(signal.ITIMER_REAL, _LONGEST_S)
        try:
            first = context is None
            return repr(self._recogniser.recognise(text) if first else self._read(text, context, self._recogniser))
        except Exception as error:  # noqa: BLE001  # whatever a reader raises that lacks a condition
            return repr(error)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)


@functools.cache
def remembered() -> list[Any]:
    """What remembers the texts of late."""
    modules = [module for name, module in sys.modules.items() if name.startswith(PACKAGE)]
    spaces = [vars(module) for module in modules]
    spaces += [vars(each) for space in spaces for each in space.values() if isinstance(each, type)]
    caches = {id(each): each for space in spaces for each in space.values() if hasattr(each, "cache_parameters")}
    return [each for each in caches.values() if each.cache_parameters()["maxsize"] is not None]


def forget() -> None:
    """Forget what was remembered of texts, which a fixed condition may have made otherwise."""
    for each in remembered():
        each.cache_clear()


def changed(lines: Lines, before: Sequence[str], number: int, *, value: bool) -> tuple[int, int]:
    """Whether any reading changes where a condition is fixed, and how many lines it would be otherwise for."""
    otherwise = list(CONDITIONS.seen[number, not value])
    forget()
    CONDITIONS.fixed, CONDITIONS.value = number, value
    try:
        some = otherwise[:: len(otherwise) // _MOST_READ + 1]
        return any(lines.read(line) != before[line] for line in some), len(otherwise)
    finally:
        CONDITIONS.fixed = -1
        forget()


def main() -> None:
    builtins.__condition__ = CONDITIONS  # type: ignore[attr-defined]
    sys.meta_path.insert(0, _Finder())
    lines = Lines()
    for number in range(len(lines.lines)):  # once for what is only read once, such as the tables of words
        lines.read(number)
    before = list[str]()
    for CONDITIONS.line in range(len(lines.lines)):
        forget()
        before.append(lines.read(CONDITIONS.line))
    CONDITIONS.line = -1
    print(f"{len(lines.lines)} lines, {len(CONDITIONS.places)} conditions")
    for number, (module, line, kind, said) in enumerate(CONDITIONS.places):
        if len(sys.argv) > 1 and module not in sys.argv[1:]:
            continue
        for value in [kind == "and"] if kind in ("and", "or") else [False, True]:
            differs, otherwise = changed(lines, before, number, value=value)
            if not differs:
                print(f"{module}:{line}: {kind} {said!r} may be {value} (otherwise in {otherwise} lines)", flush=True)


if __name__ == "__main__":
    main()
