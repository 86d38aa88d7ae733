"""Models with a known answer, and models that fail in known ways. Workers import them by name.

`full` asks a model for all that a scene does not require: these leave nothing out.
"""

import time
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.analyses.motions.analysis import StoredMotion, choose_places, models_to_show
from comparison.study.models import MODEL_HIERARCHY, Model, applies_to_no_scene
from comparison.study.study import Study
from reference.measures import Demands, Estimate, FloorSpectra
from reference.measures.demand_reader import MOVING_AT_END
from reference.problem import GRAVITY, Amplification, Outcome, Scene, Trajectory

MOST = {"translational": 16, "spatial": 4}  # phases per axis: fewer than those of the real models, for small grids
DEADLY = 2.0 * np.pi * 3 / 4  # alpha1, alpha2 of the one point of a 4 x 4 grid that a failing model fails at


def smooth(
    scene: Scene, phases: NDArray[np.float64], tolerance: float, gap: float = 0.0, full: bool = False, model: str = ""
) -> Amplification:
    """mu_i = (i + 2 + cos a1 + sin a2) (1 + gap), known to `tolerance`."""
    shape = 2.0 + np.cos(phases[:, 0]) + np.sin(phases[:, 1])
    mu = (shape[:, None] + np.arange(1, len(scene.bodies) + 1)) * (1.0 + gap)
    points = len(phases)
    return Amplification(mu, tolerance * mu, np.full(points, "ok"), np.full(points, np.nan), 0.001 * points)


def deadly(phases: NDArray[np.float64]) -> NDArray[np.bool_]:
    return np.isclose(phases, DEADLY).all(axis=1)


def failing_point(scene: Scene, phases: NDArray[np.float64], tolerance: float, full: bool = False) -> Amplification:
    """One point has no answer and says why."""
    answer = smooth(scene, phases, tolerance)
    mu, status = answer.mu.copy(), answer.status.astype("U32")
    mu[deadly(phases)], status[deadly(phases)] = np.nan, Outcome.RIM_REACHED.value
    return replace(answer, mu=mu, status=status)


def silent_nan(scene: Scene, phases: NDArray[np.float64], tolerance: float, full: bool = False) -> Amplification:
    """Calls a point without a number ok."""
    return replace(failing_point(scene, phases, tolerance), status=np.full(len(phases), "ok"))


def raising(scene: Scene, phases: NDArray[np.float64], tolerance: float, full: bool = False) -> Amplification:
    if deadly(phases).any():
        raise RuntimeError("the matrix is singular")
    return smooth(scene, phases, tolerance)


def always_raising(scene: Scene, phases: NDArray[np.float64], tolerance: float, full: bool = False) -> Amplification:
    raise RuntimeError("the matrix is singular")


def misshapen_there(scene: Scene, phases: NDArray[np.float64], tolerance: float, full: bool = False) -> Amplification:
    """Answers a deadly phase with a point too few."""
    answer = smooth(scene, phases, tolerance)
    return replace(answer, mu=answer.mu[:-1]) if deadly(phases).any() else answer


def endless(scene: Scene, phases: NDArray[np.float64], tolerance: float, full: bool = False) -> Amplification:
    while True:
        time.sleep(1.0)


def uneven(scene: Scene, phases: NDArray[np.float64], tolerance: float, full: bool = False) -> Amplification:
    """The later in the grid, the sooner it is done."""
    time.sleep(0.01 * (4.0 * np.pi - float(phases.sum(axis=1).max())) / np.pi)
    return smooth(scene, phases, tolerance)


def nearing(scene: Scene, phases: NDArray[np.float64], tolerance: float, full: bool = False) -> Amplification:
    """Half of the tolerance above the smooth model."""
    return smooth(scene, phases, tolerance, 0.5 * tolerance)


def refused(scene: Scene, phases: NDArray[np.float64], tolerance: float, full: bool = False) -> Amplification:
    """Takes no step at any phase pair."""
    answer = smooth(scene, phases, tolerance)
    nothing, points = np.full_like(answer.mu, np.nan), len(phases)
    return Amplification(nothing, nothing, np.full(points, Outcome.STEP_LIMIT.value), np.zeros(points), 0.0)


def why_refused(scene: Scene, tolerance: float) -> str:
    return "refused before any step: 3 times the work, shorten the duration to 7 s"


def never_refused(scene: Scene, **settings: object) -> str:
    return ""


def says_what_it_is_asked(scene: Scene, **settings: object) -> str:
    return str(settings)


def forbidden(scene: Scene, phases: object, **settings: object) -> Amplification:
    raise AssertionError("nothing should have been computed")


def sliding(
    scene: Scene, phase: object, radius: float, friction: float, mass: float, swing: float = 0.05, status: str = "ok"
) -> Trajectory:
    """Bodies slide to and fro on a sphere of `radius` under the contact force that `mass` and `friction` give."""
    time = np.linspace(0.0, scene.duration, 601)
    angle, rate = swing / radius * np.sin(2.0 * time), 2.0 * swing / radius * np.cos(2.0 * time)
    zero = np.zeros_like(time)
    place = radius * np.stack([np.sin(angle), zero, 1.0 - np.cos(angle)], axis=1)
    velocity = radius * (rate * np.stack([np.cos(angle), zero, np.sin(angle)])).T
    speed = np.linalg.norm(velocity, axis=1)
    normal = np.stack([-np.sin(angle), zero, np.cos(angle)], axis=1)
    force = np.where(time == 0.0, 1.0, 1.0 + 0.1 * np.sin(3.0 * time)) * mass * GRAVITY
    strength = friction * (speed if scene.lubricated else 1.0) * force
    direction = np.divide(velocity, speed[:, None], out=np.zeros_like(velocity), where=speed[:, None] > 0.0)
    total = (force[:, None] * normal - strength[:, None] * direction) / scene.total_mass
    total[:, 2] -= GRAVITY
    bodies = len(scene.bodies)
    spread = [np.repeat(part[:, None, :], bodies, axis=1) for part in (place, velocity, total)]
    return Trajectory(time, *spread, contact_force=force, stick=[], status=status, instant=np.nan, scene=scene)


