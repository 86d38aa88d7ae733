"""Fitted exponents, and the trends over scaled loading, ever smaller v_reg and ever stiffer contacts."""

from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest
from known_analyses import collected
from numpy.typing import NDArray

import multibody
import reference
from comparison.evidence.convergence import analysis as convergence
from comparison.evidence.convergence.analysis import CONVERGENCE_CASES, PENETRATIONS, Convergence, fit_limit_trends
from comparison.evidence.scaling.analysis import EXACT_MINUS_SMALL, SMALL_SCALE_DIFFERENCE, Scaling, scale_scene
from comparison.evidence.trends import Trend, fit_slope, fit_trend, word_trends
from comparison.study.shorten import shorten_scene
from comparison.study.study import Study
from reference import trajectory
from reference.problem import Amplification, Scene, ground_peak, load_scene
from reference.problem.readings import DEFAULT_V_C

Array = NDArray[np.float64]
SCALES = (1.0, 0.5, 0.25, 0.125)
S = np.array(SCALES)


def _power(exponent: float, *heights: float) -> Array:
    return np.array([height * S**exponent for height in heights])


def test_a_power_is_found_whatever_its_size_and_sign() -> None:
    for exponent in (0.5, 1.0, 2.0):
        sizes = _power(exponent, 1e-2, -3e-4)
        for points in (8, 7):
            slope = fit_slope(SCALES, sizes, 1e-9 * np.abs(sizes))
            assert slope.exponent == pytest.approx(exponent, abs=1e-9)
            assert slope.uncertainty < 1e-6
            assert (slope.points, slope.pairs) == (points, 2)
            sizes[0, 1] = np.nan  # a point without a value is left out
    sizes[1, 1] = 0.0  # of no size and no error
    assert fit_slope(SCALES, sizes, 1e-9 * np.abs(sizes))[2:] == (6, 2)
    few = fit_slope(SCALES, sizes * [[1.0, np.nan, 1.0, np.nan], [np.nan] * 4], np.zeros_like(sizes))
    assert (np.isnan(few.exponent), few.points) == (True, 2), "a line through two points has no scatter"
    nothing = fit_slope(SCALES, np.full((2, 4), np.nan), np.full((2, 4), np.nan))
    assert (nothing.points, np.isnan(nothing.exponent)) == (0, True)


def test_the_uncertainty_covers_the_scatter() -> None:
    """Two standard errors of a least-squares line with a height of its own for each phase pair."""
    sizes = _power(2.0, 1e-2, 2e-2, 3e-3) * np.exp(np.random.default_rng(4).normal(0.0, 0.1, (3, 4)))
    slope = fit_slope(SCALES, sizes, 1e-6 * np.abs(sizes))
    design = np.column_stack([np.tile(np.log(S), 3), np.kron(np.eye(3), np.ones((4, 1)))])
    found, [left], *_ = np.linalg.lstsq(design, np.log(sizes.ravel()), rcond=None)
    deviation = np.sqrt(left / (12 - 4) * np.linalg.inv(design.T @ design)[0, 0])
    assert (slope.exponent, slope.uncertainty) == pytest.approx((found[0], 2.0 * deviation), rel=1e-6)


def test_error_bars_alone_make_an_uncertainty() -> None:
    """The logarithms lie 1.5, 0.5, -0.5 and -1.5 times log 2 off their mean: squares of 5 together."""
    sizes = _power(1.0, 1e-2)
    scattered = sizes * np.exp([[0.01, -0.03, 0.03, -0.01]])  # of no slope
    spread = fit_slope(SCALES, scattered, 1e-9 * scattered).uncertainty
    for share in (0.1, 0.01):
        expected = 2.0 * share / (np.sqrt(5.0) * np.log(2.0))
        assert fit_slope(SCALES, sizes, share * sizes).uncertainty == pytest.approx(expected, rel=1e-6)
        both = fit_slope(SCALES, scattered, share * scattered).uncertainty
        assert both == pytest.approx(np.hypot(expected, spread), rel=1e-6)


