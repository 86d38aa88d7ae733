"""Models that fail at an extreme in every way that must be found, and two that do not. Workers import them by name."""

import os

import numpy as np
from numpy.typing import NDArray

from reference.problem import Amplification, Outcome, Scene


def _answer(phases: NDArray[np.float64], mu: float, error: float, status: str = "ok") -> Amplification:
    shape = len(phases), 2
    instant = np.full(len(phases), np.nan)
    return Amplification(np.full(shape, mu), np.full(shape, error), np.full(len(phases), status), instant, 0.0)


def honest(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    return _answer(phases, 1.0 + 0.5 * tolerance, tolerance)


def at_the_rim(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    return _answer(phases, np.nan, np.nan, Outcome.RIM_REACHED)


def unable(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    return _answer(phases, np.nan, np.nan, Outcome.STEP_LIMIT)


def hangs(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    while True:
        pass


def crashes(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    os._exit(3)


def raises(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    raise ZeroDivisionError("an inner fault")


def calls_nan_ok(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    return _answer(phases, np.nan, 1e-9)


def lies_about_its_error(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    """A thousandth of the error is claimed."""
    return _answer(phases, 1.0 + tolerance, 1e-3 * tolerance)


def misses_the_tolerance(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    return _answer(phases, 1.0, 3.0 * tolerance)


def refuses_what_can_be_done(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    """The rim is reached only by the run that was asked for less."""
    return at_the_rim(scene, phases, tolerance) if tolerance > 1e-5 else honest(scene, phases, tolerance)


def gives_a_value_with_a_refusal(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    """Of one of two bodies."""
    answer = _answer(phases, 1.0, 1e-9, Outcome.CONTACT_LOST)
    answer.mu[:, 0] = np.nan
    return answer


def invents_a_status(scene: Scene, phases: NDArray[np.float64], tolerance: float) -> Amplification:
    return _answer(phases, np.nan, np.nan, "went home")
