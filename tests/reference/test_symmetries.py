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
