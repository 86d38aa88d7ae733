"""
Pictures of the two screens of a report: report-answers.png and report-surfaces.png.

    python docs/report_pictures.py report/index.html

needs playwright and a Chromium that is installed.
"""

from __future__ import annotations

import shutil
import sys
from io import BytesIO
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright

WIDTH = 1280  # px
COLORS = 256  # enough for plots and text, at a third of the bytes
CHROMIUM = ("chromium", "chromium-browser", "google-chrome")


def main(report: Path, folder: Path) -> None:
    """Write the pictures of `report`, an index.html, into `folder`."""
    program = next(filter(None, map(shutil.which, CHROMIUM)), None)
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=program, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": WIDTH, "height": 900})
        page.goto(report.resolve().as_uri())
        page.wait_for_selector("html[data-ready]", state="attached")
        page.wait_for_selector("[data-part=demands] table")
        page.wait_for_timeout(500)  # plots are drawn when the browser has laid them out
        top, end = (_bottom(page, place) for place in ("#summary", "#surfaces"))
        screen = Image.open(BytesIO(page.screenshot(full_page=True))).convert("RGB")
        browser.close()
    for name, box in (("answers", (0, 0, WIDTH, top)), ("surfaces", (0, top, WIDTH, end))):
        screen.crop(box).quantize(COLORS, dither=Image.Dither.NONE).save(folder / f"report-{name}.png", optimize=True)


def _bottom(page: Page, place: str) -> int:
    return int(page.locator(place).evaluate("part => Math.round(part.getBoundingClientRect().bottom + scrollY)"))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "report/index.html"), Path(__file__).parent)
