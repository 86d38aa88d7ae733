"""
Results of a family of scenes over the value in which the scenes differ.

They are the amplification by every model, its change from model to model (the bars of a waterfall), and the demands.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated

import numpy as np
import xarray as xr

from comparison.result_types import Number, result
from comparison.study.models import Model, models_of
from comparison.study.study import Study
from comparison.surfaces.budget import TOTAL
from comparison.surfaces.model_difference import usable_mu
from comparison.surfaces.surfaces import select_values
from comparison.surfaces.waterfall import NAN, Waterfall, WaterfallBar
from reference.measures.peak_demands import list_demands
from reference.problem import Family, Scene

if TYPE_CHECKING:  # for annotations only; a study may lack these features
    from comparison.analyses.demands.analysis import DemandStatistics
    from comparison.analyses.motions.analysis import StoredMotion


@result
class FamilyCurve:
    """Amplification of a body by one model, a number for each scene of a family in their order; null if unknown."""

    model: Annotated[str, "key of the model"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    mean: tuple[Number, ...]
    """mean over the phase pairs that have a value, or the value under the record, one for each scene"""
    lowest: Annotated[tuple[Number, ...], "smallest over the phase pairs"]
    highest: Annotated[tuple[Number, ...], "largest over the phase pairs"]
    error: Annotated[tuple[Number, ...], "mean of the estimated absolute errors"]


@result
class FamilyStep:
    """Change of a body's amplification from one model to the next, which is a waterfall's bar, by scene of a family."""

    model: Annotated[str, "key of the model that the step leads to, or total"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    size: Annotated[tuple[Number, ...], "signed size, one for each scene"]
    error: Annotated[tuple[Number, ...], "error estimate of it"]
    resolved: Annotated[tuple[bool, ...], "whether it exceeds the sampling error, and five times the numerical one"]


def compute_family_curves(study: Study, surfaces: xr.Dataset, family: Family) -> list[FamilyCurve]:
    """Return one curve of amplification per model and body; under a record, mean, lowest and highest are equal."""
    keys = {model.key: model for scene in family.scenes for model in models_of(scene, study.hierarchy)}
    curves = []
    for model in keys.values():
        for body in range(1, family.bodies + 1):
            rows = (_numbers_of_body(surfaces, scene, model, body) for scene in family.scenes)
            mean, lowest, highest, error = zip(*rows)
            curves.append(
                FamilyCurve(model=model.key, body=body, mean=mean, lowest=lowest, highest=highest, error=error)
            )
    return curves


def list_family_steps(family: Family, waterfalls: Mapping[str, Sequence[Waterfall]]) -> list[FamilyStep]:
    """Return for each body its changes of amplification from model to model, then the total change."""
    steps = []
    for body in range(1, family.bodies + 1):
        bars = [_bars_by_effect(waterfalls[scene.name][body - 1]) for scene in family.scenes]
        keys = list(dict.fromkeys(key for scene in bars for key in scene if key != TOTAL))
        for key in (*keys, TOTAL):
            column = [scene.get(key, WaterfallBar(key, NAN, NAN, resolved=False)) for scene in bars]
            steps.append(
                FamilyStep(
                    model=key,
                    body=body,
                    size=tuple(bar.size for bar in column),
                    error=tuple(bar.error for bar in column),
                    resolved=tuple(bar.resolved for bar in column),
                )
            )
    return steps


@result
class FamilyDemand:
    """A demand by one model in each scene of a family: median, smallest and largest value over motions or phases."""

    model: Annotated[str, "key of the model"]
    quantity: Annotated[str, "key in `demands` of a scene, with the unit stated there"]
    body: Annotated[int, "number of the body; 0 where the demand is of the isolator"]
    median: Annotated[tuple[Number, ...], "median over the motions that have the demand, by scene; null without any"]
    lowest: Annotated[tuple[Number, ...], "smallest of them"]
    highest: Annotated[tuple[Number, ...], "largest of them"]
    motions: Annotated[tuple[int, ...], "how many motions have the demand"]


def list_family_demands(family: Family, motions: Sequence[StoredMotion]) -> list[FamilyDemand]:
    """Return the demands of a family's stored motions, one for each model, quantity and body."""
    numbers: dict[tuple[str, str, int], dict[str, list[float]]] = {}
    for motion in motions:
        if motion.demands is not None and motion.place.scene in {scene.name for scene in family.scenes}:
            for quantity, body, estimate in list_demands(motion.demands):
                if math.isfinite(estimate.value):
                    column = numbers.setdefault((motion.model, quantity, body), {})
                    column.setdefault(motion.place.scene, []).append(estimate.value)
    return [
        _make_family_demand(
            family, key, {name: (float(np.median(row)), min(row), max(row), len(row)) for name, row in rows.items()}
        )
        for key, rows in numbers.items()
    ]


def list_family_demands_over_phases(
    family: Family, statistics: Mapping[str, Sequence[DemandStatistics]]
) -> list[FamilyDemand]:
    """Return the demands of a family over all phases, one for each model, quantity and body."""
    found: dict[tuple[str, str, int], dict[str, tuple[float, float, float, int]]] = {}
    for scene in family.scenes:
        for row in statistics.get(scene.name, ()):
            known = round(row.points * (1.0 - row.unknown))
            numbers = row.fractile(0.5), row.lowest.value, row.highest.value, known
            found.setdefault((row.model, row.quantity, row.body), {})[scene.name] = numbers
    return [_make_family_demand(family, key, rows) for key, rows in found.items()]


def _make_family_demand(
    family: Family, key: tuple[str, str, int], rows: Mapping[str, tuple[float, float, float, int]]
) -> FamilyDemand:
    """
    Return a demand in each scene of a family.

    key: model, quantity and body. rows: by name of the scene, the median, lowest and highest value and their count.
    """
    model, quantity, body = key
    median, lowest, highest, motions = zip(*(rows.get(scene.name, (NAN, NAN, NAN, 0)) for scene in family.scenes))
    return FamilyDemand(
        model=model,
        quantity=quantity,
        body=body,
        median=median,
        lowest=lowest,
        highest=highest,
        motions=motions,
    )


def _bars_by_effect(waterfall: Waterfall) -> dict[str, WaterfallBar]:
    """Return the bars of a waterfall, its changes from model to model, by the key of the later model or TOTAL."""
    return {**{bar.model: bar for bar in waterfall.bars}, TOTAL: waterfall.total}


def _numbers_of_body(surfaces: xr.Dataset, scene: Scene, model: Model, body: int) -> tuple[float, float, float, float]:
    """Return the mean, smallest and largest amplification of a body over the phases, and its mean error; or NaN."""
    mu = usable_mu(surfaces, scene.name, model)[body - 1]
    known = np.isfinite(mu)
    if not known.any():
        return NAN, NAN, NAN, NAN
    error = select_values(surfaces, "error", scene.name, model)[body - 1][known]
    return float(mu[known].mean()), float(mu[known].min()), float(mu[known].max()), float(error.mean())
