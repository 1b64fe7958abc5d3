"""The files of the console: texts in the catalogue, nothing inline, nothing from elsewhere, no import in the air."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from wirelessagent.language.conversation import understood
from wirelessagent.language.offline import OfflineRecogniser
from wirelessagent.language.recogniser import Context
from wirelessagent.telling.catalogue import languages, message, messages

CONSOLE = Path(__file__).parents[2] / "src" / "wirelessagent" / "interfaces" / "console"
PAGES = sorted(CONSOLE.glob("*.html"))
SCRIPTS = sorted(CONSOLE.glob("*.js"))
MODULES = [script for script in SCRIPTS if script.name != "theme.js"]
_SAID = re.compile(r"""(?:say|has)\("([\w.]+)"|"((?:console|limit)\.(?!css\b)\w+)"|data-say(?:-\w+)?="([\w.]+)\"""")
_IMPORTED = re.compile(r'^import \{ ([^}]*) \} from "\./([\w-]+\.js)";$', re.MULTILINE)
_OUTER = re.compile(r"//(?!www\.w3\.org/2000/svg\b)[\w-]+\.\w+")


class _Page(HTMLParser):
    """What a page holds: tags with their attributes, and the text within scripts and styles."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.inline: list[str] = []
        self._within = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self._within = tag

    def handle_endtag(self, tag: str) -> None:
        self._within = ""

    def handle_data(self, data: str) -> None:
        if self._within in ("script", "style") and data.strip():
            self.inline.append(data)


@pytest.mark.parametrize("file", [*PAGES, *SCRIPTS], ids=lambda file: file.name)
def test_every_text_is_in_the_catalogue(file: Path) -> None:
    said = {key for found in _SAID.findall(file.read_text(encoding="utf-8")) for key in found if key}
    assert said - set(messages("en")) == set()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_a_page_holds_nothing_that_a_strict_policy_refuses(page: Path) -> None:
    held = _Page(page.read_text(encoding="utf-8"))
    assert held.inline == []
    for _, attributes in held.tags:
        assert not [name for name in attributes if name == "style" or name.startswith("on")]
    linked = [value for _, attributes in held.tags for name, value in attributes.items() if name in ("src", "href")]
    files = [value for value in linked if value and not value.startswith("#")]
    assert {value for value in files if not (CONSOLE / value).is_file()} == set()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_ids_are_there_once_and_those_referred_to_are_there(page: Path) -> None:
    tags = _Page(page.read_text(encoding="utf-8")).tags
    ids = [attributes["id"] for _, attributes in tags if "id" in attributes]
    assert len(ids) == len(set(ids))
    assert {one["aria-labelledby"] for _, one in tags if "aria-labelledby" in one} <= set(ids)


def test_what_scripts_look_up_is_on_a_page() -> None:
    ids = {one["id"] for page in PAGES for _, one in _Page(page.read_text(encoding="utf-8")).tags if "id" in one}
    asked = {name for script in SCRIPTS for name in re.findall(r'byId\("([\w-]+)"\)', script.read_text("utf-8"))}
    assert asked - ids == set()


@pytest.mark.parametrize("file", sorted(CONSOLE.iterdir()), ids=lambda file: file.name)
def test_nothing_comes_from_elsewhere(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    assert _OUTER.findall(text) == []
    assert not re.search(r"""(?:src|href|url\(|from |get\(|post\()\s*=?\s*["'`(]/""", text), "a path from the root"
    if file.suffix == ".js":
        assert not re.search(r"innerHTML|outerHTML|insertAdjacentHTML|\beval\b|new Function|document\.write", text)


@pytest.mark.parametrize("module", MODULES, ids=lambda module: module.name)
def test_what_a_module_imports_is_exported_and_used(module: Path) -> None:
    text = module.read_text(encoding="utf-8")
    imports = _IMPORTED.findall(text)
    assert len(imports) == len(re.findall(r"^import ", text, re.MULTILINE))
    for names, source in imports:
        offered = (CONSOLE / source).read_text(encoding="utf-8")
        for name in names.split(", "):
            assert re.search(rf"^export (?:async )?(?:function|const|class) {name}\b", offered, re.MULTILINE), name
            assert len(re.findall(rf"\b{name}\b", text)) > 1, f"{name} is imported and not used"


def test_every_module_is_reached_from_a_page() -> None:
    reached: set[str] = set()
    waiting = [str(one["src"]) for page in PAGES for tag, one in _Page(page.read_text("utf-8")).tags if tag == "script"]
    while waiting:
        name = waiting.pop()
        if name not in reached:
            reached.add(name)
            waiting += [source for _, source in _IMPORTED.findall((CONSOLE / name).read_text(encoding="utf-8"))]
    assert reached == {script.name for script in SCRIPTS}


_SUGGESTED = [key for key in messages("en") if key.startswith("console.say_") and key != "console.say_what"]


@pytest.mark.parametrize("language", sorted(languages()))
@pytest.mark.parametrize("key", _SUGGESTED)
def test_what_the_console_offers_to_say_is_understood(language: str, key: str) -> None:
    held = Context(objective="max_rate", user_names=tuple(f"user {number}" for number in range(1, 9)))
    said = message(language, key, number=3, power="10 W")
    assert understood(said, held, OfflineRecogniser()).kind not in ("clarify", "out_of_scope")
