"""summary.json: the numbers of a report for programs. VERSION grows when a key changes its meaning or goes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
import xarray as xr

from comparison.differences import Difference
from comparison.ladder import rungs_of
from comparison.study import Study
from reference.problem import Scene

SCHEMA = "phase-resonance/summary"
VERSION = 1


def outcome_counts(surfaces: xr.Dataset, scene: str, model: str) -> dict[str, int]:
    """How many phase pairs ended in each outcome, most frequent first."""
    return dict(Counter(np.asarray(surfaces["status"].sel(scene=scene, model=model)).ravel().tolist()).most_common())


def summary(
    study: Study,
    surfaces: xr.Dataset,
    rows: Sequence[Difference],
    broken: Sequence[str],
    faults: Sequence[str],
    run: Mapping[str, Any],
) -> dict[str, Any]:
    """
    Everything a program needs to judge a run without the report. NaN is written as null.

    schema, version; run (command, times, provenance); grid, tolerance; models (key, title, adds, settings); scenes
    (name, title, digest, models: outcomes and cost in s; differences: one entry per pair and body, see `Difference`);
    broken (acceptance limits, one line each); faults (what solvers complained about).
    """
    return {
        "schema": SCHEMA,
        "version": VERSION,
        "run": dict(run),
        "grid": study.grid,
        "tolerance": study.tolerance,
        "models": [
            {"key": rung.key, "title": rung.title, "adds": rung.adds, "settings": dict(rung.settings)}
            for rung in study.ladder
        ],
        "scenes": [_scene(study, scene, surfaces, rows) for scene in study.scenes],
        "broken": list(broken),
        "faults": list(faults),
    }


def _scene(study: Study, scene: Scene, surfaces: xr.Dataset, rows: Sequence[Difference]) -> dict[str, Any]:
    return {
        "name": scene.name,
        "title": scene.title,
        "digest": scene.digest(),
        "bodies": len(scene.bodies),
        "duration": scene.duration,
        "acceptance": scene.acceptance.model_dump(),
        "models": {
            rung.key: {
                "outcomes": outcome_counts(surfaces, scene.name, rung.key),
                "cost": float(surfaces["cost"].sel(scene=scene.name, model=rung.key)),
            }
            for rung in rungs_of(scene, study.ladder)
        },
        "differences": [_finite(asdict(row)) for row in rows if row.scene == scene.name],
    }


def _finite(entry: dict[str, Any]) -> dict[str, Any]:
    """JSON knows no NaN: null instead."""
    return {key: None if isinstance(value, float) and not np.isfinite(value) else value for key, value in entry.items()}
