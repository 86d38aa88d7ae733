"""Derivatives with respect to values of the scene, against closed forms and a law of scaling."""

import re
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from chains import chain, refusal

import reference
from reference import Estimate, Estimates, Scene, SceneError, derivatives, sensitivity
from reference.derivatives import FINITE_CHANGES, Sensitivity, describe_kink
from reference.problem import Outcome

ONE_BODY = chain(0.25, 0.08, [2.0], (), [[1.5, 0.4], [0.3, 1.2]], duration=6.0)


def test_a_power_of_a_value_has_its_derivative_within_the_error() -> None:
    def cube(scene: Scene) -> Estimate:
        return Estimate(scene.isolator.friction**-3.0, 1e-9)  # type: ignore[operator]

    found = sensitivity(ONE_BODY, ["isolator.friction"], cube)["isolator.friction"]
    missed = abs(found.value - -3.0 * 0.08**-4.0)
    assert missed <= found.error <= 1e-5 * abs(found.value)


def test_the_error_of_the_quantity_is_over_the_step() -> None:
    """1.6 % of the value is the largest step, over which (4 near - far) / 3 has three times the error."""
    found = sensitivity(ONE_BODY, ["bodies.0.mass"], lambda scene: Estimate(scene.total_mass, 1e-3))["bodies.0.mass"]
    assert (found.value, found.error) == pytest.approx((1.0, 3.0 * 1e-3 / (1.6e-2 * 2.0)))
    turned = ONE_BODY.with_values({"bodies.0.yaw": -0.5})
    found = sensitivity(turned, ["bodies.0.yaw"], lambda scene: Estimate(scene.yaws[0], 1e-3))["bodies.0.yaw"]
    assert (found.value, found.error) == pytest.approx((1.0, 3.0 * 1e-3 / (1.6e-2 * 0.5))), "of a value below zero"

    def uneven(scene: Scene) -> tuple[list[float], list[float]]:
        mass = scene.total_mass
        return [mass, mass**40.0], [{-1.0: 1.0, 0.0: 5.0, 1.0: 3.0}[np.sign(mass - 2.0)], 0.0]

    found = sensitivity(ONE_BODY, ["bodies.0.mass"], uneven)["bodies.0.mass"]
    assert found.error[0] == pytest.approx((4.0 * (1.0 + 10.0 + 3.0) / 2.0 + 14.0 / 4.0) / 3.0 / (1.6e-2 * 2.0))
    assert found.change.error[:, 0].tolist() == [6.0, 6.0, 8.0, 8.0]


def test_a_kink_within_the_step_shows_in_the_error() -> None:
    def kinked(scene: Scene) -> Estimate:
        return Estimate(max(scene.isolator.friction - 0.08, 0.0), 0.0)  # type: ignore[operator]

    found = sensitivity(ONE_BODY.with_values({"isolator.friction": 0.080001}), ["isolator.friction"], kinked)
    assert abs(found["isolator.friction"].value - 1.0) <= found["isolator.friction"].error


def test_what_has_no_derivative_is_refused_or_unknown() -> None:
    found = sensitivity(ONE_BODY, ["isolator.friction"], lambda scene: Estimate(np.nan, np.nan))
    assert np.isnan(found["isolator.friction"].value)
    for keys, kind, said in (
        (["isolator.frictio"], SceneError, "did you mean friction"),
        (["title"], ValueError, "must be a number"),
        (["isolator.lubrication"], ValueError, "must be a number"),
        ("isolator.friction", TypeError, "keys = 'isolator.friction': must be a list of keys"),
    ):
        assert said in str(refusal(sensitivity, ONE_BODY, keys, lambda scene: Estimate(1.0, 0.0), kind=kind))
    line = str(refusal(sensitivity, ONE_BODY, ["isolator.friction"], lambda scene: scene.masses, kind=TypeError))
    assert line.startswith("quantity: returns array(")
    assert "must return an Amplification" in line
    for wrong in (
        (),
        (1.0,),
        (1.0, "a"),
        ([1.0, 2.0], 0.1),
        1.0,
        None,
        (Estimate(1.0, 0.1), 2.0),
        ([], []),
        Outcome.OK,
    ):
        assert "quantity: returns" in str(
            refusal(sensitivity, ONE_BODY, ["isolator.friction"], lambda scene, found=wrong: found, kind=TypeError)
        )


