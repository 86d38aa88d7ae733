"""The page draws itself in a browser that has no network: every scene and body, without a fault of its script."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
TALL = "1280,7000"  # what is out of view is not drawn


@pytest.mark.long
@pytest.mark.skipif(BROWSER is None, reason="no Chromium on this machine")
def test_every_surface_of_the_page_is_drawn(finished: Path, tmp_path: Path) -> None:
    options = ["--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--disable-extensions"]
    profile = [f"--user-data-dir={tmp_path / 'profile'}", f"--window-size={TALL}", "--virtual-time-budget=8000"]
    page = (finished / "index.html").as_uri()
    command = [str(BROWSER), *options, *profile, "--enable-logging=stderr", "--dump-dom", page]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    boxes = re.findall(r'<div class="(surfaces[^"]*)"', done.stdout)
    assert boxes == ["surfaces js-plotly-plot"] * 4, "two scenes, two bodies each"
    assert done.stdout.count("<canvas") >= 3 * len(boxes), "two surfaces and their difference"
    said = [line for line in done.stderr.splitlines() if "CONSOLE" in line and ("rror" in line or "refused" in line)]
    assert said == []
