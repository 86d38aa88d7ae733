"""One trajectory with the engine."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from multibody.integrate import Engine, silence
from multibody.surface import COARSEST, NEWTON, PENETRATION, builder_of, checked
from reference.problem import Outcome, Scene, State, Trajectory, checked_phases, ground_acceleration


def trajectory(
    scene: Scene,
    phase: ArrayLike,
    model: str = "translational",
    regularization: float = 1e-3,
    tolerance: float = 1e-3,
    initial: State | None = None,
) -> Trajectory:
    """One motion in the plate's frame for one phase pair (2,), rad, from rest or from `initial`."""
    pair = checked_phases(np.reshape(np.asarray(phase, float), (1, -1)))[0]
    checked("tolerance", tolerance)
    built = builder_of(model)(scene, checked("regularization", regularization), PENETRATION, contact_force=True)
    units, bodies = built.units, built.bodies
    built.ground.set_phase(pair)
    count = int(np.ceil(scene.duration / units.time / COARSEST)) * 4
    with silence():
        begin = built.start(initial, ground_acceleration(scene, pair, [0.0])[0])
        motion = Engine(built, NEWTON).run(begin, 0.0, scene.duration / units.time / count, count)
    if motion is None:
        raise RuntimeError(Outcome.SOLVER_FAILED)
    time = motion.time * units.time
    ground = ground_acceleration(scene, pair, time)
    slow = motion.contact[:, 1] < built.slip_threshold if np.isfinite(built.slip_threshold) else time < 0.0
    edges = np.flatnonzero(np.diff(np.concatenate([[0], slow.astype(int), [0]])))
    return Trajectory(
        time=time,
        position=motion.coordinates[:, bodies] * units.length,
        velocity=motion.velocities[:, bodies] * units.velocity,
        absolute_acceleration=motion.accelerations[:, bodies] * units.acceleration + ground[:, None, :],
        contact_force=np.abs((motion.force[:, :3] * motion.force[:, 3:]).sum(axis=1)) * units.force,
        stick=[(float(time[a]), float(time[b - 1])) for a, b in edges.reshape(-1, 2)],
        status=Outcome.OK,
        instant=np.nan,
        extra={"slip_speed": motion.contact[:, 1] * units.velocity},
    )
