"""A surface of linear equations is a sum of one motion per harmonic: the integrated one, and only where that holds."""

import math

import numpy as np
import pytest
from chains import chain

import reference
from reference import surface
from reference.analytical import frictionless as closed_form
from reference.analytical import phase_peaks
from reference.problem import GRAVITY, Outcome, Scene, load_scene, phase_grid
from reference.problem.reductions import is_linear

PHASES = np.vstack([(0.0, np.pi), phase_grid(4) + 0.1])
TWO = {"masses": [1.0, 0.5], "stiffness": [[20.0, 30.0]], "amplitudes": [[0.3, 0.1], [-0.2, 0.2]], "duration": 6.0}


def frictionless(**changes) -> Scene:
    return chain(**{"friction": 0.0, **TWO, **changes})


def both(scene: Scene) -> list[reference.Amplification]:
    return [reference.amplification(scene, PHASES, "small", full=full) for full in (False, True)]


RANDOM = np.random.default_rng(8)
RESONANT = {"periods": [2.0 * np.pi / np.sqrt(GRAVITY), 1.1], "decay": [0.0, 0.0]}
CHAINS = {"resonance without decay": chain(1.0, 0.0, amplitudes=0.05 * np.eye(2), duration=9.0, **RESONANT)} | {
    f"{bodies} bodies": frictionless(
        radius=RANDOM.uniform(0.2, 2.0), masses=[1.0, 0.5, 2.0, 0.1][:bodies],
        stiffness=[[20.0, 30.0], [50.0, 10.0], [5.0, 5.0]][: bodies - 1], amplitudes=RANDOM.uniform(-0.5, 0.5, (2, 2)),
        periods=RANDOM.uniform(0.3, 2.0, 2), decay=[RANDOM.uniform(0.0, 1.0), 0.3], duration=4.0,
    )
    for bodies in (1, 2, 3, 4)
}  # fmt: skip


@pytest.mark.parametrize("scene", CHAINS.values(), ids=CHAINS)
def test_the_sum_is_the_integrated_surface_on_any_chain(scene):
    reduced, full = both(scene)
    assert is_linear(scene)
    assert reduced.status.tolist() == full.status.tolist()
    ok = full.status == "ok"
    assert ok.any()
    assert np.all(np.abs(reduced.mu - full.mu)[ok] <= (reduced.error + full.error)[ok])
    assert np.all(reduced.error[ok] <= 1e-8 * reduced.mu[ok])
    np.testing.assert_allclose(reduced.displacement[ok], full.displacement[ok], rtol=1e-6)


def test_the_displacement_on_a_plane_is_that_of_a_run():
    reduced, full = both(frictionless(radius=math.inf))
    assert full.displacement.min() > 0.01
    np.testing.assert_allclose(reduced.displacement, full.displacement, rtol=1e-6)


@pytest.mark.parametrize(
    ("scale", "travel", "end"),
    [(1.0, {}, Outcome.RIM_REACHED), (0.5, {"isolator.travel": 0.125}, Outcome.TRAVEL_REACHED)],
)
def test_phases_at_which_the_rim_or_the_travel_is_reached_are_told_as_by_a_run(scale, travel, end):
    scene = frictionless(amplitudes=[[6.0 * scale, 0.0], [0.0, scale]]).with_values(travel)
    reduced, full = both(scene)
    assert set(full.status) == {Outcome.OK.value, end.value}, "some phases reach it, some do not"
    assert reduced.status.tolist() == full.status.tolist()
    np.testing.assert_array_equal(reduced.instant, full.instant)
    np.testing.assert_allclose(reduced.cap_share, full.cap_share, rtol=1e-6)
    ok = full.status == Outcome.OK
    np.testing.assert_allclose(reduced.cap_share[ok] * scene.radius, reduced.displacement[ok])


