"""
Each variant of the compiled solver, where its law of friction is that of another.

All variants are compiled here, one after the other in one process, which compiles what they share once.
"""

import numpy as np
import pytest

import reference
from reference.problem import load_scene

# On a plane under horizontal shaking the normal force is the weight, so that the load changes no friction.
PLANE = load_scene("fig3-II").with_values({"isolator.radius": np.inf, "isolator.period": None, "duration": 4.0})
PHASES = [(0.3, 1.1), (2.0, 0.7)]


@pytest.mark.parametrize("yields", [{}, {"yield_displacement": 2e-3}], ids=["rigid", "yielding"])
def test_friction_of_the_load_is_constant_friction_where_the_load_is_constant(yields: dict[str, float]) -> None:
    laws = ({"slow": 0.1, **yields} if yields else 0.1, {"slow": 0.1, "load_exponent": -0.3, **yields})
    plain, loaded = (reference.amplification(PLANE.with_values({"isolator.friction": law}), PHASES) for law in laws)
    assert plain.status.tolist() == loaded.status.tolist() == ["ok", "ok"]
    assert np.ptp(plain.mu, axis=0).min() > 1e-3
    np.testing.assert_allclose(loaded.mu, plain.mu, rtol=1e-9)
