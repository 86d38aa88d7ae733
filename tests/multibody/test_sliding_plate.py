"""Flights and impacts, flat sliders and recorded motions against independent equations (sliding_plate.py)."""

import math
from itertools import product
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
    periods, decay = random.uniform(0.4, 1.2, 2), random.uniform(0.0, 2.0, 2)
    return {"amplitudes": rows.tolist(), "periods": periods.tolist(), "decay": decay.tolist()}


def jumping(seed: int, flat: bool, recorded: bool, duration: float) -> Case:
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
    isolator: Table = {"radius": radius, "ring": width, "sphere_radius": sphere}
    isolator |= {"friction": float(random.uniform(0.02, 0.25)), "supports": int(random.integers(3, 6))}
    isolator["restitution"] = float(random.choice([0.0, 0.3, 0.6]))
    height = 0.0 if flat else radius + sphere  # that of the plane of contact
    bodies = [{"mass": float(random.uniform(0.5, 5.0)), "height": height, "size": [width, width, 0.3]}]
    scene = {"title": "", "duration": duration, "isolator": isolator, "bodies": bodies, "excitation": excitation}
    return scene, tuple(random.uniform(0.0, 2.0 * np.pi, 2).tolist()), float(10.0 ** random.uniform(-3.0, -2.0))


def sliding(flat: bool, recorded: bool) -> Case:
    """A chain of three bodies under loading in three directions."""
    random = np.random.default_rng(8)
    above = [{"mass": 1.0, "period": [0.6, 1.1], "damping": 0.1}, {"mass": 2.5, "period": [1.3, 0.4]}]
    excitation = random_record(random, 2.0, 1.5, 0.6) if recorded else harmonics(random, 2.0, 1.5)
    isolator = {"radius": math.inf if flat else 1.2, "friction": 0.06}
    scene = {"title": "", "duration": 0.6, "bodies": [{"mass": 1.5}, *above]}
    return {**scene, "isolator": isolator, "excitation": excitation}, (0.4, 2.1), 3e-3


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


EITHER = (False, True)
LONG = [pytest.param(*each, 1.0, marks=pytest.mark.long) for each in product(range(1, 6), EITHER, EITHER)]


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
    table, phase, v_reg = jumping(0, flat, False, 1.0)
    scene, plate = Scene.model_validate(table), SlidingPlate(table, phase, v_reg)
    engine = multibody.amplification(scene, [phase], regularization=v_reg)
    motion = multibody.trajectory(scene, phase, regularization=v_reg)
    assert engine.status[0] == motion.status == Outcome.CONTACT_LOST
    assert np.isnan([engine.mu[0], engine.error[0], engine.displacement]).all()
    # the gap follows the force by twice the square root of the contact's penetration, which is 2.5e-7 here
    late = 1.1e-3 * plate.ground.unit_of_time(plate.radius)
    opening = plate.motion(1e-6, until_opening=True).openings[0]
    assert (engine.instant[0], motion.instant) == (pytest.approx(opening, abs=late), motion.time[-1])
    assert motion.instant == pytest.approx(opening, abs=late)
