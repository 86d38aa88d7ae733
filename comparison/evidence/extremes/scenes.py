"""The plain scene of the extremes, and its variations, as in a scene file."""

import math
from collections.abc import Sequence
from typing import Any

PLAIN_RADIUS = 0.25  # m, of the plain scene, whose period is 1 s
GRAVITY_LIMIT = 9.81  # m/s^2: downward acceleration of the plate at which the contact carries nothing


def scene(
    *,
    amplitudes: Sequence[Sequence[float]] = ((2.0, 0.0), (0.0, 2.0)),
    periods: Sequence[float] = (0.9, 1.1),
    decay: Sequence[float] = (1.0 / 3.0, 0.3 / 1.1),
    duration: float = 3.0,
    masses: Sequence[float] = (1.0, 1.0),
    link: Sequence[float] = (1.5, 1.2),
    damping: float | Sequence[float] | None = None,
    storey: float = 1.0,
    **isolator: Any,
) -> dict[str, Any]:
    """The plain scene, `fig3-I` at twice its amplitude, as in a scene file, with changed quantities; None: no key."""
    if "radius" not in isolator:
        isolator = {"period": 1.0, **isolator}
    size = [2.0, 2.0, 0.2]
    bodies: list[dict[str, Any]] = [
        {"mass": mass, "height": 0.2 + storey * number, "size": size, "period": list(link)}
        for number, mass in enumerate(masses)
    ]
    del bodies[0]["period"]
    for body in bodies[1:]:
        body["damping"] = damping
    return {
        "title": "one quantity at its extreme",
        "duration": duration,
        "isolator": {"friction": 0.1, "supports": 4, "ring": 1.0, "sphere_radius": 0.05, **isolator},
        "bodies": bodies,
        "excitation": {"amplitudes": [list(row) for row in amplitudes], "periods": list(periods), "decay": list(decay)},
    }


def amplitudes_along(amplitude: float) -> list[list[float]]:
    """Return amplitudes of one harmonic along x and the other along y, m/s^2."""
    return [[amplitude, 0.0], [0.0, amplitude]]


def amplitudes_upward(amplitude: float) -> list[list[float]]:
    """Return those of the plain scene with a vertical one, m/s^2."""
    return [[2.0, 0.0], [0.0, 2.0], [amplitude, 0.0]]


def raise_bodies(stated: dict[str, Any]) -> dict[str, Any]:
    """The bodies no lower against the contacts than in the plain scene: heights count from a radius below them."""
    rise = max(stated["isolator"]["radius"] - PLAIN_RADIUS, 0.0)
    return {**stated, "bodies": [{**body, "height": body["height"] + rise} for body in stated["bodies"]]}


def put_on_bars(share: float, **keys: Any) -> dict[str, Any]:
    """The plain scene on four bars of 1 m that carry a share of their buckling load."""
    beam = GRAVITY_LIMIT / (4.0 * math.pi**2 * share)
    stated = scene()
    platform, body = stated["bodies"]
    bars = {"count": 4, "bending_stiffness": beam, "length": 1.0, "load_effect": "softening", **keys}
    return {**stated, "bodies": [platform, {**body, "period": None, "bars": bars}]}


def change_bodies(**keys: Any) -> dict[str, Any]:
    """Return the plain scene with these keys of every body."""
    stated = scene()
    return {**stated, "bodies": [{**body, **keys} for body in stated["bodies"]]}
