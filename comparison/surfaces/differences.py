"""How far two models' surfaces lie apart, in numbers: one row per scene, pair of models and body."""

from typing import Annotated

import numpy as np
import xarray as xr

from comparison.result_types import Number, result
from comparison.study.models import Pair
from comparison.study.study import Study
from comparison.surfaces.budget import Sizes, known_to_all, sizes, steps
from comparison.surfaces.steps import Step, step
from comparison.surfaces.surfaces import values_of
from reference.problem import Outcome


@result
class Difference(Sizes):
    """The difference of two models in one body: second minus first, relative to the first."""

    pair: Annotated[str, "key of the pair: total, translational, like-for-like"]
    mean: Annotated[Number, "mean of the signed size over the phase pairs where every compared model has a value"]
    spread: Annotated[Number, "standard deviation of the signed size over the same phase pairs"]
    beyond_error: Number
    """fraction of the phase pairs where it exceeds u_D = sqrt(u_A^2 + u_B^2), the two error estimates together"""
    ratio: Annotated[Number, "largest absolute size in units of u_D"]
    not_ok: Annotated[int, "phase pairs where either outcome is not ok"]
    unanswered: Annotated[int, "phase pairs where either has no value"]


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
    both = (pair.first, pair.second), (pair.second, pair.first)
    not_ok = np.any([values_of(surfaces, "status", scene, *each) != Outcome.OK.value for each in both], axis=0)
    valid = signed.known
    stated = valid & np.isfinite(signed.uncertainty)
    return Difference(
        **sizes(scene, signed),
        pair=pair.key,
        mean=mean,
        spread=spread,
        beyond_error=float((np.abs(signed.size) > signed.uncertainty)[stated].mean()) if stated.any() else float("nan"),
        ratio=float(signed.ratio[valid].max()) if valid.any() and (stated == valid).all() else float("nan"),
        not_ok=int(not_ok.sum()),
        unanswered=int((~valid).sum()),
    )
