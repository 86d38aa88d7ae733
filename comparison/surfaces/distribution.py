"""mu of every model as a random variable over uniform phases, from the phase pairs that were computed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from comparison.study.models import models_of
from comparison.study.study import Study
from comparison.surfaces.steps import known_mu
from comparison.surfaces.surfaces import asked_of
from reference.measures import Estimate, phase_distribution
from reference.measures.distribution import FRACTILES, fractile
from reference.problem import Scene

CURVE = np.linspace(0.01, 0.99, 50)  # probabilities of the drawn curve


@dataclass(frozen=True)
class Fractile:
    """The value that mu stays below with a probability."""

    probability: float
    value: float
    error: float


@dataclass(frozen=True)
class Distribution:
    """The distribution of one model and body."""

    model: str  # key
    body: int  # from 1
    points: int  # phase pairs
    unknown: float  # share of them without an answer
    mean: Estimate
    fractiles: tuple[Fractile, ...]
    curve: tuple[float, ...]  # mu at the probabilities CURVE


def distributions(study: Study, surfaces: xr.Dataset, scene: Scene) -> list[Distribution]:
    """
    One for each model and body with an answer, in this order.

    scene: with phases.
    """
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
            listed.append(Distribution(model.key, body, taken.points, taken.unknown, taken.mean, fractiles, curve))
    return listed
