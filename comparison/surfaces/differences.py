"""How far two models' surfaces lie apart, in numbers: one row per scene, pair of models and body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.study.models import Pair
from comparison.study.study import Study
from comparison.surfaces.budget import known_to_all, steps
from comparison.surfaces.steps import Step, step
from comparison.surfaces.surfaces import common_phases
from reference.problem import Outcome
from reference.problem.distribution import fractile

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Difference:
    """
    (mu of `second` - mu of `first`) / mu of `first` over the phases where both have a value.

    mean, spread: of its signed value over the phases where every model of the scene has one, as in the waterfall, or
    both models where the second is a user's engine; the spread is the standard deviation. median, percentile95,
    maximum: of its absolute value. All are NaN without any such phase. phases: (alpha1, alpha2) of the maximum, rad.
    beyond_error: share of these phases where it exceeds u_D = sqrt(u_A^2 + u_B^2), the two error estimates together,
    NaN where a model states no error. ratio: largest |D| / u_D, NaN where any error is missing. asked: phases that both
    models were asked for; not_ok: those of them where either outcome is not ok; unanswered: where either has no value.
    """

    scene: str
    pair: str
    first: str
    second: str
    body: int
    mean: float
    spread: float
    median: float
    percentile95: float
    maximum: float
    phases: tuple[float, float]
    beyond_error: float
    ratio: float
    asked: int
    not_ok: int
    unanswered: int


def pair_step(surfaces: xr.Dataset, scene: str, pair: Pair, body: int) -> Step:
    """The pair's difference, signed and relative to its first model, at the phases both were asked for."""
    return step(surfaces, scene, pair.key, pair.first, pair.second, body, per=pair.first)


def differences(study: Study, surfaces: xr.Dataset) -> list[Difference]:
    """Every row of the closing table, in the order scene, body, pair."""
    return [
        _difference(study, surfaces, scene.name, pair, body)
        for scene in study.scenes
        for body in range(1, len(scene.bodies) + 1)
        for pair in study.pairs(scene)
    ]


def _difference(study: Study, surfaces: xr.Dataset, scene: str, pair: Pair, body: int) -> Difference:
    signed = pair_step(surfaces, scene, pair, body)
    hierarchy = [] if pair.second.side == "entered" else steps(study, surfaces, scene, body)
    stride, common = known_to_all([*hierarchy, signed])
    mean, spread = signed.mean(common, stride)
    status = common_phases(surfaces, scene, [pair.first.key, pair.second.key])["status"]
    not_ok = (status.sel(model=[pair.first.key, pair.second.key]) != Outcome.OK.value).any("model")
    valid = signed.known
    size = np.abs(signed.size[valid])
    stated = valid & np.isfinite(signed.uncertainty)
    median, percentile95, maximum = (fractile(size, p) if size.size else np.nan for p in (0.5, 0.95, 1.0))
    return Difference(
        scene=scene,
        pair=pair.key,
        first=pair.first.key,
        second=pair.second.key,
        body=body,
        mean=mean,
        spread=spread,
        median=float(median),
        percentile95=float(percentile95),
        maximum=float(maximum),
        phases=signed.phases,
        beyond_error=float((np.abs(signed.size) > signed.uncertainty)[stated].mean()) if stated.any() else float("nan"),
        ratio=float(signed.ratio[valid].max()) if valid.any() and (stated == valid).all() else float("nan"),
        asked=valid.size,
        not_ok=int(not_ok.sum()),
        unanswered=int((~valid).sum()),
    )
