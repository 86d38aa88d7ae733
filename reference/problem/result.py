"""What both sides return."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Amplification:
    """
    Dynamic amplification factors mu_i of (5.1) for M phase pairs and N bodies.

    mu: (M, N), NaN where a point could not be solved. error: (M, N), estimated absolute error of mu.
    status: (M,) strings, "ok" or another `Outcome`. instant: (M,), s, when the status arose, NaN where ok.
    cost: s of compute, summed over processes and threads. cap_share: (M,), largest horizontal displacement of the
    platform over rho, read between steps to 1e-3 of itself or better; NaN without an answer.
    """

    mu: Array
    error: Array
    status: NDArray[np.str_]
    instant: Array
    cost: float
    cap_share: Array = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        if not len(self.cap_share):
            object.__setattr__(self, "cap_share", np.full(len(self.mu), np.nan))


@dataclass(frozen=True)
class Trajectory:
    """
    One motion in the plate's frame at T instants, N bodies, axes x, y, z.

    time: (T,), s. position: (T, N, 3), m, displacement relative to the plate from the equilibrium position.
    velocity: (T, N, 3), m/s. absolute_acceleration: (T, N, 3), m/s^2, acceleration plus ground acceleration.
    contact_force: (T,), N, normal reaction of the isolator. stick: intervals (start, end), s, of rest.
    status, instant: as in `Amplification`. extra: what only one model knows, by name. peak: (N,), m/s^2, largest
    absolute acceleration of the run, found between the samples and at one-sided limits: mu of (5.1) is made of it. The
    samples of `absolute_acceleration` miss it, by some percent at a stop or under a record. NaN if nothing was run.
    """

    time: Array
    position: Array
    velocity: Array
    absolute_acceleration: Array
    contact_force: Array
    stick: list[tuple[float, float]]
    status: str
    instant: float
    extra: dict[str, Array] = field(default_factory=dict)
    peak: Array = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        if not len(self.peak):
            object.__setattr__(self, "peak", np.full(self.position.shape[1], np.nan))


@dataclass(frozen=True)
class State:
    """Initial displacement and velocity relative to the plate, (N, 2) each, m and m/s, axes x, y."""

    position: Array
    velocity: Array
