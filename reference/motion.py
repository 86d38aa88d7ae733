"""One motion by the paper's equations, sampled in time."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from reference.defaults import DEFAULT_TOLERANCE
from reference.measures.energy import friction_force
from reference.problem import Accuracy, Outcome, Scene, State, Trajectory, ground_acceleration, loading_period
from reference.problem.phases import check_phase
from reference.problem.ranges import check_state
from reference.problem.readings import describe_law
from reference.problem.scene import require_scene
from reference.solver.error_estimate import (
    DIFFERENCE_FRACTION,
    MIN_STEP_TOLERANCE,
    READING_ERROR_FACTOR,
    ROUNDING_ERROR,
    TOLERANCE_RATIO,
    record_run,
)
from reference.solver.samples import SampledMotion, sample_motion, step_instants
from reference.solver.system import Array, RunSettings, StepRecord, System, allocate_record
from reference.support.arguments import check_array
from reference.surface import OUTCOMES, loads_are_finite, prepare_run

SAMPLES_PER_PERIOD = 64  # evenly spaced output instants per loading period (the shorter of the two), by default
STEP_SAMPLES = 8000  # target number of output instants placed in steps of the solver; more if there are many steps
MAX_SAMPLES = 200_000  # largest number of evenly spaced output instants, and of those placed in steps of the solver
# Lower bound on the error of a peak, as a fraction of the tolerance: a closer agreement of two runs is accidental.
# Measured errors reach 0.2 of the tolerance.
MIN_ERROR_FRACTION = 1.0


@require_scene
def trajectory(
    scene: Scene,
    phase: ArrayLike,
    equations: str = "exact",
    regularization: float | None = None,
    tolerance: float = DEFAULT_TOLERANCE,
    rest_condition: str = "consistent",
    times: ArrayLike | None = None,
    initial: State | None = None,
) -> Trajectory:
    """
    Return one motion for one pair of initial phases of the loading by the paper's equations of motion, sampled in time.

    Parameters
    ----------
    scene : Scene
    phase : array_like, (2,), rad
    equations, regularization, rest_condition
        As in `reference.amplification`.
    tolerance : float
        Relative error of the accelerations inside each step; 1e-06 (`DEFAULT_TOLERANCE`) if not given.
    times : array_like, (T,), s, optional
        Rising instants within the duration. By default 64 per shorter loading period, and the solver's own, which are
        closer at stops.
    initial : State, optional
        Displacement and velocity at t = 0 in the plate's frame. By default at rest in the equilibrium position.

    Returns
    -------
    Trajectory
        A motion that ends early has samples up to `instant`, and a status that says why. `stick` holds the intervals of
        rest, or of creep below v_reg. `peak` has the largest accelerations, which the samples miss. `accuracy` has a
        second run with a looser tolerance; where that would end early, the motion itself has a tighter one. `law` names
        the law of friction, which no error covers: `peak` is the literal supremum under the set-valued law.

    Raises
    ------
    ValueError
        For an argument outside its range (`reference.problem.ranges`), in one line.

    Examples
    --------
    >>> import reference
    >>> motion = reference.trajectory(reference.load_scene("fig4-dry"), (2.0, 0.7), equations="small", times=[0.0, 1.5])
    >>> motion.position.shape, motion.status
    ((2, 2, 3), 'ok')
    """
    pair = check_phase(phase)
    system, settings = prepare_run(scene, equations, regularization, tolerance, None, rest_condition)
    asked = None if times is None else _check_times(scene, times)
    bodies = len(scene.bodies)
    x, v = np.zeros((bodies, 2)), np.zeros((bodies, 2))
    if initial is not None:
        x, v = check_state(initial, bodies, system.radius, scene.isolator.travel)
        settings = settings._replace(unit=settings.unit + _initial_acceleration_bound(system, x, v))
    law = describe_law(scene, regularization)
    if not loads_are_finite(system):
        nothing = np.full(bodies, np.nan)
        no_run = _RecordedRun(
            outcome=Outcome.NON_FINITE_LOAD,
            instant=0.0,
            record=allocate_record(0, bodies),
            peak=nothing,
            reading_error=nothing,
            system=system,
        )
        return replace(_sample_trajectory(scene, pair, system, no_run, asked), law=law)
    run = _record_run(system, pair, x, v, settings)
    motion = replace(_sample_trajectory(scene, pair, system, run, asked), law=law)
    if run.outcome != Outcome.OK:
        return motion
    other = _record_run(run.system, pair, x, v, settings._replace(tolerance=TOLERANCE_RATIO * settings.tolerance))
    # If the looser run ended early, as where the platform reached the isolator's rim, a tighter run gives the motion.
    # Its error then follows from the difference to the first run.
    if other.outcome != Outcome.OK:
        tighter = max(settings.tolerance / TOLERANCE_RATIO, MIN_STEP_TOLERANCE)
        run, other = _record_run(run.system, pair, x, v, settings._replace(tolerance=tighter)), run
        motion = replace(_sample_trajectory(scene, pair, system, run, asked), law=law)
        if run.outcome != Outcome.OK:
            return motion
    floor = MIN_ERROR_FRACTION * settings.tolerance + ROUNDING_ERROR
    error = READING_ERROR_FACTOR * run.reading_error + DIFFERENCE_FRACTION * np.abs(run.peak - other.peak)
    coarser = _sample_trajectory(scene, pair, system, other, asked)
    accuracy = Accuracy(
        peak_error=error + floor * run.peak, coarser=(coarser,), share=(DIFFERENCE_FRACTION,), floor=floor
    )
    return replace(motion, accuracy=accuracy)


class _RecordedRun(NamedTuple):
    """One run of the solver: how and when it ended, all its steps, peak accelerations and their errors."""

    outcome: Outcome
    instant: float  # s, time at which the run ended
    record: StepRecord
    peak: Array  # (N,) m/s^2, largest absolute accelerations
    reading_error: Array  # (N,) m/s^2, errors of the peaks from interpolation inside their steps
    system: System  # coefficients of the equations, with friction at the temperatures of this run


def _record_run(system: System, phase: Array, x: Array, v: Array, settings: RunSettings) -> _RecordedRun:
    """Return the run from initial displacements x, m, and velocities v, m/s, (N, 2), with the record of its steps."""
    run, record, system = record_run(x, v, system, phase, settings)
    return _RecordedRun(
        outcome=OUTCOMES[int(run.code[0])],
        instant=float(run.instant[0]),
        record=record,
        peak=run.value[0],
        reading_error=run.error[0],
        system=system,
    )


def _sample_trajectory(
    scene: Scene, phase: Array, system: System, run: _RecordedRun, asked: Array | None
) -> Trajectory:
    """Return the motion of a run at the instants `asked`, or at those of `_default_instants` if `asked` is None."""
    record, early = run.record, run.outcome != Outcome.OK
    steps, sticks = (int(number) for number in record.counts)
    instants = _default_instants(scene, record) if asked is None else asked
    instants = instants[instants <= (run.instant if early else scene.duration)] if steps else instants[:0]
    motion = sample_motion(record, instants)
    height, vz = _vertical_motion(motion.x[:, 0], motion.v[:, 0], system)
    shape = (len(instants), len(scene.bodies), 1)
    position = np.concatenate([motion.x, np.broadcast_to(height[:, None, None], shape)], axis=-1)
    velocity = np.concatenate([motion.v, np.broadcast_to(vz[:, None, None], shape)], axis=-1)
    return Trajectory(
        time=instants,
        position=position,
        velocity=velocity,
        absolute_acceleration=motion.total,
        contact_force=motion.reaction * scene.masses[0],
        stick=[(float(a), float(b)) for a, b in record.sticks[:sticks]],
        status=run.outcome.value,
        instant=run.instant if early else np.nan,
        scene=scene,
        peak=run.peak,
        ground=ground_acceleration(scene, phase, instants),
        friction_power=_friction_power(scene, position[:, 0], velocity[:, 0], motion),
    )


def _friction_power(scene: Scene, place: Array, velocity: Array, motion: SampledMotion) -> Array:
    """Return the power that friction dissipates, (T,), W; place, velocity: (T, 3), m and m/s, of the platform."""
    force = friction_force(scene, place, motion.total, scene.masses[0] * motion.reaction)
    power: Array = -(force * velocity).sum(axis=1)
    return power


def _initial_acceleration_bound(system: System, x: Array, v: Array) -> float:
    """Return an upper bound on the accelerations, m/s^2, that an initial state x, m, and v, m/s, (N, 2), causes."""
    gravity = system.mass_ratio * system.gravity
    links = 2.0 * ((system.below + system.above) * np.abs(x).max()).max()
    links += 2.0 * ((system.damping_below + system.damping_above) * np.abs(v).max()).max()
    return float(gravity * float(np.hypot(*x[0])) / system.radius + (v[0] ** 2).sum() / system.radius + links)


def _default_instants(scene: Scene, record: StepRecord) -> Array:
    """Return the output instants, s: SAMPLES_PER_PERIOD evenly spaced per loading period, and some in each step."""
    samples = int(np.ceil(scene.duration / loading_period(scene) * SAMPLES_PER_PERIOD)) + 1
    even = np.linspace(0.0, scene.duration, min(samples, MAX_SAMPLES))
    return np.union1d(even, step_instants(record, STEP_SAMPLES, MAX_SAMPLES))


def _check_times(scene: Scene, times: ArrayLike) -> Array:
    """Return rising instants (T,), s, within the duration. Raises ValueError with a one-line message for others."""
    rule = f"must be rising instants (T,) from 0 to the duration, {scene.duration} s"
    instants = check_array("times", times, rule)
    inside = instants.ndim == 1 and np.all((instants >= 0.0) & (instants <= scene.duration))
    if not inside or np.any(np.diff(instants) <= 0.0):
        raise ValueError(f"times: {rule}")
    return instants


def _vertical_motion(x: Array, v: Array, system: System) -> tuple[Array, Array]:
    """
    Return the platform's rise, m, and vertical velocity, m/s, each (T,); 0 in the equations for small displacements.

    x, v: (T, 2), m and m/s, its horizontal displacement and velocity.
    """
    if system.small:
        return np.zeros(len(x)), np.zeros(len(x))
    squared = (x**2).sum(axis=-1)
    depth = np.sqrt(system.radius**2 - squared)
    return squared / (system.radius + depth), (x * v).sum(axis=-1) / depth
