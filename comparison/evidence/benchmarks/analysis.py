"""Benchmarks of published numbers as tasks: one for every benchmark and side."""

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from comparison.evidence.benchmarks.cases import BenchmarkCase, MotionReading
from comparison.evidence.benchmarks.table import (
    FRICTION_EXPLANATION,
    MODEL_EXPLANATION,
    Benchmark,
    Benchmarks,
    PublishedNumber,
    SideNumber,
)
from comparison.evidence.sides import ENGINE, EQUATIONS, SMOOTHED
from comparison.json_file import finite_or_none
from comparison.runner.task import Task, TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import import_function
from comparison.study.models import EXACT, REGULARIZED, TRANSLATIONAL
from comparison.verdicts import MET, NOT_MET
from reference.measures.demand_reader import FULL_LENGTH_OUTCOMES
from reference.problem import State, Trajectory

# Model of each way to solve a benchmark: equations with rigid friction, with regularized friction, multibody engine
MODEL_OF_SIDE = {EQUATIONS: EXACT, SMOOTHED: REGULARIZED, ENGINE: TRANSLATIONAL}
TOLERANCE_OF_SIDE = {EQUATIONS: 1e-8, SMOOTHED: 1e-8, ENGINE: 1e-4}  # relative error asked, by solver
READ_SAMPLES = 100_001  # number of instants of a motion by the equations, from which numbers such as extremes are read
SECONDS_OF_SIDE = {EQUATIONS: 0.1, SMOOTHED: 0.1, ENGINE: 3.5}  # s, predicted processor time of a motion by solver
TASK_TIME_LIMIT = 300.0  # s, processor time after which a task is ended


@dataclass(frozen=True)
class SideNumbers:
    """Numbers for a benchmark as one side, the equations or the engine, computes them."""

    values: list[float]  # in the units of the published numbers; empty if the motion ended early
    errors: list[float]  # estimated absolute errors of the values
    ending: str  # how the computed motion ended
    seconds: float  # s, processor time


@dataclass(frozen=True)
class BenchmarkTable:
    """
    Benchmarks, each of which is solved by three sides.

    The sides are the equations, the equations with the engine's friction law ("smoothed"), and the engine.
    """

    cases: Sequence[BenchmarkCase]

    def tasks(self) -> list[Task]:
        """Return a task for each benchmark and side."""
        return [self._task(case, side) for case in self.cases for side in MODEL_OF_SIDE]

    def collect(self, results: TaskResults) -> Benchmarks:
        """Return the results of all benchmarks; its field `run` is empty, to be filled by the command."""
        answers = [
            {side: results.value(self._task(case, side), _answer_of_failure) for side in MODEL_OF_SIDE}
            for case in self.cases
        ]
        return Benchmarks([_make_benchmark(case, of_case) for case, of_case in zip(self.cases, answers)], run={})

    def _task(self, case: BenchmarkCase, side: str) -> Task:
        """Return the task that solves a benchmark by one side."""
        return Task(
            solve_side,
            (case, side),
            stage="benchmarks",
            seconds=SECONDS_OF_SIDE[side] * max(1.0, case.scene.duration / 12.0),
            about=case.scene,
            needs_compiled_reference=side != ENGINE,
            timeout=TASK_TIME_LIMIT,
        )


def solve_side(benchmark_and_side: tuple[BenchmarkCase, str]) -> SideNumbers:
    """Solve a benchmark by one side; return the numbers to compare with those published. Runs in a worker process."""
    case, side = benchmark_and_side
    settings = dict(MODEL_OF_SIDE[side].settings)
    if side != EQUATIONS:
        settings["regularization"] = case.regularization
    if side != ENGINE:
        settings["times"] = np.linspace(0.0, case.scene.duration, READ_SAMPLES)
    if case.start:
        place = np.array(case.start)
        settings["initial"] = State(place, np.zeros_like(place))
    clock = time.process_time()
    trajectory = import_function(MODEL_OF_SIDE[side].trajectory)
    motion: Trajectory = trajectory(case.scene, case.phases, tolerance=TOLERANCE_OF_SIDE[side], **settings)
    values, errors = _read_numbers(case.reading, motion)
    return SideNumbers(values=values, errors=errors, ending=str(motion.status), seconds=time.process_time() - clock)


