"""Along every run: at rest the force lies in the friction cone, sliding goes against friction, the contact presses."""

import numpy as np
import pytest
from chains import chain
from oracle_cases import scene_of
from oracle_law import Law

import reference
from reference.problem import GRAVITY

CASES = [
    (name, phase, equations)
    for name, phase in [
        ("fig3-I", (0.3, 1.1)), ("fig3-I", (2.0, 0.7)), ("fig3-II", (2.5, 4.0)), ("fig4-dry", (0.3, 1.1)),
        ("three-vertical", (0.3, 1.1)), ("deep", (0.3, 1.1)), ("light-platform", (0.3, 1.1)),
        ("five-bodies", (0.3, 1.1)), ("one-axis", (0.3, 1.1)), ("one-body", (3.0, 2.0)),
    ]
    for equations in (["exact"] if name == "deep" else ["exact", "small"])
]  # fmt: skip


@pytest.mark.parametrize(("name", "phase", "equations"), CASES)
def test_the_platform_rests_only_where_friction_can_hold_it(name, phase, equations):
    scene = scene_of(name)
    law = Law(scene, phase, equations)
    times = np.linspace(0.0, scene.duration, 5_001)[1:]  # at 0 the velocity is zero even where a slide begins
    run = reference.trajectory(scene, phase, equations, times=times)
    assert run.status == "ok"
    still = ~run.velocity[:, 0, :2].any(axis=1)
    assert still.sum() > 10
    starts, ends = np.array(run.stick).T
    inside = np.any((times[:, None] >= starts) & (times[:, None] <= ends), axis=1)
    # the last 1e-4 of a period of a slide, which moves nothing any more, is sampled at rest
    ending = np.any((times[:, None] >= starts - 1e-4) & (times[:, None] < starts), axis=1)
    np.testing.assert_array_equal(still | ending, inside | ending)
    places = run.position[:, :, :2].reshape(len(times), -1)
    excess = [
        law.excess(t, q, law.link_forces(q, [0.0] * len(q)))
        for t, q in zip(times[still].tolist(), places[still].tolist())
    ]
    # ten times the default tolerance, which the forces of the springs have
    assert max(excess) < 1e-5
    np.testing.assert_array_equal(run.contact_force > 0.0, True)
    np.testing.assert_allclose(
        run.absolute_acceleration[still, 0],
        np.array([law.ground(t) for t in times[still].tolist()]),
        rtol=0.0,
        atol=1e-5,
    )


@pytest.mark.parametrize("equations", ["small", "exact"])
@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_a_drive_that_touches_the_friction_limit_moves_nothing(equations: str, tolerance: float) -> None:
    """The platform stays at rest, so its absolute acceleration is that of the ground."""
    limit = 0.1 * GRAVITY
    radius = GRAVITY / (2.0 * np.pi) ** 2
    scene = chain(radius, 0.1, amplitudes=[[limit, 0.0], [0.0, 0.0]], decay=(0.0, 0.0), duration=3.0)
    result = reference.amplification(scene, [(0.0, 0.0)], equations=equations, tolerance=tolerance)
    assert result.status[0] == "ok"
    assert abs(result.mu[0, 0] - 1.0) <= result.error[0, 0]
