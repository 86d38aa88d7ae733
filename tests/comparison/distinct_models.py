"""
A study in which no two numbers are the same: every model, body, phase pair, statistic and sign can be told apart.

mu of the first model and the relative differences of the others are closed forms; `differences_of` gives them to tests,
which make every statistic of them with NumPy alone. `lacking` are the same models with gaps.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from fake_models import known_motions
from numpy.typing import NDArray

from comparison.analyses.motions.analysis import StoredMotion
from comparison.study.models import MODEL_HIERARCHY, Model, applies_to_no_scene
from comparison.study.study import Study
from reference.measures import Estimate
from reference.measures.peak_demands import PER_BODY, QUANTITIES
from reference.problem import Amplification, Outcome, Scene

Array = NDArray[np.float64]

MOST = {"translational": 4, "spatial": 4}  # phases per axis
# of each model: mean step and swing over the phases of the platform, the same of body 2, share of mu of the error
STEPS = {
    "small": (0.0, 0.0, 0.0, 0.0, 1.1e-5),
    "exact": (0.033, 0.010, -0.0077, 0.0027, 1.7e-5),
    "small-resolved": (-0.011, 0.0077, 0.0069, -0.0039, 1.3e-5),
    "resolved": (-0.039, 0.16, 0.0093, -0.0089, 2.3e-5),
    "small-regularised": (0.0096, 0.0024, -0.0017, 0.0055, 2.7e-5),
    "regularised": (-0.0075, 0.0085, -0.0036, 0.0066, 3.1e-5),
    "translational": (0.0022, -0.0019, 0.0011, 0.0047, 7.3e-4),
    "spatial": (-0.076, -0.077, 0.014, 0.024, 1.9e-4),
}
KEYS = tuple(STEPS)
CHAIN = ("small-resolved", "resolved", "regularised", "translational", "spatial")
GRID, COARSE = 8, 4  # phases per axis of the equations, and of the engine


def first_mu(body: int, phases: Array) -> Array:
    """mu of the first model at phases (P, 2); alpha1 and alpha2 are no mirror images."""
    alpha1, alpha2 = phases.T
    mu = 1.3 + 0.9 * body + 0.5 * np.cos(alpha1 - 0.3 * body + 1.4)
    return mu + 0.21 * np.sin(alpha2 + 0.2) + 0.13 * np.cos(2 * alpha2)


def differences_of(key: str, body: int, phases: Array) -> Array:
    """(mu of the model - mu of the first) / mu of the first at phases (P, 2)."""
    total = np.zeros(len(phases))
    for number, name in enumerate(KEYS[: KEYS.index(key) + 1]):
        mean, swing = STEPS[name][2 * body - 2 : 2 * body]
        shape = np.cos(phases[:, 0] + 0.7 * number) + 0.6 * np.sin(phases[:, 1] - 0.4 * number + body)
        shape += 0.45 * np.cos(phases[:, 0] - 2.0 * phases[:, 1] + number)
        total += mean + swing * (shape + 0.2 * shape**2)  # as many above the mean as below it would make it the median
    return total


def grid_phases(count: int) -> Array:
    """Phase pairs (count^2, 2) of a grid, alpha2 running fastest."""
    axis = 2.0 * np.pi * np.arange(count) / count
    return np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)


def distinct(scene: Scene, phases: Array, tolerance: float, key: str) -> Amplification:
    """The model as a study calls it."""
    bodies = range(1, len(scene.bodies) + 1)
    share = scene.friction_coefficient / 0.1  # of fig3-I: members of a family differ
    mu = np.stack(
        [first_mu(body, phases) * (1.0 + share * differences_of(key, body, phases)) for body in bodies], axis=1
    )
    points = len(phases)
    moved = 0.011 * scene.radius * (1.0 + KEYS.index(key) + 0.3 * np.cos(phases[:, 0] - 0.7)) * share
    return Amplification(
        mu, STEPS[key][-1] * mu, np.full(points, "ok"), np.full(points, np.nan), 0.001 * points,
        displacement=0.01 * (43.0 + KEYS.index(key)) * np.cos(phases[:, 0]) ** 2 if scene.flat else moved,
    )  # fmt: skip


# of a model: the row and column on the grid, and the outcome there
GAPS = {
    "resolved": (1, 2, Outcome.RIM_REACHED),
    "regularised": (4, 6, Outcome.OK),  # with an error of 60 %
    "translational": (2, 4, Outcome.CONTACT_LOST),
}


def lacking(
    scene: Scene, phases: Array, tolerance: float, key: str, full: bool = False, model: str = ""
) -> Amplification:
    """As `distinct`, with gaps; the spatial model fails at a phase pair, the other engine refuses a flat slider."""
    answer = distinct(scene, phases, tolerance, key)
    mu, error, status = answer.mu.copy(), answer.error.copy(), answer.status.astype("U32")
    row, column = np.rint(phases * GRID / (2.0 * np.pi)).astype(int).T
    if key == "spatial" and (row == 6).any():
        raise RuntimeError("the matrix is <singular>")
    if key == "translational":
        status[row == 0] = Outcome.TOLERANCE_NOT_MET
    if key in GAPS:
        *place, outcome = GAPS[key]
        there = (row == place[0]) & (column == place[1])
        status[there], error[there] = outcome, 0.6 * mu[there]
        mu[there & (outcome != Outcome.OK)] = np.nan
    if key == "translational" and scene.flat:
        status[:], mu[:] = Outcome.STEP_LIMIT, np.nan
    moved = answer.displacement * (9.3 if scene.lubricated else 1.0)
    return replace(answer, mu=mu, error=error, status=status, displacement=moved)


def near(scene: Scene, phases: Array) -> tuple[Array, Array]:
    """An engine of a user, off by 1.5 u_D in the platform and by 0.5 u_D in body 2."""
    answer = distinct(scene, phases, 1e-3, "regularised")
    return answer.mu + np.hypot(answer.error, answer.error) * [1.5, 0.5], answer.error


def why_lacking(scene: Scene, tolerance: float, **settings: object) -> str:
    return "refused before any step: 3 times the work, shorten the duration to 7 s" if scene.flat else ""


def lacking_hierarchy() -> tuple[Model, ...]:
    """The models of `distinct_hierarchy` with gaps; the translational one has every phase."""
    return tuple(
        replace(
            model,
            amplification="distinct_models:lacking",
            refusal="distinct_models:why_lacking" if model.key == "translational" else None,
            settings={"key": model.key, **({"model": "spatial"} if model.key == "spatial" else {})},
            symmetric=model.symmetric if model.key in ("small", "exact") else applies_to_no_scene,
            most={"translational": GRID, "spatial": COARSE}.get(model.key),
            batch=4,
        )
        for model in MODEL_HIERARCHY
    )


def distinct_motions(study: Study, surfaces: xr.Dataset) -> list[StoredMotion]:
    """The known motions with demands and spectra that all differ; one has failed, every second one comes to rest."""

    def scaled(value: Any, factor: float) -> Any:
        if isinstance(value, tuple):
            return tuple(scaled(each, factor) for each in value)
        return replace(value, value=factor * value.value, error=factor * value.error) if value else value

    found = []
    for number, motion in enumerate(known_motions(study, surfaces)):
        factor, demands, spectra = 1.0 + 0.0171 * number + 1e-3 * number**2, motion.demands, motion.spectra
        assert demands is not None
        assert spectra is not None
        values = {name: scaled(value, factor) for name, value in vars(demands).items() if name != "status"}
        if number % 2:
            values["residual"] = Estimate(0.0034 * factor, 0.0002 * factor)
        spectra = replace(spectra, acceleration=factor * spectra.acceleration, error=factor * spectra.error)
        if number == 3:
            none = {"demands": None, "spectra": None, "status": Outcome.SOLVER_FAILED.value}
            found.append(replace(motion, **none, error_message="RuntimeError: it <broke>"))
        else:
            found.append(replace(motion, demands=replace(demands, **values), spectra=spectra))
    return found


def known_demand_surfaces(study: Study, surfaces: xr.Dataset) -> xr.Dataset:
    """Demands of every phase pair of the scenes without a family; the first model lacks one, and one error."""
    names = [scene.name for scene in study.scenes if "[" not in scene.name]
    models, bodies, grid = [model.key for model in study.hierarchy], surfaces["body"].values, study.grid
    axis = surfaces["alpha1"].values
    alpha1, alpha2 = np.meshgrid(axis, axis, indexing="ij")
    variables: dict[str, Any] = {}
    for number, (name, (meaning, unit)) in enumerate(QUANTITIES.items()):
        of_bodies = (*([bodies] if name in PER_BODY else []),)
        dims = ("scene", "model", *(["body"] if of_bodies else []), "alpha1", "alpha2")
        values = np.empty([len(names), len(models), *map(len, of_bodies), grid, grid])
        for index in np.ndindex(values.shape[:-2]):
            scene, model, body = (*index, 0)[:3]
            swing = 0.31 * np.cos(alpha1 - 0.4 * model + body) + 0.17 * np.sin(alpha2 + number)
            swing += 0.05 * np.cos(2.0 * alpha2)
            values[index] = (1.0 + number) * (1.0 + 0.07 * model + 0.33 * body + 0.6 * scene) * (1.0 + swing)
            between = np.arange(grid) % study.stride(study.hierarchy[model]) != 0
            values[index][between] = values[index][:, between] = np.nan
            if models[model] not in ("small", "translational", "spatial")[:: 1 if number % 3 == 0 else 2]:
                values[index] = np.nan
        error = (0.001 + 0.002 * np.cos(alpha1 + 0.5 * alpha2) ** 2) * values
        values[0, 0, ..., 5, 1], error[0, 0, ..., 2, 3] = np.nan, np.nan if number % 2 else 0.1
        variables[name] = dims, values, {"units": unit, "long_name": meaning}
        variables[f"{name}_error"] = dims, error, {"units": unit, "long_name": f"estimated absolute error: {meaning}"}
    variables["status"] = ("scene", "model", "alpha1", "alpha2"), np.full([len(names), len(models), grid, grid], "ok")
    return xr.Dataset(variables, {"scene": names, "model": models, "alpha1": axis, "alpha2": axis, "body": bodies})


def distinct_hierarchy() -> tuple[Model, ...]:
    """The real hierarchy with these models, which leave no phase pair to a symmetry."""
    every = {"amplification": "distinct_models:distinct", "symmetric": applies_to_no_scene, "refusal": None}
    return tuple(
        replace(model, **every, settings={"key": model.key}, most=MOST.get(model.key)) for model in MODEL_HIERARCHY
    )
