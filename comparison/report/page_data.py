"""What the page's script draws: surfaces, where their difference is as large as its uncertainty, motions."""

from __future__ import annotations

import json
from typing import Any

import contourpy
import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.analysis.differences import pair_step
from comparison.analysis.surfaces import common_phases
from comparison.report.findings import Findings
from comparison.report.motion_data import Starts, contact_geometry, places, starts_of
from comparison.study.models import Pair, models_of
from comparison.study.study import Study
from reference.problem import Scene

Array = NDArray[np.float64]


def page_data(found: Findings) -> str:
    """
    JSON that is safe inside a script element; NaN is null.

    grid; strides, titles: by model. scenes, each: duration, s; pairs (first and second model, by pair); mu (by model,
    per body: rows alpha1, columns alpha2); contours (by pair, per body: polylines [[alpha1, alpha2], ...], rad, on
    which |D| = u_D); contact (`contact_geometry`); places (row, column, phases or null under a record, why, and
    motions: model, status, error_message, stick, demands, and where its packed numbers are, see `motion_data`).
    """
    study, surfaces = found.study, found.surfaces
    starts = starts_of(found.motions or [])
    data = {
        "grid": study.grid,
        "strides": study.strides,
        "titles": {model.key: model.title for model in study.hierarchy},
        "scenes": [_scene(found, scene, surfaces, starts) for scene in study.scenes],
    }
    return json.dumps(data, allow_nan=False).replace("<", "\\u003c")


def crossings(size: Array, uncertainty: Array, phase: Array) -> list[list[list[float]]]:
    """Where |size| = uncertainty on the closed square, both (alpha1, alpha2): polylines of phases, rad."""
    over = np.pad(np.abs(size) - uncertainty, ((0, 1), (0, 1)), mode="wrap")
    axis = np.append(phase, 2.0 * np.pi)
    lines = contourpy.contour_generator(axis, axis, np.ma.masked_invalid(over.T)).lines(0.0)
    return [np.round(np.asarray(line), 4).tolist() for line in lines]


def _scene(found: Findings, scene: Scene, surfaces: xr.Dataset, starts: Starts) -> dict[str, Any]:
    study: Study = found.study
    bodies = range(1, len(scene.bodies) + 1)

    def contours(pair: Pair, body: int) -> list[list[list[float]]]:
        if scene.recorded:
            return []
        step = pair_step(surfaces, scene.name, pair, body)
        return crossings(step.size, step.uncertainty, step.alpha1)

    def listed(model: str, body: int) -> list[list[float | None]]:
        mu = common_phases(surfaces, scene.name, [model])["mu"].sel(model=model, body=body).values
        return [[float(f"{value:.7g}") if np.isfinite(value) else None for value in row] for row in mu]

    pairs = study.pairs(scene)
    return {
        "duration": scene.duration,
        "pairs": {pair.key: [pair.first.key, pair.second.key] for pair in pairs},
        "mu": {model.key: [listed(model.key, body) for body in bodies] for model in models_of(scene, study.hierarchy)},
        "contours": {pair.key: [contours(pair, body) for body in bodies] for pair in pairs},
        "contact": contact_geometry(scene),
        "places": list(places(found, scene, starts)),
    }
