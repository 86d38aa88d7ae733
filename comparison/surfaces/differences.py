"""How far two models' surfaces lie apart, in numbers: one row per scene, pair of models and body."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.result_types import Number, Phases, Text, result
from comparison.study.models import Pair
from comparison.study.study import Study
from comparison.surfaces.budget import known_to_all, steps
from comparison.surfaces.steps import Step, step
from comparison.surfaces.surfaces import common_phases
from reference.measures.distribution import fractile
from reference.problem import Outcome

Array = NDArray[np.float64]


@result
class Difference:
    """The difference of two models in one body: second minus first, relative to the first."""

    scene: Text
    """name of the scene"""
    pair: str
    """key of the pair: total, translational, like-for-like"""
    first: str
    """key of the first model"""
    second: str
    """key of the second model"""
    body: int
    """number of the body; 1 is the platform"""
    mean: Number
    """mean of the signed size over the phase pairs where every compared model has a value"""
    spread: Number
    """standard deviation of the signed size over the same phase pairs"""
    median: Number
    """median of the absolute size over the phase pairs where both have a value"""
    percentile95: Number
    """95 % of the absolute sizes are below this"""
    maximum: Number
    """largest absolute size"""
    phases: Phases
    """(alpha1, alpha2) of the largest, rad"""
    beyond_error: Number
    """fraction of the phase pairs where it exceeds u_D = sqrt(u_A^2 + u_B^2), the two error estimates together"""
    ratio: Number
    """largest absolute size in units of u_D"""
    asked: int
    """phase pairs that both models were asked for"""
    not_ok: int
    """phase pairs where either outcome is not ok"""
    unanswered: int
    """phase pairs where either has no value"""


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
    hierarchy = [] if pair.second.side == "user" else steps(study, surfaces, scene, body)
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
