"""Errata of the paper: every one has its row, and the effect of the printed form is what was measured."""

from collections.abc import Callable

import numpy as np
import pytest
from known_analyses import collected

from comparison.analyses.errata import analysis as errata
from comparison.analyses.errata import printed_matrices
from comparison.analyses.errata.analysis import ERRATA, PHASES, Errata, MeasuredErratum, cut_platform, measured
from comparison.analyses.errata.printed_matrices import WRONG_DAMPING, WRONG_SPRING, printed_amplification
from comparison.study.models import V_REG
from comparison.study.study import Study
from reference import amplification
from reference.problem import Amplification, Scene, load_scene


def test_effects_come_in_order_and_a_measure_that_fails_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def whole(scene: Scene) -> np.ndarray:
        return np.ones((2, 2))

    def breaks(scene: Scene) -> np.ndarray:
        raise RuntimeError("singular")

    half = (lambda scene: scene.name.startswith("fig3-I[")), (lambda scene: np.full((2, 2), 1.5)), whole

    monkeypatch.setattr(errata, "ERRATA", [MeasuredErratum(where, "p", "c", "w") for where in "abc"])
    monkeypatch.setattr(errata, "MEASURES", {0: half, 2: (lambda scene: True, breaks, whole)})
    study = Study((load_scene("fig3-I"), load_scene("fig3-II")), 2, 1e-3)
    halved, harmless, broken = [row.effects for row in collected(Errata(), study)]
    assert [(effect.scene, effect.erratum) for effect in halved] == [("fig3-I", 0), ("fig3-II", 0)]
    assert harmless == ()
    assert halved[0].change == ((0.5, 0.5), (0.5, 0.5))
    assert halved[1].change == (), "a scene the erratum does not touch"
    assert broken[0].error_message == "RuntimeError: singular"


@pytest.mark.parametrize("name", ["fig3-I", "fig4-viscous"])
def test_the_mended_matrices_are_the_exact_equations(name: str, within: Callable[[float, float], None]) -> None:
    """Written apart from the reference; what is left is the reading of peaks, 4e-5, and the integrator, 1e-5."""
    for damping in (None, [2.0, 0.5]):
        scene = load_scene(name).with_values({"duration": 2.0, "bodies.1.damping": damping})
        expected = amplification(scene, PHASES, regularization=None if scene.lubricated else V_REG).mu
        within(abs(printed_amplification(scene, PHASES) / expected - 1.0).max(), 1e-4)


def test_a_slip_has_its_own_effect() -> None:
    for name, slip, printed in (
        ("fig3-II", WRONG_SPRING, "c_24 = -k^x_21 Delta"),
        ("fig4-viscous", WRONG_DAMPING, "h_12, h_21 without rho; h_22 with xi'' Q; h_21 called h_11"),
    ):
        scene = load_scene(name).with_values({"duration": 1.0})
        change = printed_amplification(scene, PHASES, [slip]) / printed_amplification(scene, PHASES) - 1.0
        assert np.abs(change).max() > 1e-4
        (number,) = (number for number, erratum in enumerate(ERRATA) if erratum.printed == printed)
        assert np.array(measured((scene, number)).change) == pytest.approx(change, rel=1e-9)


@pytest.mark.parametrize("name", ["fig3-I", "fig4-viscous"])
def test_a_platform_cut_in_two_moves_small_equations_alone(name: str) -> None:
    scene = load_scene(name).with_values({"duration": 6.0})
    v_reg = None if scene.lubricated else V_REG
    whole, cut = (amplification(each, PHASES, regularization=v_reg).mu for each in (scene, cut_platform(scene)))
    np.testing.assert_allclose(cut[:, [0, 2]], whole, rtol=2e-4, err_msg="the exact equations know no difference")
    changes = {
        erratum.where: np.array(measured((scene, number)).change)
        for number, erratum in enumerate(ERRATA)
        if erratum.where in ("(4.3)", "(5.1)")
    }
    assert 5e-4 < np.abs(changes["(4.3)"][:, 0]).max() < 1e-2
    if scene.lubricated:
        assert not changes["(5.1)"].size
    else:
        assert np.abs(changes["(5.1)"][:, 0]).max() > 0.01
        assert np.abs(changes["(5.1)"][:, 1]).max() < 1e-4, "mu_2 has no such limit"


@pytest.mark.parametrize(
    ("where", "change"),
    [("after (2.3)", (1.0, 1.0)), ("after (2.5)", (0.5, 0.5)), ("(4.6)", (5.0, 5.0)), ("(5.1)", (1.5, 0.0))],
)
def test_the_change_is_that_of_the_printed_form(monkeypatch, where, change):
    """mu = 2 mended; on links 144 times softer 4, with friction 1 3, by (4.6) as printed 12, of halves 5 and 9."""
    whole = load_scene("fig3-I")

    def known(scene: Scene, phases: np.ndarray, rest_condition: str = "", **settings: object) -> Amplification:
        softer = scene.stiffness[-1, 0] == pytest.approx(whole.stiffness[-1, 0] / 144.0)
        mu = np.full((len(phases), len(scene.bodies)), 4.0 if softer else 2.0)
        if scene.friction_coefficient == 1.0:
            mu[:] = 3.0
        if rest_condition == "printed":
            mu[:] = 12.0
        if len(scene.bodies) == 3:
            mu[:, :2] = 5.0, 9.0
        return Amplification(mu, 0.0 * mu, np.full(len(mu), "ok"), np.full(len(mu), np.nan), 0.0)

    monkeypatch.setattr(errata.reference, "amplification", known)
    place = next(number for number, erratum in enumerate(ERRATA) if erratum.where == where)
    assert measured((whole, place)).change == (change,) * 2


def test_the_wrong_spring_of_y_is_that_of_x() -> None:
    """c_24 = -k^x_21 Delta, as (3.12) is printed: body 2 pulls the platform along y by the spring of x."""
    scene = load_scene("fig3-I")
    k_x, k_y = scene.stiffness[0]
    assert k_x != k_y
    printed, mended = (printed_matrices._fixed(scene, slips).links for slips in ([WRONG_SPRING], []))
    assert (mended[0, 2], mended[1, 3]) == (-k_x, -k_y)
    assert (printed[0, 2], printed[1, 3]) == (-k_x, -k_x)


def test_the_wrong_damping_has_no_rho_and_xi_in_the_place_of_eta() -> None:
    """At x = 0 and x' = 0 the matrix M is diagonal; the printed h_12 y' and h_22 y' differ as (3.15) is misprinted."""
    scene, y, vy, (xi, eta) = load_scene("fig4-viscous"), 0.05, 0.3, (0.7, 0.4)
    place, rate = np.array([0.0, y, 0.0, y]), np.array([0.0, vy, 0.0, vy])
    printed, mended = (
        printed_matrices._accelerations(printed_matrices._fixed(scene, slips), place, rate, np.array([xi, eta, 0.0]))
        for slips in ([WRONG_DAMPING], [])
    )
    m, rho, f = scene.masses[0], scene.radius, scene.friction_coefficient
    delta = -np.sqrt(rho**2 - y**2)
    r, s = y / delta, f * rho
    own = m * (delta - s * vy * r)
    expected = m * xi * r * f * (1.0 - rho) * vy / own, m * (xi - eta) * r * s * vy / (own + 2.0 * m * r * (y + s * vy))
    assert (printed - mended)[:2] == pytest.approx(expected, rel=1e-9)
