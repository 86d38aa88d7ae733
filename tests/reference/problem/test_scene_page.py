"""docs/scene.md lists every key of a scene file as the program reads it."""

import runpy
from pathlib import Path

from reference.problem.scene import KEYS

DOCS = Path(__file__).parents[3] / "docs"


def test_the_page_of_keys_is_what_the_schema_says() -> None:
    page = (DOCS / "scene.md").read_text(encoding="utf-8")
    assert page == runpy.run_path(str(DOCS / "scene_keys.py"))["page"](), "run: python docs/scene_keys.py"
    keys = {key for table in KEYS.values() for key in table} - {*KEYS, "name"}
    assert not [key for key in keys if f"\n| `{key}` | " not in page]
