"""Folders of the project."""

from pathlib import Path

HELPERS = Path(__file__).parent
ROOT = HELPERS.parents[1]
SCENES = ROOT / "reference/problem/scenes"
EXAMPLES = ROOT / "reference/records/examples"


def scene_text(name: str = "fig3-I", *replaced: tuple[str, str]) -> str:
    """The file of a built-in scene, with texts that stand in it once replaced."""
    text = (SCENES / f"{name}.toml").read_text(encoding="utf-8")
    for old, new in replaced:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def limited_scene(folder: Path, limits: str, name: str = "limited.toml") -> str:
    """The file of a scene with these limits."""
    (folder / name).write_text(scene_text().split("[acceptance]")[0] + limits, encoding="utf-8")
    return str(folder / name)