def test_values_within_their_error_bars_are_not_fitted() -> None:
    sizes = _power(2.0, 1e-3)
    errors = np.full_like(sizes, 1e-4)  # the last two sizes, 6e-5 and 1.6e-5, drown, and 2.5e-4 is not known to a fifth
    assert np.isnan(fit_slope(SCALES, sizes, errors).exponent)
    noise = fit_trend("s", 1, "w", SCALES, sizes, errors, 2.0)
    assert noise.verdict == "within the error bars: no slope can be told"


@pytest.mark.parametrize(
    ("sizes", "expected", "says"),
    [
        (_power(2.0, 1e-2), 2.0, "like the power 2"),
        (_power(1.0, 1e-2), 2.0, "not like the power 2"),
        (np.array([[1e-2, 2e-3, 5e-3, 1e-5]]), 2.0, "no single slope: phase pairs or values do not agree"),
        (_power(0.29, 1e-2), None, "hardly falls: not converged at any value in use"),
        (_power(0.31, 1e-2), None, "falls"),
    ],
)
def test_the_verdict_says_what_the_fit_allows(sizes: Array, expected: float | None, says: str) -> None:
    assert fit_trend("s", 1, "w", SCALES, sizes, 1e-6 * np.abs(sizes), expected).verdict == says


def test_expected_exponents_are_counted_and_the_first_that_is_not_met_is_named() -> None:
    def told(scene: str, body: int, exponent: float, expected: float | None) -> Trend:
        sizes = _power(exponent, 1e-2)
        return fit_trend(scene, body, "small, exact", SCALES, sizes, 1e-3 * sizes, expected)

    noise = fit_trend("d", 1, "small, exact", SCALES, _power(2.0, 1e-3), np.ones((1, 4)), 2.0)
    met, missed, free, other = (
        told("a", 1, 2.0, 2.0),
        told("b", 2, 1.0, 2.0),
        told("c", 1, 1.0, None),
        told("e", 1, 3.0, 1.0),
    )
    assert word_trends([met, free]) == "1 expected exponent: 1 met, 0 not met, 0 not compared"
    counts = "4 expected exponents: 1 met, 2 not met, 1 not compared (first: "
    assert word_trends([met, free, noise, missed, other]) == f"{counts}b, body 2, small, exact, 1.00 ± 0.00 for 2)"
    assert word_trends([other, missed, noise, met]) == f"{counts}e, body 1, small, exact, 3.00 ± 0.00 for 1)"


@pytest.mark.parametrize(("off", "noise", "says"), [
    (0.14, 1e-4, "like the power 2"), (0.16, 1e-4, "not like the power 2"), (-0.16, 1e-4, "not like the power 2"),
    (0.16, 0.14, "like the power 2"), (0.30, 0.14, "not like the power 2"), (0.0, 0.19, "like the power 2"),
    (0.0, 0.199, "no single slope: phase pairs or values do not agree"),
])  # fmt: skip
def test_an_exponent_agrees_within_the_larger_of_its_uncertainty_and_what_is_not_asymptotic(
    off: float, noise: float, says: str
) -> None:
    sizes = _power(2.0 + off, 1e-2)
    found = fit_trend("s", 1, "w", SCALES, sizes, noise * np.abs(sizes), 2.0)
    assert found.uncertainty == pytest.approx(2.0 * noise / (np.sqrt(5.0) * np.log(2.0)), rel=1e-6)
    assert found.verdict == says


def test_medians_are_of_the_absolute_size_of_what_is_known() -> None:
    sizes = fit_trend(
        "s", 1, "w", (1.0, 0.5), np.array([[-4.0, 1.0], [2.0, np.nan], [3.0, np.nan]]), np.ones((3, 2)), None
    )
    assert sizes.medians == (3.0, 1.0)


def _model(step: Callable[[float], float], error: float = 1e-9) -> Callable[..., Amplification]:
    """mu = 2 + i, small as printed 1 + 0.01 s^2 of it, exact step(s) above that, half of it where resolved."""

    def amplification(scene: Scene, phases: Array, equations: str, **settings: object) -> Amplification:
        s = float(np.abs(scene.amplitudes).max())
        assert settings["cutoff"] in (None, DEFAULT_V_C * s)
        share = 1.0 if settings["cutoff"] is None else 0.5
        factor = (1.0 + 0.01 * s**2) * (1.0 + (share * step(s) if equations == "exact" else 0.0))
        mu = factor * (2.0 + np.arange(len(scene.bodies)) + 0.1 * np.cos(phases[:, :1]))
        return Amplification(mu, error * mu, np.full(len(mu), "ok"), np.full(len(mu), np.nan), 0.0)

    return amplification


