"""The highest point of every surface on the phases that were computed."""

from __future__ import annotations

import numpy as np
import xarray as xr

from comparison.result_types import Number, Phases, result
from comparison.study.models import models_of
from comparison.study.study import Study
from comparison.surfaces.steps import known_mu
from comparison.surfaces.surfaces import asked_of
from reference.problem import Scene


@result
class GridMaximum:
    """The largest value of one surface on the phases that were computed."""

    model: str
    """key of the model"""
    body: int
    """number of the body; 1 is the platform"""
    mu: Number
    """largest value; null without any"""
    error: Number
    """estimated absolute error of it"""
    phases: Phases
    """(alpha1, alpha2), rad; null under a record"""


def grid_maxima(study: Study, surfaces: xr.Dataset, scene: Scene) -> list[GridMaximum]:
    """One per model and body, in this order. Of phase pairs with the same value it is the first."""
    maxima = []
    for model in models_of(scene, study.hierarchy):
        for body in range(1, len(scene.bodies) + 1):
            data = asked_of(surfaces, scene, model).sel(body=body)
            mu, nan = known_mu(data, model), float("nan")
            if not np.isfinite(mu).any():
                maxima.append(GridMaximum(model.key, body, nan, nan, (nan, nan)))
                continue
            row, column = np.unravel_index(np.nanargmax(mu), mu.shape)
            alpha1, alpha2 = (float(data[name][place]) for name, place in (("alpha1", row), ("alpha2", column)))
            phases = (nan, nan) if scene.recorded else (alpha1, alpha2)
            error = float(data["error"].sel(model=model.key)[row, column])
            maxima.append(GridMaximum(model.key, body, float(mu[row, column]), error, phases))
    return maxima
