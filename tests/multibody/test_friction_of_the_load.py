"""Friction that depends on the normal force in the engine: the exact equations like for like, both models."""

from __future__ import annotations

import math

import numpy as np
import pytest

import multibody
import reference
from reference.problem import Outcome, load_scene

V_REG = 1e-3
PRESSED = {"slow": 0.08, "load_exponent": 0.4}
EASED = {"slow": 0.05, "fast": 0.1, "rate": 100.0, "load_exponent": -0.3, "reference_load": 25.0}
VERTICAL = {"excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0], [2.0, 1.0]]}
PLANE = {"isolator.period": None, "isolator.radius": math.inf}


def share(law: object, phases: object, **values: object) -> float:
    """Largest difference of engine and exact equations over the sum of their errors."""
    scene = load_scene("fig3-I").with_values({"isolator.friction": law, **values})
    engine = multibody.amplification(scene, phases, regularization=V_REG)
    equations = reference.amplification(scene, phases, regularization=V_REG)
    assert set(engine.status) == set(equations.status) == {Outcome.OK}
    return float((np.abs(engine.mu - equations.mu) / (engine.error + equations.error)).max())


@pytest.mark.parametrize("values", [{}, VERTICAL, VERTICAL | PLANE], ids=["sphere", "vertical", "plane"])
@pytest.mark.parametrize("law", [PRESSED, EASED], ids=["pressed", "eased"])
def test_points_lie_within_their_errors_of_the_equations(law, values):
    assert share(law, [(0.3, 1.1)], duration=3.0, **values) <= 1.0


@pytest.mark.long
@pytest.mark.parametrize("law", [PRESSED, EASED], ids=["pressed", "eased"])
def test_a_surface_lies_within_its_errors_of_the_equations(law):
    assert share(law, np.random.default_rng(7).uniform(0.0, 2.0 * np.pi, (64, 2)), **VERTICAL) <= 1.0


def test_every_support_has_the_friction_of_its_own_load():
    """A body level with the depressions does not turn: the spatial model has the motion of the translational one."""
    body = {"mass": 1.0, "height": 0.0, "size": [2.0, 2.0, 0.2]}
    values = {"bodies": [body], "duration": 2.0, "isolator.friction": {"slow": 0.1, "load_exponent": 0.2}}
    scene = load_scene("fig3-I").with_values(VERTICAL | values)
    spatial, translational = (
        multibody.amplification(scene, [(0.3, 1.1)], model=model, full=True) for model in ("spatial", "translational")
    )
    assert spatial.status.tolist() == [Outcome.OK]
    np.testing.assert_allclose(spatial.mu, translational.mu, rtol=5e-3)
