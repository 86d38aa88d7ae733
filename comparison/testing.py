"""A gate for the tests of users: do the equations and the engine agree about a scene?"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import xarray as xr

from comparison.analysis.differences import pair_step
from comparison.analysis.surfaces import labeled_surfaces
from comparison.study.batches import execute_batch
from comparison.study.models import MODEL_HIERARCHY, Pair, has_spatial_data
from comparison.study.study import Study
from reference.problem import Scene, load_scene
from reference.problem.ranges import Range, checked_number

LIMIT = Range(0.0, 1e6)
PAIRS = {"like_for_like": "like-for-like", "total": "total"}  # names of arguments, and keys of pairs of models


def assert_consistent(
    scene: Scene | str | Path,
    *,
    like_for_like: float | None = None,
    total: float | None = None,
    like_for_like_maximum: float | None = None,
    total_maximum: float | None = None,
    grid: int = 4,
    tolerance: float = 1e-3,
) -> None:
    """
    Raise AssertionError where the equations and the engine differ by more than their errors and a limit.

    Parameters
    ----------
    scene : Scene, str or Path
        A scene, the name of a built-in one, or a scene file.
    like_for_like, like_for_like_maximum : float, optional
        Limits on the relative difference of mu_i with the same geometry and friction law on both sides: on its median
        over the phases, and on its largest value, for each body.
    total, total_maximum : float, optional
        The same for the difference between the paper's printed equations and the most complete engine model.
    grid : int
        Phases per axis.
    tolerance : float
        Relative error asked of the engine.

    Raises
    ------
    AssertionError
        With one line for each limit that is broken: body, phase pair, both values and their errors. Also where no phase
        pair has both values.
    SceneError, ValueError
        For a scene that cannot be used, a limit outside its range, or no limit at all.

    Notes
    -----
    A difference within the two error estimates together counts as zero. Everything is computed in this process. The
    spatial model is computed for the total difference only, if the scene has the data that it needs.

    Examples
    --------
    >>> from comparison.testing import assert_consistent
    >>> assert_consistent("fig4-dry", like_for_like=1e-3, grid=2)
    """
    limits = {
        ("like_for_like", "median"): like_for_like,
        ("like_for_like", "maximum"): like_for_like_maximum,
        ("total", "median"): total,
        ("total", "maximum"): total_maximum,
    }
    stated = {
        place: checked_number("_".join(place).removesuffix("_median"), limit, LIMIT)
        for place, limit in limits.items()
        if limit is not None
    }
    if not stated:
        raise ValueError(
            f"no limit: give one of {', '.join('_'.join(place).removesuffix('_median') for place in limits)}"
        )
    scene = scene if isinstance(scene, Scene) else load_scene(scene)
    compared = {pair for pair, _ in stated}
    hierarchy = [model for model in MODEL_HIERARCHY if "total" in compared or model.applies is not has_spatial_data]
    study = Study((scene,), grid, tolerance, hierarchy)
    batches = study.batches()
    surfaces = labeled_surfaces(study, batches, [execute_batch(batch) for batch in batches])
    pairs = {pair.key: pair for pair in study.pairs(scene)}
    broken = [
        line
        for (name, measure), limit in stated.items()
        for line in _broken(surfaces, scene, pairs.get(PAIRS[name]), name, measure, limit)
    ]
    if broken:
        raise AssertionError("\n".join(broken))


def _broken(
    surfaces: xr.Dataset, scene: Scene, pair: Pair | None, name: str, measure: str, limit: float
) -> Iterator[str]:
    """One line for each body beyond the limit."""
    if pair is None:
        yield f"{scene.name}: {name}: the study has no pair of models for it"
        return
    for body in range(1, len(scene.bodies) + 1):
        step = pair_step(surfaces, scene.name, pair, body)
        size = np.abs(step.size)
        beyond = np.where(size > step.uncertainty, size, 0.0)
        if not step.known.any():
            both = f"{pair.first.title} and {pair.second.title}"
            yield f"{scene.name}, body {body}: {name}: no phase pair has a value by {both}"
            continue
        value = float(np.median(beyond[step.known]) if measure == "median" else beyond[step.known].max())
        if value <= limit:
            continue
        row, column = np.unravel_index(np.nanargmax(np.where(step.known, beyond, np.nan)), beyond.shape)
        at = "under the record" if step.recorded else f"at ({step.alpha1[row]:.4f}, {step.alpha2[column]:.4f}) rad"
        place = {"body": body, "alpha1": step.alpha1[row], "alpha2": step.alpha2[column]}
        values = [
            f"{model.title} {float(found['mu']):.6g} ± {float(found['error']):.1g}"
            for model in (pair.first, pair.second)
            for found in [surfaces.sel(scene=scene.name, model=model.key, **place)]
        ]
        yield (
            f"{scene.name}, body {body}: {name}: {measure} difference {value:.3g}, allowed {limit:g}; "
            f"largest {beyond[row, column]:.3g} {at}: {', '.join(values)}"
        )
