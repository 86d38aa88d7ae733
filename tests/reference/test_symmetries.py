"""Exact symmetries of the paper's system: each maps one run onto another, digit for digit up to the tolerance."""

import numpy as np
import pytest
from chains import chain

import reference
from reference.problem import load_scene
from reference.problem.reductions import own_axes

PHASES = np.array([(0.3, 1.1), (2.0, 0.7), (4.0, 5.5), (5.1, 3.3), (1.0, 2.0), (0.0, 0.0)])
LAWS = pytest.mark.parametrize(("equations", "regularization"), [("exact", None), ("small", None), ("exact", 1e-3)])


def agree(a: reference.Amplification, b: reference.Amplification) -> None:
    assert (a.status == "ok").all()
    assert (b.status == "ok").all()
    # runs that are mirror images take the same steps up to rounding, which a stop can amplify
    np.testing.assert_allclose(a.mu, b.mu, rtol=1e-6)


@LAWS
@pytest.mark.parametrize("name", ["fig3-I", "fig3-II"])
def test_turning_the_loading_round_turns_the_motion_round(name, equations, regularization):
    """zeta'' = 0: (alpha1 + pi, alpha2 + pi) gives -x, -y and the same mu."""
    scene = load_scene(name)
    options = {"equations": equations, "regularization": regularization}
    agree(reference.amplification(scene, PHASES, **options), reference.amplification(scene, PHASES + np.pi, **options))


@LAWS
def test_mirror_of_case_one(equations, regularization):
    """Each harmonic along its own axis: alpha1 + pi alone mirrors x."""
    scene = load_scene("fig3-I")
    options = {"equations": equations, "regularization": regularization}
    mirrored = reference.amplification(scene, PHASES + np.array([np.pi, 0.0]), **options)
    agree(reference.amplification(scene, PHASES, **options), mirrored)


def test_vertical_loading_breaks_the_turn():
    """The check above is no tautology: with zeta'' the two phases differ."""
    scene = chain(masses=[1.0, 1.0], stiffness=[[20.0, 30.0]], amplitudes=[[1.0, 0.0], [0.0, 1.0], [2.0, 1.0]])
    here, there = (reference.amplification(scene, PHASES + shift).mu for shift in (0.0, np.pi))
    assert np.abs(here / there - 1.0).max() > 1e-2


@LAWS
@pytest.mark.parametrize("beta", [-0.5])
def test_motion_under_proportional_loading_stays_in_its_plane(beta, equations, regularization):
    """(4.7): xi'' = beta eta'' and kx = ky give x_i = beta y_i for every body."""
    scene = chain(
        masses=[1.0, 1.0, 0.5], stiffness=[[20.0, 20.0], [35.0, 35.0]], amplitudes=[[beta, 0.8 * beta], [1.0, 0.8]]
    )
    run = reference.trajectory(scene, (0.3, 1.1), equations, regularization)
    assert run.status == "ok"
    size = np.abs(run.position[:, :, :2]).max()
    assert size > 1e-3
    np.testing.assert_allclose(run.position[:, :, 0], beta * run.position[:, :, 1], atol=1e-9 * size)


def test_two_harmonics_along_one_axis_do_not_have_their_own() -> None:
    for amplitudes, own in (
        ([[1.0, 0.0], [0.0, 1.4]], True),
        ([[1.0, 1.4], [0.0, 0.0]], False),
        ([[1.0, 0.0], [1.4, 0.0]], False),
    ):
        scene = chain(masses=[1.0, 1.0], stiffness=[[20.0, 30.0]], amplitudes=amplitudes)
        assert bool(own_axes(scene)) == own
        here, there = (
            reference.amplification(scene, [(0.3, phase)], tolerance=1e-6).mu for phase in (1.1, 1.1 + np.pi)
        )
        assert np.allclose(here, there, rtol=1e-5) == (own or amplitudes[1][0] != 0.0)


def test_axes_can_be_exchanged():
    """x and y exchanged in loading and links: the same mu."""
    one = chain(masses=[1.0, 1.0], stiffness=[[20.0, 30.0]], amplitudes=[[1.0, 0.2], [0.3, 1.4]])
    other = chain(masses=[1.0, 1.0], stiffness=[[30.0, 20.0]], amplitudes=[[0.3, 1.4], [1.0, 0.2]])
    for equations in ("exact", "small"):
        agree(reference.amplification(one, PHASES, equations), reference.amplification(other, PHASES, equations))


def test_only_mass_ratios_matter():
    """Masses and stiffnesses times ten: the same mu, ten times the contact force."""
    one = chain(masses=[1.0, 2.0], stiffness=[[20.0, 30.0]])
    other = chain(masses=[10.0, 20.0], stiffness=[[200.0, 300.0]])
    agree(reference.amplification(one, PHASES), reference.amplification(other, PHASES))
    light, heavy = (reference.trajectory(scene, PHASES[0]).contact_force for scene in (one, other))
    np.testing.assert_allclose(heavy, 10.0 * light, rtol=1e-6)


@pytest.mark.parametrize("equations", ["exact", "small"])
def test_scaled_loading_and_friction_leave_the_factors_alone(equations):
    """The gap to s -> 0 falls like s^2, by terms of order (x/rho)^2 and mu x xi''/(rho g); resolved peaks."""
    scene = load_scene("fig3-I")

    def factors(scale: float) -> np.ndarray:
        data = scene.with_amplitude(scale).model_dump(exclude_none=True)
        data["isolator"]["friction"] = 0.1 * scale
        found = reference.amplification(
            reference.Scene.model_validate(data), PHASES[:3], equations, tolerance=1e-9, cutoff=0.05 * scale
        )
        return found.mu[:, 1]

    limit = factors(1e-4)
    large, small = np.abs(factors(0.2) / limit - 1.0), np.abs(factors(0.1) / limit - 1.0)
    np.testing.assert_allclose(large / small, 4.0, rtol=0.1)
    assert large.max() > 1e-6
