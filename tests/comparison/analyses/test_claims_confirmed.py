"""The verdicts of the claims follow from a second, independent integration of the same readings, too."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from claims_literal import LiteralClaims, gathered
from numpy.typing import NDArray
from second_integration import LITERAL as LITERAL_LAW
from second_integration import SET_VALUED, by_scipy, stepped

from comparison.analyses.claims import readings
from comparison.analyses.claims.claims import CLAIMS
from comparison.analyses.claims.evidence import MOTIONS, Evidence
from comparison.analyses.claims.readings import CASES, LIGHT_BODY, LITERAL, OWN_PERIOD, SPEED, Reading
from comparison.analyses.claims.smoothness import bends
from comparison.analyses.claims.table import recorded_verdict
from reference import amplification, modes
from reference.problem import Scene, ground_peak

Array = NDArray[np.float64]

GRID = 16
STEP, LITERAL_STEP, FINE = 4e-4, 1e-3, 2e-4  # s
CONFIRMED = (Reading(1.0), OWN_PERIOD, LIGHT_BODY, LITERAL, Reading(2.0), Reading(0.6), replace(LITERAL, amplitude=0.6))
TINY = np.finfo(float).tiny  # a platform that never slides has no displacement to compare with
ALL_CASES = sorted({case for claim in CLAIMS for case in claim.cases})


def _solved(scene: Scene, reading: Reading, phases: Array, fine: bool) -> tuple[Array, Array]:
    if not readings.has_stops(scene):
        return by_scipy(scene, phases, None)
    if reading.peak == "literal (4.6)":
        return stepped(scene, phases, LITERAL_LAW, LITERAL_STEP)
    return stepped(scene, phases, SET_VALUED, FINE if fine else STEP, SPEED)


@cache
def _second(case: str, reading: Reading) -> Evidence:
    """Evidence as `gathered` finds it, by the second integration alone."""
    scene = CASES[case](reading)
    bodies = len(scene.bodies)
    grid = GRID // 2 if bodies == 1 else GRID
    axis = 2.0 * np.pi * np.arange(grid) / grid
    phases = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1)
    half = _solved(scene, reading, phases[: grid // 2].reshape(-1, 2), False)
    mu = half[0].reshape(grid // 2, grid, bodies)
    mu = np.concatenate([mu, np.roll(mu, grid // 2, axis=1)])  # that this is so is measured below
    swings = half[1][:, 0] / scene.radius**2
    if swings.max() >= 1.0:
        return Evidence(np.full_like(mu, np.nan), statuses=("rim reached",))
    if bodies == 1:
        return Evidence(mu, 1e-3, ("ok",))

    def factors(phases: Array) -> Array:
        return _solved(scene, reading, phases, True)[0]

    facts = _solved(scene, reading, np.array(MOTIONS), False)[1]
    apart = facts[:, 1 : 1 + bodies] / np.maximum(facts[:, 1 + bodies :], TINY)
    probes = np.array([(0.3, 1.1), (2.0, 0.7)])
    twins = np.abs(factors(probes + np.pi) / factors(probes) - 1.0).max() < 1e-6
    natural = modes(scene).period.ravel()
    tops = ground_peak(scene, phases.reshape(-1, 2)).reshape(grid, grid, 1)
    numerators = bends(mu * tops, lambda at: factors(at) * ground_peak(scene, at)[:, None]) if scene.lubricated else []
    return Evidence(
        mu,
        1e-3,
        ("ok",),
        tuple(bends(mu, factors)),
        tuple(apart.max(axis=0)),
        float(facts[:, 0].max() / scene.radius**2),
        tuple((T, float(natural[np.abs(T / natural - 1.0).argmin()])) for T in scene.excitation.periods),
        bool(twins),
        bends(tops, lambda at: ground_peak(scene, at)[:, None])[0],
        tuple(numerators),
    )


@pytest.mark.long
@pytest.mark.parametrize("reading", CONFIRMED, ids=lambda reading: reading.name)
def test_a_second_integration_gives_every_claim_the_same_verdict(reading: Reading) -> None:
    first, second = {}, {}
    for case in ALL_CASES:
        asked = readings.without_effect(reading, CASES[case](reading))
        first[case], second[case] = gathered(LiteralClaims(GRID).task(case, reading).argument), _second(case, asked)
    verdicts = {(c.figure, c.says): (c.verdict(first), c.verdict(second)) for c in CLAIMS}
    assert {key: pair for key, pair in verdicts.items() if pair[0].finding is not pair[1].finding} == {}
    if reading.peak == LITERAL.peak:
        assert all(recorded_verdict(reading, claim) == claim.verdict(first) for claim in CLAIMS)


PROBES = np.array([(0.3, 1.1), (4.0, 5.5)])


@pytest.mark.parametrize("reading", [Reading(), OWN_PERIOD, LIGHT_BODY], ids=lambda reading: reading.name)
def test_readings_have_the_factors_of_time_stepping(reading: Reading) -> None:
    scene = CASES["fig3-I"](reading).with_values({"duration": 2.0})
    law = readings.settings(scene, reading)
    first = amplification(scene, PROBES, equations="small", tolerance=1e-4, **law).mu
    second, _ = stepped(scene, PROBES, SET_VALUED, 1e-3, SPEED)
    assert np.abs(first / second - 1.0).max() < 5e-3


def test_the_regularized_reading_has_the_factors_of_scipy() -> None:
    reading = Reading(peak="regularised")
    scene = CASES["fig3-I"](reading).with_values({"duration": 1.0})
    first = amplification(scene, PROBES, equations="small", tolerance=1e-5, **readings.settings(scene, reading)).mu
    second, _ = by_scipy(scene, PROBES, SPEED)
    assert np.abs(first / second - 1.0).max() < 1e-3
