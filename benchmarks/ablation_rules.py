"""What each function and condition of the reader is worth: sentences read otherwise where it is switched off.

Run with ``python benchmarks/ablation_rules.py FILE.jsonl… [--module NAME] [--talks COUNT]`` (files as ``bars_frames``
reads them, of sentences that nobody read, or it tells what is pinned; so many lines of the training talks beside).
Functions of ``wirelessagent.language`` give back their argument, None, False or nothing; the test of an ``if``, a
filter and each operand of "and" and "or" is fixed. Only sentences in which a switch had another value are read again,
few at first, and none once it has plainly earned its place: a rule that seldom speaks costs next to nothing. What is
worth nothing is a candidate to go, and no more: a guard against odd input is among them, and a procedure that gives
back nothing anyway seems to do nothing.
"""

from __future__ import annotations

import argparse
import ast
import functools
import gc
import importlib.machinery
import random
import sys
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any, NamedTuple

PACKAGE = "wirelessagent.language"
LEFT_OUT = (f"{PACKAGE}.training", f"{PACKAGE}.llm")
ENOUGH, MOST = 3, 250
"""Of how many sentences that become worse on a switch has earned its place; in how many it may speak to be tried."""
FUNCTION = {"its argument": ..., "None": None, "False": False, "nothing": (), "True": True}


class Rule(NamedTuple):
    """A switch: where it stands, what it is, and the values that it may be fixed to."""

    module: str
    line: int
    code: str
    values: tuple[str, ...]


rules: list[Rule] = []
off: list[tuple[int, str]] = []
differs: set[tuple[int, str]] = set()
"""Switches with each value that they did not have, in the sentence that is being read."""


def switched(number: int, after_self: bool) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """A function that notes what it gives back, or gives back what it is fixed to."""

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(function)
        def instead(*given: Any, **named: Any) -> Any:
            argument = next(iter((*given[after_self:], *named.values())), None)
            if off and off[0][0] == number:
                return argument if off[0][1] == "its argument" else FUNCTION[off[0][1]]
            found = function(*given, **named)
            if not off:
                generates = hasattr(found, "__next__")
                found = [*found] if generates else found
                none = isinstance(found, list | tuple | dict | str) and not found
                same = {"its argument": found is argument, "nothing": none, "None": found is None,
                        "False": found is False, "True": found is True}  # fmt: skip
                differs.update((number, value) for value, is_so in same.items() if not is_so)
                found = iter(found) if generates else found
            return found

        return instead

    return decorate


def fixed(number: int, value: Any) -> Any:
    """What an operand or a test is, or what it is fixed to."""
    if off:
        return off[0][1] == "True" if off[0][0] == number else value
    differs.add((number, "False" if value else "True"))
    return value


class _Switches(ast.NodeTransformer):
    def __init__(self, module: str) -> None:
        self._module, self._in_class = module, False

    def _rule(self, node: ast.expr | ast.FunctionDef, code: str, values: tuple[str, ...]) -> ast.Constant:
        rules.append(Rule(self._module, node.lineno, code[:60], values))
        return ast.Constant(len(rules) - 1)

    def _fixed(self, node: ast.expr, kind: str, *values: str) -> ast.expr:
        code, inner = f"{kind} {ast.unparse(node)}", self.visit(node)
        call = ast.Call(ast.Name("ablation_fixed", ast.Load()), [self._rule(node, code, values), inner], [])
        return ast.copy_location(call, node)

    def visit_BoolOp(self, node: ast.BoolOp) -> ast.BoolOp:
        kind, value = ("and", "True") if isinstance(node.op, ast.And) else ("or", "False")
        node.values = [self._fixed(each, kind, value) for each in node.values]
        return node

    def visit_If(self, node: ast.If) -> ast.If:
        node.test = self._fixed(node.test, "if", "False", "True")
        node.body, node.orelse = ([self.visit(each) for each in part] for part in (node.body, node.orelse))
        return node

    def visit_comprehension(self, node: ast.comprehension) -> ast.comprehension:
        node.iter, node.ifs = self.visit(node.iter), [self._fixed(each, "filter", "True", "False") for each in node.ifs]
        return node

    def visit_ClassDef(self, node: ast.ClassDef) -> ast.ClassDef:
        for each in node.body:
            self._in_class = True
            self.visit(each)
        self._in_class = False
        return node

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.FunctionDef:
        of_class, self._in_class = self._in_class, False
        self.generic_visit(node)
        if not node.name.startswith("__"):
            number = self._rule(node, f"def {node.name}", tuple(FUNCTION))
            name = ast.Name("ablation_switched", ast.Load())
            node.decorator_list.append(ast.copy_location(ast.Call(name, [number, ast.Constant(of_class)], []), node))
        return node


