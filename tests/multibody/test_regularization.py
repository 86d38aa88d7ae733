"""A v_reg beyond double precision is answered by a larger one, whose effect is part of the error."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scenes_at_hand import changed

import multibody
import reference
from multibody.integration.adaptive import EngineRun
from multibody.integration.peak import Peaks
from multibody.integration.refine import Refinement
from multibody.integration.regularization import resolved_regularization, with_regularization
from multibody.models.assembly import assemble
from reference.problem import Outcome, load_scene

PHASE = [(0.3, 1.1)]
BRIEF = changed(load_scene("fig3-I"), duration=2.0, excitation={"amplitudes": [[2.0, 0.0], [0.0, 2.0]]})


@pytest.mark.parametrize("speed", [1e-7, 1e-8])
def test_an_unresolved_v_reg_has_the_factors_of_the_equations_at_that_speed(speed: float) -> None:
    engine = multibody.amplification(BRIEF, PHASE, regularization=speed, tolerance=1e-3)
    equations = reference.amplification(BRIEF, PHASE, equations="exact", regularization=speed)
    assert engine.status.tolist() == [Outcome.OK]
    assert (np.abs(engine.mu - equations.mu) <= engine.error + equations.error).all()


@pytest.mark.parametrize(("model", "tolerance"), [("translational", 1e-3), ("spatial", 1e-2)])
@pytest.mark.parametrize("speed", [1e-2, 1e-3, 1e-4, 1e-5])
def test_a_v_reg_that_the_contact_follows_stays_what_it_is(model: str, tolerance: float, speed: float) -> None:
    assert resolved_regularization(BRIEF, assemble(BRIEF, model, speed), speed, tolerance) == speed


def test_a_platform_too_light_for_any_contact_keeps_its_v_reg() -> None:
    light = changed(BRIEF, bodies=[{"mass": 1e-6}, {"mass": 2.0, "period": [1.5, 1.2]}])
    assert resolved_regularization(light, assemble(light, "translational", 1e-3), 1e-3, 1e-3) == 1e-3


def refinement(peak: float, error: float, outcome: Outcome = Outcome.OK) -> Refinement:
    run = EngineRun(Peaks(1, np.inf), np.inf)
    return Refinement(np.array([peak]), np.array([error]), outcome, np.nan, run)


def test_the_change_with_v_reg_is_an_error_at_first_order() -> None:
    point = with_regularization(refinement(1.0, 1e-4), refinement(1.0 + 4e-4, 1e-4), 1e-3)
    assert point.outcome == Outcome.OK
    # between v and 4 v lies three times the effect of v; times 1.5 for safety
    np.testing.assert_allclose(point.errors, [1e-4 + 2e-4], rtol=1e-9)


@pytest.mark.parametrize(
    ("smoother", "outcome"),
    [
        (refinement(1.1, 1e-4), Outcome.TOLERANCE_NOT_MET),
        (replace(refinement(np.nan, np.nan), outcome=Outcome.RIM_REACHED), Outcome.RIM_REACHED),
    ],
)
def test_a_v_reg_that_matters_is_no_answer(smoother: Any, outcome: Outcome) -> None:
    point = with_regularization(refinement(1.0, 1e-4), smoother, 1e-3)
    assert point.outcome == outcome
    assert np.isnan(point.peaks).any() == (outcome == Outcome.RIM_REACHED)
