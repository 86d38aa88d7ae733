"""Folders of the project."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

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


def write_pulses(folder: Path, pulses: Mapping[str, tuple[float, float, float]]) -> None:
    """Make a folder of motions of 2 s: peak along x, m/s^2, angular frequency, rad/s, and y over x, by name."""
    folder.mkdir()
    time = np.arange(0.0, 2.0, 0.05)
    for name, (peak, rate, share) in pulses.items():
        along_x = peak * np.sin(rate * time) * np.exp(-(((time - 1.0) / 0.5) ** 2))
        rows = "\n".join(f"{t:.2f},{a:.6f},{share * a:.6f}" for t, a in zip(time, along_x))
        (folder / f"{name}.csv").write_text(f"time [s],ax [m/s^2],ay [m/s^2]\n{rows}\n")