class _Switched(importlib.machinery.SourceFileLoader):
    """A module whose functions and conditions can be switched off."""

    def get_code(self, fullname: str) -> CodeType:
        path = self.get_filename(fullname)
        tree = _Switches(fullname.removeprefix(f"{PACKAGE}.")).visit(ast.parse(Path(path).read_text(encoding="utf-8")))
        return compile(ast.fix_missing_locations(tree), path, "exec", dont_inherit=True)

    def exec_module(self, module: ModuleType) -> None:
        vars(module).update(ablation_fixed=fixed, ablation_switched=switched)
        super().exec_module(module)


class _Finder(importlib.machinery.PathFinder):
    @classmethod
    def find_spec(cls, fullname: str, path: Sequence[str] | None = None, target: Any = None) -> Any:
        if not fullname.startswith(PACKAGE) or fullname.startswith(LEFT_OUT):
            return None
        spec = super().find_spec(fullname, path, target)
        if spec is not None and str(spec.origin).endswith(".py"):
            spec.loader = _Switched(fullname, str(spec.origin))
        return spec


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--module", default="", help="only modules whose name holds this")
    parser.add_argument("--talks", type=int, default=0, help="so many lines of the training talks, too")
    given = parser.parse_args()
    sys.meta_path.insert(0, _Finder)
    from bars_frames import FIRST, RECOGNISER, read, verdict

    from wirelessagent.language.conversation import understood
    from wirelessagent.language.training.talk_notation import examples

    said: list[tuple[str, Any, dict[str, Any] | None]] = [
        (row["text"], FIRST, row) for file in given.files for row in read(file)
    ]
    talks = list(examples()) if given.talks else []
    said += [(each.text, each.context, None) for each in random.Random(1).sample(talks, min(given.talks, len(talks)))]

    def meant(text: str, context: Any, row: dict[str, Any] | None) -> tuple[str, bool]:
        """What a sentence comes to, and whether that is right; of a line of a talk whatever it came to is."""
        for cache in caches:
            cache.cache_clear()
        try:
            intent = understood(text, context, RECOGNISER)
        except Exception as error:  # noqa: BLE001  # a function that something rests on
            return type(error).__name__, False
        came_to = f"{intent.kind} {intent.objective} {dict(intent.constraints)} {intent.acts} {intent.topic}"
        return came_to, row is None or verdict(row, intent) == "right"

    caches: list[Any] = []
    for each in said[:200]:
        meant(*each)
    found = [each for each in gc.get_objects() if isinstance(each, functools._lru_cache_wrapper)]  # type: ignore[attr-defined]
    caches += [each for each in found if str(each.__module__).startswith(PACKAGE) and each.cache_info().currsize > 40]
    base, speaks = list[tuple[str, bool]](), dict[tuple[int, str], list[int]]()
    for place, each in enumerate(said):
        differs.clear()
        base.append(meant(*each))
        for switch in differs:
            speaks.setdefault(switch, []).append(place)

    def worth(number: int, value: str) -> Counter[str]:
        off[:], changes = [(number, value)], Counter[str]()
        for place in speaks.get((number, value), ()):
            (was, right), (now, still) = base[place], meant(*said[place])
            changes["worse"] += was != now and right and (not still or said[place][2] is None)
            changes["better"] += was != now and still and not right
            if changes["worse"] > ENOUGH:
                break
        off.clear()
        return changes

    reached = {number for number, _ in speaks}
    print(f"{'where':26}{'speaks':>8}{'worse':>7}{'better':>8}  what, and fixed to what")
    for number, rule in enumerate(rules):
        seldom = [value for value in rule.values if len(speaks.get((number, value), ())) <= MOST]
        if number in reached and given.module in rule.module and seldom:
            least = min(((worth(number, value), value) for value in seldom), key=lambda each: each[0]["worse"])
            if least[0]["worse"] <= ENOUGH:
                where, times = f"{rule.module}:{rule.line}", len(speaks.get((number, least[1]), ()))
                print(f"{where:26}{times:8}{least[0]['worse']:7}{least[0]['better']:8}  {rule.code} -> {least[1]}")
    for number, rule in enumerate(rules):
        if number not in reached and given.module in rule.module:
            print(f"{rule.module}:{rule.line}".ljust(26) + f"never reached behind the import: {rule.code}")


if __name__ == "__main__":
    main()
