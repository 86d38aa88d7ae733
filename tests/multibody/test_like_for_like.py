"""Same law, same geometry: the engine and the paper's exact equations must give the same factors."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scenes_at_hand import assert_within, both_sides, frame

import multibody
from reference.problem import Outcome, Scene, load_scene

PHASES = np.array([(0.3, 1.1), (2.0, 0.7), (0.867, 4.951)])
V_REG = 1e-3
PLANE = {"isolator.period": None, "isolator.radius": math.inf}
VERTICAL = {"excitation.amplitudes": [[1.0, 0.0], [0.0, 1.0], [2.0, 1.0]]}
FLOORS = [{"mass": 2.0}, {"mass": 1.0, "period": [0.5, 0.4]}, {"mass": 0.5, "stiffness": [40.0, 60.0]}]
RISING, FALLING = {"slow": 0.05, "fast": 0.1, "rate": 100.0}, {"slow": 0.1, "fast": 0.05, "rate": 100.0}
PRESSED = {"slow": 0.08, "load_exponent": 0.4}
EASED = {"slow": 0.05, "fast": 0.1, "rate": 100.0, "load_exponent": -0.3, "reference_load": 25.0}
HEATING = {"contact_radius": 0.02, "conductivity": 0.02, "diffusivity": 1e-3}  # which so small a weight heats
HEATED = {"slow": 0.1, "heating": HEATING}


def law(friction: dict[str, Any], **values: Any) -> dict[str, Any]:
    return {"isolator.friction": friction, **values}


SCENES: dict[str, Scene] = {
    name: load_scene(base).with_values({"duration": 5.0, **values})
    for name, base, values in (
        ("pressed", "fig3-I", law(PRESSED)),  # the first, as it takes long to compile
        ("pressed, plane, vertical", "fig3-I", law(PRESSED, **PLANE, **VERTICAL)),
        ("eased, vertical", "fig3-I", law(EASED, **VERTICAL)),
        ("heated", "fig3-I", law(HEATED)),
        ("heated, eased, vertical", "fig3-II", law({**EASED, "heating": HEATING}, **VERTICAL)),
        ("heated, plane", "fig3-I", law(HEATED, **PLANE)),
        ("fig3-I", "fig3-I", {}),
        ("fig3-II", "fig3-II", {}),
        ("fig4-dry", "fig4-dry", {}),
        ("fig4-viscous", "fig4-viscous", {}),
        ("three floors", "fig3-II", {"bodies": FLOORS}),
        ("vertical", "fig3-I", VERTICAL),
        ("damped, unequal axes", "fig3-I", {"bodies.1.damping": [2.0, 0.5]}),
        ("damped, lubricated", "fig4-viscous", {"bodies.1.damping": [2.0, 0.5]}),
        *((f"lubrication {size:g}", "fig4-viscous", {"isolator.lubrication": size}) for size in (1e-3, 10.0, 1e5)),
        ("rising", "fig3-I", law(RISING)),
        ("falling", "fig3-II", law(FALLING)),
        ("rising, damped, vertical", "fig3-I", law(RISING, **VERTICAL) | {"bodies.1.damping": 0.05}),
        ("rising, one axis", "fig3-I", law(RISING) | {"excitation.amplitudes": [[1.0, 0.6], [0.0, 0.0]]}),
        *((f"rising, rate {rate:g}", "fig3-I", law({**RISING, "rate": rate})) for rate in (1.0, 1e6)),
        ("falling, rate 1e4", "fig3-I", law({**FALLING, "rate": 1e4})),
        ("plane", "fig3-I", PLANE),
        ("plane, lubricated", "fig4-viscous", PLANE),
        ("plane, vertical", "fig3-I", {**PLANE, **VERTICAL}),
        ("plane, rising", "fig3-I", law(RISING, **PLANE)),
        ("plane, one body", "fig3-I", {**PLANE, "bodies": [{"mass": 1.0}], "excitation.scale": 3.0}),
        ("pair", "synthetic-pair", {"excitation.scale": 0.5, "duration": 20.0}),
        ("triple", "synthetic-triple", {"duration": 16.0}),
        ("pair on a plane", "synthetic-pair", {**PLANE, "duration": 4.0}),
        ("pair, falling", "synthetic-pair", law(FALLING, duration=3.0)),
        ("pair, heated", "synthetic-pair", law(HEATED, duration=3.0)),
        ("pair, locked", "synthetic-pair", {"duration": 2.0, "isolator": {"period": 2.0, "lubrication": 1e5}}),
    )
}
SCENES["frame"] = frame(5.0)
SCENES["frame on a plane"] = frame(5.0).with_values({"isolator": {"radius": math.inf, "friction": 0.05}})


@pytest.mark.parametrize("name", SCENES)
def test_every_factor_lies_within_its_error(name: str) -> None:
    engine, equations = both_sides(SCENES[name], PHASES if name in ("fig3-I", "plane") else PHASES[:1], V_REG)
    assert (engine.error <= 1e-3 * engine.mu).all()
    if SCENES[name].flat:
        np.testing.assert_allclose(engine.displacement, equations.displacement, rtol=5e-3)


LEVEL = {"bodies": [{"mass": 1.0, "height": 0.0, "size": [2.0, 2.0, 0.2]}], "duration": 2.0}


@pytest.mark.parametrize(
    ("values", "apart"),
    [
        (law(RISING), 0.0),
        (law(FALLING), 0.0),
        (law({"slow": 0.1, "load_exponent": 0.2}, **VERTICAL), 5e-3),  # four contacts share the load
        (law(HEATED), 0.0),
        ({**PLANE, "excitation.scale": 2}, 0.0),
    ],
    ids=["rising", "falling", "pressed", "heated", "plane"],
)
def test_supports_have_the_friction_of_their_own_speed_and_load(values: dict[str, Any], apart: float) -> None:
    """A body level with its contacts does not turn: the spatial model has the motion of the translational one."""
    scene = load_scene("fig3-I").with_values({**LEVEL, **values})
    spatial, moving = (
        multibody.amplification(scene, PHASES[:1], model, full=True) for model in ("spatial", "translational")
    )
    assert_within(spatial, moving.mu, apart * moving.mu if apart else moving.error)


STRONG = {"excitation.amplitudes": [[2.0, 0.0], [0.0, 2.0]]}
OBLIQUE = {"amplitudes": [[-3.0, -0.63], [4.5, 3.6]], "periods": [1.58, 1.89], "decay": [0.46, 0.43]}
STIFF = {
    "isolator": {"radius": 0.17, "friction": 0.0755},
    "bodies": [{"mass": 1.0}, {"mass": 2.06, "period": [1.9, 0.58], "damping": 0.02}],
    "excitation": OBLIQUE,
}


@pytest.mark.parametrize(
    ("values", "phase", "v_reg"),
    [
        ({"duration": 0.1, **STRONG, "excitation.decay": [1e3, 0.3]}, PHASES[0], V_REG),
        ({"duration": 0.6, **STRONG, "bodies.1.period": [1e-2, 8e-3]}, PHASES[0], V_REG),  # undamped, it rings at first
        ({"duration": 3.0, **STRONG}, PHASES[0], 1e-4),  # two levels agree to 0.9 of what both are off
        # what the prediction of a step misses presses a stiff contact: Newton's first residual is large
        ({"duration": 1.2, **STIFF}, (1.8, 1.27), 1.1e-4),
    ],
    ids=["decay 1e3/s", "link 1e-2 s", "v_reg 1e-4 m/s", "contact made stiff by a small v_reg"],
)
def test_the_error_holds_where_a_scene_is_quick(values: dict[str, Any], phase: Any, v_reg: float) -> None:
    both_sides(load_scene("fig3-I").with_values(values), [phase], v_reg)


def test_a_tower_under_a_millionth_of_the_loading_has_its_factors() -> None:
    """It turns by as much less as it sways."""
    scene = load_scene("fig3-I").with_values({"duration": 3.0}).with_amplitude(1e-6)
    both_sides(scene, PHASES[:2], model="spatial")


@pytest.mark.long
@pytest.mark.parametrize(
    ("scene", "count", "v_reg"),
    [("fig3-I", 256, V_REG), ("fig3-II", 128, V_REG), ("fig3-I", 16, 1e-4), ("fig3-II", 16, 1e-4)],
)
def test_a_whole_surface_lies_within_its_errors(scene: str, count: int, v_reg: float) -> None:
    phases = np.vstack([PHASES[:1], np.random.default_rng(11).uniform(0.0, 2.0 * np.pi, (count - 1, 2))])
    engine, equations = both_sides(load_scene(scene), phases, v_reg)
    assert (engine.error <= 1e-3 * engine.mu).all()
    gap = np.abs(engine.mu - equations.mu) / equations.mu
    assert gap.max() <= 2e-3
    assert (np.median(gap, axis=0) <= 1e-4).all()


@pytest.mark.long
@pytest.mark.parametrize("model", ["translational", "spatial"])
@pytest.mark.parametrize("scene", ["fig3-I", "fig3-II", "fig4-dry", "fig4-viscous"])
def test_no_finer_run_contradicts_an_answer(scene: str, model: str, within: Callable[[float, float], None]) -> None:
    """A tolerance of 1e-5 is met by few points; the error that is left to the others counts as well."""
    phases = np.random.default_rng(32).uniform(0.0, 2.0 * np.pi, (16, 2))
    v_reg = None if load_scene(scene).lubricated else V_REG
    coarse, fine = (
        multibody.amplification(load_scene(scene), phases, model, v_reg, tolerance, max_work=2e7)
        for tolerance in (1e-3, 1e-5)
    )
    assert set(coarse.status) == {Outcome.OK}
    assert (fine.error <= 0.5 * coarse.error).all()
    within((np.abs(coarse.mu - fine.mu) / (coarse.error + fine.error)).max(), 1.0)


@pytest.mark.parametrize("v_reg", [1e-4, 1e-5])
def test_a_sharp_corner_asks_for_a_quick_contact(v_reg: float) -> None:
    # the contact of 1e-6 rho is 3 or 30 times slower than the friction relaxes: off by 1.4e-4 and 7e-4, estimate less
    engine, equations = both_sides(load_scene("fig3-I").with_values({"duration": 4.0}), PHASES[:1], v_reg)
    np.testing.assert_allclose(engine.mu, equations.mu, rtol=8e-5)
