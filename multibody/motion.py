"""Motion at one phase pair by the engine: to a tolerance, or from a single run without an error estimate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from multibody.defaults import DEFAULT_NEWTON_TOLERANCE, DEFAULT_PENETRATION, DEFAULT_TOLERANCE, DEFAULT_V_REG
from multibody.integration.constant_step import INTEGRATORS, EngineMotion, silence_engine
from multibody.integration.engine_run import Budget, EngineRun
from multibody.integration.level import Level, check_levels
from multibody.integration.one_run import PhasePair
from multibody.integration.peak import PeakReader
from multibody.integration.refine import MAX_WORK, WORK_RANGE, refine
from multibody.models.assembly import assemble
from multibody.models.system import EngineModel
from reference.problem import Accuracy, Outcome, Scene, State, Trajectory, ground_acceleration, ground_peak
from reference.problem.phases import check_phase
from reference.problem.ranges import TOLERANCE_RANGE, check_state
from reference.problem.readings import describe_law
from reference.problem.scene import require_scene
from reference.support.arguments import Range, check_choice, check_number

# Largest number of steps of a single run, whose motion is held in memory.
MAX_STEPS = 1e7
PENETRATION_RANGE = Range(1e-14, 0.1, "of rho")  # allowed penetration of the contact under the weight
NEWTON_RANGE = Range(1e-14, 1.0)  # allowed relative tolerance of the forces in Newton's iteration
RESIDUAL_RANGE = Range(0.0, 1.0, "of the weight")  # allowed absolute tolerance of the forces


@require_scene
def trajectory(
    scene: Scene,
    phase: ArrayLike,
    model: str = "translational",
    regularization: float | None = DEFAULT_V_REG,
    tolerance: float = DEFAULT_TOLERANCE,
    initial: State | None = None,
    max_work: float = MAX_WORK,
    softened: bool = False,
) -> Trajectory:
    """
    Compute the motion against the ground at one pair of loading phases by the engine, peak acceleration to a tolerance.

    Parameters
    ----------
    scene, model, regularization, max_work, softened
        As in `amplification`.
    phase : array_like, shape (2,)
        Initial phases of the two harmonics, rad.
    tolerance : float
        Relative error that is asked of the largest accelerations; 0.001 (`DEFAULT_TOLERANCE`) if not given.
    initial : State, optional
        Displacements (N, 2), m, and velocities (N, 2), m/s, at time zero; at rest without.

    Returns
    -------
    Trajectory
        With T instants: `position`, `velocity` and `absolute_acceleration` (T, N, 3); `contact_force` (T,), N, the sum
        over the supports; `stick`, the intervals in which every support slips slower than v_reg; `peak` (N,), m/s^2;
        `status` and `instant` as in `amplification`. A run that ends early is returned up to there. `accuracy` has
        the run at the level before, and one with a softer contact where that was run.
        `extra` has slip_speed (T, K), m/s, and support_force (T, K), N, of K contacts (one in the translational model).
        The spatial model adds yaw and tilt of the platform (T,), rad; turns (T, N, 3), rad, the angles a, b, c of
        every body, which is turned against the plate by Rx(a) Ry(b) Rz(c); uplift (T, K), m, the gap of every contact,
        zero where it presses; and liftoff (L, 3): support, start and end, s, of every time that a contact is open.

    Raises
    ------
    ValueError
        For wrong arguments.

    Notes
    -----
    The instants are the engine's own, closer at stops. They miss the largest accelerations, which `peak` has. They are
    those of the finest run, as in `amplification`. `law` of the result names the law of friction. Dry friction below
    v_reg is creep: a motion just below the limit of friction slips further than under the set-valued law, and no error
    covers that. A second motion with a smaller v_reg shows it.

    Examples
    --------
    >>> import multibody, reference
    >>> scene = reference.load_scene("fig3-I").with_values({"duration": 1.0})
    >>> multibody.trajectory(scene, (2.0, 0.7)).status == "ok"
    True
    """
    scene = scene.softened() if softened else scene
    checked = check_phase(phase)
    tolerance = check_number("tolerance", tolerance, TOLERANCE_RANGE)
    max_work = check_number("max_work", max_work, WORK_RANGE)
    initial, law = _check_initial(scene, initial), describe_law(scene, regularization)
    with silence_engine():
        built = assemble(scene, model, regularization, contact_force=True)
        pair = PhasePair(scene, built, checked, initial)
        if not np.isfinite(ground_peak(scene, [checked])[0]):
            no_run = EngineRun(peaks=PeakReader(len(built.bodies), built.corner), stop=0.0)
            return replace(_make_trajectory(pair, no_run, Outcome.NON_FINITE_LOAD, 0.0), law=law)
        point = refine(pair, tolerance, keep=True, max_work=max_work)
    motion = replace(_make_trajectory(pair, point.finest, point.outcome, point.instant), law=law)
    if not point.coarser:
        return motion
    coarser = tuple(_make_trajectory(pair, run, run.outcome, np.nan) for run, _ in point.coarser)
    shares = tuple(share for _, share in point.coarser)
    return replace(motion, accuracy=Accuracy(peak_error=point.errors, coarser=coarser, share=shares, floor=point.floor))


@require_scene
def single_run(
    scene: Scene,
    phase: ArrayLike,
    model: str = "translational",
    regularization: float | None = DEFAULT_V_REG,
    *,
    level: Level | None = None,
    step: float | None = None,
    penetration: float = DEFAULT_PENETRATION,
    newton: float = DEFAULT_NEWTON_TOLERANCE,
    residual: float | None = None,
    integrator: str = "generalized alpha",
    discontinuous: float | None = None,
    initial: State | None = None,
) -> Trajectory:
    """
    Run the engine once, at a level of accuracy or at a constant step, without an error estimate.

    Parameters
    ----------
    scene, model, regularization
        As in `amplification`. The model is never reduced.
    phase : array_like, shape (2,)
        Initial phases of the two harmonics, rad.
    level : Level, optional
        Run with adaptive steps at this level of accuracy (`multibody.levels`).
    step : float, optional
        Run with this constant step, s, rounded so that the duration is a whole number of steps. Exactly one of `level`
        and `step` is required. The arguments below belong to `step`.
    penetration : float
        Penetration of the contact under the weight, in units of rho: the inverse of its stiffness. 1e-06
        (`DEFAULT_PENETRATION`) if not given.
    newton : float
        Tolerance of the forces in Newton's iteration, relative to the first residual of a step; 1e-05
        (`DEFAULT_NEWTON_TOLERANCE`) if not given.
    residual : float, optional
        Smallest residual that is asked for, in units of the weight; 1e-3 of `newton` without.
    integrator : {"generalized alpha", "trapezoidal", "RK44", "velocity Verlet"}
        The last two are explicit.
    discontinuous : float, optional
        Tolerance of the engine's iteration over contacts that open or turn within a step; `newton` without. The
        engine's own default is 1, with which it leaves stops less accurate.
    initial : State, optional
        As in `trajectory`.

    Returns
    -------
    Trajectory
        As in `trajectory`. `peak` is read between the samples; it is NaN where the engine gives up. `status` is "ok",
        "rim reached", "travel reached", "contact lost", "overturned", "solver failed" or "step limit".

    Raises
    ------
    ValueError
        For wrong arguments.

    Notes
    -----
    At a constant step the kinks of a recorded motion lie inside the steps. Use a level for such a scene.

    Examples
    --------
    >>> import multibody, reference
    >>> scene = reference.load_scene("fig3-I").with_values({"duration": 1.0})
    >>> len(multibody.single_run(scene, (0.3, 1.1), step=2e-3).time)
    501
    """
    pair = check_phase(phase)
    if (level is None) == (step is None):
        raise ValueError("level, step: give exactly one of the two")
    check_choice("integrator", integrator, INTEGRATORS)
    penetration = check_number("penetration", penetration, PENETRATION_RANGE)
    newton = check_number("newton", newton, NEWTON_RANGE)
    residual = 1e-3 * newton if residual is None else check_number("residual", residual, RESIDUAL_RANGE)
    if discontinuous is not None:
        discontinuous = check_number("discontinuous", discontinuous, NEWTON_RANGE)
    with silence_engine():
        built = assemble(scene, model, regularization, contact_force=True)
        point = PhasePair(scene, built, pair, _check_initial(scene, initial))
        if level is not None:
            [level] = check_levels([level])
            run = point.run_level(level, Budget(MAX_STEPS), keep=True)
        else:
            allowed = Range(scene.duration / MAX_STEPS, scene.duration, "s")
            count = round(scene.duration / check_number("step", step, allowed))
            run = point.run_constant_step(count, penetration, newton, residual, integrator, discontinuous)
    motion = _make_trajectory(point, run, run.outcome, run.instant * built.units.time)
    return replace(motion, law=describe_law(scene, regularization))


def _check_initial(scene: Scene, initial: State | None) -> State | None:
    """Return an initial state whose arrays fit the scene. Raises ValueError for a wrong one."""
    if initial is None:
        return None
    return State(*check_state(initial, len(scene.bodies), scene.radius, scene.isolator.travel))


def _make_trajectory(pair: PhasePair, run: EngineRun, status: str, instant: float) -> Trajectory:
    """Return a run's motion relative to the ground in SI units, with absolute accelerations."""
    model, motion = pair.model, EngineMotion.concatenate(run.chunks) if run.chunks else EngineMotion.empty(pair.model)
    units, bodies = model.units, model.bodies
    time = motion.time * units.time
    ground = ground_acceleration(pair.scene, pair.phase, time)
    # the recorder gives six numbers for each contact: the vector of its force, then its unit normal
    contacts = motion.force.reshape(len(time), motion.force.shape[1] // 6, 2, 3)
    force, normal = contacts[:, :, 0], contacts[:, :, 1]
    normal_force = (force * normal).sum(axis=-1)
    friction = np.linalg.norm(force - normal_force[:, :, None] * normal, axis=-1)
    support_force = np.abs(normal_force) * units.force
    extra = {"slip_speed": motion.slip * units.velocity, "support_force": support_force}
    if model.allows_liftoff:
        extra |= _measure_attitude(model, motion, time) | {"uplift": np.maximum(motion.gap, 0.0) * units.length}
    return Trajectory(
        time=time,
        position=motion.coordinates[:, bodies] * units.length,
        velocity=motion.velocities[:, bodies] * units.velocity,
        absolute_acceleration=motion.accelerations[:, bodies] * units.acceleration + ground[:, None, :],
        contact_force=support_force.sum(axis=1),
        stick=_find_intervals(time, (motion.slip < model.corner).all(axis=1) & np.isfinite(model.corner)),
        status=status,
        instant=instant,
        scene=pair.scene,
        extra=extra,
        peak=run.peaks.value * units.acceleration if len(time) else np.full(len(bodies), np.nan),
        ground=ground,
        friction_power=(friction * motion.slip).sum(axis=1) * units.force * units.velocity,
    )


def _measure_attitude(
    model: EngineModel, motion: EngineMotion, time: NDArray[np.float64]
) -> dict[str, NDArray[np.float64]]:
    """
    Return the rotations of a motion as `Trajectory.extra` holds them, and the times at which supports lift off.

    turns: angles of the bodies, (T, N, 3), rad. yaw, tilt: of the platform, (T,), rad. liftoff: number of the support,
    start and end, s, of every such time, (L, 3).
    """
    turns = motion.coordinates[:, model.bodies + 3]
    roll, pitch, yaw = turns[:, 0].T
    open_at = [
        (float(support), *interval)
        for support, gap in enumerate(motion.gap.T)
        for interval in _find_intervals(time, gap >= 0.0, around=1)
    ]
    # the sine of the tilt is the horizontal part of the platform's own vertical axis
    tilt = np.arcsin(np.hypot(np.sin(pitch), np.sin(roll) * np.cos(pitch)))
    return {"yaw": yaw, "tilt": tilt, "turns": turns, "liftoff": np.array(open_at).reshape(-1, 3)}


def _find_intervals(time: NDArray[np.float64], holds: NDArray[np.bool_], around: int = 0) -> list[tuple[float, float]]:
    """Return start and end of every interval in which `holds` (T,) is true, widened by `around` instants each way."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], holds.astype(int), [0]])))
    last = len(time) - 1
    return [
        (float(time[max(begin - around, 0)]), float(time[min(end - 1 + around, last)]))
        for begin, end in edges.reshape(-1, 2)
    ]