def _found(monkeypatch: pytest.MonkeyPatch, step: Callable[[float], float], name: str = "fig3-I") -> list[Trend]:
    monkeypatch.setattr(reference, "amplification", _model(step))
    return list(collected(Scaling(), _study(name)))


def test_a_geometric_step_has_the_exponent_two(monkeypatch: pytest.MonkeyPatch) -> None:
    trends = _found(monkeypatch, lambda s: -0.03 * s**2)
    assert len(trends) == 2 * 2 * 2, "supremum and resolved, two bodies, two trends"
    assert {trend.verdict for trend in trends} == {"like the power 2"}
    of_step, of_small = (
        [each for each in trends if each.what.startswith(what)] for what in (EXACT_MINUS_SMALL, SMALL_SCALE_DIFFERENCE)
    )
    for each in of_step:
        share = 0.5 if each.what.endswith("resolved peak") else 1.0
        assert each.medians == pytest.approx([share * 0.03 * s**2 for s in SCALES], rel=1e-9)
    assert len({each.what for each in of_step}) == 2
    for each in of_small:
        halved = [(1.0 + 0.01 * s**2) / (1.0 + 0.0025 * s**2) - 1.0 for s in SCALES[:-1]]
        assert (each.medians, each.parameter) == (pytest.approx(halved, rel=1e-9), SCALES[:-1])


def test_a_step_enters_the_slope_where_known_to_a_fifth(monkeypatch: pytest.MonkeyPatch) -> None:
    """Errors of 3e-4 on both sides: 4.2e-4 together, a fifth of 2.1e-3. At s = 1/4 both differences are 1.9e-3."""
    monkeypatch.setattr(reference, "amplification", _model(lambda s: 0.03 * s**2, 3e-4))
    points = {(trend.what.split(",")[0], trend.points) for trend in collected(Scaling(), _study("fig3-I"))}
    assert points == {(EXACT_MINUS_SMALL, 4 * 2), (SMALL_SCALE_DIFFERENCE.split(",")[0], 0)}, (
        "of four phase pairs; one value has no slope"
    )


def test_a_lubricated_scene_has_one_peak_and_a_heated_one_no_scaling(monkeypatch: pytest.MonkeyPatch) -> None:
    assert len(_found(monkeypatch, lambda s: 0.03 * s**2, "fig4-viscous")) == 2 * 2

    def broken(*args: object, **settings: object) -> None:
        raise RuntimeError("singular")

    monkeypatch.setattr(reference, "amplification", broken)
    trends = collected(Scaling(), _study("fig4-viscous"))
    assert [trend.body for trend in trends] == [1, 2]
    assert {trend.verdict for trend in trends} == {"solver failed: RuntimeError: singular"}
    heating = {"contact_radius": 0.1, "conductivity": 18.0, "diffusivity": 4e-6}
    heated = load_scene("fig3-I").with_values({"isolator.friction": {"slow": 0.1, "heating": heating}})
    assert collected(Scaling(), Study((heated,), 2, 1e-3)) is None


VARYING = {"slow": 0.02, "fast": 0.1, "rate": 20.0}  # s/m; slips of 0.05 m/s lie in the middle of its rise
LOADED = {"slow": 0.1, "load_exponent": -0.2}


