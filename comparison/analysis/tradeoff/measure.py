"""
Settings measured on worker processes: processor time per point, warm, and errors against the reference_solutions.

A worker solves a short motion with a function before its time counts, so that nothing is compiled or loaded within it.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.analysis.tradeoff.settings import Question, Setting, Settings, asked, settings
from comparison.analysis.tradeoff.trade import Answered, Entry, Trade, labeled, quantile, with_pareto_fronts
from comparison.execution.executors import Pool
from comparison.execution.processes import process_pool
from comparison.execution.sweep import sweep
from comparison.study.batches import imported
from reference.problem import Amplification, Outcome, Scene

Array = NDArray[np.float64]

SEED = 20  # of the sample of phase pairs: the same in every run
SHORT = 0.2  # s of motion, to warm up
CHUNK = 3.0  # s of work in one task, about

Function = tuple[str, Settings]
_warm: set[str] = set()


@dataclass(frozen=True)
class Task:
    """Some phase pairs (M, 2) of the sample, rad, from number `first` on, under one function."""

    scene: Scene
    function: Function
    first: int
    phases: Array


@dataclass(frozen=True)
class Found:
    """mu, error_estimate (M, N), NaN without; processor time, s; mean step, s, or NaN; what went wrong, or ""."""

    mu: Array
    error_estimate: Array
    seconds: float
    step: float
    error_message: str = ""

    def upto(self, count: int) -> Found:
        """The first phase pairs, with their share of the time."""
        share = min(1.0, count / len(self.mu))
        return replace(
            self, mu=self.mu[:count], error_estimate=self.error_estimate[:count], seconds=self.seconds * share
        )


def sample(points: int) -> Array:
    """Phase pairs (points, 2), rad; a smaller sample is the beginning of a larger one."""
    return np.random.default_rng(SEED).uniform(0.0, 2.0 * np.pi, (points, 2))


def solve(task: Task) -> Found:
    """Ask the task's function, warm; never raises for what a model does."""
    path, given = task.function
    if path not in _warm:
        _warm.add(path)
        _asked(task.scene.with_values({"duration": SHORT}), task.phases[:1], path, given)
    return _asked(task.scene, task.phases, path, given)


def _asked(scene: Scene, phases: Array, path: str, given: Settings) -> Found:
    shape = len(phases), len(scene.bodies)
    nothing, step = np.full(shape, np.nan), np.nan
    clock = time.process_time()
    try:
        found = imported(path)(scene, phases, **given)
    except Exception as error:
        return Found(nothing, nothing, time.process_time() - clock, np.nan, f"{type(error).__name__}: {error}")
    seconds = time.process_time() - clock
    if isinstance(found, tuple):
        found, step = found
    if isinstance(found, Amplification):
        return Found(found.mu, found.error, seconds, step)
    return Found(np.asarray(found, dtype=float), nothing, seconds, step)


def lost(task: Task, outcome: Outcome, error_message: str) -> Found:
    """A worker that died leaves points without a value."""
    nothing = np.full((len(task.phases), len(task.scene.bodies)), np.nan)
    return Found(nothing, nothing, 0.0, np.nan, f"{outcome.value}: {error_message}")


def key(function: Function) -> str:
    """What tells two functions apart."""
    return f"{function[0]} {sorted(function[1].items())}"


def functions(scene: Scene, quick: bool) -> dict[str, tuple[Function, int, float]]:
    """Every function to call: itself, its number of points, seconds per point."""
    points = {question.key: question.quick if quick else question.points for question in asked(scene)}
    own = settings(scene, quick)
    calls = [(question.reference_solution, points[question.key], question.seconds) for question in asked(scene)]
    calls += [(one.against, points[one.question], 0.01) for one in own if one.against]
    calls += [((one.function, one.settings), points[one.question], one.seconds) for one in own]
    found: dict[str, tuple[Function, int, float]] = {}
    for function, count, seconds in calls:  # one may serve two questions
        found[key(function)] = function, max(count, found.get(key(function), (function, 0, 0.0))[1]), seconds
    return found


def tasks(scene: Scene, quick: bool) -> list[tuple[Task, float]]:
    """The work, each with the seconds it is expected to take."""
    found = []
    for function, count, seconds in functions(scene, quick).values():
        each = seconds * scene.duration / 20.0
        size = int(np.clip(CHUNK / each, 1, count))
        found += [
            (Task(scene, function, first, sample(count)[first : first + size]), each * min(size, count - first))
            for first in range(0, count, size)
        ]
    return sorted(found, key=lambda pair: -pair[1])


