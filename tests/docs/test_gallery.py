"""Every example runs as a user would run it, is short, and has its picture in the gallery."""

import ast
from pathlib import Path

import gallery_pictures as gallery
import numpy as np
import pytest
from pages import ROOT
from PIL import Image

EXAMPLES = sorted([*(ROOT / "examples").glob("*.py"), *(ROOT / "examples").glob("*.ipynb")])
MAX_LINES = 60


@pytest.mark.long
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.name)
def test_an_example_runs_and_draws_its_picture(example: Path, tmp_path: Path) -> None:
    with Image.open(gallery.run(example, tmp_path)) as drawn:
        assert np.unique(np.asarray(drawn.convert("RGB")).reshape(-1, 3), axis=0).shape[0] > 20  # not an empty page


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.name)
def test_an_example_has_its_picture_in_the_gallery(example: Path) -> None:
    script = gallery.script_of(example)
    ast.parse(script)
    assert len(script.splitlines()) < MAX_LINES
    page = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
    assert f"(gallery/{example.stem}.png)" in page
    assert f"../examples/{example.name}" in page
    assert (ROOT / "docs" / "gallery" / f"{example.stem}.png").stat().st_size > 5000
