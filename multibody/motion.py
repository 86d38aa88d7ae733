"""One trajectory with the engine."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from multibody.integrate import Motion, silence
from multibody.refine import refine
from multibody.surface import assembled, checked
from reference.problem import Scene, State, Trajectory, checked_phases, ground_acceleration


def trajectory(
    scene: Scene,
    phase: ArrayLike,
    model: str = "translational",
    regularization: float | None = 1e-3,
    tolerance: float = 1e-3,
    initial: State | None = None,
) -> Trajectory:
    """
    One motion in the plate's frame for one phase pair (2,), rad, from rest or from `initial`.

    The instants are the engine's own, closer at stops; they are those of the run whose peaks meet `tolerance`, as in
    `amplification`, with the same statuses; a run that ends early is returned up to there. `stick`: intervals in which
    the slip is slower than v_reg. `extra`: slip_speed (T,), m/s. Raises ValueError for wrong arguments.
    """
    pair = checked_phases(np.reshape(np.asarray(phase, float), (1, -1)))[0]
    checked("tolerance", tolerance)
    with silence():
        built = assembled(scene, model, regularization, contact_force=True)
        point = refine(scene, built, pair, tolerance, initial=initial, keep=True)
    units, bodies = built.units, built.bodies
    motion = Motion.joined(point.finest.chunks)
    time = motion.time * units.time
    ground = ground_acceleration(scene, pair, time)
    slip = motion.slip[:, 0]
    return Trajectory(
        time=time,
        position=motion.coordinates[:, bodies] * units.length,
        velocity=motion.velocities[:, bodies] * units.velocity,
        absolute_acceleration=motion.accelerations[:, bodies] * units.acceleration + ground[:, None, :],
        contact_force=np.abs((motion.force[:, :3] * motion.force[:, 3:]).sum(axis=1)) * units.force,
        stick=_intervals(time, (slip < built.corner) & np.isfinite(built.corner)),
        status=point.outcome,
        instant=point.instant,
        extra={"slip_speed": slip * units.velocity},
    )


def _intervals(time: NDArray[np.float64], holds: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """First and last instant of every unbroken run of rows in which something holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], holds.astype(int), [0]])))
    return [(float(time[begin]), float(time[end - 1])) for begin, end in edges.reshape(-1, 2)]
