"""
The total difference of a surface, taken apart: what each rung of the ladder adds, with its uncertainty.

Steps are taken between neighbouring rungs that apply to the scene, so that they add up to the total by construction.
All are relative to mu of the first rung: their sum is then the relative total.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.ladder import Rung, rungs_of
from comparison.study import Study

Array = NDArray[np.float64]

TOTAL = "total"


@dataclass(frozen=True)
class Step:
    """
    One step of the budget on the grid, (alpha1, alpha2): NaN where any rung of the ladder has no value.

    size: (mu of `second` - mu of `first`) / mu of the ladder's first rung, signed. uncertainty: u_D = sqrt(u_A^2 +
    u_B^2) of the two error estimates in the same unit. For the total, `key` is "total", else that of the second rung.
    """

    key: str
    first: Rung
    second: Rung
    body: int
    size: Array
    uncertainty: Array

    @property
    def real(self) -> NDArray[np.bool_]:
        """Where the step is larger than its uncertainty: only there it is a difference between models."""
        return np.abs(self.size) > self.uncertainty


@dataclass(frozen=True)
class Entry:
    """
    One step in numbers. median, rms, percentile95, maximum: of the absolute size, NaN without a point.

    phases: (alpha1, alpha2) of the maximum, rad. real: share of the points where |D| > u_D. uncertain: median of
    u_D. mean: of the signed size, so that a step which only raises is told from one that scatters. peak_moves: rad on
    the periodic square, how far the highest point of the surface moves at least; points whose error estimates let them
    be the highest count alike, because symmetric surfaces have several. correlation: of the two surfaces. points: how
    many phase pairs have a value on every rung.
    """

    scene: str
    body: int
    step: str
    first: str
    second: str
    mean: float
    median: float
    rms: float
    percentile95: float
    maximum: float
    phases: tuple[float, float]
    real: float
    uncertain: float
    peak_moves: float
    correlation: float
    points: int


def steps(study: Study, surfaces: xr.Dataset, scene: str, body: int) -> list[Step]:
    """Every step of one body's surface in the order of the ladder, and the total at the end."""
    rungs = rungs_of(next(one for one in study.scenes if one.name == scene), study.ladder)
    mu, error = (
        [np.asarray(surfaces[name].sel(scene=scene, model=rung.key, body=body), float) for rung in rungs]
        for name in ("mu", "error")
    )
    known = np.isfinite([*mu, *error]).all(axis=0) & (mu[0] > 0.0)
    scale = np.where(known, mu[0], np.nan)

    def step(key: str, first: int, second: int) -> Step:
        uncertainty = np.hypot(error[first], error[second]) / scale
        return Step(key, rungs[first], rungs[second], body, (mu[second] - mu[first]) / scale, uncertainty)

    last = len(rungs) - 1
    return [step(rungs[i + 1].key, i, i + 1) for i in range(last)] + [step(TOTAL, 0, last)]


def budget(study: Study, surfaces: xr.Dataset) -> list[Entry]:
    """Every entry of the table, in the order scene, body, step."""
    return [
        _entry(surfaces, scene.name, step)
        for scene in study.scenes
        for body in range(1, len(scene.bodies) + 1)
        for step in steps(study, surfaces, scene.name, body)
    ]


def closure(steps: Sequence[Step]) -> float:
    """Largest |sum of the steps - total| over the points, relative to mu: rounding if the budget is sound."""
    gap = np.abs(np.sum([step.size for step in steps[:-1]], axis=0) - steps[-1].size)
    return float(np.nanmax(gap)) if np.isfinite(gap).any() else 0.0


def torus_distance(one: Sequence[float], other: Sequence[float]) -> float:
    """Distance of two phase pairs on the square that closes at 2 pi in both directions, rad."""
    apart = np.abs(np.subtract(one, other)) % (2.0 * np.pi)
    return float(np.hypot(*np.minimum(apart, 2.0 * np.pi - apart)))


def _entry(surfaces: xr.Dataset, scene: str, step: Step) -> Entry:
    size, known = np.abs(step.size), np.isfinite(step.size)
    names: dict[str, Any] = {
        "scene": scene,
        "body": step.body,
        "step": step.key,
        "first": step.first.key,
        "second": step.second.key,
        "points": int(known.sum()),
    }
    if not known.any():
        nothing: dict[str, Any] = dict.fromkeys(
            ("mean", "median", "rms", "percentile95", "maximum", "real", "uncertain", "peak_moves", "correlation"),
            float("nan"),
        )
        return Entry(**names, **nothing, phases=(float("nan"), float("nan")))
    both, errors = (
        [
            np.where(known, surfaces[name].sel(scene=scene, model=rung.key, body=step.body), np.nan)
            for rung in (step.first, step.second)
        ]
        for name in ("mu", "error")
    )
    highest = [_phases_at(surfaces, mu + error >= np.nanmax(mu - error)) for mu, error in zip(both, errors)]
    return Entry(
        **names,
        mean=float(step.size[known].mean()),
        median=float(np.median(size[known])),
        rms=float(np.sqrt((size[known] ** 2).mean())),
        percentile95=float(np.percentile(size[known], 95.0)),
        maximum=float(size[known].max()),
        phases=_phases_at(surfaces, size == np.nanmax(size))[0],
        real=float(step.real[known].mean()),
        uncertain=float(np.median(step.uncertainty[known])),
        peak_moves=min(torus_distance(one, other) for one in highest[0] for other in highest[1]),
        correlation=_correlation(both[0][known], both[1][known]),
    )


def _phases_at(surfaces: xr.Dataset, where: NDArray[np.bool_]) -> list[tuple[float, float]]:
    alpha1, alpha2 = surfaces["alpha1"].values, surfaces["alpha2"].values
    return [(float(alpha1[row]), float(alpha2[column])) for row, column in np.argwhere(where)]


def _correlation(one: Array, other: Array) -> float:
    """Pearson's, NaN for a flat surface."""
    a, b = one - one.mean(), other - other.mean()
    scale = float(np.sqrt((a @ a) * (b @ b)))
    return float(a @ b) / scale if scale > 0.0 else float("nan")
