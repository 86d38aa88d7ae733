"""mu of every model as a random variable over uniform phases, from the phase pairs that were computed."""

from __future__ import annotations

import numpy as np
import xarray as xr

from comparison.result_types import Number, UncertainNumber, result
from comparison.study.models import models_of
from comparison.study.study import Study
from comparison.surfaces.steps import known_mu
from comparison.surfaces.surfaces import asked_of
from reference.measures import phase_distribution
from reference.measures.distribution import FRACTILES, fractile
from reference.problem import Scene

CURVE = np.linspace(0.01, 0.99, 50)  # probabilities of the drawn curve


@result
class Fractile:
    """The value that mu stays below with a probability."""

    probability: float
    """probability"""
    value: Number
    """fractile of mu"""
    error: Number
    """estimated absolute error, sampling included; null where it is not known"""


@result
class Distribution:
    """mu of one model and body over phases that are independent and uniform."""

    model: str
    """key of the model"""
    body: int
    """number of the body; 1 is the platform"""
    points: int
    """phase pairs that it was taken from"""
    unknown: float
    """share of them without an answer"""
    mean: UncertainNumber
    """mean over all phases; its error includes that of sampling"""
    fractiles: tuple[Fractile, ...]
    """by rising probability"""
    curve: tuple[Number, ...]
    """mu at 50 probabilities from 0.01 to 0.99"""


def distributions(study: Study, surfaces: xr.Dataset, scene: Scene) -> list[Distribution]:
    """One for each model and body with an answer, in this order."""
    listed = []
    for model in models_of(scene, study.hierarchy):
        for body in range(1, len(scene.bodies) + 1):
            data = asked_of(surfaces, scene, model).sel(body=body)
            mu, error = known_mu(data, model), data["error"].sel(model=model.key).values
            known = mu[np.isfinite(mu)]
            if not known.size:
                continue
            taken = phase_distribution(mu, error)
            fractiles = tuple(Fractile(p, each.value, each.error) for p, each in zip(FRACTILES, taken.fractiles))
            curve = tuple(fractile(known, p) for p in CURVE)
            mean = UncertainNumber.model_validate(taken.mean)
            listed.append(Distribution(model.key, body, taken.points, taken.unknown, mean, fractiles, curve))
    return listed
