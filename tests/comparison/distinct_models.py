"""
A study in which no two numbers are the same: every model, body, phase pair, statistic and sign can be told apart.

mu of the first model and the relative differences of the others are closed forms; `differences_of` gives them to tests,
which make every statistic of them with NumPy alone.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray
from studies import solved

from comparison.study.models import MODEL_HIERARCHY, Model, never
from comparison.study.study import Study
from reference.problem import Amplification, Scene, load_scene

Array = NDArray[np.float64]

MOST = {"translational": 4, "spatial": 4}  # phases per axis
# of each model: mean step and swing over the phases of the platform, the same of body 2, share of mu of the error
STEPS = {
    "small": (0.0, 0.0, 0.0, 0.0, 1.1e-5),
    "exact": (0.033, 0.010, -0.0077, 0.0027, 1.7e-5),
    "resolved": (-0.039, 0.11, 0.011, -0.017, 2.3e-5),
    "regularised": (-0.0075, 0.0085, -0.0036, 0.0066, 3.1e-5),
    "translational": (0.0022, -0.0019, 0.0011, 0.0017, 7.3e-4),
    "spatial": (-0.057, -0.088, 0.021, 0.026, 1.9e-4),
}
KEYS = tuple(STEPS)
GRID, COARSE = 8, 4  # phases per axis of the equations, and of the engine
ROWS = [(pair, body) for body in (1, 2) for pair in ("total", "translational", "like for like")]


def first_mu(body: int, phases: Array) -> Array:
    """mu of the first model at phases (P, 2); alpha1 and alpha2 are no mirror images."""
    alpha1, alpha2 = phases.T
    return (
        1.3
        + 0.9 * body
        + 0.5 * np.cos(alpha1 - 0.3 * body + 1.4)
        + 0.21 * np.sin(alpha2 + 0.2)
        + 0.13 * np.cos(2 * alpha2)
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
    share = scene.friction_coefficient / 0.1  # of fig3-I: members of a family differ
    mu = np.stack(
        [first_mu(body, phases) * (1.0 + share * differences_of(key, body, phases)) for body in bodies], axis=1
    )
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


@cache
def distinct_study() -> tuple[Study, xr.Dataset]:
    """A study of one scene by these models, and its surfaces."""
    study = Study((load_scene("fig3-I"),), GRID, 1e-3, distinct_hierarchy())
    return study, solved(study)


def step(key: str, body: int, count: int = COARSE) -> Array:
    """What a model adds to the one before it on a grid."""
    before = KEYS[KEYS.index(key) - 1]
    return differences_of(key, body, grid_phases(count)) - differences_of(before, body, grid_phases(count))


def pair_sizes(pair: str, body: int, count: int = COARSE) -> Array:
    """The signed differences of a pair of models, relative to its own first model."""
    first, second = {
        "total": ("small", "spatial"),
        "translational": ("small", "translational"),
        "like for like": ("regularised", "translational"),
    }[pair]
    phases = grid_phases(count)
    size = (1.0 + differences_of(second, body, phases)) / (1.0 + differences_of(first, body, phases)) - 1.0
    return np.asarray(size)


def of_sizes(pair: str, body: int) -> dict[str, float]:
    """The statistics of the table of differences, made with NumPy alone."""
    signed, size = pair_sizes(pair, body), np.abs(pair_sizes(pair, body))
    return {
        "mean": signed.mean(), "standard deviation": signed.std(), "95 %": np.percentile(size, 95.0, method="hazen"),
        "maximum": size.max(), "median size": np.median(size),
    }  # fmt: skip


def in_percent(value: float, plus: str = "") -> str:
    """Two digits, or whole percents from 10 % on."""
    size = 100.0 * abs(value)
    return ("−" if value < 0.0 else plus) + (f"{size:.0f} %" if size >= 10.0 else f"{size:.2g} %")


def drawn(patch: pytest.MonkeyPatch, draw: Callable[..., object], *arguments: Any) -> Figure:
    """The figure that a function draws."""
    figures: list[Figure] = []
    patch.setattr(Figure, "savefig", lambda figure, *rest, **options: figures.append(figure))
    draw(*arguments)
    return figures[0]


def by_phase(values: Array) -> Array:
    """Values on a grid, alpha1 along the rows, closed at 2 pi."""
    count = round(len(values) ** 0.5)
    return np.pad(values.reshape(count, count), ((0, 1), (0, 1)), mode="wrap")


def heights(key: str, body: int, count: int) -> Array:
    phases = grid_phases(count)
    return by_phase(first_mu(body, phases) * (1.0 + differences_of(key, body, phases)))
