"""Distribution of the amplification mu by model over uniform phases, and its maximum on the phases computed."""

from collections.abc import Iterator, Sequence
from typing import Annotated

import numpy as np
import xarray as xr

from comparison.result_types import Array, Number, Phases, UncertainNumber, result
from comparison.study.models import Model
from comparison.surfaces.model_difference import usable_mu
from comparison.surfaces.surfaces import find_common_stride, select_values
from reference.measures import phase_distribution
from reference.measures.distribution import FRACTILES, fractile
from reference.problem import Scene

CURVE_PROBABILITIES = np.linspace(0.01, 0.99, 50)  # probabilities at which a distribution is drawn


@result
class Fractile:
    """The value that the amplification mu stays below with a probability."""

    probability: Annotated[float, "probability"]
    value: Annotated[Number, "fractile of mu"]
    error: Annotated[Number, "estimated absolute error, sampling included; null where it is not known"]


@result
class Distribution:
    """Amplification mu of one model and body over phases that are independent and uniform."""

    model: Annotated[str, "key of the model"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    points: Annotated[int, "phase pairs that it was taken from"]
    unknown: Annotated[float, "share of them without an answer"]
    mean: Annotated[UncertainNumber, "mean over all phases; its error includes that of sampling"]
    fractiles: Annotated[tuple[Fractile, ...], "by rising probability"]
    curve: Annotated[tuple[Number, ...], "mu at 50 probabilities from 0.01 to 0.99"]


@result
class GridMaximum:
    """The largest value of one surface on the phases that were computed."""

    model: Annotated[str, "key of the model"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    mu: Annotated[Number, "largest value; null without any"]
    error: Annotated[Number, "estimated absolute error of it"]
    phases: Annotated[Phases, "(alpha1, alpha2), rad; null under a record"]


def compute_distributions(surfaces: xr.Dataset, scene: Scene, models: Sequence[Model]) -> list[Distribution]:
    """Return the distribution of the amplification for each model and body that has values, in this order."""
    listed = []
    for model, body, mu, error in _usable_values(surfaces, scene, models):
        known = mu[np.isfinite(mu)]
        if known.size:
            taken = phase_distribution(mu, error)
            fractiles = tuple(Fractile(p, each.value, each.error) for p, each in zip(FRACTILES, taken.fractiles))
            curve = tuple(fractile(known, p) for p in CURVE_PROBABILITIES)
            mean = UncertainNumber.model_validate(taken.mean)
            listed.append(
                Distribution(
                    model=model.key,
                    body=body,
                    points=taken.points,
                    unknown=taken.unknown,
                    mean=mean,
                    fractiles=fractiles,
                    curve=curve,
                )
            )
    return listed


def find_grid_maxima(surfaces: xr.Dataset, scene: Scene, models: Sequence[Model]) -> list[GridMaximum]:
    """Return the largest amplification of each model and body, in this order; of equal ones the first phase pair."""
    maxima, nan = [], float("nan")
    for model, body, mu, error in _usable_values(surfaces, scene, models):
        if not np.isfinite(mu).any():
            maxima.append(GridMaximum(model=model.key, body=body, mu=nan, error=nan, phases=(nan, nan)))
            continue
        row, column = np.unravel_index(np.nanargmax(mu), mu.shape)
        phase = surfaces["alpha1"].values[:: find_common_stride(surfaces, scene.name, model)]
        phases = (nan, nan) if scene.recorded else (float(phase[row]), float(phase[column]))
        maxima.append(
            GridMaximum(
                model=model.key,
                body=body,
                mu=float(mu[row, column]),
                error=float(error[row, column]),
                phases=phases,
            )
        )
    return maxima


def _usable_values(
    surfaces: xr.Dataset, scene: Scene, models: Sequence[Model]
) -> Iterator[tuple[Model, int, Array, Array]]:
    """Yield for every model and body these two, the usable amplification and its error, both (K, K) over the phases."""
    for model in models:
        of_bodies = zip(usable_mu(surfaces, scene.name, model), select_values(surfaces, "error", scene.name, model))
        for body, (mu, error) in zip(range(1, len(scene.bodies) + 1), of_bodies):
            yield model, body, mu, error
