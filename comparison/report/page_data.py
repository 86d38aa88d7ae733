"""Data that the page's script draws: surfaces, curves where a difference equals its uncertainty, and motions."""

import base64
import gzip
import json
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import contourpy
import numpy as np

from comparison.report.section import Report
from comparison.result_types import Array
from comparison.runner.attempts import attempt
from comparison.runner.output import print_on_stderr
from comparison.study.models import Model, Pair, label_of, models_of
from comparison.surfaces.completion import Completion
from comparison.surfaces.model_difference import compute_difference
from comparison.surfaces.surfaces import select_values
from reference.problem import Scene

Rows = list[list[float | None]]  # values on the grid of phases: one row for each alpha1, in it one for each alpha2

MU_DIGITS, ERROR_DIGITS = 7, 2  # significant digits on the page of an amplification, and of its error
COMPRESSION_LEVEL = 6  # gzip compression level of the page's data: level 7 takes 1.5 times as long for 2 % less


def collect_page_data(report: Report, say: Callable[[str], object] = print_on_stderr) -> str:
    """
    Return the data that the page draws as JSON text; a feature that raises an error is left out, with a line to `say`.

    grid: phases per axis of the study. titles: by model. scenes, each: name, title, labels (by model, with the reading
    of (5.1)), bodies, duration (s), recorded, flat (whether it is a flat slider); pairs, each: key, title, sentence,
    first, second (models), user (whether the second is an engine of the user), contours (per body: polylines
    [[alpha1, alpha2], ...], rad, on which |D| = u_D), uncertainty (per body: u_D relative to the first model on the
    phases of both, or null where both are surfaces); models (by key: see `_model_data`); and what the `page_data` of
    every feature adds. A surface is a list of rows, one per alpha1, of values, one per alpha2.
    """
    study = report.study
    data = {
        "grid": study.grid,
        "titles": report.results.titles,
        "scenes": [
            {
                "name": scene.name,
                "title": scene.title,
                "labels": {model.key: label_of(model, scene) for model in models_of(scene, study.hierarchy)},
                "bodies": len(scene.bodies),
                "duration": scene.duration,
                "recorded": scene.recorded,
                "flat": scene.flat,
                "pairs": [_pair_data(report, scene, pair) for pair in study.pairs(scene)],
                "models": {model.key: _model_data(report, scene, model) for model in models_of(scene, study.hierarchy)},
                **_collect_feature_data(report, scene, say),
            }
            for scene in study.scenes
        ],
    }
    return _format_json(data)


def _collect_feature_data(report: Report, scene: Scene, say: Callable[[str], object]) -> dict[str, Any]:
    """Return the data of a scene that the features add for the page's script."""
    added: dict[str, Any] = {}
    for feature in report.features:
        if feature.page_data:
            read = partial(_read_encodable, feature.page_data, report, scene)
            added |= attempt(f"data of {feature.key} on the page", read, say) or {}
    return added


def _read_encodable(
    read: Callable[[Report, Scene], Mapping[str, Any]], report: Report, scene: Scene
) -> Mapping[str, Any]:
    """Return a feature's data of a scene; raise an error if JSON cannot hold them, so that no other data are lost."""
    data = read(report, scene)
    _format_json(dict(data))
    return data


def _format_json(data: Any) -> str:
    """Return data as compact JSON text; NaN and infinity raise ValueError."""
    return json.dumps(data, allow_nan=False, separators=(",", ":"))


def compress_to_text(content: bytes) -> str:
    """Return the content compressed by gzip and encoded in Base64; the browser decodes both."""
    return base64.b64encode(gzip.compress(content, COMPRESSION_LEVEL, mtime=0)).decode()


