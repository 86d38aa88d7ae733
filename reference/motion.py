"""One motion by the paper's equations, sampled for plots and tests."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reference.march import march
from reference.problem import Outcome, Scene, State, Trajectory, checked_phases, ground_acceleration
from reference.surface import OUTCOMES, checked_demand, loads_are_finite
from reference.system import TIME, Array, Record, System, workspace

SAMPLES_PER_PERIOD = 64  # of the shorter loading period, when no times are given
MOST_SAMPLES = 200_000
STICKS = 10_000  # intervals of rest that are kept


def trajectory(
    scene: Scene,
    phase: ArrayLike,
    equations: str = "exact",
    regularization: float | None = None,
    tolerance: float = 1e-6,
    rest_condition: str = "consistent",
    times: ArrayLike | None = None,
    initial: State | None = None,
) -> Trajectory:
    """
    One motion for one phase pair (2,), rad, in the plate's frame, from rest or from `initial`.

    equations, regularization, rest_condition: as in `amplification`. tolerance: relative error of the accelerations
    inside each step. times: rising instants (T,), s, within the duration; by default 64 per shorter loading period.
    A motion that ends early (status, instant) has samples up to that instant. `stick` holds the intervals of rest, or
    of creep below v_reg. Raises ValueError for arguments outside these rules.
    """
    pair = checked_phases(np.reshape(np.asarray(phase, float), (1, -1)))[0]
    system, demand = checked_demand(scene, equations, regularization, tolerance, None, rest_condition)
    instants = _checked_times(scene, times)
    bodies = len(scene.bodies)
    count = len(instants)
    record = Record(
        times=instants,
        x=np.full((count, bodies, 2), np.nan),
        v=np.full((count, bodies, 2), np.nan),
        total=np.full((count, bodies, 3), np.nan),
        reaction=np.full(count, np.nan),
        sticks=np.zeros((STICKS, 2)),
        count=np.zeros(2, np.int64),
    )
    work = workspace(bodies)
    if initial is not None:
        work.x[:], work.v[:] = _checked_state(initial, system, bodies)
    outcome = Outcome.NON_FINITE_LOAD
    if loads_are_finite(system):
        outcome = OUTCOMES[march(system, pair, work, demand, record)]
    sampled, sticks = (int(number) for number in record.count)
    x, v = record.x[:sampled], record.v[:sampled]
    height, climb = _vertical(x[:, 0], v[:, 0], system)
    ground = ground_acceleration(scene, pair, instants[:sampled])
    total = record.total[:sampled]
    if system.small:  # no vertical motion relative to the plate
        total[:, :, 2] = ground[:, None, 2]
    return Trajectory(
        time=instants[:sampled],
        position=np.concatenate([x, np.broadcast_to(height[:, None, None], (sampled, bodies, 1))], axis=-1),
        velocity=np.concatenate([v, np.broadcast_to(climb[:, None, None], (sampled, bodies, 1))], axis=-1),
        absolute_acceleration=total,
        contact_force=record.reaction[:sampled] * scene.masses[0],
        stick=[(float(a), float(b)) for a, b in record.sticks[:sticks]],
        status=outcome.value,
        instant=np.nan if outcome == Outcome.OK else float(work.run[TIME]),
    )


def _checked_times(scene: Scene, times: ArrayLike | None) -> Array:
    if times is None:
        samples = int(np.ceil(scene.duration / min(scene.excitation.periods) * SAMPLES_PER_PERIOD)) + 1
        return np.linspace(0.0, scene.duration, min(samples, MOST_SAMPLES))
    instants = np.ascontiguousarray(times, dtype=float)
    inside = instants.ndim == 1 and np.all((instants >= 0.0) & (instants <= scene.duration))
    if not inside or np.any(np.diff(instants) <= 0.0):
        raise ValueError(f"times: must be rising instants (T,) from 0 to the duration, {scene.duration} s")
    return instants


def _checked_state(initial: State, system: System, bodies: int) -> tuple[Array, Array]:
    x, v = np.asarray(initial.position, float), np.asarray(initial.velocity, float)
    if x.shape != (bodies, 2) or v.shape != (bodies, 2) or not (np.isfinite(x).all() and np.isfinite(v).all()):
        raise ValueError(f"initial: position and velocity must be finite and of shape ({bodies}, 2)")
    if np.hypot(*x[0]) >= system.radius:
        raise ValueError(f"initial: the platform must start inside the rim (4.1), rho = {system.radius:.6g} m")
    return x, v


def _vertical(x: Array, v: Array, system: System) -> tuple[Array, Array]:
    """Height above the lowest point and vertical velocity (2.1), (3.4); none in the small equations."""
    if system.small:
        return np.zeros(len(x)), np.zeros(len(x))
    squared = (x**2).sum(axis=-1)
    depth = np.sqrt(system.radius**2 - squared)
    return squared / (system.radius + depth), (x * v).sum(axis=-1) / depth