@pytest.mark.parametrize(("name", "friction"), [("fig3-II", VARYING), ("fig3-II", LOADED), ("fig4-viscous", None)])
def test_the_scaled_scene_moves_as_the_scene_scaled(name: str, friction: object) -> None:
    """Small equations without the kept terms would do so exactly; with them to s^2 of the swing, 1e-2 here."""
    scene = load_scene(name).with_values({"duration": 2.0, **({"isolator.friction": friction} if friction else {})})
    larger, smaller = (trajectory(scale_scene(scene, s), (2.0, 0.7), equations="small").position for s in (0.25, 0.125))
    np.testing.assert_allclose(larger, 2.0 * smaller, atol=1e-2 * np.abs(larger).max())
    assert scale_scene(scene, 1.0).dry_friction == scene.dry_friction
    assert scale_scene(scene.with_values({"isolator.travel": 0.2}), 0.25).isolator.travel == 0.05


@pytest.mark.long
def test_the_step_to_the_exact_equations_is_geometry() -> None:
    """fig3-II: every trend like s^2, with an uncertainty below 0.1."""
    trends = collected(Scaling(), _study("fig3-II"))
    assert {trend.verdict for trend in trends} == {"like the power 2"}
    assert max(trend.uncertainty for trend in trends) < 0.1


def _study(*names: str) -> Study:
    return Study(tuple(load_scene(name) for name in names), 2, 1e-3)


def test_a_lubricated_scene_has_only_the_limit_of_the_contact(monkeypatch: pytest.MonkeyPatch) -> None:
    def planted(scene: Scene) -> tuple[Array, Array]:
        if scene.lubricated:
            raise RuntimeError("no engine")
        sizes = np.array(PENETRATIONS)[None, :, None] * np.array([1.0, -2.0])[None, None, :]
        return sizes, 1e-3 * np.abs(sizes)

    limits = [limit._replace(parameter=PENETRATIONS, expected=1.0, measure=planted) for limit in CONVERGENCE_CASES]
    monkeypatch.setattr(convergence, "CONVERGENCE_CASES", limits)
    trends = collected(Convergence(), _study("fig3-I", "fig4-viscous"))
    assert [trend.scene for trend in trends] == ["fig3-I"] * 8 + ["fig4-viscous"] * 2
    assert [trend.body for trend in trends] == [1, 2] * 5
    verdicts = [trend.verdict for trend in trends]
    assert verdicts == ["like the power 1"] * 8 + ["solver failed: RuntimeError: no engine"] * 2


last_speed: list[float] = []  # v_reg of the last answer of either side


def _regularized(power: float, supremum: float = 3.0) -> object:
    """mu = 3 resolved at v, or `supremum`; 3 + v^power under a law regularized below v."""

    def amplification(scene: Scene, phases: Array, tolerance: float, **settings: float) -> Amplification:
        v, cutoff = settings.get("regularization"), settings.get("cutoff")
        last_speed[:] = [v] if v else last_speed
        assert not cutoff or [cutoff] == last_speed, "v_c = v_reg"
        mu = np.full((len(phases), len(scene.bodies)), 3.0 + v**power if v else 3.0 if cutoff else supremum)
        return Amplification(mu, 1e-9 * mu, np.full(len(mu), "ok"), np.full(len(mu), np.nan), 0.0)

    return amplification


@pytest.mark.parametrize(("power", "says"), [(1.0, "like the power 1"), (0.5, "not like the power 1")])
def test_the_order_in_v_reg_is_that_of_the_law(monkeypatch: pytest.MonkeyPatch, power: float, says: str) -> None:
    monkeypatch.setattr(reference, "amplification", _regularized(power, 4.0))
    monkeypatch.setattr(multibody, "amplification", _regularized(power))
    for number in (0, 2):  # the equations and the engine, against the resolved peak
        trends = fit_limit_trends((load_scene("fig3-I"), number))
        assert {each.verdict for each in trends} == {says}
        assert [each.exponent for each in trends] == pytest.approx([power] * 2, abs=1e-6)
    against_supremum = fit_limit_trends((load_scene("fig3-I"), 1))[0]
    assert against_supremum.verdict.startswith("hardly falls")
    speeds = against_supremum.parameter
    assert against_supremum.medians == pytest.approx([1.0 - (3.0 + v**power) / 4.0 for v in speeds], rel=1e-9)


