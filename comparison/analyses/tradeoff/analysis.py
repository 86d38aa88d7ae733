"""
The trade-off as an analysis: a task for every few seconds of a function's phase pairs, and the diagram made of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.analyses.tradeoff.measure import Function, Measured, Measurement, joined, measure, sample, without_value
from comparison.analyses.tradeoff.settings import Question, Setting, asked, settings, user_settings
from comparison.analyses.tradeoff.trade import Answered, Entry, Trade, labeled, quantile, with_pareto_fronts
from comparison.json_file import finite_or_none
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.models import Model
from comparison.study.study import Study
from comparison.study.user_models import engine_of
from reference.problem import Scene

Array = NDArray[np.float64]

CHUNK = 3.0  # s of work in one task, about
STATED = ("question", "method", "parameter", "unit", "value", "controlled", "model_error")  # of a setting
CHEAP = 0.01  # s per point of a reference solution of its own, about
OTHER_METHODS = {"SciPy": "another method on the same equations", "translational": "other code from the bodies up"}


@dataclass(frozen=True)
class MeasuredTrade:
    """One scene: the diagram, and every value behind it by setting, point and body."""

    trade: Trade
    values: xr.Dataset


@dataclass(frozen=True)
class TradeOff(Analysis[list[MeasuredTrade]]):
    """Error against compute time of every setting in every scene with phases; quick: fewer points and values."""

    key, stage = "tradeoff", "trade-off"
    quick: bool = False
    supplied: tuple[Model, ...] = ()

    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """Every function of every scene, its sample in parts of about CHUNK seconds."""
        return [task for scene in study.phased for tasks in self._by_function(scene).values() for task in tasks]

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> list[MeasuredTrade]:
        """One diagram for each scene, without what the command knows of the run."""
        return [self._trade(scene, results) for scene in study.phased]

    def _by_function(self, scene: Scene) -> dict[str, list[Task]]:
        """The tasks of a scene by the key of their function."""
        tasks: dict[str, list[Task]] = {}
        limits = {engine_of(model.settings)["function"]: model.timeout for model in self.supplied}
        for name, (function, count, seconds) in functions(scene, self.quick, user_settings(self.supplied)).items():
            each = seconds * scene.duration / 20.0
            size = int(np.clip(CHUNK / each, 1, count))
            phases = sample(count)
            engine = engine_of(function[1]).get("function", "")
            limit = limits.get(engine)
            tasks[name] = [
                Task(
                    measure,
                    Measurement(scene, function, first, phases[first : first + size]),
                    self.stage,
                    each * min(size, count - first),
                    scene,
                    timeout=limit and limit * size,
                    group=engine,
                )
                for first in range(0, count, size)
            ]
        return tasks

    def _trade(self, scene: Scene, results: TaskResults) -> MeasuredTrade:
        measured = {
            name: joined([results.value(task, without_value) for task in tasks])
            for name, tasks in self._by_function(scene).items()
        }
        questions = {question.key: question for question in asked(scene)}
        entries, answers, reference_solutions = [], [], []
        for setting in [*settings(scene, self.quick), *user_settings(self.supplied)]:
            question = questions[setting.question]
            count = question.quick if self.quick else question.points
            reference_solution = measured[key(setting.against or question.reference_solution)].upto(count)
            answer = measured[key((setting.function, setting.settings))].upto(count)
            entries.append(entry(setting, answer, reference_solution.mu))
            answers.append(answer)
            reference_solutions.append(reference_solution.mu)
        entries = with_pareto_fronts(entries, len(scene.bodies))
        answered = [
            _answered(question, measured[key(question.reference_solution)], entries) for question in questions.values()
        ]
        trade = Trade(scene.name, scene.title, scene.digest(), len(scene.bodies), answered, entries, {})
        phases = sample(max(question.points for question in answered))
        estimates = [answer.error_estimate for answer in answers]
        return MeasuredTrade(
            trade, labeled(entries, [answer.mu for answer in answers], reference_solutions, estimates, phases)
        )


def key(function: Function) -> str:
    """What tells two functions apart."""
    return f"{function[0]} {sorted(function[1].items())}"


def functions(scene: Scene, quick: bool, others: Sequence[Setting] = ()) -> dict[str, tuple[Function, int, float]]:
    """
    Every function called for a scene, by its key, with its number of phase pairs and about how long each takes, s.
    """
    points = {question.key: question.quick if quick else question.points for question in asked(scene)}
    measured = [*settings(scene, quick), *others]
    calls = [(question.reference_solution, points[question.key], question.seconds) for question in asked(scene)]
    calls += [(setting.against, points[setting.question], CHEAP) for setting in measured if setting.against]
    calls += [((setting.function, setting.settings), points[setting.question], setting.seconds) for setting in measured]
    by_key: dict[str, tuple[Function, int, float]] = {}
    for function, count, seconds in calls:  # one may serve two questions
        before = by_key.get(key(function), (function, 0, 0.0))[1]
        by_key[key(function)] = function, max(count, before), seconds
    return by_key


def entry(setting: Setting, measured: Measured, reference_solution: Array) -> Entry:
    """What one setting gave at M phase pairs, against mu (M, N) of the reference solution there."""
    error = np.abs(measured.mu / reference_solution - 1.0)
    error_estimate = measured.error_estimate / np.abs(measured.mu)
    points, bodies = measured.mu.shape
    return Entry(
        **{name: getattr(setting, name) for name in STATED},
        points=points,
        answered=int(np.isfinite(error).all(axis=1).sum()),
        seconds=measured.seconds / points,
        median=[quantile(error[:, body], 0.5) for body in range(bodies)],
        most=[quantile(error[:, body], 0.95) for body in range(bodies)],
        error_estimate=[quantile(error_estimate[:, body], 0.95) for body in range(bodies)],
        step=finite_or_none(measured.step),
        error_message=measured.error_message,
    )


def _answered(question: Question, reference_solution: Measured, entries: Sequence[Entry]) -> Answered:
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
    """How far the most accurate setting of other methods, else of the same one, agrees with the reference solution."""
    candidates = [
        setting
        for setting in entries
        if setting.question == question.key and not setting.model_error and setting.answered
    ]
    by_engine = question.reference_solution[0].startswith("multibody")
    agreements = []
    for family, what in {} if by_engine else OTHER_METHODS.items():
        others = [setting for setting in candidates if setting.method.startswith(family)]
        agreements += [_agreement(min(others, key=_largest), what)] if others else []
    controlled = [setting for setting in candidates if setting.controlled]
    if agreements or not controlled:
        return agreements
    return [_agreement(min(controlled, key=_largest), "the same code, asked for less")]


def _agreement(setting: Entry, what: str) -> str:
    at = f"{setting.method} ({setting.parameter} {setting.value:.0e})"
    return f"{at}, {what}, agrees with it to {_largest(setting):.0e} at 95 %"


def _largest(setting: Entry) -> float:
    """Error of the mu that is known worst."""
    return max(np.inf if error is None else error for error in setting.most)
