"""Demands of every phase pair of a surface: one motion for each, read by `demands`."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reference.problem.definition import ground_peak
from reference.problem.demands import Demands, Estimate, demands
from reference.problem.outcome import Outcome
from reference.problem.phases import checked_phases
from reference.problem.result import Trajectory
from reference.problem.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Estimates:
    """
    Numbers and their errors.

    Attributes
    ----------
    value : ndarray, (M,) or (M, K)
        For M phase pairs, of K bodies or links. NaN without an answer.
    error : ndarray, likewise
        Estimated absolute error; NaN where it is not known.
    """

    value: Array
    error: Array


@dataclass(frozen=True)
class PeakDemands(Mapping[str, Estimates]):
    """
    Demands of M phase pairs; what `peak_demands` returns.

    A mapping from the names of the fields of `Demands` to `Estimates`, without those that the model lacks.

    Attributes
    ----------
    estimates : dict of str to Estimates
        `acceleration` is (M, N) and `drift` (M, N - 1), everything else (M,).
    status : ndarray of str, (M,)
        "ok" or another value of `Outcome`.
    instant : ndarray, (M,), s
        When the status arose; NaN where it is "ok".
    cost : float, s
        Processor time.
    """

    estimates: dict[str, Estimates]
    status: NDArray[np.str_]
    instant: Array
    cost: float

    def __getitem__(self, name: str) -> Estimates:
        return self.estimates[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.estimates)

    def __len__(self) -> int:
        return len(self.estimates)


def demands_of_motions(scene: Scene, phases: ArrayLike, move: Callable[[Array], Trajectory]) -> PeakDemands:
    """
    Demands of the motion at every phase pair.

    Parameters
    ----------
    scene : Scene
    phases : array_like, (M, 2), rad
    move : callable
        The motion of one phase pair (2,).

    Returns
    -------
    PeakDemands
        A pair without an answer is NaN; its status says why. The other pairs do not depend on it.
    """
    pairs = checked_phases(phases)
    clock = time.process_time()
    status = np.full(len(pairs), Outcome.NON_FINITE_LOAD.value, dtype=f"U{max(map(len, Outcome))}")
    instant = np.zeros(len(pairs))
    answers: list[Demands | None] = [None] * len(pairs)
    for number in np.flatnonzero(np.isfinite(ground_peak(scene, pairs))):
        motion = move(pairs[number])
        status[number], instant[number], answers[number] = motion.status, motion.instant, demands(motion)
    return PeakDemands(_stacked(answers), status, instant, time.process_time() - clock)


def _stacked(answers: list[Demands | None]) -> dict[str, Estimates]:
    """Every field of the answers; NaN in place of an answer that is lacking."""
    first = next((answer for answer in answers if answer is not None), None)
    stacked: dict[str, Estimates] = {}
    for name in (field.name for field in fields(Demands)):
        sample = None if first is None else getattr(first, name)
        if isinstance(sample, Estimate):
            nothing: float | Array = np.nan
        elif isinstance(sample, tuple):
            nothing = np.full(len(sample), np.nan)
        else:
            continue
        values, errors = (
            np.array([nothing if answer is None else _part(getattr(answer, name), part) for answer in answers])
            for part in ("value", "error")
        )
        stacked[name] = Estimates(values, errors)
    return stacked


def _part(estimates: Estimate | tuple[Estimate, ...], part: str) -> float | list[float]:
    """The values or the errors of one answer."""
    if isinstance(estimates, Estimate):
        return float(getattr(estimates, part))
    return [float(getattr(estimate, part)) for estimate in estimates]
