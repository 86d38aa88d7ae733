"""One smooth piece of motion at a time: SciPy steps, events found on the dense output, peaks refined."""

import math
from collections.abc import Callable, Sequence

import numpy as np
from oracle_law import RefusalError
from scipy.integrate import DOP853, Radau
from scipy.optimize import brentq, minimize_scalar

NODES = np.linspace(0.0, 1.0, 9)

Curve = Callable[[float], np.ndarray]
Event = Callable[[float, np.ndarray], float]  # a piece ends where one rises through 0
Observation = tuple[list[float], float]  # |absolute acceleration|^2 of each body, slip speed


class Peaks:
    """
    Running maxima of |absolute acceleration|^2 over the times when the slip speed is at least the cutoff.

    cutoffs: slip speeds in m/s; 0 is the supremum. A maximum over such a set is a local maximum inside it or a value
    where the speed crosses the cutoff, so these are all that is looked for.
    """

    def __init__(self, cutoffs: Sequence[float], bodies: int) -> None:
        self.cutoffs = list(cutoffs)
        self.best = np.zeros((len(self.cutoffs), bodies))

    def offer(self, observation: Observation) -> None:
        squares, speed = observation
        for row, cutoff in enumerate(self.cutoffs):
            if speed >= cutoff * (1.0 - 1e-9):
                self.best[row] = np.maximum(self.best[row], squares)

    def piece(self, observe: Callable[[float], Observation], start: float, end: float) -> None:
        places = start + (end - start) * NODES
        seen = [observe(p) for p in places]
        for observation in seen:
            self.offer(observation)
        squares = np.array([s for s, _ in seen])
        speeds = np.array([v for _, v in seen])
        floor = self.best.min(axis=0)
        last = len(places) - 1
        for body in range(squares.shape[1]):
            column = squares[:, body]
            for k in range(last + 1):
                left, right = max(k - 1, 0), min(k + 1, last)
                if column[k] < column[left] or column[k] < column[right] or 1.05 * column[k] < floor[body]:
                    continue
                found = minimize_scalar(
                    lambda p, body=body: -observe(p)[0][body],
                    bounds=(places[left], places[right]),
                    method="bounded",
                    options={"xatol": 1e-7 * (places[right] - places[left])},
                )
                self.offer(observe(found.x))
        for cutoff in self.cutoffs:
            if cutoff == 0.0:
                continue
            above = speeds >= cutoff
            for k in np.flatnonzero(above[1:] != above[:-1]):
                crossing = brentq(
                    lambda p, c=cutoff: observe(p)[1] - c, places[k], places[k + 1], xtol=1e-15, rtol=1e-14
                )
                squares_there, _ = observe(crossing)
                self.offer((squares_there, cutoff))


def march(
    rhs: Callable[[float, np.ndarray], np.ndarray],
    start: float,
    state: np.ndarray,
    end: float,
    events: Sequence[Event],
    observe: Callable[[float, np.ndarray], Observation],
    peaks: Peaks,
    tolerance: float,
    stiff: bool = False,
    floor: np.ndarray | float = 1e-3,
    longest: float = math.inf,
) -> tuple[float, np.ndarray, int | None]:
    """
    Integrate until `end` or the first event that rises through 0: (place, state, number of the event or None).

    floor: absolute tolerance of each unknown over the relative one; longest: step. Raises RefusalError where an
    accepted step holds a state outside the equations.
    """
    if end <= start:
        return start, state, None
    method = Radau if stiff else DOP853

    def guarded(p: float, y: np.ndarray) -> np.ndarray:
        try:
            return rhs(p, y) if np.isfinite(y).all() else np.full(len(y), np.nan)
        except RefusalError:  # perhaps only a trial stage of a step too long: let the solver reject it
            return np.full(len(y), np.nan)

    solver = method(guarded, start, state, end, rtol=tolerance, atol=floor * tolerance, max_step=longest)
    while solver.status == "running":
        message = solver.step()
        if solver.status == "failed":
            raise RefusalError(f"{message} at {solver.t}")
        low, high = solver.t_old, solver.t
        dense = solver.dense_output()
        place, number = _first_event(dense, low, high, events)
        stop = high if number is None else place
        peaks.piece(lambda p, dense=dense: observe(p, dense(p)), low, stop)
        if number is not None:
            return stop, dense(stop), number
    return solver.t, solver.y, None


def _first_event(dense: Curve, low: float, high: float, events: Sequence[Event]) -> tuple[float, int | None]:
    places = low + (high - low) * NODES
    states = [dense(p) for p in places]
    first, which = math.inf, None
    for number, event in enumerate(events):
        values = [event(p, s) for p, s in zip(places, states)]

        def along(p: float, event: Event = event) -> float:
            return event(p, dense(p))

        for k in range(1, len(places)):
            if values[k] >= 0.0:
                if values[k - 1] >= 0.0:  # started on the wrong side: by rounding, or for good
                    if values[k] < 1e-9:
                        continue
                    root = places[k - 1]
                else:
                    root = brentq(along, places[k - 1], places[k], xtol=1e-15, rtol=1e-14)
                if root < first:
                    first, which = root, number
                break
            if k < len(places) - 1 and values[k] >= max(values[k - 1], values[k + 1]):
                top = minimize_scalar(
                    lambda p: -along(p), bounds=(places[k - 1], places[k + 1]), method="bounded",
                    options={"xatol": 1e-9 * (high - low)},
                )  # fmt: skip
                if -top.fun > 0.0 and values[k - 1] < 0.0:
                    root = brentq(along, places[k - 1], top.x, xtol=1e-15, rtol=1e-14)
                    if root < first:
                        first, which = root, number
                    break
    return first, which
