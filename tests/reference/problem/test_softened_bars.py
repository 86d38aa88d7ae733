"""Bars under the weight that they carry: softer, and refused where they would buckle."""

import math
from typing import Any

import numpy as np
import pytest
from elastic_chain import beam_column

import multibody
import reference
from reference.problem import GRAVITY, Scene, SceneError, load_scene
from reference.problem.beam_column import buckling_load, load_factors

PHASES = [(0.3, 1.1), (2.0, 0.7), (4.0, 5.5), (1.0, 3.0)]
BARS = {"count": 4, "bending_stiffness": 0.8, "length": 1.0}
CHAINS: list[tuple[list[float], dict[str, Any]]] = [  # masses from below; bars of every link
    ([1.0, 1.0], BARS),
    ([1.0, 0.1], {"count": 1, "bending_stiffness": 0.2, "length": 1.0}),
    ([1.0, 0.01], BARS),
    ([2.0, 1.0, 0.5], {"count": 3, "bending_stiffness": 3.0, "length": 1.5}),
    ([1e5, 1e5, 1e5, 1e5], {"count": 8, "bending_stiffness": 1e6, "length": 3.0}),
    ([0.5, 0.5, 0.5, 0.5, 0.5, 0.5], {"count": 6, "bending_stiffness": 0.45, "length": 0.8}),
]


def chain(masses: list[float], bars: dict[str, Any], **values: Any) -> Scene:
    platform, *others = ({"mass": mass} for mass in masses)
    bodies = [platform, *({**body, "bars": bars} for body in others)]
    return load_scene("fig3-I").with_values({"duration": 3.0, "bodies": bodies, **values})


@pytest.mark.parametrize(("masses", "bars"), CHAINS)
def test_softened_bars_have_the_stiffness_of_beam_columns(masses: list[float], bars: dict[str, Any]) -> None:
    softened = chain(masses, bars).softened()
    for link, stiffness in enumerate(softened.stiffness):
        load = GRAVITY * sum(masses[link + 1 :]) / bars["count"]
        sway = bars["count"] * beam_column(bars["bending_stiffness"], bars["length"], load)[0]
        assert stiffness[0] == stiffness[1] == pytest.approx(sway, rel=1e-9)


def test_a_small_load_takes_six_fifths_of_itself_over_the_length() -> None:
    for load in (1e-3, 1e-6, 1e-9, 1e-12):
        lost = 12.0 * (1.0 - load_factors(0.25 * load).sway)
        assert lost == pytest.approx(1.2 * load, rel=load, abs=3e-15)


@pytest.mark.parametrize("q", [1e-3, 0.3, 1.0, 2.0, 2.46])
def test_factors_have_their_closed_forms_and_their_slope(q: float) -> None:
    x, factors = math.sqrt(q), load_factors(q)
    assert factors.sway == pytest.approx(q / (3.0 * (math.tan(x) / x - 1.0)), rel=1e-10)
    assert factors.bending == pytest.approx(x / math.tan(x), rel=1e-10)
    step = 1e-5
    slope = (load_factors(q + step).sway - load_factors(q - step).sway) / (2.0 * step)
    assert factors.sway_slope == pytest.approx(slope, rel=1e-8)


def test_both_factors_vanish_at_the_buckling_load() -> None:
    factors = load_factors(buckling_load(1.0, 1.0) / 4.0)
    assert (factors.sway, factors.bending) == pytest.approx((0.0, 0.0), abs=1e-15)


def test_bars_that_would_buckle_are_refused_with_both_loads() -> None:
    limit = math.pi**2 * BARS["bending_stiffness"] * BARS["count"] / GRAVITY
    assert chain([1.0, 0.999 * limit], BARS).softened().stiffness[0, 0] < 0.1
    with pytest.raises(SceneError, match=r"1\.bars: weight on each bar in N = 7\.9.*below pi\^2 .*= 7\.89") as caught:
        chain([1.0, 1.001 * limit], BARS).softened()
    assert "\n" not in str(caught.value)
    assert multibody.refusal(chain([1.0, limit + 1.0], BARS), softened=True).startswith("refused before any step: ")
    assert multibody.refusal(chain([1.0, limit + 1.0], BARS)) == ""


