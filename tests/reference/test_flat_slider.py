"""
A flat slider, rho = inf: a plane under the platform, no restoring force.

A rigid block has closed forms: Newmark's sliding block. Bodies on links are solved again in
`tests/multibody/test_sliding_plate.py`.
"""

import math

import numpy as np
import pytest
from chains import chain
from scipy.optimize import brentq

import reference
from reference.problem import GRAVITY, Scene, ground_peak, load_scene, phase_grid

FLAT = {"isolator.period": None, "isolator.radius": math.inf}
PHASES = np.array([(0.3, 1.1), (2.0, 0.7), (4.0, 5.5)])


def flat(**values) -> Scene:
    """A scene of the paper on a plane; keys with double underscores for dots."""
    return load_scene("fig3-I").with_values(FLAT | {key.replace("__", "."): value for key, value in values.items()})


def test_a_sliding_rigid_block_is_accelerated_by_mu_g():
    scene = flat(bodies=[{"mass": 2.0}], excitation__scale=3.0)
    pairs = phase_grid(8)
    answer = reference.amplification(scene, pairs)
    limit = scene.friction_coefficient * GRAVITY
    expected = np.minimum(1.0, limit / ground_peak(scene, pairs))
    assert (np.abs(answer.mu[:, 0] - expected) <= answer.error[:, 0]).all()
    np.testing.assert_allclose(answer.mu[:, 0], expected, rtol=1e-6)
    assert (expected < 1.0).all()


@pytest.mark.parametrize("share", [0.75, 0.9, 0.99])
def test_a_block_under_a_harmonic_slides_as_newmark_says(share):
    """From its largest value on a cosine drives the block until sin z / z = share; it stays within the half cycle."""
    amplitude, period = 2.0, 1.3
    pace = 2.0 * math.pi / period
    z = brentq(lambda z: math.sin(z) / z - share, 1e-3, math.pi)
    way = amplitude / pace**2 * (1.0 - math.cos(z)) - share * amplitude * (z / pace) ** 2 / 2.0
    assert abs(math.cos(z)) < share, "friction holds the block when it stops"
    loading = {"amplitudes": [[amplitude, 0.0], [0.0, 0.0]], "periods": (period, period), "decay": (0.0, 0.0)}
    scene = chain(math.inf, share * amplitude / GRAVITY, [3.0], duration=0.25 * period, **loading)
    run = reference.trajectory(scene, (0.0, 0.0), tolerance=1e-9, times=[0.0, z / pace, 0.25 * period])
    assert run.stick[0][0] == pytest.approx(z / pace, rel=1e-7)
    assert run.position[-1, 0, 0] == pytest.approx(-way, rel=1e-7)
    assert reference.amplification(scene, [(0.0, 0.0)]).displacement[0] == pytest.approx(way, rel=1e-3)


@pytest.mark.parametrize("phase", [PHASES[0], (0.0, 0.0)], ids=["farthest at the end", "farthest within a step"])
@pytest.mark.parametrize("equations", ["exact", "small"])
def test_without_friction_the_plate_moves_alone(equations, phase):
    scene = flat(isolator__friction=0.0, bodies=[{"mass": 2.0}], excitation__decay=[0.0, 0.0], duration=5.0)
    amplitudes, pace = np.diag(scene.amplitudes), 2.0 * np.pi / np.array([0.9, 1.1])
    answer = reference.amplification(scene, [phase], equations=equations)
    times = np.linspace(0.0, 5.0, 2001)
    turned = pace * times[:, None] + phase
    # minus the second integral of a cos(w t + alpha) from rest
    moved = amplitudes / pace**2 * (np.cos(turned) - np.cos(phase) + pace * times[:, None] * np.sin(phase))
    assert answer.mu[0, 0] == pytest.approx(0.0, abs=1e-11)
    assert answer.displacement[0] == pytest.approx(np.hypot(*moved.T).max(), rel=1e-5)
    run = reference.trajectory(scene, phase, equations, times=times)
    np.testing.assert_allclose(run.position[:, 0, :2], moved, atol=1e-6)


def test_the_modes_on_a_plane_begin_with_rigid_motion():
    """The others are those of an oscillator with the reduced mass 2/3 kg."""
    scene = flat(bodies=[{"mass": 2.0}, {"mass": 1.0, "stiffness": [30.0, 12.0], "damping": [0.4, 0.3]}])
    omega = np.sqrt(np.array([30.0, 12.0]) * 1.5)
    natural = reference.modes(scene)
    np.testing.assert_array_equal(natural.frequency[:, 0], 0.0)
    np.testing.assert_array_equal(natural.period[:, 0], np.inf)
    np.testing.assert_allclose(natural.frequency[:, 1], omega, rtol=1e-13)
    np.testing.assert_allclose(natural.effective_mass, [[3.0, 0.0], [3.0, 0.0]], atol=1e-13)
    np.testing.assert_allclose(natural.shape[:, :, 0], 1.0 / math.sqrt(3.0), rtol=1e-13)
    assert reference.modes(flat(bodies=[{"mass": 2.0}])).frequency.tolist() == [[0.0], [0.0]]
    natural = reference.damped_modes(scene)
    np.testing.assert_array_equal(natural.eigenvalue[:, :2], 0.0)
    np.testing.assert_array_equal(natural.damping_ratio[:, :2], 0.0)
    np.testing.assert_array_equal(natural.shape[:, :, :2], 1.0)
    np.testing.assert_allclose(natural.frequency[:, 2:], np.column_stack([omega, omega]), rtol=1e-12)
    ratio = np.array([0.4, 0.3]) * 1.5 / (2.0 * omega)
    np.testing.assert_allclose(natural.damping_ratio[:, 2:], np.column_stack([ratio, ratio]), rtol=1e-12)


def test_a_flat_slider_has_no_rim_and_infinity_survives_json_as_a_word():
    scene = flat(duration=6.0)
    numbers = reference.demands(reference.trajectory(scene, PHASES[0]))
    answer = reference.amplification(scene, PHASES[:1])
    assert numbers.cap_share.value == answer.cap_share[0] == 0.0
    assert numbers.displacement.value == pytest.approx(answer.displacement[0], rel=1e-3)
    assert '"radius":"inf"' in scene.model_dump_json()
    assert Scene.model_validate(scene.model_dump(exclude_none=True)) == scene
    assert scene.digest() != scene.with_values({"isolator.radius": 1e12}).digest()