def measured(
    scene: Scene,
    quick: bool,
    jobs: int,
    run: Mapping[str, Any],
    done: Callable[[Task], None] = lambda task: None,
    executor: Pool = process_pool,
) -> tuple[Trade, xr.Dataset]:
    """The trade of one scene, and every value behind it."""
    work = [task for task, _ in tasks(scene, quick)]
    results = sweep(work, solve, lost, lambda task, found: done(task), jobs, executor)
    parts: dict[str, list[tuple[int, Found]]] = {}
    for task, found in zip(work, results):
        parts.setdefault(key(task.function), []).append((task.first, found))
    whole = {name: _joined([found for _, found in sorted(own, key=lambda one: one[0])]) for name, own in parts.items()}
    entries, mu, reference_solutions, claims = [], [], [], []
    for setting in settings(scene, quick):
        question = next(one for one in asked(scene) if one.key == setting.question)
        count = question.quick if quick else question.points
        reference_solution = whole[key(setting.against or question.reference_solution)].upto(count)
        found = whole[key((setting.function, setting.settings))].upto(count)
        entries.append(entry(setting, found, reference_solution.mu))
        mu.append(found.mu)
        reference_solutions.append(reference_solution.mu)
        claims.append(found.error_estimate)
    entries = with_pareto_fronts(entries, len(scene.bodies))
    questions = [_answered(question, whole[key(question.reference_solution)], entries) for question in asked(scene)]
    trade = Trade(scene.name, scene.title, scene.digest(), len(scene.bodies), questions, entries, run)
    most = sample(max(question.points for question in questions))
    return trade, labeled(entries, mu, reference_solutions, claims, most, run)


def _joined(parts: Sequence[Found]) -> Found:
    return Found(
        np.concatenate([part.mu for part in parts]),
        np.concatenate([part.error_estimate for part in parts]),
        sum(part.seconds for part in parts),
        float(np.mean([part.step for part in parts])),
        next((part.error_message for part in parts if part.error_message), ""),
    )


def entry(setting: Setting, found: Found, reference_solution: Array) -> Entry:
    """What one setting gave, against the reference solution (M, N)."""
    error, error_estimate = np.abs(found.mu / reference_solution - 1.0), found.error_estimate / np.abs(found.mu)
    points, bodies = found.mu.shape
    return Entry(
        question=setting.question,
        method=setting.method,
        parameter=setting.parameter,
        unit=setting.unit,
        value=setting.value,
        controlled=setting.controlled,
        model_error=setting.model_error,
        points=points,
        answered=int(np.isfinite(error).all(axis=1).sum()),
        seconds=found.seconds / points,
        median=[quantile(error[:, body], 0.5) for body in range(bodies)],
        most=[quantile(error[:, body], 0.95) for body in range(bodies)],
        error_estimate=[quantile(error_estimate[:, body], 0.95) for body in range(bodies)],
        step=found.step if np.isfinite(found.step) else None,
        error_message=found.error_message,
    )


def _answered(question: Question, reference_solution: Found, entries: Sequence[Entry]) -> Answered:
    """The question with its reference solution, and what is known about that."""
    error_estimate = reference_solution.error_estimate / np.abs(reference_solution.mu)
    error = float(np.nanmax(error_estimate)) if np.isfinite(error_estimate).any() else float("inf")
    tolerance = question.reference_solution[1]["tolerance"]
    side = "the reference" if question.reference_solution[0].startswith("reference") else "the engine"
    seconds = reference_solution.seconds / len(reference_solution.mu)
    return Answered(
        question.key,
        question.title,
        len(reference_solution.mu),
        f"{side} at a tolerance of {tolerance:.0e}, {seconds:.2g} s per point",
        error,
        [f"its own error estimate is {error:.0e} at most", *_agreements(question, entries)],
    )


def _agreements(question: Question, entries: Sequence[Entry]) -> list[str]:
    """
    How far the most accurate setting of other methods agrees with the reference solution; of the same one where there
    is none.
    """
    own = [one for one in entries if one.question == question.key and not one.model_error and one.answered]
    engine = question.reference_solution[0].startswith("multibody")
    others = {
        "SciPy": "another method on the same equations",
        "translational": "other code from the bodies up",
    }
    found = []
    for family, what in {} if engine else others.items():
        candidates = [one for one in own if one.method.startswith(family)]
        found += [_agreement(min(candidates, key=_largest), what)] if candidates else []
    controlled = [one for one in own if one.controlled]
    return (
        found or [_agreement(min(controlled, key=_largest), "the same code, asked for less")] if controlled else found
    )


def _agreement(one: Entry, what: str) -> str:
    return f"{one.method} ({one.parameter} {one.value:.0e}), {what}, agrees with it to {_largest(one):.0e} at 95 %"


def _largest(one: Entry) -> float:
    """Error of the mu that is known worst."""
    return max(np.inf if part is None else part for part in one.most)
