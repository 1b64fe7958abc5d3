"""The plug-in door: strangers' packages come in by it, and none of them can take the rest down."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wirelessagent as wa
from wirelessagent import plugins
from wirelessagent.interfaces.cli import run
from wirelessagent.model.errors import InputError, PluginError, UnknownNameError

ALPHA = """
from __future__ import annotations
from dataclasses import dataclass
from pathlib import Path
from typing import Literal
import wirelessagent as wa

@dataclass(frozen=True, kw_only=True)
class Alpha(wa.Objective):
    '''Shares alpha-fairly.

    And more about it.

    Attributes:
        alpha: how fair, e.g. 1 for
            proportional fairness. Not in [0, 1).
        rounds (int): how often ``it`` is tried
        unknown: no field of it.

    Raises:
        strict: what is said elsewhere is no help.
    '''
    name = "alpha"
    aliases = ("A1",)
    alpha: float = 2.0
    rounds: int = 3
    strict: bool = False
    label: str | None = None
    mode: Literal["soft", "hard"] = "soft"
    pace: Literal[1, 2] = 1
    shade: Literal["Dark", "dim"] | None = None
    table: Path = Path("table.csv")
    levels: tuple[float, ...] = ()
    share: float | tuple[float, ...] = 1.0
    stage: int | tuple[int, ...] | None = None

    def utility(self, rate):
        return 0.0 * rate

    def conjugate(self, price, min_rate, max_rate):
        return 0.0 * price, min_rate
"""


class Site:
    """A folder on the path where packages are installed."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def install(self, package: str, module: str, source: str, entries: dict[str, str], kind: str = "objective") -> None:
        """A distribution of one module that registers ``entries``, as an installer would leave it."""
        (self.folder / f"{module}.py").write_text(source)
        info = self.folder / f"{package.replace('-', '_')}-1.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n")
        lines = [f"[wirelessagent.{kind}]", *(f"{name} = {target}" for name, target in entries.items())]
        (info / "entry_points.txt").write_text("\n".join(lines))
        plugins.refresh()


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Site]:
    monkeypatch.syspath_prepend(str(tmp_path))
    before = set(sys.modules)
    yield Site(tmp_path)
    for name in set(sys.modules) - before:
        if (tmp_path / f"{name}.py").exists():
            del sys.modules[name]
    plugins.refresh()


@pytest.fixture(autouse=True)
def _forget_afterwards() -> Iterator[None]:
    yield
    plugins.refresh()


BUILT_IN = {
    "channel_source": {"rayleigh", "cqi", "file"},
    "repairer": {"user_mean", "nncf", "nncf_paper", "linear", "kriging", "learned_covariance", "predictor"},
    "objective": {"max_rate", "min_power", "max_energy_efficiency", "proportional_fairness", "max_min_rate"},
    "method": {"dual", "greedy", "paper", "equal_power", "round_robin"},
    "base_station": {"simulated", "file"},
}


def test_there_are_five_kinds() -> None:
    assert set(plugins.KINDS) == set(BUILT_IN)


@pytest.mark.parametrize("kind", BUILT_IN)
def test_built_in_plugins_enter_by_entry_points_and_load(kind: Any) -> None:
    found = {item.name: item for item in plugins.plugins(kind)}
    assert found.keys() >= BUILT_IN[kind]
    assert {name: item.error for name, item in found.items() if item.cls is None} == {}
    for name in BUILT_IN[kind]:
        assert found[name].package == "wirelessagent"
        assert found[name].target.startswith("wirelessagent.")
        assert found[name].summary


def test_a_strangers_plugin_is_listed_and_made(site: Site) -> None:
    site.install("fair-play", "fair_play", ALPHA, {"alpha": "fair_play:Alpha"})
    assert "alpha" in plugins.names("objective")
    found = plugins.plugin("objective", "alpha")
    assert (found.package, found.target, found.summary) == ("fair-play", "fair_play:Alpha", "Shares alpha-fairly.")
    assert plugins.create("objective", "alpha", {"alpha": 3}) == found.cls(alpha=3.0)
    assert plugins.objective("A1") == found.cls()


