"""Demands of every phase pair: those of the single motions, the same from both sides, gaps that cost no other pair."""

from dataclasses import replace

import numpy as np
import pytest
from chains import chain, made_up
from oracle_law import Law
from scipy.integrate import solve_ivp

import multibody
import reference
from reference.measures import Estimate, demands
from reference.measures.peak_demands import demands_of_motions
from reference.problem import Outcome, phase_grid

V_REG = 1e-3
SHARED = ("displacement", "base_shear", "acceleration", "drift", "contact_force_min", "contact_force_max")


@pytest.mark.parametrize("law", [{"regularization": V_REG}, {"equations": "small", "rest_condition": "printed"}])
def test_a_surface_has_the_demands_of_its_motions(law) -> None:
    scene, phases = reference.load_scene("fig3-I"), phase_grid(2)
    surface = reference.peak_demands(scene, phases, **law)
    for row, phase in enumerate(phases):
        single = demands(reference.trajectory(scene, phase, **law))
        for name, estimates in surface.items():
            value = getattr(single, name)
            listed = [value] if isinstance(value, Estimate) else value
            np.testing.assert_array_equal(np.atleast_1d(estimates.value[row]), [each.value for each in listed])
            np.testing.assert_array_equal(np.atleast_1d(estimates.error[row]), [each.error for each in listed])


def test_labeled_demands_are_those_of_the_result() -> None:
    scene = reference.load_scene("fig3-I").with_values({"duration": 2.0})
    square = reference.peak_demands(scene, phase_grid(2).reshape(2, 2, 2))
    data = square.to_xarray()
    assert data["base_shear"].dims == ("alpha1", "alpha2")
    np.testing.assert_array_equal(data["base_shear_error"], square["base_shear"].error)
    np.testing.assert_array_equal(data["drift"].sel(body=2), square["drift"].value[..., 0])
    assert np.isnan(data["drift"].sel(body=1)).all()
    assert data["friction_energy"].attrs["units"] == "J"
    assert data["drift_error"].attrs["long_name"] == f"estimated absolute error: {data['drift'].attrs['long_name']}"
    assert reference.peak_demands(scene, [(0.3, 1.1)]).to_xarray()["status"].dims == ("phase",)


NAMES = ["fig3-I", "fig3-II", "fig4-dry", "fig4-viscous"]


@pytest.mark.parametrize(
    ("name", "points"),
    [("fig3-I", 1), ("fig4-viscous", 1), *(pytest.param(name, 8, marks=pytest.mark.long) for name in NAMES)],
)
def test_the_two_sides_agree_within_their_errors(name, points) -> None:
    """Every number within the two errors, which are small."""
    scene = reference.load_scene(name)
    law, phases = None if scene.lubricated else V_REG, phase_grid(points) + 0.1
    first, second = (side.peak_demands(scene, phases, regularization=law) for side in (reference, multibody))
    assert set(first.status) == set(second.status) == {"ok"}
    assert set(first) == set(second)
    for quantity, ours in first.items():
        theirs, known = second[quantity], np.isfinite(ours.value)
        assert known.all() or quantity == "residual"
        assert (known == np.isfinite(theirs.value)).all(), quantity
        assert (np.abs(ours.value - theirs.value) <= ours.error + theirs.error)[known].all(), quantity
        if quantity in SHARED:
            assert (theirs.error <= 1e-2 * theirs.value).all(), quantity


@pytest.mark.parametrize("name", ["fig3-I", "fig4-viscous"])
def test_base_shear_and_contact_force_are_those_of_scipy(name) -> None:
    """Plain equations of two bodies on a sphere by SciPy: R = sum of m a, N from the curvature."""
    scene, phase = reference.load_scene(name).with_values({"duration": 3.0}), (2.0, 0.7)
    v_reg = None if scene.lubricated else 1e-2
    law = Law(scene, phase, "exact")
    solution = solve_ivp(
        lambda t, y: law.smooth_rate(t, y, v_reg)[0],
        (0.0, scene.duration), np.zeros(8), "Radau", rtol=1e-8, atol=1e-10, max_step=0.02,
    )  # fmt: skip
    shear, contact = [], []
    for t, y in zip(solution.t, solution.y.T):
        rate, normal = law.smooth_rate(t, y, v_reg)
        shear.append(np.hypot(*(scene.masses @ (rate[4:].reshape(2, 2) + law.ground(t)[:2]))))
        contact.append(normal)
    answer = reference.peak_demands(scene, [phase], regularization=v_reg)
    assert answer["base_shear"].value[0] == pytest.approx(max(shear), rel=1e-4)
    assert answer["contact_force_max"].value[0] == pytest.approx(max(contact), rel=1e-4)
    assert answer["contact_force_min"].value[0] == pytest.approx(min(contact), rel=1e-4)


def test_a_pair_without_an_answer_is_nan_and_costs_no_other() -> None:
    scene = reference.load_scene("fig3-I").with_values(
        {"excitation.amplitudes": [[9.0, 0.0], [0.0, 9.0]], "isolator.friction": 0.01}
    )
    phases = phase_grid(3)
    surface = reference.peak_demands(scene, phases)
    lost = surface.status != "ok"
    assert lost.any()
    for estimates in surface.values():
        assert np.isnan(estimates.value[lost]).all()
    assert np.isfinite(surface.instant[lost]).all()
    scene = chain(amplitudes=[[1.3e154, 1.3e154], [0.0, 0.0]], duration=0.2)  # its square is finite out of phase
    alone = demands_of_motions(
        scene, [(0.0, 0.0), (0.0, np.pi)], lambda phase: made_up(scene, np.arange(3.0) + phase[1])
    )
    assert (alone.status.tolist(), alone["stops"].value[1]) == (["non-finite load", "ok"], 0.0)
    assert (multibody.trajectory(scene, (0.0, 0.0)).status, len(alone["stops"].value)) == ("non-finite load", 2)


def test_a_demand_that_is_not_there_is_named() -> None:
    surface = reference.peak_demands(chain(duration=0.5), [(0.3, 1.1)])
    assert ("drift" in surface, "uplift" in surface) == (True, False)
    with pytest.raises(KeyError, match="drfit"):
        surface["drfit"]


def test_every_outcome_keeps_its_whole_name() -> None:
    """Some are longer than that of the outcome which stands for pairs without a motion."""
    scene, ended = chain(duration=0.2), iter(Outcome)
    phases = np.linspace(0.0, 1.0, 2 * len(Outcome)).reshape(-1, 2)
    surface = demands_of_motions(
        scene, phases, lambda phase: replace(made_up(scene, np.arange(3.0)), status=next(ended).value)
    )
    assert surface.status.tolist() == [outcome.value for outcome in Outcome]
