"""The cases that the claims speak about, as scenes of a reading."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

from comparison.analyses.claims.readings import Reading, loading_around
from reference.problem import Scene, load_scene

KEPT = 1024  # scenes of each kind: every reading asks for its own several times


@lru_cache(KEPT)
def _read(name: str, reading: Reading) -> Scene:
    scene = load_scene(name, reading.amplitude)
    values: dict[str, Any] = {"name": name, "duration": reading.duration}
    values |= {key: value for key, value in reading.values if not (scene.lubricated and key == "isolator.friction")}
    for key, factor in reading.factors:
        values[key] = _times(_value(scene, key), factor)
    if scene.lubricated:
        values["isolator.lubrication"] = reading.lubrication
    return scene.with_values(values)


def _value(scene: Scene, key: str) -> Any:
    place: Any = scene.model_dump(exclude_none=True)
    for part in key.split("."):
        place = place[int(part) if part.isdecimal() else part]
    return place


def _times(value: Any, factor: float) -> Any:
    return factor * value if isinstance(value, int | float) else [factor * number for number in value]


@lru_cache(KEPT)
def _alone(name: str, reading: Reading) -> Scene:
    """The platform without what stands on it, under the loading as printed: close to its own resonance T_c."""
    scene = _read(name, reading)
    natural = scene.isolator.period
    assert natural is not None
    platform = [scene.bodies[0].model_dump(exclude_none=True)]
    return scene.with_values({"name": f"{name} alone", "bodies": platform, **dict(loading_around(natural))})


@lru_cache(KEPT)
def _oscillator(name: str, reading: Reading) -> Scene:
    """One body without friction, of the period T_3x of the second body on its springs: far from both harmonics."""
    scene = _read(name, reading)
    second = scene.bodies[1].period
    assert second is not None
    return scene.with_values(
        {
            "name": f"{name} oscillator",
            "bodies": [scene.bodies[0].model_dump(exclude_none=True)],
            "isolator": {"period": second[0], "friction": 0.0},
        }
    )


CASES: Mapping[str, Callable[[Reading], Scene]] = {
    "fig3-I": lambda reading: _read("fig3-I", reading),
    "fig3-II": lambda reading: _read("fig3-II", reading),
    "fig4-dry": lambda reading: _read("fig4-dry", reading),
    "fig4-viscous": lambda reading: _read("fig4-viscous", reading),
    "fig3-I alone": lambda reading: _alone("fig3-I", reading),
    "fig3-II alone": lambda reading: _alone("fig3-II", reading),
    "fig3-II oscillator": lambda reading: _oscillator("fig3-II", reading),
}