def find_crossings(size: Array, uncertainty: Array, phase: Array) -> list[list[list[float]]]:
    """Return the curves |size| = uncertainty over both phases, 0 to 2 pi, as polylines of (alpha1, alpha2), rad."""
    over = np.pad(np.abs(size) - uncertainty, ((0, 1), (0, 1)), mode="wrap")
    axis = np.append(phase, 2.0 * np.pi)
    lines = contourpy.contour_generator(axis, axis, np.ma.masked_invalid(over.T)).lines(0.0)
    return [np.round(np.asarray(line), 4).tolist() for line in lines]


def _pair_data(report: Report, scene: Scene, pair: Pair) -> dict[str, Any]:
    """
    Return the data of a pair of models that the page draws: their names, and the uncertainty of their difference.

    If both models are drawn as surfaces, it is told for each body by the curves on which |difference| = uncertainty;
    otherwise by its values.
    """
    surfaces = (
        not scene.recorded
        and _is_drawn_as_surface(report, scene, pair.first)
        and _is_drawn_as_surface(report, scene, pair.second)
    )
    steps = [compute_difference(report.surfaces, scene.name, pair, body) for body in range(1, len(scene.bodies) + 1)]
    return {
        "key": pair.key,
        "title": pair.title,
        "sentence": pair.sentence,
        "first": pair.first.key,
        "second": pair.second.key,
        "user": pair.second.side == "user",
        "contours": [find_crossings(step.size, step.uncertainty, step.alpha1) if surfaces else [] for step in steps],
        "uncertainty": None if surfaces else [_round_rows(step.uncertainty, ERROR_DIGITS) for step in steps],
    }


def _is_drawn_as_surface(report: Report, scene: Scene, model: Model) -> bool:
    """Return whether a model's values are drawn as a surface: it has all phases and is no engine of the user."""
    incomplete = any((each.scene, each.model) == (scene.name, model.key) for each in report.completions)
    return model.side != "user" and not incomplete


def _model_data(report: Report, scene: Scene, model: Model) -> dict[str, Any]:
    """
    Return the data of one model of a scene that the page draws.

    phases: number per axis. computed: number of phase pairs that symmetry did not give. surface: whether the values are
    drawn as one. mu, error: by body; the error is null for a surface. completed: by body, see `_completion_data`.
    """
    bodies = range(1, len(scene.bodies) + 1)
    surface = not scene.recorded and _is_drawn_as_surface(report, scene, model)
    place = scene.name, model.key
    completed = {each.body: each for each in report.completions if (each.scene, each.model) == place}

    def list_rows(name: str, digits: int) -> list[Rows]:
        """Return a variable ("mu" or "error") of the model for every body, as rounded rows of numbers."""
        values = select_values(report.surfaces, name, scene.name, model)
        return [_round_rows(values[body - 1], digits) for body in bodies]

    return {
        "phases": len(report.study.phase_indices(model, scene)),
        "computed": len(report.study.solved(scene, model)),
        "surface": surface,
        "mu": list_rows("mu", MU_DIGITS),
        "error": None if surface else list_rows("error", ERROR_DIGITS),
        "completed": [_completion_data(completed.get(body)) for body in bodies],
    }


def _completion_data(completion: Completion | None) -> dict[str, Any] | None:
    """
    Return a surface that is completed between computed phase pairs, or why it is not; None if that was not tried.

    through: model by whose surface it is completed. certificate: how far it is off, in words. reason: why it is not
    drawn. difference: whether its difference from another model may be drawn. mu: null if it is not drawn.
    """
    if completion is None:
        return None
    return {
        "through": completion.through,
        "certificate": completion.certificate if completion.accepted else "",
        "reason": completion.reason,
        "difference": completion.difference_accepted,
        "mu": _round_rows(completion.mu, MU_DIGITS) if completion.accepted else None,
    }


def _round_rows(values: Array, digits: int) -> Rows:
    """Return an array as rows of numbers rounded to `digits` significant digits, with None for NaN."""
    return [[float(f"{value:.{digits}g}") if np.isfinite(value) else None for value in row] for row in values]