FRICTION = "isolator.friction"
AT = 0.08


def along_friction(law: Callable[[float], float], error: float = 1e-9) -> Sensitivity:
    """What is found of a law of the coefficient of friction, 0.08 in the scene."""
    return sensitivity(ONE_BODY, [FRICTION], lambda scene: Estimate(law(scene.isolator.friction), error))[FRICTION]  # type: ignore[arg-type]


def bent(at: float, below: float, beyond: float, jump: float = 0.0) -> Callable[[float], float]:
    return lambda friction: (below if friction < at else beyond) * (friction - at) + (jump if friction > at else 0.0)


@pytest.mark.parametrize("share", [-0.043, -0.02, -0.004, 0.0, 0.0005, 0.004, 0.012, 0.03, 0.043])
@pytest.mark.parametrize(("below", "beyond"), [(-15.1, 10.0), (22.0, -3.0), (4.0, 20.0)])
def test_a_kink_within_five_percent_is_located_with_the_slopes_beside_it(
    share: float, below: float, beyond: float
) -> None:
    at = AT * (1.0 + share)
    found = along_friction(bent(at, below, beyond))
    assert abs(found.kink.value - at) <= found.kink.error * (1.0 + 1e-9)
    assert found.kink.error <= 1e-3 * AT
    assert found.slopes == pytest.approx((below, beyond), rel=1e-2)
    assert found.jump == 0.0
    assert found.warning == describe_kink(FRICTION, AT, found.kink, found.slopes)
    assert found.warning in repr(found)


def test_a_jump_is_told_from_a_kink() -> None:
    found = along_friction(bent(0.083, 2.0, 2.0, jump=0.3))
    assert found.jump == pytest.approx(0.3, rel=1e-2)
    assert abs(found.kink.value - 0.083) <= found.kink.error
    assert found.warning.startswith("jump by 0.3 at isolator.friction = 0.082998 ± 3e-06 (+3.7 %)")


@pytest.mark.parametrize(
    "law",
    [lambda f: 3.0 * f, lambda f: f**-3.0, lambda f: f**8.0, lambda f: np.exp(20.0 * f), lambda f: np.sin(30.0 * f)],
)
def test_a_smooth_quantity_has_no_kink_and_no_warning(law: Callable[[float], float]) -> None:
    found = along_friction(law, error=1e-15)
    assert np.isnan([found.kink.value, *found.slopes]).all()
    assert found.warning == ""


def test_what_is_strongly_curved_is_no_kink_but_is_said() -> None:
    found = along_friction(lambda friction: np.sin(400.0 * friction))
    assert np.isnan(found.kink.value)
    assert "departs by" in found.warning
    assert found.warning.endswith("from the derivative: no kink found")


def test_noise_within_the_errors_is_no_kink() -> None:
    found = along_friction(lambda friction: 2.0 * friction + 1e-4 * np.sin(1e6 * friction), error=1e-4)
    assert np.isnan(found.kink.value)
    curved = along_friction(lambda friction: np.sin(400.0 * friction), error=2e-2)
    assert np.isnan(curved.kink.value), "an interval that errors keep wide shows no kink"


def test_every_part_of_an_error_counts() -> None:
    """Of an odd function what extrapolation changes; of a slope over 5 % its own, and that of the derivative."""
    odd = along_friction(lambda friction: (friction - AT) ** 5, error=0.0)
    assert 0.0 < abs(odd.value) <= odd.error
    steep = Estimates(np.array([[-0.07, -0.01, 0.01, 0.07]]).T, np.full((4, 1), 0.01))  # 1.4 over 5 %
    for slope, contradicted in ((0.2, False), (0.1, True)):
        found = derivatives._find_contradiction(Estimates(np.array([1.0]), np.array([slope])), steep, 1.0)
        assert found == (0, pytest.approx(0.4), contradicted), slope
    both = Estimates(np.hstack([-np.array([[0.05, 0.01, -0.01, -0.05]]).T, steep.value]), np.zeros((4, 2)))
    assert derivatives._find_contradiction(Estimates(np.ones(2), np.zeros(2)), both, 1.0)[0] == 1
    valley = Estimates(np.array([[0.07, 0.01, 0.01, 0.0712]]).T, np.zeros((4, 1)))  # level over 5 %, for its slopes
    line = Estimates(np.array([[0.05, 0.01, -0.01, -0.05]]).T, np.zeros((4, 1)))  # by a value below zero
    for slope, change, at in ((0.0, valley, 1.0), (1.0, line, -1.0)):
        found = derivatives._find_contradiction(Estimates(np.array([slope]), np.zeros(1)), change, at)
        assert found == (None, 0.0, False)
    ends = (derivatives._QuantityAtValue(at, value, 0.0) for at, value in ((0.0, 0.0), (2.0, 7.0)))
    assert derivatives._Bracket(*ends, below=1.0, beyond=3.0).jump == 7.0 - 2.0 * 2.0, "the mean of both slopes"


