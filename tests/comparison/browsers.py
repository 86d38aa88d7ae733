"""Pages in a browser without a network."""

import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from places import HELPERS
from playwright.sync_api import Browser, Page, sync_playwright

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
FLAGS = ["--no-sandbox", "--disable-background-networking", "--disable-sync"]
PHONE, LAPTOP, DESKTOP = 390, 1280, 1920  # px
PATIENCE = 300_000  # ms: nothing here takes that long, however busy the machine
OVERLAPS = (HELPERS / "boxes.js").read_text(encoding="utf-8")

Scheme = Literal["light", "dark"]


@dataclass
class Visit:
    """An opened page, and all it complained about or asked for."""

    page: Page
    complaints: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)


@contextmanager
def chromium() -> Iterator[Browser]:
    """A browser that is closed in the end."""
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


def opened(browser: Browser, file: Path, width: int, scheme: Scheme = "light", first: str = "") -> Visit:
    """A page that is ready; first: a script that runs before the page's own."""
    page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
    page.set_default_timeout(PATIENCE)
    visit = Visit(page)
    page.on("console", lambda message: visit.complaints.append(message.text))
    page.on("pageerror", lambda error_message: visit.complaints.append(str(error_message)))
    page.on("request", lambda r: visit.requests.append(r.url) if not r.url.startswith(("data:", "blob:")) else None)
    page.add_init_script(first)
    page.goto(file.as_uri())
    page.wait_for_selector("html[data-ready]", state="attached")
    return visit


def until(page: Page, condition: str) -> None:
    """Wait for a condition. The page's policy forbids the evaluation of texts that `wait_for_function` relies on."""
    end = time.monotonic() + PATIENCE / 1000
    while not page.evaluate(condition):
        assert time.monotonic() < end, condition
        page.wait_for_timeout(20)


def unfolded(page: Page) -> None:
    """Every folded part is opened, every plot drawn."""
    page.evaluate("document.querySelectorAll('details').forEach(part => { part.open = true; })")
    until(page, "[...document.querySelectorAll('[data-plot]')].every(box => box.querySelector('svg'))")
    until(page, "!document.querySelector('[data-part=plots]') || document.querySelector('[data-part=plots] svg')")