def test_two_plugins_of_one_name_are_an_error_that_names_both_packages(site: Site) -> None:
    site.install("fair-play", "fair_play", ALPHA, {"alpha": "fair_play:Alpha"})
    site.install("foul-play", "foul_play", ALPHA, {"alpha": "foul_play:Alpha"})
    with pytest.raises(PluginError, match=r"'alpha'.*fair-play.*foul-play|'alpha'.*foul-play.*fair-play"):
        plugins.plugin("objective", "alpha")
    listed = {item.name: item for item in plugins.plugins("objective")}
    assert listed["alpha"].cls is None
    assert "fair-play" in listed["alpha"].error
    assert "foul-play" in listed["alpha"].error
    assert listed["max_rate"].cls is not None


def test_a_name_of_ours_cannot_be_taken_over(site: Site) -> None:
    site.install("hijack", "hijack", ALPHA.replace('"alpha"', '"max_rate"'), {"max_rate": "hijack:Alpha"})
    with pytest.raises(PluginError, match=r"wirelessagent.*hijack|hijack.*wirelessagent"):
        plugins.objective("max_rate")


def test_two_objectives_of_one_alias_are_an_error_that_names_both_packages(site: Site) -> None:
    site.install("fair-play", "fair_play", ALPHA, {"alpha": "fair_play:Alpha"})
    site.install("foul-play", "foul_play", ALPHA.replace('"alpha"', '"beta"'), {"beta": "foul_play:Alpha"})
    with pytest.raises(PluginError, match=r"'A1'.*fair-play.*foul-play"):
        plugins.objective("A1")


@pytest.mark.parametrize(
    ("source", "reason"),
    [
        ("import a_package_that_does_not_exist", "ModuleNotFoundError"),
        ("1 / 0", "ZeroDivisionError"),
        ("raise SystemExit(3)", "SystemExit"),
        ("def Alpha(", "SyntaxError"),
        ("Other = None", "AttributeError"),
        ("class Alpha: name = 'alpha'", "not a subclass of Objective"),
        ("Alpha = 3", "not a subclass of Objective"),
        (ALPHA.replace('"alpha"', '"omega"'), "called 'alpha' but Alpha.name is 'omega'"),
        (ALPHA.replace("@dataclass(frozen=True, kw_only=True)", ""), "not a dataclass"),
        (ALPHA.replace("rounds: int", "rounds: Whatever"), "NameError"),
    ],
)
def test_a_plugin_that_fails_is_named_with_its_package_and_the_rest_go_on(site: Site, source: str, reason: str) -> None:
    site.install("foul-play", "foul_play", source, {"alpha": "foul_play:Alpha"})
    listed = {item.name: item for item in plugins.plugins("objective")}
    assert listed["alpha"].cls is None
    assert listed["alpha"].options == ()
    assert "'alpha' of foul-play" in listed["alpha"].error
    assert reason in listed["alpha"].error
    assert listed["alpha"].summary == listed["alpha"].error
    assert listed["max_rate"].cls is not None
    with pytest.raises(PluginError, match=r"foul-play"):
        plugins.create("objective", "alpha")


def test_an_unknown_name_gets_a_hint() -> None:
    with pytest.raises(UnknownNameError, match=r"unknown objective 'max_rat': did you mean 'max_rate'\?"):
        plugins.plugin("objective", "max_rat")


@pytest.fixture
def alpha(site: Site) -> Any:
    site.install("fair-play", "fair_play", ALPHA, {"alpha": "fair_play:Alpha"})
    return lambda **options: plugins.create("objective", "alpha", options)


def test_fields_that_hold_a_simple_value_are_options(alpha: Any) -> None:
    found = {option.name: (option.type, option.default) for option in plugins.plugin("objective", "alpha").options}
    assert found == {
        "alpha": (float, 2.0),
        "rounds": (int, 3),
        "strict": (bool, False),
        "label": (str, None),
        "mode": (str, "soft"),
        "pace": (int, 1),
        "shade": (str, None),
        "table": (Path, Path("table.csv")),
        "share": (float, 1.0),
        "stage": (int, None),
    }
    several = [option.name for option in plugins.plugin("objective", "alpha").options if option.several]
    assert several == ["share", "stage"]


def test_options_are_explained_by_the_docstring_and_list_their_choices(alpha: Any) -> None:
    found = {option.name: option for option in plugins.plugin("objective", "alpha").options}
    assert {name: option.help for name, option in found.items() if option.help} == {
        "alpha": "how fair, e.g. 1 for proportional fairness",
        "rounds": "how often it is tried",
    }
    assert {name: option.choices for name, option in found.items() if option.choices} == {
        "mode": ("soft", "hard"),
        "pace": (1, 2),
        "shade": ("Dark", "dim"),
    }


