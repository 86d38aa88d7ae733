"""Baseline scene of the extreme test cases and its variations, as tables and keys of a scene file."""

import math
from collections.abc import Sequence
from typing import Any

BASELINE_RADIUS = 0.25  # m, radius of the sphere on which the baseline scene's platform slides with a period of 1 s
GRAVITY_LIMIT = 9.81  # m/s^2, downward acceleration of the shaking plate at which the contact force vanishes


def make_baseline_scene(
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
    """
    Return the tables of a scene file for the baseline, the paper's `fig3-I` with twice its loading, or a variation.

    Every argument replaces values of the baseline; a value None leaves its key out. amplitudes: m/s^2, a row for each
    axis, a column for each harmonic. periods: s, decay: 1/s, of both harmonics. link: s, periods of every link along x
    and y. damping: of the links, over critical damping. storey: m, vertical distance of the bodies. isolator: keys of
    that table.
    """
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


def make_horizontal_amplitudes(amplitude: float) -> list[list[float]]:
    """Return the amplitudes of a loading with one harmonic along x and the other along y, m/s^2."""
    return [[amplitude, 0.0], [0.0, amplitude]]


def add_vertical_harmonic(amplitude: float) -> list[list[float]]:
    """Return the horizontal amplitudes of the baseline scene, and a vertical harmonic of `amplitude`, m/s^2."""
    return [[2.0, 0.0], [0.0, 2.0], [amplitude, 0.0]]


def raise_bodies(stated: dict[str, Any]) -> dict[str, Any]:
    """Return a scene of large radius with its bodies raised by as much, so that they are as far above the contacts."""
    rise = max(stated["isolator"]["radius"] - BASELINE_RADIUS, 0.0)
    return {**stated, "bodies": [{**body, "height": body["height"] + rise} for body in stated["bodies"]]}


def put_on_bars(share: float, **keys: Any) -> dict[str, Any]:
    """
    Return the baseline scene with body 2, of 1 kg, on four bars of 1 m; `share` is its weight over their buckling load.

    keys: further keys of the bars.
    """
    bending = GRAVITY_LIMIT / (4.0 * math.pi**2 * share)  # N m^2, EI of a bar, which buckles under pi^2 EI / (1 m)^2
    stated = make_baseline_scene()
    platform, body = stated["bodies"]
    bars = {"count": 4, "bending_stiffness": bending, "length": 1.0, "load_effect": "softening", **keys}
    return {**stated, "bodies": [platform, {**body, "period": None, "bars": bars}]}


def change_bodies(**keys: Any) -> dict[str, Any]:
    """Return the baseline scene with these keys set in every body."""
    stated = make_baseline_scene()
    return {**stated, "bodies": [{**body, **keys} for body in stated["bodies"]]}
