"""The pages are built without a warning, and nothing on them is loaded from a network."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from pages import ROOT

LOADED = re.compile(
    r"""<(?:script|img|iframe|source)[^>]*\bsrc="(?:https?:)?//|<link(?![^>]*canonical)[^>]*href="(?:https?:)?//"""
)


@pytest.mark.long
def test_the_site_is_built_without_warnings(tmp_path: Path) -> None:
    for module in ("sphinx", "numpydoc", "myst_nb", "furo"):
        pytest.importorskip(module)
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "docs", str(tmp_path)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    built = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert built.returncode == 0, built.stderr
    pages = {page: page.read_text(encoding="utf-8") for page in tmp_path.rglob("*.html")}
    assert len(pages) > 40
    assert [str(page) for page, text in pages.items() if LOADED.search(text)] == []
    theory = pages[tmp_path / "theory.html"]
    assert theory.count("<math") > 50
    assert "merror" not in theory