def test_the_docstring_of_a_base_explains_what_is_inherited(site: Site) -> None:
    source = f"{ALPHA}\n@dataclass(frozen=True, kw_only=True)\nclass Beta(Alpha):\n    name = 'beta'\n"
    site.install("fair-play", "fair_play", source, {"beta": "fair_play:Beta"})
    assert plugins.plugin("objective", "beta").options[1].help == "how often it is tried"


@pytest.mark.parametrize("kind", plugins.KINDS)
def test_every_option_of_a_built_in_plugin_is_explained(kind: Any) -> None:
    found = [(item.name, option) for item in plugins.plugins(kind) for option in item.options]
    assert [(name, option.name) for name, option in found if not option.help] == []


def test_help_shows_what_an_option_is_whose_and_its_choices(site: Site, capsys: pytest.CaptureFixture[str]) -> None:
    code = ALPHA.replace("Objective", "Repairer").replace("def utility(self", "def repair(self, observation")
    site.install("paper-play", "paper_play", code, {"alpha": "paper_play:Alpha"}, "repairer")
    assert run(["repair", "--help-all"]) == 0
    shown = " ".join(capsys.readouterr().out.replace("│", " ").split())
    assert "how fair, e.g. 1 for proportional fairness [of alpha; default 2.0]" in shown
    assert "[of nncf_paper; default 2.0]" in shown
    assert re.search(r"--shade <Dark\|dim> \[of alpha\]", shown)
    assert re.search(r"--unit <linear\|db\|complex> ", shown)


def test_the_listing_has_help_and_choices(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["plugins", "--kind", "channel_source", "--json"]) == 0
    file = next(item for item in json.loads(capsys.readouterr().out)["plugins"] if item["name"] == "file")
    unit = next(option for option in file["options"] if option["name"] == "unit")
    assert unit["choices"] == ["linear", "db", "complex"]
    assert unit["help"].startswith("what its numbers are")


@pytest.mark.parametrize(
    ("name", "given", "taken"),
    [
        ("alpha", "1.5", 1.5),
        ("mode", " HARD", "hard"),
        ("shade", "dark", "Dark"),
        ("shade", None, None),
        ("pace", "2", 2),
        ("pace", np.int64(2), 2),
        ("alpha", 1, 1.0),
        ("alpha", np.float32(0.5), 0.5),
        ("rounds", "7", 7),
        ("rounds", 7.0, 7),
        ("rounds", np.int64(7), 7),
        ("strict", "yes", True),
        ("strict", "False", False),
        ("label", "night", "night"),
        ("label", None, None),
        ("table", "a/b.csv", Path("a/b.csv")),
        ("share", "2", 2.0),
        ("share", "2, 3e6", (2.0, 3e6)),
        ("share", [1, 2], (1.0, 2.0)),
        ("share", np.array([1.0]), (1.0,)),
        ("stage", (1, 2), (1, 2)),
        ("stage", None, None),
    ],
)
def test_options_are_converted(alpha: Any, name: str, given: object, taken: object) -> None:
    value = getattr(alpha(**{name: given}), name)
    assert value == taken
    assert type(value) is type(taken) or isinstance(taken, Path)


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("alpha", "a lot"),
        ("alpha", True),
        ("alpha", [1.0]),
        ("rounds", "2.5"),
        ("rounds", 2.5),
        ("rounds", np.float32(2.5)),
        ("rounds", float("inf")),
        ("rounds", True),
        ("strict", "perhaps"),
        ("strict", 1),
        ("table", 3),
        ("share", "a lot"),
        ("stage", 2.5),
    ],
)
def test_options_of_another_type_are_refused_with_what_was_received(alpha: Any, name: str, given: object) -> None:
    with pytest.raises(InputError, match=rf"{name} must be of type \w+; got ") as caught:
        alpha(**{name: given})
    assert repr(given) in str(caught.value)


def test_one_of_several_values_of_another_type_is_named(alpha: Any) -> None:
    with pytest.raises(InputError, match="share must be of type float; got 'b'"):
        alpha(share="1, b")


