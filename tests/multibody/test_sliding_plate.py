"""Flights and impacts, flat sliders and recorded motions against independent equations (sliding_plate.py)."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.random import Generator
from sliding_plate import SlidingPlate, random_record

import multibody
from reference.measures import demands
from reference.problem import Outcome, Scene

Table = dict[str, Any]
Case = tuple[Table, tuple[float, float], float]  # scene, phases, and v_reg in m/s


def harmonics(random: Generator, horizontal: float, vertical: float) -> Table:
    """Two-frequency loading in three directions, m/s^2."""
    rows = random.uniform(-1.0, 1.0, (3, 2)) * np.array([[horizontal], [horizontal], [vertical]])
    return {
        "amplitudes": rows.tolist(),
        "periods": random.uniform(0.4, 1.2, 2).tolist(),
        "decay": random.uniform(0.0, 2.0, 2).tolist(),
    }


def case(
    title: str, duration: float, isolator: Table, bodies: list[Table], excitation: Table, random: Generator
) -> Case:
    scene = {"title": title, "duration": duration, "isolator": isolator, "bodies": bodies, "excitation": excitation}
    return scene, tuple(random.uniform(0.0, 2.0 * np.pi, 2).tolist()), float(10.0 ** random.uniform(-3.0, -2.0))


def jumping(seed: int, flat: bool, recorded: bool, duration: float = 1.0) -> Case:
    """A level platform that a vertical acceleration above g throws up; on spheres all of it stays in a plane."""
    random = np.random.default_rng([7, seed])
    along = random.normal(size=2) / 1.5
    width, sphere = float(random.uniform(3.0, 5.0)), float(random.uniform(0.03, 0.1))
    radius = math.inf if flat else float(random.uniform(0.4, 1.5))
    if recorded:
        excitation = random_record(random, 3.0, 8.0, duration)
        rows = excitation["record"]["acceleration"].T
    else:
        excitation = harmonics(random, 4.0, 3.0)
        rows = np.array(excitation["amplitudes"])
        rows[2, 0] = random.choice([-1.0, 1.0]) * random.uniform(11.0, 18.0)
        excitation["amplitudes"] = rows
    if not flat:
        rows[:2] = along[:, None] * rows[0]
    isolator: Table = {
        "radius": radius,
        "friction": float(random.uniform(0.02, 0.25)),
        "supports": int(random.integers(3, 6)),
        "ring": width,
        "sphere_radius": sphere,
        "restitution": float(random.choice([0.0, 0.3, 0.6])),
    }
    height = 0.0 if flat else radius + sphere  # that of the plane of contact
    bodies = [{"mass": float(random.uniform(0.5, 5.0)), "height": height, "size": [width, width, 0.3]}]
    return case(f"jumping {seed}", duration, isolator, bodies, excitation, random)


def sliding(flat: bool, recorded: bool) -> Case:
    """A chain of one to three bodies under loading in three directions."""
    random = np.random.default_rng([8, 0])
    bodies: list[Table] = [{"mass": float(random.uniform(0.5, 3.0))}]
    for _ in range(random.integers(0, 3)):
        bodies.append({"mass": float(random.uniform(0.3, 3.0)), "period": random.uniform(0.3, 1.5, 2).tolist()})
        if random.uniform() < 0.5:
            bodies[-1]["damping"] = float(random.uniform(0.01, 0.3))
    size = float(random.uniform(0.7, 3.0)), float(random.uniform(0.1, 3.0))
    excitation = random_record(random, *size, 0.6) if recorded else harmonics(random, *size)
    isolator: Table = {
        "radius": math.inf if flat else float(random.uniform(0.3, 2.0)),
        "friction": float(random.uniform(0.02, 0.15)),
    }
    return case("sliding", 0.6, isolator, bodies, excitation, random)


def share_of_errors(case: Case, model: str) -> float:
    """Largest difference of the engine's factors and displacement from the equations', over the sum of both errors."""
    scene, phase, v_reg = case
    engine = multibody.amplification(Scene.model_validate(scene), [phase], model, v_reg, full=True)
    assert engine.status[0] in (Outcome.OK, Outcome.TOLERANCE_NOT_MET)
    rough, close = (SlidingPlate(scene, phase, v_reg).motion(each) for each in (1e-4, 1e-6))
    share = float((np.abs(engine.mu[0] - close.mu) / (engine.error[0] + np.abs(rough.mu - close.mu))).max())
    farthest = demands(multibody.trajectory(Scene.model_validate(scene), phase, model, v_reg)).displacement
    away = abs(farthest.value - close.displacement)
    away /= farthest.error + abs(rough.displacement - close.displacement)
    return max(share, away)


LONG = [
    pytest.param(seed, flat, recorded, 1.0, marks=pytest.mark.long)
    for seed in range(1, 6)
    for flat in (False, True)
    for recorded in (False, True)
]


@pytest.mark.parametrize(
    ("seed", "flat", "recorded", "duration"), [(16, True, False, 0.5), (1, True, True, 0.5), *LONG]
)
def test_a_platform_thrown_up_moves_as_flights_and_impacts_say(
    seed: int, flat: bool, recorded: bool, duration: float
) -> None:
    """The first two on a plane: six landings (mu is 11 % less without restitution), and one under a record."""
    assert share_of_errors(jumping(seed, flat, recorded, duration), "spatial") <= 1.0


@pytest.mark.parametrize(("flat", "recorded"), [(True, False), (False, True), (True, True)])
def test_bodies_on_links_move_as_independent_equations_say(flat: bool, recorded: bool) -> None:
    assert share_of_errors(sliding(flat, recorded), "translational") <= 1.0


@pytest.mark.parametrize("flat", [False, True], ids=["spheres", "plane"])
def test_translation_ends_where_the_normal_force_vanishes(flat: bool) -> None:
    scene, phase, v_reg = jumping(0, flat, False)
    engine = multibody.amplification(Scene.model_validate(scene), [phase], regularization=v_reg)
    plate = SlidingPlate(scene, phase, v_reg)
    opening = plate.motion(1e-6, until_opening=True).openings[0]
    assert engine.status[0] == Outcome.CONTACT_LOST
    # the gap follows the force by twice the square root of the contact's penetration, which is 2.5e-7 here
    assert engine.instant[0] == pytest.approx(opening, abs=1.1e-3 * plate.ground.unit_of_time(plate.radius))
