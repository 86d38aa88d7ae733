"""What `--tolerance` and `--budget` promised, beside what came of it."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from comparison.analysis.surfaces import common_phases
from comparison.study.models import Rung
from comparison.study.planning import Choice


def kept_promises(
    chosen: Choice, tolerance: float | None, budget: float | None, surfaces: xr.Dataset
) -> dict[str, Any]:
    """
    For summary.json and the report. models: share of the points at which the error estimates meet the tolerance, and
    the estimate that 99 % of them do not exceed, relative to mu. A point without a value meets nothing.
    """
    study = chosen.study
    models = [rung for rung in study.ladder if any(rung.applies(scene) for scene in study.scenes)]
    return {
        "tolerance": tolerance,
        "budget": budget,
        "predicted_seconds": round(chosen.compute, 2),
        "seconds": round(float(surfaces["cost"].sum()), 2),
        "predicted_wall": round(chosen.wall, 1),
        "left_out": list(chosen.left_out),
        "models": [
            {"key": rung.key, "title": rung.title, "tolerance": study.tolerance, **_met(chosen, rung, surfaces)}
            for rung in models
        ],
    }


def _met(chosen: Choice, rung: Rung, surfaces: xr.Dataset) -> dict[str, Any]:
    study, errors = chosen.study, []
    for scene in study.scenes:
        if rung.applies(scene):
            own = common_phases(surfaces, scene.name, [rung.key]).sel(model=rung.key)
            own = own.isel(body=slice(len(scene.bodies)))
            errors.append(np.asarray(own["error"] / own["mu"]).reshape(-1, len(scene.bodies)).max(axis=1))
    every = np.nan_to_num(np.concatenate(errors), nan=np.inf)
    worst = float(np.quantile(every, 0.99, method="higher"))
    return {
        "asked": rung.tolerance(study.tolerance),
        "points": len(every),
        "met": float((every <= study.tolerance).mean()),
        "error99": worst if np.isfinite(worst) else None,
    }
