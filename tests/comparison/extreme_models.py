"""Models that fail at an extreme in every way that must be found, and two that do not. Workers import them by name."""

import os
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from reference.problem import Amplification, Outcome, Scene


def _answering(answer: Callable[[float], tuple[float, float]], status: str = "ok") -> Callable[..., Amplification]:
    """A model with one mu and error for every point and body, which follow from the tolerance."""

    def model(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
        mu, error = (np.full((len(phases), 2), value) for value in answer(tolerance))
        return Amplification(mu, error, np.full(len(phases), status), np.full(len(phases), np.nan), 0.0)

    return model


honest = _answering(lambda tolerance: (1.0 + 0.5 * tolerance, tolerance))
at_the_rim = _answering(lambda tolerance: (np.nan, np.nan), Outcome.RIM_REACHED)
unable = _answering(lambda tolerance: (np.nan, np.nan), Outcome.STEP_LIMIT)
calls_nan_ok = _answering(lambda tolerance: (np.nan, 1e-9))
lies_about_its_error = _answering(lambda tolerance: (1.0 + tolerance, 1e-3 * tolerance))  # it claims a thousandth
misses_the_tolerance = _answering(lambda tolerance: (1.0, 3.0 * tolerance))
invents_a_status = _answering(lambda tolerance: (np.nan, np.nan), "went home")


def hangs(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    while True:
        pass


def crashes(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    os._exit(3)


def raises(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    raise ZeroDivisionError("an inner fault")


def refuses_what_can_be_done(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    """The rim is reached only by the run that was asked for less."""
    return at_the_rim(scene, phases, tolerance) if tolerance > 1e-5 else honest(scene, phases, tolerance)


def gives_a_value_with_a_refusal(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    """Of one of two bodies."""
    answer = _answering(lambda tolerance: (1.0, 1e-9), Outcome.CONTACT_LOST)(scene, phases, tolerance)
    answer.mu[:, 0] = np.nan
    return answer
