"""Links of bars, k = 12 n E J / l^3: softer under the weight that they carry, and refused where they would buckle."""

import math
from typing import Any

import numpy as np
import pytest
from chains import refusal
from elastic_chain import beam_column

import multibody
import reference
from reference.problem import GRAVITY, Scene, SceneError, load_scene
from reference.problem.beam_column import buckling_load, stability_functions
from reference.problem.reductions import is_planar, turn_loading_to_x

PHASES = [(0.3, 1.1), (2.0, 0.7), (4.0, 5.5), (1.0, 3.0)]
FIG3 = load_scene("fig3-I")
BARS = {"count": 4, "bending_stiffness": 0.8, "length": 1.0}
CHAINS: list[tuple[list[float], dict[str, Any]]] = [  # masses from below; bars of every link
    ([1.0, 0.01], BARS),
    ([2.0, 1.0, 0.5], {"count": 3, "bending_stiffness": 3.0, "length": 1.5}),
]


def chain(masses: list[float], bars: dict[str, Any], **values: Any) -> Scene:
    platform, *others = ({"mass": mass} for mass in masses)
    bodies = [platform, *({**body, "bars": bars} for body in others)]
    return FIG3.with_values({"duration": 3.0, "bodies": bodies, **values})


@pytest.mark.parametrize(("masses", "bars"), CHAINS)
def test_bars_have_the_stiffness_of_beam_columns(masses: list[float], bars: dict[str, Any]) -> None:
    scene = chain(masses, bars)
    for each, weighs in ((scene, 0.0), (scene.softened(), GRAVITY)):
        for link, stiffness in enumerate(each.stiffness):
            load = weighs * sum(masses[link + 1 :]) / bars["count"]
            sway = bars["count"] * beam_column(bars["bending_stiffness"], bars["length"], load)[0]
            assert stiffness[0] == stiffness[1] == pytest.approx(sway, rel=1e-9)
    assert scene.softened().softened() == scene.softened()


def test_factors_have_their_closed_forms_and_their_slope() -> None:
    for q in (1e-3, 0.3, 1.0, 2.0, 2.46):
        x, factors, step = math.sqrt(q), stability_functions(q), 1e-5
        assert factors.sway == pytest.approx(q / (3.0 * (math.tan(x) / x - 1.0)), rel=1e-10)
        assert factors.bending == pytest.approx(x / math.tan(x), rel=1e-10)
        slope = (stability_functions(q + step).sway - stability_functions(q - step).sway) / (2.0 * step)
        assert factors.sway_slope == pytest.approx(slope, rel=1e-8)
    buckled = stability_functions(buckling_load(1.0, 1.0) / 4.0)
    assert (buckled.sway, buckled.bending) == pytest.approx((0.0, 0.0), abs=1e-15)


def test_bars_that_would_buckle_are_refused_with_both_loads() -> None:
    limit = math.pi**2 * 0.8 * 4 / GRAVITY
    assert chain([1.0, 0.999 * limit], BARS).softened().stiffness[0, 0] < 0.1
    said = str(refusal(chain([1.0, 1.001 * limit], BARS).softened, kind=SceneError))
    assert said.startswith("fig3-I[duration=3, bodies changed]: bodies.1.bars: weight on each bar in N = 7.90")
    assert "must be below pi^2 E J / l^2 = 7.89568 N" in said
    slender = {"bodies.2.bars.bending_stiffness": 0.05, "bodies.1.bars.load_effect": None}
    said = refusal(chain([1.0, 1.0, 1.0], {**BARS, "load_effect": "softening"}).with_values, slender)
    assert said.key.startswith("bodies.2.bars: weight on each bar"), "the upper link alone"
    heavy = chain([1.0, limit + 1.0], BARS)
    assert multibody.refusal(heavy, softened=True).startswith("refused before any step: ")
    assert multibody.refusal(heavy) == ""


