"""How far two models' surfaces lie apart, in numbers: one row per scene, pair of models and body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.ladder import Pair, pairs_of
from comparison.study import Study
from reference.problem import Outcome

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Difference:
    """
    (mu of `second` - mu of `first`) / mu of `first` over the phases where both have a value.

    median, percentile95, maximum: of its absolute value, NaN without any such phase. phases: (alpha1, alpha2) of the
    maximum, rad. beyond_error: share of these phases where it exceeds u_D = sqrt(u_A^2 + u_B^2), the two error
    estimates together. not_ok: phases where either outcome is not ok. unanswered: phases where either has no value.
    """

    scene: str
    pair: str
    first: str
    second: str
    body: int
    median: float
    percentile95: float
    maximum: float
    phases: tuple[float, float]
    beyond_error: float
    not_ok: int
    unanswered: int


def relative_difference(surfaces: xr.Dataset, scene: str, pair: Pair, body: int) -> Array:
    """Signed relative difference over the grid, (alpha1, alpha2), NaN where either model has no value."""
    first, second = (_of(surfaces, "mu", scene, rung.key, body) for rung in (pair.first, pair.second))
    with np.errstate(divide="ignore", invalid="ignore"):
        relative: Array = np.where(first > 0.0, (second - first) / first, np.nan)
    return relative


def differences(study: Study, surfaces: xr.Dataset) -> list[Difference]:
    """Every row of the closing table, in the order scene, body, pair."""
    return [
        _difference(surfaces, scene.name, pair, body)
        for scene in study.scenes
        for body in range(1, len(scene.bodies) + 1)
        for pair in pairs_of(scene, study.ladder)
    ]


def _of(surfaces: xr.Dataset, name: str, scene: str, model: str, body: int) -> Array:
    return np.asarray(surfaces[name].sel(scene=scene, model=model, body=body))


def _difference(surfaces: xr.Dataset, scene: str, pair: Pair, body: int) -> Difference:
    signed = relative_difference(surfaces, scene, pair, body)
    first, second = pair.first.key, pair.second.key
    uncertainty = np.hypot(_of(surfaces, "error", scene, first, body), _of(surfaces, "error", scene, second, body))
    uncertainty = uncertainty / _of(surfaces, "mu", scene, first, body)
    status = surfaces["status"].sel(scene=scene)
    not_ok = (status.sel(model=[first, second]) != Outcome.OK.value).any("model")
    size = np.abs(signed)
    valid = np.isfinite(size)
    median, percentile95, maximum = np.percentile(size[valid], [50, 95, 100]) if valid.any() else [np.nan] * 3
    row, column = np.unravel_index(np.nanargmax(size), size.shape) if valid.any() else (0, 0)
    return Difference(
        scene=scene,
        pair=pair.key,
        first=first,
        second=second,
        body=body,
        median=float(median),
        percentile95=float(percentile95),
        maximum=float(maximum),
        phases=(float(surfaces["alpha1"][row]), float(surfaces["alpha2"][column])),
        beyond_error=float((size[valid] > uncertainty[valid]).mean()) if valid.any() else float("nan"),
        not_ok=int(not_ok.sum()),
        unanswered=int((~valid).sum()),
    )
