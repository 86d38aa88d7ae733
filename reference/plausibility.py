"""Values of a scene that are valid but hardly meant."""

from __future__ import annotations

import math

import numpy as np

from reference.problem.scene import Scene

LONGEST_PERIOD = 100.0  # s
LARGEST_RADIUS = 100.0  # m
LARGEST_FRICTION = 1.0
MASS_RATIO = 1e6


def implausible_values(scene: Scene) -> list[str]:
    """Return one line for every kind of value that is hardly meant."""
    lines, links = [], scene.masses[1:, None]
    if scene.damping.any():
        ratio = float((scene.damping / (2.0 * np.sqrt(scene.stiffness * links))).max())
        if ratio > 1.0:
            lines.append(f"the damping ratio of a link is {ratio:.4g}, above critical: percent?")
    periods = 2.0 * np.pi * np.sqrt(links / scene.stiffness)
    longest = max([scene.isolator.period or 0.0, *periods.ravel().tolist()])
    if longest > LONGEST_PERIOD:
        lines.append(f"a natural period is {longest:.4g} s: units of mass and stiffness?")
    if LARGEST_RADIUS < scene.radius < math.inf and scene.isolator.radius is not None:
        lines.append(f"the radius of the isolator is {scene.radius:.4g} m: mm?")
    if not scene.isolator.lubrication and (friction := scene.dry_friction.largest) > LARGEST_FRICTION:
        lines.append(f"the friction coefficient is {friction:.4g}: percent?")
    spread = float(scene.masses.max() / scene.masses.min())
    if spread >= MASS_RATIO:
        lines.append(f"masses differ by a factor of {spread:.2g}: kg in one place and t in another?")
    return lines
