"""Published numbers as an analysis: a task for every benchmark and side."""

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from comparison.evidence.benchmarks.cases import BenchmarkCase, MotionReading
from comparison.evidence.benchmarks.table import FRICTION, MODEL, Benchmark, Benchmarks, Number, PublishedNumber
from comparison.evidence.sides import ENGINE, EQUATIONS, SMOOTHED
from comparison.json_file import finite_or_none
from comparison.runner.task import Task, TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import import_function
from comparison.study.models import EXACT, REGULARIZED, TRANSLATIONAL
from comparison.verdicts import MET, NOT_MET
from reference.measures.demand_reader import FULL_LENGTH_OUTCOMES
from reference.problem import State, Trajectory

MODELS = {EQUATIONS: EXACT, SMOOTHED: REGULARIZED, ENGINE: TRANSLATIONAL}
TOLERANCES = {EQUATIONS: 1e-8, SMOOTHED: 1e-8, ENGINE: 1e-4}
SAMPLES = 100_001  # instants at which the equations are read
SECONDS = {EQUATIONS: 0.1, SMOOTHED: 0.1, ENGINE: 3.5}  # predicted cost
LIMIT = 300.0  # s of processor time of one task


@dataclass(frozen=True)
class SideNumbers:
    """The numbers of one side with their errors, and how the motion ended."""

    values: list[float]
    errors: list[float]
    ending: str
    seconds: float


@dataclass(frozen=True)
class BenchmarkTable:
    """Every benchmark by the equations, by the equations with the engine's friction law, and by the engine."""

    cases: Sequence[BenchmarkCase]

    def tasks(self) -> list[Task]:
        """One task for each benchmark and side."""
        return [self._task(case, side) for case in self.cases for side in MODELS]

    def collect(self, results: TaskResults) -> Benchmarks:
        """The table, without what the command knows of the run."""
        answers = [
            {side: results.value(self._task(case, side), _answer_of_failure) for side in MODELS} for case in self.cases
        ]
        return Benchmarks([_make_benchmark(case, of_case) for case, of_case in zip(self.cases, answers)], {})

    def _task(self, case: BenchmarkCase, side: str) -> Task:
        seconds = SECONDS[side] * max(1.0, case.scene.duration / 12.0)
        return Task(solve_side, (case, side), "benchmarks", seconds, case.scene, side != ENGINE, timeout=LIMIT)


def solve_side(question: tuple[BenchmarkCase, str]) -> SideNumbers:
    """The numbers of one side. Runs inside a worker process."""
    case, side = question
    settings = dict(MODELS[side].settings)
    if side != EQUATIONS:
        settings["regularization"] = case.regularization
    if side != ENGINE:
        settings["times"] = np.linspace(0.0, case.scene.duration, SAMPLES)
    if case.start:
        place = np.array(case.start)
        settings["initial"] = State(place, np.zeros_like(place))
    clock = time.process_time()
    trajectory = import_function(MODELS[side].trajectory)
    motion: Trajectory = trajectory(case.scene, case.phases, tolerance=TOLERANCES[side], **settings)
    return SideNumbers(*_read_numbers(case.reading, motion), str(motion.status), time.process_time() - clock)


def _read_numbers(reading: MotionReading, motion: Trajectory) -> tuple[list[float], list[float]]:
    """The numbers and their estimated absolute errors; none of a motion that ended early."""
    if motion.status not in FULL_LENGTH_OUTCOMES or len(motion.time) < 2:
        return [], []
    values, accuracy = reading.read(motion), motion.accuracy
    others = [] if accuracy is None else [reading.read(each) for each in (halve_samples(motion), *accuracy.coarser)]
    if accuracy is None or any(len(other) != len(values) for other in others):  # another number of swings
        return values, [math.nan] * len(values)
    rows = zip(values, *others)
    return values, [accuracy.error_of(value, rest) + abs(value - halved) / 3.0 for value, halved, *rest in rows]


def halve_samples(motion: Trajectory) -> Trajectory:
    """Every second sample of a motion: what is read of it is four times as wrong, at kinks, and more elsewhere."""
    kept = np.append(np.arange(0, len(motion.time) - 1, 2), len(motion.time) - 1)
    arrays = {name: getattr(motion, name)[kept] for name in ("time", "position", "velocity", "absolute_acceleration")}
    return replace(motion, **arrays)


def _make_benchmark(case: BenchmarkCase, answers: Mapping[str, SideNumbers]) -> Benchmark:
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
    """A published number with that of every side, NaN where a side has not as many values as are published."""
    row = case.published[place]
    numbers = dict.fromkeys(answers, (math.nan, math.nan))
    for side, answer in answers.items():
        if len(answer.values) == len(case.published):
            numbers[side] = answer.values[place], answer.errors[place]

    def read_number(side: str) -> Number:
        value, error = map(finite_or_none, numbers[side])
        verdict = row.judge(value, error)
        return Number(value, error, verdict, explain(side) if verdict == NOT_MET else "")

    def explain(side: str) -> str:
        if case.difference:
            return MODEL
        (value, error), (smoothed, its_error) = numbers[side], numbers[SMOOTHED]
        same = replace(row, published=smoothed, uncertainty=its_error, numbers={})
        return FRICTION if side != EQUATIONS and same.judge(value, error) == MET else ""

    return replace(row, numbers={side: read_number(side) for side in numbers})


def _answer_of_failure(question: tuple[BenchmarkCase, str], failed: TaskResult) -> SideNumbers:
    return SideNumbers([], [], failed.reason, 0.0)
