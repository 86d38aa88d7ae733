"""Small scenes for the engine's closed-form cases."""

from __future__ import annotations

from typing import Any

from reference.problem import Scene

CONSTANT = 1e9  # s, period of a harmonic that stays at its first value


def one_body(
    *,
    radius: float = 0.25,
    friction: float = 0.1,
    duration: float = 1.0,
    amplitudes: list[list[float]] | None = None,
    periods: tuple[float, float] = (1.0, 1.0),
    **isolator: Any,
) -> Scene:
    """One mass of 1 kg on the isolator; without amplitudes the plate is at rest."""
    return Scene.model_validate(
        {
            "title": "one body",
            "duration": duration,
            "isolator": {"radius": radius, **(isolator or {"friction": friction})},
            "bodies": [{"mass": 1.0}],
            "excitation": {
                "amplitudes": amplitudes or [[0.0, 0.0], [0.0, 0.0]],
                "periods": list(periods),
                "decay": [0.0, 0.0],
            },
        }
    )


def changed(scene: Scene, **tables: Any) -> Scene:
    """`scene` with some of its top-level entries replaced; tables are merged key by key."""
    data = scene.model_dump(exclude_none=True)
    for key, value in tables.items():
        data[key] = {**data[key], **value} if isinstance(value, dict) else value
    return Scene.model_validate(data)
