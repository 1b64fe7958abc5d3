"""The console in a real browser: what an operator does with it, on a server as it is started."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page, sync_playwright
from servers import Server, Signed, started

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")

pytestmark = [
    pytest.mark.machine_code,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium to look at the console with"),
]

WIDE, NARROW = {"width": 1440, "height": 900}, {"width": 390, "height": 844}


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


class Seen:
    """A page, and what went wrong on it or left the machine."""

    def __init__(self, browser: Browser, url: str, *, cell: str = "", **look: object) -> None:
        context = browser.new_context(**{"viewport": WIDE, "locale": "en-GB", **look})  # type: ignore[arg-type]
        if cell:
            context.add_init_script(f"localStorage.setItem('wirelessagent.cell', '{cell}')")
        self.page: Page = context.new_page()
        self.faults, self.outside, self.url = list[str](), list[str](), url
        self.page.on("pageerror", lambda error: self.faults.append(str(error)))
        self.page.on("console", lambda said: self.faults.append(said.text) if said.type == "error" else None)
        self.page.on("request", lambda asked: self.outside.append(asked.url) if not asked.url.startswith(url) else None)

    def opened(self) -> Page:
        self.page.goto(self.url)
        self.page.wait_for_selector("#page:not(.loading)")
        return self.page

    def say(self, line: str) -> str:
        """Say a line, and what became of it."""
        turns = self.page.locator("article.turn").count()
        self.page.fill("#line", line)
        self.page.keyboard.press("Enter")
        self.done(turns)
        return self.page.inner_text("article.turn:last-child")

    def press(self, place: int) -> None:
        """Apply (0) or discard (1) the plan that waits."""
        turns = self.page.locator("article.turn").count()
        self.page.click(f"#plan button >> nth={place}")
        self.done(turns)

    def done(self, turns: int) -> None:
        self.page.locator("article.turn").nth(turns).wait_for(timeout=60_000)
        self.page.wait_for_selector("#working:empty", state="attached", timeout=60_000)

    def is_sound(self) -> None:
        """Nothing went wrong, nothing left the machine, and nobody is kept out."""
        found = Axe().run(self.page).response["violations"]
        serious = [one["id"] for one in found if one["impact"] in ("serious", "critical")]
        assert (self.faults, self.outside, serious) == ([], [], [])
        assert self.page.evaluate("document.documentElement.scrollWidth <= innerWidth")


@pytest.mark.parametrize("language", ["en-GB", "zh-CN"])
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("viewport", [WIDE, NARROW], ids=["wide", "narrow"])
def test_the_first_screen(browser: Browser, server: Server, viewport: object, scheme: str, language: str) -> None:
    seen = Seen(browser, server.url, viewport=viewport, color_scheme=scheme, locale=language)
    page = seen.opened()
    page.wait_for_selector("#channel-picture svg, #channel-picture canvas")
    assert page.locator("article.turn").count() == 3
    assert page.locator("#plan-card").is_visible()
    seen.is_sound()


def test_ask_apply_compare_undo_and_reload(browser: Browser, server: Server) -> None:
    server.post("v1/cells", {"name": "looked at", "options": {"seed": 1}})
    seen = Seen(browser, server.url)
    page = seen.opened()
    page.click("#cells summary")
    page.click("#cell-list >> text=looked at")
    page.wait_for_selector("#log:not(:has(article.turn))", state="attached")
    assert "27" in seen.say("highest total rate")
    assert page.locator("#plan-card").is_visible()
    seen.press(0)
    assert "27" in page.inner_text("#in-effect")
    seen.say("at most 10 W")
    assert "10 W" in page.inner_text("#plan")
    seen.press(0)
    seen.say("serve user 99 best")
    assert page.evaluate("document.activeElement.id") == "line"  # a question back: answer at once
    for place in (0, 1):
        page.locator("#timeline input[type=checkbox]").nth(place).check()
    page.click("#timeline-buttons button")
    assert page.locator("#compare").is_visible()
    page.click("#compare [data-close]")
    seen.say("undo")
    turns = page.locator("article.turn").count()
    page.reload()
    page.wait_for_selector("#page:not(.loading)")
    page.locator("article.turn").nth(turns - 1).wait_for()
    seen.is_sound()


def test_what_ifs_the_curve_and_the_report(browser: Browser, server: Server) -> None:
    cell = server.cell("small", num_users=3, num_subcarriers=6)
    server.say(cell["session"], "highest total rate")
    seen = Seen(browser, server.url, cell=cell["id"])
    page = seen.opened()
    page.fill("#line", "yes")
    page.keyboard.press("Enter")  # words apply nothing: they lead to the button
    assert page.evaluate("document.activeElement.textContent") == page.inner_text("#plan button >> nth=0")
    seen.press(0)
    for budget in ("10", "6"):
        seen.say(f"what if we had {budget} W?")
        assert f"{budget} W" in page.inner_text("#looking-text")
    page.click("#timeline-buttons button")
    shown = page.locator("#compare tr:has(th:text-is('Power budget')) td").all_inner_texts()
    assert shown[-2:] == ["10 W", "6 W"]  # what was supposed, not what is asked for
    assert page.locator("#compare section").count() == 3
    page.click("#compare [data-close]")
    page.click("#trade-off-open")
    page.wait_for_selector("#trade-off svg circle.here")
    assert page.inner_text("#trade-off tr.here").startswith("6 W")
    assert page.locator("#trade-off tbody tr").count() == 8 + 1  # 6 W is none of the eighths of 20 W that are
    seen.is_sound()
    page.click("#trade-off [data-close]")
    page.pdf()
    assert page.locator("#rates-picture table").is_visible()
    assert page.text_content("#printed")


def test_figures_agree_in_the_language_in_use(browser: Browser, server: Server) -> None:
    cell = server.cell("agreeing", num_users=3, num_subcarriers=6)
    seen = Seen(browser, server.url, cell=cell["id"], locale="zh-CN")
    page = seen.opened()
    seen.say("总速率最大,每个用户至少100 kbit/s")
    assert "回答" not in page.inner_text("article.turn:last-child")
    seen.press(0)
    assert "回答" in seen.say("如果没有用户3会怎样?")  # it answers, it decides nothing
    page.click("#timeline-buttons button")
    rows = {row.split("\t")[0]: row.split("\t")[1:] for row in page.locator("#compare tbody tr").all_inner_texts()}
    assert rows["排除的用户"] == ["–", "用户3"]
    assert "0 bit/s" not in rows["最低速率"]  # of those who are served
    page.click("#compare [data-close]")
    seen.say("每个用户至少500 Mbit/s")
    page.click("article.turn:last-child summary")
    assert page.inner_text("#certificate") == page.inner_text("article.turn:last-child .more p >> nth=0")
    seen.is_sound()


def test_a_plan_that_waited_for_too_long_is_asked_for_again(browser: Browser, server: Server) -> None:
    cell = server.cell("late", num_users=3, num_subcarriers=6)
    server.say(cell["session"], "highest total rate")
    seen = Seen(browser, server.url, cell=cell["id"])
    seen.page.clock.set_fixed_time(datetime.now(UTC) + timedelta(minutes=16))
    page = seen.opened()
    assert "waited too long" in page.inner_text("#plan-note")
    assert page.locator("#plan button >> text=Apply").count() == 0
    seen.press(0)
    assert "Apply it?" in page.inner_text("article.turn:last-child")


def test_an_operation_with_its_tables_and_its_picture(browser: Browser, server: Server) -> None:
    pytest.importorskip("matplotlib")
    seen = Seen(browser, server.url)
    page = seen.opened()
    page.click(".top > [data-open=settings]")
    assert page.locator("#new-recogniser").is_disabled()
    assert page.locator(".no-llm").is_visible()
    page.click("#settings [data-close]")
    page.click("#tools-open")
    page.wait_for_selector("#tools-fields label")
    assert "power, W" in page.inner_text("#tools-fields")
    page.click("#tools-form button")
    page.wait_for_selector("#tools-found img", timeout=60_000)
    assert page.evaluate("document.querySelector('#tools-found img').naturalWidth") > 100
    assert page.locator("#tools-found table").count() > 1
    seen.is_sound()


def test_a_measured_file(browser: Browser, server: Server, tmp_path: Path) -> None:
    file = tmp_path / "hall.csv"
    file.write_text("1e-9,2e-9,,4e-9\n2e-9,1e-9,3e-9,1e-9\n")
    seen = Seen(browser, server.url)
    page = seen.opened()
    page.set_input_files("#upload-file", file)
    page.wait_for_selector("#upload-make:not([disabled])")
    page.click("#upload-make")
    page.wait_for_selector("#cell-name:has-text('hall')")
    assert "Mbit/s" in seen.say("highest total rate")
    file.write_text("1e-9,2e-9,3e-9\n2e-9,1e-9,3e-9\n1e-9,1e-9,1e-9\n")
    page.set_input_files("#upload-file", file)
    page.wait_for_selector("#upload-use:not([disabled])")
    assert page.inner_text("#upload-use") == "Use it in hall"
    page.click("#upload-use")  # the same cell on another channel, in a new conversation
    page.wait_for_selector("#cell-size:has-text('3 users × 3 sub')")
    assert page.locator("article.turn").count() == 0
    assert "Mbit/s" in seen.say("highest total rate")
    seen.is_sound()


def test_the_server_is_lost_and_comes_back(browser: Browser, tmp_path: Path) -> None:
    store = tmp_path / "store.sqlite3"
    with started(store) as server:
        seen = Seen(browser, server.url)
        page = seen.opened()
        page.fill("#line", "what if we had 10 W?")
        server.kill()
        page.keyboard.press("Enter")
        page.wait_for_selector("#disconnected:not([hidden])", timeout=30_000)
        port = server.url.rstrip("/").rsplit(":", 1)[1]
    with started(store, "--port", port):
        page.wait_for_selector("#disconnected", state="hidden", timeout=60_000)
        assert page.input_value("#line") == "what if we had 10 W?"


def test_a_server_that_says_why_it_cannot_is_not_lost(browser: Browser, server: Server) -> None:
    seen = Seen(browser, server.url)
    page = seen.opened()
    why = {"title": "The store cannot be reached", "status": 503, "detail": "the audit store does not answer"}
    kind = "application/problem+json"
    page.route("**/turns", lambda route: route.fulfill(status=503, content_type=kind, body=json.dumps(why)))
    page.fill("#line", "what if we had 10 W?")
    page.keyboard.press("Enter")
    page.wait_for_selector(f"text={why['detail']}")
    assert page.locator("#disconnected").is_hidden()
    assert page.input_value("#line") == "what if we had 10 W?"


def test_signing_in(browser: Browser, guarded: Signed) -> None:
    page = Seen(browser, guarded.nobody.url).page
    page.goto(guarded.nobody.url)
    page.wait_for_url("**/sign-in.html")
    page.fill("#token", "wa_nonsense")
    page.click("button")
    page.wait_for_selector(".problem:not([hidden])")
    page.fill("#token", guarded.viewer.token)
    page.click("button")
    page.wait_for_selector("#page:not(.loading)")
    assert page.locator("#viewer").is_visible()
    assert page.locator("#plan button").count() == 0
    assert page.locator(".operates:visible").count() == 0