def test_errors_of_every_point_hide_a_kink() -> None:
    """A slope of 1 begins at 1; errors of the intervals around it, and of both ends and the middle of a bracket."""

    def level(at: float) -> derivatives._QuantityAtValue:
        return derivatives._QuantityAtValue(at, 0.0, 0.0)

    for errors, seen in (
        ((0, 0, 0, 0), True),
        ((1.1, 0, 0, 0), False),
        ((0.6, 0, 0, 0), True),
        ((0.6, 0, 0.6, 0), False),
    ):
        rows = zip((0.0, 1.0, 2.0, 3.0), (0.0, 0.0, 1.0, 2.0), errors)
        points = [derivatives._QuantityAtValue(*row) for row in rows]
        assert (derivatives._bracket_kink(points, level) is not None) == seen, errors
    for low, middle, high in ((0.06, 0.0, 0.0), (0.0, 0.03, 0.0), (0.0, 0.0, 0.06)):
        ends = (derivatives._QuantityAtValue(at, abs(at), error) for at, error in ((-1.0, low), (1.2, high)))
        wide = derivatives._Bracket(*ends, below=-1.0, beyond=1.0)
        same = derivatives._halve_bracket(wide, lambda at, e=middle: derivatives._QuantityAtValue(at, abs(at), e), 1e-4)
        assert same == wide


def test_a_sentence_about_a_kink_says_place_sides_and_what_is_there() -> None:
    said = describe_kink("duration", 2.0, Estimate(1.98, 0.001), (-3.0, 4.0), 0.0)
    assert said == "kink at duration = 1.98 ± 0.001 (-1 %): slope -3 below and 4 beyond it"
    assert describe_kink("duration", 2.0, Estimate(2.04, 0.001), (1.0, 1.0), -0.5).startswith("jump by -0.5 at ")


def test_finite_changes_stand_beside_the_derivative() -> None:
    asked: list[float] = []
    found = along_friction(lambda friction: asked.append(friction) or friction**2.0)
    assert len(asked) == len({*asked}) == 1 + derivatives.RUNS_PER_KEY == 17, "three steps, twice each, and changes"
    moved = AT * (1.0 + np.array(FINITE_CHANGES))
    assert FINITE_CHANGES == (-0.05, -0.01, 0.01, 0.05)
    np.testing.assert_allclose(found.change.value, moved**2.0 - AT**2.0, rtol=1e-12)
    np.testing.assert_allclose(found.change.error, 2e-9)
    assert (found.key, found.at) == (FRICTION, AT)


def test_a_change_without_an_answer_is_unknown_and_costs_nothing_else() -> None:
    def ends(scene: Scene) -> Estimate:
        if scene.isolator.friction > 0.083:  # type: ignore[operator]
            raise ValueError("no phase pair has an answer")
        return Estimate(scene.isolator.friction, 1e-9)  # type: ignore[arg-type]

    found = sensitivity(ONE_BODY, [FRICTION], ends)[FRICTION]
    for column in (found.change.value, found.change.error):
        assert np.isnan(column).tolist() == [False, False, False, True]
    assert found.value == pytest.approx(1.0)


def test_a_derivative_is_that_of_the_steps_at_which_the_quantity_has_values() -> None:
    """It is unknown from 2 % above the value on, which only the widest of the steps reaches."""
    asked: list[float] = []

    def ends(scene: Scene) -> Estimate:
        asked.append(scene.isolator.friction / AT)  # type: ignore[operator]
        return Estimate(np.nan if asked[-1] > 1.02 else AT * asked[-1], 1e-9)

    found = sensitivity(ONE_BODY, [FRICTION], ends)[FRICTION]
    assert sum(1.02 < share < 1.049 for share in asked) == 1
    assert (found.value, np.isfinite(found.error)) == (pytest.approx(1.0), True)


