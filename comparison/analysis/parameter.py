"""A family of scenes in which one value runs: mu of every model, and every bar of the waterfalls, over that value."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from comparison.analysis.budget import TOTAL
from comparison.analysis.steps import known_mu
from comparison.analysis.surfaces import common_phases
from comparison.analysis.waterfall import NAN, Waterfall, WaterfallBar
from comparison.study.models import Model, models_of
from comparison.study.study import Study
from reference.problem import Family, Scene


@dataclass(frozen=True)
class FamilyCurve:
    """mu of one model and body over the value that runs, one number for each scene; NaN without a value."""

    model: str  # key
    body: int  # from 1
    mean: tuple[float, ...]  # over the phase pairs that have a value
    lowest: tuple[float, ...]
    highest: tuple[float, ...]
    error: tuple[float, ...]  # mean of the estimated absolute errors


@dataclass(frozen=True)
class FamilyStep:
    """One bar of the waterfalls of a body over the value that runs, one number for each scene."""

    model: str  # key of the model that the step leads to, or "total"
    body: int  # from 1
    size: tuple[float, ...]  # signed, relative to mu of the first model; NaN where a scene does not have the step
    error: tuple[float, ...]
    real: tuple[bool, ...]


def family_curves(study: Study, surfaces: xr.Dataset, family: Family) -> list[FamilyCurve]:
    """One per model and body. A record has one value, which is mean, lowest and highest."""
    keys = {model.key: model for scene in family.scenes for model in models_of(scene, study.hierarchy)}
    curves = []
    for model in keys.values():
        for body in range(1, family.bodies + 1):
            columns = zip(*(_numbers(surfaces, scene, model, body) for scene in family.scenes))
            mean, lowest, highest, error = map(tuple, columns)
            curves.append(FamilyCurve(model.key, body, mean, lowest, highest, error))
    return curves


def family_steps(family: Family, waterfalls: Mapping[str, Sequence[Waterfall]]) -> list[FamilyStep]:
    """
    One per bar and body, then the total of the body.

    Parameters
    ----------
    waterfalls : mapping of str to sequence of Waterfall
        By name of the scene, one per body.
    """
    steps = []
    for body in range(1, family.bodies + 1):
        bars = [_bars(waterfalls[scene.name][body - 1]) for scene in family.scenes]
        keys = list(dict.fromkeys(key for scene in bars for key in scene if key != TOTAL))
        for key in (*keys, TOTAL):
            column = [scene.get(key, WaterfallBar(key, NAN, NAN)) for scene in bars]
            sizes, errors = tuple(bar.size for bar in column), tuple(bar.error for bar in column)
            steps.append(FamilyStep(key, body, sizes, errors, tuple(bar.real for bar in column)))
    return steps


def _bars(waterfall: Waterfall) -> dict[str, WaterfallBar]:
    return {**{bar.model: bar for bar in waterfall.bars}, TOTAL: waterfall.total}


def _numbers(surfaces: xr.Dataset, scene: Scene, model: Model, body: int) -> tuple[float, float, float, float]:
    data = common_phases(surfaces, scene.name, [model.key]).sel(body=body)
    mu = known_mu(data, model)
    known = np.isfinite(mu)
    if not known.any():
        return NAN, NAN, NAN, NAN
    error = np.asarray(data["error"].sel(model=model.key), float)[known]
    return float(mu[known].mean()), float(mu[known].min()), float(mu[known].max()), float(error.mean())
