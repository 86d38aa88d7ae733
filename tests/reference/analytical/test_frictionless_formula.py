"""The frictionless response against direct integration of (4.3)-(4.4) with SciPy."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from reference.analytical import frictionless_amplification, frictionless_motion
from reference.problem import GRAVITY, Scene, ground_acceleration, ground_peak

SCENE = Scene.model_validate(
    {
        "title": "three bodies",
        "duration": 6.0,
        "isolator": {"period": 1.0, "friction": 0.0},
        "bodies": [{"mass": 2.0}, {"mass": 1.0, "period": [1.5, 0.9]}, {"mass": 0.4, "stiffness": [50.0, 70.0]}],
        "excitation": {"amplitudes": [[0.6, 0.2], [-0.1, 0.5]], "periods": [0.9, 1.1], "decay": [0.33, 0.0]},
    }
)
PHASE = (0.3, 1.1)


def integrated(times: np.ndarray, phase: tuple[float, float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    mass = SCENE.masses[:, None]

    def acceleration(t, q):
        force = np.zeros((3, 2))
        force[0] = -SCENE.total_mass * GRAVITY / SCENE.radius * q[0]
        link = SCENE.stiffness * np.diff(q, axis=0)
        force[:-1] += link
        force[1:] -= link
        return force / mass - ground_acceleration(SCENE, phase, [t])[0, :2]

    def rhs(t, y):
        return np.concatenate([y[6:], acceleration(t, y[:6].reshape(3, 2)).ravel()])

    run = solve_ivp(rhs, (0.0, 6.0), np.zeros(12), method="DOP853", rtol=1e-12, atol=1e-14, t_eval=times)
    x, v = run.y[:6].T.reshape(-1, 3, 2), run.y[6:].T.reshape(-1, 3, 2)
    ground = ground_acceleration(SCENE, phase, times)[:, None, :2]
    return x, v, np.array([acceleration(t, q) for t, q in zip(times, x)]) + ground


def test_motion_is_the_integrated_one():
    times = np.linspace(0.0, 6.0, 400)
    for found, wanted in zip(frictionless_motion(SCENE, PHASE, times), integrated(times, PHASE)):
        np.testing.assert_allclose(found, wanted, atol=1e-10)


def test_motion_starts_from_rest():
    position, velocity, _ = frictionless_motion(SCENE, PHASE, [0.0])
    np.testing.assert_allclose(position, 0.0, atol=1e-15)
    np.testing.assert_allclose(velocity, 0.0, atol=1e-14)


def test_amplification_is_the_maximum_of_the_motion():
    """Against 2e4 samples: |a|^2 between two of them rises by less than 1e-5 of itself."""
    phases = np.array([PHASE, (0.0, 0.0)])
    times = np.linspace(0.0, SCENE.duration, 20_001)
    found = frictionless_amplification(SCENE, phases)
    for phase, mu in zip(phases, found):
        _, _, acceleration = frictionless_motion(SCENE, phase, times)
        sampled = np.sqrt((acceleration**2).sum(axis=-1).max(axis=0)) / ground_peak(SCENE, [phase])[0]
        assert np.all(mu >= sampled * (1.0 - 1e-13))
        np.testing.assert_allclose(mu, sampled, rtol=1e-5)


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        ({"isolator": {"period": 1.0, "friction": 0.1}}, "friction"),
        ({"excitation": {"amplitudes": [[1, 0], [0, 1], [1, 0]], "periods": [1, 2], "decay": [0, 0]}}, "vertical"),
    ],
)
def test_scenes_without_this_closed_form_are_refused(change, rule):
    data = SCENE.model_dump(exclude_none=True) | change
    for part in ("amplitudes", "periods", "decay"):
        rows = data["excitation"][part]
        data["excitation"][part] = np.asarray(rows, dtype=float).tolist()
    with pytest.raises(ValueError, match=rule):
        frictionless_motion(Scene.model_validate(data), PHASE, [0.0])
