"""
A study in which no two numbers are the same: every model, body, phase pair, statistic and sign can be told apart.

mu of the first model and the relative differences of the others are closed forms; `differences_of` gives them to tests,
which make every statistic of them with NumPy alone.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from comparison.study.models import MODEL_HIERARCHY, Model, never
from reference.problem import Amplification, Scene

Array = NDArray[np.float64]

MOST = {"translational": 4, "spatial": 4}  # phases per axis
# of each model: mean step and swing over the phases of the platform, the same of body 2, share of mu of the error
STEPS = {
    "small": (0.0, 0.0, 0.0, 0.0, 1.1e-5),
    "exact": (0.033, 0.010, -0.0077, 0.0027, 1.7e-5),
    "resolved": (-0.039, 0.11, 0.011, -0.017, 2.3e-5),
    "regularised": (-0.0075, 0.0085, -0.0036, 0.0066, 3.1e-5),
    "translational": (0.0022, -0.0019, 0.0011, 0.0017, 7.3e-5),
    "spatial": (-0.057, -0.088, 0.021, 0.026, 1.9e-4),
}
KEYS = tuple(STEPS)


def first_mu(body: int, phases: Array) -> Array:
    """mu of the first model at phases (P, 2); alpha1 and alpha2 are no mirror images."""
    alpha1, alpha2 = phases.T
    return (
        1.3 + 0.9 * body + 0.5 * np.cos(alpha1 - 0.3 * body) + 0.21 * np.sin(alpha2 + 0.2) + 0.13 * np.cos(2 * alpha2)
    )


def differences_of(key: str, body: int, phases: Array) -> Array:
    """(mu of the model - mu of the first) / mu of the first at phases (P, 2)."""
    total = np.zeros(len(phases))
    for number, name in enumerate(KEYS[: KEYS.index(key) + 1]):
        mean, swing = STEPS[name][2 * body - 2 : 2 * body]
        shape = np.cos(phases[:, 0] + 0.7 * number) + 0.6 * np.sin(phases[:, 1] - 0.4 * number + body)
        shape += 0.45 * np.cos(phases[:, 0] - 2.0 * phases[:, 1] + number)
        total += mean + swing * (shape + 0.2 * shape**2)  # as many above the mean as below it would make it the median
    return total


def grid_phases(count: int) -> Array:
    """Phase pairs (count^2, 2) of a grid, alpha2 running fastest."""
    axis = 2.0 * np.pi * np.arange(count) / count
    return np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)


def distinct(scene: Scene, phases: Array, tolerance: float, key: str) -> Amplification:
    """The model as a study calls it."""
    bodies = range(1, len(scene.bodies) + 1)
    mu = np.stack([first_mu(body, phases) * (1.0 + differences_of(key, body, phases)) for body in bodies], axis=1)
    points = len(phases)
    return Amplification(mu, STEPS[key][-1] * mu, np.full(points, "ok"), np.full(points, np.nan), 0.001 * points)


def distinct_hierarchy() -> tuple[Model, ...]:
    """The real hierarchy with these models, which leave no phase pair to a symmetry."""
    return tuple(
        replace(
            model,
            amplification="distinct_models:distinct",
            settings={"key": model.key},
            symmetric=never,
            refusal=None,
            most=MOST.get(model.key),
        )
        for model in MODEL_HIERARCHY
    )
