"""
Completion of a model's surface that has fewer phases than the study, through the difference to a complete model.

Two neighboring models differ little and smoothly although both surfaces have ridges: the completed surface is the
finer model plus the interpolated difference of the two. A ridge between the computed phases then stands where the finer
model has it. How far the interpolation is off is measured at held-out phase pairs: chosen at random, computed by the
model, and never used in the interpolation. If more than a share s of the phase pairs were off by more than E, the
probability that n held-out ones all stay within E would be at most (1 - s)^n.
"""

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pydantic import Field, computed_field
from scipy.interpolate import RBFInterpolator

from comparison.result_types import Array, Number, Text, result
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task, TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import compute_amplification
from comparison.study.models import Model
from comparison.study.study import Study
from comparison.surfaces.model_difference import RESOLVED_RATIO, drop_unusable_values, usable_mu
from reference.measures.distribution import fractile
from reference.problem import Scene, phase_grid
from reference.problem.phases import phase_axis
from reference.problem.symmetry import indices_of_solved_pairs

Indices = NDArray[np.intp]  # index of each phase pair on the whole grid

MIN_SPATIAL_PER_AXIS = 9  # phases per axis of the spatial model, below which its values are drawn as points
MIN_VALUES = 16  # smallest number of phase pairs from which a surface is interpolated
CONFIDENCE = 0.95  # probability that no larger share of a completed surface than stated is off by more than its error
# Phase pairs held out per model and scene: with CONFIDENCE at most 1 - 0.05^(1/59) = 5 % exceed their largest error.
HELD_OUT_PAIRS = 59
# Largest share of phase pairs of a completed surface that may be off by more than its error: where held-out values are
# too few to show this share, no surface is completed.
MAX_SHARE_BEYOND_ERROR = 0.1
POINTS_PER_TASK = 8  # largest number of held-out phase pairs in one task
CERTIFICATE_VARIABLES = {  # meaning of each variable that surfaces.nc stores with a completed surface
    "error": "largest relative error of `completed` at phase pairs that were computed and not used",
    "share": "at most so many phase pairs are off by more than completed_error, with the confidence of `completed`",
    "held_out": "phase pairs that were computed and not used",
    "model_error": "largest relative error estimate of the model itself at these",
}

# Arguments of a task: scene, model, settings of its amplification, phases (M, 2) in rad
Arguments = tuple[Scene, Model, Mapping[str, object], Array]


@dataclass(frozen=True)
class HeldOut:
    """
    Amplification of a model at the phase pairs that are held out to check an interpolation.

    mu, error: (n, N), n pairs and N bodies, the amplification and its estimated absolute error; NaN without a value.
    """

    mu: Array
    error: Array