def test_only_bars_are_softened_and_turned_into_a_plane() -> None:
    assert (FIG3.softened(), FIG3.softened().digest()) == (FIG3, FIG3.digest())
    loaded = chain([1.0, 1.0, 1.0], BARS | {"bending_stiffness": 2.0})
    mixed = loaded.with_values({"bodies.1.bars": None, "bodies.1.stiffness": [20.0, 30.0]})
    assert mixed.softened().stiffness[0].tolist() == [20.0, 30.0]
    assert (mixed.has_unloaded_bars, mixed.softened().has_unloaded_bars) == (True, False)
    assert mixed.softened().stiffness[1, 0] < mixed.stiffness[1, 0] == loaded.stiffness[1, 0]
    along_y = loaded.with_values({"excitation.amplitudes": [[0.0, 0.0], [2.0, 1.0]]})
    assert is_planar(along_y)
    assert turn_loading_to_x(along_y).stiffness.tolist() == loaded.stiffness.tolist()


def test_bars_that_cannot_hold_the_bodies_upright_are_refused() -> None:
    bars = {"count": 4, "bending_stiffness": 500.0, "length": 0.5, "axial_stiffness": 1e9, "spread": 0.0}
    tall = {"bodies.1.period": None, "bodies.1.bars": bars, "bodies.1.height": 6.0}
    FIG3.with_values({**tall, "bodies.1.mass": 100.0})
    FIG3.with_values({**tall, "bodies.1.mass": 1000.0, "bodies.1.bars": {**bars, "spread": 0.5}})
    for effect in ("softening", "shortening"):  # bars that shorten let the weight sink elsewhere, by as much
        loaded = {**tall, "bodies.1.bars": {**bars, "load_effect": effect}}
        FIG3.with_values({**loaded, "bodies.1.mass": 144.6})
        said = refusal(FIG3.with_values, {**loaded, "bodies.1.mass": 144.7})
        rule = "the bodies topple under their weight: take stiffer bars, a larger spread or lower bodies"
        table = {key: loaded["bodies.1.bars"][key] for key in said.value}
        assert (said.key, said.value, said.rule) == ("bodies.1.bars", table, rule)
        # a body between, on a stiff link that does not bend, raises the tower and nothing else
        between, top = {"mass": 2.0, "height": 3.0, "stiffness": [1e12, 1e12]}, {"mass": 144.6, "height": 8.8}
        bodies = [{"mass": 1.0, "height": 0.2}, between, {**top, "bars": loaded["bodies.1.bars"]}]
        FIG3.with_values({"bodies": bodies})
        bodies[2]["mass"] = 144.7
        assert refusal(FIG3.with_values, {"bodies": bodies}).key == "bodies.2.bars"
        bodies[1] = {"mass": 2.0, "height": 3.0, "bars": {**loaded["bodies.1.bars"], "count": 5}}
        said = refusal(FIG3.with_values, {"bodies": bodies})
        assert (said.key, said.value["count"]) == ("bodies.1.bars", 5), "the lowest of them"
        # a body above, on a link that is soft along one axis alone
        below, above = {"mass": 2.0, "height": 3.0, "bars": loaded["bodies.1.bars"]}, {"mass": 60.0, "height": 6.0}
        bodies = [{"mass": 1.0, "height": 0.2}, below, {**above, "stiffness": [1e12, 1e12]}]
        FIG3.with_values({"bodies": bodies})
        for soft in ([200.0, 1e12], [1e12, 200.0]):
            bodies[2]["stiffness"] = soft
            assert refusal(FIG3.with_values, {"bodies": bodies}).key == "bodies.1.bars"


def test_both_sides_agree_like_for_like_with_softened_bars() -> None:
    scene = chain([1.0, 1.0], BARS, duration=2.0).with_amplitude(2.0)
    equations = reference.amplification(scene.softened(), PHASES, regularization=1e-3)
    engine = multibody.amplification(scene, PHASES, softened=True)
    assert set(equations.status) == set(engine.status) == {"ok"}
    assert (np.abs(engine.mu - equations.mu) <= engine.error + equations.error).all()
    effect = multibody.amplification(scene, PHASES, softened=True, regularization_effect=True).regularization_effect
    finer = multibody.amplification(scene, PHASES, softened=True, regularization=1e-4)
    np.testing.assert_array_equal(effect, finer.mu - engine.mu)
    unloaded = reference.amplification(scene, PHASES, regularization=1e-3)
    assert (np.abs(unloaded.mu - equations.mu) > 3.0 * equations.error).any(axis=1).all(), "softening shows"