def known_motions(study: Study, surfaces: xr.Dataset, *rest: object) -> list[StoredMotion]:
    """Circles, (1 + number of the model) cm wide, at every place and by every model the page shows."""
    time = np.linspace(0.0, 20.0, 201)
    found = []
    for scene in study.scenes:
        circle = np.stack([np.cos(time), np.sin(time)], axis=1)[:, None, :].repeat(len(scene.bodies), axis=1)
        for place in choose_places(study, surfaces, scene):
            for number, model in enumerate(models_to_show(study, scene)):
                at, spatial = 0.01 * (1 + number) * circle, model.key == "spatial"
                force = np.full((len(time), 4), 0.25 * scene.total_mass * GRAVITY)
                found.append(StoredMotion(
                    place, model.key, time, at, -at, ((2.0, 3.0),),
                    contact_force=force.sum(axis=1), isolator_force=scene.total_mass * at[:, 0],
                    support_force=force if spatial else np.zeros(0),
                    yaw=0.001 * np.sin(time) if spatial else np.zeros(0),
                    demands=known_demands(scene, spatial), spectra=known_spectra(scene),
                ))  # fmt: skip
    return found


KNOWN = {
    "displacement": 0.15, "cap_share": 0.6, "acceleration": 2.1, "base_shear": 5.2, "drift": 0.037,
    "contact_force_min": 17.0, "contact_force_max": 23.0, "support_force_min": 3.1, "support_force_max": 7.3,
    "torsion": 0.004, "stops": 9.0, "uplift": 0.0013, "support_displacement": 0.19, "friction_energy": 1.7,
}  # fmt: skip


def known_demands(scene: Scene, supported: bool) -> Demands:
    """The numbers are KNOWN, those of bodies each 10 % above the one below; the residual is not known."""

    def one(name: str, body: int = 0) -> Estimate:
        return Estimate(KNOWN[name] * (1.0 + 0.1 * body), 0.01 * KNOWN[name])

    def many(name: str, first: int = 0) -> tuple[Estimate, ...]:
        return tuple(one(name, body) for body in range(len(scene.bodies) - first))

    def of_supports(name: str) -> Estimate | None:
        return one(name) if supported else None

    return Demands(
        Outcome.OK.value, one("displacement"), Estimate(np.nan, np.nan, MOVING_AT_END), one("cap_share"), None,
        many("acceleration"), one("base_shear"), many("drift", 1), one("contact_force_min"), one("contact_force_max"),
        of_supports("support_force_min"), of_supports("support_force_max"), many("torsion") if supported else None,
        one("stops"), of_supports("support_displacement"), of_supports("uplift"), one("friction_energy"),
        None, None if supported else Estimate(0.0, 0.25),
    )  # fmt: skip


def known_spectra(scene: Scene) -> FloorSpectra:
    """By body, direction and period: no two numbers are the same."""
    values = 1.0 + np.arange(4.0 * len(scene.bodies)).reshape(-1, 2, 2)
    return FloorSpectra(np.array([0.1, 1.0]), 0.05, values, 0.01 * values)


def planted(
    scene: Scene, phases: NDArray[np.float64], tolerance: float, gap: float, claimed: float | None = None
) -> Amplification:
    """`gap` above the smooth model, with the relative error `claimed` in place of an honest one."""
    return smooth(scene, phases, tolerance if claimed is None else claimed, gap)


def errors_in(gaps: Mapping[str, float], error_estimates: Mapping[str, float] | None = None) -> tuple[Model, ...]:
    """The real hierarchy: the models named lie `gaps` above the others and state relative errors."""
    every = {"amplification": "fake_models:planted", "symmetric": applies_to_no_scene, "refusal": None}
    models = []
    for model in MODEL_HIERARCHY:
        claimed = (error_estimates or {}).get(model.key, 1e-5)
        settings = {"gap": gaps.get(model.key, 0.0), "claimed": claimed}
        models.append(replace(model, **every, settings=settings, most=MOST.get(model.key)))
    return tuple(models)


def silenced(*keys: str, gap: float = 5e-5) -> tuple[Model, ...]:
    """The fake model hierarchy in which the models named refuse every phase pair."""
    functions = {"amplification": "fake_models:refused", "refusal": "fake_models:why_refused"}
    return tuple(
        replace(model, **functions, settings={}) if model.key in keys else model for model in fake_hierarchy(gap=gap)
    )


def fake_hierarchy(engine: str = "smooth", gap: float = 0.01, batch: int = 4) -> tuple[Model, ...]:
    """The real hierarchy with fake functions, no symmetries: the engine lies `gap` above, or is another model here."""
    models = []
    for model in MODEL_HIERARCHY:
        name = engine if model.side == "engine" else "smooth"
        functions = {"amplification": f"fake_models:{name}", "trajectory": "fake_models:forbidden"}
        functions |= {"refusal": "fake_models:never_refused"} if model.refusal else {}
        settings = {"gap": gap} if (model.side, name) == ("engine", "smooth") else {}
        most = MOST.get(model.key)
        models.append(
            replace(model, **functions, settings=settings, batch=batch, symmetric=applies_to_no_scene, most=most)
        )
    return tuple(models)


def busy(seconds: float) -> str:
    """Compute for so long."""
    while time.process_time() < seconds:
        pass
    return "done"
