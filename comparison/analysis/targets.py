"""What `--tolerance` and `--budget` promised, beside what came of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from comparison.analysis.stored import finite_or_none
from comparison.analysis.surfaces import asked_of
from comparison.study.models import Model
from comparison.study.planning import StudyPlan
from comparison.study.refinement import EQUATIONS, Step
from comparison.study.study import Study


def targets_met(
    plan: StudyPlan,
    study: Study,
    tolerance: float | None,
    budget: float | None,
    unfinished: Sequence[tuple[Step, float]],
    surfaces: xr.Dataset,
) -> dict[str, Any]:
    """
    For summary.json and the report.

    Parameters
    ----------
    plan : StudyPlan
    study : Study
        What was computed of it.
    tolerance, budget : float or None
        Relative error asked, and s of the whole run.
    unfinished : sequence of tuple
        Steps that the budget did not buy, in their order, and the processor time that is missing, s.
    surfaces : xr.Dataset

    Returns
    -------
    dict
        models: share of the points at which the error estimates meet the tolerance, and the estimate that 99 % of them
        do not exceed, relative to mu. A point without a value meets nothing.
    """
    models = [model for model in study.hierarchy if any(model.applies(scene) for scene in study.scenes)]
    titles = {model.key: model.title for model in plan.study.hierarchy if model.side == "engine"}
    return {
        "tolerance": tolerance,
        "budget": budget,
        "predicted_seconds": round(sum(study.seconds(model) for model in study.hierarchy), 2),
        "seconds": round(float(surfaces["cost"].sum()), 2),
        "left_out": list(plan.omitted),
        "next_steps": [{"what": describe(step, titles), "seconds": round(seconds, 1)} for step, seconds in unfinished],
        "models": [
            {
                "key": model.key,
                "title": model.title,
                "tolerance": study.tolerance,
                "phases_per_axis": len(study.axis(model)) if study.phased else 1,
                **_met(study, model, surfaces),
            }
            for model in models
        ],
    }


def describe(step: Step, titles: dict[str, str]) -> str:
    """What a step gives, for people; titles: of the engine's models by key."""
    if not step.grid:
        return step.key
    return f"{titles.get(step.key, EQUATIONS)}: {step.grid} × {step.grid} phases"


def _met(study: Study, model: Model, surfaces: xr.Dataset) -> dict[str, Any]:
    errors = []
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
        "error99": finite_or_none(worst),
    }
