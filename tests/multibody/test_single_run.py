"""One run at a level or at a constant step is what `amplification` and `trajectory` are made of."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import multibody
from reference.problem import Outcome, ground_peak, load_scene

PHASE = (0.3, 1.1)
SCENE = load_scene("fig3-I").with_values({"duration": 1.0})


@pytest.mark.parametrize("model", ["translational", "spatial"])
def test_the_run_at_the_second_level_has_the_peaks_of_the_answer(model: str) -> None:
    answer = multibody.amplification(SCENE, [PHASE], model)
    run = multibody.single_run(SCENE, PHASE, model, level=multibody.levels(SCENE, model)[1])
    assert answer.status[0] == run.status == Outcome.OK
    np.testing.assert_array_equal(run.peak / ground_peak(SCENE, [PHASE])[0], answer.mu[0])


def test_a_level_with_another_contact_rounds_like_it() -> None:
    level = multibody.levels(SCENE)[0]
    stiffer = replace(level, penetration=level.penetration / 100.0)
    assert stiffer.rounding == pytest.approx(100.0 * level.rounding)


@pytest.mark.parametrize("integrator", ["generalized alpha", "trapezoidal", "RK44"])
def test_every_integrator_finds_the_motion_at_a_constant_step(integrator: str) -> None:
    run = multibody.single_run(SCENE, PHASE, step=2e-4, integrator=integrator)
    answer = multibody.amplification(SCENE, [PHASE])
    assert len(run.time) >= 5001, "the engine may halve steps, never lengthen them"
    np.testing.assert_allclose(run.peak / ground_peak(SCENE, [PHASE])[0], answer.mu[0], rtol=5e-3)


def test_an_unstable_run_is_no_answer() -> None:
    assert multibody.single_run(SCENE, PHASE, step=2e-3, integrator="velocity Verlet").status != Outcome.OK


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "exactly one"),
        ({"step": 1e-3, "level": multibody.levels(SCENE)[0]}, "exactly one"),
        ({"step": 0.0}, "step"),
        ({"step": 2.0}, "step"),
        ({"step": 1e-3, "integrator": "Euler"}, "integrator"),
        ({"step": 1e-3, "penetration": -1.0}, "penetration"),
    ],
)
def test_wrong_arguments_are_refused_by_name(options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        multibody.single_run(SCENE, PHASE, **options)