@result
class Completion:
    """
    A body's amplification by a model on fewer phases than the study has, interpolated through a model that has all.

    It is the finer model plus the interpolated difference of the two. With the confidence stated at most a share of the
    phase pairs that were not computed is off by more than the error. The completed values are the variable `completed`
    of surfaces.nc.
    """

    scene: Annotated[Text, "name of the scene"]
    model: Annotated[str, "key of the model that is completed"]
    through: Annotated[str, "key of the finer model; empty without one"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    computed: Annotated[int, "phase pairs where both models have a value"]
    held_out: int
    """phase pairs with a value that were chosen at random, computed and not used; 0 where nothing was interpolated"""
    error: Number
    """largest error at the held-out phase pairs, relative to the model's own mu; null where nothing was interpolated"""
    model_error: Annotated[Number, "largest error estimate of the model itself at these, relative"]
    share: Annotated[float, "at most so many of the phase pairs that were not computed are off by more than the error"]
    confidence: Annotated[float, "of this statement"]
    asked: Annotated[float, "largest error with which the surface may be drawn: the tolerance asked of the model"]
    difference: Number
    """95 % of the absolute differences of the completed surface from the first model are below this, relative to it"""
    reason: Annotated[Text, "why the surface may not be drawn; empty where it may"]
    mu: Annotated[Any, Field(exclude=True)] = None
    """(K, K) completed; NaN everywhere where it may not be drawn, and where the finer model has no value"""

    @computed_field  # type: ignore[prop-decorator]
    @property
    def accepted(self) -> bool:
        """Return whether the completed surface may be drawn: its error is at most the asked tolerance."""
        return not self.reason

    @property
    def certificate(self) -> str:
        """Return the error of the completed surface in words."""
        return (
            f"off by at most {100.0 * self.error:.2g} % at {self.held_out} held-out phase pairs, where the model's own "
            f"error is up to {100.0 * self.model_error:.2g} %; with {100.0 * self.confidence:g} % confidence at most "
            f"{100.0 * self.share:.2g} % of the phase pairs between the dots are off by more"
        )

    @computed_field  # type: ignore[prop-decorator]
    @property
    def difference_accepted(self) -> bool:
        """Return whether the difference from the first model may be drawn: it is at least five times the error."""
        return self.accepted and RESOLVED_RATIO * self.error <= self.difference


class CompletedSurfaces(Analysis[dict[tuple[str, str], HeldOut]]):
    """Analysis that computes held-out phase pairs, as a check of each surface that is completed by interpolation."""

    key, stage, level = "completion", "held-out phases", 2
    seconds = 3.5

    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """Return the tasks, each of which computes a few held-out phase pairs."""
        return [task for _, _, tasks in self._list_tasks(study) for task in tasks]

    def collect(
        self, study: Study, surfaces: xr.Dataset | None, results: TaskResults
    ) -> dict[tuple[str, str], HeldOut] | None:
        """Return the held-out values by scene and model, in the order of `choose_held_out`; None if there are none."""
        found = {}
        for scene, model, tasks in self._list_tasks(study):
            if not all(task in results for task in tasks):
                continue  # A coarse level of the study may hold out no phase pairs.
            parts = [results.value(task, _without_value) for task in tasks]
            mu, error = (np.concatenate([getattr(part, name) for part in parts]) for name in ("mu", "error"))
            found[scene.name, model.key] = HeldOut(mu, error)
        return found or None

    def _list_tasks(self, study: Study) -> Iterator[tuple[Scene, Model, list[Task]]]:
        """Yield each scene and model whose surface is completed, with the tasks for its held-out phase pairs."""
        for scene in study.phased:
            for model in study.compared(scene) if study.selection.has("surfaces", scene.name) else ():
                # The spatial model's surface is not smooth enough to be interpolated, as its supports stop one by one.
                lacks = study.stride(model) > 1 and not model.is_spatial and study.points(model) >= MIN_VALUES
                if lacks and _find_finer_model(study, scene, model):
                    phases = phase_grid(study.grid)[choose_held_out(study, scene, model)]
                    about = scene, model, model.arguments(study.tolerance, study.full)
                    parts = [
                        phases[first : first + POINTS_PER_TASK] for first in range(0, len(phases), POINTS_PER_TASK)
                    ]
                    arguments = [(*about, part) for part in parts]
                    yield scene, model, [Task(compute_held_out, each, self.stage, about=scene) for each in arguments]


def compute_held_out(task: Arguments) -> HeldOut:
    """Return the amplification mu of one model at the phase pairs of one task. Runs inside a worker process."""
    scene, model, settings, phases = task
    answer = compute_amplification(scene, model, phases, **settings)
    return HeldOut(np.asarray(answer.mu, float), np.asarray(answer.error, float))


def _without_value(task: Arguments, failed: TaskResult) -> HeldOut:
    """Return NaN at the held-out phase pairs of a task that failed."""
    nothing = np.full((len(task[3]), len(task[0].bodies)), np.nan)
    return HeldOut(nothing, nothing)


def choose_held_out(study: Study, scene: Scene, model: Model) -> Indices:
    """
    Return random phase pairs that the model does not compute, to check the interpolation there.

    They are indices in the flattened grid of all phases, in which alpha2 varies fastest, and the same in every run. No
    two of them are mirror images of each other, and none is of a computed phase pair.
    """
    mirrored = model.symmetric(scene) and not study.full
    same = indices_of_solved_pairs(scene, study.grid) if mirrored else np.arange(study.grid**2)
    candidates = np.setdiff1d(same, same[study.places(model)])
    seed = hashlib.sha256(f"{scene.digest()} {model.key}".encode()).digest()
    chosen: Indices = np.random.default_rng(list(seed)).permutation(candidates)[:HELD_OUT_PAIRS]
    return chosen


def bound_share_beyond_error(held_out: int) -> float:
    """
    Return a bound, with CONFIDENCE, on the share of phase pairs whose error exceeds that of all `held_out` ones.

    >>> round(bound_share_beyond_error(59), 3), bound_share_beyond_error(0)
    (0.05, 1.0)
    """
    return float(1.0 - (1.0 - CONFIDENCE) ** (1.0 / held_out)) if held_out else 1.0


def complete_surfaces(
    study: Study, surfaces: xr.Dataset, scene: Scene, held_out: Mapping[tuple[str, str], HeldOut] | None
) -> list[Completion]:
    """
    Return the completed surfaces of a scene, one for each body and each model that lacks phases of the study.

    The spatial model is listed also if it has all phases of a study with few. A surface that is not completed says why.
    """
    if scene.recorded:
        return []
    listed = []
    for model in study.compared(scene):
        few = len(study.phase_indices(model)) < MIN_SPATIAL_PER_AXIS
        if study.stride(model) > 1 or (few and model.is_spatial):
            finer, unused = _find_finer_model(study, scene, model), (held_out or {}).get((scene.name, model.key))
            for body in range(1, len(scene.bodies) + 1):
                listed.append(_complete_body(study, surfaces, scene, finer, model, body, unused))
    return listed


def add_completed(surfaces: xr.Dataset, listed: Sequence[Completion]) -> xr.Dataset:
    """
    Return `surfaces` with the variable `completed` and those of CERTIFICATE_VARIABLES on its error.

    `completed` is the amplification interpolated to all phases, NaN where that is not accurate enough.
    """
    nothing, meaning = np.full(surfaces["mu"].shape, np.nan), "mu on all phases, completed through a finer model"
    about = {"units": "1", "long_name": meaning, "confidence": CONFIDENCE}
    found = surfaces.assign(completed=(surfaces["mu"].dims, nothing, about))
    for name, meaning in CERTIFICATE_VARIABLES.items():
        dims, empty = ("scene", "model", "body"), nothing[..., 0, 0].copy()
        found[f"completed_{name}"] = dims, empty, {"units": "1", "long_name": meaning}
    for surface in listed:
        place = {"scene": surface.scene, "model": surface.model, "body": surface.body}
        found["completed"].loc[place] = surface.mu
        for name in CERTIFICATE_VARIABLES:
            found[f"completed_{name}"].loc[place] = getattr(surface, name)
    return found


def _find_finer_model(study: Study, scene: Scene, model: Model) -> Model | None:
    """Return the last model before `model`, in the order of added effects, that is computed at every phase, or None."""
    models = study.compared(scene)
    return next((before for before in reversed(models[: models.index(model)]) if study.stride(before) == 1), None)


def _complete_body(
    study: Study,
    surfaces: xr.Dataset,
    scene: Scene,
    finer: Model | None,
    model: Model,
    body: int,
    unused: HeldOut | None,
) -> Completion:
    """
    Return the completed surface of a body by `model`, or the reason why there is none.

    finer: a model with values at all phases, or None. unused: values of `model` at held-out phase pairs, or None.
    """
    asked, nan = model.tolerance(study.tolerance), float("nan")

    def mu(of: Model, on: Model) -> Array:
        """Return the usable amplification mu of a body by model `of` at the phases of model `on`."""
        values: Array = usable_mu(surfaces, scene.name, of, on)[body - 1]
        return values

    gap = mu(model, model) - mu(finer, model) if finer else mu(model, model)
    computed = int(np.isfinite(gap).sum())
    make_completion = partial(
        Completion,
        scene=scene.name,
        model=model.key,
        through=finer.key if finer else "",
        body=body,
        computed=computed,
        confidence=CONFIDENCE,
        asked=asked,
    )

    def refuse(reason: str) -> Completion:
        """Return a completion without a surface, for this reason."""
        nothing = np.full((study.grid, study.grid), nan)
        return make_completion(
            held_out=0, error=nan, model_error=nan, share=1.0, difference=nan, reason=reason, mu=nothing
        )

    if reason := _explain_refusal(study, finer, model, computed, unused):
        return refuse(reason)
    assert finer is not None
    assert unused is not None
    every = phase_axis(study.grid)
    surface = mu(finer, finer) + interpolate_on_phases(gap, every[study.phase_indices(model)], every)
    truth_error = unused.error[:, body - 1]
    truth = drop_unusable_values(unused.mu[:, body - 1], truth_error)
    missed = np.abs(surface.ravel()[choose_held_out(study, scene, model)] - truth) / truth
    checked = np.isfinite(missed)
    held_out = int(checked.sum())
    share = bound_share_beyond_error(held_out)
    if share > MAX_SHARE_BEYOND_ERROR:
        return refuse(f"{held_out} held-out phase pairs with a value are too few")
    error, model_error = float(missed[checked].max()), float((truth_error / truth)[checked].max())
    first = study.compared(scene)[0]
    base = mu(first, first)
    distance = np.abs(surface - base) / base
    known_distance = distance[np.isfinite(distance)]
    difference = fractile(known_distance, 0.95) if known_distance.size else nan
    if not error <= asked:
        off, allowed = f"{100.0 * error:.2g} %", f"{100.0 * asked:.2g} %"
        reason = f"interpolation misses held-out phase pairs by up to {off}, {allowed} asked"
        surface = np.full_like(surface, nan)
    return make_completion(
        held_out=held_out,
        error=error,
        model_error=model_error,
        share=share,
        difference=difference,
        reason=reason,
        mu=surface,
    )


def _explain_refusal(study: Study, finer: Model | None, model: Model, computed: int, unused: HeldOut | None) -> str:
    """
    Return why the difference of a model from a finer one is not interpolated, or "".

    computed: number of phase pairs where both have a value. unused: values at held-out phase pairs, or None.
    """
    count = len(study.phase_indices(model))
    if finer is None:
        return "no model before it has all phases"
    if model.is_spatial and count < MIN_SPATIAL_PER_AXIS:
        return f"{count} × {count} phases are too few for a surface"
    if model.is_spatial:
        return "its supports stop one by one: between the computed phases it is not smooth"
    if computed < MIN_VALUES:
        return f"{computed} values are too few for a surface"
    return "no phase pairs were held out to check an interpolation" if unused is None else ""


def interpolate_on_phases(values: Array, phase: Array, every: Array) -> Array:
    """
    Return values (L, L) at all pairs of the phases `every` (L,), interpolated by thin-plate splines.

    values: (K, K) at all pairs of the phases `phase` (K,), NaN where unknown. Phases are in rad.
    """
    known = np.isfinite(values.ravel())
    made: Array = RBFInterpolator(_map_onto_torus(phase)[known], values.ravel()[known])(_map_onto_torus(every))
    return made.reshape(len(every), len(every))


def _map_onto_torus(phase: Array) -> Array:
    """
    Return (K^2, 4): cosine and sine of alpha1, cosine and sine of alpha2, for every pair of the phases (K,).

    What is interpolated over these coordinates is periodic in both phases.
    """
    alpha1, alpha2 = (axis.ravel() for axis in np.meshgrid(phase, phase, indexing="ij"))
    return np.stack([np.cos(alpha1), np.sin(alpha1), np.cos(alpha2), np.sin(alpha2)], axis=1)
