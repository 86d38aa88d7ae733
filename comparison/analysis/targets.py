"""What `--tolerance` and `--budget` promised, beside what came of it."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from comparison.analysis.surfaces import asked_of
from comparison.study.models import Model
from comparison.study.planning import StudyPlan


def targets_met(plan: StudyPlan, tolerance: float | None, budget: float | None, surfaces: xr.Dataset) -> dict[str, Any]:
    """
    For summary.json and the report. models: share of the points at which the error estimates meet the tolerance, and
    the estimate that 99 % of them do not exceed, relative to mu. A point without a value meets nothing.
    """
    study = plan.study
    models = [model for model in study.hierarchy if any(model.applies(scene) for scene in study.scenes)]
    return {
        "tolerance": tolerance,
        "budget": budget,
        "predicted_seconds": round(plan.compute, 2),
        "seconds": round(float(surfaces["cost"].sum()), 2),
        "predicted_wall": round(plan.wall, 1),
        "left_out": list(plan.omitted),
        "models": [
            {"key": model.key, "title": model.title, "tolerance": study.tolerance, **_met(plan, model, surfaces)}
            for model in models
        ],
    }


def _met(plan: StudyPlan, model: Model, surfaces: xr.Dataset) -> dict[str, Any]:
    study, errors = plan.study, []
    for scene in study.scenes:
        if model.applies(scene):
            data = asked_of(surfaces, scene, model).sel(model=model.key)
            errors.append(np.asarray(data["error"] / data["mu"]).reshape(-1, len(scene.bodies)).max(axis=1))
    every = np.nan_to_num(np.concatenate(errors), nan=np.inf)
    worst = float(np.quantile(every, 0.99, method="higher"))
    return {
        "asked": model.tolerance(study.tolerance),
        "points": len(every),
        "met": float((every <= study.tolerance).mean()),
        "error99": worst if np.isfinite(worst) else None,
    }
