"""docs/scene.md lists every key of a scene file as the program reads it."""

import importlib.util
from pathlib import Path

from reference.problem.scene import KEYS

DOCS = Path(__file__).parents[3] / "docs"


def test_the_page_of_keys_is_what_the_schema_says() -> None:
    place = importlib.util.spec_from_file_location("scene_keys", DOCS / "scene_keys.py")
    assert place is not None
    assert place.loader is not None
    scene_keys = importlib.util.module_from_spec(place)
    place.loader.exec_module(scene_keys)
    written = (DOCS / "scene.md").read_text(encoding="utf-8")
    assert written == scene_keys.page(), "run: python docs/scene_keys.py"


def test_the_page_has_a_row_for_every_key_but_tables_and_the_file_s_name() -> None:
    page = (DOCS / "scene.md").read_text(encoding="utf-8")
    keys = {key for table in KEYS.values() for key in table} - {*KEYS, "name"}
    assert not [key for key in keys if f"\n| `{key}` | " not in page]
