"""The cases that the claims speak about, as scenes of a reading."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache, partial
from typing import Any

import numpy as np

from comparison.analyses.claims.readings import Reading, loading_around
from reference.problem import Scene, load_scene

KEPT = 1024  # scenes of each kind: every reading asks for its own several times


@lru_cache(KEPT)
def _read(name: str, reading: Reading) -> Scene:
    scene = load_scene(name, reading.amplitude)
    values: dict[str, Any] = {"name": name, "duration": reading.duration}
    values |= {key: value for key, value in reading.values if not (scene.lubricated and key == "isolator.friction")}
    for key, factor in reading.factors:
        stated: Any = scene.model_dump(exclude_none=True)
        for part in key.split("."):
            stated = stated[int(part) if part.isdecimal() else part]
        values[key] = np.multiply(factor, stated).tolist()
    if scene.lubricated:
        values["isolator.lubrication"] = reading.lubrication
    return scene.with_values(values)


@lru_cache(KEPT)
def _alone(name: str, reading: Reading) -> Scene:
    """The platform without what stands on it, under the loading as printed: close to its own resonance T_c."""
    natural = _read(name, reading).isolator.period
    assert natural is not None
    return _platform(name, reading, "alone", **dict(loading_around(natural)))


@lru_cache(KEPT)
def _oscillator(name: str, reading: Reading) -> Scene:
    """One body without friction, of the period T_3x of the second body on its springs: far from both harmonics."""
    second = _read(name, reading).bodies[1].period
    assert second is not None
    return _platform(name, reading, "oscillator", isolator={"period": second[0], "friction": 0.0})


def _platform(name: str, reading: Reading, kind: str, **values: Any) -> Scene:
    scene = _read(name, reading)
    platform = scene.bodies[0].model_dump(exclude_none=True)
    return scene.with_values({"name": f"{name} {kind}", "bodies": [platform], **values})


CASES: Mapping[str, Callable[[Reading], Scene]] = {
    **{name: partial(_read, name) for name in ("fig3-I", "fig3-II", "fig4-dry", "fig4-viscous")},
    **{f"{name} alone": partial(_alone, name) for name in ("fig3-I", "fig3-II")},
    "fig3-II oscillator": partial(_oscillator, "fig3-II"),
}