def test_a_contact_ten_times_stiffer_is_ten_times_closer(monkeypatch: pytest.MonkeyPatch) -> None:
    """Second body of fig3-II: 8e-5 of mu at 3e-3 of rho; what is of higher order there is a tenth of it."""
    monkeypatch.setattr(convergence, "CONSTANT_STEP_PERIODS", 2.0)
    trend = fit_limit_trends((load_scene("fig3-II"), 3))[1]
    assert trend.verdict == "like the power 1"
    assert trend.medians[0] == pytest.approx(8.4e-5, rel=0.2)
    assert trend.exponent == pytest.approx(1.0, abs=0.15)


@pytest.mark.long
def test_regularization_is_of_first_order() -> None:
    scene = load_scene("fig3-II")
    resolved, supremum = (fit_limit_trends((scene, number)) for number in (0, 1))
    assert [trend.verdict for trend in resolved] == ["like the power 1"] * 2
    assert supremum[0].verdict.startswith("hardly falls")
    assert supremum[1].verdict == "falls"


def test_a_limit_has_its_error_and_as_many_periods_as_asked() -> None:
    limit, answer = (
        Amplification(np.full((1, 2), mu), np.full((1, 2), error), np.array(["ok"]), np.full(1, np.nan), 0.0)
        for mu, error in ((2.0, 3e-3), (3.0, 4e-3))
    )
    sizes, errors = convergence._relative_differences([(answer, limit)])
    assert (sizes.tolist(), errors.ravel().tolist()) == ([[[0.5, 0.5]]], pytest.approx([2.5e-3] * 2))
    assert shorten_scene(load_scene("fig3-I"), 3.0).duration == pytest.approx(3.0 * 1.1), "of 0.9 and 1.1 s"


def test_a_run_at_a_constant_step_is_over_the_ground_of_its_phases(monkeypatch: pytest.MonkeyPatch) -> None:
    runs = iter(SimpleNamespace(status=status, peak=np.array([6.0, 3.0])) for status in ("step limit", "ok"))
    monkeypatch.setattr(multibody, "single_run", lambda *given, **settings: next(runs))
    lost, found = convergence._solve_at_constant_step(load_scene("fig3-I"), 1e-2, 1e-3, 1)
    assert np.isnan(lost).all()
    ground = ground_peak(load_scene("fig3-I"), convergence.ENGINE_PHASES[1:])
    assert found == pytest.approx(np.array([6.0, 3.0]) / ground)


@pytest.mark.parametrize("order", [1, 2])
def test_the_error_of_a_constant_step_covers_it(monkeypatch: pytest.MonkeyPatch, order: int) -> None:
    """A method of this order that is off by 1 % with the coarser steps."""

    def stepped(scene: Scene, v_reg: float, penetration: float, factor: int) -> Array:
        return np.full((len(convergence.ENGINE_PHASES), 2), 3.0 * (1.0 + 0.01 / factor**order))

    monkeypatch.setattr(convergence, "_solve_at_constant_step", stepped)
    monkeypatch.setattr(reference, "amplification", _regularized(60.0))
    sizes, errors = convergence._compare_stiff_contacts(load_scene("fig3-I"))
    assert (np.abs(sizes) <= errors).all()
    assert (errors <= 5.0 * np.abs(sizes)).all()


def test_the_error_of_a_constant_step_has_that_of_the_equations_and_that_of_the_step(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def stepped(scene: Scene, v_reg: float, penetration: float, factor: int) -> Array:
        return np.full((len(convergence.ENGINE_PHASES), 2), 4.0 if factor == 1 else 4.0 + 4.0 * penetration)

    def exact(scene: Scene, phases: Array, **settings: float) -> Amplification:
        mu = np.full((len(phases), 2), 4.0)
        return Amplification(mu, 0.01 * mu, np.full(len(mu), "ok"), np.full(len(mu), np.nan), 0.0)

    monkeypatch.setattr(convergence, "_solve_at_constant_step", stepped)
    monkeypatch.setattr(reference, "amplification", exact)
    _, errors = convergence._compare_stiff_contacts(load_scene("fig3-I"))
    expected = np.hypot(convergence.STEP_ERROR_FACTOR * np.array(PENETRATIONS), 0.01)
    assert errors == pytest.approx(np.broadcast_to(expected[:, None], errors.shape), rel=1e-12)
