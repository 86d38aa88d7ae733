"""A flat slider in the engine: a sphere on a plane, in units of length that the loading gives."""

import math

import numpy as np

import multibody
from reference.analytical import stopping_distance
from reference.problem import GRAVITY, Outcome, State, load_scene

FLAT = {"isolator.period": None, "isolator.radius": math.inf}
V_REG = 1e-3
SCENE = load_scene("fig3-I").with_values(FLAT)


def test_a_straight_slide_far_out_stops_after_v2_over_2_mu_g():
    still = {"excitation.amplitudes": [[0.0, 0.0], [0.0, 0.0]], "bodies": [{"mass": 1.0}], "duration": 2.0}
    scene, speed = SCENE.with_values(still), 1.0
    way = stopping_distance(speed, 0.1)
    for place in (0.0, 1e4):
        start = State(np.array([[place, 0.0]]), np.array([[0.6 * speed, 0.8 * speed]]))
        run = multibody.trajectory(scene, (0.0, 0.0), initial=start)
        moved = run.position[-1, 0, :2] - [place, 0.0]
        creep = V_REG**2 / (0.1 * GRAVITY)  # below v_reg the speed decays: the way left is v_reg^2 / (mu g)
        np.testing.assert_allclose(moved, [0.6 * way, 0.8 * way], atol=creep + 2e-4 * way)
        np.testing.assert_allclose(run.peak, 0.1 * GRAVITY, rtol=1e-4)
        assert np.abs(run.position[:, 0, 2]).max() < 1e-6


def test_overturning_shifts_the_load_as_statics_says():
    """A block that slides along x with its center h above the plane: the load's center is mu h before that of mass."""
    height, still = 0.3, [[0.0, 0.0], [0.0, 0.0]]
    block = {"mass": 2.0, "height": height, "size": [2.0, 2.0, 0.2]}
    scene = SCENE.with_values({"bodies": [block], "excitation.amplitudes": still, "duration": 0.5})
    start = State(np.zeros((1, 2)), np.array([[0.8, 0.0]]))
    run = multibody.trajectory(scene, (0.0, 0.0), model="spatial", initial=start)
    middle = len(run.time) // 2
    weight, places = 2.0 * GRAVITY, scene.support_places[:, 0]
    center = 0.1 * height + run.position[middle, 0, 0]
    expected = weight / 4.0 + weight * center * places / (places**2).sum()
    assert run.status == Outcome.OK
    np.testing.assert_allclose(run.extra["support_force"][middle], expected, rtol=1e-5)
    assert np.abs(run.extra["yaw"]).max() < 1e-9
