"""The keys of friction that yields elastically before it slides."""

import numpy as np
import pytest
from chains import refusal

import reference
from reference.problem import GRAVITY

SCENE = reference.load_scene("fig3-I")
WEIGHT = SCENE.total_mass * GRAVITY


def yielding(**table: float) -> reference.Scene:
    return SCENE.with_values({"isolator.friction": {"slow": 0.1, **table}})


@pytest.mark.parametrize("table", [{}, {"fast": 0.2, "rate": 10.0}, {"load_exponent": 0.5, "reference_load": 5.0}])
def test_yield_displacement_and_initial_stiffness_state_the_same(table):
    scene = yielding(yield_displacement=1e-3, **table)
    law = scene.dry_friction
    assert law.elastic
    assert law.stiffness == pytest.approx(law.largest * WEIGHT / 1e-3)
    assert scene.yield_displacement == pytest.approx(1e-3)
    same = yielding(initial_stiffness=law.stiffness, **table)
    assert same.dry_friction.stiffness == law.stiffness
    assert not SCENE.dry_friction.elastic
    assert SCENE.yield_displacement == 0.0


def test_effective_isolator_counts_the_elastic_part_of_the_loop():
    scene = yielding(yield_displacement=2e-3)
    rigid, soft = (reference.effective_isolator(each, [1e-3, 2e-3, 0.01]) for each in (SCENE, scene))
    loss = soft.damping * soft.stiffness * np.array([1e-3, 2e-3, 0.01]) ** 2 * 2.0 * np.pi
    np.testing.assert_allclose(loss, [0.0, 0.0, 4.0 * 0.1 * WEIGHT * 0.008], atol=1e-12)
    np.testing.assert_array_equal(soft.stiffness[1:], rigid.stiffness[1:])
    assert soft.stiffness[0] == pytest.approx(WEIGHT * (0.05 / 1e-3 + 1.0 / SCENE.radius))


@pytest.mark.parametrize("key", ["yield_displacement", "initial_stiffness"])
def test_what_has_rigid_friction_names_the_key_of_the_file(key: str) -> None:
    value = {"yield_displacement": 2e-3, "initial_stiffness": 1500.0}[key]
    said = refusal(yielding(**{key: value}).require_rigid_friction, "the closed form")
    assert (said.key, said.value) == (f"isolator.friction.{key}", value)
    assert said.rule == "the closed form has friction that is rigid before it slides: remove this key"
    SCENE.require_rigid_friction("the closed form")


def test_another_yield_displacement_leaves_the_rest_of_the_law():
    scene = SCENE
    table = {"slow": 0.05, "fast": 0.1, "rate": 20.0, "initial_stiffness": 900.0}
    soft = scene.with_values({"isolator.friction": table, "name": "soft"}).with_yield_displacement(2e-3)
    assert (soft.name, soft.yield_displacement) == ("soft", pytest.approx(2e-3))
    assert soft.isolator.friction.initial_stiffness is None
    rigid = soft.with_yield_displacement(0.0)
    assert (rigid.dry_friction.elastic, rigid.dry_friction.fast, rigid.name) == (False, 0.1, "soft")
    assert scene.with_yield_displacement(1e-3).with_yield_displacement(0.0).digest() == scene.digest()
    assert scene.with_yield_displacement(0.0) is scene
