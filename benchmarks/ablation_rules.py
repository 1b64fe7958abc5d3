"""What each function and condition of the reader is worth: sentences read otherwise where it is switched off.

Run with ``python benchmarks/ablation_rules.py FILE.jsonl… [--module NAME] [--conditions]`` (files as ``bars_frames.py``
reads them; of sentences that nobody read, or it tells what is pinned). Functions of ``wirelessagent.language`` are
switched off one by one as they are imported: each gives back its argument, None, False or nothing, whichever harms
least. The test of an ``if`` is fixed to false and to true. Only sentences that reach it are read again, and none once
it has plainly earned its place. What is worth nothing is a candidate to go, and no more: a guard against odd input is
among them; try whether what it guards against is then asked about.
"""

from __future__ import annotations

import argparse
import ast
import functools
import gc
import importlib.machinery
import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

PACKAGE = "wirelessagent.language"
LEFT_OUT = (f"{PACKAGE}.training", f"{PACKAGE}.llm")
ENOUGH = 12
"""Of how many sentences that become worse on a function has plainly earned its place."""
VALUES = {"its argument": None, "None": None, "False": False, "nothing": (), "True": True}
FUNCTION, CONDITION = ("its argument", "None", "False", "nothing"), ("False", "True")
rules: list[tuple[str, str, int]] = []
off: list[tuple[int, str]] = []
reached: set[int] = set()


def is_off(number: int) -> bool:
    reached.add(number)
    return bool(off) and off[0][0] == number


def instead(argument: Any) -> Any:
    return argument if off[0][1] == "its argument" else VALUES[off[0][1]]


def test(number: int, value: Any) -> Any:
    return VALUES[off[0][1]] if is_off(number) else value


class _Switched(importlib.machinery.SourceFileLoader):
    """A module whose functions and conditions can be switched off."""

    def get_code(self, fullname: str) -> CodeType:
        path = self.get_filename(fullname)
        tree = ast.parse(Path(path).read_text(encoding="utf-8"))
        for function in [each for each in ast.walk(tree) if isinstance(each, ast.FunctionDef)]:
            for node in [each for each in ast.walk(function) if isinstance(each, ast.If)]:
                if not (isinstance(node.test, ast.Call) and ast.unparse(node.test.func) == "ablation_test"):
                    name, number = ast.Name("ablation_test", ast.Load()), ast.Constant(len(rules))
                    rules.append((Path(path).stem, f"if {ast.unparse(node.test)}"[:44], node.lineno))
                    node.test = ast.copy_location(ast.Call(name, [number, node.test], []), node.test)
        for node in [each for each in ast.walk(tree) if isinstance(each, ast.FunctionDef)]:
            generates = any(isinstance(each, ast.Yield | ast.YieldFrom) for each in ast.walk(node))
            if generates or node.name.startswith("__"):
                continue
            names = [each.arg for each in (*node.args.posonlyargs, *node.args.args) if each.arg not in ("self", "cls")]
            switch = f"if ablation_is_off({len(rules)}): return ablation_instead({(*names, 'None')[0]})"
            rules.append((Path(path).stem, node.name, node.lineno))
            node.body[:0] = [ast.copy_location(each, node.body[0]) for each in ast.parse(switch).body]
        return compile(ast.fix_missing_locations(tree), path, "exec", dont_inherit=True)

    def exec_module(self, module: ModuleType) -> None:
        vars(module).update(ablation_is_off=is_off, ablation_instead=instead, ablation_test=test)
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
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--module", default="", help="only modules whose name holds this")
    parser.add_argument("--conditions", action="store_true", help="conditions instead of functions")
    given = parser.parse_args()
    sys.meta_path.insert(0, _Finder)
    from bars_frames import FIRST, RECOGNISER, read, verdict

    from wirelessagent.language.conversation import understood

    rows = [row for file in given.files for row in read(file)]

    def said(row: dict[str, Any]) -> str:
        for cache in caches:
            cache.cache_clear()
        try:
            return verdict(row, understood(row["text"], FIRST, RECOGNISER))
        except Exception as error:  # noqa: BLE001  # a function that something rests on
            return type(error).__name__

    caches: list[Any] = []
    for row in rows[:200]:
        said(row)
    found = [each for each in gc.get_objects() if isinstance(each, functools._lru_cache_wrapper)]  # type: ignore[attr-defined]
    caches += [each for each in found if str(each.__module__).startswith(PACKAGE) and each.cache_info().currsize > 40]
    base, reach = list[str](), dict[int, list[int]]()
    for place, row in enumerate(rows):
        reached.clear()
        base.append(said(row))
        for number in reached:
            reach.setdefault(number, []).append(place)
    print(f"{'function or condition':64}{'reached':>9}{'worse':>7}{'better':>8}  gives back")
    for number, (module, name, line) in enumerate(rules):
        is_asked_for = given.module in module and name.startswith("if ") == given.conditions
        if not is_asked_for or number not in reach:
            continue
        best: tuple[Counter[str], str] | None = None
        for value in CONDITION if given.conditions else FUNCTION:
            off[:] = [(number, value)]
            changes = Counter[str]()
            for place in reach[number]:
                now = said(rows[place])
                changes["worse"] += now != base[place] and base[place] == "right"
                changes["better"] += now != base[place] and now == "right"
                if changes["worse"] > ENOUGH:
                    break
            best = min(best or (changes, value), (changes, value), key=lambda each: each[0]["worse"])
        off.clear()
        if best is not None and best[0]["worse"] <= ENOUGH:
            print(f"{module}:{line} {name}".ljust(64) + f"{len(reach[number]):9}{best[0]['worse']:7}"
                  f"{best[0]['better']:8}  {best[1]}", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
