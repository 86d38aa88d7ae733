"""One trajectory with the engine."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from multibody.integration.constant_step import Motion, silence
from multibody.integration.refine import refine
from multibody.models.assembly import assembled
from reference.problem import Scene, State, Trajectory, checked_phase, ground_acceleration
from reference.problem.ranges import TOLERANCE, checked_number, checked_state


def trajectory(
    scene: Scene,
    phase: ArrayLike,
    model: str = "translational",
    regularization: float | None = 1e-3,
    tolerance: float = 1e-3,
    initial: State | None = None,
    loading: str = "inertial",
) -> Trajectory:
    """
    One motion in the plate's frame for one phase pair (2,), rad, from rest or from `initial`.

    Other arguments as in `amplification`.

    The instants are the engine's own, closer at stops, and miss the largest accelerations, which `peak` has; they are
    those of the run whose peaks meet `tolerance`, as in `amplification`, with the same statuses; a run that ends early
    is returned up to there. `contact_force`: sum over the supports. `stick`: intervals in which every support slips
    slower than v_reg. `extra`: slip_speed (T, K), m/s, and support_force (T, K), N, of K contacts (one in the
    translational model); the spatial model adds yaw and tilt of the platform (T,), rad, turns (T, N, 3), rad, the
    angles a, b, c of every body, which is turned against the plate by Rx(a) Ry(b) Rz(c), and liftoff (L, 3): support,
    start and end, s, of every time a contact is open. Raises ValueError for wrong arguments.
    """
    pair = checked_phase(phase)
    tolerance = checked_number("tolerance", tolerance, TOLERANCE)
    if initial is not None:
        initial = State(*checked_state(initial, len(scene.bodies), scene.radius))
    with silence():
        built = assembled(scene, model, regularization, loading=loading, contact_force=True)
        point = refine(scene, built, pair, tolerance, initial=initial, keep=True)
    units, bodies = built.units, built.bodies
    motion = Motion.joined(point.finest.chunks) if point.finest.chunks else Motion.none(built)
    time = motion.time * units.time
    resting = not built.moving_plate
    ground = ground_acceleration(scene, pair, time) if resting else motion.plate[:, 2] * units.acceleration
    vectors = motion.force.reshape(len(time), motion.force.shape[1] // 6, 2, 3)  # per contact: force, normal
    support_force = np.abs((vectors[:, :, 0] * vectors[:, :, 1]).sum(axis=-1)) * units.force
    extra = {"slip_speed": motion.slip * units.velocity, "support_force": support_force}
    if model == "spatial":
        extra |= _attitude(motion, bodies, time)
    return Trajectory(
        time=time,
        position=motion.coordinates[:, bodies] * units.length,
        velocity=motion.velocities[:, bodies] * units.velocity,
        absolute_acceleration=motion.accelerations[:, bodies] * units.acceleration + ground[:, None, :],
        contact_force=support_force.sum(axis=1),
        stick=_intervals(time, (motion.slip < built.corner).all(axis=1) & np.isfinite(built.corner)),
        status=point.outcome,
        instant=point.instant,
        extra=extra,
        peak=point.finest.peaks.value * units.acceleration if len(time) else np.full(len(bodies), np.nan),
    )


def _attitude(motion: Motion, bodies: NDArray[np.int_], time: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """How the bodies turn, and when the platform leaves a support."""
    turns = motion.coordinates[:, bodies + 3]  # of a body, behind its three displacements
    roll, pitch, yaw = turns[:, 0].T
    open_at = [
        (float(support), *interval)
        for support, gap in enumerate(motion.gap.T)
        for interval in _intervals(time, gap >= 0.0)
    ]
    tilt = np.arcsin(np.hypot(np.sin(pitch), np.sin(roll) * np.cos(pitch)))
    return {"yaw": yaw, "tilt": tilt, "turns": turns, "liftoff": np.array(open_at).reshape(-1, 3)}


def _intervals(time: NDArray[np.float64], holds: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """First and last instant of every unbroken run of rows in which something holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], holds.astype(int), [0]])))
    return [(float(time[begin]), float(time[end - 1])) for begin, end in edges.reshape(-1, 2)]