def test_full_and_the_exact_equations_are_integrated(monkeypatch):
    monkeypatch.setattr(surface, "frictionless_peaks", None)
    assert reference.amplification(frictionless(), PHASES[:1], equations="small", full=True).status[0] == "ok"
    assert reference.amplification(frictionless(), PHASES[:1], equations="exact").status[0] == "ok"
    with pytest.raises(TypeError):
        reference.amplification(frictionless(), PHASES[:1], equations="small")


def test_a_sum_meets_the_tolerance_where_all_bodies_do(monkeypatch):
    for error, status in (([1e-7, 0.0], "ok"), ([1e-5, 0.0], "tolerance not met")):
        peaks = np.ones((1, 2)), np.array([error]), np.ones(1), np.array([False])
        monkeypatch.setattr(surface, "frictionless_peaks", lambda scene, phases, peaks=peaks: peaks)
        assert reference.amplification(frictionless(), PHASES[:1], equations="small").status[0] == status


def test_the_error_of_mu_is_over_the_ground_as_mu_is():
    scene = load_scene("fig4-viscous")
    once, hundred = (
        reference.amplification(scene.with_values({"excitation.scale": scale}), [(0.3, 1.1)], equations="small")
        for scale in (1e-4, 1e-2)
    )
    np.testing.assert_allclose(hundred.mu, once.mu, rtol=1e-3)
    np.testing.assert_allclose(hundred.error / once.error, 1.0, atol=0.9)


def test_a_sum_that_rounding_keeps_from_the_tolerance_is_not_ok() -> None:
    found = reference.amplification(frictionless(duration=60.0), PHASES, equations="small", tolerance=1e-10)
    missed = (found.error > 1e-10 * found.mu).any(axis=1)
    assert missed.any()
    assert list(found.status) == list(np.where(missed, "tolerance not met", "ok"))


def test_finer_intervals_and_more_terms_find_the_same_peaks(monkeypatch):
    """The shortest time is that of the isolator, of a link along y, or of the loading."""
    fast = [{"masses": [1.0], "stiffness": []}, {"stiffness": [[20.0, 2e4]]}, {"periods": [0.05, 1.1]}]
    for scene in (frictionless(duration=0.7, **changes) for changes in fast):
        found = closed_form.frictionless_peaks(scene, PHASES[:4])
        monkeypatch.setattr(closed_form, "INTERVALS_PER_PERIOD", 31)
        monkeypatch.setattr(closed_form, "SERIES_TERMS", 14)
        finer = closed_form.frictionless_peaks(scene, PHASES[:4])
        monkeypatch.undo()
        for number in (0, 2):
            np.testing.assert_allclose(found[number], finer[number], rtol=2e-12)
        assert (found[1] < 1e-9 * found[0]).all()


def test_the_largest_length_is_that_of_dense_samples():
    """Of two bodies on eight intervals, of series whose later terms are as large as the first."""
    random, places = np.random.default_rng(2), np.linspace(-1.0, 1.0, 1001)
    derivatives = [2.0**order * (random.normal(size=(8, 2, 2, 2, 2)) @ [1.0, 1.0j]) for order in range(6)]
    series = phase_peaks.PhaseSeries.from_derivatives(derivatives, 0.5)
    phases = random.uniform(0.0, 2.0 * np.pi, (12, 2))
    terms = np.array([part / math.factorial(order) / 2.0**order for order, part in enumerate(derivatives)])
    vectors = np.einsum("ptnah,mh,px->mtnax", terms, np.exp(1j * phases), places ** np.arange(6.0)[:, None]).real
    dense = np.linalg.norm(vectors, axis=3).max(axis=(1, 3))
    peaks, _ = phase_peaks.largest_lengths(series, phases)
    assert (dense <= peaks + 1e-12).all()
    np.testing.assert_allclose(peaks, dense, rtol=1e-6)
    assert (dense <= series.envelope).all()
    for near, reached in ((1.0 - 1e-9, True), (2.0, False)):
        found = [phase_peaks.may_reach_bound(series, phases[m][None], near * dense[m, 0]).item() for m in range(12)]
        assert found == [reached] * 12
