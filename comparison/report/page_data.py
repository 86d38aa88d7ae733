"""What the page's script draws: surfaces, where their difference is as large as its uncertainty, motions."""

from __future__ import annotations

import base64
import gzip
import json
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any

import contourpy
import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.analysis.differences import pair_step
from comparison.analysis.surfaces import common_phases
from comparison.analysis.trajectories import Place, StoredMotion
from comparison.report.findings import Findings
from comparison.study.models import Pair, models_of
from comparison.study.study import Study
from reference.problem import Scene

Array = NDArray[np.float64]
Starts = dict[tuple[Place, str], int]


def page_data(found: Findings) -> str:
    """
    JSON that is safe inside a script element; NaN is null.

    grid; strides, titles: by model. scenes, each: duration, s; pairs (first and second model, by pair); mu (by model,
    per body: rows alpha1, columns alpha2); contours (by pair, per body: polylines [[alpha1, alpha2], ...], rad, on
    which |D| = u_D); places (row, column, phases or null under a record, why, and motions: model, status, fault, stick,
    start and count of its instants in the packed numbers).
    """
    study, surfaces = found.study, found.surfaces
    starts = _starts(found.motions or [])
    data = {
        "grid": study.grid,
        "strides": study.strides,
        "titles": {model.key: model.title for model in study.hierarchy},
        "scenes": [_scene(found, scene, surfaces, starts) for scene in study.scenes],
    }
    return json.dumps(data, allow_nan=False).replace("<", "\\u003c")


def packed_motions(found: Findings) -> str:
    """Every motion in order, 32-bit numbers: time (T,), position (T, N, 2), acceleration (T, N, 2)."""
    return packed(b"".join(_numbers(motion).tobytes() for motion in found.motions or []))


def packed(content: bytes) -> str:
    """Compressed and written in letters; the browser undoes both."""
    return base64.b64encode(gzip.compress(content, mtime=0)).decode()


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
        "places": list(_places(found, scene, starts)),
    }


def _places(found: Findings, scene: Scene, starts: Starts) -> Iterator[dict[str, Any]]:
    own = [motion for motion in found.motions or [] if motion.place.scene == scene.name]
    alpha1, alpha2 = (np.asarray(found.surfaces[name]) for name in ("alpha1", "alpha2"))
    for place, motions in groupby(own, key=lambda motion: motion.place):
        yield {
            "row": place.row,
            "column": place.column,
            "phases": None if scene.recorded else [float(alpha1[place.row]), float(alpha2[place.column])],
            "why": place.why,
            "motions": [
                {
                    "model": motion.model,
                    "status": motion.status,
                    "error_message": motion.error_message,
                    "stick": [[round(start, 4), round(end, 4)] for start, end in motion.stick],
                    "start": starts[place, motion.model],
                    "count": len(motion.time),
                }
                for motion in motions
            ],
        }


def _numbers(motion: StoredMotion) -> NDArray[np.float32]:
    parts = (motion.time, motion.position, motion.acceleration)
    return np.concatenate([part.ravel() for part in parts]).astype("<f4")


def _starts(motions: Sequence[StoredMotion]) -> Starts:
    """Where the first number of every motion stands among all of them."""
    sizes = [motion.time.size + motion.position.size + motion.acceleration.size for motion in motions]
    keys = [(motion.place, motion.model) for motion in motions]
    return dict(zip(keys, np.concatenate([[0], np.cumsum(sizes)]).astype(int).tolist()))
