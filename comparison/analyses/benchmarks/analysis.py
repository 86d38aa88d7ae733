"""Published numbers as an analysis: a task for every benchmark and side."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from comparison.analyses.benchmarks.cases import Case, Published, Reading
from comparison.analyses.benchmarks.table import Benchmark, Benchmarks, Number, Row, Verdict
from comparison.analyses.sides import ENGINE, EQUATIONS, SMOOTHED
from comparison.json_file import finite_or_none
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task, TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import imported
from comparison.study.models import EXACT, REGULARIZED, TRANSLATIONAL
from comparison.study.study import Study
from reference.measures.demands import ANSWERED
from reference.problem import Scene, State, Trajectory

MODELS = {EQUATIONS: EXACT, SMOOTHED: REGULARIZED, ENGINE: TRANSLATIONAL}
TOLERANCES = {EQUATIONS: 1e-8, SMOOTHED: 1e-8, ENGINE: 1e-4}
SAMPLES = 100_001  # instants at which the equations are read
SECONDS = {EQUATIONS: 0.1, SMOOTHED: 0.1, ENGINE: 3.5}  # predicted cost
LIMIT = 300.0  # s of processor time of one task
ROUNDING = 1e-12  # relative


@dataclass(frozen=True)
class Question:
    """One benchmark for one side."""

    scene: Scene
    phases: tuple[float, float]
    start: Sequence[tuple[float, float]]
    regularization: float
    reading: Reading
    side: str


@dataclass(frozen=True)
class Answer:
    """The numbers of one side with their errors, and how the motion ended."""

    values: list[float]
    errors: list[float]
    ending: str
    seconds: float


@dataclass(frozen=True)
class BenchmarkTable(Analysis[Benchmarks]):
    """Every benchmark by the equations, by the equations with the engine's friction law, and by the engine."""

    key, stage = "benchmarks", "benchmarks"
    cases: Sequence[Case]

    def tasks(self, study: Study | None = None, surfaces: xr.Dataset | None = None) -> list[Task]:
        """One task for each benchmark and side."""
        return [self._task(case, side) for case in self.cases for side in MODELS]

    def collect(self, study: Study | None, surfaces: xr.Dataset | None, results: TaskResults) -> Benchmarks:
        """The table, without what the command knows of the run."""
        return Benchmarks(
            [
                _benchmark(case, {side: results.value(self._task(case, side), _failed) for side in MODELS})
                for case in self.cases
            ],
            {},
        )

    def _task(self, case: Case, side: str) -> Task:
        question = Question(case.scene, case.phases, case.start, case.regularization, case.reading, side)
        seconds = SECONDS[side] * max(1.0, case.scene.duration / 12.0)
        return Task(solve, question, self.stage, seconds, case.scene, side != ENGINE, timeout=LIMIT)


def solve(question: Question) -> Answer:
    """The numbers of one side. Runs inside a worker process."""
    scene, model = question.scene, MODELS[question.side]
    settings = dict(model.settings)
    if question.side != EQUATIONS:
        settings["regularization"] = question.regularization
    if question.side != ENGINE:
        settings["times"] = np.linspace(0.0, scene.duration, SAMPLES)
    if question.start:
        place = np.array(question.start)
        settings["initial"] = State(place, np.zeros_like(place))
    clock = time.process_time()
    motion: Trajectory = imported(model.trajectory)(
        scene, question.phases, tolerance=TOLERANCES[question.side], **settings
    )
    values, errors = _read(question.reading, motion)
    return Answer(values, errors, str(motion.status), time.process_time() - clock)


def _read(reading: Reading, motion: Trajectory) -> tuple[list[float], list[float]]:
    """The numbers and their estimated absolute errors; none of a motion that ended early."""
    if motion.status not in ANSWERED or len(motion.time) < 2:
        return [], []
    values, accuracy = reading.of(motion), motion.accuracy
    if accuracy is None:
        return values, [math.nan] * len(values)
    coarser = [reading.of(other) for other in accuracy.coarser]
    if any(len(other) != len(values) for other in coarser):  # another number of swings: nothing is known of the error
        return values, [math.nan] * len(values)
    halved = reading.of(thinned(motion))
    if len(halved) != len(values):
        return values, [math.nan] * len(values)
    sampling = [abs(a - b) / 3.0 for a, b in zip(values, halved)]
    return values, [accuracy.error_of(value, others) + part for value, part, *others in zip(values, sampling, *coarser)]


def thinned(motion: Trajectory) -> Trajectory:
    """Every second sample of a motion: what is read of it is four times as wrong, at kinks, and more elsewhere."""
    kept = np.append(np.arange(0, len(motion.time) - 1, 2), len(motion.time) - 1)
    arrays = {name: getattr(motion, name)[kept] for name in ("time", "position", "velocity", "absolute_acceleration")}
    return replace(motion, **arrays)


def _benchmark(case: Case, answers: Mapping[str, Answer]) -> Benchmark:
    return Benchmark(
        name=case.scene.name,
        title=case.title,
        source=case.source,
        evidence=case.evidence,
        regularization=case.regularization,
        difference=case.difference,
        rows=[_row(case, published, place, answers) for place, published in enumerate(case.published)],
        endings={side: answer.ending for side, answer in answers.items()},
        seconds={side: round(answer.seconds, 3) for side, answer in answers.items()},
    )


def _row(case: Case, published: Published, place: int, answers: Mapping[str, Answer]) -> Row:
    numbers = {side: _number_at(answer, len(case.published), place) for side, answer in answers.items()}
    smoothed = numbers[SMOOTHED]

    def judged(side: str, value: float, error: float) -> Number:
        verdict = _verdict(case, published, value, error, smoothed if side == ENGINE else None)
        return Number(finite_or_none(value), finite_or_none(error), verdict)

    judged_numbers = {side: judged(side, *number) for side, number in numbers.items()}
    return Row(published.quantity, published.unit, published.value, published.uncertainty, judged_numbers)


def _number_at(answer: Answer, count: int, place: int) -> tuple[float, float]:
    """Value and error; NaN where the side has not as many values as are published."""
    return (answer.values[place], answer.errors[place]) if len(answer.values) == count else (math.nan, math.nan)


def _verdict(
    case: Case, published: Published, value: float, error: float, smoothed: tuple[float, float] | None
) -> Verdict:
    """smoothed: value and error of the equations with the engine's friction law, for the engine's own number."""
    if not (math.isfinite(value) and math.isfinite(error)):
        return Verdict.NONE
    if within(value - published.value, error + published.uncertainty, value):
        return Verdict.MET
    if case.difference:
        return Verdict.MODEL
    if smoothed is not None and within(value - smoothed[0], error + smoothed[1], value):
        return Verdict.FRICTION
    return Verdict.OFF


def within(difference: float, allowed: float, value: float) -> bool:
    """Whether a difference is allowed, but for rounding of the value."""
    return abs(difference) <= allowed + ROUNDING * abs(value)


def _failed(question: Question, failed: TaskResult) -> Answer:
    return Answer([], [], failed.reason, 0.0)
