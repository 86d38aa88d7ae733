"""The equations under a recorded motion: kinks of the loading cost neither accuracy nor the error estimate."""

import numpy as np
import pytest

import reference
from reference.problem import Scene, ground_acceleration, ground_peak
from reference.solver.error_estimate import peaks_at
from reference.surface import checked_demand

ANY = (0.0, 0.0)  # a record has no phases
EXAMPLES = {name: reference.load_scene(name) for name in reference.example_scenes()}


def recorded(scene: Scene, samples: np.ndarray, **changes: object) -> Scene:
    data = scene.model_dump(exclude_none=True) | changes
    data["excitation"] = {"record": "made.csv", "samples": samples.tolist()}
    return Scene.model_validate(data)


def random_record(spacing: float, duration: float = 8.0) -> np.ndarray:
    generator = np.random.default_rng(3)
    count = int(duration / spacing) + 1
    values = generator.normal(size=(count, 3)) * [1.0, 1.0, 0.2]
    return np.column_stack([spacing * np.arange(count), values])


@pytest.mark.parametrize("law", [{"friction": 0.0}, {"lubrication": 0.5}])
@pytest.mark.parametrize("spacing", [0.8, 0.37])
def test_kinks_do_not_lower_the_order_of_convergence(law, spacing):
    """Several steps between two knots: the error estimate of a step is of order 7; a step over a kink has order 2."""
    scene = recorded(EXAMPLES["synthetic-pair"], random_record(spacing), duration=8.0, isolator={"period": 1.0, **law})
    system, demand = checked_demand(scene, "exact", None, 1e-6, None, "consistent")
    point = np.array([ANY])
    truth = peaks_at(system, point, demand, 1e-11).value
    runs = [peaks_at(system, point, demand, tolerance) for tolerance in 10.0 ** -np.arange(3.0, 8.1)]
    errors = [np.abs(run.value - truth).max() for run in runs]
    order = -np.polyfit(np.log([run.steps[0] for run in runs]), np.log(errors), 1)[0]
    assert order >= 7.0


@pytest.mark.parametrize("phase", [(4.0, 5.5), (2.0, 0.7)])
def test_samples_of_two_frequencies_tend_to_them_at_second_order(phase):
    """The chord of a curve is off by h^2/12 of its curvature in the mean; peaks, as the largest sample jumps about."""
    scene = reference.load_scene("fig3-I")
    asked = {"regularization": 1e-3, "tolerance": 1e-8}
    truth = reference.amplification(scene, [phase], **asked).mu * ground_peak(scene, [phase])[0]
    changes = []
    for spacing in (0.04, 0.02, 0.01, 0.005):
        time = spacing * np.arange(round(scene.duration / spacing) + 1)
        sampled = recorded(scene, np.column_stack([time, ground_acceleration(scene, phase, time)]))
        peaks = reference.amplification(sampled, [ANY], **asked).mu * ground_peak(sampled, [ANY])[0]
        changes.append((peaks - truth)[0])
    ratios = np.array(changes[:-1]) / np.array(changes[1:])
    assert ratios == pytest.approx(4.0, rel=0.05)
    assert np.abs(changes[-1]).max() < 1e-4


def test_a_motion_is_sampled_through_its_kinks():
    """At rest the absolute acceleration of the platform is the ground's, at knots and between them."""
    scene = EXAMPLES["synthetic-pair"]
    motion = reference.trajectory(scene, ANY)
    assert motion.status == "ok"
    start, end = max(motion.stick, key=lambda interval: interval[1] - interval[0])
    inside = (motion.time > start) & (motion.time < end)
    ground = ground_acceleration(scene, ANY, motion.time[inside])
    assert inside.sum() > 20
    assert motion.absolute_acceleration[inside, 0] == pytest.approx(ground, abs=1e-9)