class Uncertain:
    """An object of another package."""

    def __init__(self, value: float) -> None:
        self.value, self.error = value, 1e-9


def test_whatever_has_a_value_and_an_error_is_taken() -> None:
    def found(quantity: Callable[[Scene], Any]) -> Sensitivity:
        return sensitivity(ONE_BODY, ["bodies.0.mass"], quantity)["bodies.0.mass"]

    for quantity in (
        lambda scene: Uncertain(scene.total_mass),
        lambda scene: (scene.total_mass, 1e-9),
        lambda scene: Estimate(scene.total_mass, 1e-9),
    ):
        assert found(quantity).value == pytest.approx(1.0)
    for quantity in (
        lambda scene: (scene.total_mass * np.arange(3.0), np.array([1e-9, 1e-6, 1e-8])),
        lambda scene: tuple(Estimate(scene.total_mass * n, 1e-9) for n in range(3)),
        lambda scene: [Uncertain(scene.total_mass * n) for n in range(3)],
        lambda scene: Estimates(scene.total_mass * np.arange(3.0), np.full(3, 1e-9)),
    ):
        assert found(quantity).value == pytest.approx(np.arange(3.0))
        assert f"0 to 2 ± {found(quantity).error.max():.1g};" in repr(found(quantity))
    two = found(lambda scene: (Estimate(scene.total_mass, 0.0), Estimate(2.0 * scene.total_mass, 0.0)))
    assert two.value == pytest.approx([1.0, 2.0]), "two estimates are no pair of value and error"


def test_a_derivative_says_which_reading_its_quantity_has() -> None:
    def search(scene: Scene, **law: Any) -> reference.PhaseMaximum:
        return reference.worst_phases(scene, equations="small", tolerance=1e-3, starts=[(0.3, 1.1)], **law)

    scene = reference.load_scene("fig3-I").with_values({"duration": 1.0})
    for law, reading in (({}, "literal supremum"), ({"cutoff": 1e-3}, "as integrated")):
        found = sensitivity(scene, ["bodies.1.mass"], lambda scene, law=law: search(scene, **law))["bodies.1.mass"]
        assert found.reading == reading
        assert reading in repr(found)
        assert found.law.startswith("set-valued Coulomb friction; ")
    viscous = reference.load_scene("fig4-viscous").with_values({"duration": 0.5})
    surface = sensitivity(
        viscous, ["bodies.1.mass"], lambda s: reference.amplification(s, [(0.3, 1.1)], tolerance=1e-3)
    )
    assert surface["bodies.1.mass"].reading == "both agree"
    demand = sensitivity(
        viscous, ["bodies.1.mass"], lambda s: reference.demands(reference.trajectory(s, (0.3, 1.1))).drift
    )
    assert demand["bodies.1.mass"].reading == "not stated"
    assert demand["bodies.1.mass"].value.shape == (1,)


def test_each_of_several_quantities_has_its_own_error() -> None:
    def both(scene: Scene) -> list[Estimate]:
        return [Estimate(scene.total_mass, 1e-9), Estimate(2.0 * scene.total_mass, 1e-5)]

    found = sensitivity(ONE_BODY, ["bodies.0.mass"], both)["bodies.0.mass"]
    np.testing.assert_allclose(found.value, [1.0, 2.0], rtol=1e-3)
    assert found.error[1] > 100.0 * found.error[0] > 0.0


def test_long_work_says_on_standard_error_what_is_left(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    keys = [FRICTION, "bodies.0.mass"]
    sensitivity(ONE_BODY, keys, lambda scene: Estimate(scene.total_mass, 1e-9))
    assert capsys.readouterr().err == "", "two seconds are not over"
    monkeypatch.setattr(derivatives, "PROGRESS_AFTER", 0.0)

    def slow(scene: Scene) -> Estimate:
        time.sleep(0.07)
        return Estimate(scene.total_mass, 1e-9)

    sensitivity(ONE_BODY, keys, slow)
    first, second = capsys.readouterr().err.splitlines()
    assert re.fullmatch(r"sensitivity to isolator\.friction, key 1 of 2: about [2-9] s left", first), (
        "31 runs of 0.07 s"
    )
    assert re.fullmatch(r"sensitivity to bodies\.0\.mass, key 2 of 2: about [1-4] s left", second)
