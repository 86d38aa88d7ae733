"""
Phase pairs measured on worker processes under one function: mu, its error estimate and processor time, warm.

A worker solves a short motion with a function before its time counts, so that nothing is compiled or loaded within it.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparison.analyses.tradeoff.settings import Settings
from comparison.runner.task import TaskResult
from comparison.study.batches import imported
from comparison.wording import exception_line
from reference.problem import Amplification, Scene

Array = NDArray[np.float64]

SEED = 20  # of the sample of phase pairs: the same in every run
SHORT = 0.2  # s of motion, to warm up

Function = tuple[str, Settings]  # "package:function" and its keyword arguments
_warm: set[str] = set()  # functions that this process has called


@dataclass(frozen=True)
class Measurement:
    """Some phase pairs of the sample under one function."""

    scene: Scene
    function: Function
    first: int  # number of the first phase pair in the sample
    phases: Array  # (M, 2), rad


@dataclass(frozen=True)
class Measured:
    """What a measurement gave."""

    mu: Array  # (M, N), NaN without a value
    error_estimate: Array  # (M, N), absolute, NaN without
    seconds: float  # of processor time
    step: float  # mean step, s; NaN where the function does not tell it
    error_message: str = ""  # what went wrong, or empty

    def __post_init__(self) -> None:
        if self.mu.ndim != 2 or self.error_estimate.shape != self.mu.shape:
            raise ValueError(f"mu {self.mu.shape}, error_estimate {self.error_estimate.shape}")


def sample(points: int) -> Array:
    """
    The phase pairs that are measured, rad; a smaller sample is the beginning of a larger one.

    >>> bool((sample(3) == sample(5)[:3]).all())
    True
    """
    return np.random.default_rng(SEED).uniform(0.0, 2.0 * np.pi, (points, 2))


def measure(measurement: Measurement) -> Measured:
    """Call the function, warm, inside a worker process; where it raises there are no values, but the reason."""
    path, settings = measurement.function
    if path not in _warm:
        _warm.add(path)
        _called(measurement.scene.with_values({"duration": SHORT}), measurement.phases[:1], path, settings)
    return _called(measurement.scene, measurement.phases, path, settings)


def _called(scene: Scene, phases: Array, path: str, settings: Settings) -> Measured:
    nothing, step = np.full((len(phases), len(scene.bodies)), np.nan), np.nan
    clock = time.process_time()
    try:
        answer = imported(path)(scene, phases, **settings)
    except Exception as error:
        return Measured(nothing, nothing, time.process_time() - clock, np.nan, exception_line(error))
    seconds = time.process_time() - clock
    if isinstance(answer, tuple):
        answer, step = answer
    if isinstance(answer, Amplification):
        return Measured(answer.mu, answer.error, seconds, step)
    return Measured(np.asarray(answer, dtype=float), nothing, seconds, step)


def without_value(measurement: Measurement, failed: TaskResult) -> Measured:
    """In place of what a task did not return: phase pairs without a value."""
    nothing = np.full((len(measurement.phases), len(measurement.scene.bodies)), np.nan)
    return Measured(nothing, nothing, 0.0, np.nan, failed.reason)


def joined(parts: Sequence[Measured]) -> Measured:
    """The measurements of one function as one: times added up, and the first error message."""
    return Measured(
        np.concatenate([part.mu for part in parts]),
        np.concatenate([part.error_estimate for part in parts]),
        sum(part.seconds for part in parts),
        float(np.mean([part.step for part in parts])),
        next((part.error_message for part in parts if part.error_message), ""),
    )
