"""Friction that depends on the normal force against limits and closed forms; `oracle_values.json` has more."""

import numpy as np
from numba import types

import reference
from reference.problem import GRAVITY, load_scene
from reference.solver.work import _SystemType

SCENE = load_scene("fig3-I").with_values({"duration": 4.0})
PHASES = [(0.3, 1.1), (2.0, 0.7)]


def factors(friction: object, **asked: object) -> np.ndarray:
    answer = reference.amplification(SCENE.with_values({"isolator.friction": friction}), PHASES, **asked)
    assert set(answer.status) == {"ok"}
    return answer.mu


def test_an_exponent_of_zero_gives_the_bits_of_plain_friction():
    np.testing.assert_array_equal(factors({"slow": 0.1, "load_exponent": 0.0}), factors(0.1))


def test_small_equations_have_the_friction_of_their_constant_load():
    load = {"slow": 0.1, "load_exponent": 0.5, "reference_load": SCENE.total_mass * GRAVITY / 0.64}
    small = {"equations": "small", "tolerance": 1e-8}
    np.testing.assert_allclose(factors(load, **small), factors(0.08, **small), rtol=3e-8)


def test_builds_of_both_variants_have_functions_of_other_names():
    """A build on disk would otherwise lend its functions to the other variant, which is compiled later."""
    without, present = (_SystemType([("exponent", kind)]).mangling_args for kind in (types.none, types.float64))
    assert without != present
