"""
A model that is computed on fewer phases than the study has, completed through the model before it that has them all.

Two neighboring models differ little and smoothly although both surfaces have ridges: the completed surface is the
finer model plus the interpolated difference of the two. A ridge between the computed phases then stands where the finer
model has it. How far the interpolation is off is measured by leaving out each computed phase pair in turn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.analysis.steps import RESOLVED, known_mu
from comparison.analysis.surfaces import common_phases
from comparison.study.models import Model
from comparison.study.study import Study
from reference.problem import Scene
from reference.problem.distribution import fractile

Array = NDArray[np.float64]

MIN_PER_AXIS = 9  # phases per axis: on 8 x 8 or fewer no interpolation can be judged by leaving out points
MAX_ERROR_OF_RELIEF = 0.01  # of the height of the surface: an error that no drawing of it shows


@dataclass(frozen=True)
class Completion:
    """
    One body's surface of one model on all phases of the study, or why there is none.

    The surface may be drawn (`accepted`) where the largest leave-one-out error is at most a hundredth of its height.
    Its difference from the first model may be drawn (`difference_accepted`) where the largest error is at most a fifth
    of that difference, exceeded at 5 % of the phases: the five-fold rule.
    """

    scene: str
    model: str  # key of the model that is completed
    through: str  # key of the model before it that has all phases; "" without one
    body: int  # from 1
    computed: int  # phase pairs where both models have a value
    error: float  # largest leave-one-out error of mu; NaN where there is no interpolation
    relative_error: float  # the same, relative to mu of the finer model at the same phase pair
    relief: float  # highest less lowest value of the completed surface
    difference: float  # 95 % of the absolute differences from the first model are below this, relative to its mu
    reason: str  # why the surface may not be drawn, "" where it may
    mu: Array  # (K, K) completed; NaN everywhere without an interpolation, and where the finer model has no value

    @property
    def accepted(self) -> bool:
        """Whether the surface may be drawn as completed."""
        return not self.reason

    @property
    def difference_accepted(self) -> bool:
        """Whether its difference from the first model may be drawn as completed."""
        return self.accepted and RESOLVED * self.relative_error <= self.difference


def completions(study: Study, surfaces: xr.Dataset, scene: Scene) -> list[Completion]:
    """
    A completion for every body of every model that lacks phases of the study, in the order of models and bodies.

    The model before it is the nearest in the hierarchy that is compared and has all phases. A spatial model on 8 x 8
    phases or fewer is listed, too: it is not to be drawn as a surface even where the study has no more.
    """
    if scene.recorded:
        return []
    models, listed = study.compared(scene), []
    for number, model in enumerate(models):
        few = len(study.axis(model)) < MIN_PER_AXIS
        if study.stride(model) == 1 and not (few and model.settings.get("model") == "spatial"):
            continue
        finer = next((before for before in reversed(models[:number]) if study.stride(before) == 1), None)
        for body in range(1, len(scene.bodies) + 1):
            listed.append(_completion(study, surfaces, scene, models[0], finer, model, body))
    return listed


def with_completed(surfaces: xr.Dataset, listed: Sequence[Completion]) -> xr.Dataset:
    """The surfaces with the variable `completed`: mu where a completed surface may be drawn, NaN elsewhere."""
    completed = xr.full_like(surfaces["mu"], np.nan)
    completed.attrs = {"units": "1", "long_name": "mu on all phases, completed through a finer model"}
    for surface in listed:
        completed.loc[{"scene": surface.scene, "model": surface.model, "body": surface.body}] = surface.mu
    return surfaces.assign(completed=completed)


def _completion(
    study: Study, surfaces: xr.Dataset, scene: Scene, first: Model, finer: Model | None, model: Model, body: int
) -> Completion:
    count = len(study.axis(model))

    def refused(reason: str, computed: int) -> Completion:
        nothing, nan = np.full((study.grid, study.grid), np.nan), float("nan")
        through = finer.key if finer else ""
        return Completion(scene.name, model.key, through, body, computed, nan, nan, nan, nan, reason, nothing)

    def mu(model: Model, stride: Model) -> Array:
        return known_mu(common_phases(surfaces, scene.name, [stride.key]).sel(body=body), model)

    values = mu(model, model)
    if finer is None:
        return refused("no model before it has all phases", int(np.isfinite(values).sum()))
    fine, coarse = mu(finer, finer), mu(finer, model)
    gap = values - coarse
    known = np.isfinite(gap)
    if count < MIN_PER_AXIS:
        return refused(f"{count} × {count} phases are too few for a surface", int(known.sum()))
    if known.sum() < MIN_PER_AXIS**2:
        return refused(f"{known.sum()} values are too few for a surface", int(known.sum()))
    phase = 2.0 * np.pi * study.axis(model) / study.grid
    surface = fine + interpolated(gap, phase, 2.0 * np.pi * np.arange(study.grid) / study.grid)
    missed = np.abs(leave_one_out(gap, phase) - gap)
    error, relative = float(np.nanmax(missed)), float(np.nanmax(missed / coarse))
    relief = float(np.nanmax(surface) - np.nanmin(surface))
    base = mu(first, first)
    distance = np.abs(surface - base) / base
    known_distance = distance[np.isfinite(distance)]
    difference = fractile(known_distance, 0.95) if known_distance.size else float("nan")
    reason = ""
    if not error <= MAX_ERROR_OF_RELIEF * relief:
        reason = f"leaving out a phase pair misses it by up to {error:.2g}, the surface is {relief:.2g} high"
    if reason:
        surface = np.full_like(surface, np.nan)
    return Completion(
        scene.name, model.key, finer.key, body, int(known.sum()), error, relative, relief, difference, reason, surface
    )


def torus(phase: Array) -> Array:
    """
    The phase pairs of a square grid as places on a torus in four dimensions, (K^2, 4), alpha2 running fastest.

    A function of these places has the period 2 pi in both phases.
    """
    alpha1, alpha2 = (axis.ravel() for axis in np.meshgrid(phase, phase, indexing="ij"))
    return np.stack([np.cos(alpha1), np.sin(alpha1), np.cos(alpha2), np.sin(alpha2)], axis=1)


def interpolated(values: Array, phase: Array, every: Array) -> Array:
    """
    A function of both phases that is known at some phase pairs, by thin plates.

    Parameters
    ----------
    values : (K, K) array
        At `phase`; NaN where it is not known.
    phase : (K,) array
        The phases of either axis, rad.
    every : (L,) array
        Those at which the values are wanted, rad.

    Returns
    -------
    (L, L) array
    """
    known = np.isfinite(values.ravel())
    wanted = _interpolation(phase.tobytes(), known.tobytes(), every.tobytes()) @ values.ravel()[known]
    return wanted.reshape(len(every), len(every))


def leave_one_out(values: Array, phase: Array) -> Array:
    """
    What the interpolation of all other phase pairs gives at each one.

    Parameters
    ----------
    values : (K, K) array
        A function of both phases; NaN where it is not known.
    phase : (K,) array
        The phases of either axis, rad.

    Returns
    -------
    (K, K) array
        NaN where the value is not known.

    Notes
    -----
    With the inverse B of the interpolation's matrix and its weights c, point i is missed by c_i / B_ii when it alone is
    left out (Rippa, 1999): one matrix serves all points.
    """
    known = np.isfinite(values.ravel())
    inverse = _weights(phase.tobytes(), known.tobytes())[: known.sum()]
    predicted = np.full(values.size, np.nan)
    predicted[known] = values.ravel()[known] - inverse @ values.ravel()[known] / np.diag(inverse)
    return predicted.reshape(values.shape)


@lru_cache(maxsize=4)  # of bodies and scenes with values at the same phase pairs
def _weights(phase: bytes, known: bytes) -> Array:
    """What makes the P + 5 weights of an interpolation, (P + 5, P), from its values at the P known phase pairs."""
    basis = _basis(*[torus(np.frombuffer(phase))[np.frombuffer(known, bool)]] * 2)
    count = len(basis)
    linear = basis[:, count:]
    matrix = np.block([[basis], [linear.T, np.zeros((linear.shape[1],) * 2)]])
    weights: Array = np.linalg.inv(matrix)[:, :count]
    return weights


@lru_cache(maxsize=4)  # likewise
def _interpolation(phase: bytes, known: bytes, every: bytes) -> Array:
    """What makes the values at all pairs of L phases, (L^2, P), from those at the P known phase pairs."""
    centers = torus(np.frombuffer(phase))[np.frombuffer(known, bool)]
    matrix: Array = _basis(torus(np.frombuffer(every)), centers) @ _weights(phase, known)
    return matrix


def _basis(places: Array, centers: Array) -> Array:
    """Thin plates about P centers and a linear part, (M, P + 5), at M places on the torus."""
    squares = np.maximum(4.0 - 2.0 * places @ centers.T, 0.0)  # of the distances: both have the length sqrt(2)
    plates = 0.5 * squares * np.log(np.where(squares > 0.0, squares, 1.0))
    return np.hstack([plates, np.ones((len(places), 1)), places])
