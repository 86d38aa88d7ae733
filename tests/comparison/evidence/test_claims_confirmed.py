"""The verdicts as integrated follow from a second, independent integration, too."""

import numpy as np
import pytest
from numpy.typing import NDArray
from second_integration import by_scipy, stepped

from comparison.evidence.claims.claims import CLAIMS
from comparison.evidence.claims.evidence import MOTION_PHASES, CaseInReading, Evidence, gather_evidence
from comparison.evidence.claims.readings import AS_INTEGRATED, STATEMENT_CASES, effective_reading
from comparison.evidence.claims.smoothness import find_sharpest_curvatures
from comparison.evidence.claims.table import CLAIMS_GRID
from reference import amplification, modes
from reference.problem import Scene, ground_peak

Array = NDArray[np.float64]

STEP, FINE = 4e-4, 2e-4  # s
TINY = np.finfo(float).tiny  # a platform that never slides has no displacement to compare with
ALL_CASES = sorted({case for claim in CLAIMS for case in claim.cases})


def _solved(scene: Scene, phases: Array, fine: bool) -> tuple[Array, Array]:
    if effective_reading(AS_INTEGRATED, scene) != AS_INTEGRATED:
        return by_scipy(scene, phases, None)
    return stepped(scene, phases, FINE if fine else STEP, AS_INTEGRATED.cutoff)


def _second(case: str) -> Evidence:
    """Evidence as `gather_evidence` finds it, by the second integration alone."""
    scene = STATEMENT_CASES[case]()
    bodies = len(scene.bodies)
    grid = CLAIMS_GRID // 2 if bodies == 1 else CLAIMS_GRID
    axis = 2.0 * np.pi * np.arange(grid) / grid
    phases = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1)
    half = _solved(scene, phases[: grid // 2].reshape(-1, 2), False)
    mu = half[0].reshape(grid // 2, grid, bodies)
    mu = np.concatenate([mu, np.roll(mu, grid // 2, axis=1)])  # that this is so is measured below
    if bodies == 1:
        return Evidence(mu, 1e-3, ("ok",))

    def factors(phases: Array) -> Array:
        return _solved(scene, phases, True)[0]

    probes = np.array([(0.3, 1.1), (2.0, 0.7)])
    assert np.abs(factors(probes + np.pi) / factors(probes) - 1.0).max() < 1e-6
    facts = _solved(scene, np.array(MOTION_PHASES), False)[1]
    apart = facts[:, 1 : 1 + bodies] / np.maximum(facts[:, 1 + bodies :], TINY)
    natural = modes(scene).period.ravel()
    tops = ground_peak(scene, phases.reshape(-1, 2)).reshape(grid, grid, 1)
    return Evidence(
        mu,
        1e-3,
        ("ok",),
        tuple(find_sharpest_curvatures(mu, factors)),
        tuple(apart.max(axis=0)),
        float(facts[:, 0].max() / scene.radius**2),
        tuple((T, float(natural[np.abs(T / natural - 1.0).argmin()])) for T in scene.excitation.periods),
        find_sharpest_curvatures(tops, lambda at: ground_peak(scene, at)[:, None])[0],
        case=case,
    )


@pytest.mark.long
def test_a_second_integration_gives_every_statement_the_same_verdict() -> None:
    first, second = {}, {}
    for case in ALL_CASES:
        grid = CLAIMS_GRID // 2 if len(STATEMENT_CASES[case]().bodies) == 1 else CLAIMS_GRID
        first[case] = gather_evidence(
            CaseInReading(case, effective_reading(AS_INTEGRATED, STATEMENT_CASES[case]()), grid)
        )
        second[case] = _second(case)
    verdicts = {(c.figure, c.says): (c.verdict(first), c.verdict(second)) for c in CLAIMS}
    assert {key: pair for key, pair in verdicts.items() if pair[0].verdict != pair[1].verdict} == {}


def test_the_surfaces_as_integrated_have_the_factors_of_time_stepping() -> None:
    scene, phases = STATEMENT_CASES["fig3-I"]().with_values({"duration": 2.0}), np.array([(0.3, 1.1), (4.0, 5.5)])
    first = amplification(scene, phases, equations="small", tolerance=1e-4, cutoff=AS_INTEGRATED.cutoff).mu
    second, _ = stepped(scene, phases, 1e-3, AS_INTEGRATED.cutoff)
    assert np.abs(first / second - 1.0).max() < 5e-3
