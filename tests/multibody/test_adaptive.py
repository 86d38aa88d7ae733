"""Adaptive runs: smaller steps at stops and nowhere else, and restarts that the contact does not notice."""

import numpy as np
from scenes_at_hand import changed, one_body

import multibody
from multibody.integration.constant_step import Engine, silence
from multibody.models.assembly import assemble
from reference.problem import State, load_scene


def test_steps_are_small_at_stops_and_large_elsewhere() -> None:
    scene, v_reg = changed(load_scene("fig3-I"), duration=6.0), 1e-3
    motion = multibody.trajectory(scene, (2.0, 0.7), regularization=v_reg)
    step = np.diff(motion.time)
    slip = motion.extra["slip_speed"][:-1, 0]
    change = np.linalg.norm(np.diff(motion.velocity[:, 0], axis=0), axis=-1)
    # the bound at level 1 is 0.07 of the slip speed, met at the row before and exceeded at most by what one step adds
    assert (change / np.maximum(slip, v_reg)).max() < 0.14
    assert step.min() < step.max() / 10.0
    assert np.median(step) > 0.9 * step.max()


def test_a_settled_restart_with_a_smaller_step_does_not_ring() -> None:
    scene, penetration, coarse = one_body(duration=1.0), 1e-6, 0.0123
    model = assemble(scene, "translational", 1e-3)
    model.set_contact(penetration)
    state = model.start(State(np.array([[0.05, 0.0]]), np.array([[0.3, 0.4]])), np.zeros(3), penetration)
    engine = Engine(model, 1e-8, 1e-9)
    jitter = []
    with silence():
        sliding = engine.run(state, 0.0, coarse, 40)
        assert sliding is not None
        rate = (sliding.gap[-1] - sliding.gap[-5]) / (sliding.time[-1] - sliding.time[-5])
        for begin in (sliding.state(-1), model.settle(sliding.state(-1), rate, penetration)):
            motion = engine.run(begin, float(sliding.time[-1]), coarse / 4.0, 12)
            assert motion is not None
            jitter.append(np.abs(np.diff(motion.accelerations[:, 2], 2)).max())
    assert jitter[1] < 0.1 * jitter[0]