@pytest.mark.parametrize(
    ("name", "given"), [("mode", "loud"), ("mode", 1), ("mode", ["soft"]), ("pace", True), ("pace", 3)]
)
def test_a_value_that_is_no_choice_is_refused_with_the_choices(alpha: Any, name: str, given: object) -> None:
    with pytest.raises(InputError, match=rf"{name} must be one of (soft, hard|1, 2); got ") as caught:
        alpha(**{name: given})
    assert repr(given) in str(caught.value)


def test_an_abstract_plugin_is_listed_with_what_it_lacks(site: Site) -> None:
    code = ALPHA.replace("def conjugate", "def conjugated")
    site.install("half-play", "half_play", code, {"alpha": "half_play:Alpha"})
    found = plugins.plugin("objective", "alpha")
    assert found.cls is None
    for part in ("'alpha' of half-play", "Alpha is abstract: it must define conjugate"):
        assert part in found.error
    with pytest.raises(PluginError, match="must define conjugate"):
        plugins.create("objective", "alpha")


def test_an_option_that_it_does_not_have_is_refused_with_a_hint(alpha: Any) -> None:
    with pytest.raises(UnknownNameError, match=r"option 'alfa' of the objective 'alpha': did you mean 'alpha'\?"):
        alpha(alfa=2)


def test_an_option_without_a_default_must_be_given(site: Site) -> None:
    site.install(
        "fair-play", "fair_play", ALPHA.replace("alpha: float = 2.0", "alpha: float"), {"alpha": "fair_play:Alpha"}
    )
    with pytest.raises(InputError, match=r"the objective 'alpha' needs alpha"):
        plugins.create("objective", "alpha")


def modules_after(code: str) -> set[str]:
    """The top-level modules loaded in a new process after ``code``."""
    script = f"{code}\nimport sys\nprint(*sorted({{name.partition('.')[0] for name in sys.modules}}))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=True)
    return set(done.stdout.splitlines()[-1].split())


def test_importing_the_package_loads_nothing_heavy() -> None:
    heavy = {"numpy", "scipy", "numba", "h5py", "pydantic", "click", "rich", "matplotlib", "platformdirs"}
    assert modules_after("import wirelessagent") & heavy == set()


def test_listing_every_plugin_with_its_options_compiles_nothing() -> None:
    listing = (
        "from wirelessagent import plugins\n"
        "found = [item for kind in plugins.KINDS for item in plugins.plugins(kind)]\n"
        "assert all(item.cls for item in found), found\n"
        "assert any(item.options for item in found)"
    )
    assert modules_after(listing) & {"numba", "llvmlite", "scipy", "h5py", "matplotlib"} == set()


def test_every_public_name_is_listed_and_resolves() -> None:
    assert wa.__all__ == list(wa._HOMES)
    assert sorted(wa.__all__) == wa.__all__
    for name in wa.__all__:
        assert getattr(wa, name) is not None
    assert dir(wa) == sorted([*wa.__all__, "__version__"])


def test_an_objective_is_checked_by_name_without_being_loaded() -> None:
    script = (
        "import wirelessagent as wa, sys\n"
        "wa.Problem('max_rate', max_power_w=10)\n"
        "print([name for name in sys.modules if name.startswith('wirelessagent.deciding')])"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.strip() == "[]"


def test_an_objective_may_go_by_its_alias() -> None:
    assert wa.Problem("P1").objective == "P1"
    with pytest.raises(UnknownNameError, match="unknown objective 'P9'"):
        wa.Problem("P9")


ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize(
    "path",
    [ROOT / "docs" / "plugins.md", *(ROOT / "examples" / "third_party_objective").rglob("*.py")],
    ids=lambda path: path.name,
)
def test_who_writes_a_plugin_imports_from_one_public_place(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert "import wirelessagent as wa\n" in text
    assert re.findall(r"(?:from|import) wirelessagent\.[\w.]+", text) == []


def test_type_checkers_see_the_names_that_resolve() -> None:
    tree = ast.parse(Path(wa.__file__).read_text(encoding="utf-8"))
    guarded = next(node for node in tree.body if isinstance(node, ast.If))
    seen = {
        alias.name: node.module for node in guarded.body if isinstance(node, ast.ImportFrom) for alias in node.names
    }
    homes = {name: f"wirelessagent.{home}" if home else "wirelessagent" for name, home in wa._HOMES.items()}
    assert seen == homes


def test_a_name_that_does_not_exist_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'Sell'"):
        wa.__getattr__("Sell")