def _read_numbers(reading: MotionReading, motion: Trajectory) -> tuple[list[float], list[float]]:
    """Return the numbers read from a motion and their estimated absolute errors; two empty lists if it ended early."""
    if motion.status not in FULL_LENGTH_OUTCOMES or len(motion.time) < 2:
        return [], []
    # The error of a number has two parts: that of the solution, from coarser solutions, and that of reading it from
    # samples, which is a third of the change by leaving out every second sample, as it is of second order.
    values, accuracy = reading.read(motion), motion.accuracy
    others = [] if accuracy is None else [reading.read(each) for each in (halve_samples(motion), *accuracy.coarser)]
    # no error estimate: a coarser solution has another number of swings, so that numbers do not pair
    if accuracy is None or any(len(other) != len(values) for other in others):
        return values, [math.nan] * len(values)
    rows = zip(values, *others)
    return values, [accuracy.error_of(value, rest) + abs(value - halved) / 3.0 for value, halved, *rest in rows]


def halve_samples(motion: Trajectory) -> Trajectory:
    """Return a motion with every second sample, from which numbers are read with about four times the error."""
    kept = np.append(np.arange(0, len(motion.time) - 1, 2), len(motion.time) - 1)
    arrays = {name: getattr(motion, name)[kept] for name in ("time", "position", "velocity", "absolute_acceleration")}
    return replace(motion, **arrays)


def _make_benchmark(case: BenchmarkCase, answers: Mapping[str, SideNumbers]) -> Benchmark:
    """Return a benchmark's published numbers beside those that the sides in `answers` computed."""
    return Benchmark(
        name=case.scene.name,
        title=case.title,
        source=case.source,
        evidence=case.evidence,
        regularization=case.regularization,
        difference=case.difference,
        rows=[_make_row(case, place, answers) for place in range(len(case.published))],
        endings={side: answer.ending for side, answer in answers.items()},
        seconds={side: round(answer.seconds, 3) for side, answer in answers.items()},
    )


def _make_row(case: BenchmarkCase, place: int, answers: Mapping[str, SideNumbers]) -> PublishedNumber:
    """Return the published number at index `place` beside those computed; none if a motion gave too few numbers."""
    row = case.published[place]
    numbers = dict.fromkeys(answers, (math.nan, math.nan))
    for side, answer in answers.items():
        if len(answer.values) == len(case.published):
            numbers[side] = answer.values[place], answer.errors[place]

    def read_number(side: str) -> SideNumber:
        """Return the number by one side with its verdict and, if that is "not met", an explanation."""
        value, error = map(finite_or_none, numbers[side])
        verdict = row.judge(value, error)
        explanation = explain_deviation(side) if verdict == NOT_MET else ""
        return SideNumber(value=value, error=error, verdict=verdict, explanation=explanation)

    def explain_deviation(side: str) -> str:
        """
        Return why the number by one side misses the published one, "" if that is not known.

        Either the source has another model, or the engine's friction law makes the difference: the equations with this
        law then give the same number.
        """
        if case.difference:
            return MODEL_EXPLANATION
        (value, error), (smoothed, smoothed_error) = numbers[side], numbers[SMOOTHED]
        same = replace(row, published=smoothed, uncertainty=smoothed_error)
        return FRICTION_EXPLANATION if side != EQUATIONS and same.judge(value, error) == MET else ""

    return replace(row, numbers={side: read_number(side) for side in numbers})


def _answer_of_failure(benchmark_and_side: tuple[BenchmarkCase, str], failed: TaskResult) -> SideNumbers:
    """Return no numbers and the reason, for a benchmark that one side failed to compute."""
    return SideNumbers(values=[], errors=[], ending=failed.reason, seconds=0.0)