def test_only_bars_without_load_are_softened() -> None:
    scene = load_scene("fig3-I")
    assert scene.softened() == scene
    assert scene.softened().digest() == scene.digest()
    loaded = chain([1.0, 1.0, 1.0], BARS | {"bending_stiffness": 2.0})
    assert loaded.softened().softened() == loaded.softened()
    mixed = loaded.with_values({"bodies.1.bars": None, "bodies.1.stiffness": [20.0, 30.0]})
    assert mixed.softened().stiffness[0].tolist() == [20.0, 30.0]
    assert mixed.softened().stiffness[1, 0] < mixed.stiffness[1, 0] == loaded.stiffness[1, 0]


@pytest.mark.parametrize(
    ("bars", "rule"),
    [
        ({"load_effect": "shortening"}, "needs axial_stiffness"),
        ({"load_effect": "buckling"}, "'softening' or 'shortening'"),
        ({"axial_stiffness": 10.0, "count": 2}, "needs 3 bars or more"),
        ({"axial_stiffness": 0.0}, "greater than 0"),
        ({"spread": -1.0}, "greater than or equal to 0"),
    ],
)
def test_keys_of_bars_that_do_not_fit_are_refused_in_one_line(bars: dict[str, Any], rule: str) -> None:
    with pytest.raises(SceneError, match=rule) as caught:
        chain([1.0, 1.0], {**BARS, **bars})
    assert "\n" not in str(caught.value)


def test_bars_that_cannot_hold_the_bodies_upright_are_refused() -> None:
    scene = load_scene("fig3-I")
    bars = {"count": 4, "bending_stiffness": 500.0, "length": 0.5, "axial_stiffness": 1e9, "spread": 0.0}
    tall = {"bodies.1.period": None, "bodies.1.bars": bars, "bodies.1.mass": 100.0, "bodies.1.height": 6.0}
    scene.with_values(tall)
    with pytest.raises(SceneError, match="topple under their weight"):
        scene.with_values({**tall, "bodies.1.mass": 1000.0})
    scene.with_values({**tall, "bodies.1.mass": 1000.0, "bodies.1.bars": {**bars, "spread": 0.5}})
    for effect in ("softening", "shortening"):  # bars that shorten let the weight sink elsewhere, by as much
        loaded = {**tall, "bodies.1.bars": {**bars, "load_effect": effect}}
        scene.with_values({**loaded, "bodies.1.mass": 144.6})
        with pytest.raises(SceneError, match="topple under their weight"):
            scene.with_values({**loaded, "bodies.1.mass": 144.7})


def _agree(scene: Scene, phases: Any) -> None:
    softened = scene.softened()
    equations = reference.amplification(softened, phases, regularization=1e-3)
    engine = multibody.amplification(scene, phases, softened=True)
    assert set(equations.status) == set(engine.status) == {"ok"}
    assert (np.abs(engine.mu - equations.mu) <= engine.error + equations.error).all()
    unloaded = reference.amplification(scene, phases, regularization=1e-3)
    assert (np.abs(unloaded.mu - equations.mu) > 3.0 * equations.error).any(axis=1).all(), "softening shows"


def test_both_sides_agree_like_for_like_with_softened_bars() -> None:
    _agree(chain([1.0, 1.0], {**BARS, "load_effect": None}, duration=2.0).with_amplitude(2.0), PHASES)


@pytest.mark.long
@pytest.mark.parametrize(("masses", "bars"), CHAINS[2:4])
def test_both_sides_agree_with_softened_bars_on_64_phases(masses: list[float], bars: dict[str, Any]) -> None:
    phases = np.stack(np.meshgrid(*[np.arange(8) * np.pi / 4.0] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
    _agree(chain(masses, bars, duration=6.0).with_amplitude(2.0), phases)
